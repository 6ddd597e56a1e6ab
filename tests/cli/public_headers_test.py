"""The public headers, sdk/jostle, reach no kernel, no file format and no library that users need not have."""

import os
import pathlib
import re
import unittest

SOURCE = pathlib.Path(os.environ["SOURCE"])


def public_headers():
    return sorted((SOURCE / "sdk/jostle").glob("*.hpp"))


def includes(header, quote):
    return re.findall(rf"^\s*#\s*include\s+{quote}([^\">]+)", header.read_text(), re.MULTILINE)


def internal_headers():
    """Headers included by the public headers, recursively: names from the root."""
    found, waiting = set(), public_headers()
    while waiting:
        names = set(includes(waiting.pop(), '"')) - found
        found |= names
        waiting += [SOURCE / name for name in names]
    return sorted(found)


class PublicHeaders(unittest.TestCase):
    def test_they_are_few_and_each_is_described(self):
        names = [header.name for header in public_headers()]
        self.assertLessEqual(len(names), 12)
        described = (SOURCE / "docs/reference/library.md").read_text()
        self.assertEqual([name for name in names if f"`<jostle/{name}>`" not in described], [])
        self.assertEqual([header.name for header in public_headers()
                          if not re.match(r"#pragma once\n\n// [A-Z]", header.read_text())], [])

    def test_they_reach_nothing_of_how_it_is_done(self):
        self.assertGreater(len(internal_headers()), 50)
        hidden = r"(engine/.*/(kernel|rejection_free)|results/(hdf5|checkpoints)|cli|bench|tests)/"
        self.assertEqual([h for h in internal_headers() if re.match(hidden, h)], [])
        shown = [f"{header} includes <{name}>" for header in internal_headers()
                 for name in includes(SOURCE / header, "<")
                 if re.match(r"hdf5|H5|openssl/|immintrin|tbb/|CLI/|spdlog/|fmt/", name)]
        self.assertEqual(shown, [])

    def test_each_header_is_guarded(self):
        self.assertEqual([h for h in internal_headers()
                          if "#pragma once" not in (SOURCE / h).read_text()], [])


if __name__ == "__main__":
    unittest.main()
