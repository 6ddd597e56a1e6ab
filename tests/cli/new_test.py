"""jostle new: a scene of one's own, from one that is shipped."""

import json
import os
import subprocess
import unittest

from support import BAD_INPUT, BROKEN, JOSTLE, PLAIN, SOURCE, STOPPED, Case

SHIPPED = sorted(str(path.relative_to(SOURCE / "config/scenes").with_suffix(""))
                 for path in (SOURCE / "config/scenes").rglob("*.json"))


class New(Case):
    def test_a_new_scene_stands_alone(self):
        out = self.jostle("new", "my-bed").stdout
        self.assertIn("my-bed.json: a copy of quickstart", out)
        self.assertEqual(self.files(), ["my-bed.json", "scene.schema.json"])
        scene = json.loads((self.folder / "my-bed.json").read_text())
        original = json.loads((SOURCE / "config/scenes/quickstart.json").read_text())
        self.assertEqual(scene, {**original, "name": "my-bed", "$schema": "scene.schema.json"})
        self.assertEqual((self.folder / scene["$schema"]).read_text(),
                         self.jostle("schema").stdout)
        self.jostle("run", "my-bed.json", "--time-limit", "0s", "--quiet", expect=STOPPED)
        self.assertIn("my-bed.h5", self.files())

    def test_commands_that_are_printed_begin_with_the_word_that_was_typed(self):
        def call(word, *arguments):
            done = subprocess.run([word, *arguments], executable=JOSTLE, cwd=self.folder, env=PLAIN, text=True,
                                  capture_output=True)
            return " ".join((done.stdout + done.stderr).split())

        for word in ("./dev", "../jostle/dev", "jostle"):
            printed = call(word, "new", "mine", "--force")
            self.assertIn(f"; {word} check mine.json estimates its cost, {word} run mine.json writes", printed)
            call(word, "run", "mine.json", "--time-limit", "0s", "--force")
            self.assertIn(f"Finish it with {word} run SCENE --resume",
                          call(word, "fit", "mine.h5", "--observable", "bottom_fraction"))
            printed = call(word, "slurm", "mine.json", "--hours", "1", "--cpus", "1", "--jobs", "2", "-o", "x.sh", "--force")
            self.assertIn(f" {word} status mine.shards {word} merge mine.shards -o mine.h5", printed)

    def test_every_shipped_scene_can_be_taken(self):
        self.assertGreater(len(SHIPPED), 20)
        for name in SHIPPED:
            with self.subTest(name=name):
                self.jostle("new", "mine.json", "--from", name, "--force")
                text = self.jostle("check", "mine.json", "--no-pilot").stdout
                self.assertEqual(json.loads(text.split("\n}\n")[0] + "\n}")["name"], "mine")

    def test_nothing_is_replaced_without_force(self):
        self.jostle("new", "mine")
        (self.folder / "mine.json").write_text("{}")
        (self.folder / "scene.schema.json").write_text("{}")
        err = self.jostle("new", "mine", expect=BAD_INPUT).stderr
        self.assertIn("mine.json exists and is kept", err)
        err = self.jostle("new", "other").stderr
        self.assertIn("scene.schema.json is not the schema of this version, and is kept", err)
        self.assertEqual((self.folder / "scene.schema.json").read_text(), "{}")
        self.assertEqual((self.folder / "mine.json").read_text(), "{}")
        self.jostle("new", "mine", "--force")
        self.assertIn("mine", (self.folder / "mine.json").read_text())
        self.assertNotEqual((self.folder / "scene.schema.json").read_text(), "{}")

    def test_an_unknown_scene_is_answered_with_those_there_are(self):
        err = self.jostle("new", "mine", "--from", "fig4-bel", expect=BAD_INPUT).stderr
        self.assertIn('Did you mean "philippe-bideau-2001/fig4-bell"?', err)
        for name in SHIPPED:
            self.assertIn(f"\n  {name}\n", err + "\n")
        self.assertEqual(self.files(), [])

    def test_links_and_pipes_are_not_written_to(self):
        victim = self.folder / "victim"
        victim.write_text("mine")
        (self.folder / "scene.schema.json").symlink_to(victim)
        err = self.jostle("new", "bed", "--force", expect=BROKEN).stderr
        self.assertIn("scene.schema.json: is a link that jostle did not make", err)
        self.assertEqual(victim.read_text(), "mine")
        self.assertNotIn("bed.json", self.files())
        (self.folder / "scene.schema.json").unlink()
        for name in ("scene.schema.json", "bed.json"):
            with self.subTest(name=name):
                os.mkfifo(self.folder / name)
                err = self.jostle("new", "bed", "--force", expect=BAD_INPUT).stderr
                self.assertIn(f"{name} is a pipe or a device: remove it", err)
                (self.folder / name).unlink()

    def test_a_name_is_that_of_a_file(self):
        for name in ("my bed", "-bed", "a\"b", ".."):
            with self.subTest(name=name):
                self.jostle("new", name, expect=BAD_INPUT)
        (self.folder / "folder").mkdir()
        self.jostle("new", "folder/bed")
        self.assertEqual(json.loads((self.folder / "folder/bed.json").read_text())["name"], "bed")


if __name__ == "__main__":
    unittest.main()
