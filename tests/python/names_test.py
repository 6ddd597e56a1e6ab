"""Files whose names are options, patterns or commands elsewhere, handed to the program."""

import json
import os
import pathlib
import shutil
import unittest

import jostle

from support import TINY, Case, changed, made

ONE = changed(TINY, sweep=None, realizations=2)
NAMES = ("--csv=b.h5", "-x.h5", "--force", "-", "a b.h5", "it's \"so\".h5", "two\nlines.h5", "$(touch made).h5",
         "`touch made`.h5", "*.h5", "[a]", "?.h5", "~.h5", "#.h5", "a;b&c|d.h5", "steady", "\u00e9.h5")


class Names(Case):
    def test_no_name_is_an_option_or_a_command(self):
        steady = {"last": 40, "store": False}
        wanted = jostle.analyse(made(ONE), "steady", "mean_height", **steady)[0]["value"].tolist()
        pathlib.Path("b.h5").write_text("keep me")
        for name in NAMES:
            with self.subTest(name):
                shutil.copy(made(ONE), name)
                before = sorted(os.listdir("."))
                with jostle.open(name) as results:
                    digest = results.digest()
                (table,) = jostle.analyse(name, "steady", "mean_height", **steady)
                self.assertEqual(table["value"].tolist(), wanted)
                (curve,) = jostle.fit(name, "mean_height", model="kww", store=False)
                self.assertIn("kww", curve.fits)
                self.assertTrue(jostle.structure([name], part=["profile"], store=False))
                self.assertEqual(sorted(os.listdir(".")), before)
                self.assertEqual(len(digest), 64)
                os.remove(name)
        self.assertEqual(pathlib.Path("b.h5").read_text(), "keep me")

    def test_a_glob_of_names_is_every_file_of_it(self):
        for number, name in enumerate(("a.h5", "--csv=b.h5", "-o", "steady")):
            results = jostle.run(changed(ONE, seed=number + 1), name)
            results.close()
        pathlib.Path("b.h5").write_text("keep me")
        before = sorted(os.listdir("."))
        tables = jostle.analyse([name for name in before if name != "b.h5"], "steady", "mean_height", last=40,
                                store=False)
        self.assertEqual(len({float(table["value"]) for table in tables}), 4)
        self.assertEqual(sorted(os.listdir(".")), before)
        self.assertEqual(pathlib.Path("b.h5").read_text(), "keep me")

    def test_outputs_and_scenes_have_any_name_too(self):
        for name in ("--force", "-x", "$(touch made)", "a b", "*", "two\nlines"):
            with self.subTest(name):
                scene = f"{name}.json"
                pathlib.Path(scene).write_text(json.dumps(ONE))
                with jostle.run(scene, f"{name}.h5", threads=1) as results:
                    self.assertEqual(results.state, "complete")
                jostle.check(scene)
                jostle.report(f"{name}.h5", f"{name}.html")
                jostle.export(f"{name}.h5", f"{name}.xyz", format="extxyz")
                made_here = sorted(os.listdir("."))
                self.assertEqual(made_here, sorted(f"{name}{end}" for end in (".json", ".h5", ".html", ".xyz")))
                for one in made_here:
                    os.remove(one)


if __name__ == "__main__":
    unittest.main()
