"""Small problems with every kind of body."""

import numpy as np
import signorini as sg

STEEL = sg.LinearElastic(youngs_modulus=1.0, poissons_ratio=0.3)


def membrane(**changes):
    """A round membrane on a flat floor."""
    film = sg.Membrane(domain=sg.Disc(radius=1), mesh=sg.GridMesh(cells=[12, 12]), degree=3, tension=1)
    keys = dict(
        space="plane",
        bodies={"film": film, "floor": sg.Rigid(shape=-0.1)},
        supports={"rim": sg.Support(on="film:boundary", displacement=0)},
        loads={"press": sg.Load(on="film", normal=-1)},
        contacts={"touch": sg.Contact(between=["film", "floor"])},
    )
    return sg.Problem(**{**keys, **changes})


def grid(n=4):
    """Points and quadrilaterals of a unit square."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    points = np.column_stack([x.ravel(), y.ravel()])
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    cells = np.column_stack([first, first + 1, first + n + 2, first + n + 1])
    return points, cells


def mesh(n=4):
    points, cells = grid(n)
    top = np.flatnonzero(points[:, 1] == 1)
    bottom = np.flatnonzero(points[:, 1] == 0)
    return sg.MeshArrays(
        points=points,
        cells=[sg.CellArrays(shape="quadrilateral", nodes=cells)],
        groups={"upper": top, "lower": bottom},
    )


def block(mesh_=None, **changes):
    """A block of finite elements pressed on a plane: the mesh is one of arrays."""
    keys = dict(
        space="plane_strain",
        bodies={
            "block": sg.Solid(mesh=mesh_ if mesh_ is not None else mesh(), material=STEEL),
            "floor": sg.Rigid(shape=sg.Plane(point=[0, 0], normal=[0, 1])),
        },
        supports={"press": sg.Support(on="block:upper", displacement=[0, "-0.01*t"])},
        contacts={"touch": sg.Contact(between=["block:lower", "floor"])},
        steps=[sg.Step(to=1, increments=2)],
    )
    return sg.Problem(**{**keys, **changes})


def image(values=None, **changes):
    """A block of finite cells from an image."""
    if values is None:
        values = np.ones((8, 8))
    geometry = sg.ImageGeometry(file=values, spacing=[0.125, 0.125], origin=[0, 0], youngs_modulus="value")
    keys = dict(
        space="plane_strain",
        bodies={
            "block": sg.Cells(
                geometry=geometry,
                mesh=sg.CellsMesh(grid=sg.CellsGrid(cells=[4, 4], min=[0, 0], max=[1, 1])),
                degree=1,
                material=STEEL,
            ),
            "floor": sg.Rigid(shape=sg.Plane(point=[0, 0], normal=[0, 1])),
        },
        supports={"press": sg.Support(on="block:top", displacement=[0, -0.01])},
        contacts={"touch": sg.Contact(between=["block", "floor"])},
    )
    return sg.Problem(**{**keys, **changes})


def rope():
    """A rope half around a drum, pulled at both ends."""
    angles = np.linspace(0, np.pi, 31)
    arc = np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
    path = np.vstack([[[1, -1, 0]], arc, [[-1, -1, 0]]])
    return sg.Problem(
        bodies={
            "belt": sg.Rope(path=path, cells=40, stiffness=1e4, pretension=1.0),
            "drum": sg.Rigid(shape=sg.Cylinder(point=[0, 0, 0], axis=[0, 0, 1], radius=1)),
        },
        supports={"end": sg.Support(on="belt:end", displacement=[0, 0, 0])},
        loads={"pull": sg.Load(on="belt:start", force=[0, -1, 0])},
        contacts={"touch": sg.Contact(between=["belt", "drum"], friction=sg.CoulombFriction(mu=0.3))},
    )


def beams():
    """Two beams in contact at a crossing point."""
    beam = lambda points: sg.Beam(
        path=points,
        cells=8,
        section=sg.CircleSection(radius=0.05),
        material=sg.LinearElastic(youngs_modulus=1e6, poissons_ratio=0.3),
    )
    clamped = lambda on, z: sg.Support(on=on, displacement=[0, 0, z], rotation=[0, 0, 0])
    return sg.Problem(
        bodies={"lower": beam([[-2, 0, 0], [2, 0, 0]]), "upper": beam([[0, -2, 0.11], [0, 2, 0.11]])},
        supports={"a": clamped("lower:boundary", 0), "b": clamped("upper:boundary", "-0.1*t")},
        contacts={"cross": sg.Contact(between=["upper", "lower"])},
        steps=[sg.Step(to=1, increments=2)],
    )
