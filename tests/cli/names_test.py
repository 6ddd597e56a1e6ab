"""Files whose names begin with a dash, or are patterns or commands of a shell: on the program's command
line, in its batch script, and in the commands that it prints."""

import hashlib
import os
import subprocess
import unittest

import h5py

from support import JOSTLE, OK, PLAIN, SLOW, STOPPED, TINY, Case, changed, some

ONE = changed(TINY, sweep={}, realizations=2, protocol=[{"tap": {"dilate": 0.05}, "count": 40}],
              snapshots={"taps": [0]})
NAMES = ("-x", "--force", "a b", "it's", "$(touch made)", "`touch made`", "*", "[a]", "~", "#", "a;b&c|d",
         "two\nlines")


class Names(Case):
    def bash(self, command, expect=OK, **environment):
        done = subprocess.run(["bash", "-c", command], cwd=self.folder, text=True, stdin=subprocess.DEVNULL,
                              capture_output=True, env={**PLAIN, **environment})
        self.assertEqual(done.returncode, expect, f"{command}\n{done.stdout}{done.stderr}")
        self.assertFalse((self.folder / "made").exists(), command)
        return done

    def test_the_command_that_goes_on_goes_on(self):
        for name in some(NAMES[::3], 2):
            with self.subTest(name):
                self.write(SLOW, f"{name}.json")
                stopped = self.jostle("run", "--no-progress", f"--output={name}.h5", "--time-limit=0.1",
                                      "--", f"{name}.json", expect=STOPPED)
                command = stopped.stderr.split("resume with (omit --time-limit to reach the end)\n  ")[1]
                self.assertIn("--resume", command)
                self.bash(command.replace("--time-limit=0.1", ""))
                self.assertEqual(self.info(f"./{name}.h5")["state"], "complete")

    def test_the_commands_that_come_next_are_of_this_file(self):
        for name in some(NAMES[::2], 3):
            with self.subTest(name):
                self.write(ONE, f"{name}.json")
                told = self.jostle("run", "--no-progress", f"--output={name}.h5", "--", f"{name}.json").stdout
                for command in told.split("\nnext:\n  ")[1].split(f"\n  {JOSTLE}"):
                    self.bash(command if command.startswith(JOSTLE) else JOSTLE + command)

    def test_two_dashes_end_the_options_of_every_command(self):
        self.write(ONE, "--csv=x.json")
        self.jostle("run", "--quiet", "--output=--csv=b.h5", "--", "--csv=x.json")
        self.jostle("run", "--quiet", "-o", "a.h5", "--", "--csv=x.json")
        (self.folder / "b.h5").write_text("keep me")
        before = self.files()
        both = ("--", "a.h5", "--csv=b.h5")
        for command in (["check", "--no-pilot", "--", "--csv=x.json"], ["info", "--", "--csv=b.h5"],
                        ["fit", "--observable=mean_height", "--no-store", "--", "--csv=b.h5"],
                        ["structure", "--no-store", "--", "--csv=b.h5"], ["status", *both],
                        ["analyse", *both, "steady", "--observable=mean_height", "--no-store"]):
            with self.subTest(command):
                self.jostle(*command)
                self.assertEqual(self.files(), before)
        two = self.jostle("analyse", *both, "steady", "--observable=mean_height", "--no-store").stdout
        self.assertIn("--csv=b.h5", two)
        self.assertEqual((self.folder / "b.h5").read_text(), "keep me")

    def test_a_name_in_brackets_is_no_list(self):
        self.write(ONE)
        self.jostle("run", "scene.json", "--quiet", "-o", "[a]")
        self.jostle("structure", "[a]", "--no-store")
        self.jostle("analyse", "[a]", "steady", "--observable", "mean_height", "--no-store")

    def test_a_batch_script_runs_scenes_of_any_name_in_folders_of_any_name(self):
        for name in ("-s", "it's", "$(touch made)", "*"):
            with self.subTest(name):
                self.write(changed(TINY, name="tiny"), f"{name}.json")
                told = self.jostle("slurm", "--hours=2", "--cpus=1", "--jobs=1", f"--folder={name}/",
                                   "--output=tiny.sbatch", "--force", "--", f"{name}.json").stderr
                self.bash("bash tiny.sbatch", SLURM_JOB_ID="7", SLURM_ARRAY_JOB_ID="7", SLURM_ARRAY_TASK_ID="1",
                          SLURM_CLUSTER_NAME="a")
                self.assertEqual(sorted(os.listdir(self.folder / name)), ["1.h5", "1.log", "job.sbatch"])
                for line in told.splitlines()[-2:]:
                    self.assertTrue(line.strip().startswith(JOSTLE), line)
                    self.bash(line.strip())
                os.remove(self.folder / "tiny.h5")

    def forge(self, name, command):
        """Writes another command line into a results file, with the right checksum."""
        path = self.folder / name
        data = path.read_bytes()[:-80]
        path.write_bytes(data)
        with h5py.File(path, "r+") as file:
            lines = file["provenance/command_line"]
            lines[...] = [command] * len(lines)
        data = path.read_bytes()
        path.write_bytes(data + b"\njostle-sha256 " + hashlib.sha256(data).hexdigest().encode() + b"\n")

    def test_a_command_that_a_file_names_is_not_advised(self):
        for command in ("rm -rf /", "bash -c 'touch made' run scene.json", "evil run scene.json --csv=x",
                        "evil run a.json b.json", "evil run", "evil run -o", "jostle merge a.h5 -o b.h5"):
            with self.subTest(command):
                self.write(TINY)
                self.run_scene("--quiet", "--shard", "1/2", "-o", "1.h5", "--force")
                self.forge("1.h5", command)
                told = self.jostle("status", "1.h5").stdout
                self.assertIn(f"\n  {JOSTLE} run SCENE.json --resume --shard 2/2 -o 2.h5\n", told)
        self.forge("1.h5", "evil run --threads=2 --force -o /etc/passwd --quiet -- '-a b.json'")
        self.assertIn(f"\n  {JOSTLE} run './-a b.json' --threads=2 --quiet --resume --shard 2/2 -o 2.h5\n",
                      self.jostle("status", "1.h5").stdout)


if __name__ == "__main__":
    unittest.main()
