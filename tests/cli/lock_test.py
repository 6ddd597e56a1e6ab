"""Who may work on a file: jobs of Slurm, on other hosts too, and file systems without flock."""

import errno
import os
import time
import unittest

from support import BROKEN, OK, SHIM, SLOW, STOPPED, TINY, Case

SERVER_SAYS_NOT_SUPPORTED = 524


class Jobs(Case):
    """Slurm's answers come from programs of its names, which print what Slurm's own do."""

    def setUp(self):
        super().setUp()
        self.write(TINY)
        self.run_scene()
        self.digest_before = self.digest("tiny.h5")
        self.lock = self.folder / "tiny.h5.lock"
        (self.folder / "bin").mkdir()

    def slurm(self, jobs, cluster="alpha", code=0):
        """`jobs`: number, state, restarts of each."""
        lines = "\n".join(f"{number:<24}{state:<24}{restarts:<24}" for number, state, restarts in jobs)
        for name, text in (("squeue", lines), ("scontrol", f"ClusterName             = {cluster}")):
            path = self.folder / "bin" / name
            path.write_text(f"#!/bin/sh\ncat <<'TEXT'\n{text}\nTEXT\nexit {code}\n")
            path.chmod(0o755)

    def resume(self, locked_by, expect, **environment):
        self.lock.write_text(locked_by + "\n")
        path = f"{self.folder / 'bin'}:{os.environ['PATH']}"
        done = self.run_scene("--resume", expect=expect, environment={"PATH": path, **environment})
        self.assertEqual(self.lock.exists(), expect != OK)
        self.assertEqual(self.digest("tiny.h5"), self.digest_before)
        return done.stderr

    def test_a_job_that_slurm_says_has_ended_gives_its_lock_away(self):
        owner = "elsewhere 1 1 slurm alpha 71 0 70_1"
        for jobs in ([], [(72, "RUNNING", 0)], [(71, "COMPLETED", 0)], [(71, "CANCELLED", 0)],
                     [(71, "TIMEOUT", 0)], [(71, "NODE_FAIL", 0)],
                     [(71, "PENDING", 1)], [(71, "RUNNING", 1)]):
            with self.subTest(jobs=jobs):
                self.slurm(jobs)
                self.resume(owner, OK)

    def test_a_job_that_may_still_run_keeps_it(self):
        owner = "elsewhere 1 1 slurm alpha 71 2 70_1"
        for jobs in ([(71, "RUNNING", 2)], [(71, "COMPLETING", 2)], [(71, "SUSPENDED", 2)],
                     [(71, "STATE_OF_LATER_VERSIONS", 2)],
                     [(71, "RUNNING", 2), (71, "PENDING", 2)],
                     [(71, "PENDING", 2), (71, "RUNNING", 2)]):
            with self.subTest(jobs=jobs):
                self.slurm(jobs)
                error = self.resume(owner, BROKEN)
                self.assertIn("process 1 on host elsewhere (Slurm job 70_1)", error)
                self.assertIn("--force", error)

    def test_where_slurm_cannot_tell_the_lock_is_kept(self):
        owner = "elsewhere 1 1 slurm alpha 71 0 71"
        self.slurm([], cluster="beta")
        self.resume(owner, BROKEN)
        self.slurm([], code=1)
        self.resume(owner, BROKEN)
        for name in ("squeue", "scontrol"):
            (self.folder / "bin" / name).unlink()
        self.resume(owner, BROKEN)
        self.slurm([])
        self.resume("elsewhere 1 1", BROKEN)  # a lock without a job, in the form of earlier versions

    @unittest.skipUnless(os.getuid() == 0, "only root gives files away")
    def test_of_another_users_job_slurm_is_not_asked(self):
        self.slurm([])
        self.lock.write_text("")
        os.chown(self.lock, 65534, -1)
        self.resume("elsewhere 1 1 slurm alpha 71 0 71", BROKEN)

    def test_a_job_knows_its_own_earlier_start_to_be_over(self):
        job = {"SLURM_JOB_ID": "71", "SLURM_CLUSTER_NAME": "alpha", "SLURM_RESTART_COUNT": "1"}
        self.resume("elsewhere 1 1 slurm alpha 71 0 70_1", OK, **job)
        self.resume("elsewhere 1 1 slurm alpha 71 1 70_1", BROKEN, **job)  # two steps of one job
        self.resume("elsewhere 1 1 slurm beta 71 0 70_1", BROKEN, **job)

    def test_a_lock_names_the_job(self):
        self.write(SLOW)
        process = self.popen("run", "scene.json", "-o", "slow.h5", environment={
            "SLURM_JOB_ID": "71", "SLURM_CLUSTER_NAME": "alpha", "SLURM_RESTART_COUNT": "3",
            "SLURM_ARRAY_JOB_ID": "70", "SLURM_ARRAY_TASK_ID": "1"})
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        while not (self.folder / "slow.h5").exists():
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        words = (self.folder / "slow.h5.lock").read_text().split()
        self.assertEqual(words[1], str(process.pid))
        self.assertEqual(words[3:], ["slurm", "alpha", "71", "3", "70_1"])


class WithoutFlock(Case):
    """Where flock fails as on network file systems that have none."""

    def surroundings(self, error):
        return {**SHIM, "JOSTLE_NO_FLOCK": str(error)}

    def test_a_run_says_so_and_gives_the_same_data(self):
        self.write(TINY)
        self.run_scene("-o", "with.h5")
        digest = self.digest("with.h5")
        for error in (SERVER_SAYS_NOT_SUPPORTED, errno.ENOLCK, errno.ENOTSUP, errno.ENOSYS):
            with self.subTest(error=error):
                done = self.run_scene("--force", environment=self.surroundings(error))
                self.assertIn("has no flock", done.stderr)
                self.assertEqual(self.digest("tiny.h5"), digest)
        self.assertNotIn("flock", self.run_scene("--force").stderr)
        self.assertEqual([name for name in self.files() if "lock" in name], [])

    def test_another_process_is_kept_out_and_a_dead_one_is_not_waited_for(self):
        self.write(SLOW)
        without = self.surroundings(errno.ENOLCK)
        process = self.popen("run", "scene.json", environment=without)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        while not (self.folder / "tiny.h5").exists():
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        second = self.run_scene("--resume", expect=BROKEN, environment=without)
        self.assertIn(f"process {process.pid} on this host", second.stderr)
        process.kill()
        process.wait()
        self.assertTrue((self.folder / "tiny.h5.lock").exists())
        resumed = self.run_scene("--resume", "--time-limit", "0.1", environment=without,
                                 expect=STOPPED)
        self.assertIn("stopped by the time limit", resumed.stderr)
        self.assertEqual(self.files(), ["scene.json", "tiny.h5"])

    def test_a_lock_that_was_never_written_is_waited_for_and_taken(self):
        self.write(TINY)
        (self.folder / "tiny.h5.lock").touch()
        self.run_scene(environment=self.surroundings(errno.ENOLCK))
        self.assertEqual(self.files(), ["scene.json", "tiny.h5"])

    def test_of_many_that_take_over_from_a_dead_one_one_gets_it(self):
        self.write(SLOW)
        self.run_scene("--time-limit", "0.1", expect=STOPPED)
        host = os.uname().nodename
        (self.folder / "tiny.h5.lock").write_text(f"{host} 999999999 1\n")
        runs = [self.popen("run", "scene.json", "--resume", "--threads", "1", "--time-limit", "1s",
                           environment=self.surroundings(errno.ENOLCK)) for _ in range(6)]
        codes = []
        for run in runs:
            run.communicate(timeout=600)
            codes.append(run.returncode)
        # A process that arrives after another has ended continues; two never work at once.
        self.assertTrue({STOPPED, OK} & set(codes), codes)
        self.assertLessEqual(set(codes), {STOPPED, BROKEN, OK})
        self.assertEqual([name for name in self.files() if "lock" in name], [])
        self.run_scene("--resume")
        self.run_scene("-o", "straight.h5")
        self.assertEqual(self.digest("tiny.h5"), self.digest("straight.h5"))


if __name__ == "__main__":
    unittest.main()
