"""Damaged files and arguments that mean nothing: every failure is a JostleError with a message."""

import inspect
import json
import os
import pathlib
import reprlib
import shutil
import unittest
import unittest.mock

import h5py
import jostle
import numpy as np

from support import EVERY, PROGRAM, TINY, Case, changed, made

SMALL = changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}], realizations=2,
                sweep={"/protocol/0/tap/dilate": [0.02, 0.1]}, snapshots={"taps": [0, 40]})
SEAL = b"\njostle-sha256 " + b"0" * 64 + b"\n"  # read without verify, it needs only be there


def asked(results):
    """Everything that a Results can be asked for, as (name, question)."""
    yield "repr", lambda: repr(results)
    for name in sorted(name for name in dir(jostle.Results) if not name.startswith("_")):
        if name not in ("close", "verify", "digest", "file"):
            yield name, lambda name=name: called(getattr(results, name))
    yield "points", lambda: len(results.points)
    for name in sorted(name for name in dir(jostle.Point) if not name.startswith("_")):
        yield f"points[0].{name}", lambda name=name: called(getattr(results.points[0], name))
    yield "tables", lambda: [repr(results.tables[one]) for one in results.tables]


def called(member):
    """A member's value; a dataset's or a mapping's values are read."""
    if callable(member):
        needed = [one for one in inspect.signature(member).parameters.values()
                  if one.default is one.empty and one.kind is not one.VAR_POSITIONAL]
        member = member(*["mean_height" if one.name == "name" else "verbatim" for one in needed])
    if hasattr(member, "items") and not isinstance(member, dict):
        for _, value in member.items():
            np.asarray(value)
    return member


# Values put in the place of an attribute or a dataset of the file.
VALUES = {
    "words": "one", "not a number": np.nan, "negative": -1, "huge": 2 ** 62, "empty": np.zeros(0),
    "three numbers": np.array([1.0, 2.0, 3.0]), "a matrix": np.zeros((2, 3), int),
    "bytes that are not UTF-8": np.bytes_(b"\xff\xfe{"), "texts": np.array([b"a", b"b"], object),
}


def put(group, name, value):
    del group[name]
    kind = h5py.string_dtype() if isinstance(value, np.ndarray) and value.dtype == object else None
    group.create_dataset(name, data=value, dtype=kind)


class Damaged(Case):
    @classmethod
    def setUpClass(cls):
        cls.good = made(SMALL).with_name("with-tables.h5")
        shutil.copy(made(SMALL), cls.good)
        jostle.analyse(cls.good, "steady", "mean_height", last=40)
        jostle.fit(cls.good, "mean_height", model="kww")

    def setUp(self):
        super().setUp()
        shutil.copy(self.good, "good.h5")

    def places(self):
        """(path, attribute or None) of all that is in the file."""
        found = []
        with h5py.File("good.h5") as file:
            found += [("/", name) for name in file.attrs]

            def note(path, item):
                found.extend((path, name) for name in item.attrs)
                found.append((path, None))
            file.visititems(note)
        return found

    def damage(self, path, attribute, value):
        shutil.copy("good.h5", "bad.h5")
        with h5py.File("bad.h5", "r+") as file:
            if attribute is not None:
                del file[path].attrs[attribute]
                if value is not None:
                    file[path].attrs[attribute] = value
            elif value is None or isinstance(file[path], h5py.Group):
                del file[path]
            else:
                put(file[path].parent, path.rsplit("/", 1)[-1], value)
        with open("bad.h5", "ab") as file:
            file.write(SEAL)

    def ask(self, about):
        """Asks everything; returns how many questions were refused."""
        refused = 0
        try:
            results = jostle.open("bad.h5")
        except jostle.JostleError as error:
            self.assertIn("bad.h5", str(error))
            return 1
        with results:
            for name, question in asked(results):
                try:
                    question()
                except jostle.JostleError as error:
                    self.assertTrue(str(error).strip(), about)
                    refused += 1
                except Exception as error:
                    self.fail(f"{about}: {name}: {type(error).__name__}: {error}")
        return refused

    def test_a_good_file_answers_everything(self):
        shutil.copy("good.h5", "bad.h5")
        with jostle.open("bad.h5") as results:
            for name, question in asked(results):
                with self.subTest(name):
                    try:
                        question()
                    except jostle.NotThere:
                        self.assertIn(name, ("contacts", "points[0].contacts"))  # data of grains alone

    def test_every_place_of_a_file_in_turn(self):
        kinds = [*VALUES.items(), ("gone", None)]
        refused = 0
        places = self.places()
        # Some of them: the kinds of damage come round in another order at every axis.
        for number, (path, attribute) in enumerate(places[::13 if EVERY else 29]):
            what, value = kinds[number % len(kinds)]
            about = f"{path}{'' if attribute is None else '@' + attribute} becomes {what}"
            try:
                self.damage(path, attribute, value)
            except (KeyError, OSError, RuntimeError, TypeError, ValueError):
                continue  # HDF5 itself refuses to make it
            refused += self.ask(about) > 0
        self.assertGreater(len(places), 300)
        self.assertGreater(refused, 5)

    def test_places_that_all_else_depends_on(self):
        kinds = [("words", "gone"), ("empty", "not a number"), ("three numbers", "texts")]
        for number, (path, attribute) in enumerate((("/", "jostle_format"), ("scene/resolved", None), ("scene", "realizations"),
                                ("provenance", "shard"), ("provenance", "state"), ("sweep/label", None),
                                ("sweep/point_0000", "widths"), ("sweep/value", None),
                                ("observables/point_0000/status", None))):
            for what in kinds[number % len(kinds)]:
                value = VALUES.get(what)
                about = f"{path}@{attribute} becomes {what}"
                with self.subTest(about):
                    self.damage(path, attribute, value)
                    self.ask(about)

    def test_a_byte_of_the_scene_s_text(self):
        with h5py.File("good.h5") as file:
            text = file["scene/resolved"][()].decode()
        for place in range(0, len(text), 411):
            self.damage("scene/resolved", None, text[:place] + "\x01" + text[place + 1:])
            self.ask(f"byte {place} of the scene")
        for text in ('{"name": NaN', "[]", "7", '"scene"', "{}", '{"name": 3}', "[" * 5000):
            self.damage("scene/resolved", None, text)
            with self.subTest(text[:20]), jostle.open("bad.h5") as results, \
                    self.assertRaisesRegex(jostle.ResultsError, "bad.h5: .*damaged"):
                results.scene

    def test_a_layout_that_is_none_is_named(self):
        for value, shown in (("one", "one"), (np.nan, "nan"), (3, "3"), (1.5, "1.5"), (True, "True")):
            self.damage("/", "jostle_format", value)
            with self.subTest(value), self.assertRaisesRegex(jostle.ResultsError, f"of layout {shown}: "):
                jostle.open("bad.h5")

    def test_bytes_of_a_file_at_random(self):
        rng = np.random.default_rng(20260101)
        good = pathlib.Path("good.h5").read_bytes()
        for _ in range(20):
            bad = bytearray(good)
            # One of the first bytes, where HDF5 keeps its structures; not of its signature.
            for place in rng.integers(8, min(len(bad), 20000), 3):
                bad[place] ^= 1 << int(rng.integers(8))
            pathlib.Path("bad.h5").write_bytes(bad)
            with self.assertRaisesRegex(jostle.ResultsError, "checksum is wrong"):
                jostle.open("bad.h5", verify=True)

    def test_a_closed_file_says_so(self):
        results = jostle.open("good.h5")
        point, columns, tables = results.points[0], results.points[0].mean, results.tables
        results.close()
        for question in (lambda: results.scene_text("verbatim"), lambda: point.tap,
                         lambda: columns["mean_height"], lambda: point.series, lambda: results.run_id,
                         lambda: tables[next(iter(tables))]):
            with self.assertRaises(jostle.ResultsError):
                question()
        with self.assertRaisesRegex(jostle.ResultsError, "good.h5: closed"):
            columns["mean_height"]


ITSELF = {"name": "itself"}
ITSELF["sweep"] = ITSELF
CIRCLE = []
CIRCLE.append(CIRCLE)
DEEP = 0
for _ in range(5000):
    DEEP = [DEEP]
NOTHING = object()


class Unreadable(os.PathLike):
    def __fspath__(self):
        return 5


class Arguments(Case):
    """(function, arguments, keywords): none can be meant, and none leaves a file."""

    TABLE = [
        *(("open", [path], {}) for path in (None, 5, NOTHING, 1.5, [], "a\0.h5", b"a\0", "", "none.h5", ".",
                                             "\ud800.h5", Unreadable(), "x" * 5000)),
        *((name, [scene], {}) for name in ("run", "check", "cost") for scene in (
            None, 5, NOTHING, ITSELF, {"a": CIRCLE}, {"a": DEEP}, {"a": NOTHING}, {(1, 2): 3}, {"a": {1, 2}},
            {"name": "a\0b"}, {"name": "../../up"}, {"name": 7}, {"a": float("nan")}, "a\0.json", "\ud800.json",
            "", "none.json", [], {}, b"none.json")),
        *(("run", ["scene.json", output], {}) for output in (5, NOTHING, "a\0.h5", "", "-", ".", "no/a.h5",
                                                             "\ud800", [], True)),
        *(("run", ["scene.json"], {name: value}) for name, value in (
            ("threads", "many"), ("threads", -1), ("threads", 1e300), ("threads", CIRCLE), ("shard", (1, 2)),
            ("shard", "one"), ("shard", 5), ("shard", np.zeros((2, 2))), ("time_limit", "soon"),
            ("time_limit", "1s\0"), ("checkpoint_every", -1), ("program", 5), ("program", "none"),
            ("program", "a\0b"), ("program", "/"), ("program", "/bin/false"), ("program", "/bin/true"),
            ("program", "scene.json"), ("nothing", 1))),
        *(("fit", arguments, keywords) for arguments, keywords in (
            ([], {}), ([5], {}), ([None], {}), ([[]], {}), (["a.h5", "mean_height", "kww"], {}),
            (["a.h5", 5], {}), (["a.h5", "x\0"], {}), (["a.h5", "--csv=b"], {}), (["a\0.h5", "mean_height"], {}),
            *((["a.h5", "mean_height"], {name: value}) for name, value in (
                ("fix", 5), ("fix", {"tau": "x"}), ("fix", {"tau": None}), ("fix", {"tau": CIRCLE}),
                ("fix", [("tau", 1)]), ("start", {1: NOTHING}), ("bounds", {"a": 5}), ("bounds", {"a": (1,)}),
                ("bounds", {"a": (1, 2, 3)}), ("bounds", {"a": ("x", None)}), ("bounds", 7), ("model", "x y"),
                ("model", NOTHING), ("range", (1, 2)), ("range", "\0"), ("law", "-"), ("law", NOTHING),
                ("seed", "x"), ("seed", -1), ("sweep_point", "x"), ("sweep_point", CIRCLE))))),
        *(("analyse", arguments, keywords) for arguments, keywords in (
            ([], {}), (["a.h5"], {}), (["a.h5", None], {}), (["a.h5", "stedy", "mean_height"], {}),
            (["a.h5", "--csv=x", "mean_height"], {}), (["a.h5", "steady", 5], {}), (["a.h5", "steady", [5]], {}),
            (["a.h5", "steady", "--csv=x"], {}), ([["a.h5", 5], "steady", "mean_height"], {}),
            ([["a.h5", "--csv=x"], "steady", "mean_height"], {}), ([[], "steady", "mean_height"], {}),
            ([5, "steady", "mean_height"], {}), (["a.h5", "steady", "mean_height"], {"last": "x"}),
            (["a.h5", "ageing", "mean_height"], {"lags": CIRCLE}),
            (["a.h5", "ageing", "mean_height"], {"waiting_times": "x"}), (["a.h5", "steady\0", "mean_height"], {}))),
        *(("structure", ["a.h5"], {name: value}) for name, value in (
            ("settings", ITSELF), ("settings", NOTHING), ("settings", {"a": CIRCLE}), ("settings", DEEP),
            ("settings", {(1,): 2}), ("settings", []), ("part", 5), ("part", "x"), ("tap", "x"), ("tap", [-1]),
            ("tap", CIRCLE), ("threads", "x"))),
        *(("report", arguments, {}) for arguments in (
            ["a.h5"], ["a.h5", 5], ["a.h5", "a\0"], ["a.h5", ""], [5, "x.html"], [[], "x.html"], ["none", "x.html"])),
        *(("export", arguments, keywords) for arguments, keywords in (
            (["a.h5", "x"], {}), (["a.h5", "x"], {"format": "x"}), (["a.h5", "x"], {"format": NOTHING}),
            (["a.h5", 5], {"format": "vtp"}), (["a.h5", "x"], {"format": "vtp", "tap": "x"}),
            (["a.h5", "x"], {"format": "vtp", "realization": "x"}), ([NOTHING, "x"], {"format": "vtp"}))),
        ("schema", [5], {}), ("schema", [[]], {}), ("schema", ["/bin/true"], {}), ("program_path", [5], {}),
        ("program_path", ["a\0"], {}), ("half_width", ["x", 3], {}), ("half_width", [1, "x"], {}),
        ("half_width", [[1, 2], [1, 2, 3]], {}), ("half_width", [NOTHING, 1], {}),
    ]

    # Refused by calling a function as it cannot be called, or in Python's own words: these are TypeError
    # or ValueError too, as documented.
    def test_every_one_is_refused(self):
        shutil.copy(made(SMALL), "a.h5")
        pathlib.Path("scene.json").write_text(json.dumps(SMALL))
        before = sorted(os.listdir("."))
        for name, arguments, keywords in self.TABLE:
            about = f"{name}({reprlib.repr(arguments)}, {reprlib.repr(keywords)})"
            with self.subTest(about):
                with self.assertRaises(jostle.JostleError) as raised:
                    getattr(jostle, name)(*arguments, **keywords)
                self.assertRegex(str(raised.exception), r"\w")
                self.assertEqual(sorted(os.listdir(".")), before)

    def test_wrong_types_and_values_are_what_python_calls_them_too(self):
        with self.assertRaises(TypeError):
            jostle.open(5)
        with self.assertRaises(ValueError):
            jostle.open("a\0.h5")
        with self.assertRaises(TypeError):
            jostle.run()

    def test_questions_that_mean_nothing(self):
        results = self.open(made(SMALL))
        point = results.points[0]
        table = jostle.analyse(made(SMALL), "steady", "mean_height", last=40, store=False)[0]
        for question in (
                lambda: results.points["x"], lambda: results.points[1.5], lambda: results.points[9],
                lambda: results.points[-3], lambda: results.points["a":"b"], lambda: results.points[::0],
                lambda: results.points[None], lambda: results.positions("x"), lambda: results.positions(0, "x"),
                lambda: results.positions(0, 0, "x"), lambda: results.positions(0, 0, 7),
                lambda: results.positions(0, 99), lambda: results.positions(0, -1), lambda: results.box("x"),
                lambda: results.contacts(0, None), lambda: results.to_pandas(5), lambda: results.to_pandas([1]),
                lambda: results.to_pandas("a\0"), lambda: results.scene_text(5), lambda: results.scene_text("a\0"),
                lambda: point.mean["x"], lambda: point.mean[5], lambda: point.mean[[]], lambda: point.series["a\0"],
                lambda: point.units(5), lambda: point.units("a\0"), lambda: point.units([]),
                lambda: results.tables["x"], lambda: results.tables[5], lambda: results.tables[[]],
                lambda: results.tables.one("x"), lambda: results.tables.one(5), lambda: table["x"],
                lambda: table[[]], lambda: table.error("x"), lambda: table.error(5),
                lambda: table.to_pandas("x"), lambda: jostle.plot.compaction(results, "x"),
                lambda: jostle.plot.compaction(results, []), lambda: jostle.plot.compaction(5, "mean_height"),
                lambda: jostle.plot.compaction(results, "mean_height", points="x"),
                lambda: jostle.plot.compaction(results, "mean_height", points=[9]),
                lambda: jostle.plot.compaction(results, "mean_height", band=[]),
                lambda: jostle.plot.packing_slice(results, normal="xy"),
                lambda: jostle.plot.packing_slice(results, normal=5),
                lambda: jostle.plot.packing_slice(results, at="x"), lambda: jostle.plot.fit(5),
                lambda: jostle.plot.fit(table), lambda: jostle.plot.ageing(None),
                lambda: jostle.plot.profile(table, "x"), lambda: jostle.plot.sweep("x"),
                lambda: jostle.plot.height_histogram(results, 9), lambda: jostle.plot.spectrum(table),
                lambda: jostle.plot.height_histogram(results, taps="x")):
            with self.subTest(inspect.getsource(question).strip()[:70]), self.assertRaises(jostle.JostleError):
                question()

    def test_mappings_and_sequences_behave_as_python_s(self):
        results = self.open(made(SMALL))
        self.assertIsNone(results.tables.get("x"))
        self.assertNotIn("x", results.tables)
        self.assertNotIn([], results.tables)
        self.assertEqual(results.points[0].mean.get("x", 7), 7)
        self.assertNotIn([], results.points[0].mean)
        self.assertEqual(len(list(results.points)), 2)
        with self.assertRaises(IndexError):
            results.points[2]
        with self.assertRaises(KeyError) as raised:
            results.tables["x"]
        self.assertNotIn('"', str(raised.exception)[:1])

    def test_a_program_that_is_none_of_jostle_s(self):
        shutil.copy(made(SMALL), "a.h5")
        for text in ("exit 0", "echo {}", "echo [1]", "echo '{\"tables\": 5}'", "kill -9 $$", "kill -40 $$",
                     "echo '{\"curves\": [5]}'", "printf '\\377'"):
            pathlib.Path("program").write_text(f"#!/bin/sh\n{text}\n")
            os.chmod("program", 0o755)
            program = os.path.realpath("program")
            for ask in (lambda: jostle.fit("a.h5", "x", program=program),
                        lambda: jostle.analyse("a.h5", "steady", "x", program=program),
                        lambda: jostle.structure("a.h5", program=program),
                        lambda: jostle.open("a.h5", program=program).digest(),
                        lambda: jostle.check("scene.json", program=program)):
                with self.subTest(text), self.assertRaises(jostle.JostleError):
                    ask()


if __name__ == "__main__":
    unittest.main()
