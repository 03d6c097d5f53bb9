"""What is done with problems: run, check, fit, paths on bodies, closest points."""

from __future__ import annotations

import json
import os
import sys
from functools import cached_property
from typing import Any, Callable, Iterable, List, Mapping, Optional, Type, Union

import numpy as np

from . import _native
from ._base import Noun
from ._errors import CaseError
from ._nouns import Rigid, RopeOnSurface, ShortestPath, Winding
from ._problem import Problem, _text_of, stated
from ._result import Picture, Record, Result

Folder = Optional[Union[str, "os.PathLike[str]"]]


def run(
    problem: Union[Problem, str, "os.PathLike[str]"],
    folder: Folder = None,
    *,
    progress: Union[bool, Callable[..., Any], None] = None,
    pictures: Optional[bool] = None,
) -> Result:
    """Runs a problem.

    problem: A problem, or the path of a case file.
    folder: Where all files of the run are written as the command does; in memory if left out.
    progress: True shows a bar of tqdm, False nothing; if left out, a bar after two seconds where tqdm is installed. A
        callable is called with a :class:`signorini.Event` for each increment and iteration; what it raises ends the run.
    pictures: Whether pictures are drawn; `output.pictures` of the problem if left out.

    A run that does not converge is no exception: `converged`, `reason` and `verdict` tell of it, and the increments before
    are there. Ctrl-C ends the run after the current iteration; `interrupted` is true then.

    Raises CaseError with the path of the key for what is wrong with the problem, OutputError for a folder that cannot be
    written.

    >>> import signorini as sg
    >>> result = sg.run(sg.gallery("string"), pictures=False)
    >>> result.converged, float(result.contacts["touch"].force[2].round(6))
    (True, 1.105573)
    """
    if not isinstance(problem, Problem):
        problem = Problem.from_toml(problem)
    name, how, settings, files = stated(problem)
    if pictures is not None:
        how, settings = _with_pictures(how, settings, bool(pictures))
    with _bar(progress) as told:
        found = _native.solve(name, how, settings, files, _folder(folder), told)
    return Result(found, None if folder is None else os.fspath(folder))


def _with_pictures(how: Any, settings: list, pictures: bool) -> "tuple[Any, list]":
    """What is stated, with `output.pictures`."""
    if isinstance(how, str):
        return how, [*settings, f"output.pictures={str(pictures).lower()}"]
    output = how.get("output", {})
    # What is no table is told by the reader.
    return {**how, "output": {**output, "pictures": pictures} if isinstance(output, dict) else output}, settings


def check(problem: Union[Problem, str, "os.PathLike[str]"]) -> Record:
    """Checks a problem without running it; tells its size.

    Raises CaseError with the path of the key for what is wrong.

    >>> import signorini as sg
    >>> sg.check(sg.gallery("flat_disc")).cells
    400
    """
    if not isinstance(problem, Problem):
        problem = Problem.from_toml(problem)
    return Record(json.loads(_native.check(*stated(problem), False)[0]))


class Fitted(Record):
    """The result of :func:`fit`: the content of `summary.json`.

    table: The columns of `fit.csv`: time, measured, fitted and residual.
    """


def fit(problem: Problem, folder: Folder = None) -> Fitted:
    """Computes the adhesion energy, and if wanted the tension, from measurements (`problem.fit`).

    `Fit(data=…)` takes the path of a CSV file, or a dictionary of columns.

    Raises CaseError with the path of the key.
    """
    from ._result import columns

    summary, files = _native.fit(*stated(problem), _folder(folder))
    made = Fitted(json.loads(summary))
    table = files.get("fit.csv")
    if table is None and folder is not None:
        with open(os.path.join(os.fspath(folder), "fit.csv"), "rb") as file:
            table = file.read()
    made.__dict__["table"] = columns(table or b"")
    made.__dict__["picture"] = Picture("fit.png", files["pictures/fit.png"]) if "pictures/fit.png" in files else None
    return made


def scene(source: Union[str, "os.PathLike[str]"], folder: Folder = None, *, set: Iterable[str] = ()) -> Result:
    """Runs a scene of moving rigid bodies (`analysis = "closest_pairs"`) from a case file or its text.

    Raises CaseError with line and column.
    """
    name, text = _text_of(source)
    summary, files = _native.run_scene(name, text, [str(s) for s in set], _folder(folder))
    found = {"summary": summary, "states": [], "files": files}
    return Result(found, None if folder is None else os.fspath(folder))


def wrap(
    from_: Any,
    to: Any,
    around: Mapping[str, Any],
    *,
    frames: int = 1,
    folder: Folder = None,
    pictures: Optional[bool] = None,
    **options: Any,
) -> Result:
    """The shortest path from a point to another over rigid bodies.

    from_, to: Points; expressions of t in [0, 1] where they move.
    around: The bodies, by name, in the order of the path: shapes or :class:`Rigid`.
    frames: Number of times in [0, 1].
    options: Further keys of :class:`ShortestPath`, such as ``friction``, ``tension``, ``via``; and of the problem, such
        as ``units``, ``constants``.

    ``result.paths[0].frames[0].length`` is the length, ``result.lines`` are the points.

    >>> import signorini as sg
    >>> result = sg.wrap([-2, 0, 0.5], [2, 0, 0.5], {"drum": sg.Cylinder(point=[0, 0, 0], axis=[0, 1, 0], radius=1)})
    >>> round(result.paths[0].frames[0].length, 6)
    4.128483
    """
    own, rest = _split(ShortestPath, options)
    path = ShortestPath(from_=from_, to=to, around=list(around), **own)
    problem = Problem(
        analysis="wrapping", bodies=_rigid(around), paths={"path": path}, frames=frames, **rest
    )
    return run(problem, folder, pictures=pictures)


def wind(
    mandrel: Any, start: Any, *, folder: Folder = None, pictures: Optional[bool] = None, **options: Any
) -> Result:
    """The path of a yarn on a mandrel.

    mandrel: A shape, or :class:`Rigid`.
    start: :class:`WindingStart`.
    options: Further keys of :class:`Winding`, such as ``slippage``, ``friction``, ``polar_opening``, ``band``,
        ``length``, ``pattern``; and of the problem, such as ``units``.

    ``result.winding[0]`` has the results, ``result.lines`` the points.
    """
    own, rest = _split(Winding, options)
    yarn = Winding(on="mandrel", start=start, **own)
    problem = Problem(analysis="winding", bodies=_rigid({"mandrel": mandrel}), winding={"yarn": yarn}, **rest)
    return run(problem, folder, pictures=pictures)


def theorem(
    body: Any, path: Any, *, folder: Folder = None, pictures: Optional[bool] = None, **options: Any
) -> Result:
    """A rope with friction on a given curve on a surface: the admissible tensions after Euler and Eytelwein, with friction
    along and across the rope.

    body: A shape, or :class:`Rigid`.
    path: The curve, as of a :class:`Rope`.
    options: Further keys of :class:`RopeOnSurface` (``friction``, ``tension``, ``end_tension``) and of the problem.

    ``result.ropes[0].tension_limits`` are the least and the largest tension at the end.

    >>> import numpy as np, signorini as sg
    >>> result = sg.theorem(
    ...     sg.Cylinder(point=[0, 0, 0], axis=[0, 0, 1], radius=0.1),
    ...     sg.HelixPath(radius=0.1, pitch=0.0, turns=0.5),
    ...     friction=sg.CoulombFriction(mu=0.3),
    ...     tension=100.0,
    ... )
    >>> bool(np.isclose(result.ropes[0].tension_limits[1], 100 * np.exp(0.3 * np.pi)))
    True
    """
    own, rest = _split(RopeOnSurface, options)
    rope = RopeOnSurface(on="body", path=path, **own)
    problem = Problem(analysis="euler_eytelwein", bodies=_rigid({"body": body}), ropes={"rope": rope}, **rest)
    return run(problem, folder, pictures=pictures)


def _rigid(shapes: Mapping[str, Any]) -> dict:
    is_body = lambda shape: isinstance(shape, Noun) and shape._key == "rigid"
    return {name: shape if is_body(shape) else Rigid(shape=shape) for name, shape in shapes.items()}


def _split(noun: Type[Noun], options: dict) -> "tuple[dict, dict]":
    """The options that are keys of a noun, and the others."""
    own = {key: value for key, value in options.items() if key in noun._types}
    return own, {key: value for key, value in options.items() if key not in own}


class Closest:
    """Closest points of n pairs.

    distance, gap: Arrays of shape (n,). The gap is negative within a closed surface; nan where the second shape has no
        inside.
    point_a, point_b: The closest points, (n, 3).
    normal: Unit vectors from the second to the first point, (n, 3); nan where they coincide.
    parameters_a, parameters_b: Parameters of the shapes, (n, 2); nan for those that a shape does not have.
    feature_a, feature_b: ``point``, ``interior``, ``edge`` or ``vertex``, (n,).
    element_a, element_b: The triangles of meshes, or the smooth pieces of other shapes, (n,).
    uniqueness: ``unique``, ``multiple``, ``continuum`` or ``near-continuum``, (n,).
    certified, certified_to: Whether it is proved that nothing is closer, and up to which distance.
    lambda_min: Smallest eigenvalue of the Hessian of half the squared distance.
    others: For each pair a table with ``distance``, ``point_a`` and ``point_b`` of the further minimisers.
    """

    distance: np.ndarray
    gap: np.ndarray
    point_a: np.ndarray
    point_b: np.ndarray
    normal: np.ndarray
    parameters_a: np.ndarray
    parameters_b: np.ndarray
    feature_a: np.ndarray
    feature_b: np.ndarray
    element_a: np.ndarray
    element_b: np.ndarray
    uniqueness: np.ndarray
    certified: np.ndarray
    certified_to: np.ndarray
    lambda_min: np.ndarray

    def __init__(self, found: dict) -> None:
        real = lambda name: np.frombuffer(found[name], "<f8")
        whole = lambda name: np.frombuffer(found[name], "<i8")
        for name in ("distance", "gap", "lambda_min", "certified_to"):
            setattr(self, name, real(name))
        for name in ("point_a", "point_b", "normal"):
            setattr(self, name, real(name).reshape(-1, 3))
        for name in ("parameters_a", "parameters_b"):
            setattr(self, name, real(name).reshape(-1, 2))
        for name in ("element_a", "element_b"):
            setattr(self, name, whole(name))
        for name in ("feature_a", "feature_b", "uniqueness"):
            setattr(self, name, np.array(found[name]))
        self.certified = whole("certified").astype(bool)
        self._ends = np.concatenate([[0], np.cumsum(whole("others"))])
        self._further = [real("others_distance"), real("others_a").reshape(-1, 3), real("others_b").reshape(-1, 3)]

    @cached_property
    def others(self) -> List[Record]:
        """For each pair the further minimisers."""
        # Tables of pairs by the thousand take longer than the search: they are made where they are asked for.
        names = ("distance", "point_a", "point_b")
        tables = zip(self._ends, self._ends[1:])
        return [Record({name: values[a:b] for name, values in zip(names, self._further)}) for a, b in tables]

    def __len__(self) -> int:
        return len(self.distance)

    def __repr__(self) -> str:
        return f"<Closest points of {len(self)} pairs>"


def closest_points(a: Any, b: Any, *, local_minima: bool = False, folder: Union[str, "os.PathLike[str]"] = "") -> Closest:
    """Closest points of pairs of shapes, certified: of `a[k]` and `b[k]`; one that stands alone belongs to all.

    a, b: An array of points (n, 3) or (3,), a shape, or a list of shapes. A shape is a dictionary as in the queries of
        `signorini closest`, such as ``{"type": "torus", …}`` or ``{"type": "triangle_mesh", "vertices": array,
        "triangles": array}``.
    local_minima: Whether all local minima are listed in `others`.
    folder: Where files that shapes name are looked for.

    Raises CaseError with the path of the field.

    >>> import signorini as sg
    >>> found = sg.closest_points([[0, 0, 2], [5, 0, 0]], {"type": "segment", "p0": [1, 0, 0], "p1": [3, 0, 0]})
    >>> found.distance
    array([2.23606798, 2.        ])
    >>> found.feature_b.tolist()
    ['vertex', 'vertex']
    """
    found = _native.closest_points(_partner(a, "a"), _partner(b, "b"), os.fspath(folder), bool(local_minima))
    return Closest(found)


def _partner(shapes: Any, path: str) -> Any:
    """Points as bytes; shapes as texts of JSON."""
    if isinstance(shapes, Mapping):
        return [_shape(shapes, path)]
    if isinstance(shapes, (list, tuple)) and shapes and all(isinstance(shape, Mapping) for shape in shapes):
        return [_shape(shape, f"{path}[{k}]") for k, shape in enumerate(shapes)]
    from ._base import _numbers

    points = _numbers(_as_array(shapes, path), path).astype("<f8")
    if points.shape == (3,):
        points = points[None, :]
    if points.ndim != 2 or points.shape[1] != 3:
        raise CaseError(f"an array of the shape {points.shape}", path=path, help="points are an array of the shape (n, 3)")
    return points.tobytes()


def _as_array(value: Any, path: str) -> np.ndarray:
    try:
        return np.asarray(value)
    except ValueError as error:
        raise CaseError(f"no array of points: {error}", path=path) from error


def _shape(shape: Mapping, path: str) -> str:
    def plain(value: Any) -> Any:
        if isinstance(value, np.ndarray):
            return value.tolist()
        if isinstance(value, np.generic):
            return value.item()
        if isinstance(value, os.PathLike):
            return os.fspath(value)
        raise CaseError(f"a {type(value).__name__} is no part of a shape", path=path)

    try:
        return json.dumps(dict(shape), default=plain, allow_nan=False)
    except ValueError as error:
        raise CaseError(f"not a shape: {error}", path=path) from error


def gallery(name: Optional[str] = None) -> Any:
    """A problem of the gallery; without a name, the names and what each shows.

    >>> import signorini as sg
    >>> sg.gallery()["string"]
    'a string on a flat floor, compared with the exact solution'
    """
    cases = {case: (about, text) for case, about, text in _native.gallery()}
    if name is None:
        return {case: about for case, (about, _) in cases.items()}
    if name not in cases:
        raise KeyError(f"`{name}` is not in the gallery: {', '.join(cases)}")
    if _native.is_scene(cases[name][1]):
        raise ValueError(f"`{name}` is a scene: signorini.scene(text) runs it")
    problem = Problem.from_toml(cases[name][1])
    problem._name = f"{name}.toml"
    return problem


def explain(word: str) -> str:
    """What a key of the case file or a word of the results means.

    Raises CaseError for a word that is neither.

    >>> import signorini as sg
    >>> print(sg.explain("membrane.tension").splitlines()[0])
    bodies.NAME.membrane.tension (key: value, required)
    """
    return _native.explain(word)


def set_threads(count: int) -> None:
    """Sets the number of threads of this process, once and before the first run. Results do not depend on it."""
    if int(count) < 1:
        raise ValueError(f"{count} threads")
    _native.set_threads(int(count))


class Event:
    """What a run tells while it works.

    kind: ``step`` where an increment begins, ``iteration`` after an iteration.
    step: Index of the increment.
    count: Number of increments.
    time: Time at the end of the increment.
    iteration, residual, action: Of an iteration; the residual is relative to its tolerance.
    """

    def __init__(self, kind: str, step: int, count: int, time: float, iteration: int, residual: float, action: str) -> None:
        self.kind = kind
        self.step = step
        self.count = count
        self.time = time
        self.iteration = iteration
        self.residual = residual
        self.action = action

    def __repr__(self) -> str:
        figures = f"iteration={self.iteration}, residual={self.residual:.3g}"
        return f"Event({self.kind!r}, step={self.step}, time={self.time}, {figures})"


class _bar:
    """What a run calls: a bar of tqdm, the callable of the user, or nothing."""

    def __init__(self, progress: Union[bool, Callable[..., Any], None]) -> None:
        self.progress = progress
        self.bar: Any = None
        self.count = 0

    def __enter__(self) -> Optional[Callable[..., Any]]:
        if callable(self.progress):
            return self.call
        if self.progress is False or (self.progress is None and "tqdm" not in sys.modules and not _installed("tqdm")):
            return None
        if self.progress is None and not _is_watched():
            return None
        from ._errors import optional

        optional("tqdm")
        from tqdm.auto import tqdm

        self.bar = tqdm(total=1, unit="step", leave=False, delay=0 if self.progress else 2)
        return self.show

    def __exit__(self, *_: Any) -> None:
        if self.bar is not None:
            self.bar.close()

    def call(self, *event: Any) -> None:
        kind, step, count, *rest = event
        self.count = count or self.count
        self.progress(Event(kind, step, self.count, *rest))  # type: ignore[misc,operator]

    def show(self, kind: str, step: int, count: int, time: float, iteration: int, residual: float, action: str) -> None:
        if kind == "step":
            self.bar.total = count
            self.bar.update(step - self.bar.n)
        else:
            self.bar.set_postfix_str(f"t = {time:.4g}, iteration {iteration}, residual {residual:.1e}")


def _installed(name: str) -> bool:
    import importlib.util

    return importlib.util.find_spec(name) is not None


def _is_watched() -> bool:
    return "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())


def _folder(folder: Folder) -> Optional[str]:
    return None if folder is None else os.fspath(folder)
