"""Results that are analysed, and the tables that are made of them."""

import json

import h5py

from support import OK, TINY, Case, changed

TAPPED = changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 160}])


class Analysed(Case):
    def analyse(self, *arguments, expect=OK):
        return json.loads(self.jostle("analyse", *arguments, "--json", expect=expect).stdout)

    def tables(self, file="tiny.h5"):
        return self.info(file)["tables"]

    def series(self, column, point=0, file="tiny.h5"):
        with h5py.File(self.folder / file) as stored:
            return stored[f"/observables/point_{point:04}/{column}"][:]
