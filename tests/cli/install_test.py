"""cmake --install gives a program that runs and libraries that another project finds."""

import os
import pathlib
import subprocess
import unittest

from support import SOURCE, TINY, Case

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

        self.command("cmake", "-G", "Ninja", "-S", SOURCE / "tests/cli/consumer", "-B", "consumer",
                     f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release",
                     f"-DEXAMPLES={SOURCE / 'docs/examples'}")
        self.command("cmake", "--build", "consumer")
        height = float(self.command("consumer/pour"))
        # 300 spheres on 36 d^2 at solids fraction 0.5 to 0.65 make a bed 6.7 to 8.7 d deep.
        self.assertTrue(3.2 < height < 4.5, height)
        self.assertIn("power_approach: X = X_inf", self.command("consumer/own_model"))


if __name__ == "__main__":
    unittest.main()
