"""Exit codes, messages, and what each command prints."""

import json
import pathlib
import subprocess
import unittest

from support import (BAD_INPUT, BROKEN, JOSTLE, OK, PLAIN, SOURCE, STOPPED, TINY, UNFOLDED, Case,
                     changed)


class Help(Case):
    def test_every_command_has_help_with_an_example(self):
        for command in ("new", "run", "check", "schema", "info", "merge", "fit", "bench", "cost",
                        "analyse", "structure", "selftest", "export", "report", "slurm",
                        "status"):
            with self.subTest(command=command):
                text = self.jostle(command, "--help").stdout
                self.assertIn("Example", text)
                self.assertIn(f"jostle {command}", text)
                self.assertLessEqual(max(map(len, text.splitlines())), 80)

    def test_version_names_revision_compiler_and_libraries(self):
        text = self.jostle("--version").stdout
        for part in ("jostle 0.", "(git ", "compiler ", "HDF5 ", "oneTBB ", "OpenSSL "):
            self.assertIn(part, text)

    def test_a_wrong_command_line_is_bad_input(self):
        self.write(TINY)
        for arguments in ([], ["walk"], ["run"], ["run", "scene.json", "--treads", "2"],
                          ["run", "scene.json", "--threads", "0"],
                          ["run", "scene.json", "--shard", "3/2"],
                          ["run", "scene.json", "--shard", "1"],
                          ["run", "scene.json", "--time-limit", "soon"],
                          ["bench", "gravel"], ["merge", "a.h5"], ["info", "a.h5", "--json", "--digest"]):
            with self.subTest(arguments=arguments):
                result = self.jostle(*arguments, expect=BAD_INPUT)
                self.assertNotEqual(result.stderr, "")
                self.assertEqual(self.files(), ["scene.json"])


class Bench(Case):
    def test_rates_are_printed_a_line_a_state_or_as_json(self):
        rates = json.loads(self.jostle("bench", "fluid_0.45", "--json").stdout)
        self.assertIn(rates["instruction_set"], ("baseline", "avx2", "avx512"))
        (case,) = rates["cases"]
        self.assertEqual((case["state"], case["spheres"]), ("fluid_0.45", 4096))
        self.assertGreater(case["trials_per_second"], 0)
        self.assertTrue(0.25 < case["acceptance"] < 0.4)
        lines = self.jostle("bench", "fluid_0.45").stdout.splitlines()
        self.assertRegex(lines[-1], r"^fluid_0\.45 +4096 spheres .* million trials/s")


class SelfTest(Case):
    def test_every_check_passes_here_and_leaves_nothing(self):
        lines = self.jostle("selftest", "--folder", ".").stdout.splitlines()
        self.assertGreaterEqual(len(lines), 5)
        for line in lines:
            self.assertRegex(line, r"^ok      [a-z, 0-9]+: ")
        self.assertEqual(self.files(), [])

    def test_its_files_are_small(self):
        limit = 'ulimit -f 4096; exec "$0" selftest --folder .'  # pieces of 1024 bytes
        done = subprocess.run(["bash", "-c", limit, JOSTLE], cwd=self.folder, env=PLAIN, text=True,
                              capture_output=True, timeout=600)
        self.assertEqual((done.returncode, done.stderr), (OK, ""), done.stdout)
        self.assertNotIn("FAILED", done.stdout)

    def test_a_folder_that_cannot_be_written_is_named(self):
        result = self.jostle("selftest", "--folder", "missing", expect=BROKEN)
        self.assertIn("missing: cannot make a folder there (No such file", result.stderr)
        self.assertIn("name another with --folder\n", result.stderr)


class Scenes(Case):
    def test_a_bad_scene_runs_and_writes_nothing_and_lists_every_fault(self):
        bad = changed(TINY, sphere=3, realizations=0,
                      protocol=[{"tap": {"dilat": 0.02}, "count": 4}])
        del bad["sweep"]
        self.write(bad)
        for command in ("run", "check"):
            with self.subTest(command=command):
                result = self.jostle(command, "scene.json", expect=BAD_INPUT)
                self.assertEqual(result.stdout, "")
                for line in ("/sphere: ", "/realizations: ", "/protocol/0/tap/dilat: "):
                    self.assertRegex(result.stderr, f"(?m)^{line}")
                self.assertIn('Did you mean "dilate"?', result.stderr)
                self.assertEqual(self.files(), ["scene.json"])

    def test_a_scene_that_cannot_be_read_is_named(self):
        self.assertIn("nowhere.json", self.jostle("run", "nowhere.json", expect=BAD_INPUT).stderr)
        for path, name in (("config/scenes/tutorial.json", "tutorial"),
                           ("fig4-bell.json", "philippe-bideau-2001/fig4-bell")):
            self.assertIn(f'jostle carries a scene of this name, "{name}": jostle new can write it',
                          self.jostle("run", path, expect=BAD_INPUT, environment=UNFOLDED).stderr)
        (self.folder / "folder").mkdir()
        self.assertIn("folder", self.jostle("check", "folder", expect=BAD_INPUT).stderr)
        self.write("", "empty.json")
        self.jostle("run", "empty.json", expect=BAD_INPUT)

    def test_a_packing_file_is_looked_for_beside_the_scene(self):
        self.write(TINY)
        self.run_scene("-o", "first.h5")
        (self.folder / "later").mkdir()
        scene = changed(TINY, start={"file": {"path": "../first.h5", "point": 1, "tap": 4}})
        self.write(scene, "later/scene.json")
        self.run_scene("-o", "second.h5", scene="later/scene.json")
        scene["start"]["file"]["path"] = "first.h5"
        self.write(scene, "later/scene.json")
        result = self.run_scene("-o", "third.h5", scene="later/scene.json", expect=BAD_INPUT)
        self.assertIn("/start/file", result.stderr)
        self.assertIn("first.h5", result.stderr)

    def test_check_prints_the_resolved_scene_its_size_and_estimates(self):
        self.write(TINY)
        text = self.jostle("check", "scene.json").stdout
        resolved, rest = text.split("\n}\n", 1)
        self.assertEqual(json.loads(resolved + "\n}")["relax"]["polar"]["max_step"], 0.1)
        self.assertIn("2 sweep points x 3 realizations, 48 spheres, 24 taps in all", rest)
        for part in ("effects", "pilot", "time: ", "memory: ", "disk: "):
            self.assertIn(part, rest)
        without = self.jostle("check", "scene.json", "--no-pilot").stdout
        self.assertNotIn("pilot", without)
        self.assertIn("disk: ", without)

    def test_check_bounds_its_pilot_for_a_large_scene(self):
        self.write(changed(TINY, spheres=200000, container={"sides": "periodic", "width": 50},
                           sweep={}))
        text = self.jostle("check", "scene.json").stdout
        self.assertIn("20000 of 200000 spheres", text)

    def test_check_tries_the_strengths_of_a_ramp_and_takes_threads_from_its_environment(self):
        ramp = changed(TINY, sweep={}, realizations=8, protocol=[
            {"ramp": {"lift": {"from": 0.1, "to": 0.5, "step": 0.05}}, "count": 2}])
        self.write(ramp)
        text = self.jostle("check", "scene.json", environment={"JOSTLE_THREADS": "4"}).stdout
        self.assertIn("48 spheres, taps of 3 strengths", text)
        self.assertRegex(text, r"time: .* on 4 threads")
        self.assertIn("on 1 thread,", self.jostle("check", "scene.json", "--threads", 1).stdout)

    def test_the_schema_is_the_shipped_one(self):
        printed = self.jostle("schema").stdout
        shipped = (pathlib.Path(JOSTLE).parent.parent / "scene.schema.json").read_text()
        self.assertEqual(json.loads(printed), json.loads(shipped))


class Runs(Case):
    def test_a_run_prints_a_table_a_sweep_point_and_names_its_file_after_the_scene(self):
        self.write(TINY)
        result = self.run_scene()
        self.assertEqual(self.files(), ["scene.json", "tiny.h5"])
        self.assertEqual(result.stdout.count("mean_height"), 2)
        self.assertEqual(result.stdout.count("no relaxation ended at the cap"), 1)
        self.assertRegex(" ".join(result.stdout.split()),
                         r"; bottom_fraction after tap 4: 0\.\d+\(\d+\) at \S+ = 0.02, 0\.\d+\(\d+\) at \S+ = 0.1 ")
        self.assertRegex(result.stdout, r"distance tests per trial")
        heights = [line.split() for line in result.stdout.splitlines() if line.startswith("  4 ")]
        self.assertEqual(len(heights), 2, result.stdout)

    def test_quiet_prints_nothing(self):
        self.write(TINY)
        result = self.jostle("run", "scene.json", "--quiet")
        self.assertEqual((result.stdout, result.stderr), ("", ""))
        result = self.jostle("run", "scene.json", "--force", environment={"JOSTLE_QUIET": "1"})
        self.assertEqual((result.stdout, result.stderr), ("", ""))

    def test_an_existing_file_is_kept_unless_forced(self):
        self.write(TINY)
        self.run_scene()
        before = (self.folder / "tiny.h5").read_bytes()
        result = self.run_scene(expect=BAD_INPUT)
        self.assertIn("tiny.h5 exists", result.stderr)
        self.assertIn("--force", result.stderr)
        self.assertEqual((self.folder / "tiny.h5").read_bytes(), before)
        digest = self.digest("tiny.h5")
        self.run_scene("--force")
        self.assertEqual(self.digest("tiny.h5"), digest)

    def test_a_capped_relaxation_is_reported(self):
        scene = changed(TINY, relax={"polar": {}, "max_sweeps": 10, "stop": {"mean_height": {
            "eta": 1e-9, "every_sweeps": 5}}})
        self.write(scene)
        self.assertEqual(
            self.run_scene().stdout.count("at every sweep point: 12 of 12 relaxations ended at the cap"), 1)

    def test_a_resume_from_a_changed_packing_file_is_refused(self):
        self.write(TINY)
        self.run_scene("-o", "first.h5")
        later = changed(TINY, start={"file": "first.h5"})
        self.write(later, "later.json")
        self.run_scene("--time-limit", "0s", scene="later.json", expect=STOPPED)
        self.write(changed(TINY, seed=5))
        self.run_scene("-o", "first.h5", "--force")
        result = self.run_scene("--resume", scene="later.json", expect=BROKEN)
        self.assertIn("starts from has changed", result.stderr)

    def exit_code_writing_to_a_full_disk(self, stream, *arguments):
        streams = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        with open("/dev/full", "w") as full:
            return subprocess.run([JOSTLE, *arguments], cwd=self.folder, env=PLAIN, timeout=600,
                                  **{**streams, stream: full}).returncode

    def test_a_log_that_cannot_be_written_ends_no_run(self):
        self.write(TINY)
        run = ("run", "scene.json", "--force")
        self.assertEqual(self.exit_code_writing_to_a_full_disk("stderr", *run), OK)
        self.assertEqual(
            self.exit_code_writing_to_a_full_disk("stderr", *run, "--time-limit", "0s"), STOPPED)
        self.assertEqual(self.exit_code_writing_to_a_full_disk("stdout", "schema"), BROKEN)

    def test_output_that_is_a_folder_is_refused_before_anything_runs(self):
        self.write(TINY)
        (self.folder / "out").mkdir()
        done = self.run_scene("-o", "out", expect=BAD_INPUT)
        self.assertIn("out/tiny.h5", done.stderr)
        self.assertEqual(self.files(), ["out", "scene.json"])

    def test_a_link_stays_and_what_it_names_is_written(self):
        self.write(TINY)
        (self.folder / "disk").mkdir()
        (self.folder / "tiny.h5").symlink_to(self.folder / "disk" / "big.h5")
        self.run_scene()
        self.assertTrue((self.folder / "tiny.h5").is_symlink())
        self.assertEqual(self.files(), ["disk", "disk/big.h5", "scene.json", "tiny.h5"])

    def test_output_in_a_missing_folder_is_a_broken_surrounding(self):
        self.write(TINY)
        result = self.run_scene("-o", "nowhere/out.h5", expect=BROKEN)
        self.assertIn("nowhere/out.h5", result.stderr)


class Information(Case):
    def test_info_summarises_in_words_and_in_json(self):
        self.write(changed(TINY, description="A bed of forty-eight."))
        self.run_scene()
        text = self.jostle("info", "tiny.h5").stdout
        for part in ("complete", "A bed of forty-eight.", "6 done", "24 of 24 taps", "mean_height"):
            self.assertIn(part, text)
        summary = self.info("tiny.h5")
        self.assertEqual(summary["state"], "complete")
        self.assertEqual([one["taps_recorded"] for one in summary["realizations"]], [4] * 6)
        self.assertEqual(summary["points"][1]["values"], {"/protocol/0/tap/dilate": 0.1})

    def test_what_is_no_results_file_is_refused_by_name(self):
        self.write("not HDF5", "text.h5")
        self.assertIn("text.h5", self.jostle("info", "text.h5", expect=BROKEN).stderr)
        for command in (["info"], ["report"], ["structure"], ["export", "--format", "extxyz"],
                        ["fit", "--observable", "mean_height"]):
            self.assertEqual(self.jostle(*command, "none.h5", expect=BROKEN).stderr,
                             "jostle: none.h5: cannot open: No such file or directory\n")
        self.jostle("analyse", "none.h5", "steady", "--observable", "mean_height", expect=BROKEN)
        self.jostle("fit", "none.csv", expect=BROKEN)

    def test_a_damaged_file_is_refused(self):
        self.write(TINY)
        self.run_scene()
        file = self.folder / "tiny.h5"
        whole = file.read_bytes()
        for place in range(100, len(whole), len(whole) // 9):
            with self.subTest(place=place):
                damaged = bytearray(whole)
                damaged[place] ^= 0x10
                file.write_bytes(damaged)
                self.assertIn("tiny.h5", self.jostle("info", "tiny.h5", expect=BROKEN).stderr)
                self.run_scene("--resume", expect=BROKEN)
        file.write_bytes(whole[:-100])
        self.jostle("info", "tiny.h5", "--digest", expect=BROKEN)


if __name__ == "__main__":
    unittest.main()
