"""Sweeps: a problem run many times with other values of some of its keys."""

from __future__ import annotations

import hashlib
import json
import os
import pathlib
from typing import Any, Dict, Iterable, List, Mapping, Optional, Sequence, Union

from . import _native
from ._base import Tree
from ._errors import CaseError, optional
from ._problem import Problem
from ._toml import _value as literal
from ._toml import written

Values = Union[str, Sequence[Any], Any]


class Rows(List[Dict[str, Any]]):
    """The table of a sweep: a dictionary for each run.

    The names of columns are the varied keys, ``run``, ``status`` (``done``, ``failed`` or ``missing``), ``reason``, ``time``,
    ``iterations``, what was collected from the summaries by its path, such as ``contacts.touch.force.z``, and ``message``.

    columns: The names in their order.
    units: The units of columns that have one, by their names.
    folder: The folder of the sweep; `sweep.csv` and `sweep.png` are there, and each run in `runs`.
    """

    columns: List[str]
    units: Dict[str, str]
    folder: str

    def __init__(self, table: Mapping[str, Any], folder: str) -> None:
        super().__init__({name: row.get(name) for name in table["columns"]} for row in table["rows"])
        self.columns = list(table["columns"])
        self.units = dict(table["units"])
        self.folder = folder

    def to_pandas(self) -> Any:
        """The table as a pandas.DataFrame.

        Raises MissingPackage without pandas.
        """
        return optional("pandas").DataFrame(list(self), columns=self.columns)


def sweep(
    problem: Union[Problem, str, "os.PathLike[str]"],
    vary: Mapping[str, Values],
    output: Union[str, "os.PathLike[str]"],
    *,
    executor: Any = None,
    sample: Optional[int] = None,
    seed: int = 0,
    collect: Iterable[str] = (),
    keep: str = "summary",
    restart: bool = False,
) -> Rows:
    """Runs a problem with many values of some of its keys.

    problem: A problem, or the path of a case file.
    vary: Values by key. Values are a list or an array, or a text as of the command: ``"0.1:0.5:5"`` from 0.1 to 0.5 in 5
        values, ``"1:1000:4:log"`` in equal factors. Several keys make a grid.
    output: The folder of the sweep. A sweep that was interrupted or killed goes on there when it is called again.
    executor: What runs the rows: an executor of `concurrent.futures`, a client of Dask, or anything with ``submit``. Its
        workers need the folder under the same path. If left out, one row after the other is run here.
    sample, seed: Number of runs of a Latin hypercube over the ranges in place of the grid, and its seed. Ranges of a sample
        need no number of values: ``"0.1:0.5"``.
    collect: What the table collects from the summaries, by paths such as ``"contacts.touch.area"``; the main numbers if left
        out.
    keep: What stays of each run: ``"summary"``, or ``"all"`` its files.
    restart: Whether results of an earlier sweep in the folder are removed.

    Runs that fail are rows with their status and reason.

    Raises CaseError for a key or a value that the case cannot have, before anything runs, and for a folder with another
    sweep; OutputError for a folder that cannot be written.

    >>> import signorini as sg, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     rows = sg.sweep(sg.gallery("string"), {"loads.press.normal": [-0.5, -1.0]}, folder)
    >>> [round(row["contacts.touch.area"], 6) for row in rows]
    [0.735089, 1.105573]
    """
    folder = os.path.abspath(os.fspath(output))
    if keep not in ("all", "summary"):
        raise ValueError(f'keep is "all" or "summary", not {keep!r}')
    if isinstance(collect, str):
        collect = [collect]
    if not isinstance(problem, Problem):
        problem = Problem.from_toml(problem)
    case, files = _case(problem, folder)
    stated = [(str(key), *_values(str(key), values)) for key, values in vary.items()]
    size = None if sample is None else (int(sample), int(seed))
    choices = (keep == "all", bool(restart))
    resumed = _native.sweep_begin(case, stated, size, folder, [str(path) for path in collect], choices)
    if files and not resumed:
        beside = pathlib.Path(folder) / "case"
        beside.mkdir(exist_ok=True)
        for name, content in files.items():
            (beside / name).write_bytes(content)
    _run(folder, _native.sweep_missing(folder), executor)
    return Rows(json.loads(_native.sweep_gather(folder)), folder)


def _run(folder: str, missing: List[int], executor: Any) -> None:
    """Runs rows here, or by an executor."""
    if executor is None:
        for index in missing:
            if _row(folder, index) is None:
                raise KeyboardInterrupt
        return
    futures: List[Any] = []
    try:
        for index in missing:
            futures.append(executor.submit(_row, folder, index))
        for future in futures:
            future.result()
    except BaseException:
        for future in futures:
            future.cancel()
        raise


def _row(folder: str, index: int) -> Optional[str]:
    """Runs one row: what a worker does."""
    return _native.sweep_row(folder, index)


def _case(problem: Problem, folder: str) -> "tuple[tuple[str, str, list[str]], dict[str, bytes]]":
    """Name, text and settings of a problem, and the files that arrays stand for."""
    tree = Tree()
    table = tree.table(problem, "")
    if problem._read and problem._read[2] == table:
        text, settings, _ = problem._read
        return (os.path.abspath(problem._name or "case.toml"), text, settings), {}
    # Arrays with other content are another case.
    marks = [f"# {name}: {hashlib.sha256(content).hexdigest()}\n" for name, content in tree.files.items()]
    name = os.path.join(folder, "case", "case.toml") if tree.files else os.path.abspath(problem._name or "case.toml")
    return (name, written(table) + "".join(marks), []), tree.files


def _values(key: str, values: Values) -> "tuple[Optional[str], list[str]]":
    """A text as of the command, or values one by one."""
    if isinstance(values, str):
        return values, []
    if hasattr(values, "tolist"):
        values = values.tolist()
    if not hasattr(values, "__iter__"):
        values = [values]
    found = [_value(key, value) for value in values]
    if not found:
        raise CaseError("there are no values", path=key, help='give a list such as [0.1, 0.2], or a text such as "0.1:0.5:5"')
    return None, found


def _value(key: str, value: Any) -> str:
    """A value as it is written in a case file; a text as it is."""
    plain = Tree().plain(value, "any", key)
    if isinstance(plain, str):
        return plain
    if isinstance(plain, float) and plain - plain != 0.0:
        raise CaseError(f"{plain} is not a finite number", path=key)
    return literal(plain)
