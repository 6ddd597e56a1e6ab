"""Results of small scenes, bit by bit: what a change of the code must not change.

Between them the scenes use every container, start, tap, move, sampler, stop, observable and kind of
snapshot, and files come about in every way: straight, resumed, in shards, merged, grown. Their
digests are in tests/data/digests.json. A change that is to alter results writes them anew:

    JOSTLE=build/release/cli/jostle FAULT_SHIM=- SOURCE=. python3 tests/cli/digests_test.py --write
"""

import json
import sys
import unittest

from support import SOURCE, Case, changed

RECORDED = SOURCE / "tests/data/digests.json"
ALL_OBSERVABLES = [
    "mean_height", "bottom_fraction", {"corrected_fraction": {"depth": 0.8}}, "bulk_fraction",
    {"bulk_fraction": {"name": "low", "heights": [0.5, 2]}},
    {"bulk_fraction": {"name": "middle", "quantiles": [0.4, 0.6]}}]


def taps(tap, count=2):
    return {"tap": tap, "count": count}


def scene(**keys):
    return {"seed": 20010222, "realizations": 2, "spheres": 60,
            "container": {"sides": "periodic", "width": 3.5}, **keys}


SCENES = {
    "polar": scene(
        protocol=[taps({"dilate": 0.05}), taps({"dilate_floor_held": 0.1}), taps({"lift": 0.2})],
        relax={"polar": {}, "stop": {"mean_height": {"eta": 1e-3, "every_sweeps": 20}}},
        observe=ALL_OBSERVABLES, snapshots={"taps": [0, 3, 6]}),
    "polar_between_walls": scene(
        container={"sides": "walls", "width": [3.5, 4]}, start={"pour": "fitted"},
        protocol=[{"ramp": {"dilate": {"sqrt_from": 0.1, "sqrt_to": 0.3, "sqrt_step": 0.1}},
                   "count": 1}],
        relax={"polar": {"law": "exponential", "theta0": 0.5}, "sampler": "skipping",
               "stop": {"mean_height": {"change": 1e-3, "every_sweeps": 50}}},
        snapshots={"taps": [0, 3], "keep": ["height_histogram"], "bin_width": 0.2}),
    "fitted_and_relaxed": scene(
        container={"sides": "walls", "width": 3.5}, start={"pour": "fitted"},
        protocol=[taps({"dilate": 0.02})], relax={"polar": {}, "stop": {"sweeps": 50}},
        relax_start={"metropolis": {"max_step": 0.05}, "stop": {"sweeps": 40}},
        snapshots={"taps": [0, 2], "keep": ["positions"]}),
    "polar_in_cylinder": scene(
        container={"sides": "cylinder", "diameter": 4.5}, protocol=[taps({"dilate": 0.05}, 3)],
        relax={"polar": {"law": "linear", "max_step": 0.2}, "stop": {"sweeps": 100}},
        snapshots={"taps": [0, 3], "keep": ["coordination"], "contact_cut": 1.1}),
    "settled_in_cylinder": scene(
        container={"sides": "cylinder", "diameter": 4}, spheres=40,
        start={"random_settle": {"dilute_fraction": 0.1}},
        protocol=[{"ramp": {"lift": {"from": 0.1, "to": 0.3, "step": 0.1}}, "count": 1}],
        relax={"metropolis": {"beta": 5, "adapt": {"every_trials": 1000, "of": "not_upward",
                                                   "threshold": 0.4, "factor": 0.9}},
               "stop": {"sweeps": 300}}),
    "settled_between_walls": scene(
        container={"sides": "walls", "width": 3.5}, start={"random_settle": {}},
        protocol=[taps({"shake": {"lambda": 0.05, "lateral_radius": 0.2, "retries": 2}}, 3)],
        relax={"polar": {}, "sampler": "skipping", "stop": {"mean_height": {"eta": 1e-4}}},
        observe=ALL_OBSERVABLES),
    "metropolis": scene(
        start={"random_settle": {"dilute_fraction": 0.2}}, protocol=[taps({"lift": 0.25}, 3)],
        relax={"metropolis": {"adapt": {"every_trials": 2000, "reset_each_tap": False}},
               "stop": {"bulk_fraction": {"change": 0.01, "every_trials": 5000, "times": 2}}},
        observe=["bulk_fraction"], snapshots={"taps": [0, 1, 3]}),
    "metropolis_skipping": scene(
        protocol=[taps({"lift": 0.1}, 3)],
        relax={"metropolis": {"adapt": {}}, "sampler": "skipping", "max_sweeps": 1500,
               "stop": {"bulk_fraction": {"window": {"heights": [1, 3]}, "measure_start": False,
                                          "every_trials": 20000}}}),
    "between_plates": scene(
        container={"sides": "plates", "width": 4, "gap": 3.5}, protocol=[taps({"dilate": 0.05}, 3)],
        relax={"polar": {}, "sampler": "skipping", "stop": {"sweeps": 100}},
        snapshots={"taps": [0, 3]}),
    "crystals": scene(
        realizations=1, container={"sides": "periodic", "width": 4}, spheres=64,
        start={"crystal": {"lattice": "hcp", "stretch": True}},
        protocol=[taps({"shake": {}})], relax={"polar": {}, "stop": {"sweeps": 60}},
        observe=ALL_OBSERVABLES, snapshots={"taps": [0, 2]},
        sweep={"/start/crystal/lattice": ["hcp", "fcc"]}),
    "fluid": scene(
        container={"sides": "fully_periodic", "width": 5, "height": 5}, spheres=80,
        start={"grow": {}}, protocol=[taps({"dilate": 0}, 3)],
        relax={"metropolis": {"max_step": 0.15}, "stop": {"sweeps": 30}}, observe=[],
        snapshots={"taps": [0, 3], "keep": ["positions"]}),
    "matched_sweep": scene(
        streams="matched", protocol=[taps({"dilate": 0.05}, 3)],
        relax={"polar": {}, "stop": {"sweeps": 80}}, snapshots={"taps": [0, 3]},
        sweep={"/protocol/0/tap": [{"dilate": 0.02}, {"lift": 0.3}],
               "zip": {"/spheres": [40, 60], "/container/width": [3, 3.5]}}),
    "until": scene(
        protocol=[taps({"dilate": 0.1})], relax={"polar": {}, "stop": {"sweeps": 50}},
        observe=["mean_height"],
        until={"targets": [{"observable": "mean_height", "standard_error": 0.01}], "at_most": 12}),
}

KINDS = [{"name": "small", "count": 50, "diameter": {"lognormal": {"mean": 0.7, "deviation": 0.07}}},
         {"name": "large", "count": 6, "diameter": 1.5, "density": 2},
         {"name": "intruder", "count": 1, "diameter": 2.5, "place": [2, 2]}]
SCENES |= {
    "several_sizes": scene(
        container={"sides": "walls", "width": 4}, spheres=KINDS,
        protocol=[taps({"dilate": 0.05}), taps({"shake": {"lambda": 0.05, "lateral_radius": 0.1, "retries": 3}}, 1)],
        relax={"metropolis": {"beta": 9}, "stop": {"sweeps": 200}},
        observe=["mean_height", "segregation", {"lacey_index": {"cell": 2, "kind": "large"}}],
        snapshots={"taps": [0, 3]}),
    "several_sizes_skipped": scene(
        spheres=[{"name": "small", "count": 60}, {"name": "large", "count": 9, "diameter": {"uniform": {
            "from": 1.2, "to": 1.7}}}], container={"sides": "periodic", "width": 4}, pour_order="small_first",
        protocol=[taps({"dilate_floor_held": 0.1})],
        relax={"polar": {}, "sampler": "skipping", "stop": {"mean_height": {"eta": 1e-4, "every_sweeps": 50}}},
        observe=["mean_height", "segregation"], snapshots={"taps": [0, 2]}),
    "several_sizes_grown": scene(
        container={"sides": "fully_periodic", "width": 5, "height": 5}, start={"grow": {}},
        spheres=[{"name": "small", "count": 60}, {"name": "large", "count": 12, "diameter": 1.6}],
        protocol=[taps({"dilate": 0}, 1)], relax={"metropolis": {}, "stop": {"sweeps": 100}}, observe=[],
        snapshots={"taps": [0, 1], "keep": ["positions"]}),
}

SOFT = {"walton_braun": {"stiffness": 1e4, "friction": 0.3}}
DASHPOTS = {"linear_spring_dashpot": {"stiffness": 1e4, "restitution": 0.5}}
SCENES |= {
    "grains": scene(
        engine={"discrete_element": {"contact": SOFT, "rest": {"timed": {"seconds": 0.1}}}},
        protocol=[taps({"half_sine": {"amplitude": 0.4, "frequency": 7.5}}), taps({"lift": 0.3}, 1)],
        snapshots={"taps": [0, 3]}),
    "grains_in_cylinder": scene(
        container={"sides": "cylinder", "diameter": 4.5}, start={"random_settle": {}},
        engine={"discrete_element": {"contact": DASHPOTS, "rest": {"timed": {"seconds": 0.1}}}},
        protocol=[taps({"dilate": 0.1}, 1)], snapshots={"taps": [0, 1]}),
    "grains_of_several_sizes": scene(
        container={"sides": "walls", "width": 4},
        spheres=KINDS,
        engine={"discrete_element": {"contact": SOFT, "rest": {"timed": {"seconds": 0.1}}}},
        protocol=[taps({"half_sine": {"amplitude": 0.4, "frequency": 7.5}})],
        observe=["mean_height", {"kind_height": {"kind": "intruder"}}], snapshots={"taps": [0, 2]}),
    "dashpots_of_several_sizes": scene(
        spheres=[{"name": "small", "count": 40}, {"name": "large", "count": 8, "diameter": 1.5}],
        engine={"discrete_element": {"contact": DASHPOTS, "rest": {"timed": {"seconds": 0.1}}}},
        protocol=[taps({"lift": 0.3}, 1)], observe=["mean_height", "segregation"],
        snapshots={"taps": [0, 1]}),
}


class Digests(Case):
    def digest_of(self, text, name, *arguments):
        self.write(text, f"{name}.json")
        self.run_scene("-o", f"{name}.h5", *arguments, scene=f"{name}.json")
        return self.digest(f"{name}.h5")

    def digests(self):
        found = {name: self.digest_of(text, name) for name, text in SCENES.items()}
        return found | self.digests_of_files() | self.digests_of_other_ways()

    def digests_of_files(self):
        """Starts from snapshots: of a results file, of extended XYZ."""
        from_file = dict(protocol=[taps({"dilate": 0.05})],
                         relax={"polar": {}, "stop": {"sweeps": 40}})
        self.jostle("export", "polar.h5", "--format", "extxyz", "--realization", 1,
                    "--tap", "all", "-o", "polar.xyz")
        return {
            "from_results": self.digest_of(scene(
                start={"file": {"path": "polar.h5", "realization": 1, "tap": 3}}, **from_file),
                "from_results"),
            "from_xyz": self.digest_of(scene(start={"file": {"path": "polar.xyz", "frame": 1}},
                                             **from_file), "from_xyz"),
        }

    def digests_of_other_ways(self):
        sweep = SCENES["matched_sweep"]
        for index in (1, 2, 3):
            self.digest_of(sweep, f"shard{index}", "--shard", f"{index}/3")
        self.jostle("merge", *(f"shard{index}.h5" for index in (1, 2, 3)), "-o", "merged.h5")
        found = {"shard": self.digest("shard2.h5"), "merged": self.digest("merged.h5")}
        longer = changed(SCENES["polar"], realizations=3, protocol=SCENES["polar"]["protocol"] + [
            taps({"dilate": 0.01})])
        self.digest_of(SCENES["polar"], "resumed")
        found["resumed"] = self.digest_of(longer, "resumed", "--resume")
        crystals = changed(SCENES["crystals"], sweep={"/start/crystal/lattice": ["fcc"]})
        self.digest_of(crystals, "grown")
        found["grown"] = self.digest_of(SCENES["crystals"], "grown", "--resume")
        return found

    def test_the_digests_are_those_recorded(self):
        self.assertEqual(self.digests(), json.loads(RECORDED.read_text()))

    def test_merged_shards_are_one_run(self):
        recorded = json.loads(RECORDED.read_text())
        self.assertEqual(recorded["merged"], recorded["matched_sweep"])


def write():
    case = Digests()
    case.setUp()
    RECORDED.write_text(json.dumps(case.digests(), indent=2) + "\n")
    case.doCleanups()


if __name__ == "__main__":
    write() if "--write" in sys.argv else unittest.main()
