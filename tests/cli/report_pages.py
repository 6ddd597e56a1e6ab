"""Pages of jostle report, read without a browser."""

import html.parser
import json

import numpy

from support import TINY, Case, changed

EVERYTHING = changed(
    TINY, name="everything", description="A bed of 48 spheres.", realizations=3, streams="matched",
    protocol=[{"tap": {"dilate": 0.05}, "count": 60}], snapshots={"taps": [0, 7, 60]},
    sweep={"/protocol/0/tap/dilate": [0.02, 0.05, 0.1]},
    fits=[{"observable": "bottom_fraction", "model": "all"}],
    analyse={"steady": [{"observable": "mean_height", "last": 40}],
             "spectrum": [{"observable": "mean_height", "last": 40}],
             "ageing": [{"observable": "mean_height"}],
             "sweep": [{"observable": "mean_height"}]},
    structure={"region": {"heights": [0.5, 2]}, "profile": {}, "pair_correlation": {}, "order": {},
               "voronoi": {"cut_cells": True}, "layers": {}})

HOSTILE = ('</script><script>document.title="x"</script><img src=x onerror=alert(1)>'
           '<!--\u2028\u2029\u202e&amp;{{7*7}}"\'`')


class Elements(html.parser.HTMLParser):
    """The elements of a page with their attributes, and the text of its scripts."""

    def __init__(self, page):
        super().__init__()
        self.elements, self.scripts, self.inside = [], [], False
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        self.inside = tag == "script"
        if self.inside:
            self.scripts.append("")

    def handle_endtag(self, tag):
        self.inside = False

    def handle_data(self, data):
        if self.inside:
            self.scripts[-1] += data


def number(value):
    return {None: numpy.nan, "inf": numpy.inf, "-inf": -numpy.inf}.get(value, value)


def panel_of(run, name):
    """The first panel of a figure of the page."""
    (figure,) = [one for one in run["figures"] if one["name"] == name]
    return figure["panels"][0]


class Report(Case):
    def page(self, *inputs, output="page.html", **keywords):
        done = self.jostle("report", *inputs, "-o", output, "--force", **keywords)
        return (self.folder / output).read_text(), done

    def data(self, page):
        scripts = Elements(page).scripts
        self.assertEqual(len(scripts), 2)
        return json.loads(scripts[0])
