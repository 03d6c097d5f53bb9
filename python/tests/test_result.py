"""Results: pickled, in threads, interrupted, in other packages."""

import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import problems
import pytest
import signorini as sg


@pytest.fixture(scope="module")
def block():
    return sg.run(problems.block(output=sg.Output(probes={"corner": [0, 1]})))


def test_results_and_problems_are_pickled(block):
    again = pickle.loads(pickle.dumps(block))
    assert np.array_equal(again.contacts["touch"].force, block.contacts.touch.force)
    assert np.array_equal(again.bodies.block.von_mises, block.bodies["block"]["von_mises"])
    assert again.contacts.touch.fields.name == "touch" and again.picture().data == block.picture().data
    problem = problems.block()
    assert pickle.loads(pickle.dumps(problem)) == problem


def test_files_and_pictures_are_there(block, tmp_path):
    assert set(block.histories) and len(block.histories.time) >= 2
    assert block.probes["corner"].displacement[1] == pytest.approx(-0.01)
    picture = block.picture()
    assert picture.data.startswith(b"\x89PNG")
    picture.save(tmp_path / "block.png")
    with pytest.raises(ValueError):
        picture.save(tmp_path / "block.svg")
    assert "image/png" in picture._repr_mimebundle_()
    page = block._repr_html_()
    assert "data:image/png;base64," in page and "touch" in page
    assert problems.block().preview().data.startswith(b"<svg")
    assert "block" in problems.block()._repr_html_()


def test_a_run_in_a_folder_has_the_same_results(block, tmp_path):
    there = sg.run(problems.block(output=sg.Output(probes={"corner": [0, 1]})), tmp_path / "out")
    assert np.array_equal(there.contacts.touch.force, block.contacts.touch.force)
    assert (tmp_path / "out" / "summary.json").is_file() and (tmp_path / "out" / "fields.pvd").is_file()
    assert set(there.pictures) == set(block.pictures) and there.histories.time.tolist() == block.histories.time.tolist()
    assert len(there.states) == len(block.states)
    again = sg.Problem.from_toml(tmp_path / "out" / "case.toml")
    assert np.array_equal(sg.run(again, pictures=False).contacts.touch.force, block.contacts.touch.force)


def test_runs_in_threads_are_the_same():
    wanted = sg.run(problems.membrane(), pictures=False).contacts.touch.area
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda _: sg.run(problems.membrane(), pictures=False).contacts.touch.area, range(8)))
    assert found == [wanted] * 8


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no forks")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_forked_processes_run_after_their_parent(block):
    with multiprocessing.get_context("fork").Pool(2) as pool:
        found = pool.map_async(_force, range(3)).get(timeout=60)
    assert all(np.array_equal(force, block.contacts.touch.force) for force in found)


def _force(_):
    return sg.run(problems.block(), pictures=False).contacts.touch.force


def test_other_threads_go_on_during_a_run():
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.002)

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.monotonic()
    sg.run(sg.gallery("cosine_disc"), pictures=False)
    end = time.monotonic()
    done.set()
    thread.join()
    assert max(np.diff([begin, *ticks, end])) < max(0.5 * (end - begin), 0.2)


def test_progress_is_told_and_ends_a_run():
    events = []
    sg.run(problems.block(), pictures=False, progress=events.append)
    assert [e.step for e in events if e.kind == "step"] == [0, 1] and events[0].count == 2

    def stop(event):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        sg.run(problems.block(), pictures=False, progress=stop)

    def interrupt(event):
        if event.step == 1:
            raise KeyboardInterrupt

    result = sg.run(problems.block(), pictures=False, progress=interrupt)
    assert result.interrupted and not result.converged and result.steps[0].converged
    assert result.last is result.steps[0] and result.contacts.touch.force[1] > 0


def test_a_bar_is_shown():
    pytest.importorskip("tqdm")
    assert sg.run(problems.block(), pictures=False, progress=True).converged


SCRIPT = """
import signal
import signorini as sg
# A shell without job control starts processes in the background with this signal ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
problem = sg.gallery("cosine_disc")
problem.steps = [sg.Step(to=1, increments=100000)]
print("begins", flush=True)
result = sg.run(problem, pictures=False)
print(result.reason, len(result.steps), result.steps[0].converged, flush=True)
"""


@pytest.mark.skipif(os.name == "nt", reason="signals of another kind")
def test_an_interruption_keeps_what_is_there():
    process = subprocess.Popen([sys.executable, "-c", SCRIPT], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begins\n"
    time.sleep(4)
    process.send_signal(signal.SIGINT)
    told, _ = process.communicate(timeout=300)
    reason, count, first = told.split()
    assert reason == "interrupted" and int(count) > 0 and first == "True"


def test_fields_are_handed_on(block):
    meshio = pytest.importorskip("meshio")
    mesh = block.to_meshio("block")
    assert len(mesh.points) == len(block.bodies.block.points) and "von_mises" in mesh.point_data
    assert isinstance(mesh, meshio.Mesh) and set(block.to_meshio()) == set(block.bodies)
    points, cells = problems.grid()
    given = sg.from_meshio(meshio.Mesh(np.column_stack([points, 0 * points[:, 0]]), [("quad", cells)]), groups=problems.mesh().groups)
    assert np.array_equal(sg.run(problems.block(given), pictures=False).contacts.touch.force, block.contacts.touch.force)


def test_fields_are_handed_on_to_pyvista(block):
    pyvista = pytest.importorskip("pyvista")
    blocks = block.to_pyvista()
    body = blocks["block"]
    assert body.n_points == len(block.bodies.block.points) and body.n_cells == len(block.bodies.block.shapes)
    assert "contact touch" in blocks.keys()
    rope = sg.run(problems.rope(), pictures=False).to_pyvista()["belt"]
    assert rope.n_cells > 0
    points, cells = problems.grid()
    grid = pyvista.UnstructuredGrid({pyvista.CellType.QUAD: cells}, np.column_stack([points, 0 * points[:, 0]]))
    given = sg.from_pyvista(grid, groups=problems.mesh().groups)
    assert np.array_equal(sg.run(problems.block(given), pictures=False).contacts.touch.force, block.contacts.touch.force)


def test_a_scene_runs():
    from signorini import _native

    text = next(text for name, _, text in _native.gallery() if name == "swords")
    result = sg.scene(text)
    assert result.frames > 0 and "pairs.csv" in result.files
    with pytest.raises(ValueError, match="scene"):
        sg.gallery("swords")
