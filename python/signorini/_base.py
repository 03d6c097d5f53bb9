"""What all nouns have in common, and how they become plain tables for the native part."""

from __future__ import annotations

import difflib
import functools
import os
from typing import TYPE_CHECKING, Any, Callable, Dict, Mapping, Sequence, Union

import numpy as np

from ._errors import CaseError

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.ArrayLike
else:
    Array = Any


class Noun:
    """A table of the case file. Keys are attributes; None leaves a key out."""

    #: The key of this kind, where the table is one of several kinds.
    _key: "str | None" = None
    #: Key of the case file and type, by attribute. Types are `Value`, `str`, `int`, `float`, `bool`, the name of a class,
    #: `<Choice>`, `[item]` for a list, `{item}` for a table of names, and alternatives with `|`.
    _types: Mapping[str, tuple] = {}

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self._types and not name.startswith("_"):
            near = difflib.get_close_matches(name, self._types, 1)
            advice = f"did you mean `{near[0]}`?" if near else f"valid are {', '.join(self._types)}"
            raise AttributeError(f"{type(self).__name__} has no key `{name}`: {advice}")
        object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        stated = ((name, getattr(self, name)) for name in self._types)
        return f"{type(self).__name__}({', '.join(f'{n}={_short(v)}' for n, v in stated if not _left_out(v))})"

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(_same(getattr(self, name), getattr(other, name)) for name in self._types)

    __hash__ = None  # type: ignore[assignment]

    def replace(self, **changes: Any) -> "Noun":
        """A copy with other values for some keys.

        >>> import signorini as sg
        >>> sg.Sphere(center=[0, 0, 0], radius=1.0).replace(radius=2.0).radius
        2.0
        """
        made = object.__new__(type(self))
        made.__dict__.update(self.__dict__)
        for name, value in changes.items():
            setattr(made, name, value)
        return made


class Samples:
    """Values at the points of a grid over x and y, joined by a bicubic spline: a field, or a height.

    values: Array of shape (rows along y, columns along x), at least 4 by 4, in base units.
    spacing: Spacing of the columns (along x) and of the rows (along y).
    origin: Position of the first value.

    >>> import signorini as sg
    >>> bump = sg.Samples.of(lambda x, y: -0.1 * (x**2 + y**2), min=[-1, -1], max=[1, 1], counts=[5, 9])
    >>> bump.values.shape, bump.spacing
    ((9, 5), [0.5, 0.25])
    """

    def __init__(self, values: Array, *, spacing: "Array" = (1.0, 1.0), origin: "Array" = (0.0, 0.0)) -> None:
        self.values = values
        self.spacing = spacing
        self.origin = origin

    @classmethod
    def of(cls, function: Callable[..., Any], *, min: "Array", max: "Array", counts: "Sequence[int]") -> "Samples":
        """Samples of a function `f(x, y)`, which is called once with two arrays of shape (counts[1], counts[0])."""
        low, high, counts = np.asarray(min, float), np.asarray(max, float), list(map(int, counts))
        if low.shape != (2,) or high.shape != (2,) or len(counts) != 2:
            raise ValueError("min, max and counts need two entries each, along x and y")
        x, y = np.meshgrid(*(np.linspace(a, b, n) for a, b, n in zip(low, high, counts)))
        values = np.broadcast_to(np.asarray(function(x, y), float), x.shape)
        spacing = [float((b - a) / (n - 1)) for a, b, n in zip(low, high, counts)]
        return cls(np.array(values), spacing=spacing, origin=low.tolist())

    def __repr__(self) -> str:
        return f"Samples({_short(self.values)}, spacing={self.spacing!r}, origin={self.origin!r})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Samples):
            return NotImplemented
        return all(_same(getattr(self, k), getattr(other, k)) for k in ("values", "spacing", "origin"))

    __hash__ = None  # type: ignore[assignment]


#: Ends of the keys that name files, for which arrays may stand.
FILES = (".file", ".data", ".profile")

#: A number, a quantity such as "0.1 mm", an expression, a callable that is one, or samples.
Value = Union[float, int, str, Callable[..., Any], Samples]


class Tree:
    """A problem as plain tables: numbers, texts, lists, and arrays as tuples `(kind, shape, bytes)`."""

    def __init__(self) -> None:
        #: Files that exist in memory only, by the names that the tables give them.
        self.files: Dict[str, bytes] = {}

    def table(self, noun: Noun, path: str) -> dict:
        """The table of a noun."""
        out = {}
        for name, (key, kind) in noun._types.items():
            value = getattr(noun, name)
            if not _left_out(value):
                out[key] = self.of(value, kind, f"{path}.{key}" if path else key)
        return out

    def of(self, value: Any, kind: str, path: str) -> Any:
        """The plain form of a value of a type."""
        choices = _choices_of(kind)
        if choices:
            return self.choice(value, choices, kind, path)
        if isinstance(value, Noun):
            return self.table(value, path)
        if isinstance(value, Samples):
            return self.samples(value, path)
        if callable(value) and not hasattr(value, "__array__"):
            return self.callable(value, path)
        if kind == "str" and path.endswith(FILES) and not isinstance(value, (str, os.PathLike)):
            return self.file(value, path)
        if isinstance(value, Mapping):
            return {key: self.of(v, _type_in(kind, key), f"{path}.{key}") for key, v in _named(value, path) if v is not None}
        return self.plain(value, _item_of(kind), path)

    def choice(self, value: Any, choices: dict, kind: str, path: str) -> Any:
        """One of several kinds: a noun, a table with its key, a word, or what only one kind holds."""
        if isinstance(value, Noun):
            if value._key is None or value._key not in choices:
                raise CaseError(f"a {type(value).__name__} cannot stand here", path=path, help=f"valid are {', '.join(choices)}")
            below = f"{path}.{value._key}"
            if set(value._types) == {"value"}:
                return {value._key: self.of(getattr(value, "value"), value._types["value"][1], below)}
            return {value._key: self.table(value, below)}
        if isinstance(value, Mapping):
            return {key: self.of(v, choices.get(key, "any"), f"{path}.{key}") for key, v in _named(value, path)}
        if isinstance(value, str) and value in choices:
            return {value: {}}
        held = [key for key, held in choices.items() if held == "Value" or held.startswith("[")]
        if len(held) == 1 and (isinstance(value, str) == (choices[held[0]] == "Value") or not isinstance(value, str)):
            return {held[0]: self.of(value, choices[held[0]], f"{path}.{held[0]}")}
        return self.plain(value, "any", path)

    def samples(self, samples: Samples, path: str) -> dict:
        """Samples as a table."""
        values = self.plain(samples.values, "any", f"{path}.values")
        return {
            "origin": self.plain(samples.origin, "any", f"{path}.origin"),
            "spacing": self.plain(samples.spacing, "any", f"{path}.spacing"),
            "values": values,
        }

    def callable(self, function: Callable, path: str) -> Any:
        """A callable as the expression that it computes."""
        from ._trace import traced

        return traced(function, path)

    def file(self, value: Any, path: str) -> str:
        """An array, a table of columns or bytes in place of a file."""
        if isinstance(value, Mapping):
            return self.keep(path, "csv", _csv(value, path))
        if isinstance(value, bytes):
            return self.keep(path, "json", value)
        array = _numbers(value, path)
        if array.ndim == 0:
            raise CaseError(f"the name of a file, or an array of its numbers, is expected, not {value!r}", path=path)
        if path.endswith(".profile"):
            if array.ndim != 2 or array.shape[1] != 2:
                raise CaseError(f"an array of the shape {array.shape}: a profile has the shape (n, 2)", path=path)
            return self.keep(path, "csv", _csv({"r": array[:, 0], "z": array[:, 1]}, path))
        return self.keep(path, "npy", _npy(array))

    def keep(self, path: str, ending: str, content: bytes) -> str:
        name = f"{path.replace('.', '_')}.{ending}"
        self.files[name] = content
        return name

    def plain(self, value: Any, kind: str, path: str) -> Any:
        """A number, a text, a list or an array."""
        if isinstance(value, (bool, str, int, float)):
            return value
        if isinstance(value, np.generic):
            return self.plain(value.item(), kind, path)
        if isinstance(value, (list, tuple)):
            return [self.of(entry, kind, f"{path}[{k}]") for k, entry in enumerate(value)]
        if isinstance(value, os.PathLike):
            return os.fspath(value)
        if hasattr(value, "__array__") or isinstance(value, (range, memoryview)):
            return self.array(value, kind, path)
        if hasattr(value, "__iter__") and not isinstance(value, (bytes, set, frozenset)):
            return self.plain(list(value), kind, path)
        raise CaseError(f"a value of the type {type(value).__name__} cannot be stated in a case", path=path)

    def array(self, value: Any, kind: str, path: str) -> Any:
        """An array of numbers of any shape, strides and byte order; arrays of objects are lists."""
        array = np.asarray(value)
        if array.ndim == 0:
            return self.plain(array.item(), kind, path)
        if array.dtype.kind in "OU":
            return self.plain(array.tolist(), kind, path)
        numbers = _numbers(array, path)
        return ("f8" if numbers.dtype.kind == "f" else "i8", numbers.shape, numbers.tobytes())


@functools.lru_cache(maxsize=None)
def split(kind: str) -> "list[str]":
    """The alternatives of a type: what `|` separates outside of brackets."""
    found, depth = [""], 0
    for letter in kind:
        depth += (letter in "[{") - (letter in "]}")
        if letter == "|" and depth == 0:
            found.append("")
        else:
            found[-1] += letter
    return found


def _choices_of(kind: str) -> "dict | None":
    from ._nouns import CHOICES

    found: dict = {}
    for part in split(kind):
        if part.startswith("<"):
            found.update(CHOICES[part[1:-1]])
    return found or None


def _item_of(kind: str) -> str:
    """The type of the entries of a list."""
    lists = [part for part in split(kind) if part.startswith("[")]
    return lists[0][1:-1] if lists else kind


def _type_in(kind: str, key: Any) -> str:
    """The type of an entry of a table."""
    from . import _nouns

    if kind.startswith("{"):
        return kind[1:-1]
    for part in split(kind):
        types = getattr(getattr(_nouns, part, None), "_types", {})
        for stated, of in types.values():
            if stated == key:
                return of
    return "any"


def _named(table: Mapping, path: str):
    for key, value in table.items():
        if not isinstance(key, str):
            raise CaseError(f"the key {key!r} is no text", path=path)
        yield key, value


def _left_out(value: Any) -> bool:
    return value is None or (isinstance(value, (dict, list, tuple)) and not value)


def _numbers(value: Any, path: str) -> np.ndarray:
    """Numbers in the order of C, whole or real, all finite."""
    array = np.asarray(value)
    kind = array.dtype.kind
    if kind not in "biuf":
        raise CaseError(f"an array of {array.dtype} is not one of real numbers", path=path)
    if kind == "u" and array.size and array.max() > np.iinfo(np.int64).max:
        raise CaseError("a number is larger than 64 bits with a sign hold", path=path)
    if kind == "f" and not np.isfinite(array).all():
        at = np.argwhere(~np.isfinite(array))[0].tolist()
        raise CaseError(f"the entry {at} is {array[tuple(at)]}, not a finite number", path=path)
    return np.ascontiguousarray(array, dtype="<f8" if kind == "f" else "<i8")


def _npy(array: np.ndarray) -> bytes:
    import io

    buffer = io.BytesIO()
    np.save(buffer, array, allow_pickle=False)
    return buffer.getvalue()


def _csv(columns: Mapping, path: str) -> bytes:
    """A table of columns of equal length."""
    arrays = {str(name): _numbers(column, f"{path}.{name}") for name, column in columns.items()}
    sizes = {array.shape for array in arrays.values()}
    if len(sizes) != 1 or len(next(iter(sizes))) != 1:
        raise CaseError(f"columns of the shapes {sorted(sizes)}: give one-dimensional ones of equal length", path=path)
    rows = zip(*(array.tolist() for array in arrays.values()))
    return "\n".join([",".join(arrays), *(",".join(map(repr, row)) for row in rows), ""]).encode()


def _same(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return np.array_equal(np.asarray(a), np.asarray(b))
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return a.keys() == b.keys() and all(_same(a[key], b[key]) for key in a)
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(map(_same, a, b))
    return bool(a == b)


def _short(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"<array {value.shape} of {value.dtype}>"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key!r}: {_short(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list) and len(value) <= 100:
        return "[" + ", ".join(map(_short, value)) + "]"
    return repr(value) if not isinstance(value, (list, tuple)) or len(value) <= 100 else f"<list of {len(value)}>"

