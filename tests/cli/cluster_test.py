"""jostle slurm, status and merge on folders of shards. The script runs in bash as Slurm would run it;
tests/slurm has a real Slurm."""

import json
import os
import re
import signal
import subprocess
import time
import unittest

from support import BAD_INPUT, BROKEN, FAILED, OK, SLOW, STOPPED, TINY, Case, changed


class Script(Case):
    def setUp(self):
        super().setUp()
        self.write(TINY)

    def script(self, *arguments, scene="scene.json", **keywords):
        return self.jostle("slurm", scene, "--hours", 2, "--cpus", 1, *arguments, **keywords)

    def options(self, text):
        return dict(re.findall(r"^#SBATCH --([\w-]+)=(.*)$", text, re.M))

    def run_task(self, task, restarts=0, wait=True, scontrol="exit 0", **environment):
        """The work of Slurm for one task of tiny.sbatch. scontrol's arguments go to a file."""
        (self.folder / "bin").mkdir(exist_ok=True)
        (self.folder / "bin/scontrol").write_text(f'#!/bin/sh\necho "$@" >>requeued\n{scontrol}\n')
        (self.folder / "bin/scontrol").chmod(0o755)
        process = subprocess.Popen(
            ["bash", "tiny.sbatch"], cwd=self.folder, text=True, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            env={**os.environ, "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}",
                 "SLURM_JOB_ID": str(70 + task), "SLURM_ARRAY_JOB_ID": "70",
                 "SLURM_ARRAY_TASK_ID": str(task), "SLURM_CLUSTER_NAME": "alpha",
                 "SLURM_RESTART_COUNT": str(restarts), **environment})
        if not wait:
            return process
        out, _ = process.communicate(timeout=600)
        return process.returncode, out

    def requeued(self):
        path = self.folder / "requeued"
        return path.read_text() if path.exists() else ""

    def test_it_asks_for_what_was_asked(self):
        text = self.jostle("slurm", "scene.json", "--hours", "30.5", "--cpus", 3, "--jobs", 2).stdout
        options = self.options(text)
        self.assertEqual(options["array"], "1-2")
        self.assertEqual(options["cpus-per-task"], "3")
        self.assertEqual(options["time"], "1-06:30:00")
        self.assertEqual(options["signal"], "B:USR1@120")
        self.assertEqual(options["chdir"], str(self.folder))
        self.assertRegex(options["mem"], r"^\d+M$")
        self.assertIn("#SBATCH --requeue\n", text)
        self.assertEqual(subprocess.run(["bash", "-n"], input=text, text=True).returncode, 0)

    def test_the_longest_time_limit_is_written_as_such(self):
        text = self.jostle("slurm", "scene.json", "--hours", "87600", "--cpus", 65535, "--jobs", 1).stdout
        self.assertEqual(self.options(text)["time"], "3650-00:00:00")

    def test_a_script_shows_what_it_holds(self):
        turned = "evil\u202elmth"
        (self.folder / turned).mkdir()
        for arguments in (["--folder", turned], ["--folder", "two\nlines"], ["--folder", "\x1b[31m"],
                          ["--folder", "line\u2028break"], ["--folder", "c1\u009b"]):
            with self.subTest(arguments=arguments):
                done = self.script("--jobs", 1, *arguments, expect=BAD_INPUT)
                self.assertIn("has a character that a line of a script cannot contain or show", done.stderr)
                self.assertEqual(done.stdout, "")
                self.assertNotRegex(done.stderr, "[\u202e\x1b\u2028\u009b]")
        # The command line, which is no more than a comment, the rest is escaped.
        text = self.script("--jobs", 1, "-o", f"{turned}/tiny.sbatch").stderr
        script = (self.folder / turned / "tiny.sbatch").read_text()
        self.assertNotIn("\u202e", script + text)
        self.assertIn(r"$'evil\xe2\x80\xaelmth/tiny.sbatch'", script)
        self.assertEqual(subprocess.run(["bash", "-c", r"printf %s $'evil\xe2\x80\xaelmth'"], text=True,
                                        capture_output=True).stdout, turned)

    def test_its_tasks_compute_every_shard_once_and_again_nothing(self):
        told = self.script("--jobs", 3, "-o", "tiny.sbatch").stderr
        self.assertIn("jostle merge tiny.shards -o tiny.h5", told)
        for task in (1, 2, 3):
            code, out = self.run_task(task)
            self.assertEqual(code, 0, out)
            self.assertIn(f"shard {task} of 3 is done", out)
        before = {path: path.read_bytes() for path in self.folder.glob("tiny.shards/*.h5")}
        self.assertEqual(self.run_task(2)[0], 0)
        self.assertEqual({path: path.read_bytes() for path in before}, before)
        self.jostle("merge", "tiny.shards", "-o", "tiny.h5")
        self.run_scene("-o", "whole.h5")
        self.assertEqual(self.digest("tiny.h5"), self.digest("whole.h5"))
        self.assertEqual(self.requeued(), "")

    def test_a_name_of_two_lines_is_no_command(self):
        self.script("--jobs", 2, "-o", "a\ntouch made\n.sbatch")
        text = (self.folder / "a\ntouch made\n.sbatch").read_text()
        self.assertNotIn("\ntouch made", text)
        self.assertIn("a\\x0atouch made", text)

    def test_more_shards_than_an_array_may_have_come_one_after_another(self):
        text = self.script("--jobs", 5, "--array-limit", 2, "-o", "tiny.sbatch").stderr
        self.assertIn("2 tasks, 5 shards", text)
        self.assertEqual(self.options((self.folder / "tiny.sbatch").read_text())["array"], "1-2")
        self.assertEqual(self.run_task(1)[0], 0)
        self.assertEqual(sorted(path.name for path in self.folder.glob("tiny.shards/*.h5")),
                         ["1.h5", "2.h5", "3.h5"])
        status = json.loads(self.jostle("status", "tiny.shards", "--json").stdout)["studies"][0]
        self.assertEqual(status["redo"], ["sbatch --array=2 tiny.shards/job.sbatch"])
        self.assertEqual(self.run_task(2)[0], 0)
        self.jostle("merge", "tiny.shards", "-o", "tiny.h5")

    def slow_task(self, *signals, **keywords):
        """A task that gets these signals while it computes: its exit code and what it printed."""
        self.script("--jobs", 2, "-o", "tiny.sbatch", "--force")  # TINY has a short pilot
        self.write(changed(SLOW, name="tiny"))
        process = self.run_task(1, wait=False, **keywords)
        self.addCleanup(process.kill)
        while not (self.folder / "tiny.shards/1.h5").exists():
            self.assertIsNone(process.poll(), "ended before it wrote a file")
            time.sleep(0.01)
        for number in signals:
            process.send_signal(number)
            time.sleep(0.05)
        out, _ = process.communicate(timeout=600)
        return process.returncode, out

    def test_out_of_time_it_goes_back_into_the_queue_and_goes_on_there(self):
        code, out = self.slow_task(signal.SIGCONT, signal.SIGUSR1)
        self.assertEqual(code, STOPPED, out)
        self.assertIn("requeued", out)
        self.assertEqual(self.requeued(), "requeue 70_1\n")
        self.assertIn("stopped by SIGUSR1", (self.folder / "tiny.shards/1.log").read_text())
        self.assertEqual(self.run_task(1, restarts=1)[0], 0)
        self.assertEqual(self.run_task(2)[0], 0)
        self.jostle("merge", "tiny.shards", "-o", "tiny.h5")
        self.run_scene("-o", "whole.h5")
        self.assertEqual(self.digest("tiny.h5"), self.digest("whole.h5"))

    def test_a_cancelled_job_stops_and_does_not_come_back(self):
        code, out = self.slow_task(signal.SIGTERM, signal.SIGCONT, signal.SIGTERM)
        self.assertEqual(code, STOPPED, out)
        self.assertIn("not requeued", out)
        self.assertEqual(self.requeued(), "")
        self.assertEqual(self.info("tiny.shards/1.h5")["state"], "interrupted")

    def test_sigterm_before_sigusr1_stops_once(self):
        code, out = self.slow_task(signal.SIGTERM, signal.SIGUSR1)
        self.assertEqual(code, STOPPED, out)
        log = (self.folder / "tiny.shards/1.log").read_text()
        self.assertIn("stopped by SIGTERM", log)
        self.assertEqual(log.count("stopped by"), 1)
        self.assertEqual(self.info("tiny.shards/1.h5")["state"], "interrupted")

    def test_it_does_not_go_round_for_ever(self):
        code, out = self.slow_task(signal.SIGUSR1, restarts=10)
        self.assertEqual(code, STOPPED, out)
        self.assertIn("after 10 restarts", out)
        self.assertEqual(self.requeued(), "")

    def test_where_it_cannot_be_requeued_it_says_so(self):
        code, out = self.slow_task(signal.SIGUSR1, scontrol="exit 1")
        self.assertEqual(code, STOPPED, out)
        self.assertIn("submit it again", out)

    def test_a_shard_that_fails_costs_neither_the_next_nor_its_exit_code(self):
        self.write(changed(TINY, start={"crystal": "hcp"},
                           sweep={"/start/crystal/stretch": [True, False]}))
        # No crystal fits 4 x 4 unless it is stretched: the second point fails.
        self.script("--jobs", 2, "--array-limit", 1, "-o", "tiny.sbatch", expect=BAD_INPUT)
        self.write(TINY)
        self.script("--jobs", 2, "--array-limit", 1, "-o", "tiny.sbatch")
        (self.folder / "tiny.shards").mkdir()
        (self.folder / "tiny.shards/1.h5").write_text("notes")
        code, out = self.run_task(1)
        self.assertEqual(code, BROKEN, out)
        self.assertIn("shard 2 of 2 is done", out)
        self.assertEqual((self.folder / "tiny.shards/1.h5").read_text(), "notes")

    def test_what_cannot_be_is_refused_and_what_may_not_be_meant_is_said(self):
        refused = self.script("--jobs", 7, expect=BAD_INPUT)
        self.assertIn("take at most 6", refused.stderr)
        self.assertEqual(refused.stdout, "")
        self.assertIn("--cpus", self.script("--jobs", 2, "--cpus", 0, expect=BAD_INPUT).stderr)
        self.assertIn("have nothing to do", self.jostle(
            "slurm", "scene.json", "--hours", 1, "--cpus", 16, "--jobs", 3).stderr)
        # A tenth of a millisecond a tap, and a job has at least a minute.
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 10_000_000}]))
        long = self.jostle("slurm", "scene.json", "--hours", 1e-6, "--cpus", 1, "--jobs", 1)
        self.assertEqual(self.options(long.stdout)["time"], "00:01:00")
        self.assertRegex(" ".join(long.stderr.split()),
                         r"longest task needs about [\d.hmins ]+, limit 1 min 0 s: \d+ submissions")
        self.assertRegex(long.stderr, r"core-hours\s+\([\d.e+]+\s+to\s+[\d.e+]+\),\s+efficiency\s+\d+\s+%")
        restarts = int(re.search(r"most_restarts=(\d+)", long.stdout)[1])
        self.assertGreater(restarts, 10)
        self.write(changed(TINY, until={"target": {"mean_height": {"error": 0.1}}, "at_most": 9}))
        self.script("--jobs", 2, expect=BAD_INPUT)

    def test_a_script_that_exists_is_kept(self):
        (self.folder / "tiny.sbatch").write_text("mine")
        self.script("--jobs", 2, "-o", "tiny.sbatch", expect=BAD_INPUT)
        self.assertEqual((self.folder / "tiny.sbatch").read_text(), "mine")
        self.script("--jobs", 2, "-o", "tiny.sbatch", "--force")

    def test_names_that_a_shell_would_take_apart(self):
        folder = self.folder / "it's a $(touch oops) \"folder\""
        folder.mkdir()
        self.write(TINY, f"{folder.name}/my scene.json")
        text = self.jostle("slurm", "my scene.json", "--hours", 1, "--cpus", 1, "--jobs", 1,
                           "--folder", "a b", folder=folder).stdout
        (self.folder / "tiny.sbatch").write_text(text)
        self.folder, above = folder, self.folder
        (folder / "tiny.sbatch").write_text(text)
        code, out = self.run_task(1)
        self.assertEqual(code, 0, out)
        self.assertTrue((folder / "a b/1.h5").exists())
        self.assertFalse((folder / "oops").exists() or (above / "oops").exists())


class Status(Case):
    def setUp(self):
        super().setUp()
        self.write(TINY)
        (self.folder / "shards").mkdir()

    def shard(self, index, count=5, **keywords):
        return self.run_scene("--shard", f"{index}/{count}", "-o", f"shards/{index}.h5", **keywords)

    def status(self, *named, **keywords):
        shown = self.jostle("status", *(named or ("shards",)), "--json", **keywords)
        return json.loads(shown.stdout)

    def states(self):
        return {one["index"]: one["state"] for one in self.status()["studies"][0]["shards"]}

    def test_every_state_is_told_and_the_commands_end_it(self):
        self.write(SLOW)
        self.shard(1, 2, expect=STOPPED, environment={"JOSTLE_TIME_LIMIT": "0.1"})
        self.assertEqual(self.states(), {1: "stopped", 2: "missing"})
        running = self.popen("run", "scene.json", "--shard", "2/2", "-o", "shards/2.h5",
                             "--checkpoint-every", "0")
        self.addCleanup(running.communicate)
        self.addCleanup(running.kill)
        while not (self.folder / "shards/2.h5").exists():
            time.sleep(0.01)
        self.assertEqual(self.states(), {1: "stopped", 2: "running"})
        text = self.jostle("status", "shards").stdout
        self.assertIn(f"process {running.pid}", text)
        self.assertNotIn("--shard 2/2", text)
        running.kill()
        running.wait()
        self.assertEqual(self.states(), {1: "stopped", 2: "dead"})
        redo = self.status()["studies"][0]["redo"]
        self.assertEqual(len(redo), 2)
        self.assertIn(redo[0], self.jostle("status", "shards").stdout)
        for command in redo:
            subprocess.run(["bash", "-c", command], cwd=self.folder, check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.assertEqual(self.states(), {1: "done", 2: "done"})
        self.assertIn("merge shards -o tiny.h5", self.jostle("status", "shards").stdout)

    def test_a_redone_run_keeps_its_scene_and_options_and_a_merge_its_study(self):
        self.write(SLOW)
        self.jostle("run", "scene.json", "--shard", "1/2", "-oshards/1.h5", "--verbose", "--threads", 2,
                    environment={"JOSTLE_TIME_LIMIT": "0.1"}, expect=STOPPED)
        redo = self.jostle("status", "shards/1.h5").stdout
        self.assertRegex(redo, "run scene.json --verbose --threads=2 --resume --shard 1/2 -o shards/1.h5")
        (self.folder / "both").mkdir()
        for name, tiny in (("low", TINY), ("high", changed(TINY, seed=5))):
            self.write(changed(tiny, name=name))
            for i in (1, 2):
                self.jostle("run", "scene.json", "--shard", f"{i}/2", "-o", f"both/{name}{i}.h5", "--quiet")
        text = " ".join(self.jostle("status", "both").stdout.split())
        for name in ("low", "high"):
            self.assertIn(f"merge both/{name}1.h5 both/{name}2.h5 -o {name}.h5", text)

    def test_what_is_missing_is_computed_by_the_commands_alone(self):
        self.shard(2)
        self.shard(4)
        study = self.status()["studies"][0]
        self.assertEqual(study["counts"], {"done": 2, "running": 0, "stopped": 0, "dead": 0,
                                           "missing": 3, "unreadable": 0})
        self.assertGreater(study["core_hours_used"], 0)
        # 2 of 6 realizations are done, of the same cost.
        self.assertGreater(study["core_hours_left"], 0)
        self.assertEqual((study["realizations_done"], study["realizations"]), (2, 6))
        # A realization has four taps; its start, tap 0, is none.
        self.assertEqual([(one["taps_recorded"], one["taps"]) for one in study["shards"]],
                         [(0, 8), (4, 4), (0, 4), (4, 4), (0, 4)])
        self.assertIn("8 of 24\n", self.jostle("status", "shards").stdout)
        refused = self.jostle("merge", "shards", "-o", "all.h5", expect=BROKEN)
        self.assertIn("no input holds shard 1, 3, 5 of 5", refused.stderr)
        for command in study["redo"]:
            subprocess.run(["bash", "-c", command], cwd=self.folder, check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.assertEqual(self.status()["studies"][0]["core_hours_left"], 0)
        self.jostle("merge", "shards", "-o", "all.h5")
        self.run_scene("-o", "whole.h5")
        self.assertEqual(self.digest("all.h5"), self.digest("whole.h5"))

    def test_the_cost_of_a_run_in_progress_is_known_from_its_first_checkpoint_on(self):
        self.write(SLOW)
        folder = self.folder / "shards"
        for every in (3600, 0):
            running = self.popen("run", "scene.json", "-o", f"shards/{every}.h5", "--checkpoint-every", every)
            self.addCleanup(running.communicate)
            self.addCleanup(running.kill)
            while not (folder / f"{every}.h5").exists():
                time.sleep(0.01)
            while not every and self.status("shards/0.h5")["studies"][0]["shards"][0]["taps_recorded"] == 0:
                time.sleep(0.01)
            for ended in (False, True):
                if ended:
                    running.kill()
                    running.wait()
                study = self.status(f"shards/{every}.h5")["studies"][0]
                text = " ".join(self.jostle("status", f"shards/{every}.h5").stdout.split())
                summary = " ".join(self.jostle("info", f"shards/{every}.h5").stdout.split())
                each = json.loads(self.jostle("info", f"shards/{every}.h5", "--json").stdout)["realizations"]
                if every:
                    self.assertIsNone(study["core_hours_used"])
                    self.assertIsNone(study["core_hours_left"])
                    self.assertIn("no cost is recorded yet, the rest is not known", text)
                    self.assertIn("no cost is recorded yet", summary)
                else:
                    self.assertGreater(study["core_hours_used"], 0)
                    self.assertGreater(study["core_hours_left"], study["core_hours_used"] / 100)
                    self.assertRegex(text, r"core-hours\s+\S+ used, about \S+ left")
                    self.assertRegex(summary, r"[1-9]\S* (M )?trials in \S+ \w+ of one core")
                    self.assertTrue(any(one["seconds"] > 0 and one["trials"] > 0 for one in each))

    def test_damaged_files_and_runs_of_other_scenes_are_told_apart(self):
        for index in (1, 2, 3):
            self.shard(index, 3)
        self.write(changed(TINY, name="other"))
        self.run_scene("-o", "shards/other.h5")
        whole = self.folder / "shards/2.h5"
        whole.write_bytes(whole.read_bytes()[:-100])
        shown = self.jostle("status", "shards", "--json", expect=BROKEN)
        status = json.loads(shown.stdout)
        self.assertEqual({study["scene"]: study["counts"]["done"] for study in status["studies"]},
                         {"tiny": 2, "other": 1})
        self.assertEqual([one["file"] for one in status["bad_files"]], ["shards/2.h5"])
        self.assertIn("shards/2.h5", shown.stderr)

    def test_a_shard_that_cannot_be_read_is_not_missing(self):
        for index in (1, 3):
            self.shard(index, 4)
        damaged = self.folder / "shards/3.h5"
        damaged.write_bytes(damaged.read_bytes()[:-100])
        study = json.loads(self.jostle("status", "shards", "--json", expect=BROKEN).stdout)["studies"][0]
        self.assertEqual([one["state"] for one in study["shards"]], ["done", "missing", "unreadable", "missing"])
        self.assertEqual(study["shards"][2]["file"], "shards/3.h5")
        self.assertEqual(len(study["redo"]), 2)
        self.assertFalse([command for command in study["redo"] if "3/4" in command])
        shown = self.jostle("status", "shards", expect=BROKEN).stdout
        self.assertIn("unreadable   1: 3", shown)
        self.assertNotIn("3/4", shown)
        # A name without a number: it may hold any of them, and none is repeated.
        damaged.rename(self.folder / "shards/copy.h5")
        study = json.loads(self.jostle("status", "shards", "--json", expect=BROKEN).stdout)["studies"][0]
        self.assertEqual(study["unread"], ["shards/copy.h5"])
        self.assertEqual(study["redo"], [])
        self.assertIn("shards/copy.h5 cannot be read", self.jostle("status", "shards", expect=BROKEN).stdout
                      .replace("\n               ", " "))
        (self.folder / "shards/copy.h5").unlink()
        self.assertEqual(len(self.status()["studies"][0]["redo"]), 3)

    def test_a_share_in_two_files_is_told(self):
        self.shard(1, 2)
        alone = self.status()["studies"][0]
        (self.folder / "shards/copy.h5").write_bytes((self.folder / "shards/1.h5").read_bytes())
        told = self.status()["studies"][0]
        self.assertEqual(told["twice"], ["shards/copy.h5"])
        self.assertEqual(told["core_hours_used"], alone["core_hours_used"])
        self.assertIn("shards/copy.h5", self.jostle("status", "shards").stdout)

    def test_failed_realizations_are_counted(self):
        self.write(changed(TINY, start={"crystal": "hcp"},
                           sweep={"/start/crystal/stretch": [False, True]}))
        self.shard(1, 2, expect=FAILED)
        study = self.status()["studies"][0]
        self.assertEqual((study["realizations_failed"], study["realizations_done"]), (3, 0))

    def test_folders_without_results_and_files_that_are_none(self):
        self.assertIn(".h5", self.jostle("status", "shards", expect=BAD_INPUT).stderr)
        self.assertIn(".h5", self.jostle("merge", "shards", "-o", "a.h5", expect=BAD_INPUT).stderr)
        self.jostle("status", "scene.json", expect=BROKEN)
        self.jostle("status", "nowhere", expect=BROKEN)

    def test_unfinished_files_are_all_named(self):
        self.write(SLOW)
        for index in (1, 2):
            self.shard(index, 2, expect=STOPPED, environment={"JOSTLE_TIME_LIMIT": "0.1"})
        refused = self.jostle("merge", "shards", "-o", "a.h5", expect=BROKEN).stderr
        self.assertRegex(refused, r"shards/1.h5: is not finished, nor is shards/2.h5")


if __name__ == "__main__":
    unittest.main()
