"""Builds the documentation as a static site: `python3 build.py FOLDER`.

Pages are the repository's Markdown files, converted by pandoc. Paths stay as they are in the repository, with .html
for .md and index.html for README.md, so that relative links keep their targets. Linked sources become pages that show
them. The gallery and the Python API are generated. The site loads nothing from a network.
"""

import concurrent.futures
import html
import json
import os
import pathlib
import re
import shutil
import string
import subprocess
import sys

import check
import gallery
import python_api
from menu import Menu, read_menu

SOURCE = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
PICTURES = (".svg", ".png")
TO_HTML = ("pandoc", "--from=gfm+tex_math_dollars", "--to=html", "--mathml", "--wrap=none", "--no-highlight")
# Debian's fonts-dejavu-extra. Without a font for mathematics browsers misplace subscripts and brackets.
MATH_FONT = pathlib.Path("/usr/share/fonts/truetype/dejavu/DejaVuMathTeXGyre.ttf")
PAGE = string.Template((HERE / "page.html").read_text())


def site_path(path: str) -> str:
    """Returns the site's file for a page or source of the repository."""
    folder, _, name = path.rpartition("/")
    if (SOURCE / path).is_dir() or name == "README.md":
        return "/".join(filter(None, (path.removesuffix("README.md").rstrip("/"), "index.html")))
    return path.removesuffix(".md") + ".html" if not name.endswith(PICTURES) else path


def relative(target: str, page: str) -> str:
    return os.path.relpath(target, os.path.dirname(page) or ".")


def normal_path(page: str, target: str) -> str:
    """Returns the repository's path of a link from a page or a folder's list."""
    folder = page if (SOURCE / page).is_dir() else os.path.dirname(page)
    path = os.path.normpath(os.path.join(folder, target))
    return "" if path == "." else path


class Site:
    """Pages still to be written, and files already requested."""

    def __init__(self, folder: pathlib.Path, menu: Menu):
        self.folder, self.menu = folder, menu
        self.known: set[str] = set()
        self.waiting: list[str] = []
        self.sections: list[list[str]] = []

    def request(self, path: str) -> None:
        if path not in self.known:
            self.known.add(path)
            self.waiting.append(path)

    def write(self, path: str, body: str) -> None:
        """Writes one page: menu, title and body; relative links of the body lead to the site's pages."""
        page = site_path(path)
        body = re.sub(r'(href|src)="([^"]*)"', lambda match: f'{match[1]}="{self.link(path, match[2])}"', body)
        body = re.sub(r'(<math display="block".*?</math>)', r'<span class="equation">\1</span>', body, flags=re.S)
        body = body.replace("<table>", '<div class="table"><table>').replace("</table>", "</table></div>")
        title, sections = contents(body)
        if path.endswith(".md"):
            self.sections += [[title, heading, f"{page}#{anchor}" if anchor else page, text]
                              for heading, anchor, text in sections]
        root = relative(".", page)
        text = PAGE.substitute(title=html.escape(title), root=root, body=body,
                               menu=self.menu.as_html(path, sections, lambda one: relative(site_path(one), page)))
        file = self.folder / page
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def link(self, path: str, target: str) -> str:
        if re.match(r"\w+:|#", target):
            return target
        name, mark, anchor = html.unescape(target).partition("#")
        there = normal_path(path, name)
        if there not in self.known and not (SOURCE / there).exists():
            return target  # the check reports it
        self.request(there)
        return html.escape(relative(site_path(there), site_path(path)) + mark + anchor)


def contents(body: str) -> tuple[str, list[tuple[str, str, str]]]:
    """Returns the title, and heading, anchor and text of each section."""
    body = re.sub(r"<annotation.*?</annotation>", "", body, flags=re.S)
    parts = re.split(r'<h([1-3])(?: id="([^"]*)")?>(.*?)</h\1>', body, flags=re.S)
    sections = [(plain(heading), anchor or "", plain(text))
                for anchor, heading, text in zip(parts[2::4], parts[3::4], parts[4::4], strict=True)]
    return sections[0][0] if sections else "jostle", sections


def plain(markup: str) -> str:
    return " ".join(html.unescape(re.sub(r"<[^>]*>", "", markup.replace("</td>", " ").replace("</th>", " "))).split())


def markdown_body(path: str) -> str:
    return subprocess.run([*TO_HTML, SOURCE / path], capture_output=True, text=True, check=True).stdout


def source_body(path: str) -> str:
    """A page that shows a source of the repository, or lists a folder."""
    place = SOURCE / path
    title = f"<h1>{html.escape(path)}</h1>\n"
    if place.is_dir():
        names = sorted(one.name for one in place.iterdir() if not one.name.startswith(("__", ".")))
        return title + "<ul>" + "".join(f'<li><a href="{one}">{one}</a></li>' for one in names) + "</ul>"
    command = f"<pre><code>jostle run {path}</code></pre>\n" if path.startswith("config/scenes/") else ""
    return f"{title}{command}<pre><code>{html.escape(place.read_text())}</code></pre>"


def write_pages(site: Site) -> None:
    """Writes all requested pages, then the pages that these link to, until nothing is left."""
    with concurrent.futures.ThreadPoolExecutor() as pool:
        while site.waiting:
            batch, site.waiting = site.waiting, []
            bodies = {path: pool.submit(markdown_body, path) for path in batch if path.endswith(".md")}
            for path in batch:
                if path.endswith(PICTURES):
                    (site.folder / path).parent.mkdir(parents=True, exist_ok=True)
                    shutil.copyfile(SOURCE / path, site.folder / path)
                else:
                    # The directory's page is its README where it has one.
                    if (SOURCE / path / "README.md").is_file():
                        site.request(os.path.join(path, "README.md"))
                        continue
                    site.write(path, bodies[path].result() if path in bodies else source_body(path))


def build(folder: pathlib.Path) -> Site:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    site = Site(folder, read_menu(SOURCE / "docs/README.md"))
    site.known |= {gallery.PATH, python_api.PATH}
    for path in ("README.md", *sorted(str(one.relative_to(SOURCE)) for one in (SOURCE / "docs").rglob("*.md"))):
        site.request(path)
    site.write(gallery.PATH, gallery.body(SOURCE))
    site.write(python_api.PATH, python_api.body(SOURCE / "python/jostle"))
    write_pages(site)
    for file in (HERE / "style.css", HERE / "search.js", *filter(pathlib.Path.is_file, (MATH_FONT,))):
        shutil.copyfile(file, folder / file.name)
    (folder / "search-index.js").write_text(
        "window.searchIndex = " + json.dumps(site.sections, ensure_ascii=False, separators=(",", ":")) + ";\n")
    return site


def main() -> int:
    folder = pathlib.Path(sys.argv[1])
    site = build(folder)
    faults = check.faults(folder)
    for fault in faults:
        print(f"site: {fault}", file=sys.stderr)
    size = sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())
    print(f"{folder}/index.html: {len(site.known)} pages and files, {size / 1e6:.1f} MB, {len(faults)} broken links")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
