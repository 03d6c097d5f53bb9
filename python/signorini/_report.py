"""A result that is in memory as a folder of results, of which a page is made."""

from __future__ import annotations

import base64
import pathlib
from typing import Any, List, Tuple

import numpy as np

from ._result import SHAPES, Fields, Result


def store(result: Result, folder: pathlib.Path) -> None:
    """Writes the summary, the files and the states of a result as the command does."""
    for name, content in result.files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    if not (folder / "summary.json").exists():
        (folder / "summary.json").write_text(result.text, encoding="utf-8")
    if result.case_text and not (folder / "case.toml").exists():
        (folder / "case.toml").write_text(result.case_text, encoding="utf-8")
    bodies: List[Tuple[float, str]] = []
    contacts: List[Tuple[float, str]] = []
    for number, state in enumerate(result.states):
        name = f"fields/fields_{number:05}.vtu"
        _write(folder / name, _file(list(state.bodies.values()), "UnstructuredGrid"))
        bodies.append((state.time, name))
        for contact, fields in state.contacts.items():
            name = f"contact/{contact}_{number:05}.vtp"
            _write(folder / name, _file([fields], "PolyData"))
            contacts.append((state.time, name))
    for name, files in (("fields.pvd", bodies), ("contact.pvd", contacts)):
        if files:
            (folder / name).write_text(_collection(files), encoding="utf-8")


def _write(path: pathlib.Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def _collection(files: List[Tuple[float, str]]) -> str:
    lines = (f'<DataSet timestep="{time!r}" part="0" file="{file}"/>\n' for time, file in files)
    return f'<VTKFile type="Collection" version="0.1"><Collection>\n{"".join(lines)}</Collection></VTKFile>\n'


def _array(name: str, values: np.ndarray) -> str:
    """An array of VTK, its bytes as base64 behind their number."""
    kind = {"f": "Float64", "i": "Int64", "u": "UInt8"}[values.dtype.kind]
    data = np.ascontiguousarray(values).tobytes()
    text = base64.b64encode(len(data).to_bytes(8, "little") + data).decode()
    components = values.shape[1] if values.ndim == 2 else 1
    return f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="binary">{text}</DataArray>'


def _file(parts: List[Fields], kind: str) -> str:
    """Fields as one file; what a part does not have is zero there, and `body` tells parts apart."""
    count = sum(len(part.points) for part in parts)
    arrays = {}
    first = 0
    for part in parts:
        for name, values in part.arrays.items():
            shape = (count, *values.shape[1:])
            whole = arrays.setdefault(name, np.zeros(shape))
            if whole.shape == shape:
                whole[first : first + len(part.points)] = values
        first += len(part.points)
    if kind == "UnstructuredGrid" and not ("gap" in arrays and len(parts) == 1):
        arrays["body"] = np.repeat(np.arange(len(parts), dtype=float), [len(part.points) for part in parts])
    if not arrays:
        arrays["front"] = np.zeros(count)
    points = np.concatenate([part.points for part in parts]) if parts else np.zeros((0, 3))
    connectivity, ends, types = _cells(parts)
    data = f'<PointData>{"".join(_array(name, values) for name, values in arrays.items())}</PointData>'
    head = f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64"><{kind}>'
    where = f'<Points>{_array("Points", points)}</Points>'
    if kind == "UnstructuredGrid":
        cells = f'{_array("connectivity", connectivity)}{_array("offsets", ends)}{_array("types", types)}'
        piece = f'<Piece NumberOfPoints="{count}" NumberOfCells="{len(ends)}">{data}{where}<Cells>{cells}</Cells></Piece>'
    else:
        if not len(ends):
            connectivity, ends = np.arange(count), np.arange(1, count + 1)
            types = np.ones(count, dtype=np.uint8)
        name = "Verts" if (types == 1).all() else "Lines" if (types == 3).all() else "Polys"
        cells = f'<{name}>{_array("connectivity", connectivity)}{_array("offsets", ends)}</{name}>'
        piece = f'<Piece NumberOfPoints="{count}" NumberOf{name}="{len(ends)}">{data}{where}{cells}</Piece>'
    return f"{head}{piece}</{kind}></VTKFile>\n"


def _cells(parts: List[Fields]) -> Any:
    """Corners of all cells, where the corners of each end, and their numbers in VTK."""
    numbers = {name: number for name, number in SHAPES.values()}
    connectivity, ends, types, first, last = [], [], [], 0, 0
    for part in parts:
        connectivity.append(np.asarray(part.connectivity) + first)
        ends.append(np.asarray(part.offsets)[1:] + last)
        types.extend(numbers[shape] for shape in part.shapes)
        first += len(part.points)
        last += len(part.connectivity)
    whole = lambda arrays: np.concatenate(arrays) if arrays else np.zeros(0, dtype=int)
    return whole(connectivity), whole(ends), np.array(types, dtype=np.uint8)
