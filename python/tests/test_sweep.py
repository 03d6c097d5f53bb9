"""Sweeps: tables that depend neither on who runs the rows nor on interruptions."""

import concurrent.futures
import pathlib
import pickle

import numpy as np
import pytest
import signorini as sg

TENSION = "bodies.film.membrane.tension"
VARY = {TENSION: [0.5, 1.0, -1.0], "loads.press.normal": "-0.5:-1:2"}


def table(folder):
    return (folder / "sweep.csv").read_text(encoding="utf-8")


def test_the_rows_are_the_same_with_any_executor(tmp_path):
    problem = sg.gallery("string")
    rows = sg.sweep(problem, VARY, tmp_path / "one")
    assert [row["status"] for row in rows] == ["done"] * 4 + ["failed"] * 2
    assert rows[4]["reason"] == "input" and "tension" in rows[4]["message"]
    assert rows.columns[:3] == ["run", TENSION, "loads.press.normal"]
    # The exact length of contact is 2 (1 - sqrt(0.2 tension / load)).
    exact = [2 * (1 - np.sqrt(0.2 * row[TENSION] / -row["loads.press.normal"])) for row in rows[:4]]
    assert np.allclose([row["contacts.touch.area"] for row in rows[:4]], exact, atol=1e-9)
    for kind in (concurrent.futures.ThreadPoolExecutor, concurrent.futures.ProcessPoolExecutor):
        with kind(2) as executor:
            assert sg.sweep(problem, VARY, tmp_path / kind.__name__, executor=executor) == rows
        assert table(tmp_path / kind.__name__) == table(tmp_path / "one")


def test_an_interrupted_sweep_goes_on(tmp_path):
    problem = sg.gallery("string")

    class Broken(concurrent.futures.ThreadPoolExecutor):
        count = 0

        def submit(self, *arguments):
            self.count += 1
            if self.count > 3:
                raise OSError("the cluster is gone")
            return super().submit(*arguments)

    with Broken(1) as executor, pytest.raises(OSError, match="gone"):
        sg.sweep(problem, VARY, tmp_path / "parts", executor=executor)
    ended = list((tmp_path / "parts" / "runs").glob("*.json"))
    assert 1 <= len(ended) <= 3
    kept = ended[0].stat().st_mtime_ns
    rows = sg.sweep(problem, VARY, tmp_path / "parts")
    assert ended[0].stat().st_mtime_ns == kept
    assert rows == sg.sweep(problem, VARY, tmp_path / "whole")
    with pytest.raises(sg.CaseError, match="other variations"):
        sg.sweep(problem, {TENSION: [1.0]}, tmp_path / "parts")
    assert len(sg.sweep(problem, {TENSION: [1.0]}, tmp_path / "parts", restart=True)) == 1


def test_samples_and_columns(tmp_path):
    rows = sg.sweep(
        sg.gallery("string"), {TENSION: "0.5:1", "loads.press.normal": "-1:-0.5"}, tmp_path / "out",
        sample=5, seed=3, collect=["contacts.touch.area", "energy"],
    )  # fmt: skip
    assert rows.columns[7:] == ["contacts.touch.area", "energy", "message"]
    again = pickle.loads(pickle.dumps(rows))
    assert again == rows and again.columns == rows.columns
    strata = sorted(int((row[TENSION] - 0.5) / 0.1) for row in rows)
    assert strata == [0, 1, 2, 3, 4]
    pandas = pytest.importorskip("pandas")
    frame = rows.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame.columns) == rows.columns


def test_arrays_belong_to_the_case(tmp_path):
    def problem(depth):
        return sg.Problem(
            space="plane",
            bodies={
                "film": sg.Membrane(domain=sg.Disc(radius=1.0), mesh=sg.GridMesh(cells=[8, 8]), degree=3, tension=1.0),
                "floor": sg.Rigid(shape=sg.HeightMap(file=np.full((9, 9), -depth), spacing=[0.5, 0.5], origin=[-2, -2])),
            },
            supports={"rim": sg.Support(on="film:boundary", displacement=0.0)},
            loads={"press": sg.Load(on="film", normal=-1.0)},
            contacts={"touch": sg.Contact(between=["film", "floor"])},
        )

    vary = {"loads.press.normal": np.array([-1.0, -0.8])}
    rows = sg.sweep(problem(0.1), vary, tmp_path / "out")
    assert [row["status"] for row in rows] == ["done", "done"], rows[0]["message"]
    assert sg.sweep(problem(0.1), vary, tmp_path / "out") == rows
    with pytest.raises(sg.CaseError, match="another case"):
        sg.sweep(problem(0.12), vary, tmp_path / "out")


@pytest.mark.parametrize(
    "vary, message",
    [
        ({"loads.pres.normal": [1.0]}, "no load `pres`"),
        ({TENSION: []}, "no values"),
        ({TENSION: "1:2:0"}, "no number of values"),
        ({TENSION: [1.0, float("nan")]}, "finite"),
        ({}, "nothing is varied"),
    ],
)
def test_wrong_variations_are_errors_before_anything_runs(vary, message, tmp_path):
    with pytest.raises(sg.CaseError, match=message):
        sg.sweep(sg.gallery("string"), vary, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_with_dask(tmp_path):
    distributed = pytest.importorskip("distributed")
    with distributed.Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:
        rows = sg.sweep(sg.gallery("string"), VARY, pathlib.Path(tmp_path) / "out", executor=client)
    assert [row["status"] for row in rows] == ["done"] * 4 + ["failed"] * 2
