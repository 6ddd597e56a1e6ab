"""Figures 2 to 5 of Philippe & Bideau, and their moves: curves against taps, and what hangs on the
strength and on the settings."""
import numpy as np

from page_text import at, interval, parameters, steadiness, table, window
from verdicts import (Estimate, are_positive, detectable, is_positive, is_within, is_zero,
                      of_interval, of_program, undecided)


def compaction(run):
    values, curves = run.values(), run.curves("bottom_fraction")
    fits = run.fits("bottom_fraction", "inverse_log")
    rows = [[f"{value:g}"] + [at(curve, tap) for tap in (0, 1, 10, 100, 1000)] +
            parameters(fit, ("X_inf", "tau")) for value, curve, fit in zip(values, curves, fits)]
    early = [window(curve, 81, 120) - curve[1] for curve in curves]
    late = [window(curve, 901, 1000) - curve[1] for curve in curves]
    statements = [is_positive(f"Phi_b grows with taps at eps = {value:g}", Estimate.of(gain),
                              "taps 901 to 1000 less tap 1: ")
                  for value, gain in zip(values, late)]
    statements += [
        is_positive("slower for smaller eps: the gain of the first 100 taps",
                    Estimate.of(early[1] - early[0]), f"that of {values[1]:g} less that of "
                    f"{values[0]:g}: ", name="paired t-test"),
        is_positive("slower for smaller eps: the share of the gain of 1000 taps made by tap 100",
                    Estimate.of(early[2] / late[2] - early[0] / late[0]),
                    f"that of {values[2]:g} less that of {values[0]:g}: ", digits=2,
                    name="paired t-test"),
        of_interval("X_inf may exceed 0.64 at small eps", *interval(fits[0], "X_inf"), above=0.64,
                    found=f"X_inf at {values[0]:g}"),
        undecided("tau rises spectacularly at small eps",
                  ", ".join(f"{text} at {value:g}" for value, text in
                            zip(values, (parameters(fit, ("tau",))[0] for fit in fits))),
                  "95 % intervals: they overlap or have no end")
        if overlap(interval(fits[0], "tau"), interval(fits[1], "tau")) else
        of_interval("tau rises spectacularly at small eps", *interval(fits[0], "tau"),
                    above=interval(fits[1], "tau")[1], found=f"tau at {values[0]:g}")]
    text = table(["eps", "Phi_b, tap 0", "1", "10", "100", "1000", "X_inf of the inverse log",
                  "its tau"], rows)
    return text, statements


def overlap(first, second):
    return first[0] <= second[1] and second[0] <= first[1]


def fluctuations(run):
    last, rows, states = run.scene["analyse"]["steady"][0]["last"], [], []
    steady = run.analyse("steady", "--observable", "mean_height", "--last", last)
    spectra = run.analyse("spectrum", "--observable", "mean_height", "--last", last, "--detrend",
                          "linear")
    sweep = next(iter(run.analyse("sweep", "--observable", "mean_height", "--quantity",
                                  "steady/sigma").values()))
    slopes = []
    for point, value in enumerate(run.values()):
        state = steady[f"point_{point:04}/steady/mean_height"]
        spectrum = spectra[f"point_{point:04}/spectrum/mean_height"]
        states.append(state.notes["verdict"])
        slopes.append(spectrum)
        rows.append([f"{np.sqrt(value):.3f}", state.estimate("sigma").text(),
                     f"{state['autocorrelation_time']:.0f}", spectrum.estimate("slope").text(2),
                     f"{spectrum['ar1_slope']:.2f}", f"{spectrum['ar1_slope_p']:.2g}",
                     states[-1]])
    statements = []
    for value, spectrum, state in zip(run.values(), slopes, states):
        name = f"the spectrum falls as f^-s, s from 1 to 1.5, at eps^(1/2) = {np.sqrt(value):.3f}"
        slope = spectrum.estimate("slope")
        found = f"slope {slope.text(2)}, of AR(1) {spectrum['ar1_slope']:.2f}"
        if not state.startswith("reached"):
            statements.append(undecided(name, found, "a steady state is not shown"))
        else:
            slope.value += 1.25
            statements.append(is_within(name, slope, 0.25, found + "; from -1.25: ", 2))
    line = sweep.estimate("line_slope")
    statements += [
        is_positive("sigma_Z rises with eps^(1/2)", line, "slope of a straight line: "),
        is_zero("sigma_Z is proportional to eps^(1/2)", sweep.estimate("line_intercept"),
                "at eps = 0 the line is at ")]
    text = table(["eps^(1/2)", "sigma_Z", "autocorrelation time, taps", "slope of the spectrum",
                  "of AR(1)", "p of their difference", "steady state"], rows)
    return text + (f"\n\nStraight line through sigma_Z: slope {line.text()}, at eps = 0 "
                   f"{sweep.estimate('line_intercept').text()}; of a straight line scattering as "
                   f"much p = {sweep['line_p']:.2g}."), statements


def bell(run):
    values, curves = np.sqrt(run.values()), run.curves("corrected_fraction")
    last = len(curves[0]) - 1
    windows = [(end - 99, end) for end in (400, 700, 1000, 2000, 4000) if end <= last]
    rows = [[f"{value:.3f}", at(curve, 1)] +
            [Estimate.of(window(curve, *taps)).text() for taps in windows]
            for value, curve in zip(values, curves)]
    sweep = next(iter(run.analyse("sweep", "--observable", "corrected_fraction", "--last",
                                  100).values()))
    steady = run.analyse("steady", "--observable", "corrected_fraction", "--last", last // 2)
    end = dict(zip(np.round(values, 3), (window(curve, *windows[-1]) for curve in curves)))
    statements = [
        maximum_of(sweep, "a bell: Phi_c has a maximum inside", "eps^(1/2)"),
        of_interval("its maximum lies between 0.1 and 0.2", sweep["maximum_at_low"],
                    sweep["maximum_at_high"], between=(0.1, 0.2), found="maximum at"),
        is_positive("its left side rises", Estimate.of(end[0.15] - end[0.05]),
                    "Phi_c at 0.15 less 0.05: ", name="paired t-test"),
        is_positive("its right side falls", Estimate.of(end[0.2] - end[0.4]),
                    "Phi_c at 0.20 less 0.40: ", name="paired t-test")]
    statements.append(undecided(
        "its values are those of steady states",
        f"steady over taps {last - last // 2 + 1} to {last}? " + steadiness(
            steady, "corrected_fraction", [f"{value:.2f}" for value in values]),
        f"{last} of 4000 taps"))
    header = [f"{first} to {end}" for first, end in windows]
    return table(["eps^(1/2)", "Phi_c after tap 1", "mean of taps " + header[0]] + header[1:],
                 rows), statements


def maximum_of(sweep, statement, symbol):
    """The test of a sweep for a maximum inside."""
    found = f"{sweep.notes['maximum']}"
    if np.isfinite(sweep["maximum_at"]):
        found += f"; a parabola's is at {symbol} = {sweep['maximum_at']:.3g}"
    return of_program(statement, found, "two lines (Simonsohn 2018)", sweep["maximum_p"], True)


THETAS, STEPS = (0.0982, 0.3927, 0.589, 0.7854, 1.1781, 1.5708), (0.003, 0.03, 0.1, 0.3, 1.0)


def moves(run):
    """Each pair of theta_0 and d_max, and two other laws of the same width."""
    zipped = run.scene["sweep"]["zip"]
    settings = list(zip(*(zipped[f"/relax/polar/{name}"]
                          for name in ("theta0", "max_step", "law"))))
    curves = dict(zip(settings, run.curves("corrected_fraction")))
    sweeps = dict(zip(settings, run.curves("sweeps")))

    def gain(theta, step=0.1):
        curve = curves[theta, step, "gaussian"]
        return curve[30] - curve[0]
    rows = [[f"{theta / np.pi:.4g} pi"] + [
        f"{Estimate.of(1e4 * gain(theta, step)).text(0)}; "
        f"{np.mean(sweeps[theta, step, 'gaussian'][1:]):.0f}" for step in STEPS]
        for theta in THETAS]
    at_best = gain(0.7854)
    statements = [
        are_positive("theta_0 = pi/4 compacts most, d_max = R/5",
                     [Estimate.of(at_best - gain(theta)) for theta in THETAS if theta != 0.7854],
                     "gain of 30 taps at pi/4 less that at " + ", ".join(
                         f"{theta / np.pi:.4g} pi" for theta in THETAS if theta != 0.7854) + ": ",
                     name="paired t-tests"),
        is_positive("a very small theta_0 decompacts", Estimate.of(-gain(THETAS[0])),
                    "fall of Phi_c in 30 taps at pi/32: ")]
    for step, name in ((STEPS[0], "a very small"), (STEPS[-1], "a large")):
        statements.append(is_positive(
            f"{name} d_max freezes the bed",
            Estimate.of(np.abs(at_best) - np.abs(gain(0.7854, step))),
            f"size of the change in 30 taps, at d_max = 0.1 less at {step:g}: ",
            name="paired t-test"))
    gaussian = curves[0.7854, 0.1, "gaussian"]
    for (_, _, law), curve in list(curves.items())[-2:]:
        statements.append(is_within(
            f"the width of the law matters, not its form: {law} (0.002)",
            Estimate.of(curve[30] - gaussian[30]), 0.002,
            f"Phi_c at tap 30, {law} less Gaussian: "))
    text = table(["10^4 (Phi_c(30) - Phi_c(0)); sweeps a tap, at theta_0"] +
                 [f"d_max = {step:g} d" for step in STEPS], rows)
    return text + f"\n\nPhi_c(0) = {at(gaussian, 0)}.", statements


def steps_of(curve, found):
    """The mean of each step's last taps, [step][realization]."""
    return [window(curve, int(first), int(last))
            for first, last in zip(found["first_tap"], found["last_tap"])]


def hysteresis(run):
    found = next(iter(run.analyse("hysteresis", "--observable", "corrected_fraction", "--last",
                                  40).values()))
    means = steps_of(run.curves("corrected_fraction")[0], found)
    names = ("up", "down", "up again")
    on = {(round(strength, 3), names[int(branch)]): mean for strength, branch, mean in
          zip(found["sqrt_epsilon"], found["branch"], means)}
    rows = [[f"{strength:.2f}"] + [Estimate.of(on[strength, name]).text() if (strength, name) in on
                                   else "" for name in names]
            for strength in sorted({key[0] for key in on})]
    loops = [found.estimate("area", place) for place in range(len(found["area"]))]
    statements = [
        is_positive("the way down lies above the first way up", loops[0], "area between them, "
                    "10^-3: ", digits=2, scale=1e3),
        is_within("the way up again is the way down, within a fifth of the first loop", loops[1],
                  0.2 * abs(loops[0].value), "area between them, 10^-3: ", 2, 1e3),
        is_positive("on the way down Phi_c falls with eps^(1/2) above 0.15",
                    Estimate.of(on[0.15, "down"] - on[0.35, "down"]),
                    "at 0.15 less 0.35: ", name="paired t-test"),
        is_positive("below 0.15 the way down still rises a bit more",
                    Estimate.of(on[0.05, "down"] - on[0.15, "down"]),
                    "at 0.05 less 0.15: ", name="paired t-test")]
    text = table(["eps^(1/2)"] + [f"Phi_c, {name}" for name in names], rows)
    return text + "\n\nAreas between branches, 10^-3: " + "; ".join(
        f"{names[int(later)]} less {names[int(earlier)]} {area.text(2, 1e3)}"
        for earlier, later, area in zip(found["earlier_branch"], found["later_branch"], loops)
    ) + ".", statements


def squared_change(curve, age, lag):
    return (curve[age + lag] - curve[age])**2


def log_ratio(first, second):
    """ln of the ratio of two means over the same realizations, by the jackknife."""
    n = first.size
    without = np.log((first.sum() - first) / (second.sum() - second))
    whole = np.log(first.mean() / second.mean())
    return Estimate(float(n * whole - (n - 1) * without.mean()),
                    float(np.sqrt((n - 1) * np.mean((without - without.mean())**2))), n - 1)


def p_exchanged(first, second):
    """Of two means of like distributions being so different: all exchanges within pairs. Exact for
    any distribution; squares are skewed, and Student's t says too often that they differ."""
    n = first.size
    chosen = (np.arange(2**n)[:, np.newaxis] >> np.arange(n)) & 1
    means = second.sum() + chosen @ (first - second)
    distance = np.abs(np.log(means / (first.sum() + second.sum() - means)))
    return float(np.mean(distance >= distance[-1] * (1 - 1e-12)))


def falls_with_age(paper, young, old):
    """Squared changes of the same realizations (16 at most) from two ages on."""
    ratio = log_ratio(young, old)
    return of_program(paper, f"ln of their ratio: {ratio.text(2)}",
                      f"exchanges within {young.size} pairs", p_exchanged(young, old),
                      young.mean() > old.mean(), f"a ratio of about exp({detectable(ratio):.1f}) "
                      "would have been found with 80 %")


def with_interval(found, name, place, unit=1.0):
    """A value with its 95 % interval, where there is one."""
    value, low, high = (unit * found[name + end][place] for end in ("", "_low_95", "_high_95"))
    return rounded(value, 3) + (f" ({rounded(low, 2)} to {rounded(high, 2)})"
                                if np.isfinite(low) else "")


def rounded(value, digits):
    """To so many digits, without an exponent where it has none by hand."""
    return f"{float(f'{value:.{digits}g}'):g}"


def would_be_found(what, size):
    return f"{what} {size:.3g} would have been found with 80 %" if np.isfinite(size) else \
        "none would have been found with 80 %"


def ageing(run):
    ages = [int(age) for age in run.scene["analyse"]["ageing"][0]["waiting_times"]]
    found = next(iter(run.analyse("ageing", "--observable", "mean_height", "--waiting-times",
                                  ",".join(map(str, ages))).values()))
    curve, lags = run.curves("mean_height")[0], found["lag"]
    shown = [int(np.argmin(np.abs(lags - lag))) for lag in (1, 10, 32, 100, 316)]
    rows = [[str(age)] + [with_interval(found, "a", (i, j), 1e4) for j in shown] +
            [f"{found['misfit'][i]:.2f}"] for i, age in enumerate(ages)]
    statements = []
    for lag in (10, 100):
        for young, old in zip(ages, ages[1:]):
            statements.append(falls_with_age(
                f"A falls with age: from t_W = {young} to {old} at lag {lag}",
                squared_change(curve, young, lag), squared_change(curve, old, lag)))
    statements += [
        of_program("A falls with age, all ages and lags", found.notes["ageing_verdict"],
                   "`jostle analyse ageing`", found["ageing_p"], found["ageing_factor"] < 1,
                   would_be_found("a factor of", found["ageing_detectable"])),
        of_program("the ages collapse on eq. 6", found.notes["collapse_verdict"],
                   "`jostle analyse ageing`", found["collapse_p"], False,
                   would_be_found("a change of B by a factor of", found["collapse_detectable"]))]
    head = "Not in the paper (V: the variance of the change over realizations):"
    beyond = "\n".join([head, ""] + [
        f"- {what}: {found.notes[note]}" for what, note in (
            ("V and age", "fluctuation_verdict"),
            ("A = F(t/t_W^mu)", "mu_verdict"),
            ("A = F(ln(t_W + t)/ln t_W)", "logarithmic_collapse_verdict"),
            ("V = F(t/t_W^mu)", "v_mu_verdict"),
            ("V = F(ln(t_W + t)/ln t_W)", "v_logarithmic_collapse_verdict"))])
    measured = table(["t_W"] + [f"10^4 A, lag {int(lags[j])}" for j in shown] +
                     ["misfit of eq. 6"], rows)
    return f"{measured}\n\n{beyond}", statements
