"""What the documents must keep to: one version everywhere, an index of every page, links that lead somewhere."""

import os
import pathlib
import re
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(os.environ["SOURCE"])
PAGES = [SOURCE / "README.md", SOURCE / "CONTRIBUTING.md", *sorted((SOURCE / "docs").rglob("*.md"))]


def anchors(text):
    """What a #... may name: headings as GitHub writes them."""
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", one.lower()).replace(" ", "-") for one in headings}


class Documents(unittest.TestCase):
    def test_one_version_stands_everywhere(self):
        said = subprocess.run([os.environ["JOSTLE"], "--version"], capture_output=True, text=True).stdout
        version = re.match(r"jostle (\d+\.\d+\.\d+) ", said).group(1)
        for file, pattern in (("CMakeLists.txt", r"project\(jostle VERSION (\S+)"),
                              ("python/jostle/__init__.py", r'__version__ = "(.*)"'),
                              ("CITATION.cff", r"(?m)^version: (.*)$"),
                              ("CHANGELOG.md", r"(?m)^## \[(\d.*?)\]")):
            self.assertEqual(re.search(pattern, (SOURCE / file).read_text()).group(1), version, file)

    def test_the_index_names_every_page(self):
        index = (SOURCE / "docs/README.md").read_text()
        pages = {path.name for path in (SOURCE / "docs").glob("*.md")} - {"README.md"}
        self.assertGreater(len(pages), 15)
        self.assertEqual([page for page in sorted(pages) if f"]({page})" not in index], [])

    def test_the_scene_reference_is_what_the_schema_makes(self):
        made = subprocess.run([sys.executable, SOURCE / "config/scene_reference.py", "--check"],
                              capture_output=True, text=True)
        self.assertEqual((made.returncode, made.stderr), (0, ""))

    def test_links_lead_somewhere(self):
        wrong, n = [], 0
        for page in PAGES:
            for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
                if target.startswith("http"):
                    continue
                n += 1
                name, _, anchor = target.partition("#")
                there = (page.parent / name) if name else page
                if not there.exists() or (anchor and there.suffix == ".md" and
                                          anchor not in anchors(there.read_text())):
                    wrong.append(f"{page.relative_to(SOURCE)}: {target}")
        self.assertGreater(n, 80)
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    unittest.main()
