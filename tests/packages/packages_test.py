"""The Debian packages of ./dev package: lintian finds no error, the same commit gives the same bytes in
another folder, and they install and run on a bare Debian 12 with dpkg alone. ./dev test-package runs it,
with SOURCE and BUILD."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["SOURCE"])
BUILD = pathlib.Path(os.environ["BUILD"])
AGAIN = "--again" in sys.argv
NAMES = ("jostle", "libjostle-dev", "python3-jostle")
SCENE = """{"name": "tiny", "seed": 1, "realizations": 2, "container": {"sides": "periodic", "width": 4},
"spheres": 48, "protocol": [{"tap": {"dilate": 0.05}, "count": 12}], "observe": ["mean_height"],
"relax": {"polar": {}, "stop": {"sweeps": 50}}}"""


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], text=True, capture_output=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def package(name, folder=BUILD):
    (path,) = (folder / "packages").glob(f"{name}_*.deb")
    return path


def field(name, key):
    return run("dpkg-deb", "--field", package(name), key).strip()


class Packages(unittest.TestCase):
    maxDiff = None

    def folder(self):
        folder = tempfile.mkdtemp(prefix="jostle-packages-")
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        return pathlib.Path(folder)

    def test_lintian_finds_no_error(self):
        run("lintian", "--fail-on", "error", "--suppress-tags", "bad-distribution-in-changes-file",
            *(["--allow-root"] if os.getuid() == 0 else []), *map(package, NAMES))

    def test_packages_hold_what_they_should(self):
        listed = {name: run("dpkg-deb", "--contents", package(name)) for name in NAMES}
        for name, files in {
                "jostle": ("bin/jostle", "share/man/man1/jostle.1.gz", "share/man/man1/jostle-run.1.gz",
                           "share/bash-completion/completions/jostle", "share/zsh/vendor-completions/_jostle",
                           "share/jostle/scenes/quickstart.json", "share/jostle/scene.schema.json",
                           "share/doc/jostle/docs/tutorial.md", "share/doc/jostle/copyright"),
                "libjostle-dev": ("include/jostle/run.hpp", "lib/libjostle_study.a",
                                  "lib/cmake/jostle/jostle-config.cmake"),
                "python3-jostle": ("lib/python3/dist-packages/jostle/__init__.py",)}.items():
            for file in files:
                self.assertIn(f" ./usr/{file}\n", listed[name])
        self.assertEqual(field("python3-jostle", "Architecture"), "all")
        # Nothing of this machine, and no library of ours that nobody packs.
        self.assertNotIn(str(SOURCE), "".join(listed.values()))
        for needed in ("libc6", "libhdf5-103", "libmuparser2v5", "libtbb12", "libssl3"):
            self.assertIn(needed, field("jostle", "Depends"))

    def test_no_file_names_the_folder_it_was_built_in(self):
        folder = self.folder()
        for name in NAMES:
            run("dpkg-deb", "--extract", package(name), folder / name)
            for path in (folder / name).rglob("*"):
                if path.is_file():
                    self.assertNotIn(os.fsencode(SOURCE), path.read_bytes(), path)

    def test_the_installed_libraries_are_found_and_linked(self):
        folder = self.folder()
        run("dpkg-deb", "--extract", package("libjostle-dev"), folder / "root")
        (folder / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(own LANGUAGES CXX)\n"
            "find_package(jostle REQUIRED)\n"
            f"add_executable(own {SOURCE}/docs/examples/own_sink.cpp)\n"
            "target_link_libraries(own PRIVATE jostle::study)\n")
        run("cmake", "-G", "Ninja", "-S", folder, "-B", folder / "build",
            f"-DCMAKE_PREFIX_PATH={folder}/root/usr")
        run("cmake", "--build", folder / "build")

    @unittest.skipUnless(AGAIN, "a second build takes as long as the first: --again makes it")
    def test_a_second_build_elsewhere_gives_the_same_bytes(self):
        """Builds the committed sources, in a clone, without a cache."""
        self.assertEqual(run("git", "-C", SOURCE, "status", "--porcelain"), "", "uncommitted changes")
        clone = self.folder() / "clone"
        run("git", "clone", "--quiet", SOURCE, clone)
        run(clone / "dev", "package", env={**os.environ, "CCACHE_DISABLE": "1"})
        for name in NAMES:
            self.assertEqual(package(name).read_bytes(), package(name, clone / "build/release").read_bytes(),
                             f"{name}: diffoscope shows the differences")


class BareDebian(unittest.TestCase):
    """Debian 12 with what dpkg needs and what the packages name, nothing else."""

    @classmethod
    def setUpClass(cls):
        if subprocess.run(["unshare", "--mount", "true"], capture_output=True).returncode != 0:
            raise unittest.SkipTest("no chroot can be made here: that needs root or user namespaces")
        cls.root = pathlib.Path(tempfile.mkdtemp(prefix="jostle-bare-"))
        cls.addClassCleanup(shutil.rmtree, cls.root, ignore_errors=True)
        needed = set()
        for name in ("jostle", "python3-jostle"):
            needed |= {re.split(r"[ :(|]", one.strip())[0] for one in field(name, "Depends").split(",")}
        run("mmdebstrap", "--variant=minbase", f"--include={','.join(sorted(needed | {'bash'}))}",
            "bookworm", cls.root)
        for name in ("jostle", "python3-jostle"):
            shutil.copy(package(name), cls.root / "tmp")
        (cls.root / "tmp/tiny.json").write_text(SCENE)

    def bare(self, *command):
        return run("chroot", self.root, "/usr/bin/env", "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin",
                   "HOME=/tmp", *command)

    def test_packages_install_by_dpkg_and_run(self):
        self.bare("sh", "-c", "dpkg --install /tmp/*.deb")
        self.assertIn("jostle " + field("jostle", "Version").split("-")[0], self.bare("jostle", "--version"))
        self.bare("jostle", "selftest")
        self.bare("sh", "-c", "cd /tmp && jostle run tiny.json --quiet")
        fit = self.bare("jostle", "fit", "/tmp/tiny.h5", "--observable", "mean_height", "--law",
                        "a + b*log(t)", "--start", "a=4,b=-0.1")
        self.assertIn("own: X = a + b*log(t)", fit)
        said = self.bare("python3", "-c", "import jostle; print(jostle.open('/tmp/tiny.h5').digest())")
        self.assertEqual(said, self.bare("jostle", "info", "--digest", "/tmp/tiny.h5"))
        self.bare("sh", "-c", "cd /tmp && jostle check /usr/share/jostle/scenes/quickstart.json --no-pilot")
        offered = self.bare("bash", "-c", "source /usr/share/bash-completion/completions/jostle; "
                            "COMP_WORDS=(jostle se); COMP_CWORD=1; _jostle; echo ${COMPREPLY[@]}")
        self.assertEqual(offered, "selftest\n")
        self.bare("dpkg", "--purge", "python3-jostle", "jostle")
        self.assertFalse((self.root / "usr/bin/jostle").exists())
        self.assertFalse((self.root / "usr/share/doc/jostle").exists())


if __name__ == "__main__":
    unittest.main(argv=[word for word in sys.argv if word != "--again"])
