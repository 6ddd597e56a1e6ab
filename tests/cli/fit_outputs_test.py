"""One fit in every output of jostle fit: the law that leads, its values, errors and intervals."""

import html
import json
import math
import re
import unittest
from random import Random

from support import BAD_INPUT, SOURCE, UNFOLDED, Case, some

ROW = re.compile(r"^  (\S+) +(\S+) +(no limit|[<>] \S+|\S+ to \S+) +(identified|wide|only a lower limit|"
                 r"only an upper limit|not identifiable|unfinished)$", re.M)
CELLS = re.compile(r"<tr><td>([^<]*)</td><td>[^<]*</td><td>([^<]*)</td><td>([^<]*)</td><td>[^<]*</td></tr>")


def hyperbola(t):
    return 0.574 - 0.02 / (1 + 0.02 * t)


def line_in_ln_t(t):
    return 0.54 + 0.004 * math.log(t)


def two_times(t):
    return 0.6 - 0.02 * math.exp(-t / 8) - 0.01 * math.exp(-t / 60)


def stretched(t):
    return 0.6 - 0.05 * math.exp(-(t / 25) ** 0.6)


def limits(interval):
    low, high = interval
    if low is None and high is None:
        return "no limit"
    if high is None:
        return f"> {low:.5g}"
    if low is None:
        return f"< {high:.5g}"
    digits = next(n for n in range(5, 18) if n == 17 or f"{low:.{n}g}" != f"{high:.{n}g}")
    return f"{low:.{digits}g} to {high:.{digits}g}"


class WithEnsembles(Case):
    def ensemble(self, name, law, seed, realizations=4, level=1.0, noise=1e-3, taps=120, header=None):
        random = Random(seed)
        levels = [random.gauss(0, level * noise) for _ in range(realizations)]
        lines = [header or "t," + ",".join(f"r{r}" for r in range(realizations))]
        for t in range(1, taps + 1):
            lines.append(f"{t}," + ",".join(f"{law(t) + own + random.gauss(0, noise):.8g}" for own in levels))
        self.write("\n".join(lines) + "\n", name)

    def fits(self, name, *arguments):
        done = self.jostle("fit", name, "--realizations", *arguments, "--json", environment=UNFOLDED)
        return json.loads(done.stdout)["curves"][0]["fits"]


class OneFit(WithEnsembles):
    def check(self, name, model):
        done = self.jostle("fit", name, "--realizations", "--model", model, "--page", name + ".html",
                           environment=UNFOLDED)
        printed = ROW.findall(done.stdout)
        page = [tuple(html.unescape(cell) for cell in row)
                for row in CELLS.findall((self.folder / (name + ".html")).read_text())]
        self.assertEqual([row[:3] for row in printed], page)
        fit = self.fits(name, "--model", model)[0]
        reported = fit["reported"]["parameters"]
        self.assertEqual(fit["reported"]["model"], fit["limit"]["model"] if "limit" in fit else model)
        self.assertEqual([row[0] for row in printed[:len(reported)]],
                         list(reported) if "limit" in fit else fit["order"])
        for parameter, value, interval, _ in printed[:len(reported)]:
            found = reported[parameter]
            self.assertEqual(interval, limits(found["interval_95"]))
            closed = None not in found["interval_68"]
            if value == "-":
                self.assertIsNone(found["value"])
                self.assertIsNone(found["error"])
                self.assertTrue(not closed or found["identifiability"] == "not_identifiable")
            else:
                self.assertTrue(closed)
                self.assertRegex(value, r"\(\d+(\.\d+)?\)(e[+-]\d+)?$|\(\+[0-9.e+-]+/-[0-9.e+-]+\)$")
                self.assertGreater(found["error"], 0)
                half = (found["interval_68"][1] - found["interval_68"][0]) / 2
                self.assertAlmostEqual(found["half_width_68"], half, delta=1e-9 * half)
        return "limit" in fit

    def test_terminal_page_and_json_lead_with_one_law_and_its_numbers(self):
        at_limit = 0
        cases = [(law, model) for law, models in (
            (hyperbola, ("inverse_log", "kww")), (line_in_ln_t, ("inverse_log", "kww", "two_exponentials")),
            (two_times, ("two_exponentials", "inverse_log")), (stretched, ("kww", "two_exponentials")))
            for model in models]
        cases = list(enumerate(cases + 4 * [(hyperbola, "inverse_log")]))
        for seed, (law, model) in some(cases[:9], 4) + some(cases[9:], 2):
            with self.subTest(law=law.__name__, model=model, seed=seed):
                name = f"{law.__name__}_{model}_{seed}.csv"
                self.ensemble(name, law, seed)
                at_limit += self.check(name, model)
        self.assertGreaterEqual(at_limit, 2)

    def test_errors_are_given_only_where_a_column_gives_them(self):
        self.ensemble("a.csv", stretched, 1)
        self.assertFalse(self.fits("a.csv", "--model", "kww")[0]["sigma_given"])

    def test_parameters_have_the_units_of_the_heading(self):
        self.ensemble("a.csv", stretched, 1, header="Time [min]," + ",".join(f"r{r} [mm]" for r in range(4)))
        done = self.jostle("fit", "a.csv", "--realizations", "--model", "kww", "--page", "a.html",
                           environment=UNFOLDED)
        self.assertRegex(done.stdout, r"(?m)^  units: rho_inf, rho_0 in mm; tau in min$")
        page = (self.folder / "a.html").read_text()
        for name, unit in (("rho_inf", "mm"), ("tau", "min"), ("beta", "1")):
            self.assertIn(f"<tr><td>{name}</td><td>{unit}</td>", page)

    def test_a_fitted_law_is_no_realization(self):
        self.ensemble("a.csv", stretched, 1)
        rows = (self.folder / "a.csv").read_text().splitlines()
        for law in ("inverse_log", "kww", "own"):
            with self.subTest(law):
                self.write("\n".join([rows[0] + "," + law] + [row + ",0.5" for row in rows[1:]]) + "\n", "b.csv")
                fit = self.fits("b.csv", "--model", "kww")[0]
                self.assertEqual(fit, self.fits("a.csv", "--model", "kww")[0])
                told = self.jostle("fit", "b.csv", "--realizations", "--model", "kww", environment=UNFOLDED).stdout
                self.assertIn(f"Column 6 ({law}) is a fitted law and is not used.", told)

    def test_a_law_in_ln_x_is_refused_where_realizations_have_gaps(self):
        self.ensemble("a.csv", lambda t: t ** -1.3, 1, noise=1e-5)
        rows = (self.folder / "a.csv").read_text().splitlines()
        rows[5] = rows[5].rsplit(",", 1)[0] + ","
        self.write("\n".join(rows) + "\n", "a.csv")
        done = self.jostle("fit", "a.csv", "--realizations", "--model", "power_law", expect=BAD_INPUT,
                           environment=UNFOLDED)
        self.assertIn("--gaps drop-row", done.stderr)
        dropped = self.fits("a.csv", "--model", "power_law", "--gaps", "drop-row")[0]["parameters"]["s"]
        self.assertAlmostEqual(dropped["value"], 1.3, delta=0.1)

    def test_errors_from_resamples_that_differ_are_remarked_on(self):
        remarked = "Errors from resamples and from profiles differ by more than 25 % (half widths at 68 %)"
        self.ensemble("a.csv", lambda t: 0.62 - 0.06 / (1 + 0.5 * math.log1p(t / 10)), 3, realizations=6)
        for model in ("two_exponentials", "inverse_log"):
            fit = self.fits("a.csv", "--model", model, "--resample", "jackknife")[0]
            ratios = [found["resampled_error"] / found["error"] for found in fit["parameters"].values()
                      if found["error"] and found["resampled_error"]]
            differ = any(max(ratio, 1 / ratio) > 1.25 for ratio in ratios)
            self.assertEqual(any(remarked in remark for remark in fit["remarks"]), differ, (model, ratios))


class LawsOfManyParameters(Case):
    def test_their_fits_end_and_say_how(self):
        rows = [f"{t},{0.6 - 0.02 * math.exp(-t / 8) + 1e-4 * math.sin(7 * t * t)}" for t in range(1, 301)]
        self.write("t,X\n" + "\n".join(rows) + "\n", "a.csv")
        for terms in (29,):
            with self.subTest(terms=terms):
                law = "+".join(f"a{i}*exp(-t/b{i})" for i in range(terms))
                start = ",".join(f"a{i}=1,b{i}={i + 1}" for i in range(terms))
                fit = json.loads(self.jostle("fit", "a.csv", "--law", law, "--start", start, "--json").stdout)
                fit = fit["curves"][0]["fits"][0]
                allowed = 2e9 / (300 * (2 * terms) ** 2)
                self.assertLess(fit["total_evaluations"], allowed + 10 * (2 * terms + 1))
                self.assertTrue(any("limit of evaluations (" in remark and "for 300 points" in remark
                                    for remark in fit["remarks"]))

    def test_a_noisy_constant_has_consistent_intervals(self):
        for points in (60, 200):
            curve = str(SOURCE / f"tests/data/fits/constant_{points}.csv")
            fits = json.loads(self.jostle("fit", curve, "--model", "all", "--json").stdout)["curves"][0]["fits"]
            for fit in fits:
                for name, found in fit["parameters"].items():
                    with self.subTest(points=points, model=fit["model"], parameter=name):
                        self.require_consistent(found)

    def require_consistent(self, found):
        narrow, wide = (
            (-math.inf if low is None else low, math.inf if high is None else high)
            for low, high in (found["interval_68"], found["interval_95"]))
        self.assertTrue(wide[0] <= narrow[0] <= narrow[1] <= wide[1])
        if found["value"] is not None:
            self.assertTrue(narrow[0] <= found["value"] <= narrow[1])
        if found["half_width_68"] is not None:
            self.assertGreaterEqual(found["half_width_68"], 0)


if __name__ == "__main__":
    unittest.main()
