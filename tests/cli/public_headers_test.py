"""The list of public headers (cmake/PublicHeaders.cmake) is whole, and holds no internals."""

import os
import pathlib
import re
import unittest

SOURCE = pathlib.Path(os.environ["SOURCE"])


def public_headers():
    text = (SOURCE / "cmake/PublicHeaders.cmake").read_text()
    return re.search(r"set\(JOSTLE_PUBLIC_HEADERS\s+([^)]*)\)", text)[1].split()


def includes(header, quote):
    text = (SOURCE / header).read_text()
    return re.findall(rf"^\s*#\s*include\s+{quote}([^\">]+)", text, re.MULTILINE)


class PublicHeaders(unittest.TestCase):
    def test_they_exist_once_and_in_order(self):
        headers = public_headers()
        self.assertGreater(len(headers), 50)
        self.assertEqual(headers, sorted(set(headers)))
        self.assertEqual([h for h in headers if not (SOURCE / h).is_file()], [])

    def test_they_include_public_headers_alone(self):
        headers = set(public_headers())
        missing = {f"{name}, which {header} includes" for header in headers
                   for name in includes(header, '"') if name not in headers}
        self.assertEqual(sorted(missing), [])

    def test_they_say_nothing_of_how_it_is_done(self):
        internal = r"(engine/.*/(kernel|rejection_free)|results/(hdf5|checkpoints)|cli|bench|tests)/"
        self.assertEqual([h for h in public_headers() if re.match(internal, h)], [])
        shown = [f"{header} includes <{name}>" for header in public_headers()
                 for name in includes(header, "<")
                 if re.match(r"hdf5|H5|openssl/|immintrin|tbb/|CLI/|spdlog/|fmt/", name)]
        self.assertEqual(shown, [])

    def test_each_is_guarded(self):
        self.assertEqual([h for h in public_headers()
                          if "#pragma once" not in (SOURCE / h).read_text()], [])


if __name__ == "__main__":
    unittest.main()
