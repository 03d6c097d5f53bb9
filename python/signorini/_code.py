"""Problems as Python code."""

from __future__ import annotations

import inspect
from typing import Any, List, Mapping, Tuple

import numpy as np

from ._base import Noun, Samples, _left_out, _named
from ._errors import CaseError

#: Lines are broken beyond this length.
WIDTH = 100
#: Keys of a problem in the order of case files; others follow.
FIRST = ("title", "analysis", "units", "space", "constants", "functions", "bodies", "supports", "loads", "contacts", "steps")


def code(problem: Noun) -> str:
    """A program that states a problem, with the package as `sg`."""
    writer = _Writer()
    text = writer.of(problem, 0, len("problem = "), "")
    head = ["import numpy as np"] if writer.has_arrays else []
    return "\n".join([*head, "import signorini as sg", "", f"problem = {text}", ""])


class _Writer:
    def __init__(self) -> None:
        self.has_arrays = False

    def of(self, value: Any, indent: int, used: int, path: str) -> str:
        """A value as an expression. `used` is the width that the line has before it, and a comma after it."""
        plain = self.flat(value, path)
        if indent + used + len(plain) < WIDTH:
            return plain
        opening, entries, closing = self.parts(value, path)
        if not entries:
            return plain
        pad = " " * (indent + 4)
        lines = [
            f"{pad}{name}{self.of(entry, indent + 4, len(name), below)}," for name, entry, below in entries
        ]
        return "\n".join([opening, *lines, " " * indent + closing])

    def flat(self, value: Any, path: str) -> str:
        """A value on one line."""
        opening, entries, closing = self.parts(value, path)
        if not entries:
            return opening
        return opening + ", ".join(name + self.flat(entry, below) for name, entry, below in entries) + closing

    def parts(self, value: Any, path: str) -> "Tuple[str, List[Tuple[str, Any, str]], str]":
        """Opening, named entries with their paths, and closing of a value; without entries the opening is all of it."""
        if isinstance(value, (Noun, Samples)):
            names = list(value._types) if isinstance(value, Noun) else ["values", "spacing", "origin"]
            if not path:
                names.sort(key=lambda name: FIRST.index(name) if name in FIRST else len(FIRST))
            alone = names == ["value"]
            parameters = inspect.signature(type(value).__init__).parameters
            required = {n for n in names if n in parameters and parameters[n].default is inspect.Parameter.empty}
            given = [n for n in names if not _left_out(getattr(value, n)) or n in required]
            stated = [("" if alone else f"{n}=", getattr(value, n), _below(path, n)) for n in given]
            kind = type(value).__name__
            return (f"sg.{kind}(", stated, ")") if stated else (f"sg.{kind}()", [], "")
        if isinstance(value, Mapping):
            entries = [(f"{_text(key)}: ", entry, _below(path, key)) for key, entry in _named(value, path)]
            return ("{", entries, "}") if entries else ("{}", [], "")
        if isinstance(value, np.generic):
            value = value.item()
        if isinstance(value, (list, tuple)):
            return ("[", [("", entry, path) for entry in value], "]") if value else ("[]", [], "")
        if value is None or isinstance(value, (bool, int, float, str, bytes)):
            return _text(value), [], ""
        if callable(value) and not hasattr(value, "__array__"):
            from ._trace import traced

            found = traced(value, path)
            return self.parts(found, path)
        if hasattr(value, "__fspath__"):
            return _text(str(value)), [], ""
        if hasattr(value, "__array__") or hasattr(value, "__iter__"):
            array = np.asarray(value if hasattr(value, "__array__") else list(value))
            if array.ndim == 0 or array.dtype.kind in "OU":
                return self.parts(array.tolist(), path)
            self.has_arrays = True
            return "np.array(", [("", array.tolist(), path)], ")"
        raise CaseError(f"a value of the type {type(value).__name__} cannot be written as code", path=path)


def _below(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name


def _text(value: Any) -> str:
    """Texts in double quotes where that needs no escapes."""
    plain = repr(value)
    if isinstance(value, str) and plain.startswith("'") and '"' not in value and "\\" not in plain:
        return f'"{value}"'
    return plain
