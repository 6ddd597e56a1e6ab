"""The menu of the site: the sections and links of docs/README.md."""

from __future__ import annotations

import dataclasses
import html
import os
import pathlib
import re
from collections.abc import Callable

import gallery
import python_api

FIRST = (("Overview", "README.md"), ("All pages", "docs/README.md"), ("Gallery", gallery.PATH))


@dataclasses.dataclass(frozen=True)
class Menu:
    """groups: title -> (label, path from the repository's root) of each page."""

    groups: dict[str, list[tuple[str, str]]]

    def as_html(self, current: str, sections: list[tuple[str, str, str]], link: Callable[[str], str]) -> str:
        """The menu for one page, which is marked and shows its own sections."""
        parts = []
        for title, pages in self.groups.items():
            is_open = " open" if title != "Developers" or any(path == current for _, path in pages) else ""
            items = "".join(self._item(label, path, current, sections, link) for label, path in pages)
            parts.append(f"<details{is_open}><summary>{html.escape(title)}</summary><ul>{items}</ul></details>")
        return "\n".join(parts)

    def _item(self, label: str, path: str, current: str, sections: list[tuple[str, str, str]],
              link: Callable[[str], str]) -> str:
        if path != current:
            return f'<li><a href="{link(path)}">{html.escape(label)}</a></li>'
        inner = "".join(f'<li><a href="#{anchor}">{html.escape(heading)}</a></li>'
                        for heading, anchor, _ in sections[1:] if anchor)
        return (f'<li><a href="{link(path)}" aria-current="page">{html.escape(label)}</a>'
                + (f"<ul>{inner}</ul>" if inner else "") + "</li>")


def read_menu(index: pathlib.Path) -> Menu:
    """Reads the index: every heading of level 2 is a group, every link of a table's first column a page.

    The label of a page is its title.
    """
    groups: dict[str, list[tuple[str, str]]] = {"jostle": list(FIRST)}
    group = ""
    for line in index.read_text().splitlines():
        if line.startswith("## "):
            group = line[3:]
            groups[group] = []
        elif line.startswith("| ["):
            for target in re.findall(r"\]\(([^)]*\.md)\)", line.split(" | ")[0]):
                title = (index.parent / target).read_text().partition("\n")[0].removeprefix("# ")
                groups[group].append((title, os.path.normpath(os.path.join("docs", target))))
    groups["Reference"].append(("Python API", python_api.PATH))
    return Menu(groups)
