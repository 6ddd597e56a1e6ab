"""Pages of jostle report in one headless Chromium, which all test modules share."""

import atexit
import json
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))

from browser import WIDE, Browser  # noqa: E402
from pages import make_pages  # noqa: E402
from support import Case  # noqa: E402


def start():
    """The folder with a page of each kind, and the browser."""
    case = Case()
    case.setUp()
    atexit.register(case.doCleanups)
    downloads = tempfile.TemporaryDirectory(prefix="jostle-downloads-")
    atexit.register(downloads.cleanup)
    browser = Browser(downloads.name)
    atexit.register(browser.quit)
    make_pages(case)
    return case.folder, browser


FOLDER, BROWSER = start()


class Open(unittest.TestCase):
    """A page that is open; whatever a test does, the console stays silent."""

    name = "whole"

    def setUp(self):
        self.browser = BROWSER
        BROWSER.resize(WIDE)
        BROWSER.prefer("light")
        BROWSER.messages()
        BROWSER.open(FOLDER / f"{self.name}.html")
        self.addCleanup(self.assert_silent)

    def assert_silent(self):
        self.assertEqual(BROWSER.messages(), [])

    def sections(self):
        return [one.get_attribute("data-section") for one in BROWSER.find_all("section")]

    def data(self):
        return json.loads(BROWSER.run("return document.getElementById('report-data').textContent"))
