"""Builds jostle here with another compiler, another C++ library, for another processor or without what only
Linux on x86-64 has, and compares the digests of the quickstart and of the small scenes with the recorded ones.

./dev test-elsewhere clang | libcxx | arm64 | fallbacks [--tests] calls it, with SOURCE (the checkout) and BUILD
(where each has a folder of its own).

clang      clang 16 with GNU's C++ library.
libcxx     clang 16 with libc++. Debian builds muParser with GNU's C++ library, so the program does not link: all of it
           is compiled, and --tests runs the test programs that need no such library.
arm64      g++ for aarch64, against a Debian of that architecture that is unpacked and never booted; what is built
           runs under qemu-user.
fallbacks  JOSTLE_PORTABLE: no intrinsics, and no call that only Linux has.
"""

import argparse
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys

SOURCE = pathlib.Path(os.environ["SOURCE"])
BUILD = pathlib.Path(os.environ["BUILD"])
QUICKSTART = SOURCE / "config/scenes/quickstart.json"
LIBRARIES = [f"jostle_{name}" for name in ("engine", "structure", "fitting", "ensemble", "config", "results", "study")]
# Test programs without a library of GNU's C++: they link with libc++. Those of structure need voro++.
INDEPENDENT = ["engine", "fitting", "ensemble"]
TESTED = ["engine", "structure", "fitting", "ensemble", "config", "results"]
DEFINITIONS = {
    "clang": ["-DCMAKE_CXX_COMPILER=clang++-16"],
    "libcxx": ["-DCMAKE_CXX_COMPILER=clang++-16", "-DJOSTLE_WARNINGS_AS_ERRORS=OFF",
               "-DCMAKE_CXX_FLAGS=-stdlib=libc++ -DFMT_HEADER_ONLY"],
    "fallbacks": ["-DJOSTLE_PORTABLE=ON"],
    "arm64": [f"--toolchain={SOURCE}/tests/elsewhere/aarch64.cmake", f"-DJOSTLE_SYSROOT={BUILD}/debian-arm64"],
}
NEEDS = {"clang": ["clang++-16"], "libcxx": ["clang++-16"], "fallbacks": [],
         "arm64": ["aarch64-linux-gnu-g++", "qemu-aarch64-static", "mmdebstrap"]}
FAST = "~[statistics]~[slow]~[nightly]"


def run(*command, **options):
    """Runs a command; a failure ends this program."""
    done = subprocess.run([str(word) for word in command], **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}")
    return done.stdout


def listed(use):
    lines = (SOURCE / f"packages/{use}.txt").read_text().splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def unpack_debian(root):
    """Unpacks the libraries of the other architecture that the program and its tests link, without running any."""
    if (root / "usr/include").exists():
        return
    shutil.rmtree(root, ignore_errors=True)
    libraries = [name for name in listed("run") if "-dev" in name] + ["catch2", "libvalijson-dev", "libstdc++-12-dev"]
    run("mmdebstrap", "--variant=extract", "--architectures=arm64", f"--include={','.join(libraries)}", "bookworm", root)


class Build:
    def __init__(self, platform):
        self.platform = platform
        self.folder = BUILD / platform
        # A program of the other architecture is run by qemu.
        self.before = ["qemu-aarch64-static", "-L", BUILD / "debian-arm64"] if platform == "arm64" else []

    def configure(self):
        if self.platform == "arm64":
            unpack_debian(BUILD / "debian-arm64")
        run("cmake", "-S", SOURCE, "-B", self.folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
            "-DCMAKE_CXX_FLAGS_RELEASE=-O3", "-DJOSTLE_WARNINGS_AS_ERRORS=ON", "-DJOSTLE_TESTS=ON", *DEFINITIONS[self.platform],
            stdout=subprocess.DEVNULL)

    def build(self, *targets):
        run("cmake", "--build", self.folder, "--target", *targets)

    def quickstart(self):
        program = [*self.before, self.folder / "cli/jostle"]
        results = self.folder / "quickstart.h5"
        run(*program, "run", QUICKSTART, "-o", results, "--force", "--quiet", stdout=subprocess.DEVNULL)
        digest = run(*program, "info", "--digest", results, stdout=subprocess.PIPE, text=True).split()[-1]
        recorded = json.loads((SOURCE / "tests/data/quickstart_digest.json").read_text())["sha256"]
        if digest != recorded:
            sys.exit(f"{self.platform}: the quickstart's digest is {digest}, not {recorded}")
        print(f"{self.platform}: the quickstart's digest is the recorded one", flush=True)

    def scenes(self):
        """Runs the small scenes of `cli: digests`; its scripts call one program, which starts qemu where it must."""
        program = self.folder / "run-jostle"
        program.write_text(f'#!/bin/sh\nexec {shlex.join(map(str, [*self.before, self.folder / "cli/jostle"]))} "$@"\n')
        program.chmod(0o755)
        run(sys.executable, SOURCE / "tests/cli/digests_test.py",
            env=os.environ | {"JOSTLE": str(program), "FAULT_SHIM": "", "SOURCE": str(SOURCE)})
        print(f"{self.platform}: the digests of the small scenes are the recorded ones", flush=True)

    def tests(self):
        if self.platform in ("clang", "fallbacks"):
            self.build("all")
            run("ctest", "--test-dir", self.folder, "--output-on-failure", "--label-regex", "^(fast|statistics)$",
                "--parallel", str(os.cpu_count()))
            return
        for folder in INDEPENDENT if self.platform == "libcxx" else TESTED:
            self.build(f"test_{folder}")
            print(f"{self.platform}: {folder}", flush=True)
            run(*self.before, self.folder / f"tests/{folder}/test_{folder}", FAST)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("platform", choices=DEFINITIONS)
    parser.add_argument("--tests", action="store_true", help="the tests as well")
    arguments = parser.parse_args()
    missing = [program for program in NEEDS[arguments.platform] if shutil.which(program) is None]
    if missing:
        sys.exit(f"{arguments.platform} needs {', '.join(missing)}")
    build = Build(arguments.platform)
    build.configure()
    if arguments.platform == "libcxx":
        build.build(*LIBRARIES)
        print("libcxx: every library of the program compiles", flush=True)
    else:
        build.build("jostle")
        # Under qemu the quickstart takes much longer than the small scenes, about 40 minutes of processor time.
        build.scenes()
        build.quickstart()
    if arguments.tests:
        build.tests()


main()
