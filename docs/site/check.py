"""Checks a static site: every internal link and anchor exists, and no page loads anything from a network."""

import html.parser
import os
import pathlib
import re
import sys
import urllib.parse

# Attributes whose target a browser loads without a click.
LOADED = {("img", "src"), ("img", "srcset"), ("script", "src"), ("link", "href"), ("iframe", "src"), ("source", "src"),
          ("video", "src"), ("object", "data"), ("image", "href"), ("image", "xlink:href"), ("use", "href"),
          ("use", "xlink:href")}
REMOTE = re.compile(r"(?:https?:)?//")


class Page(html.parser.HTMLParser):
    """Anchors, links and loaded resources of a page."""

    def __init__(self, text: str):
        super().__init__()
        self.anchors: list[str] = []
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        for name, value in attributes:
            if name == "id" and value:
                self.anchors.append(value)
            elif (tag, name) in LOADED:
                self.loaded.append(value or "")
            elif name == "href" and tag == "a":
                self.links.append(value or "")


def faults(folder: pathlib.Path) -> list[str]:
    pages = {file: Page(file.read_text()) for file in sorted(folder.rglob("*.html"))}
    found = [] if pages else [f"{folder}: no pages"]
    for file, page in pages.items():
        name = file.relative_to(folder)
        found += [f"{name}: the anchor #{one} is not unique" for one in sorted(set(page.anchors))
                  if page.anchors.count(one) > 1]
        found += [f"{name}: loads {one} from a network" for one in page.loaded if REMOTE.match(one)]
        for target in page.links + page.loaded:
            if not re.match(r"\w[\w+.-]*:|//", target) and not leads_somewhere(file, target, pages):
                found.append(f"{name}: {target or 'an empty link'} does not exist")
    for file in sorted(folder.rglob("*")):
        if file.suffix in (".css", ".js", ".svg") and file.name != "search-index.js":
            text = file.read_text()
            found += [f"{file.relative_to(folder)}: loads {one} from a network" for one in loaded_by(text)]
            found += [f"{file.relative_to(folder)}: {one} does not exist" for one in re.findall(r"url\((\w[^):]*)\)", text)
                      if not (file.parent / one).is_file()]
    return found


def leads_somewhere(file: pathlib.Path, target: str, pages: dict[pathlib.Path, Page]) -> bool:
    name, _, anchor = target.partition("#")
    there = pathlib.Path(os.path.normpath(file.parent / urllib.parse.unquote(name))) if name else file
    if not target or not there.is_file():
        return False
    return not anchor or (there in pages and urllib.parse.unquote(anchor) in pages[there].anchors)


def loaded_by(text: str) -> list[str]:
    """Returns remote addresses that a style sheet, script or drawing loads; namespaces are only names."""
    return re.findall(r"""(?:url\(|@import|fetch\(|import\(|src=|href=)\s*["']?((?:https?:)?//[^"')\s]+)""", text)


if __name__ == "__main__":
    wrong = faults(pathlib.Path(sys.argv[1]))
    print("\n".join(wrong))
    sys.exit(1 if wrong else 0)
