"""cmake --install gives a program that runs and libraries that another project finds."""

import json
import os
import pathlib
import subprocess
import sys
import unittest

from public_headers_test import internal_headers, public_headers
from support import PLAIN, SOURCE, TINY, Case, changed

BUILD = pathlib.Path(os.environ["BUILD"])


class Install(Case):
    def command(self, *words):
        result = subprocess.run([str(word) for word in words], cwd=self.folder, text=True,
                                capture_output=True, timeout=600)
        self.assertEqual(result.returncode, 0,
                         f"{' '.join(map(str, words))}\n{result.stdout}{result.stderr}")
        return result.stdout

    def test_the_installed_program_and_libraries_work(self):
        prefix = self.folder / "prefix"
        self.command("cmake", "--install", BUILD, "--prefix", prefix)

        program = prefix / "bin/jostle"
        self.assertIn("jostle 0.", self.command(program, "--version"))
        self.write(TINY)
        self.command(program, "run", "scene.json", "--quiet")
        self.run_scene("-o", "built.h5")
        self.assertEqual(self.digest("tiny.h5"), self.digest("built.h5"))
        self.command(program, "check", prefix / "share/jostle/scenes/quickstart.json", "--no-pilot")

        self.command(program, "new", "own", "--from", "philippe-bideau-2001/fig2")
        self.command(program, "check", "own.json", "--no-pilot")

        headers = {str(path.relative_to(prefix / "include/jostle"))
                   for path in (prefix / "include/jostle").rglob("*.*")}
        names = [header.name for header in public_headers()]
        self.assertEqual(headers, {*names, *(f"internal/{name}" for name in internal_headers())})

        self.command("cmake", "-G", "Ninja", "-S", SOURCE / "tests/cli/consumer", "-B", "consumer",
                     f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release",
                     f"-DEXAMPLES={SOURCE / 'docs/examples'}",
                     f"-DHEADERS={';'.join(f'jostle/{name}' for name in names)}")
        self.command("cmake", "--build", "consumer")
        height = float(self.command("consumer/pour"))
        # 300 spheres on 36 d^2 at packing fraction 0.5 to 0.65 make a bed 6.7 to 8.7 d deep.
        self.assertTrue(3.2 < height < 4.5, height)
        self.assertIn("power_approach: X = X_inf", self.command("consumer/own_model"))
        self.run_own_sink(program)
        self.import_the_package(prefix)

    def test_a_project_can_contain_the_sources(self):
        self.command("cmake", "-G", "Ninja", "-S", SOURCE / "tests/cli/parent", "-B", "parent", f"-DJOSTLE={SOURCE}",
                     f"-DPOUR={SOURCE / 'tests/cli/consumer/pour.cpp'}")
        self.command("cmake", "--build", "parent", "--target", "pour")

    def import_the_package(self, prefix):
        """The installed package, with the program installed beside it, and as xarray's engine."""
        script = ("import jostle, xarray\n"
                  "assert jostle.__file__.startswith(%r), jostle.__file__\n"
                  "ensemble = xarray.open_dataset('tiny.h5', engine='jostle')\n"
                  "assert ensemble.sizes['dilate'] == 2\n"
                  "print(jostle.open('tiny.h5').digest())" % str(prefix))
        done = subprocess.run([sys.executable, "-c", script], cwd=self.folder, text=True,
                              capture_output=True, env={**PLAIN, "PATH": f"{prefix}/bin:{PLAIN['PATH']}",
                                                        "PYTHONPATH": f"{prefix}/lib/python3/dist-packages"})
        self.assertEqual(done.stdout.strip(), self.digest("tiny.h5"), done.stderr)

    def run_own_sink(self, program):
        """A run into memory is analysed and fitted with the numbers of the program."""
        scene = changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}])
        del scene["sweep"], scene["snapshots"]
        self.write(scene, "own.json")
        self.command(program, "run", "own.json", "-o", "own.h5", "--quiet")
        steady = json.loads(self.command(program, "analyse", "own.h5", "steady", "--observable",
                                         "mean_height", "--last", 32, "--json"))
        fitted = json.loads(self.command(program, "fit", "own.h5", "--observable", "mean_height",
                                         "--model", "inverse_log", "--json"))
        lines = self.command("consumer/own_sink", "own.json").splitlines()
        numbers = dict(line.split() for line in lines if len(line.split()) == 2)
        value = steady["tables"][0]["quantities"]["value"]["values"]
        self.assertEqual(float(numbers["steady"]), value)
        parameters = fitted["curves"][0]["fits"][0]["parameters"]
        self.assertEqual(sorted(set(numbers) - {"steady"}), sorted(parameters))
        for name, parameter in parameters.items():
            if parameter["value"] is not None:
                self.assertEqual(float(numbers[name]), parameter["value"])


if __name__ == "__main__":
    unittest.main()
