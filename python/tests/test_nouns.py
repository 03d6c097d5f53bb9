"""The classes are generated from the schema; cases go in and out."""

import doctest
import importlib
import json
import pathlib
import pkgutil
import sys

import numpy as np
import pytest
import signorini as sg
from signorini import _native, _nouns

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parent))


def test_the_nouns_are_those_of_the_schema():
    from generate import generated

    installed = pathlib.Path(_nouns.__file__).read_text(encoding="utf-8")
    assert generated(json.loads(_native.schema())) == installed, "run  python generate.py --installed"


def test_every_noun_has_a_docstring_and_knows_its_keys():
    for name in _nouns.__all__:
        noun = getattr(sg, name)
        assert noun.__doc__ and getattr(_nouns, name) is noun
        assert set(noun._types) == set(noun.__init__.__annotations__) - {"return"}


@pytest.mark.parametrize("name", [name for name in sg.gallery() if name != "swords"])
def test_every_case_of_the_gallery_goes_in_and_out(name):
    problem = sg.gallery(name)
    again = sg.Problem.from_toml(problem.to_toml())
    assert again == problem and again.to_toml() == problem.to_toml()
    assert eval(repr(problem), vars(sg)) == problem  # noqa: S307


@pytest.mark.parametrize("name", [name for name in sg.gallery() if name != "swords"])
def test_every_case_of_the_gallery_is_python_code(name):
    problem, names = sg.gallery(name), {}
    exec(problem.to_python(), names)  # noqa: S102
    assert names["problem"] == problem and names["problem"].to_toml() == problem.to_toml()
    assert max(map(len, problem.to_python().splitlines())) <= 100 or "\"," in problem.to_python()


def test_arrays_functions_and_samples_are_code():
    heights = sg.Samples([[0.0, 1.0, 0.0, 0.0]] * 4, spacing=[0.5, 0.5])
    problem = sg.Problem(
        constants={"n": np.int64(3)},
        bodies={
            "rope": sg.Rope(path=np.arange(6.0).reshape(2, 3), stiffness=1),
            "floor": sg.Rigid(shape=sg.Height(heights)),
            "ball": sg.Rigid(shape=sg.Sphere(center=np.zeros(3, ">f4"), radius=1)),
        },
        loads={"pull": sg.Load(on="rope", force=[0, 'say "no"', lambda t: -t])},
    )
    text, names = problem.to_python(), {}
    exec(text, names)  # noqa: S102
    assert names["problem"].to_toml() == problem.to_toml() and "np.array([[0.0, 1.0, 2.0]" in text
    with pytest.raises(sg.CaseError, match="as code") as caught:
        sg.Problem(bodies={}, loads={"pull": sg.Load(on="rope", force=object())}).to_python()
    assert caught.value.path == "loads.pull.force"


def test_the_cases_are_of_toml_1_0():
    tomllib = pytest.importorskip("tomllib")
    root = HERE.parents[1]
    cases = {path: path.read_text(encoding="utf-8") for path in (root / "gallery").glob("*/case.toml")}
    for page in [root / "README.md", *(root / "docs").rglob("*.md")]:
        blocks = page.read_text(encoding="utf-8").split("```toml\n")[1:]
        cases.update({f"{page}, block {k}": block.split("\n```")[0] for k, block in enumerate(blocks)})
    for name in sg.gallery():
        cases[f"signorini gallery show {name}"] = sg.gallery(name).to_toml() if name != "swords" else ""
    assert len(cases) > 100
    for name, text in cases.items():
        try:
            tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            pytest.fail(f"{name}: {error}")


def test_arrays_in_place_of_files_are_written_beside_the_case(tmp_path):
    import problems

    problem = problems.image()
    with pytest.raises(sg.CaseError, match="folder"):
        problem.to_toml()
    problem.to_toml(tmp_path / "case.toml")
    again = sg.run(tmp_path / "case.toml", pictures=False)
    assert (again.contacts.touch.force == sg.run(problem, pictures=False).contacts.touch.force).all()


def test_settings_replace_keys():
    text = sg.gallery("flat_disc").to_toml()
    problem = sg.Problem.from_toml(text, set=["loads.press.normal=-0.5"])
    assert problem.loads["press"].normal == -0.5


def test_a_copy_has_other_keys():
    load = sg.Load(on="film", normal=1)
    assert load.replace(normal=2) == sg.Load(on="film", normal=2) and load.normal == 1
    assert load != sg.Load(on="film") and load != 1
    with pytest.raises(AttributeError):
        load.replace(norm=1)


@pytest.mark.parametrize("name", ["", *(m.name for m in pkgutil.iter_modules(sg.__path__) if m.name != "_native")])
def test_the_examples_of_the_docstrings_hold(name):
    module = importlib.import_module(f"signorini.{name}".rstrip("."))
    assert doctest.testmod(module, optionflags=doctest.NORMALIZE_WHITESPACE).failed == 0


def test_the_example_of_the_manual_holds(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (HERE.parent / "README.md").read_text(encoding="utf-8")
    code = text.split("```python\n")[1].split("```")[0]
    names: dict = {}
    exec(code, names)  # noqa: S102
    assert names["result"].contacts["touch"].area == pytest.approx(0.7931908, rel=1e-5)
    assert (tmp_path / "film.png").is_file()
