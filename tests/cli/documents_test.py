"""Rules of the documents: one version everywhere, an index of every page, links with existing targets."""

import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(os.environ["SOURCE"])
BUILD = pathlib.Path(os.environ["BUILD"])
PAGES = [SOURCE / "README.md", SOURCE / "CONTRIBUTING.md", *sorted((SOURCE / "docs").rglob("*.md"))]


def anchors(text):
    """Valid anchors: headings in GitHub's form."""
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", one.lower()).replace(" ", "-") for one in headings}


class Documents(unittest.TestCase):
    def test_everything_has_the_version_of_the_citation(self):
        said = subprocess.run([os.environ["JOSTLE"], "--version"], capture_output=True, text=True).stdout
        version = re.match(r"jostle (\d+\.\d+\.\d+) ", said).group(1)
        for file, pattern in (("CITATION.cff", r"(?m)^version: (.*)$"),
                              ("CHANGELOG.md", r"(?m)^## \[(\d.*?)\]")):
            self.assertEqual(re.search(pattern, (SOURCE / file).read_text()).group(1), version, file)
        python = subprocess.run([sys.executable, "-c", "import jostle; print(jostle.__version__)"], text=True,
                                capture_output=True, env={**os.environ, "PYTHONPATH": str(SOURCE / "python")})
        self.assertEqual(python.stdout.strip(), version, python.stderr)
        manual = BUILD / "manual/man1/jostle.1"
        if manual.exists():
            self.assertIn(version, manual.read_text().splitlines()[0])

    def test_a_version_has_one_section_of_the_changelog(self):
        versions = re.findall(r"(?m)^## \[(.*?)\]", (SOURCE / "CHANGELOG.md").read_text())
        self.assertEqual(len(versions), len(set(versions)), versions)
        self.assertEqual([one for one in versions if not re.fullmatch(r"\d+\.\d+\.\d+", one)], [])

    def test_no_address_is_a_placeholder(self):
        placeholder = re.compile(rb"@example\.(org|com|net)\b")
        files = [path for path in (*SOURCE.glob("*"), *SOURCE.glob("cmake/*"), *SOURCE.glob("packages/**/*"),
                                   *SOURCE.glob("python/**/*.py"), *PAGES) if path.is_file()]
        self.assertGreater(len(files), 60)
        self.assertEqual([path for path in files if placeholder.search(path.read_bytes())], [])

    def test_the_index_names_every_page(self):
        # validation.md is the index of the pages of single figures.
        index = "".join((SOURCE / "docs" / page).read_text() for page in ("README.md", "validation.md"))
        docs = SOURCE / "docs"
        pages = {str(path.relative_to(docs)) for path in docs.rglob("*.md") if path.parent.name != "decisions"}
        pages = pages - {"README.md"} | {"developers/decisions/README.md"}
        self.assertGreater(len(pages), 15)
        self.assertEqual([page for page in sorted(pages) if f"]({page})" not in index], [])

    def test_the_scene_reference_is_what_the_schema_makes(self):
        schema = subprocess.run([os.environ["JOSTLE"], "schema"], capture_output=True, check=True).stdout
        made = subprocess.run([sys.executable, SOURCE / "config/scene_reference.py", "--check"],
                              input=schema.decode(), capture_output=True, text=True)
        self.assertEqual((made.returncode, made.stderr), (0, ""))

    def test_the_scene_reference_has_every_key_of_the_schema(self):
        def keys(schema):
            if isinstance(schema, list):
                return {key for part in schema for key in keys(part)}
            if not isinstance(schema, dict):
                return set()
            return set(schema.get("properties", {})) | {key for part in schema.values() for key in keys(part)}

        schema = subprocess.run([os.environ["JOSTLE"], "schema"], capture_output=True, check=True).stdout
        rows = re.findall(r"(?m)^\| `([^`]*)` \|", (SOURCE / "docs/reference/scene-keys.md").read_text())
        named = {row.split("/")[-1].removesuffix("[]") for row in rows}
        self.assertEqual(sorted(keys(json.loads(schema)) - named), [])

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
