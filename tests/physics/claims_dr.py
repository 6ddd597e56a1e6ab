"""The statements of Rosato et al. (Phys. Rev. E 81, 061301, 2010) and how each is tested.

The windows from the floor and the first step of 0.2 were chosen on other beds by the printed 0.567, 0.578 and 0.597;
dr6-windows tests them on beds with a seed of their own. A printed mean errs by 0.001, the paper's stop rule for
realizations, and is rounded to 0.0005."""
from scores import Claim

LIFT = "the lift densifies faster: about tap {}, {} d wide"


def density(text, source, printed, **more):
    return Claim("dr6", text, "printed", "dr6-windows", source, printed=printed, printed_error=0.001, margin=0.0005,
                 relevant=0.01, full=True, **more)


CLAIMS = [
    Claim("dr2", "the lift densifies faster, 12 d, tap 100", "positive", "dr2-wide", LIFT.format(100, 12), full=True),
    Claim("dr2", "the lift densifies faster, 12 d, tap 1500", "positive", "dr2-wide", LIFT.format(1500, 12),
          full=True),
    Claim("dr2", "the lift densifies faster, 8 d, tap 350", "positive", "dr2", LIFT.format(350, 8)),
    Claim("dr2", "the held dilation gives little or nothing (0.005)", "within", "dr2-wide",
          "the held dilation gives little or nothing (0.005)", margin=0.005, full=True),
    *(Claim("dr2", f"the lift densifies faster, {width} d, tap {tap}", "positive", run, LIFT.format(tap, width),
            own=True, full=width == 12)
      for run, width, tap in (("dr2", 8, 10), ("dr2", 8, 100), ("dr2", 8, 200), ("dr2-wide", 12, 10),
                              ("dr2-wide", 12, 350), ("dr2-wide", 12, 700))),
    Claim("dr2", "a bed 12 d wide gains what one of 16 d does (0.005)", "within", "dr-widths",
          "a bed 12 d wide gains what one of 16 d does, Phi within 0.005 (ours)", margin=0.005, own=True, full=True),
    Claim("dr2", "lateral offsets change nothing (0.005): 0.05 d", "within", "dr-shakes",
          "lateral offsets change nothing (0.005): offsets within 0.05 d", margin=0.005),
    Claim("dr2", "lateral offsets change nothing (0.005): 0.1 d", "within", "dr-shakes",
          "lateral offsets change nothing (0.005): offsets within 0.1 d", margin=0.005),
    Claim("dr2", "a shake densifies the upper bed little or not at all (0.005)", "within", "dr-shakes",
          "a shake densifies the upper bed little or not at all (0.005)", margin=0.005),
    Claim("dr2", "a shake leaves the bulk less dense than a lift does", "positive", "dr-shakes",
          "a shake leaves the bulk less dense than a lift does"),
    Claim("dr3", "N_c rises with Phi", "positive", "dr3", "N_c rises with Phi", full=True),
    Claim("dr3", "Aste's data lie near", "none", full=True, note="no data of Aste et al. at hand"),
    Claim("dr4", "Phi is largest at an intermediate lift", "positive", "dr4", "=best_lift"),
    Claim("dr4", "that lift is near 0.25 to 0.3 (0.05)", "interval", "dr4", "=best_lift_top", wanted=(0.2, 0.35)),
    Claim("dr4", "in equilibrium before 10^4 taps at 0.3 and above", "none", note="400 taps here"),
    Claim("dr4", "the inverse log fits at low lifts", "none", note="not fitted to these runs"),
    *(Claim("dr5", f"Phi falls within 60 taps at {lift}", "positive", "dr5", f"Phi falls within 60 taps at {lift}",
            own=lift in (0.2, 0.3)) for lift in (0.1, 0.2, 0.25, 0.3, 0.5)),
    Claim("dr5", "the final Phi is largest at an intermediate lift", "positive", "dr5", "=best_melted"),
    Claim("dr5", "at about the lift of fig. 4 (0.2 to 0.35)", "interval", "dr5", "=best_melted_top",
          wanted=(0.2, 0.35)),
    Claim("dr5", "Phi flattens after many thousand taps", "none", note="500 taps here"),
    density("rho = 0.567 after 0 taps, 0 to 15 d", "=floor_15_at_0", 0.567),
    density("rho = 0.578 after 50 taps, 0 to 15 d", "=floor_15_at_50", 0.578),
    density("rho = 0.597 after 250 taps, 0 to 15 d", "=floor_15_at_250", 0.597),
    density("from tap 50 to 250 it gains 0.019, 0 to 15 d", "=floor_15_gain", 0.019, gain=True),
    Claim("dr6", "layers grow with taps", "positive", "dr6", "layers grow with taps", full=True),
    Claim("dr6", "they grow upwards from the floor", "positive", "dr6", "they grow upwards from the floor", full=True),
    Claim("dr6", "peaks of n(y/d) lie at the heights of hcp layers", "none", full=True,
          note="tap 600: 0.50, 1.28, 2.06, 2.85 d for 0.50, 1.32, 2.13, 2.95 d; errors not kept"),
    Claim("dr6", "rho = 0.654 after 90 000 taps", "none", full=True, note="250 taps here"),
    *(density(text, source, printed, own=True) for text, source, printed in (
        ("0.567 after 0 taps, 0 to 18 d", "=floor_18_at_0", 0.567),
        ("0.578 after 50 taps, 0 to 18 d", "=floor_18_at_50", 0.578),
        ("0.597 after 250 taps, 0 to 18 d", "=floor_18_at_250", 0.597),
        ("0.597 after 250 taps, the middle 60 %", "=middle_at_250", 0.597),
        ("0.578 after 50 taps, 0 to 15 d, first step 0.1", "=short_step_at_50", 0.578),
        ("0.597 after 250 taps, 0 to 15 d, first step 0.1", "=short_step_at_250", 0.597),
        ("0.597 after 250 taps, stop watches 0 to 15 d", "=floor_stop_at_250", 0.597),
        ("0.597 after 250 taps, the same, measure_start off", "=floor_stop_later_at_250", 0.597))),
    Claim("dr7", "Phi falls with friction", "positive", "dr7-9", "Phi falls with friction", pick=(0, 1, 2, 3, 4, 5),
          full=True),
    Claim("dr7", "without friction as dense as random packings, 0.6366 (0.005)", "within", "dr7-9",
          "without friction 0.6366 +- 0.0005, as random packings have",
          printed=0.6366, printed_error=0.0005, margin=0.005,
          dof=3, full=True, post_hoc=True),
    Claim("dr7", "0.6088 +- 0.0035 at a friction of 0.1 (its range)", "within", "dr7-9",
          "0.6088 +- 0.0035 at a friction of 0.1", printed=0.6088, printed_error=0.0035, margin=0.0035, full=True),
    *(Claim("dr7", f"0.6088 +- 0.0035; K1 = {stiffness} N/m, column {column}", "within", "dr7-columns",
            f"0.6088 +- 0.0035 at a friction of 0.1; K1 = {stiffness} N/m, column {column}", printed=0.6088,
            margin=0.0035, own=True, full=True)
      for stiffness, column in (("10000", 0.2), ("1e+06", 0.2), ("100000", 0.05), ("100000", 0.34))),
    Claim("dr8", "mean of the neighbours 7.27 +- 0.06", "interval", "dr7-9",
          bounds=(7.602, 7.643), wanted=(7.2713 - 0.0558, 7.2713 + 0.0558), full=True),
    Claim("dr8", "width of the neighbours 1.255 +- 0.026", "interval", "dr7-9",
          bounds=(1.157, 1.204), wanted=(1.2550 - 0.0262, 1.2550 + 0.0262), full=True),
    Claim("dr8", "the neighbours are normal, R2 of 0.99 or more", "interval", "dr7-9", "=neighbours_are_normal",
          wanted=(0.99, 1), full=True),
    Claim("dr10", "single beds densify in jumps", "seen", note="one of four beds: 0.6486 to 0.7156, taps 100 to 150"),
    Claim("dr10", "Phi = 0.609 at the start (0.0035)", "within", "dr10-14", "Phi = 0.609 at the start (0.0035)",
          printed=0.609, printed_error=0.0035, margin=0.0035),
    Claim("dr10", "Phi grows at Gamma = 2 (tap 200)", "positive", "dr10-14", "Phi grows at Gamma = 2"),
    Claim("dr10", "Phi = 0.6997 +- 0.0058 after 898 taps", "none", note="200 taps here: 0.669(17)"),
    Claim("dr11", "almost nothing at Gamma = 0.5 (0.0091, a tenth of the gain at 2)", "within", "dr10-14",
          "almost nothing at Gamma = 0.5: less than a tenth of that", margin=0.0091),
    Claim("dr11", "no order at Gamma = 0.5 (half a layer)", "within", "dr10-14",
          "no order at Gamma = 0.5 (less than half a layer)", margin=0.5),
    Claim("dr13", "layers grow from the floor at Gamma = 2: the third, tap 100", "positive", "dr10-14",
          "=third_layer_fills", post_hoc=True),
    Claim("dr13", "grown layers at Gamma = 2, tap 200 less tap 0", "positive", "dr10-14",
          "layers grow from the floor at Gamma = 2", own=True),
    Claim("dr15", "the improvement is at most about 5 % (5.5 %)", "p", "dr15",
          "the improvement is at most about 5 % (5.5 %)", p=0.019),
    Claim("dr15", "no solids fraction above about 0.66 (0.665)", "p", "dr15",
          "no solids fraction above about 0.66 (0.665)", p=0.007),
    *(Claim("both-engines", text, "positive", "both-engines", text + " (ours)", own=True)
      for tap in ("lift 0.25", "held dilation 1.025")
      for text in (f"{tap}, Monte Carlo: Phi grows from tap 1 to 30", f"{tap}, Monte Carlo: pores shrink",
                   f"{tap}, grains, friction 0.1: Phi grows from tap 1 to 30",
                   f"{tap}, grains, friction 0.1: pores shrink",
                   f"{tap}: grains without friction end denser than Monte Carlo")),
]
