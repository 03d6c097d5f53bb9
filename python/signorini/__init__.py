"""Contact mechanics: problems made of nouns, runs, results as arrays.

>>> import signorini as sg
>>> result = sg.run(sg.gallery("string"), pictures=False)
>>> result.contacts["touch"].zones
1
"""

from __future__ import annotations

from ._base import Samples, Value
from ._draw import draw
from ._errors import CaseError, InternalError, MissingPackage, OutputError, SignoriniError
from ._meshes import from_meshio, from_pyvista
from ._native import __version__
from ._nouns import *  # noqa: F403
from ._nouns import __all__ as _names
from ._problem import Problem
from ._result import Contact as ContactResult
from ._result import Fields, Picture, Record, Result, State
from ._run import (
    Closest,
    Event,
    Fitted,
    check,
    closest_points,
    explain,
    fit,
    gallery,
    run,
    scene,
    set_threads,
    theorem,
    wind,
    wrap,
)
from ._sweep import Rows, sweep

__all__ = [
    *_names, "CaseError", "Closest", "ContactResult", "Event", "Fields", "Fitted", "InternalError", "MissingPackage",
    "OutputError", "Picture", "Problem", "Record", "Result", "Rows", "Samples", "SignoriniError", "State", "Value", "check",
    "closest_points", "draw", "explain", "fit", "from_meshio", "from_pyvista", "gallery", "run", "scene", "set_threads",
    "sweep", "theorem", "wind", "wrap", "__version__",
]
