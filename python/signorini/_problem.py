"""Problems: made of nouns, or read from case files."""

from __future__ import annotations

import json
import os
import pathlib
from typing import Any, Iterable, Optional, Union

from . import _native, _nouns
from ._base import Noun, Tree, _left_out, split
from ._errors import CaseError
from ._nouns import ProblemKeys
from ._toml import written


class Problem(ProblemKeys):
    __doc__ = (ProblemKeys.__doc__ or "") + """
    Files that it names are looked for in the folder of the case file, or in the current one.

    >>> import signorini as sg
    >>> problem = sg.Problem(
    ...     space="plane",
    ...     bodies={
    ...         "film": sg.Membrane(domain=sg.Disc(radius=1.0), mesh=sg.GridMesh(cells=[8, 8]), degree=3, tension=1.0),
    ...         "floor": sg.Rigid(shape=sg.Height(-0.1)),
    ...     },
    ...     supports={"rim": sg.Support(on="film:boundary", displacement=0.0)},
    ...     loads={"press": sg.Load(on="film", normal=-1.0)},
    ...     contacts={"touch": sg.Contact(between=["film", "floor"])},
    ... )
    >>> print(problem.to_toml())
    space = "plane"
    <BLANKLINE>
    [bodies.film.membrane]
    mesh.grid = { cells = [8, 8] }
    tension = 1.0
    degree = 3
    domain.disc = { radius = 1.0 }
    <BLANKLINE>
    [bodies.floor.rigid]
    shape.height = -0.1
    <BLANKLINE>
    [supports.rim]
    on = "film:boundary"
    displacement = 0.0
    <BLANKLINE>
    [loads.press]
    on = "film"
    normal = -1.0
    <BLANKLINE>
    [contacts.touch]
    between = ["film", "floor"]
    <BLANKLINE>
    """
    _key = None
    #: What the case file is called in messages; files are looked for beside it.
    _name = ""
    #: The text it was read from, with settings, and what it stated.
    _read: "tuple[str, list, dict] | None" = None

    @classmethod
    def from_toml(cls, source: Union[str, os.PathLike], *, set: Iterable[str] = ()) -> "Problem":
        """Reads a case file, or its text.

        source: Path of the file; or its text, which has more than one line.
        set: Settings such as ``"loads.press.normal=-0.3"``, which replace or add keys.

        Raises CaseError with path, line and column, and OSError for a file that cannot be read.

        >>> import signorini as sg
        >>> problem = sg.gallery("flat_disc")
        >>> problem.bodies["film"].degree
        4
        >>> again = sg.Problem.from_toml(problem.to_toml())
        >>> again == problem
        True
        """
        name, text = _text_of(source)
        settings = [str(setting) for setting in set]
        made: Problem = _of_json(json.loads(_native.read(name, text, settings)), cls)
        made._name = name
        made._read = (text, settings, Tree().table(made, ""))
        return made

    def to_toml(self, path: Optional[Union[str, os.PathLike]] = None) -> str:
        """The problem as the text of a case file; with a path it is written there, with the files that arrays stand for.

        Raises CaseError for what no case file states, and OSError.
        """
        tree = Tree()
        text = written(tree.table(self, ""))
        if path is None:
            if tree.files:
                raise CaseError("arrays in place of files need a folder", help=f"to_toml(path) writes {', '.join(tree.files)}")
            return text
        target = pathlib.Path(path)
        target.write_text(text, encoding="utf-8")
        for name, content in tree.files.items():
            (target.parent / name).write_bytes(content)
        return text

    def to_python(self) -> str:
        """The problem as a Python program, in which it is called `problem`.

        Functions are written as the expressions that they compute, arrays as `np.array` with all of their numbers.

        >>> import signorini as sg
        >>> floor = sg.Rigid(shape=sg.Height(lambda x: 2 - x))
        >>> print(sg.Problem(space="line", bodies={"floor": floor}).to_python())
        import signorini as sg
        <BLANKLINE>
        problem = sg.Problem(space="line", bodies={"floor": sg.Rigid(shape=sg.Height("(2 - x)"))})
        <BLANKLINE>
        """
        from ._code import code

        return code(self)

    def check(self) -> dict:
        """See :func:`signorini.check`."""
        from ._run import check

        return check(self)

    def run(self, **options: Any) -> Any:
        """See :func:`signorini.run`."""
        from ._run import run

        return run(self, **options)

    def preview(self) -> Any:
        """A picture of the problem before anything happens in it; None where there is nothing to draw."""
        from ._result import Picture

        drawn = _native.check(*stated(self), True)[1]
        return drawn and Picture("preview.svg", drawn.encode())

    def _repr_html_(self) -> str:
        import html

        return f"<pre>{html.escape(self.to_toml())}</pre>"


def stated(problem: Problem) -> "tuple[str, Any, list[str], dict[str, bytes]]":
    """What the native part takes: name, text or tables, settings, files."""
    if not isinstance(problem, Problem):
        raise TypeError(f"a {type(problem).__name__} is no signorini.Problem; Problem.from_toml reads case files")
    tree = Tree()
    table = tree.table(problem, "")
    if problem._read and problem._read[2] == table:
        text, settings, _ = problem._read
        return problem._name, text, settings, {}
    return problem._name or "problem", table, [], tree.files


def _text_of(source: Union[str, os.PathLike]) -> "tuple[str, str]":
    """Name and text of a case file."""
    if isinstance(source, str) and "\n" in source:
        return "case.toml", source
    if not isinstance(source, (str, os.PathLike)):
        raise TypeError(f"a {type(source).__name__} is neither the path nor the text of a case file")
    path = os.fspath(source)
    try:
        return path, pathlib.Path(path).read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise CaseError(f"`{path}` is not text in UTF-8: {error}", file=path) from error


def _of_json(value: Any, cls: Any) -> Any:
    """A noun from what the reader of case files tells of it."""
    made: Any = object.__new__(cls)
    for name, (key, kind) in cls._types.items():
        found = value.get(key)
        nothing = _left_out(found) or (isinstance(found, dict) and all(map(_left_out, found.values())) and "<" not in kind)
        object.__setattr__(made, name, None if nothing else _of_kind(found, kind))
    return made


def _of_kind(value: Any, kind: str) -> Any:
    if isinstance(value, list):
        lists = [part for part in split(kind) if part.startswith("[")]
        return [_of_kind(entry, lists[0][1:-1]) for entry in value] if lists else value
    if not isinstance(value, dict):
        return value
    if kind.startswith("{"):
        return {name: _of_kind(entry, kind[1:-1]) for name, entry in value.items()}
    if set(value) == {"origin", "spacing", "values"}:
        from ._base import Samples

        return Samples(**value)
    for part in split(kind):
        choices = _nouns.CHOICES.get(part[1:-1], {}) if part.startswith("<") else {}
        for key, held in choices.items():
            if key in value:
                return _held(value[key], key, held)
        noun = getattr(_nouns, part, None)
        if noun is not None and issubclass(noun, Noun):
            return _of_json(value, noun)
    return value


def _held(value: Any, key: str, held: str) -> Any:
    noun = getattr(_nouns, held, None)
    if noun is not None:
        return _of_json(value if isinstance(value, dict) else {}, noun)
    alone = next(c for c in vars(_nouns).values() if getattr(c, "_key", None) == key and set(c._types) == {"value"})
    return alone(_of_kind(value, held))


