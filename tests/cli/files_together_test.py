"""Several files analysed together: a realization counts once."""

import json
import shutil
import unittest

from support import BAD_INPUT, Case, TINY, changed

SWEPT = "/protocol/0/tap/dilate"


class FilesTogether(Case):
    def run_sweep(self, name, values, *arguments, taps=40, **changes):
        scene = changed(TINY, **{"name": name, "protocol": [{"tap": {"dilate": 0.05}, "count": taps}],
                                 "snapshots": {"taps": []}, "sweep": {SWEPT: values}, **changes})
        if values is None:
            del scene["sweep"]
        self.write(scene, f"{name}.json")
        self.run_scene(*arguments, scene=f"{name}.json")

    def sweep(self, *files, expect=0):
        done = self.jostle("analyse", *files, "sweep", "--observable", "mean_height", "--json", expect=expect)
        return json.loads(done.stdout)["tables"][0]

    def refused(self, *files, says):
        table = self.sweep(*files, expect=BAD_INPUT)
        self.assertRegex(table["notes"]["refused"], says)
        self.assertEqual(table["quantities"], {})

    def test_points_of_one_scene_and_seed_count_once(self):
        self.run_sweep("a", [0.02, 0.1])
        self.run_sweep("b", [0.1, 0.3])
        same = "a.h5, sweep point 1, and {}.h5, sweep point {}, hold the same {} realizations .*another seed"
        self.refused("a.h5", "b.h5", says=same.format("b", 0, 3))
        self.run_sweep("longer", [0.1, 0.5], taps=60)
        self.refused("a.h5", "longer.h5", says=same.format("longer", 0, 3))
        self.run_sweep("split", [0.1, 0.5], protocol=[{"tap": {"dilate": 0.05}, "count": 10},
                                                       {"tap": {"dilate": 0.1}, "count": 40}])
        self.refused("a.h5", "split.h5", says=same.format("split", 0, 3))
        self.run_sweep("fewer", [0.1, 0.5], realizations=2, observe=["mean_height"], description="other words")
        self.refused("a.h5", "fewer.h5", says=same.format("fewer", 0, 2))
        # The quantities of other analyses are refused alike, and three files where two overlap.
        self.run_sweep("far", [0.2])
        self.refused("a.h5", "far.h5", "b.h5", says=same.format("b", 0, 3))
        done = self.jostle("analyse", "a.h5", "b.h5", "sweep", "--observable", "mean_height", "--quantity",
                           "steady/sigma", expect=BAD_INPUT)
        self.assertIn("hold the same", " ".join(done.stderr.split()))

    def test_different_seeds_points_and_scenes_are_joined(self):
        self.run_sweep("a", [0.02, 0.1])
        self.run_sweep("other_seed", [0.1, 0.3], seed=8)
        table = self.sweep("a.h5", "other_seed.h5")
        self.assertEqual(len(table["axes"]["sqrt_epsilon"]["values"]), 4)
        self.assertEqual(table["quantities"]["pooled_sigma_dof"]["values"], 8)  # 4 independent points of 3
        self.run_sweep("more", [0.3, 0.5])
        self.assertEqual(self.sweep("a.h5", "more.h5")["quantities"]["pooled_sigma_dof"]["values"], 8)
        self.run_sweep("longer_relaxed", [0.1, 0.3], relax={"polar": {}, "stop": {"sweeps": 100}})
        self.assertEqual(self.sweep("more.h5", "longer_relaxed.h5", expect=BAD_INPUT)["quantities"], {})

    def test_points_that_share_random_numbers_in_part_are_refused(self):
        self.run_sweep("m1", [0.02, 0.3], streams="matched")
        self.run_sweep("m2", [0.05, 0.1], streams="matched")
        together = self.sweep("m1.h5", "m2.h5")
        self.assertIn("realization by realization", together["notes"]["differences"])
        self.run_sweep("m3", [0.05, 0.1], streams="matched", seed=8)
        self.refused("m1.h5", "m3.h5", says="some of the 4 points share starts and random numbers")
        self.run_sweep("i3", [0.05, 0.1], seed=8)
        self.refused("m1.h5", "i3.h5", says="some of the 4 points share starts and random numbers")
        # Files without a sweep share theirs too.
        for name, strength in (("s1", 0.02), ("s2", 0.1)):
            self.run_sweep(name, None, protocol=[{"tap": {"dilate": strength}, "count": 40}])
        self.assertIn("realization by realization", self.sweep("s1.h5", "s2.h5")["notes"]["differences"])
        self.refused("s1.h5", "s2.h5", "i3.h5", says="some of the 4 points share")
        self.run_sweep("s2_again", None, protocol=[{"tap": {"dilate": 0.1}, "count": 60}])
        self.refused("s1.h5", "s2.h5", "s2_again.h5", says="s2.h5, sweep point 0, and s2_again.h5")

    def test_copies_shards_and_merged_files_count_once(self):
        self.run_sweep("a", [0.02, 0.1])
        shutil.copy(self.folder / "a.h5", self.folder / "copy.h5")
        (self.folder / "link.h5").symlink_to("a.h5")
        for other, says in (("a.h5", "given twice"), ("copy.h5", "hold the same run"), ("link.h5", "given twice")):
            done = self.jostle("analyse", "a.h5", other, "sweep", "--observable", "mean_height", expect=BAD_INPUT)
            self.assertIn(says, done.stderr)
        for share in (1, 2, 3):
            self.run_sweep("a", [0.02, 0.1], "--shard", f"{share}/3", "-o", f"share{share}.h5")
        self.refused("share1.h5", "share2.h5", says="realizations of one ensemble: join the files with jostle merge")
        self.jostle("merge", "share1.h5", "share2.h5", "share3.h5", "-o", "merged.h5")
        self.refused("merged.h5", "share1.h5", says="merged.h5, sweep point 0, and share1.h5, .*the same 1 realization")
        self.refused("merged.h5", "a.h5", says="the same 3 realizations")

    def test_packings_of_extended_xyz_count_once(self):
        self.write(changed(TINY, start={"crystal": {"lattice": "hcp", "stretch": True}}, realizations=2))
        self.run_scene()
        for r in (0, 1):
            self.jostle("export", "tiny.h5", "--format", "extxyz", "--realization", r, "--tap", "all", "-o", f"r{r}.xyz")
        asked = ["--part", "coordination"]
        self.jostle("structure", "r0.xyz", "r1.xyz", *asked)  # scenes that start from one crystal
        lines = (self.folder / "r0.xyz").read_text().splitlines()
        n = len(lines) // 2
        turned = "\n".join(lines[n:n + 2] + lines[:n + 1:-1][:n - 2]) + "\n"
        self.write(turned, "turned.xyz")
        self.write("\n".join(lines[n:]) + "\n", "last.xyz")
        for one, other in (("last.xyz", "turned.xyz"), ("turned.xyz", "last.xyz")):
            done = self.jostle("structure", one, other, *asked, expect=BAD_INPUT)
            self.assertIn(f"{other}: the same packings as in {one}", done.stderr)
        self.write("\n".join(lines + lines[n:]) + "\n", "longer.xyz")
        done = self.jostle("structure", "r0.xyz", "longer.xyz", *asked, expect=BAD_INPUT)
        self.assertIn("longer.xyz: the same packings as in r0.xyz", done.stderr)


if __name__ == "__main__":
    unittest.main()
