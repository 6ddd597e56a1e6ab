"""The statements of Philippe and Bideau (Phys. Rev. E 63, 051304, 2001) and how each is tested."""
from scores import Claim

SLOWER, STEP = "slower for smaller eps: ", "turned back at {} a bed gains on the way down"
TAIL = "the tail is exponential, tap {}"
POST = {"post_hoc": True}
PORE_BEDS = 43  # deviation of one bed: that of the 12 312 vertices of the three beds of pb10, scaled to 9550


def grows(eps):
    return Claim("pb2", f"Phi_b grows with taps at eps = {eps}", "positive", "pb2",
                 f"Phi_b grows with taps at eps = {eps}")


def ages(first, last, lag, p):
    return Claim("pb5", f"A falls with age, {first} to {last} taps, lag {lag}", "p", "pb5",
                 f"A falls with age: from t_W = {first} to {last} at lag {lag}", p=p, own=True)


def exponential_tail(tap, p):
    return Claim("pb10", f"the tail of large pores is exponential, tap {tap}", "refute", "pb10", TAIL.format(tap),
                 p=p, full=True)


CLAIMS = [
    grows(0.005), grows(0.05), grows(0.15),
    Claim("pb2", "growth is slower for smaller eps: gain of 100 taps", "positive", "pb2",
          SLOWER + "the gain of the first 100 taps"),
    Claim("pb2", "X_inf may exceed 0.64 at small eps", "none", note="X_inf at 0.005: 0.553 to 0.799 (95 %)"),
    Claim("pb2", "tau rises spectacularly at small eps", "none", note="tau above 13.6 at 0.005, no limits at 0.05"),
    Claim("pb2", "B is exponential in eps^(1/2)", "none", note="no B has two limits"),
    Claim("pb2", "the three parameters are not unique", "shown",
          note="B and tau have no upper limits at any strength (profile likelihood, 95 %)"),
    Claim("pb2", "two exponentials fit <Z> about as well as eq. 4, at 0.15", "positive", "pb2",
          "two exponentials fit <Z> reasonably well (ours: less than 1.5 times the mean square of eq. 4's residuals)"
          " at eps = 0.15", own=True),
    Claim("pb2", "most of the gain comes earlier at strong taps", "positive", "pb2",
          SLOWER + "the share of the gain of 10000 taps made by tap 100", own=True),
    Claim("pb3", "the spectrum falls as f^-s, s from 1 to 1.5: at eps^(1/2) = 0.30", "within", "pb3",
          "=slope_30", margin=0.25, printed=-1.25, **POST),
    Claim("pb3", "the spectrum falls as f^-s, s from 1 to 1.5: at eps^(1/2) = 0.25", "within", "pb3",
          "=slope_25", margin=0.25, printed=-1.25, **POST),
    Claim("pb3", "the spectrum falls as f^-s, s from 1 to 1.5: at eps^(1/2) = 0.20", "within", "pb3",
          "=slope_20", margin=0.25, printed=-1.25, **POST),
    Claim("pb3", "the spectrum falls as f^-s, s from 1 to 1.5: at eps^(1/2) = 0.15", "within", "pb3",
          "=slope_15", margin=0.25, printed=-1.25, **POST),
    Claim("pb3", "sigma_Z is proportional to eps^(1/2): no offset at 0", "within", "pb3",
          "sigma_Z is proportional to eps^(1/2)", dof=3, margin=0.01, **POST),
    Claim("pb3", "eps changes the spectrum at high frequencies only (at low ones by less than half as much)",
          "positive", "pb-campaign", "=high_frequencies_only", full=True),
    Claim("pb3", "ln of the power at high frequencies rises from eps = 0.0025 to 0.1", "positive", "pb-campaign",
          "=high_frequencies", own=True, full=True, **POST),
    Claim("pb3", "ln of the power at low frequencies is the same at eps = 0.0025 and 0.1 (0.69)", "within",
          "pb-campaign", "=low_frequencies", margin=0.69, own=True, full=True, **POST),
    *(Claim("pb3", f"slope of 1 to 1.5 at eps^(1/2) = {strength}, 4096 spheres", "within", "pb-campaign",
            f"=full_slope_{strength[2:]}", margin=0.25, printed=-1.25, own=True, full=True)
      for strength in ("0.05", "0.32")),
    Claim("pb4", "a bell: 0.10 to 0.20 above 0.05", "positive", "pb4-bell", "=bell_left"),
    Claim("pb4", "a bell: 0.10 to 0.20 above 0.40", "positive", "pb4-bell", "=bell_right"),
    Claim("pb4", "its maximum lies between 0.1 and 0.2", "interval", "pb4-bell", "=bell_top", wanted=(0.1, 0.2),
          **POST),
    Claim("pb4", "the way down lies above the first way up", "positive", "pb4-hysteresis",
          "the way down lies above the first way up"),
    Claim("pb4", "the branch is reversible: up again as down", "p", "pb4-hysteresis",
          "the way up again is the way down, within a fifth of the first loop", p=0.016, favours=False),
    Claim("pb4", "on the way down Phi_c falls with eps^(1/2) above 0.15", "positive", "pb4-hysteresis",
          "on the way down Phi_c falls with eps^(1/2) above 0.15"),
    Claim("pb4", "below 0.15 it still rises a bit more", "positive", "pb4-hysteresis",
          "below 0.15 the way down still rises a bit more"),
    Claim("pb4", "turned back below 0.15 a bed is nearly frozen (a fifth)", "p", "pb4-turns",
          "turned back at 0.1 a bed is nearly frozen (ours: the way down changes Phi_c by less than a fifth of what "
          "the way up gained from tap 1)", p=0.0019),
    *(Claim("pb4", STEP.format(at), "positive", "pb4-turns", STEP.format(at), own=True) for at in (0.2, 0.25, 0.3)),
    Claim("pb4", "0.15 comes nearer to 0.05 with more taps", "positive", "pb4-bell",
          "0.15 comes nearer to 0.05 with more taps (ours, asked after a look)", own=True, **POST),
    Claim("pb4", "a stop ten times finer leaves Phi_c at 0.15 (0.005)", "within", "pb4-eta",
          "a stop ten times finer leaves Phi_c as it is, at 0.15 (ours: 0.005)", margin=0.005, own=True),
    Claim("pb4", "a stop ten times finer leaves Phi_c at 0.05 (0.005)", "within", "pb4-eta",
          "a stop ten times finer leaves Phi_c as it is, at 0.05 (ours: 0.005)", margin=0.005, own=True),
    Claim("pb4", "pores shrink on the way down", "positive", "pb4-hysteresis", "pores shrink on the way down (ours)",
          own=True),
    ages(3, 10, 10, 0.0002), ages(30, 100, 10, 0.0002), ages(300, 1000, 10, 0.7), ages(3, 10, 100, 0.0002),
    ages(30, 100, 100, 0.0002), ages(300, 1000, 100, 0.00066),
    Claim("pb5", "A falls with age, 3 to 1000 taps, lag 10", "positive", "pb5", "=ages_at_10"),
    Claim("pb5", "A falls with age, 3 to 1000 taps, lag 100", "positive", "pb5", "=ages_at_100"),
    Claim("pb5", "eq. 6 fits: A(9) at most 9 A(1), ages 3 to 100", "positive", "pb5", "=eq6_is_concave", **POST),
    Claim("pb6", "peaks at the floor", "positive", "pb-campaign", "=full_floor_peaks", full=True),
    Claim("pb6", "density falls upward (alpha > 0)", "positive", "pb-campaign", "=full_alpha", full=True),
    Claim("pb6", "alpha is bell-shaped in eps^(1/2): it rises, 0.025 to 0.1", "positive", "pb-campaign",
          "=full_alpha_rises", full=True),
    Claim("pb6", "alpha is bell-shaped in eps^(1/2): it falls, 0.2 to 0.32 (1000 taps)", "positive", "pb6-8",
          "=alpha_falls", full=True),
    Claim("pb6", "alpha has no hysteresis: first and second time at 0.40 (a fifth of its bell)", "within",
          "pb4-hysteresis", "=alpha_hysteresis", margin=0.23, **POST),
    *(Claim("pb7", f"layers at the walls: {gap} gap", "positive", "pb-campaign", f"=full_{gap}_gap", full=True)
      for gap in ("first", "second", "third")),
    Claim("pb7", "no peaks at periodic sides (0.02)", "within", "pb6-8-periodic", "no peaks at the sides (0.02)",
          margin=0.02, full=True),
    Claim("pb7", "Phi_c is larger with periodic sides", "positive", "pb6-8-periodic",
          "Phi_c is larger than between walls", full=True),
    Claim("pb7", "Phi_c grows less with periodic sides", "positive", "pb6-8-periodic",
          "Phi_c grows less than between walls, from tap 1", full=True),
    Claim("pb8", "the first tap moves the walls more than the centre", "positive", "pb-campaign", "=full_first_tap",
          full=True),
    Claim("pb8", "the central increase is below the lateral, tap 4000", "positive", "pb-campaign", "=full_increases",
          full=True),
    Claim("pb8", "the lateral increase is bell-shaped in eps^(1/2)", "positive", "pb-campaign", "=full_lateral_bell",
          full=True),
    Claim("pb8", "the central increase is bell-shaped in eps^(1/2)", "positive", "pb-campaign", "=full_central_bell",
          full=True),
    Claim("pb8", "nearly frozen at eps^(1/2) = 0.025 (a fifth of the gain at 0.1)", "positive", "pb-campaign",
          "=full_weak_is_frozen", full=True),
    Claim("pb8", "the central increase is below the lateral, from tap 1 to 1000", "positive", "pb6-8",
          "Phi grows less in the centre, from tap 1 to 1000", full=True, own=True),
    Claim("pb8", "the lateral increase is bell-shaped in eps^(1/2), tap 1000, ends 0.05 and 0.32", "positive", "pb6-8",
          "=lateral_bell", full=True, own=True, **POST),
    Claim("pb8", "the central increase is bell-shaped in eps^(1/2), tap 1000, ends 0.05 and 0.32", "positive", "pb6-8",
          "=central_bell", full=True, own=True, **POST),
    Claim("pb8", "nearly frozen at eps^(1/2) = 0.05, taps 1 to 1000 (a fifth of the gain at 0.2)", "positive", "pb6-8",
          "=weak_is_frozen", full=True, own=True, **POST),
    Claim("pb9", "Phi = 58.4 % at the start", "printed", "pb-voids", "=fraction_before_voids", printed=0.584,
          printed_error=0.0012, margin=0.0005, relevant=0.01, full=True),
    *(Claim("pb9", text, "within", "pb-voids", source, margin=0.03, full=True, **more) for text, source, more in (
        ("P0(1.2) is near Gotoh's, tap 0 (0.03)", "=above_gotoh_first", POST),
        ("P0(1.2) is near Gotoh's, tap 4000 (0.03)", "=above_gotoh_last", POST),
        ("P0(1.2) hardly changes (0.03)", "=weak_voids_change", POST),
        ("strength 0.1: P0(1.2) is near Gotoh's, tap 4000 (0.03)", "=strong_above_gotoh_last", {"own": True}),
        ("strength 0.1: P0(1.2) hardly changes (0.03)", "=strong_voids_change", {"own": True}))),
    Claim("pb9", "60.6 % after 4000 taps", "silent", note="the paper prints no strength", full=True),
    Claim("pb10", "the tail shrinks (v0 falls)", "positive", "pb10", "the tail shrinks (v0 falls)", full=True),
    Claim("pb10", "nu falls as the bed densifies, taps 0 to 9999", "positive", "pb10", "nu falls as the bed densifies",
          full=True),
    Claim("pb10", "nu falls at every step of Phi_c", "positive", "pb10", "=nu_steps", full=True),
    Claim("pb10", "v0 follows nu", "positive", "pb10", "v0 follows nu", full=True),
    Claim("pb10", "small pores change less than large ones", "positive", "pb10",
          "small pores change less than large ones", pick=(2,), full=True, **POST),
    exponential_tail(0, 0.12), exponential_tail(9999, 0.011),
    Claim("pb10", "9550 pores in the loosest packing: tap 0, four centres in the box", "printed", "pb-pores",
          "=pores_first", printed=9550, printed_error=PORE_BEDS, margin=25, relevant=350, full=True),
    *(Claim("pb-moves", text, "positive", "pb-move-settings", source, full=True) for text, source in (
        ("theta_0 = pi/4 compacts most", "=optimum_of_angle"),
        ("a large theta_0 is less efficient", "=wide_angle_loses"),
        ("a very small theta_0 decompacts", "=small_angle_decompacts"),
        ("a very small d_max freezes the bed", "=short_steps_freeze"),
        ("a large d_max freezes the bed", "=long_steps_freeze"))),
    *(Claim("pb-moves", f"the width matters more than the form: {form}", "positive", "pb-move-settings",
            f"={form}_form", full=True, **POST) for form in ("exponential", "linear")),
    *(Claim("pb-sides", text, "positive", "pb-sides", text + end, pick=pick, own="ours" in end)
      for text, end, pick in (
          ("fig. 2, periodic: Phi_b grows at every strength", " (ours)", (0, 1, 2, 3)),
          ("fig. 2, periodic: slower for the smallest eps, in the first 100 taps", " (ours)", (0,)),
          ("fig. 4, periodic: Phi_c is largest at an intermediate strength (here: after 300 taps)", "", (0, 1)))),
    Claim("pb-sides", "a bed 8 d wide gains what one of 16 d does (0.005)", "within", "pb-widths",
          "a bed 8 d wide gains what one of 16 d does, Phi_c within 0.005 (ours)", margin=0.005, own=True),
    Claim("pb-sides", "a bed 12 d wide gains what one of 16 d does (0.005)", "within", "pb-widths",
          "a bed 12 d wide gains what one of 16 d does, Phi_c within 0.005 (ours)", margin=0.005, own=True),
]
