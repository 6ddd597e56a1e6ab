"""Graceful stops: signals and the time limit, inside a relaxation, and going on from there."""

import signal
import time
import unittest

import h5py

from support import BROKEN, FAILED, SLOW, STOPPED, TINY, Case, changed, some

# With trials that are skipped by the hundred.
SKIPPING = changed(SLOW, relax={"polar": {}, "stop": {"sweeps": 20000000},
                                "max_sweeps": 20000000, "sampler": "skipping"})


class Stops(Case):
    def setUp(self):
        super().setUp()
        self.write(SLOW)

    def wait_for_file(self, process, name="tiny.h5"):
        while not (self.folder / name).exists():
            self.assertIsNone(process.poll(), "ended before it wrote a file")
            time.sleep(0.01)

    def resume_by_the_printed_command(self, err):
        command = err.strip().splitlines()[-1].split()
        self.assertIn("--resume", command, err)
        return self.jostle(*command[1:])

    def test_each_signal_stops_resumably_with_the_same_digest_in_the_end(self):
        self.run_scene("-o", "straight.h5")
        straight = self.digest("straight.h5")
        for number in some((signal.SIGTERM, signal.SIGUSR1, signal.SIGINT), 2):
            with self.subTest(signal=number.name):
                process = self.popen("run", "scene.json", "--threads", "2", "--force")
                self.wait_for_file(process)
                process.send_signal(number)
                _, err = process.communicate(timeout=60)
                self.assertEqual(process.returncode, STOPPED, err)
                self.assertIn(f"stopped by {number.name}", err)
                self.assertEqual(self.info("tiny.h5")["state"], "interrupted")
                self.assertNotIn("tiny.h5.parts", self.files())
                self.resume_by_the_printed_command(err)
                self.assertEqual(self.digest("tiny.h5"), straight)
                (self.folder / "tiny.h5").unlink()

    def test_parts_without_their_file_are_kept_by_a_forced_resume(self):
        state = self.folder / "tiny.h5.parts" / "p0000_r00000.state"
        state.parent.mkdir()
        state.write_bytes(b"checkpoint")
        done = self.jostle("run", "scene.json", "--resume", "--force", expect=BROKEN)
        self.assertIn("holds parts of an earlier run", done.stderr)
        self.assertEqual(state.read_bytes(), b"checkpoint")

    def test_a_stop_while_the_start_comes_to_rest_is_resumable(self):
        self.write(changed(SLOW, realizations=1, start={"random_settle": {}}, protocol=[],
                           snapshots={"taps": [0]}))
        self.run_scene("-o", "straight.h5")
        process = self.popen("run", "scene.json", "--force")
        self.wait_for_file(process)
        process.send_signal(signal.SIGTERM)
        _, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, STOPPED, err)
        self.assertEqual(self.info("tiny.h5")["realizations"][0]["taps_recorded"], 0)
        self.resume_by_the_printed_command(err)
        self.assertEqual(self.digest("tiny.h5"), self.digest("straight.h5"))

    def test_a_chain_of_time_limits_reaches_the_end_with_the_same_digest(self):
        self.chain_of_time_limits()

    def test_a_chain_of_time_limits_reaches_the_end_of_relaxations_that_skip(self):
        self.write(SKIPPING)
        self.chain_of_time_limits()

    def chain_of_time_limits(self):
        self.run_scene("-o", "straight.h5")
        stops = 0
        while True:
            result = self.run_scene("--resume", "--time-limit", "150ms", expect=None)
            if result.returncode != STOPPED:
                break
            self.assertIn("stopped by the time limit", result.stderr)
            self.assertIn("resume with (omit --time-limit to reach the end)\n", result.stderr)
            stops += 1
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater(stops, 0)
        self.assertEqual(self.digest("tiny.h5"), self.digest("straight.h5"))

    def test_info_reads_a_live_run_and_a_second_run_is_kept_out(self):
        process = self.popen("run", "scene.json", "--checkpoint-every", "0")
        self.addCleanup(process.kill)
        self.wait_for_file(process)
        summary = self.info("tiny.h5")
        self.assertEqual(summary["state"], "running")
        self.assertTrue(summary["alive"])
        second = self.run_scene("--resume", expect=4)
        self.assertIn(str(process.pid), second.stderr)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0)


class Retry(Case):
    def test_failed_realizations_are_run_again_only_when_asked(self):
        # No crystal fits 4 x 4 unless it is stretched: the first point fails, the second does not.
        self.write(changed(TINY, start={"crystal": "hcp"},
                           sweep={"/start/crystal/stretch": [False, True]}))
        first = self.run_scene(expect=FAILED)
        self.assertRegex(first.stdout, r"realization 0 failed \(seed 4711\): \S")
        self.assertIn("3 done, 0 failed", first.stdout)
        digest = self.digest("tiny.h5")
        self.assertIn("0 of 6 realizations to do", self.run_scene("--resume", expect=FAILED).stderr)
        again = self.run_scene("--retry-failed", expect=FAILED)
        self.assertIn("3 of 6 realizations to do", again.stderr)
        self.assertEqual(self.digest("tiny.h5"), digest)


class Tables(Case):
    def names(self):
        with h5py.File(self.folder / "tiny.h5") as file:
            return [name for name in ("analysis", "fits", "structure") if name in file]

    def parts(self):
        with h5py.File(self.folder / "tiny.h5") as file:
            return list(file["structure/point_0000"])

    def test_a_resume_with_nothing_to_do_leaves_tables_and_file_alone(self):
        self.write(TINY)
        self.run_scene()
        self.jostle("structure", "tiny.h5", "--part", "profile")
        before = (self.folder / "tiny.h5").read_bytes()
        self.run_scene("--resume")
        self.assertEqual((self.folder / "tiny.h5").read_bytes(), before)

    def test_a_resume_that_computes_no_taps_keeps_all_tables(self):
        self.write(TINY)
        self.run_scene()
        self.jostle("structure", "tiny.h5", "--part", "profile")
        with h5py.File(self.folder / "tiny.h5") as file:
            before = self.contents(file["structure/point_0000/profile"])
        self.write(changed(TINY, structure={"coordination": {}}))
        more = self.run_scene("--resume")
        self.assertNotIn("removed", more.stderr)
        self.assertIn("coordination", self.parts())
        with h5py.File(self.folder / "tiny.h5") as file:
            self.assertEqual(self.contents(file["structure/point_0000/profile"]), before)
        self.jostle("info", "tiny.h5")

    @staticmethod
    def contents(group):
        """Values, attributes and axes of every dataset, and how the table was made."""
        def values(array):
            return array[()].tolist() if array.dtype.kind == "O" else array[()].tobytes()
        return [(name, values(array), array.attrs.get("units"),
                 [[axis.name for axis in axes.values()] for axes in array.dims])
                for name, array in group.items()] + sorted(
                    (name, str(value)) for name, value in group.attrs.items())

    def test_tables_of_fewer_data_are_dropped_by_name(self):
        self.write(TINY)
        self.run_scene()
        self.jostle("structure", "tiny.h5", "--part", "profile")
        self.write(changed(TINY, realizations=4))
        more = self.run_scene("--resume")
        self.assertIn("removed from tiny.h5", more.stderr)
        self.assertIn("structure/point_0000/profile", more.stderr)
        self.assertEqual(self.names(), [])


if __name__ == "__main__":
    unittest.main()
