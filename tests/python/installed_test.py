"""The package where pip, cmake --install or a copy put it: its version, and the program of its own environment."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import jostle

from support import PROGRAM, SOURCE, Case

ASK = "import json, jostle; print(json.dumps([jostle.__version__, jostle.program_path()]))"


class Installed(Case):
    def site(self, name, version=None, record=None):
        """A folder with a copy of the package; with its metadata, and with pip's list of files."""
        site = pathlib.Path(name).resolve() / "lib/site-packages"
        shutil.copytree(SOURCE / "python/jostle", site / "jostle", ignore=shutil.ignore_patterns("__pycache__"))
        if version:
            information = site / f"jostle-{version}.dist-info"
            information.mkdir()
            (information / "METADATA").write_text(f"Metadata-Version: 2.1\nName: jostle\nVersion: {version}\n")
            if record:
                (information / "RECORD").write_text("".join(f"{line},,\n" for line in record))
        return site

    def program(self, folder):
        path = pathlib.Path(folder).resolve() / "jostle"
        path.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy("/bin/true", path)
        return str(path)

    def ask(self, *sites, path, named=""):
        environment = {**os.environ, "JOSTLE": named, "PATH": path, "PYTHONPATH": os.pathsep.join(map(str, sites))}
        done = subprocess.run([sys.executable, "-c", ASK], env=environment, text=True, capture_output=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_the_source_tree_has_the_version_of_the_citation(self):
        cited = re.search(r"(?m)^version: (.*)$", (SOURCE / "CITATION.cff").read_text())[1]
        self.assertEqual(jostle.__version__, cited)

    def test_the_program_of_the_environment_comes_before_the_path(self):
        site = self.site("venv", "7.8.9", ["../../bin/jostle", "jostle/__init__.py"])
        own, other = self.program("venv/bin"), self.program("other")
        elsewhere = str(pathlib.Path("other").resolve())
        self.assertEqual(self.ask(site, path=elsewhere), ["7.8.9", own])
        self.assertEqual(self.ask(site, path=elsewhere, named=PROGRAM), ["7.8.9", PROGRAM])
        os.remove(own)
        self.assertEqual(self.ask(site, path=elsewhere), ["7.8.9", other])

    def test_another_installation_on_the_path_of_modules_is_not_this_one(self):
        """The source tree, or an older copy, comes first on the path."""
        behind = self.site("venv", "7.8.9", ["../../bin/jostle", "jostle/__init__.py"])
        self.program("venv/bin")
        other = self.program("other")
        elsewhere = str(pathlib.Path("other").resolve())
        self.assertEqual(self.ask(SOURCE / "python", behind, path=elsewhere), [jostle.__version__, other])
        self.assertEqual(self.ask(self.site("copied"), behind, path=elsewhere), ["unknown", other])

    def test_what_cmake_installs_has_a_version_and_no_program(self):
        other = self.program("other")
        self.assertEqual(self.ask(self.site("prefix", "7.8.9"), path=str(pathlib.Path("other").resolve())),
                         ["7.8.9", other])


if __name__ == "__main__":
    unittest.main()
