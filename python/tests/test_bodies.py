"""Every kind of body once."""

import math

import numpy as np
import problems
import pytest
import signorini as sg


def test_a_membrane_has_the_exact_contact_area():
    result = sg.run(problems.membrane(), pictures=False)
    low, high = 1e-9, 1 - 1e-9
    for _ in range(100):
        a = (low + high) / 2
        low, high = (a, high) if (1 - a**2 + 2 * a**2 * math.log(a)) / 4 > 0.1 else (low, a)
    assert result.converged and result.reason == "converged"
    assert result.contacts.touch.area == pytest.approx(math.pi * low**2, rel=1e-6)
    assert result.contacts["touch"].force == pytest.approx([0, 0, math.pi * low**2], rel=1e-5, abs=1e-8)
    film = result.bodies["film"]
    assert film.displacement.shape == film.points.shape and film["gap"].shape == (len(film.points),)


def test_a_solid_of_arrays_is_under_uniform_pressure():
    result = problems.block().run(pictures=False)
    # Plane strain, free to spread at the bottom only: the force is that of the whole block.
    assert result.converged and len(result.steps) == 2
    force = result.contacts["touch"].force
    assert force[1] > 0 and force == pytest.approx(-result.last.support_forces["press"], abs=1e-10)
    history = result.history("contacts.touch.force")
    assert history.shape == (2, 3) and history[1, 1] == pytest.approx(2 * history[0, 1], rel=1e-6)
    assert result.times.tolist() == [0.5, 1.0]
    fields = result.contacts["touch"].fields
    assert len(fields.points) > 0 and fields.arrays
    assert result.bodies["block"].von_mises.min() > 0


def test_cells_are_of_an_image_in_an_array():
    full = sg.run(problems.image(), pictures=False)
    soft = sg.run(problems.image(np.full((8, 8), 0.5)), pictures=False)
    assert full.converged and soft.converged
    assert full.contacts.touch.force[1] == pytest.approx(2 * soft.contacts.touch.force[1], rel=1e-6)


def test_a_rope_lies_on_a_drum():
    result = sg.run(problems.rope(), pictures=False)
    assert result.converged
    assert result.last.curves["belt"].max_tension == pytest.approx(1, rel=0.05)
    assert result.contacts["touch"].force[1] == pytest.approx(2, rel=0.05)


def test_beams_touch_at_a_crossing():
    result = sg.run(problems.beams(), pictures=False)
    assert result.converged
    assert result.contacts["cross"].force[2] != 0
    assert set(result.bodies) >= {"lower", "upper"}


def sphere():
    """A unit sphere of triangles: an octahedron whose triangles are divided three times."""
    points = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    triangles = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    for _ in range(3):
        middles, finer = {}, []

        def middle(a, b):
            if (min(a, b), max(a, b)) not in middles:
                middles[min(a, b), max(a, b)] = len(points)
                x = np.add(points[a], points[b])
                points.append(x / np.linalg.norm(x))
            return middles[min(a, b), max(a, b)]

        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        triangles = finer
    return np.array(points, float), np.array(triangles)


def test_a_rigid_body_is_a_surface_of_arrays():
    points, triangles = sphere()
    shape = sg.TriangleArrays(points=points, triangles=triangles)
    result = sg.wrap([-2, 0.3, 0.5], [2, 0.3, 0.5], {"ball": shape}, pictures=False)
    exact = sg.wrap([-2, 0.3, 0.5], [2, 0.3, 0.5], {"ball": sg.Sphere(center=[0, 0, 0], radius=1)}, pictures=False)
    length = lambda found: found.paths[0].frames[0].length
    assert length(result) == pytest.approx(length(exact), rel=1e-3)


def test_paths_on_bodies():
    ball = sg.Sphere(center=[0, 0, 0], radius=50.0)
    yarn = sg.wind(ball, sg.WindingStart(z=0.0, angle=0.5), friction=0.2, length=20.0, band=2.0)
    assert yarn.winding[0].length == pytest.approx(20, rel=1e-6)
    assert len(yarn.lines["yarn"]["x"]) > 5
    assert yarn.picture() is not None
    drum = sg.Cylinder(point=[0, 0, 0], axis=[0, 0, 1], radius=0.1)
    half = sg.HelixPath(radius=0.1, pitch=0.0, turns=0.5)
    rope = sg.theorem(drum, half, friction=sg.CoulombFriction(mu=0.3), tension=100.0)
    assert rope.ropes[0].tension_limits == pytest.approx([100 * math.exp(-0.3 * math.pi), 100 * math.exp(0.3 * math.pi)])


def test_a_profile_is_an_array():
    z = np.linspace(-2, 2, 41)
    drum = sg.Revolution(profile=np.column_stack([np.ones_like(z), z]), axis=[0, 0, 1])
    result = sg.wrap([-2, 0.3, 0], [2, 0.3, 0], {"drum": drum}, pictures=False)
    angle = math.pi - 2 * math.atan(0.15) - 2 * math.acos(1 / math.hypot(2, 0.3))
    assert result.paths[0].frames[0].length == pytest.approx(2 * 3.09**0.5 + angle, rel=1e-6)


def test_a_fit_takes_columns_of_arrays():
    problem = sg.gallery("blister")
    data = __import__("pathlib").Path(__file__).parents[2] / "gallery" / "blister" / problem.fit.data
    table = np.genfromtxt(data, delimiter=",", names=True, skip_header=1)
    problem.fit.data = {name: table[name] for name in table.dtype.names}
    found = sg.fit(problem)
    assert found.converged and found.adhesion_energy.value > 0
    assert len(found.table.residual) == found.measurements
