"""The static site: its check finds broken links and remote resources; its menu, gallery and API are complete."""

import ast
import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "docs/site"))

import build  # noqa: E402
import check  # noqa: E402
import gallery  # noqa: E402
import menu  # noqa: E402
import python_api  # noqa: E402


class Check(unittest.TestCase):
    def faults(self, page, **files):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "index.html").write_text(page)
            (folder / "other.html").write_text('<h1 id="there">There</h1>')
            for file, text in files.items():
                (folder / file.replace("_", ".")).write_text(text)
            return check.faults(folder)

    def test_correct_links_pass(self):
        self.assertEqual(self.faults('<h1 id="a">A</h1><a href="#a">1</a><a href="other.html#there">2</a>'
                                     '<a href="https://doi.org/10.1103">3</a><link rel="stylesheet" href="style.css">',
                                     style_css="p { color: black; }"), [])

    def test_each_fault_is_found(self):
        for page, fault in (
                ('<a href="missing.html">', "missing.html does not exist"),
                ('<a href="other.html#nowhere">', "other.html#nowhere does not exist"),
                ('<a href="#nowhere">', "#nowhere does not exist"),
                ('<img src="missing.svg">', "missing.svg does not exist"),
                ('<p id="a"><p id="a">', "#a is not unique"),
                ('<script src="https://cdn.org/x.js">', "loads https://cdn.org/x.js from a network"),
                ('<link rel="stylesheet" href="//fonts.org/x.css">', "loads //fonts.org/x.css from a network"),
                ('<img src="http://pictures.org/x.png">', "loads http://pictures.org/x.png from a network")):
            with self.subTest(page=page):
                found = self.faults(page)
                self.assertEqual(len(found), 1, found)
                self.assertIn(fault, found[0])

    def test_style_sheets_and_scripts_are_read(self):
        self.assertIn("from a network", self.faults("", style_css="@import 'https://a.org/b.css';")[0])
        self.assertIn("from a network", self.faults("", style_css="p { background: url(https://a.org/b.png); }")[0])
        self.assertIn("does not exist", self.faults("", style_css="@font-face { src: url(missing.ttf); }")[0])
        self.assertIn("from a network", self.faults("", code_js='fetch("https://a.org/b.json")')[0])


class Contents(unittest.TestCase):
    def test_the_menu_has_every_page_of_the_index(self):
        index = SOURCE / "docs/README.md"
        pages = {path for pages in menu.read_menu(index).groups.values() for _, path in pages}
        linked = {os.path.normpath(f"docs/{one}") for one in re.findall(r"\]\(([^)]*\.md)\)", index.read_text())}
        self.assertGreater(len(linked), 35)
        self.assertEqual(sorted(linked - pages), [])

    def test_the_gallery_has_every_figure_with_scene_and_command(self):
        text = gallery.body(SOURCE)
        pictures = sorted(one.name for one in (SOURCE / "docs/validation").glob("*.svg") if one.stem != "overview")
        self.assertGreater(len(pictures), 20)
        self.assertEqual([one for one in pictures if f"validation/{one}" not in text], [])
        for figure in re.findall(r"<figure>.*?</figure>", text, re.S):
            scene = re.search(r'href="\.\./(config/scenes/[^"]*\.json)"', figure)
            self.assertTrue(scene and (SOURCE / scene[1]).is_file(), figure)
            self.assertRegex(figure, r"<code>(?:jostle|\./dev)", figure)

    def test_the_api_has_every_public_name_with_its_docstring(self):
        text = python_api.body(SOURCE / "python/jostle")
        for module, folder in (("jostle", ""), ("jostle.plot", "plot")):
            init = ast.parse((SOURCE / "python/jostle" / folder / "__init__.py").read_text())
            names = set(python_api.public_names(init)) - {"plot"}
            self.assertGreater(len(names), 10)
            for name in sorted(names):
                part = re.search(rf'<h3 id="{re.escape(module)}\.{name}">.*?(?=<h[23]|\Z)', text, re.S)
                self.assertTrue(part, f"{module}.{name} is missing")
                self.assertRegex(part.group(), r"</pre>\s*<p>", f"{module}.{name} has no docstring")


@unittest.skipUnless(shutil.which("pandoc"), "pandoc is not installed (./dev site installs it)")
class Pages(unittest.TestCase):
    def test_a_page_keeps_equations_links_and_sections(self):
        with tempfile.TemporaryDirectory() as name:
            site = build.Site(pathlib.Path(name), menu.read_menu(SOURCE / "docs/README.md"))
            path = "docs/explanation/models.md"
            site.write(path, build.markdown_body(path))
            page = (site.folder / "docs/explanation/models.html").read_text()
        self.assertIn('<math display="block"', page)
        self.assertNotIn("$", re.sub(r"<annotation.*?</annotation>", "", page, flags=re.S))
        self.assertIn('href="accuracy.html"', page)
        self.assertIn('aria-current="page">Models', page)
        self.assertIn(["Models", "A tap", "docs/explanation/models.html#a-tap"], [one[:3] for one in site.sections])
        self.assertIn("docs/explanation/accuracy.md", site.waiting)


if __name__ == "__main__":
    unittest.main()
