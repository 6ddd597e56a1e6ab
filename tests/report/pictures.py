"""The pictures of the README, docs/pictures/: a page of jostle report and a packing on it, of a run of
config/scenes/quickstart.json, in headless Chromium. ./dev pictures makes them."""

import io
import os
import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

from browser import Browser

MOST_BYTES = 150_000
SOURCE = pathlib.Path(os.environ["SOURCE"])
JOSTLE = os.environ["JOSTLE"]


def keep(png, name):
    """With 128 colours, as a picture of lines and spheres needs no more."""
    image = Image.open(io.BytesIO(png)).convert("RGB").quantize(128)
    path = SOURCE / "docs/pictures" / name
    path.parent.mkdir(exist_ok=True)
    image.save(path, optimize=True)
    size = path.stat().st_size
    print(f"{path.relative_to(SOURCE)}: {image.width} x {image.height}, {size / 1000:.0f} kB")
    if size > MOST_BYTES:
        sys.exit(f"{path}: more than {MOST_BYTES // 1000} kB")


def main():
    with tempfile.TemporaryDirectory(prefix="jostle-pictures-") as name:
        folder = pathlib.Path(name)
        for arguments in (["run", SOURCE / "config/scenes/quickstart.json", "--no-progress", "--quiet"],
                          ["fit", "quickstart.h5", "--observable", "bottom_fraction"],
                          ["report", "quickstart.h5"]):
            subprocess.run([JOSTLE, *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        browser = Browser(folder)
        try:
            browser.resize(1100)
            browser.open(folder / "quickstart.html")
            browser.draw_everything()
            browser.run("arguments[0].scrollIntoView({block: 'start', behavior: 'instant'})",
                        browser.find("#file-0-compaction"))
            browser.frames()
            keep(browser.driver.get_screenshot_as_png(), "page.png")
            stage = browser.show(browser.find(".packing-panel .stage"))
            browser.frames()
            keep(browser.picture(stage), "packing.png")
        finally:
            browser.quit()


if __name__ == "__main__":
    main()
