"""What is wrong is an exception with the path of the key; never a panic."""

import copy
import pickle
import sys

import numpy as np
import problems
import pytest
import signorini as sg


def caught(problem):
    with pytest.raises(sg.CaseError) as error:
        sg.run(problem)
    return error.value


def with_mesh(**changes):
    mesh = problems.mesh()
    for name, value in changes.items():
        setattr(mesh, name, value)
    return problems.block(mesh)


POINTS, CELLS = problems.grid()
QUADS = lambda nodes: [sg.CellArrays(shape="quadrilateral", nodes=nodes)]


@pytest.mark.parametrize("problem, path, words", [
    (with_mesh(points=np.zeros((25, 3))), "mesh.arrays", "coordinates"),
    (with_mesh(points=np.zeros(25)), "mesh.arrays.points", "list"),
    (with_mesh(points=np.zeros((5, 5, 2))), "mesh.arrays.points", "number"),
    (with_mesh(points=np.where(POINTS == 0.5, np.nan, POINTS)), "mesh.arrays.points", "finite"),
    (with_mesh(points=np.where(POINTS == 0.5, np.inf, POINTS).tolist()), "mesh.arrays", "finite"),
    (with_mesh(points=POINTS.astype(complex)), "mesh.arrays.points", "complex"),
    (with_mesh(points=np.full((3, 2), "a")), "mesh.arrays.points", "number"),
    (with_mesh(points=np.zeros((0, 2))), "mesh.arrays", ""),
    (with_mesh(cells=QUADS(CELLS + 3)), "mesh.arrays", ""),
    (with_mesh(cells=QUADS(CELLS - 1)), "mesh.arrays.cells[0].nodes", "-1"),
    (with_mesh(cells=QUADS(CELLS.astype(float))), "mesh.arrays.cells[0].nodes", "whole"),
    (with_mesh(cells=QUADS(CELLS[:, :3])), "mesh.arrays", ""),
    (with_mesh(cells=QUADS(np.array([[2**40] * 4]))), "mesh.arrays.cells[0].nodes", ""),
    (with_mesh(cells=QUADS(np.array([[2**63] * 4], np.uint64))), "mesh.arrays.cells[0].nodes", "64"),
    (with_mesh(cells=[sg.CellArrays(shape="pentagon", nodes=CELLS)]), "mesh.arrays", "pentagon"),
    (with_mesh(groups={"upper": [99], "lower": [0]}), "mesh.arrays.groups.upper", "99"),
    (problems.image(np.full((8, 8), np.nan)), "geometry.image.file", "finite"),
    (problems.image(np.ones(8)), "geometry.image", ""),
    (problems.image(np.ones((8, 8), complex)), "geometry.image.file", "complex"),
    (problems.membrane(loads={"press": sg.Load(on="film", normal=float("nan"))}), "loads.press.normal", "finite"),
    (problems.membrane(loads={"press": sg.Load(on="film", normal=[1, 2])}), "loads.press.normal", "list"),
    (problems.membrane(loads={"press": sg.Load(on="film", normal=object())}), "loads.press.normal", "object"),
    (problems.membrane(loads={"press": sg.Load(on="film", normal="-1 +")}), "loads.press.normal", "expression"),
    (problems.membrane(loads={"press": sg.Load(on="flim", normal=-1)}), "loads.press.on", "flim"),
    (problems.membrane(loads={"press": {"on": "film", "nromal": -1}}), "loads.press.nromal", "unknown key"),
    (problems.membrane(loads={"press": {"normal": -1}}), "loads.press", "missing key `on`"),
    (problems.membrane(loads={3: sg.Load(on="film")}), "loads", "no text"),
    (problems.membrane(space="plain"), "space", "plain"),
    (problems.membrane(bodies={"film": sg.Sphere(center=[0, 0, 0], radius=1)}), "bodies.film", "Sphere"),
    (problems.membrane(bodies={"film": {"membran": {}}}), "bodies.film.membran", "unknown"),
    (problems.membrane(bodies={"film": 3}), "bodies.film", "choice"),
    (problems.membrane(bodies=None), None, "bodies"),
    (problems.membrane(steps=[sg.Step(to=1, increments=0.5)]), "steps[0].increments", "whole"),
    (problems.membrane(steps=[sg.Step(to=1, increments=True)]), "steps[0].increments", "whole"),
    (problems.membrane(steps=sg.Step(to=1)), "steps", "list"),
    (problems.membrane(steps=[sg.Step(to=1, increments=2**70)]), "steps[0].increments", ""),
    (problems.membrane(bodies={"film": problems.membrane().bodies["film"], "floor": sg.Rigid(shape=sg.Samples(np.zeros((2, 2))))}),
     "bodies.floor.rigid.shape.height", ""),
    (problems.membrane(bodies={"film": problems.membrane().bodies["film"], "floor": sg.Rigid(shape=sg.Stl(file="none.stl"))}),
     "bodies.floor.rigid.shape.stl.file", "none.stl"),
])
def test_wrong_input_is_told_with_its_key(problem, path, words):
    error = caught(problem)
    assert words in str(error), str(error)
    if path is None:
        assert error.path is None
    else:
        assert error.path is not None and path in error.path, f"{error.path}: {error}"


def test_an_error_of_a_file_has_its_line(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(problems.membrane().to_toml().replace('normal = -1', 'normal = "-p"'))
    with pytest.raises(sg.CaseError) as error:
        sg.run(case)
    assert error.value.path == "loads.press.normal" and error.value.line == case.read_text().splitlines().index('normal = "-p"') + 1
    assert error.value.value and str(case) in str(error.value)
    for wrong, path in (('nromal = -1', "loads.press.nromal"), ("normal = true", "loads.press.normal")):
        case.write_text(problems.membrane().to_toml().replace("normal = -1", wrong))
        with pytest.raises(sg.CaseError) as error:
            sg.Problem.from_toml(case)
        assert error.value.path == path and error.value.line
    for wrong, path in (('shape.hieght', "bodies.floor.rigid.shape.hieght"), ("shape", "bodies.floor.rigid.shape")):
        case.write_text(problems.membrane().to_toml().replace("shape.height", wrong))
        with pytest.raises(sg.CaseError) as error:
            sg.Problem.from_toml(case)
        assert error.value.path == path and error.value.line
    case.write_text("space = 'plane\n")
    with pytest.raises(sg.CaseError) as error:
        sg.Problem.from_toml(case)
    assert error.value.line == 1
    case.write_bytes(b"\xff\xfe")
    with pytest.raises(sg.CaseError):
        sg.Problem.from_toml(case)
    with pytest.raises(OSError):
        sg.Problem.from_toml(tmp_path / "none.toml")
    with pytest.raises(TypeError):
        sg.run(3)


def test_errors_are_pickled_and_copied():
    error = caught(problems.membrane(space="plain"))
    again = pickle.loads(pickle.dumps(error))
    assert (again.path, again.help, str(again)) == (error.path, error.help, str(error))
    assert copy.copy(error).path == error.path


def test_a_mistyped_key_is_told():
    with pytest.raises(TypeError, match="nromal"):
        sg.Load(on="film", nromal=1)
    load = sg.Load(on="film")
    with pytest.raises(AttributeError, match="did you mean `normal`"):
        load.nromal = 1
    with pytest.raises(AttributeError, match="there are"):
        sg.run(sg.gallery("string"), pictures=False).contcats
    with pytest.raises(KeyError, match="string"):
        sg.gallery("none")


def test_a_missing_package_is_named(monkeypatch):
    result = sg.run(problems.block(), pictures=False)
    for name, method in (("pyvista", result.to_pyvista), ("meshio", result.to_meshio)):
        monkeypatch.setitem(sys.modules, name, None)
        with pytest.raises(sg.MissingPackage, match=f"pip install {name}"):
            method()
    monkeypatch.setitem(sys.modules, "tqdm", None)
    with pytest.raises(sg.MissingPackage, match="pip install tqdm"):
        sg.run(sg.gallery("string"), progress=True)


def test_a_panic_is_an_exception(capfd):
    from signorini import _native

    with pytest.raises(sg.InternalError, match="asked for"):
        _native.panic()
    assert issubclass(sg.InternalError, Exception)


def test_a_foreign_folder_is_refused(tmp_path):
    (tmp_path / "thesis.tex").write_text("")
    with pytest.raises(sg.OutputError, match="thesis"):
        sg.run(sg.gallery("string"), tmp_path)


def test_a_run_without_a_result_is_no_exception():
    problem = sg.gallery("hertz").replace(limits=sg.Limits(max_iterations=1))
    result = sg.run(problem, pictures=False)
    assert not result.converged and result.reason == "limit_reached"
