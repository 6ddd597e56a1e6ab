"""Figures 2 to 5 of Philippe & Bideau, and their moves: curves against taps, and the effects of
strength and settings."""
import itertools

import numpy as np

from page_text import are_steady, at, interval, parameters, table, window
from verdicts import (DISAGREES, UNDECIDED, Estimate, Statement, are_positive, is_positive,
                      is_within, is_zero, limits_text, of_interval, of_program, undecided)


def compaction(run):
    values, curves = run.values(), run.curves("bottom_fraction")
    last = len(curves[0]) - 1
    shown, end = [tap for tap in (0, 1, 10, 100, 1000, 10000) if tap <= last], (
        last * 9 // 10 + 1, last)
    fits = run.fits("bottom_fraction", "inverse_log")
    rows = [[f"{value:g}"] + [at(curve, tap) for tap in shown] +
            parameters(fit, ("X_inf", "B", "tau"))
            for value, curve, fit in zip(values, curves, fits)]
    early = [window(curve, 81, 120) - curve[1] for curve in curves]
    late = [window(curve, *end) - curve[1] for curve in curves]
    statements = [is_positive(f"Phi_b grows with taps at eps = {value:g}", Estimate.of(gain),
                              f"taps {end[0]} to {end[1]} less tap 1: ")
                  for value, gain in zip(values, late)]
    statements += [
        is_positive("slower for smaller eps: the gain of the first 100 taps",
                    Estimate.of(early[1] - early[0]), f"that of {values[1]:g} less that of "
                    f"{values[0]:g}: ", name="paired t-test"),
        is_positive(f"slower for smaller eps: the share of the gain of {last} taps made by tap 100",
                    Estimate.of(early[2] / late[2] - early[0] / late[0]),
                    f"that of {values[2]:g} less that of {values[0]:g}: ", digits=2,
                    name="paired t-test"),
        of_interval("X_inf may exceed 0.64 at small eps", *interval(fits[0], "X_inf"), above=0.64,
                    found=f"X_inf at {values[0]:g}"),
        greater("tau rises spectacularly at small eps", values, fits, "tau"),
        greater("X_inf is farther from what is reached at small eps", values, fits, "X_inf",
                [window(curve, *end).mean() for curve in curves]),
        exponential_in_strength(values, fits)]
    text = table(["eps"] + [f"Phi_b, tap {shown[0]}"] + [str(tap) for tap in shown[1:]] +
                 ["X_inf of the inverse log", "its B", "its tau"], rows)
    laws, compared = laws_of_height(run)
    return f"{text}\n\n{laws}", statements + compared


def greater(paper, values, fits, name, reached=(0.0, 0.0)):
    """A parameter, less what is reached (taken as known), is greater at the first strength than at
    the second: by their 95 % intervals."""
    first, second = (tuple(np.array(interval(fit, name)) - level)
                     for fit, level in zip(fits[:2], reached))
    what = f"{name} less Phi_b reached" if any(reached) else name
    if overlap(first, second):
        return undecided(paper, f"{what}: " + ", ".join(
            f"{limits_text(*ends)} at {value:g}" for value, ends in zip(values, (first, second))),
            "95 % intervals: they overlap or have no end")
    return of_interval(paper, *first, above=second[1],
                       found=f"{what} at {values[0]:g} (at {values[1]:g} at most {second[1]:.4g})")


def exponential_in_strength(values, fits):
    """B = B0 exp(c eps^(1/2)): a line through ln B, whose 95 % intervals are wide and not symmetric.
    It is refuted where no line passes through all three: of independent normal errors of ln B that
    happens to fewer than 1 % of exponentials, though one of three intervals misses in 14 %."""
    paper = "B is exponential in eps^(1/2)"
    found = ", ".join(f"{parameters(fit, ('B',))[0]} at {value:g}"
                      for value, fit in zip(values, fits))
    (x0, x1, x2), ends = np.sqrt(values), [np.array(interval(fit, "B")) for fit in fits]
    if not all(np.isfinite(end).all() and end[0] > 0 for end in ends):
        return undecided(paper, found, "95 % intervals: not all have two ends")
    share = (x1 - x0) / (x2 - x0)
    low, high = ((1 - share) * np.log(ends[0][k]) + share * np.log(ends[2][k]) for k in (0, 1))
    missed = np.log(ends[1][1]) < low or np.log(ends[1][0]) > high
    return Statement(paper, found, "a line through all three 95 % intervals of ln B (false alarms "
                     "below 1 %), which can only refute",
                     word=DISAGREES if missed else UNDECIDED)


def laws_of_height(run):
    """Eq. 4 and two exponentials, fitted to <Z> of each realization from tap 1 on."""
    laws = ("inverse_log_height", "two_exponentials")
    rows, statements = [], []
    for value, curve in zip(run.values(), run.curves("mean_height")):
        squares = [1e4 * np.array([run.residual(curve[:, m], law)
                                   for m in range(run.realizations)]) for law in laws]
        statements.append(is_positive(
            f"two exponentials fit <Z> reasonably well (ours: less than 1.5 times the mean square of "
            f"eq. 4's residuals) at eps = {value:g}", Estimate.of(1.5 * squares[0] - squares[1]),
            "1.5 times that of eq. 4 less theirs, 10^-4: ", digits=3))
        rows.append([f"{value:g}"] + [Estimate.of(of_law).text(3) for of_law in squares])
    return table(["eps", "10^4 mean square of the residuals of <Z>: eq. 4", "two exponentials"],
                 rows), statements


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
    line, unsteady = sweep.estimate("line_slope"), [
        f"{np.sqrt(value):.3f}" for value, state in zip(run.values(), states)
        if not state.startswith("reached")]
    of_sigma = [
        is_positive("sigma_Z rises with eps^(1/2)", line, "slope of a straight line: "),
        is_zero("sigma_Z is proportional to eps^(1/2)", sweep.estimate("line_intercept"),
                "at eps = 0 the line is at ")]
    statements += of_sigma if not unsteady else [
        undecided(each.paper, each.found, f"a steady state is not shown at {', '.join(unsteady)}")
        for each in of_sigma]
    text = table(["eps^(1/2)", "sigma_Z", "autocorrelation time, taps", "slope of the spectrum",
                  "of AR(1)", "p of their difference", "steady state"], rows)
    return text + (f"\n\nStraight line through sigma_Z: slope {line.text()}, at eps = 0 "
                   f"{sweep.estimate('line_intercept').text()}; of a straight line scattering as "
                   f"much p = {sweep['line_p']:.2g}."), statements


def bell(run):
    values, curves = np.sqrt(run.values()), run.curves("corrected_fraction")
    last, mean_of = len(curves[0]) - 1, run.scene["analyse"]["sweep"][0]["last"]
    ends = [end for end in (400, 700, 1000, 2000, 4000) if end <= last]
    windows = [(end - 99, end) for end in ends] + [(last - mean_of + 1, last)]
    rows = [[f"{value:.3f}", at(curve, 1)] +
            [Estimate.of(window(curve, *taps)).text() for taps in windows]
            for value, curve in zip(values, curves)]
    sweep = next(iter(run.analyse("sweep", "--observable", "corrected_fraction", "--last",
                                  mean_of).values()))
    steady = run.analyse("steady", "--observable", "corrected_fraction", "--last", last // 2)
    end = dict(zip(np.round(values, 3), (window(curve, *windows[-1]) for curve in curves)))
    statements = [
        maximum_of(sweep, "a bell: Phi_c has a maximum inside", "eps^(1/2)"),
        of_interval("its maximum lies between 0.1 and 0.2", sweep["maximum_at_low"],
                    sweep["maximum_at_high"], between=(0.1, 0.2), found="maximum at"),
        is_positive("its left side rises", Estimate.of(end[0.15] - end[0.05]),
                    "Phi_c at 0.15 less 0.05: ", name="paired t-test"),
        is_positive("its right side falls", Estimate.of(end[0.2] - end[0.4]),
                    "Phi_c at 0.20 less 0.40: ", name="paired t-test"),
        are_steady("its values are those of steady states", steady, "corrected_fraction",
                   [f"{value:.2f}" for value in values], (last - last // 2 + 1, last), 4000)]
    if last >= 4000:
        early, late = ({key: window(curve, *taps) for key, curve in zip(end, curves)}
                       for taps in ((901, 1000), (3901, 4000)))
        statements.append(is_positive(
            "0.15 comes nearer to 0.05 with more taps (ours, asked after a look)",
            Estimate.of((early[0.15] - early[0.05]) - (late[0.15] - late[0.05])),
            "Phi_c at 0.15 less 0.05, taps 901 to 1000 less 3901 to 4000: ", name="paired t-test"))
    header = [f"{first} to {end}" for first, end in windows]
    return table(["eps^(1/2)", "Phi_c after tap 1", "mean of taps " + header[0]] + header[1:],
                 rows), statements


def bell_and_stop(run):
    """Two strengths on the left of the bell, each relaxed to two eta, from the same beds."""
    etas, epsilons = run.scene["sweep"].values()
    points = list(itertools.product(etas, np.sqrt(epsilons)))
    curves, sweeps = (dict(zip(points, run.curves(name))) for name in
                      ("corrected_fraction", "sweeps"))
    (coarse, fine), (weak, strong) = etas, np.sqrt(epsilons)
    last, taps = len(curves[points[0]]) - 1, (0, 1, 10, 100, 300)
    end = (last - 99, last)
    ends = {point: window(curve, *end) for point, curve in curves.items()}
    rows = [[f"eps^(1/2) = {strength:.2f}, eta = {eta:g}"] +
            [at(curves[eta, strength], tap) for tap in taps] +
            [Estimate.of(ends[eta, strength]).text(), f"{np.mean(sweeps[eta, strength][1:]):.0f}"]
            for eta, strength in points]
    rises = {eta: ends[eta, strong] - ends[eta, weak] for eta in etas}
    known = {coarse: "known from pb4-bell", fine: "ours"}
    statements = [is_positive(
        f"the bell's left side rises, here after {last} taps, eta = {eta:g} ({known[eta]})",
        Estimate.of(rises[eta]), f"Phi_c at {strong:.2f} less {weak:.2f}: ", name="paired t-test")
        for eta in etas]
    changes = [Estimate.of(ends[fine, strength] - ends[coarse, strength])
               for strength in (weak, strong)]
    less = f"at {fine:g} less {coarse:g}: "
    statements += [is_within(
        f"a stop ten times finer leaves Phi_c as it is, at {strength:.2f} (ours: 0.005)", change,
        0.005, less) for strength, change in zip((weak, strong), changes)]
    statements.append(is_within(
        "a stop ten times finer leaves their difference as it is (ours: 0.005)",
        Estimate.of(rises[fine] - rises[coarse]), 0.005, less))
    statements += [is_zero(
        f"a stop ten times finer changes nothing at {strength:.2f} (ours, asked after a look)", change,
        less) for strength, change in zip((weak, strong), changes)]
    return table(["Phi_c, tap"] + [str(tap) for tap in taps] +
                 [f"mean of taps {end[0]} to {end[1]}", "sweeps per tap"], rows), statements


def maximum_of(sweep, statement, symbol):
    """The test of a sweep for a maximum inside."""
    found = f"{sweep.notes['maximum']}"
    if np.isfinite(sweep["maximum_at"]):
        found += f"; a parabola's is at {symbol} = {sweep['maximum_at']:.3g}"
    return of_program(statement, found, "two lines (Simonsohn 2018), which can only show it",
                      sweep["maximum_p"], True)


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
    rows = [[f"{theta / np.pi:.4g} pi", f"{step:g}", law,
             Estimate.of(1e4 * (curve[30] - curve[0])).text(0), f"{sweeps[theta, step, law][1:].mean():.0f}"]
            for (theta, step, law), curve in curves.items()]
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
    text = table(["theta_0", "d_max, diameters", "law", "10^4 (Phi_c(30) - Phi_c(0))", "sweeps per tap"], rows)
    return text + f"\n\nPhi_c(0) = {at(gaussian, 0)}.", statements


def steps_of(curve, found):
    """The mean of each step's last taps, [step][realization]."""
    return [window(curve, int(first), int(last))
            for first, last in zip(found["first_tap"], found["last_tap"])]


def hysteresis(run):
    last = run.scene["analyse"]["hysteresis"][0]["last"]
    found = next(iter(run.analyse("hysteresis", "--observable", "corrected_fraction", "--last",
                                  last).values()))
    means = steps_of(run.curves("corrected_fraction")[0], found)
    names = ("up", "down", "up again")
    on = {(round(strength, 3), names[int(branch)]): mean for strength, branch, mean in
          zip(found["sqrt_epsilon"], found["branch"], means)}
    rows = [[f"{strength:.2f}"] + [Estimate.of(on[strength, name]).text() if (strength, name) in on
                                   else "" for name in names]
            for strength in sorted({key[0] for key in on})]
    branches = whole_branches(found["branch"], found["sqrt_epsilon"], means)
    first, second = (area(*pair) for pair in zip(branches, branches[1:]))
    statements = [
        is_positive("the way down lies above the first way up", Estimate.of(first),
                    "area between them, 10^-3: ", digits=2, scale=1e3),
        are_positive("the way up again is the way down, within a fifth of the first loop",
                     [Estimate.of(0.2 * first + sign * second) for sign in (1, -1)],
                     f"area between them {Estimate.of(second).text(2, 1e3)}; a fifth of the first's "
                     "more, and less, 10^-3: ", 2, 1e3),
        is_positive("on the way down Phi_c falls with eps^(1/2) above 0.15",
                    Estimate.of(on[0.15, "down"] - on[0.35, "down"]),
                    "at 0.15 less 0.35: ", name="paired t-test"),
        is_positive("below 0.15 the way down still rises a bit more",
                    Estimate.of(on[0.05, "down"] - on[0.15, "down"]),
                    "at 0.05 less 0.15: ", name="paired t-test")]
    ends, nu = ends_of_branches(run)
    statements.append(is_positive("pores shrink on the way down (ours)", Estimate.of(nu[1] - nu[2]),
                                  "nu where it begins less where it ends: ", name="paired t-test"))
    return "\n\n".join([table(["eps^(1/2)"] + [f"Phi_c, {name}" for name in names], rows),
                        ends]), statements


def ends_of_branches(run):
    """Packings at the ends of branches, and nu there, [end][realization]."""
    taps, kept = run.scene["snapshots"]["taps"], run.structure(["pores", "profile"])
    nu, alpha = (np.array([packings[part][name] for packings in kept]).T
                 for part, name in (("pores", "nu"), ("profile", "alpha")))
    names = ("poured", "up to 0.40", "down to 0.05", "up again to 0.40")
    return table(["tap", "", "nu, sphere volumes", "10^3 alpha R"], [
        [str(tap), name, Estimate.of(nu[k]).text(), Estimate.of(alpha[k]).text(2, 1e3)]
        for k, (tap, name) in enumerate(zip(taps, names))]), nu


def turns(run):
    """One way up, turned back at several strengths: where the way down leads to denser beds."""
    tops = run.scene["sweep"]["zip"]["/protocol/0/ramp/dilate/sqrt_to"]
    tables = run.analyse("hysteresis", "--observable", "corrected_fraction", "--last", 40)
    rows, statements = [], []
    for top, curve, found in zip(tops, run.curves("corrected_fraction"), tables.values()):
        means, strengths = steps_of(curve, found), np.round(found["sqrt_epsilon"], 3)
        turn, first, end = int(np.argmax(strengths)), means[0], means[-1]
        change, gain = end - means[turn], means[turn] - curve[1]
        rows.append([f"{top:g}", Estimate.of(first).text(), Estimate.of(means[turn]).text(),
                     Estimate.of(end).text(), Estimate.of(change).text()])
        if top < 0.15:
            statements.append(are_positive(
                f"turned back at {top:g} a bed is nearly frozen (ours: the way down changes Phi_c by "
                "less than a fifth of what the way up gained from tap 1)",
                [Estimate.of(0.2 * gain + sign * change) for sign in (1, -1)],
                f"{Estimate.of(change).text()}; a fifth of the gain more, and less: "))
        elif top > 0.15:
            statements.append(is_positive(f"turned back at {top:g} a bed gains on the way down",
                                          Estimate.of(change), "Phi_c at 0.05 less at the turn: "))
    return table(["turned at eps^(1/2)", "Phi_c at 0.05, way up", "at the turn",
                  "at 0.05, way down", "gained on the way down"], rows), statements


def whole_branches(branch, strengths, means):
    """{strength: mean of each realization} of every branch; a turn belongs to both that meet there."""
    branches = [{} for _ in range(int(max(branch)) + 1)]
    for step, (number, strength) in enumerate(zip(branch, strengths)):
        branches[int(number)][round(strength, 3)] = means[step]
        if step + 1 < len(branch) and branch[step + 1] > number:
            branches[int(number) + 1][round(strength, 3)] = means[step]
    return branches


def area(earlier, later):
    """Between two branches over eps^(1/2), of each realization: the later less the earlier, by the
    trapezoidal rule over the strengths that both have."""
    shared = sorted(earlier.keys() & later.keys())
    return np.trapz([later[strength] - earlier[strength] for strength in shared], shared, axis=0)
