"""Results: what `summary.json` tells, the fields as arrays, pictures."""

from __future__ import annotations

import base64
import csv
import html
import io
import json
import os
import pathlib
import tempfile
from typing import Any, Dict, Iterator, List, Optional, Union

import numpy as np

from ._errors import optional

#: Names of shapes of cells in meshio, and their numbers in VTK.
SHAPES = {
    "Point": ("vertex", 1), "Line": ("line", 3), "Triangle": ("triangle", 5), "Quadrilateral": ("quad", 9),
    "Tetrahedron": ("tetra", 10), "Hexahedron": ("hexahedron", 12), "Wedge": ("wedge", 13), "Polygon": ("polygon", 7),
}


class Record(dict):
    """A table whose entries are attributes too. Lists of numbers are arrays.

    >>> record = Record({"force": [0.0, 0.0, 1.5], "zones": 1})
    >>> record.force, record["zones"]
    (array([0. , 0. , 1.5]), 1)
    """

    def __init__(self, table: "dict | None" = None) -> None:
        super().__init__({key: recorded(value) for key, value in (table or {}).items()})

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"there is no `{name}`: there are {', '.join(map(str, self))}") from None

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *(key for key in self if str(key).isidentifier())]

    def __reduce__(self) -> Any:
        return (_unpickled, (type(self), dict(self), self.__dict__))


def _unpickled(cls: Any, table: dict, attributes: dict) -> Any:
    made = cls.__new__(cls)
    dict.update(made, table)
    made.__dict__.update(attributes)
    return made


def recorded(value: Any) -> Any:
    """A value of JSON: tables as records, lists of numbers as arrays."""
    if isinstance(value, dict):
        return value if isinstance(value, Record) else Record(value)
    if isinstance(value, list):
        array = _array(value)
        return [recorded(entry) for entry in value] if array is None else array
    return value


def _array(values: list) -> Optional[np.ndarray]:
    """Numbers, or rows of as many numbers, as an array."""
    if not values:
        return None
    if all(type(value) in (int, float) for value in values):
        return np.array(values)
    if all(isinstance(value, list) for value in values):
        rows = [_array(value) for value in values]
        known = [row for row in rows if row is not None]
        if len(known) == len(rows) and len({row.shape for row in known}) == 1:
            return np.array(known)
    return None


class Contact(Record):
    """The results of a contact; `fields` are the pressures, gaps and further values at points of its surface.

    `fields` is None for the contacts of a step other than the last one, and where there are no fields.
    """

    fields: "Optional[Fields]"

    def __init__(self, table: Record, fields: "Optional[Fields]") -> None:
        super().__init__(table)
        self.__dict__["fields"] = fields


class Fields:
    """Points, cells, and values at the points, of a body or of a contact. Arrays are attributes and entries.

    points: Positions before the deformation, of shape (n, 3).
    cells: Corners of the cells, an array for each shape, such as ``cells["quad"]``; those of a body in space cover its
        surface.
    arrays: The values by name: ``displacement`` (n, 3), ``von_mises`` (n,), ``pressure`` (n,) …
    """

    def __init__(self, table: dict) -> None:
        self.name: str = table["name"]
        self.points = np.frombuffer(table["points"], "<f8").reshape(-1, 3)
        self.connectivity = np.frombuffer(table["connectivity"], "<i8")
        self.offsets = np.frombuffer(table["offsets"], "<i8")
        self.shapes: List[str] = [SHAPES.get(shape, SHAPES["Polygon"])[0] for shape in table["shapes"]]
        self.arrays: Dict[str, np.ndarray] = {}
        for name, (components, values) in table["arrays"].items():
            values = np.frombuffer(values, "<f8")
            self.arrays[name] = values if components == 1 else values.reshape(-1, components)

    @property
    def cells(self) -> Dict[str, np.ndarray]:
        ends = self.offsets
        found: Dict[str, list] = {}
        for k, shape in enumerate(self.shapes):
            found.setdefault(shape, []).append(self.connectivity[ends[k] : ends[k + 1]])
        return {s: _rows(list_) for s, list_ in found.items()}

    def __getitem__(self, name: str) -> np.ndarray:
        return self.arrays[name]

    def __getattr__(self, name: str) -> np.ndarray:
        arrays = self.__dict__.get("arrays", {})
        if name not in arrays:
            raise AttributeError(f"there is no field `{name}`: there are {', '.join(arrays)}")
        return arrays[name]

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self.arrays]

    def __repr__(self) -> str:
        return f"Fields({self.name!r}, {len(self.points)} points, {', '.join(self.arrays)})"

    def to_pyvista(self) -> Any:
        """The fields as pyvista.PolyData of lines and faces.

        Raises MissingPackage without pyvista.
        """
        pyvista = optional("pyvista")
        counts = np.diff(self.offsets)
        listed = np.insert(self.connectivity, self.offsets[:-1], counts)
        kinds = np.array([{"line": "l", "vertex": "v"}.get(shape, "f") for shape in self.shapes])
        of = lambda kind: np.concatenate([[0], listed])[1:][np.repeat(kinds == kind, counts + 1)] if len(kinds) else None
        given = {key: of(kind) for key, kind in (("faces", "f"), ("lines", "l"), ("verts", "v")) if (kinds == kind).any()}
        made = pyvista.PolyData(self.points, **given)
        for name, values in self.arrays.items():
            made.point_data[name] = values
        return made

    def to_meshio(self) -> Any:
        """The fields as meshio.Mesh.

        Raises MissingPackage without meshio.
        """
        meshio = optional("meshio")
        cells = [(s, rows) for s, rows in self.cells.items() if isinstance(rows, np.ndarray) and rows.ndim == 2]
        return meshio.Mesh(self.points, cells, point_data=dict(self.arrays))


def _rows(rows: list) -> Any:
    """Rows of equal length as an array; others as a list."""
    return np.array(rows) if len({len(row) for row in rows}) == 1 else rows


class State:
    """The fields at a time.

    time: The time.
    bodies, contacts: Fields by the names of bodies and contacts.
    """

    def __init__(self, table: dict) -> None:
        self.time: float = table["time"]
        self.bodies = Record()
        self.contacts = Record()
        for stated, of in ((table["bodies"], self.bodies), (table["contacts"], self.contacts)):
            dict.update(of, {fields["name"]: Fields(fields) for fields in stated})

    def __repr__(self) -> str:
        return f"State(t={self.time}, bodies={list(self.bodies)}, contacts={list(self.contacts)})"


class Picture:
    """A picture, shown by Jupyter.

    name: Its name, which ends with `.png` or `.svg`.
    data: The content of the file.
    """

    def __init__(self, name: str, data: bytes) -> None:
        self.name = name
        self.data = data

    def save(self, path: Union[str, os.PathLike]) -> None:
        """Writes the picture; the ending of the path must be that of its name. Raises OSError."""
        wanted, ending = pathlib.Path(path).suffix.lower(), pathlib.Path(self.name).suffix
        if wanted != ending:
            raise ValueError(f"`{self.name}` is saved as {ending}, not `{wanted}`")
        pathlib.Path(path).write_bytes(self.data)

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict:
        if self.name.endswith(".svg"):
            return {"image/svg+xml": self.data.decode()}
        return {"image/png": base64.b64encode(self.data).decode()}

    def __repr__(self) -> str:
        return f"Picture({self.name!r}, {len(self.data)} bytes)"


class Result:
    """The results of a run.

    summary: The content of `summary.json` as a :class:`Record`; its entries are attributes of the result:
        ``converged``, ``reason``, ``verdict``, ``method``, ``unknowns``, ``warnings``, ``events``, ``steps`` …
    steps: One record per increment, with ``contacts``, ``support_forces``, ``probes`` …
    states: The fields of the increments that `output.every` asks for, the last one included.
    files: Contents of `history.csv` and of the pictures, by name.
    text, case_text: The text of `summary.json`, and of the case.
    """

    def __init__(self, found: dict, folder: Optional[str] = None) -> None:
        self.text: str = found["summary"]
        self.case_text: str = found.get("case", "")
        self.summary = Record(json.loads(self.text))
        self.states = [State(table) for table in found["states"]]
        self.files: Dict[str, bytes] = found["files"]
        self.folder = folder
        for step in self.summary.get("steps", []):
            for name, contact in step.get("contacts", {}).items():
                dict.__setitem__(step.contacts, name, Contact(contact, self._fields(step, name)))

    def _fields(self, step: Record, name: str) -> Optional[Fields]:
        """The fields of a contact in a step, where that was kept."""
        kept = [state for state in self.states if state.time == step.time]
        return kept[-1].contacts.get(name) if kept else None

    def __getattr__(self, name: str) -> Any:
        summary = self.__dict__.get("summary", {})
        if name.startswith("__") or name not in summary:
            raise AttributeError(f"there is no `{name}`: there are {', '.join(summary)}")
        return summary[name]

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self.summary]

    @property
    def interrupted(self) -> bool:
        """Whether the run was interrupted, with Ctrl-C; what was found before is there."""
        return self.summary.reason == "interrupted"

    @property
    def last(self) -> Record:
        """The last increment that converged; the last one if none did. Raises LookupError if there is none at all."""
        steps = self.summary.get("steps")
        if not steps:
            raise LookupError(f"no increment was solved: {self.summary.verdict}")
        return next((step for step in reversed(steps) if step.converged), steps[-1])

    @property
    def contacts(self) -> Record:
        """The contacts at the end, by name."""
        return self.last.contacts

    @property
    def probes(self) -> Record:
        """The values at `output.probes` at the end, by name."""
        return self.last.probes

    @property
    def bodies(self) -> Record:
        """The fields of the bodies at the end, by name."""
        return self.states[-1].bodies if self.states else Record()

    @property
    def times(self) -> np.ndarray:
        """The times of the increments."""
        return np.array([step.time for step in self.summary.steps])

    def history(self, path: str) -> np.ndarray:
        """A figure over all increments, by its path in a step: ``history("contacts.touch.force")`` has the shape (n, 3).

        What an increment does not have is nan. Raises KeyError for a path that no increment has.
        """
        values = [_at(step, path) for step in self.summary.steps]
        known = [value for value in values if value is not None]
        if not known:
            raise KeyError(f"`{path}`: an increment has {', '.join(self.last)}")
        shape = np.shape(known[0])
        return np.array([np.full(shape, np.nan) if value is None else value for value in values])

    @property
    def histories(self) -> Record:
        """The columns of `history.csv`, by name."""
        return columns(self.files.get("history.csv") or self._on_disk("history.csv"))

    @property
    def lines(self) -> Record:
        """The paths of `wrap`, `wind` and `theorem`: the columns of the table of each path, by the name of its file."""
        files = dict(self.files)
        if self.folder:
            folder = pathlib.Path(self.folder)
            files.update({f"paths/{p.name}": p.read_bytes() for p in sorted(folder.glob("paths/*.csv"))})
        found = {pathlib.PurePosixPath(name).stem: content for name, content in sorted(files.items())
                 if name.startswith("paths/") and name.endswith(".csv")}
        made = Record()
        dict.update(made, {name: columns(content) for name, content in found.items()})
        return made

    def _on_disk(self, name: str) -> bytes:
        path = pathlib.Path(self.folder or ".") / name
        return path.read_bytes() if self.folder and path.is_file() else b""

    @property
    def pictures(self) -> Dict[str, Picture]:
        """The pictures by name, such as ``deformed.png``."""
        files = {name: content for name, content in self.files.items() if name.startswith("pictures/")}
        if self.folder:
            folder = pathlib.Path(self.folder) / "pictures"
            files.update({f"pictures/{path.name}": path.read_bytes() for path in sorted(folder.glob("*"))})
        return {name.split("/", 1)[1]: Picture(name.split("/", 1)[1], files[name]) for name in sorted(files)}

    def picture(self, name: Optional[str] = None) -> Optional[Picture]:
        """A picture by its name; the main one if left out, or None if no pictures were drawn."""
        if name is None:
            first = self.summary.get("first_picture")
            return self.pictures.get(first.split("/", 1)[1]) if first else None
        return self.pictures[name]

    def report(self, path: "Union[str, os.PathLike, None]" = None) -> pathlib.Path:
        """Writes the result as one HTML page that needs no network, and returns the path of the page.

        path: The file; ``report.html`` in the folder of the result if left out, in the current folder for a result in memory.

        Raises OutputError for a page that cannot be written.

        >>> import signorini as sg, tempfile, pathlib
        >>> result = sg.run(sg.gallery("string"), pictures=False)
        >>> result.report(pathlib.Path(tempfile.mkdtemp()) / "string.html").name
        'string.html'
        """
        from . import _native
        from ._report import store

        target = pathlib.Path(path) if path is not None else pathlib.Path(self.folder or ".") / "report.html"
        if self.folder:
            _native.report(os.fspath(self.folder), os.fspath(target))
            return target
        with tempfile.TemporaryDirectory() as made:
            store(self, pathlib.Path(made))
            _native.report(made, os.fspath(target))
        return target

    def draw(self, path: "Union[str, os.PathLike, None]" = None, **options: Any) -> bytes:
        """Draws the result anew, without solving, with the options of :func:`signorini.draw`, and returns the picture."""
        from ._draw import draw

        return draw(self, path, **options)

    def to_pyvista(self, state: int = -1) -> Any:
        """The fields of a state as pyvista.MultiBlock: bodies, and contacts called ``contact NAME``.

        Raises MissingPackage without pyvista.
        """
        blocks = optional("pyvista").MultiBlock()
        for name, fields in self._all(state):
            blocks[name] = fields.to_pyvista()
        return blocks

    def to_meshio(self, body: Optional[str] = None, state: int = -1) -> Any:
        """The fields of a body as meshio.Mesh; without a name, those of all bodies in a dictionary.

        Raises MissingPackage without meshio.
        """
        optional("meshio")
        bodies = self.states[state].bodies
        return bodies[body].to_meshio() if body else {name: fields.to_meshio() for name, fields in bodies.items()}

    def _all(self, state: int) -> Iterator:
        yield from self.states[state].bodies.items()
        yield from ((f"contact {name}", fields) for name, fields in self.states[state].contacts.items())

    def __repr__(self) -> str:
        return f"<Result of {self.summary.get('case', '')!r}: {self.summary.get('verdict', '')}>"

    def _repr_html_(self) -> str:
        rows = []
        for name, contact in (self.last.get("contacts", {}) if self.summary.get("steps") else {}).items():
            cells = (name, _told(contact.get("force")), _told(contact.get("area")), _told(contact.get("max_pressure")))
            rows.append("<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in cells) + "</tr>")
        head = "<tr><th>contact</th><th>force</th><th>area</th><th>largest pressure</th></tr>"
        table = f"<table>{head}{''.join(rows)}</table>" if rows else ""
        warnings = "".join(f"<li>{html.escape(_message(w))}</li>" for w in self.summary.get("warnings", []))
        picture = self.picture()
        shown = ""
        if picture is not None:
            kind = "svg+xml" if picture.name.endswith(".svg") else "png"
            data = base64.b64encode(picture.data).decode()
            shown = f'<img alt="result" style="max-width:100%" src="data:image/{kind};base64,{data}">'
        title, verdict = (html.escape(str(self.summary.get(key, ""))) for key in ("case", "verdict"))
        listed = f"<ul>{warnings}</ul>" if warnings else ""
        return f"<h4>{title}</h4><p>{verdict}</p>{listed}{table}{shown}"


def _at(record: Any, path: str) -> Any:
    for key in path.split("."):
        if isinstance(record, dict) and key in record:
            record = record[key]
        else:
            return None
    return record


def _told(value: Any) -> str:
    if value is None:
        return ""
    return ", ".join(f"{v:.6g}" for v in np.atleast_1d(value))


def _message(warning: Any) -> str:
    return warning.get("message", str(dict(warning))) if isinstance(warning, dict) else str(warning)


def columns(content: bytes) -> Record:
    """The columns of a table with a row of names: arrays of numbers, or lists of texts."""
    rows = list(csv.reader(io.StringIO(content.decode())))
    made = Record()
    for k, name in enumerate(rows[0] if rows else []):
        texts = [row[k] for row in rows[1:]]
        try:
            dict.__setitem__(made, name, np.array([float(text) if text else np.nan for text in texts]))
        except ValueError:
            dict.__setitem__(made, name, texts)
    return made
