"""The gallery: pictures, each with the scene and the command that made it."""

import html
import json
import pathlib
import re

PATH = "docs/gallery.md"


def body(source: pathlib.Path) -> str:
    return "\n".join((
        "<h1>Gallery</h1>",
        "<p>Each picture links to the page that explains it. Below it are the scene and the command that made it.</p>",
        '<h2 id="published-figures">Published figures</h2>',
        "<p>Black circles are numbers that the papers print.</p>",
        cards(validation_cards(source / "docs/validation")),
        '<h2 id="the-program">The program</h2>', cards(program_cards()),
        '<h2 id="example-scenes">Example scenes</h2>', scene_list(source / "config/scenes")))


def cards(entries: list[str]) -> str:
    return '<div class="gallery">' + "\n".join(entries) + "</div>"


def card(picture: str, page: str, title: str, scene: str, commands: list[str]) -> str:
    """One picture; paths are relative to docs/."""
    name = scene.removesuffix(".json").removeprefix("../config/scenes/")
    lines = "".join(f"<code>{html.escape(one)}</code>" for one in commands)
    return (f'<figure><a href="{page}"><img src="{picture}" alt="{html.escape(title)}" loading="lazy"></a>'
            f"<figcaption><b>{html.escape(title)}</b><span>Scene: <a href=\"{scene}\">{name}</a></span>"
            f"{lines}</figcaption></figure>")


def validation_cards(folder: pathlib.Path) -> list[str]:
    """A card for every page of a figure, in the order of the index: title, picture, scene and commands of the page."""
    index = folder.with_suffix(".md").read_text()
    entries = []
    for name in dict.fromkeys(re.findall(r"\]\(validation/([\w-]+\.md)\)", index)):
        page = folder / name
        text = page.read_text()
        title = re.search(r"(?m)^# (.*)$", text)[1]
        picture = re.search(r"\]\((\w[\w-]*\.svg)\)", text)[1]
        scene = re.search(r"\]\(\.\./\.\./(config/scenes/[^)]*\.json)\)", text)[1]
        commands = re.findall(r"`(\./dev physics [^`]*)`", text)
        entries.append(card(f"validation/{picture}", f"validation/{page.name}", title, f"../{scene}", commands))
    return entries


def program_cards() -> list[str]:
    return [card("pictures/page.png", "reference/report.md", "A page of jostle report",
                 "../config/scenes/quickstart.json",
                 ["jostle run config/scenes/quickstart.json", "jostle report quickstart.h5"]),
            card("pictures/packing.png", "reference/report.md", "A packing, in the page of jostle report",
                 "../config/scenes/quickstart.json",
                 ["jostle run config/scenes/quickstart.json", "jostle report quickstart.h5"])]


def scene_list(folder: pathlib.Path) -> str:
    rows = []
    for file in sorted(folder.rglob("*.json")):
        name = file.relative_to(folder).as_posix()
        text = json.loads(file.read_text()).get("description", "")
        text = " ".join(text) if isinstance(text, list) else text
        rows.append(f'<tr><td><a href="../config/scenes/{name}">{name.removesuffix(".json")}</a></td>'
                    f"<td>{html.escape(text)}</td></tr>")
    return ("<table><thead><tr><th>scene</th><th>description</th></tr></thead><tbody>" + "".join(rows)
            + "</tbody></table>")
