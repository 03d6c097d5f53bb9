"""Meshes of other packages."""

from __future__ import annotations

from typing import Any, Mapping, Optional

import numpy as np

from ._nouns import CellArrays, MeshArrays

#: Cells of meshio by their shapes here, and of VTK by their numbers.
SHAPES = {"triangle": "triangle", "quad": "quadrilateral", "tetra": "tetrahedron", "hexahedron": "hexahedron", "wedge": "wedge"}
NUMBERS = {5: "triangle", 9: "quadrilateral", 10: "tetrahedron", 12: "hexahedron", 13: "wedge"}
FLAT = ("triangle", "quadrilateral")


def from_meshio(mesh: Any, groups: Optional[Mapping[str, Any]] = None) -> MeshArrays:
    """The mesh of a body from a meshio.Mesh with straight cells; flat cells beside solid ones are left out.

    groups: Lists of points by name, in addition to the point sets of the mesh.

    Raises ValueError for a mesh without such cells.
    """
    listed = [(SHAPES[block.type], np.asarray(block.data)) for block in mesh.cells if block.type in SHAPES]
    named = {**getattr(mesh, "point_sets", {}), **(groups or {})}
    return _mesh(np.asarray(mesh.points, float), listed, named)


def from_pyvista(grid: Any, groups: Optional[Mapping[str, Any]] = None) -> MeshArrays:
    """The mesh of a body from a pyvista.UnstructuredGrid with straight cells; flat cells beside solid ones are left out.

    groups: Lists of points by name.

    Raises ValueError for a grid without such cells.
    """
    listed = [(NUMBERS[number], np.asarray(nodes)) for number, nodes in grid.cells_dict.items() if number in NUMBERS]
    return _mesh(np.asarray(grid.points, float), listed, groups or {})


def _mesh(points: np.ndarray, listed: list, groups: Mapping[str, Any]) -> MeshArrays:
    solid = [(shape, nodes) for shape, nodes in listed if shape not in FLAT]
    if not solid:
        points = points[:, :2]
    if not listed:
        raise ValueError("the mesh has no triangles, quadrilaterals, tetrahedra, hexahedra or wedges")
    cells = [CellArrays(shape=shape, nodes=nodes) for shape, nodes in solid or listed]
    return MeshArrays(points=points, cells=cells, groups={name: np.asarray(nodes) for name, nodes in groups.items()})
