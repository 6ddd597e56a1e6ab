"""Where the program writes: links that another user planted are followed nowhere, and no source opens a file
to write but through the functions that look. A file that another command makes meanwhile is kept."""

import json
import os
import re
import shutil
import signal
import stat
import subprocess
import unittest

from support import BROKEN, JOSTLE, OK, PLAIN, SHIM, SOURCE, TINY, Case, changed

OWN, OTHER = 65534, 65533  # users without a name
RUN_AS = ["setpriv", f"--reuid={OWN}", f"--regid={OWN}", "--clear-groups"]
CAN_RUN_AS_ANOTHER = os.geteuid() == 0 and shutil.which("setpriv") and subprocess.run(
    [*RUN_AS, "sh", "-c", 'exec "$0" --version', JOSTLE], capture_output=True).returncode == 0
ONE = changed(TINY, sweep={}, realizations=2, protocol=[{"tap": {"dilate": 0.05}, "count": 40}])

# The commands that write "out" in the folder "shared"; {} is a file's ending where the command makes one up.
COMMANDS = {
    "run": "run scene.json --quiet -o shared/out",
    "run --force": "run scene.json --quiet --force -o shared/out",
    "run --resume": "run scene.json --quiet --resume -o shared/out",
    "run --shard": "run scene.json --quiet --shard 1/2 -o shared/out",
    "cost": "cost scene.json --replicates 1 --taps 1 --no-progress -o shared/out",
    "cost --csv": "cost scene.json --replicates 1 --taps 1 --no-progress -o cost.h5 --csv shared/out --force",
    "merge": "merge a.h5 -o shared/out",
    "merge --force": "merge a.h5 --force -o shared/out",
    "export extxyz": "export a.h5 --format extxyz --force -o shared/out",
    "export vtp": "export a.h5 --format vtp --force -o shared/out",
    "export h5md": "export a.h5 --format h5md --force -o shared/out",
    "export results": "export a.h5 --format results --force -o shared/out",
    "fit --csv": "fit a.h5 --observable mean_height --model kww --no-store --csv shared/out --force",
    "analyse --csv": "analyse a.h5 steady --observable mean_height --no-store --csv shared/out --force",
    "structure --csv": "structure a.h5 --part profile --no-store --csv shared/out --force",
    "report": "report a.h5 --force -o shared/out",
    "slurm": "slurm scene.json --hours 1 --cpus 1 --jobs 1 --force -o shared/out",
}


@unittest.skipUnless(CAN_RUN_AS_ANOTHER, "only root can make links of others, and setpriv runs as another")
class Planted(Case):
    def setUp(self):
        super().setUp()
        self.write(ONE)
        self.run_scene("--quiet", "-o", "a.h5")
        os.mkdir(self.folder / "mine")
        self.victim = self.folder / "mine/victim"
        self.victim.write_text("mine")
        os.mkdir(self.folder / "shared")
        for path in (self.folder, *self.folder.rglob("*")):
            os.chown(path, OWN, OWN)
        os.chown(self.folder / "shared", 0, OWN)
        os.chmod(self.folder, 0o755)

    def as_user(self, command):
        return subprocess.run([*RUN_AS, JOSTLE, *command.split()], cwd=self.folder, text=True,
                              env={**PLAIN, "TMPDIR": "/tmp"}, stdin=subprocess.DEVNULL, capture_output=True)

    def plant(self, name, target, owner=OTHER, mode=0o1777):
        path = self.folder / name
        path.unlink(missing_ok=True)
        path.symlink_to(target)
        os.chown(path, owner, owner, follow_symlinks=False)
        os.chmod(self.folder / "shared", mode)

    def contents(self):
        return {str(path): path.read_bytes() for path in (self.folder / "mine").rglob("*") if path.is_file()}

    def refused(self, command, about):
        before, files = self.contents(), self.files()
        done = self.as_user(command)
        self.assertEqual(done.returncode, BROKEN, f"{about}: {command}\n{done.stdout}{done.stderr}")
        self.assertIn(f"another user (number {OTHER})", done.stderr, about)
        self.assertEqual((self.contents(), self.files()), (before, files), about)

    def test_no_command_follows_one(self):
        modes = (0o1777, 0o777, 0o775)
        kinds = (("out", "../mine/victim"), ("out", "../mine/none"), ("out", "../mine"))
        number = 0
        for name, command in COMMANDS.items():
            # Every command with every kind, the modes in turn.
            for link, target in kinds:
                number += 1
                about = f"{name}: link to {target} in a folder of mode {modes[number % 3]:o}"
                with self.subTest(about):
                    self.plant(f"shared/{link}", target, mode=modes[number % 3])
                    self.refused(command, about)
        os.unlink(self.folder / "shared/out")
        for name, command in COMMANDS.items():
            number += 1
            with self.subTest(f"{name}: a folder on the way"):
                self.plant("shared/way", "../mine", mode=modes[number % 3])
                self.refused(command.replace("shared/out", "shared/way/victim"), name)
                self.refused(command.replace("shared/out", "shared/way/none"), name)

    def test_folders_are_written_through_none_either(self):
        self.plant("shared/way", "../mine")
        for command in ("report a.h5 --figures shared/way", "report a.h5 --figures shared/way/new",
                        "new shared/way/scene", "selftest --folder shared/way",
                        "slurm scene.json --hours 1 --cpus 1 --jobs 1 --folder shared/way",
                        "slurm scene.json --hours 1 --cpus 1 --jobs 1 --folder shared/way/new"):
            with self.subTest(command):
                before, files = self.contents(), self.files()
                done = self.as_user(command)
                self.assertIn(done.returncode, (2, BROKEN), done.stdout + done.stderr)
                self.assertIn("another user", done.stderr)
                self.assertEqual((self.contents(), self.files()), (before, files))
        for name in ("scene.json", "scene.schema.json"):
            self.plant(f"shared/{name}", "../mine/none")
            done = self.as_user("new shared/scene")
            self.assertEqual(done.returncode, BROKEN)
            self.assertEqual(self.contents(), before)
            os.unlink(self.folder / "shared" / name)
            for made in (self.folder / "shared").glob("scene*"):
                made.unlink()

    def test_tables_are_kept_in_no_file_that_a_planted_link_leads_to(self):
        shutil.copy(self.folder / "a.h5", self.folder / "mine/a.h5")
        os.chown(self.folder / "mine/a.h5", OWN, OWN)
        self.plant("shared/a.h5", "../mine/a.h5")
        before = self.contents()
        done = self.as_user("fit shared/a.h5 --observable mean_height --model kww")  # reading is allowed
        self.assertEqual(done.returncode, BROKEN, done.stderr)
        self.assertIn("another user", done.stderr)
        self.assertEqual(self.contents(), before)

    def test_one_s_own_links_are_followed(self):
        for mode in (0o1777, 0o777, 0o775):
            for name in ("run --force", "merge --force", "export h5md", "fit --csv", "report"):
                with self.subTest(f"{name} {mode:o}"):
                    target = self.folder / "mine/new"
                    self.plant("shared/out", "../mine/new", owner=OWN, mode=mode)
                    done = self.as_user(COMMANDS[name])
                    self.assertEqual(done.returncode, OK, done.stderr)
                    self.assertTrue((self.folder / "shared/out").is_symlink())
                    self.assertTrue(stat.S_ISREG(os.lstat(target).st_mode))
                    os.unlink(target)
                    os.unlink(self.folder / "shared/out")

    def test_a_script_of_another_user_is_not_advised(self):
        shards = self.folder / "shared"
        os.chmod(shards, 0o1777)
        self.assertEqual(self.as_user("run scene.json --quiet --shard 1/2 -o shared/1.h5").returncode, OK)
        script = shards / "job.sbatch"
        script.write_text("#!/bin/bash\nshards=2 a_task=1 most_restarts=10\n")
        os.chown(script, OTHER, OTHER)
        self.assertNotIn("sbatch", self.as_user("status shared").stdout)
        os.chown(script, OWN, OWN)
        self.assertIn("sbatch --array=2 shared/job.sbatch", self.as_user("status shared").stdout)

    def test_a_batch_script_writes_through_no_link(self):
        self.assertEqual(self.as_user("slurm scene.json --hours 1 --cpus 1 --jobs 1 -o mine/tiny.sbatch"
                                      " --folder shared/of-job").returncode, OK)
        script = ["bash", "mine/tiny.sbatch"]
        environment = {**PLAIN, "SLURM_JOB_ID": "7", "SLURM_ARRAY_JOB_ID": "7", "SLURM_ARRAY_TASK_ID": "1"}

        def submitted():
            return subprocess.run([*RUN_AS, *script], cwd=self.folder, env=environment, text=True,
                                  capture_output=True)
        before = self.contents()
        self.plant("shared/of-job", "../mine")
        done = submitted()
        self.assertEqual((done.returncode, self.contents()), (BROKEN, before), done.stdout)
        self.assertIn("a link of another user", done.stdout)
        os.unlink(self.folder / "shared/of-job")
        os.mkdir(self.folder / "shared/of-job", 0o777)
        os.chmod(self.folder / "shared/of-job", 0o1777)
        for name in (".job.7", "1.log", "1.h5"):
            self.plant(f"shared/of-job/{name}", "../../mine/victim")
            done = submitted()
            self.assertEqual(self.contents(), before, f"{name}\n{done.stdout}{done.stderr}")
            if name != ".job.7":
                self.assertEqual(done.returncode, BROKEN, done.stdout)
                os.unlink(self.folder / "shared/of-job" / name)


class Meanwhile(Case):
    """A file that appears while a command makes one of the same name."""

    COMMANDS = (
        "fit a.h5 --observable mean_height --model kww --no-store --csv out",
        "analyse a.h5 steady --observable mean_height --no-store --csv out",
        "report a.h5 -o out",
        "export a.h5 --format extxyz -o out",
        "export a.h5 --format h5md -o out",
        "export a.h5 --format results -o out",
    )

    def paused(self, command):
        process = self.popen(*command.split(), environment={
            **SHIM, "JOSTLE_FAULT_PATH": str(self.folder / "out"), "JOSTLE_FAULT_ACTION": "pause",
            "JOSTLE_FAULT_AT": "1"})
        change = os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
        self.assertEqual(change.si_code, os.CLD_STOPPED, "ended before it was paused")
        return process

    def test_it_is_kept_unless_force_is_given(self):
        self.write(ONE)
        self.run_scene("--quiet", "-o", "a.h5")
        before = self.files()
        for command in self.COMMANDS:
            with self.subTest(command):
                process = self.paused(command)
                (self.folder / "out").write_text("others")
                process.send_signal(signal.SIGCONT)
                _, errors = process.communicate(timeout=60)
                self.assertEqual(process.returncode, BROKEN, errors)
                self.assertIn("out: exists already; choose another name, or replace it (--force)", errors)
                self.assertEqual((self.folder / "out").read_text(), "others")
                self.assertEqual(sorted(self.files()), sorted([*before, "out"]))
                (self.folder / "out").unlink()


class Sources(Case):
    """Every call that makes, opens to write, moves or links a file, by the file that has it: why it may."""

    CALLS = re.compile(
        r"\b(?:O_CREAT|O_WRONLY|O_RDWR|O_APPEND|O_TRUNC|[io]?fstream\s+\w+\(|ofstream|fopen|freopen|creat\(|mkdir\(|"
        r"mkdtemp|mkstemp|tmpfile|mkfifo|mknod|create_director|create_symlink|create_hard_link|copy_file|"
        r"fs::copy|fs::rename|filesystem::rename|resize_file|::rename\(|renameat|(?<!\w)::link\(|symlink\(|::truncate\(|"
        r"H5Fcreate|H5F_ACC_RDWR|H5F_ACC_TRUNC|output\.open\()")
    LOOKS = "output_path("
    MAY = {
        "cli/files/python_plot.cpp": "in a scratch folder of its own, O_EXCL",
        "cli/files/keep_tables.cpp": LOOKS,
        "cli/manual/main.cpp": "makes the manual pages when jostle is built",
        "results/locks/lock.cpp": LOOKS,
        "results/disk/output_path.cpp": "is what looks",
        "results/run/run_parts.cpp": LOOKS,
        "results/disk/seal.cpp": "a TemporaryFile, which is there",
        "results/disk/temporary_file.cpp": LOOKS,
        "results/hdf5/child_process.cpp": "/dev/null",
        "results/hdf5/writable_file.cpp": "a TemporaryFile, which is there",
        "results/locks/slurm_job.cpp": "/dev/null",
        "study/running/self_checks.cpp": "a file of its own in a scratch folder",
    }

    def sources(self):
        for folder in ("cli", "config", "engine", "ensemble", "fitting", "results", "structure", "study"):
            for path in sorted((SOURCE / folder).rglob("*.?pp")):
                text = re.sub(r"//[^\n]*", "", path.read_text())
                # An ifstream reads.
                yield str(path.relative_to(SOURCE)), re.sub(r"\bifstream\s+\w+\(", "", text)

    def test_every_file_that_is_written_is_looked_at_before(self):
        found = {name: text for name, text in self.sources() if self.CALLS.search(text)}
        self.assertEqual(sorted(found), sorted(self.MAY))
        for name, why in self.MAY.items():
            if why == self.LOOKS:
                self.assertIn(self.LOOKS, found[name], name)

    def test_links_are_resolved_in_few_places(self):
        resolves = re.compile(r"\b(?:read_symlink|readlink|realpath)\(")
        found = {name: len(resolves.findall(text)) for name, text in self.sources()}
        self.assertEqual({name: n for name, n in found.items() if n > 0},
                         {"cli/files/output_file.cpp": 1,  # true for a descriptor
                          "results/disk/output_path.cpp": 1,
                          "results/disk/publish.cpp": 1,  # to read
                          "study/provenance.cpp": 1})  # the content of /proc/self/exe
        followed = {name: text.count("end_of_links(") for name, text in self.sources()}
        self.assertEqual({name for name, n in followed.items() if n > 0},
                         {"results/disk/output_path.cpp", "results/disk/publish.cpp",
                          "results/disk/publish.hpp", "results/run/live_run.cpp"})


if __name__ == "__main__":
    unittest.main()
