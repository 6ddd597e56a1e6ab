"""The scripts of examples/ run, on fewer taps than they are written for."""

import os
import subprocess
import sys
import unittest

from support import SOURCE, Case

SMALL = {
    "compaction": (["--taps", "12", "--realizations", "3"], "dilated by  0.05: <Z> falls by"),
    "ageing": (["--taps", "120", "--realizations", "3"], "collapse: cannot decide"),
    "hysteresis": (["--taps", "4", "--realizations", "3"], "area of the loop:"),
    "structure": (["--taps", "4", "--realizations", "2"], "tap 4: "),
    "own_analysis": (["--taps", "4", "--realizations", "3"], "spheres at z = 3.5: fell by"),
}


class Examples(Case):
    def test_every_script_is_run_here(self):
        self.assertEqual({path.stem for path in (SOURCE / "examples").glob("*.py")}, set(SMALL))

    def test_every_script_says_what_it_found_and_draws_it(self):
        for name, (arguments, said) in SMALL.items():
            with self.subTest(name=name):
                done = subprocess.run(
                    [sys.executable, SOURCE / f"examples/{name}.py", *arguments], text=True,
                    capture_output=True)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertIn(said, done.stdout)
                for made in done.stdout.splitlines()[-1].split(", "):
                    self.assertGreater(os.path.getsize(made), 1000, made)

    def test_the_page_names_them(self):
        page = (SOURCE / "docs/reference/python.md").read_text()
        for name in SMALL:
            self.assertIn(f"(../../examples/{name}.py)", page)


if __name__ == "__main__":
    unittest.main()
