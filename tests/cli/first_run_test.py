"""The program of a first run: which scenes it runs, and when ./dev builds and uses it."""

import json
import os
import re
import shutil
import subprocess
import unittest

from support import BAD_INPUT, BROKEN, JOSTLE, OK, PLAIN, SOURCE, TINY, UNFOLDED, Case, changed

FIRST_RUN = os.environ["FIRST_RUN"]
REQUESTS = 1

FIT = {"model": "inverse_log", "observable": "bottom_fraction"}
# Each key of a scene that requests tables.
REQUESTING = {
    "until": {"targets": [{"observable": "mean_height", "standard_error": 1}], "at_most": 4},
    "fits": [FIT],
    "analyse": {"sweep": [{"observable": "mean_height"}]},
    "motion": {"lags": [1, 2]},
    "structure": {"profile": {}},
}
SKIPPING = TINY["relax"] | {"sampler": "skipping"}
# Scenes that need a loop of jostle alone, by what that is.
LOOPS = {
    "discrete elements": {key: value for key, value in TINY.items() if key != "relax"}
                         | {"engine": {"discrete_element": {}}},
    "spheres of several sizes": changed(TINY, spheres=[{"name": "one", "diameter": 1, "count": 30},
                                                       {"name": "other", "diameter": 1.2, "count": 10}]),
    "the sampler skipping": changed(TINY, relax=SKIPPING),
}


class FirstRun(Case):
    def first_run(self, *arguments, expect=OK):
        done = subprocess.run([FIRST_RUN, *map(str, arguments)], cwd=self.folder, env={**PLAIN, **UNFOLDED}, text=True,
                              capture_output=True)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done

    def test_a_run_has_the_bytes_of_jostle(self):
        self.write(TINY)
        whole = self.run_scene("-o", "whole.h5", environment=UNFOLDED).stdout
        first = self.first_run("run", "scene.json", "--no-progress", "-o", "first.h5").stdout
        self.assertEqual(self.digest("first.h5"), self.digest("whole.h5"))
        self.assertEqual(self.first_run("info", "first.h5", "--digest").stdout.strip(), self.digest("whole.h5"))
        without_times = [[line for line in text.splitlines() if not re.search("^this run:|of one core", line)]
                         for text in (whole, first.replace("first.h5", "whole.h5").replace(FIRST_RUN, JOSTLE))]
        self.assertIn("next:", without_times[0])
        self.assertEqual(*without_times)

    def test_scenes_that_request_tables_are_refused_before_anything_is_written(self):
        for key, value in REQUESTING.items():
            with self.subTest(key=key):
                self.write(changed(TINY, **{key: value}))
                self.jostle("check", "scene.json", "--no-pilot")
                refused = self.first_run("run", "scene.json", expect=BAD_INPUT)
                self.assertIn(f"the scene needs tables ({key}), which this program does not have", refused.stderr)
                self.assertEqual(self.requests("run", "scene.json"), f"tables ({key})\n")
                self.assertEqual(self.requests("check", "scene.json"), "")
                self.assertEqual(self.files(), ["scene.json"])

    def test_scenes_that_need_other_loops_are_refused_before_anything_is_written(self):
        for words, scene in LOOPS.items():
            with self.subTest(words=words):
                self.write(scene)
                self.jostle("check", "scene.json", "--no-pilot")
                refused = self.first_run("run", "scene.json", expect=BAD_INPUT)
                self.assertIn(f"the scene needs {words}, which this program does not have", refused.stderr)
                pilot = self.first_run("check", "scene.json", expect=BAD_INPUT)
                self.assertIn(f"this program has no loop for {words}: use jostle", pilot.stderr)
                self.first_run("check", "scene.json", "--no-pilot")
                self.assertEqual(self.requests("run", "scene.json"), f"{words}\n")
                self.assertEqual(self.requests("check", "scene.json"), f"{words}\n")
                self.assertEqual(self.requests("check", "scene.json", "--no-pilot"), "")
                self.assertEqual(self.files(), ["scene.json"])

    def test_a_loop_that_one_sweep_point_or_the_start_needs_is_needed(self):
        self.write(changed(TINY, sweep={"/relax/sampler": ["exhaustive", "skipping"]}))
        self.assertEqual(self.requests("run", "scene.json"), "the sampler skipping\n")
        self.write(changed(TINY, start={"random_settle": {}}, relax_start=SKIPPING))
        self.assertEqual(self.requests("run", "scene.json"), "the sampler skipping\n")

    def requests(self, *arguments):
        done = subprocess.run([FIRST_RUN, "requests", *arguments], cwd=self.folder, env=PLAIN, text=True,
                              capture_output=True)
        self.assertEqual((done.returncode, done.stderr), (REQUESTS if done.stdout else OK, ""))
        return done.stdout

    def test_requests_takes_the_options_of_its_command(self):
        self.write(TINY)
        self.assertEqual(self.requests("run", "-o", "x.h5", "scene.json", "--threads", "1"), "")
        self.assertEqual(self.requests("check", "scene.json", "--threads", "1"), "")
        self.write(changed(TINY, fits=[FIT], structure={"profile": {}}))
        self.assertEqual(self.requests("run", "scene.json"), "tables (fits, structure)\n")

    def test_jostle_has_no_command_of_the_other_program(self):
        self.write(TINY)
        self.jostle("requests", "run", "scene.json", expect=BAD_INPUT)
        self.first_run("fit", "scene.json", expect=BAD_INPUT)


CMAKE = """#!/bin/sh
[ "$1" = --build ] || exec mkdir -p "build/$2"
echo "$4" >>"$BUILT"
[ -z "$FAILS" ] || exit 1
mkdir -p "$2/cli"
case $4 in
  jostle) ln -sf "$JOSTLE" "$2/cli/jostle" ;;
  jostle_first_run) ln -sf "$FIRST_RUN" "$2/cli/jostle_first_run" ;;
esac
"""
DPKG_QUERY = """#!/bin/sh
for package; do echo "installed $package"; done
"""


class Dev(Case):
    """./dev in a tree of its own, with a cmake that only records what it is to build, and links it."""

    def setUp(self):
        super().setUp()
        self.tree = self.folder / "tree"
        (self.tree / "tools").mkdir(parents=True)
        for name, text in (("cmake", CMAKE), ("dpkg-query", DPKG_QUERY)):
            (self.tree / "tools" / name).write_text(text)
            (self.tree / "tools" / name).chmod(0o755)
        for name in ("dev", "CMakePresets.json"):
            shutil.copy(SOURCE / name, self.tree)
        shutil.copytree(SOURCE / "packages", self.tree / "packages")

    def dev(self, *arguments, expect=OK, scene=None, **environment):
        """Returns what ./dev built, and what it printed."""
        built = self.folder / "built"
        built.unlink(missing_ok=True)
        own = {"JOSTLE": JOSTLE, "FIRST_RUN": FIRST_RUN, "BUILT": str(built), "FAILS": "",
               "PATH": f"{self.tree / 'tools'}:{os.environ['PATH']}"}
        done = subprocess.run([self.tree / "dev", *map(str, arguments)], cwd=self.folder, text=True, input=scene,
                              capture_output=True, env={**PLAIN, **UNFOLDED, **own, **environment})
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return built.read_text().split() if built.exists() else [], done

    def test_a_first_run_builds_what_it_needs_and_later_commands_the_rest(self):
        self.write(TINY)
        built, done = self.dev("run", "-o", "tiny.h5", "scene.json", "--no-progress")
        self.assertEqual(built, ["jostle_first_run"])
        self.assertIn("dev: building what a first run needs in build/release, once; about ", done.stderr)
        self.assertIn("dev: fit, structure, report and the other commands build the rest first; about ", done.stderr)
        self.assertIn(f"  {self.tree / 'dev'} structure tiny.h5\n", done.stdout)
        digest = self.digest("tiny.h5")
        built, done = self.dev("info", "tiny.h5", "--digest")
        self.assertEqual((built, done.stdout.strip(), done.stderr), (["jostle_first_run"], digest, ""))
        built, done = self.dev("structure", "tiny.h5", "--part", "profile")
        self.assertEqual(built, ["jostle"])
        self.assertIn("dev: building jostle in build/release, once; about ", done.stderr)
        self.assertEqual(self.dev("run", "scene.json", "-o", "again.h5")[0], ["jostle"])
        self.assertEqual(self.digest("again.h5"), digest)

    def test_a_scene_that_needs_more_is_run_by_jostle(self):
        self.write(changed(TINY, structure={"profile": {}}))
        built, done = self.dev("run", "scene.json")
        self.assertEqual(built, ["jostle_first_run", "jostle"])
        self.assertIn("dev: the scene needs tables (structure), which the rest of jostle has", done.stderr)
        self.assertIn("structure/point_0000/profile", self.info("tiny.h5")["tables"])

    def test_a_pilot_that_needs_more_is_made_by_jostle(self):
        self.write(LOOPS["the sampler skipping"])
        self.assertEqual(self.dev("check", "scene.json", "--no-pilot")[0], ["jostle_first_run"])
        built, done = self.dev("check", "scene.json")
        self.assertEqual(built, ["jostle_first_run", "jostle"])
        self.assertIn("dev: the scene needs the sampler skipping, which the rest of jostle has", done.stderr)
        self.assertIn("pilot of", done.stdout)

    def test_faults_of_a_scene_need_no_other_program(self):
        self.write(changed(TINY, sphere=3))
        built, done = self.dev("run", "scene.json", expect=BAD_INPUT)
        self.assertEqual(built, ["jostle_first_run"])
        self.assertEqual(done.stderr.count("/sphere: "), 1)
        self.assertEqual(sorted(path.name for path in self.folder.glob("*.h5")), [])

    def test_a_scene_from_a_pipe_is_read_by_jostle(self):
        for command in (("check", "--no-pilot"), ("run", "-o", "piped.h5")):
            (self.tree / "build/release/cli/jostle").unlink(missing_ok=True)
            built, done = self.dev(*command, "/dev/stdin", scene=json.dumps(TINY))
            self.assertEqual((built, done.stderr.count("fault")), (["jostle"], 0))

    def test_faults_of_a_command_line_name_the_command(self):
        self.write(TINY)
        built, done = self.dev("check", "scene.json", "--no-pilo", expect=BAD_INPUT)
        self.assertEqual((built, done.stderr.count("jostle check")), (["jostle_first_run"], 1), done.stderr)
        self.assertNotIn("requests", done.stderr)

    def test_help_of_run_needs_no_scene(self):
        built, done = self.dev("run", "--help")
        self.assertEqual((built, done.stdout.count("--checkpoint-every")), (["jostle_first_run"], 1))

    def test_a_build_that_fails_runs_nothing(self):
        self.write(TINY)
        built, done = self.dev("run", "scene.json", expect=BROKEN, FAILS="yes")
        self.assertEqual(built, ["jostle_first_run"])
        self.assertTrue(done.stderr.endswith("dev: build/release did not build\n"), done.stderr)


if __name__ == "__main__":
    unittest.main()
