"""The same digits as the command, and from Python as from the file."""

import json
import os
import pathlib
import subprocess

import pytest
import signorini as sg

ROOT = pathlib.Path(__file__).parents[2]
CASES = ["string", "flat_disc", "crossing", "hertz_cells", "geodesic"]


def told(result):
    """The summary but for what differs between two runs, as text."""
    summary = json.loads(json.dumps(result.summary, default=lambda array: array.tolist()))
    return {k: v for k, v in summary.items() if k not in ("environment", "interpreted", "first_picture", "case")}


@pytest.mark.parametrize("name", CASES)
def test_the_same_digits_from_tables_as_from_the_file(name):
    problem = sg.Problem.from_toml(ROOT / "gallery" / name / "case.toml")
    stated = problem.replace(title=f"{problem.title} again")
    a, b = (sg.run(p, pictures=False) for p in (problem, stated))
    assert told(a) == told(b)


@pytest.mark.parametrize("name", CASES)
def test_the_same_digits_as_the_command(name, tmp_path):
    program = os.environ.get("SIGNORINI")
    if program is None:
        pytest.skip("set SIGNORINI to the path of the command, built from the same sources")
    case = ROOT / "gallery" / name / "case.toml"
    subprocess.run([program, "run", str(case), "-o", str(tmp_path / "out")], check=True, capture_output=True)
    summary = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))
    theirs = sg.Record(summary)
    ours = sg.run(case, pictures=False)
    assert json.dumps(told(ours)) == json.dumps(told(type("Command", (), {"summary": theirs})))
