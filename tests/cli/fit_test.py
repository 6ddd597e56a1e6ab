"""jostle fit: measured curves, for people and for programs."""

import json
import math
import statistics
import unittest
from random import Random

from support import BAD_INPUT, OK, SOURCE, UNFOLDED, Case

TRUTH = {"X_inf": 0.64, "dX": 0.056, "B": 0.3, "tau": 10.0}


def inverse_log(t):
    p = TRUTH
    return p["X_inf"] - p["dX"] / (1 + p["B"] * math.log1p(t / p["tau"]))


def rough(t):
    """A few 1e-5 of scatter, without a random number."""
    return 3e-5 * math.sin(1.0 + 17.0 * t * t)


class WithCurve(Case):
    """With the points of a curve that follows an inverse log."""

    def setUp(self):
        super().setUp()
        taps = sorted({round(1.2 ** k) for k in range(50)})
        self.rows = [(t, inverse_log(t) + rough(t)) for t in taps]

    def table(self, separator=",", header="t,X\n", sigma=None):
        lines = []
        for t, x in self.rows:
            cells = [repr(t), repr(x)] + ([repr(sigma)] if sigma else [])
            lines.append(separator.join(cells))
        return "# measured by nobody\n" + header + "\n".join(lines) + "\n"

    def fit_json(self, *arguments, expect=OK):
        return json.loads(self.jostle("fit", *arguments, "--json", expect=expect).stdout)


class Measured(WithCurve):
    def test_a_table_of_two_columns_gives_its_law_back(self):
        self.write(self.table(), "data.csv")
        fit = self.fit_json("data.csv", "--model", "inverse_log")["curves"][0]["fits"][0]
        self.assertEqual(fit["points"], len(self.rows))
        self.assertFalse(fit["sigma_given"])
        for name, value in TRUTH.items():
            found = fit["parameters"][name]
            self.assertLess(abs(found["value"] - value), 4 * found["standard_error"])
            low, high = found["interval_95"]
            self.assertTrue(low < found["value"] < high)

    def test_separators_and_errors_make_no_difference_to_the_law(self):
        self.write(self.table(), "a.csv")
        self.write(self.table("\t", "", sigma=3e-5), "b.txt")
        a = self.fit_json("a.csv", "--model", "kww")["curves"][0]["fits"][0]
        b = self.fit_json("b.txt", "--model", "kww")["curves"][0]["fits"][0]
        self.assertTrue(b["sigma_given"])
        for name in a["parameters"]:
            self.assertAlmostEqual(a["parameters"][name]["value"] / b["parameters"][name]["value"],
                                   1, places=6)
        self.assertAlmostEqual(a["residual_sum"] / (b["residual_sum"] * 9e-10), 1, places=6)

    def test_one_curve_does_not_choose_a_law(self):
        for sigma in (None, 3e-5):
            self.write(self.table(sigma=sigma, header="t,X,sigma\n" if sigma else "t,X\n"), "data.csv")
            curve = self.fit_json("data.csv")["curves"][0]
            self.assertEqual([fit["model"] for fit in curve["fits"]],
                             ["inverse_log", "two_exponentials", "kww"])
            self.assertFalse(curve["comparison"]["decided"])
            self.assertEqual(curve["comparison"]["laws"], {})
            text = self.jostle("fit", "data.csv").stdout
            self.assertIn("cannot decide: the choice of a law requires 3 independent realizations",
                          " ".join(text.split()))
            self.assertIn("X_inf - dX / (1 + B ln(1 + t/tau))", text)
            self.assertNotIn("AIC", text)

    def realizations(self, count, noise):
        """With levels of their own, of the inverse log."""
        random = Random(1)
        lines = ["t," + ",".join(f"r{m}" for m in range(count))]
        levels = [random.gauss(0, 1e-3) for _ in range(count)]
        for t, _ in self.rows:
            values = [inverse_log(t) + level + random.gauss(0, noise) for level in levels]
            lines.append(",".join(map(repr, [t, *values])))
        return "\n".join(lines) + "\n"

    def test_held_out_realizations_choose_the_true_law_or_none(self):
        for noise, decided in ((3e-5, True), (3e-2, False)):
            self.write(self.realizations(6, noise), "data.csv")
            comparison = self.fit_json("data.csv", "--realizations")["curves"][0]["comparison"]
            self.assertEqual(comparison["decided"], decided)
            self.assertEqual(comparison["realizations"], 6)
            laws = comparison["laws"]
            self.assertEqual(set(laws), {"inverse_log", "two_exponentials", "kww"})
            self.assertFalse(laws["inverse_log"]["worse"])
            text = " ".join(self.jostle("fit", "data.csv", "--realizations").stdout.split())
            if decided:
                self.assertEqual(comparison["leading"], "inverse_log")
                self.assertEqual(comparison["candidates"], ["inverse_log"])
                self.assertTrue(laws["kww"]["worse"] and laws["kww"]["p"] < 0.05)
                self.assertIn("verdict inverse_log predicts held-out realizations better than", text)
            else:
                self.assertRegex(text, "verdict undecided: .* predict held-out realizations equally well, within the")
                self.assertRegex(text, r"asymptote .*\(95 %, over (all laws|the laws that are not rejected)\)")

    def test_a_range_and_a_fixed_parameter_are_kept(self):
        self.write(self.table(), "data.csv")
        curve = self.fit_json("data.csv", "--model", "inverse_log", "--range", "5:900", "--fix",
                              "tau=10")["curves"][0]
        self.assertTrue(5 <= curve["range"][0] and curve["range"][1] <= 900)
        tau = curve["fits"][0]["parameters"]["tau"]
        self.assertEqual((tau["value"], tau["identifiability"]), (10.0, "fixed"))
        self.assertEqual(curve["fits"][0]["free_parameters"], 3)

    def test_the_curve_is_written_beside_its_fits(self):
        self.write(self.table(), "data.csv")
        self.jostle("fit", "data.csv", "--csv", "out.csv")
        lines = (self.folder / "out.csv").read_text().splitlines()
        self.assertEqual(lines[0], "t,X,inverse_log,two_exponentials,kww")
        self.assertEqual(len(lines), len(self.rows) + 1)
        t, x, law = map(float, lines[5].split(",")[:3])
        self.assertEqual((t, x), self.rows[4])
        self.assertLess(abs(law - x), 2e-4)

    def test_several_laws_compete_by_name(self):
        self.write(self.realizations(4, 1e-4), "data.csv")
        for words in (("--model", "kww,inverse_log"), ("--model", "kww", "--model", "inverse_log"),
                      ("--model", "kww,inverse_log,kww")):
            with self.subTest(words=words):
                curve = self.fit_json("data.csv", "--realizations", *words)["curves"][0]
                self.assertEqual([fit["model"] for fit in curve["fits"]], ["kww", "inverse_log"])
                self.assertIn("comparison", curve)
        self.assertIn("--model kwv: there is none",
                      self.jostle("fit", "data.csv", "--model", "inverse_log,kwv", expect=BAD_INPUT).stderr)

    def test_the_errors_of_a_mean_are_written_and_read_back(self):
        self.write(self.realizations(5, 1e-3), "data.csv")
        self.jostle("fit", "data.csv", "--realizations", "--model", "kww", "--csv", "out.csv")
        lines = [line.split(",") for line in (self.folder / "out.csv").read_text().splitlines()]
        self.assertEqual(lines[0], ["t", "X", "sigma", "kww"])
        rows = [[float(field) for field in line.split(",")]
                for line in (self.folder / "data.csv").read_text().splitlines()[1:]]
        variance = sum(statistics.variance(row[1:]) for row in rows) / len(rows)
        for line in lines[1:]:
            self.assertAlmostEqual(float(line[2]) / (variance / 5) ** 0.5, 1, places=9)
        chi2 = sum(((float(x) - float(law)) / float(sigma)) ** 2 for _, x, sigma, law in lines[1:])
        fit = self.fit_json("data.csv", "--realizations", "--model", "kww")["curves"][0]["fits"][0]
        self.assertAlmostEqual(chi2 / fit["residual_sum"], 1, places=6)

    def test_a_curve_that_remembers_for_too_long_has_no_errors_and_a_remedy(self):
        lines = ["t,X"] + [f"{t},{x + 1e-3 * math.cos(t / 900)}" for t, x in self.rows]
        self.write("\n".join(lines) + "\n", "data.csv")
        told = self.jostle("fit", "data.csv", "--model", "kww", environment=UNFOLDED).stdout
        self.assertIn("no errors, because the residuals are correlated for too long", told)
        self.assertNotIn("Student's t of", told)
        self.assertIn("--independent gives errors", told)
        self.assertNotIn("--independent", self.jostle("fit", "data.csv", "--model", "kww", "--independent").stdout)

    def test_bad_input_is_named(self):
        self.write(self.table(), "data.csv")
        self.write("t,X\n1,2\n2,three\n", "words.csv")
        self.write("1,2\n2,3,4\n", "ragged.csv")
        self.write("1,2\n2,inf\n3,3\n4,5\n5,6\n", "inf.csv")
        self.write("1,2\n2,3\n", "short.csv")
        for arguments, message in (
                (["words.csv"], "line 3"),
                (["ragged.csv"], "line 2"),
                (["inf.csv"], 'line 2, column 2 (X): "inf" is not a number'),
                (["short.csv", "--model", "kww"], "cannot determine 4 parameters"),
                (["data.csv", "--model", "inverse"], "inverse_log"),
                (["data.csv", "--range", "5"], "FIRST:LAST"),
                (["data.csv", "--range", "a:b"], "FIRST:LAST"),
                (["data.csv", "--fix", "tau"], "NAME=NUMBER"),
                (["data.csv", "--model", "kww", "--fix", "B=1"], "no parameter B"),
                (["data.csv", "--observable", "mean_height"],
                 "data.csv: not a results file, but a text file, which has one curve: leave --observable out"),
                (["data.csv", "--sweep-point", "0"], "which has one curve: leave --sweep-point out")):
            with self.subTest(arguments=arguments):
                result = self.jostle("fit", *arguments, expect=BAD_INPUT)
                self.assertIn(message, result.stderr + result.stdout)


class Files(Case):
    """Measured curves as experiments and other programs write them."""

    def setUp(self):
        super().setUp()
        for path in (SOURCE / "tests/data/measured").glob("*.csv"):
            (self.folder / path.name).write_bytes(path.read_bytes())

    def curve(self, *arguments):
        done = self.jostle("fit", *arguments, "--model", "inverse_log", "--json")
        return json.loads(done.stdout)["curves"][0]

    def parameters(self, *arguments):
        return self.curve(*arguments)["fits"][0]["parameters"]

    def test_columns_go_by_their_names(self):
        named = self.parameters("v_named.csv")
        self.assertAlmostEqual(named["X_inf"]["value"], 0.6322, delta=0.00005)
        self.assertEqual(self.parameters("v_sigma_first.csv"), named)
        index = self.curve("v_index.csv")
        self.assertFalse(index["fits"][0]["sigma_given"])
        self.assertEqual(index["notes"],
                         ["Column 1 (no name) is an index and is not used.",
                          "One curve: its errors do not contain the scatter between experiments."])
        self.assertEqual(self.curve("v_named.csv")["notes"],
                         ["One curve: its errors contain the scatter between experiments only if sigma does."])
        self.assertEqual(self.curve("v_index.csv", "--independent")["notes"], index["notes"][:1])
        self.assertLess(abs(index["fits"][0]["parameters"]["X_inf"]["value"] - 0.6322), 0.002)
        real = self.curve("real_index.csv", "--realizations")
        self.assertEqual(real["fits"][0]["realizations"], 4)
        self.assertEqual(real["fits"], self.curve("real.csv", "--realizations")["fits"])

    def test_what_fit_wrote_is_fitted_alike(self):
        self.jostle("fit", "v_named.csv", "--csv", "out.csv")
        self.assertEqual(self.parameters("out.csv"), self.parameters("v_named.csv"))
        self.jostle("fit", "real.csv", "--realizations", "--csv", "mean.csv")
        mean = self.curve("mean.csv")
        self.assertEqual(mean["fits"][0]["points"], 200)
        self.assertEqual(len(mean["notes"]), 4)  # a column per law, one curve

    def test_line_ends_and_dividers_change_nothing(self):
        text = (self.folder / "real.csv").read_text()
        known = self.curve("real.csv", "--realizations")["fits"]
        for name, other in (("cr", text.replace("\n", "\r")), ("crlf", text.replace("\n", "\r\n")),
                            ("bom", "\ufeff" + text), ("semicolons", text.replace(",", ";")),
                            ("tabs", text.replace(",", "\t")), ("blanks", text.replace(",", "  ")),
                            ("quotes", text.replace("t,r0", '"t","r0"'))):
            with self.subTest(name):
                (self.folder / "other.csv").write_bytes(other.encode())
                self.assertEqual(self.curve("other.csv", "--realizations")["fits"], known)

    def test_gaps_use_the_other_realizations(self):
        lines = (self.folder / "real.csv").read_text().splitlines()
        for i in range(5, 200, 10):
            cells = lines[i].split(",")
            cells[1 + i % 4] = ("", "NaN")[i % 20 // 10]
            lines[i] = ",".join(cells)
        self.write("\n".join(lines), "gaps.csv")
        others = self.curve("gaps.csv", "--realizations", "--resample", "jackknife")
        self.assertEqual(others["fits"][0]["points"], 200)
        self.assertIn("20 of 800 values are missing", others["notes"][0])
        dropped = self.curve("gaps.csv", "--realizations", "--gaps", "drop-row")
        self.assertEqual(dropped["fits"][0]["points"], 180)
        whole = self.parameters("real.csv", "--realizations")
        for name, found in others["fits"][0]["parameters"].items():
            self.assertLess(abs(found["value"] - whole[name]["value"]), whole[name]["error"])
            self.assertLess(0.5, found["error"] / whole[name]["error"])
            self.assertLess(found["error"] / whole[name]["error"], 2)
            self.assertLess(0.5, found["resampled_error"] / found["error"])
            self.assertLess(found["resampled_error"] / found["error"], 2)
        self.assertLessEqual(others["fits"][0]["error_dof"], 3)
        text = self.jostle("fit", "gaps.csv", "--realizations").stdout
        self.assertIn("note       20 of 800 values are missing", text)

    def test_independent_rows_have_no_memory(self):
        rows, state = [], 0.0
        for t in range(1, 200):
            state = 0.9 * state + math.sin(1.0 + 17.0 * t * t)
            rows.append(f"{t},{inverse_log(t) + 1e-4 * state!r}")
        self.write("t,X\n" + "\n".join(rows), "walk.csv")
        self.assertGreater(self.curve("walk.csv")["fits"][0]["memory"], 0)
        independent = self.curve("walk.csv", "--independent")["fits"][0]
        self.assertEqual((independent["memory"], independent["effective_points"], independent["error_factor"]),
                         (0, 199, 1))

    def test_figures_show_the_data_and_the_fitted_laws(self):
        for name, option, caption in (("v_named.csv", (), "bars are the errors given"),
                                      ("v_index.csv", (), "Measured values (points) and"),
                                      ("real.csv", ("--realizations",), "Mean over 4 realizations")):
            with self.subTest(name):
                folder = self.folder / name.removesuffix(".csv")
                done = self.jostle("fit", name, *option, "--model", "inverse_log", "--figures", folder)
                self.assertIn("1 figure, each as SVG and PDF", done.stdout)
                self.assertEqual({path.name for path in folder.iterdir()},
                                 {f"fits-of-x.{kind}" for kind in ("csv", "json", "py", "svg", "pdf")})
                text = (folder / "fits-of-x.json").read_text()
                self.assertIn(caption, text)
                self.assertIn("inverse logarithm", text)
                self.assertNotIn("taps", text)
                head = (folder / "fits-of-x.csv").read_text().splitlines()[0]
                self.assertTrue(head.startswith("panel,series,t,X | "), head)
                again = self.jostle("fit", name, *option, "--figures", folder, expect=BAD_INPUT)
                self.assertIn("exists and is kept", again.stderr)

    def test_figures_draw_all_points_or_give_their_number(self):
        for n in (60, 500):
            rows = [f"{t},{0.6 - 0.05 * math.exp(-((t / 40) ** 0.6)) + 1e-4 * math.sin(17 * t)}" for t in range(1, n + 1)]
            (self.folder / f"of_{n}.csv").write_text("\n".join(["t,X", *rows]) + "\n")
            self.jostle("fit", f"of_{n}.csv", "--model", "kww", "--figures", f"of_{n}")
            rows = (self.folder / f"of_{n}/fits-of-x.csv").read_text().splitlines()
            drawn = sum(row.split(",")[1] == "data" for row in rows[1:])
            caption = (self.folder / f"of_{n}/fits-of-x.json").read_text()
            self.assertEqual(drawn == n, n == 60)
            self.assertEqual(caption.count(f" {drawn} of {n} points are drawn."), 0 if drawn == n else 2)  # both panels

    def test_a_page_shows_figure_parameters_and_notes(self):
        name = "<b>&.csv"
        (self.folder / name).write_bytes((self.folder / "v_index.csv").read_bytes())
        self.jostle("fit", name, "--model", "inverse_log", "--page", "page.html")
        page = (self.folder / "page.html").read_text()
        self.assertIn("<h1>&lt;b&gt;&amp;.csv</h1>", page)
        self.assertNotIn("<b>", page)
        self.assertIn("Column 1 (no name) is an index and is not used.", page)
        self.assertIn('src="data:image/svg+xml;base64,', page)
        for parameter in ("X_inf", "dX", "B", "tau"):
            self.assertIn(f"<td>{parameter}</td>", page)
        self.assertIn("0.6327(10)", page)
        self.assertNotIn("<script", page)
        for arguments in ((name, "--page", "page.html"), (name, "--page", name, "--force")):
            self.jostle("fit", *arguments, expect=BAD_INPUT)

    def test_options_without_sense_are_refused(self):
        for arguments, message in (
                (["real.csv", "--gaps", "drop-row"], "add --realizations"),
                (["real.csv", "--realizations", "--independent"], "only to a single curve"),
                (["real.csv", "--realizations", "--gaps", "interpolate"], "--gaps"),
                (["real.csv"], "where realizations are asked for, t and a column of any name each")):
            with self.subTest(arguments=arguments):
                done = self.jostle("fit", *arguments, expect=BAD_INPUT, environment=UNFOLDED)
                self.assertIn(message, done.stderr)
                self.assertEqual(done.stdout, "")


class Refusals(WithCurve):
    """No law fitted: the reason is an error."""

    CURVES = {"constant": "t,X\n" + "".join(f"{t},0.6\n" for t in range(9)),
              "short": "t,X\n1,0.5\n2,0.6\n",
              "before": "t,X\n" + "".join(f"{t},{0.6 + 0.01 * t}\n" for t in range(-9, -1))}

    def test_a_refused_fit_says_so_on_stderr(self):
        for name, text in self.CURVES.items():
            self.write(text, name + ".csv")
            for model in ("all", "kww", "power_law"):
                with self.subTest(curve=name, model=model):
                    done = self.jostle("fit", name + ".csv", "--model", model, expect=None)
                    if done.returncode == OK:
                        continue
                    self.assertEqual(done.returncode, BAD_INPUT)
                    self.assertEqual(done.stdout, "")
                    self.assertIn(f"{name}.csv: no law could be fitted\n", done.stderr)
                    listed = self.jostle("fit", name + ".csv", "--model", model, "--json", expect=BAD_INPUT)
                    self.assertEqual(listed.stderr, done.stderr)
                    for fit in json.loads(listed.stdout)["curves"][0]["fits"]:
                        self.assertIn(fit["refused"], done.stderr)

    def test_one_law_of_several_is_enough(self):
        self.write("t,X\n" + "".join(f"{t},{inverse_log(t)}\n" for t in (1, 3, 9, 27)), "four.csv")
        done = self.jostle("fit", "four.csv")
        self.assertIn("two_exponentials: no fit: 4 points", done.stdout)
        self.assertEqual(done.stderr, "")


class OwnLaw(WithCurve):
    """A formula of the user's own, on the curves of the law that it repeats."""

    LAW = ("--law", "Xi - d/(1 + B*log(1 + t/tau))", "--start", "Xi=0.6,d=0.1", "--start", "B=1,tau=3",
           "--bounds", "B=0:,tau=0:")

    def test_it_is_fitted_as_the_law_that_it_repeats(self):
        self.write(self.table(), "data.csv")
        fits = self.fit_json("data.csv", "--model", "inverse_log", *self.LAW, "--law-name", "mine")
        own, built_in = fits["curves"][0]["fits"]
        self.assertEqual((own["model"], own["formula"]), ("mine", self.LAW[1]))
        self.assertEqual(own["order"], ["Xi", "d", "B", "tau"])
        for mine, theirs in zip(own["order"], built_in["order"]):
            a, b = own["parameters"][mine], built_in["parameters"][theirs]
            self.assertAlmostEqual(a["value"] / b["value"], 1, places=8)
            self.assertEqual(a["identifiability"], b["identifiability"])
            for end in (0, 1):
                width = b["interval_95"][1] - b["interval_95"][0]
                self.assertLess(abs(a["interval_95"][end] - b["interval_95"][end]), 1e-5 * width)
        alone = self.fit_json("data.csv", *self.LAW)["curves"][0]["fits"]
        self.assertEqual([fit["model"] for fit in alone], ["own"])
        text = self.jostle("fit", "data.csv", *self.LAW).stdout
        self.assertIn("own: X = Xi - d/(1 + B*log(1 + t/tau))  [own law]", text)

    def test_a_fixed_parameter_needs_no_start(self):
        self.write(self.table(), "data.csv")
        own = self.fit_json("data.csv", "--law", "Xi - d/(1 + B*log(1 + t/tau))", "--start",
                            "Xi=0.6,d=0.1,B=1", "--fix", "tau=10", "--bounds", "B=0:")
        tau = own["curves"][0]["fits"][0]["parameters"]["tau"]
        self.assertEqual((tau["value"], tau["identifiability"]), (10.0, "fixed"))

    def test_a_law_without_a_free_parameter_has_no_errors(self):
        self.write(self.table(), "data.csv")
        text = self.jostle("fit", "data.csv", "--law", "Xi + d/t", "--start", "Xi=0.6,d=0.1", "--fix", "Xi=0.6", "--fix",
                           "d=0.1").stdout
        self.assertIn("own: all parameters fixed", text)
        self.assertIn("points; weights from ", text)
        self.assertNotIn("errors at 68 %", text)

    def test_what_is_wrong_is_named(self):
        self.write(self.table(), "data.csv")
        for arguments, message in (
                (["--law", "a*lgo(t)", "--start", "a=1"], "there is no function lgo; there are abs"),
                (["--law", "a*t + b", "--start", "a=1"], "the parameter b has no start"),
                (["--law", "a*t"], "the parameter a has no start"),
                (["--law", "a + b", "--start", "a=1,b=1"], "there is no t in it"),
                (["--law", "a*(t", "--start", "a=1"], "cannot be read"),
                (["--law", "a*t", "--start", "a=1,t=2"], "no parameter can be called t"),
                (["--law", "a*t", "--start", "a=1,a=2"], "a has two starts"),
                (["--law", "a*t", "--start", "a"], "--start a: not NAME=NUMBER"),
                (["--law", "a*t", "--start", "a=0x1"], "--start a=0x1: not NAME=NUMBER"),
                (["--law", "a*t + 0x1", "--start", "a=1"], "x1"),
                (["--law", "a*t", "--start", "a=1", "--bounds", "a=0x0:inf"], "not FIRST:LAST"),
                (["--law", "a*t", "--start", "a=1", "--bounds", "a"], "--bounds a: not NAME=LOWER:UPPER"),
                (["--law", "a*t", "--start", "a=1", "--bounds", "a=2:3"], "not between its bounds"),
                (["--law", "a*t", "--start", "a=1", "--fix", "q=2"], "no parameter q"),
                (["--law", "a*t", "--start", "a=1", "--law-name", "kww"], "cannot be called"),
                (["--law", "a*log(t - 3)", "--start", "a=1"], "not finite where it starts, at t = 1"),
                (["--law", ""], "an empty formula"),
                (["--start", "a=1"], "--law")):
            with self.subTest(arguments=arguments):
                result = self.jostle("fit", "data.csv", *arguments, expect=BAD_INPUT)
                self.assertIn(message, result.stderr + result.stdout)


if __name__ == "__main__":
    unittest.main()
