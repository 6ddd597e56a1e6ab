"""Results of jostle, ensembles of tapped granular packings, in Python; and the program from Python.

    import jostle

    results = jostle.open("quickstart.h5")
    results.ensemble["bottom_fraction_mean"]       # xarray, the whole sweep
    results.positions(point=0, realization=0)      # [sphere, 3], diameters
    jostle.plot.compaction(results, "bottom_fraction")

    scene = {"seed": 1, "container": {"sides": "periodic", "width": 8}, "spheres": 512,
             "protocol": [{"tap": {"dilate": 0.02}, "count": 100}]}
    results = jostle.run(scene, "mine.h5")

It needs numpy and h5py; xarray, pandas, matplotlib and jsonschema for what is named after them.
"""

from .commands import (RealizationsFailed, RunStopped, UnfinishedRun, analyse, cost, export, fit, report, run,
                       structure)
from .contacts import Contacts
from .errors import (BadArgument, Fault, JostleError, NoSuchPoint, NotThere, ProgramError, ProgramMissing,
                     ResultsError, SceneError, WrongType)
from .fits import Choice, Fit, FittedCurve, HeldOut, Parameter
from .point import Box, Point
from .program import program_path
from .results import Results, open
from .scenes import Checked, check, schema
from .student import half_width
from .tables import Quantity, Table, Tables

__all__ = ["BadArgument", "Box", "Checked", "Choice", "Contacts", "Fault", "Fit", "FittedCurve", "HeldOut", "JostleError",
           "NoSuchPoint", "NotThere", "Parameter", "Point", "ProgramError", "ProgramMissing", "Quantity",
           "RealizationsFailed", "Results", "ResultsError", "RunStopped", "SceneError", "Table",
           "Tables", "UnfinishedRun", "WrongType", "analyse", "check", "cost", "export", "fit",
           "half_width", "open", "plot", "program_path", "report", "run", "schema", "structure"]


def __getattr__(name: str) -> object:
    """Imports jostle.plot, which needs matplotlib, and determines the version, when they are used."""
    if name == "plot":
        import importlib
        return importlib.import_module(".plot", __name__)
    if name == "__version__":
        from .installed import version
        return version()
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
