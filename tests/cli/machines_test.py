"""Equal bytes on every machine: with each instruction set of this one, and with the
variants of the C library's functions that it would choose here switched off."""

import pathlib
import platform
import unittest

from support import BAD_INPUT, PORTABLE, TINY, Case, changed

NEEDS = {"baseline": set(), "avx2": {"avx2"},
         "avx512": {"avx512f", "avx512dq", "avx512vl", "avx512bw"}}
HWCAPS = ["AVX512F", "AVX2_Usable", "AVX2", "FMA_Usable", "FMA", "FMA4", "AVX_Usable", "AVX",
          "ERMS", "SSE4_2", "SSSE3"]

METROPOLIS = {"max_step": 0.3, "beta": 3.0}
SCENES = {
    "polar between walls": changed(TINY, container={"sides": "walls", "width": 5}),
    "exponential polar in a tube": changed(
        TINY, container={"sides": "cylinder", "diameter": 5},
        relax={"polar": {"theta0": 0.5, "law": "exponential"}, "stop": {"sweeps": 100}}),
    "Metropolis at zero temperature": changed(
        TINY, start={"random_settle": {}},
        relax={"metropolis": {"max_step": 0.1},
               "stop": {"mean_height": {"eta": 1e-4, "every_sweeps": 20}}}),
    "polar, skipping": changed(
        TINY, relax={"polar": {}, "stop": {"mean_height": {"eta": 1e-6, "every_sweeps": 100}},
                     "sampler": "skipping"}),
    "Metropolis at zero temperature between walls, skipping": changed(
        TINY, container={"sides": "walls", "width": 5},
        relax={"metropolis": {"max_step": 0.2, "adapt": {}}, "stop": {"sweeps": 1000},
               "sampler": "skipping"}),
    "Metropolis at finite beta": changed(
        TINY, relax={"metropolis": METROPOLIS, "stop": {"sweeps": 100}}),
}


def instruction_sets():
    """Those of this machine that the program has kernels for."""
    if PORTABLE or platform.machine() != "x86_64":
        return ["baseline"]
    flags = set(pathlib.Path("/proc/cpuinfo").read_text().split())
    return [name for name, needed in NEEDS.items() if needed <= flags]


class Machines(Case):
    def digest_with(self, environment):
        self.run_scene("--force", "-o", "out.h5", environment=environment)
        return self.digest("out.h5")

    def test_every_instruction_set_and_c_library_variant_gives_the_same_digest(self):
        without_variants = {"GLIBC_TUNABLES":
                            "glibc.cpu.hwcaps=" + ",".join(f"-{name}" for name in HWCAPS)}
        seen = set()
        for title, scene in SCENES.items():
            with self.subTest(scene=title):
                self.write(scene)
                digests = {self.digest_with({}), self.digest_with(without_variants)}
                for name in instruction_sets():
                    own = {"JOSTLE_INSTRUCTION_SET": name}
                    digests |= {self.digest_with(own), self.digest_with({**own, **without_variants})}
                self.assertEqual(len(digests), 1)
                seen |= digests
        self.assertEqual(len(seen), len(SCENES))

    def test_an_unknown_instruction_set_is_an_error(self):
        self.write(TINY)
        result = self.run_scene(environment={"JOSTLE_INSTRUCTION_SET": "mmx"}, expect=BAD_INPUT)
        self.assertIn("use one of " + ", ".join(instruction_sets()), result.stderr)


if __name__ == "__main__":
    unittest.main()
