"""Arrays of any layout, and what is none."""

import numpy as np
import problems
import pytest
import signorini as sg


def force(problem):
    return sg.run(problem, pictures=False).contacts["touch"].force


def test_layout_and_type_of_arrays_do_not_matter():
    points, cells = problems.grid()
    wanted = force(problems.block())
    strided = np.zeros((2 * len(points), 4))
    strided[::2, ::2] = points
    frozen = points.copy()
    frozen.setflags(write=False)
    swapped = points.astype(points.dtype.newbyteorder())
    for given in (strided[::2, ::2], np.asfortranarray(points), frozen, swapped, points.tolist(), points.astype(np.float32)):
        mesh = problems.mesh()
        mesh.points = given
        assert np.array_equal(force(problems.block(mesh)), wanted)
    for nodes in (cells.astype(np.uint8), cells.astype(np.int32), cells[:, ::1].T.copy().T, cells.tolist()):
        mesh = problems.mesh()
        mesh.cells = [sg.CellArrays(shape="quadrilateral", nodes=nodes)]
        assert np.array_equal(force(problems.block(mesh)), wanted)


def test_numbers_of_numpy_are_numbers():
    a = sg.run(problems.membrane(loads={"press": sg.Load(on="film", normal=np.float32(-1))}), pictures=False)
    b = sg.run(problems.membrane(loads={"press": sg.Load(on="film", normal=np.array(-1))}), pictures=False)
    assert a.contacts.touch.area == b.contacts.touch.area


def test_a_floor_is_an_expression_samples_or_a_callable():
    floor = lambda x, y: -0.1 + 0.02 * x**2 - 0.03 * np.cos(y) * np.where(x < 0, 1, 1)
    area = lambda shape: sg.run(
        problems.membrane(bodies={"film": problems.membrane().bodies["film"], "floor": sg.Rigid(shape=shape)}), pictures=False
    ).contacts.touch.area
    exact = area("-0.1 + 0.02*x^2 - 0.03*cos(y)")
    assert area(floor) == pytest.approx(exact, rel=1e-9)
    assert area(sg.Height(floor)) == pytest.approx(exact, rel=1e-9)
    sampled = sg.Samples.of(lambda x, y: -0.1 + 0.02 * x**2 - 0.03 * np.cos(y), min=[-1.2, -1.2], max=[1.2, 1.2], counts=[25, 31])
    assert area(sampled) == pytest.approx(exact, rel=1e-4)
    rows = sg.HeightMap(file=np.asarray(sampled.values), spacing=sampled.spacing, origin=sampled.origin)
    assert area(rows) == pytest.approx(area(sampled), rel=1e-9)


def test_a_load_is_a_callable_of_time():
    load = lambda t: -t
    problem = problems.membrane(loads={"press": sg.Load(on="film", normal=load)}, steps=[sg.Step(to=1, increments=1)])
    assert problem.to_toml().count('normal = "(-t)"') == 1
    assert sg.run(problem, pictures=False).contacts.touch.area == sg.run(problems.membrane(), pictures=False).contacts.touch.area


@pytest.mark.parametrize("broken, words", [
    (lambda x: 1 if x > 0 else 0, "branch"),
    (lambda x: __import__("math").sin(x), "number"),
    (lambda x: np.fft.fft(x), "numpy.fft"),
    (lambda x: 1 / 0, "division"),
    (lambda x: "no", "no"),
])
def test_a_callable_that_is_no_expression_is_told(broken, words):
    problem = problems.membrane(loads={"press": sg.Load(on="film", normal=broken)})
    with pytest.raises(sg.CaseError, match=words) as caught:
        sg.check(problem)
    assert caught.value.path == "loads.press.normal" and "Samples.of" in caught.value.help


def test_closest_points_of_many_pairs():
    rng = np.random.default_rng(1)
    points = rng.normal(size=(1000, 3))
    found = sg.closest_points(points, {"type": "sphere", "o": [0, 0, 0], "ex": [1, 0, 0], "ey": [0, 1, 0], "ez": [0, 0, 1],
                                       "r": 0.5, "range": [[0, 2 * np.pi], [-np.pi / 2, np.pi / 2]], "closed": [True, False]})
    assert len(found) == 1000 and found.certified.all()
    assert found.distance == pytest.approx(abs(np.linalg.norm(points, axis=1) - 0.5), abs=1e-12)
    assert found.point_b == pytest.approx(0.5 * points / np.linalg.norm(points, axis=1)[:, None], abs=1e-9)
    mesh = {"type": "triangle_mesh", "vertices": np.eye(3), "triangles": np.array([[0, 1, 2]])}
    one = sg.closest_points(np.zeros(3), mesh)
    assert one.distance == pytest.approx([3**-0.5]) and one.feature_b.tolist() == ["interior"]
    pairs = sg.closest_points([{"type": "point", "p": [0, 0, k]} for k in range(3)], [mesh] * 3)
    assert pairs.distance.shape == (3,)


@pytest.mark.parametrize("points, words", [
    (np.zeros((4, 2)), "shape"), (np.full((2, 3), np.nan), "finite"), (["a"], "real numbers"), ([[0, 0], [1]], "array"),
    (np.zeros((2, 3), complex), "complex"), (np.array(3.0), "shape"),
])
def test_points_that_are_none_are_told(points, words):
    with pytest.raises(sg.CaseError, match=words):
        sg.closest_points(points, {"type": "point", "p": [0, 0, 0]})


def test_shapes_that_are_none_are_told():
    with pytest.raises(sg.CaseError) as caught:
        sg.closest_points([[0, 0, 0]], {"type": "segment", "p0": [0, 0, 0]})
    assert caught.value.path.startswith("b")
    with pytest.raises(sg.CaseError):
        sg.closest_points([[0, 0, 0]], {"type": "triangle_mesh", "vertices": np.eye(3), "triangles": [[0, 1, 7]]})
    with pytest.raises(ValueError):
        sg.closest_points(np.zeros((2, 3)), [{"type": "point", "p": [0, 0, 0]}] * 3)
    with pytest.raises(sg.CaseError):
        sg.closest_points([[0, 0, 0]], {"type": "point", "p": [0, 0, float("nan")]})
