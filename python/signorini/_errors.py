"""Exceptions of the package."""

from __future__ import annotations

from typing import Optional


class SignoriniError(Exception):
    """Base class of the exceptions of this package."""


class CaseError(SignoriniError, ValueError):
    """Something is wrong with a problem.

    message: What is wrong.
    path: Path of the key, such as ``bodies.block.solid.material``; None if there is none.
    value: The text at that place of the case file; None for a problem made in Python.
    help: What to do; None if there is no advice.
    file, line, column: Place in the case file; None for a problem made in Python.

    >>> import signorini as sg
    >>> try:
    ...     sg.wrap([-2, 0, 0], [2, 0, 0], {"ball": sg.Sphere(center=[0, 0, 0], radius="2*q")})
    ... except sg.CaseError as error:
    ...     print(error.path)
    bodies.ball.rigid.shape.sphere.radius
    """

    def __init__(
        self,
        message: str,
        *,
        path: Optional[str] = None,
        value: Optional[str] = None,
        help: Optional[str] = None,
        file: Optional[str] = None,
        line: Optional[int] = None,
        column: Optional[int] = None,
    ) -> None:
        super().__init__(message)
        self.message = message
        self.path = path
        self.value = value
        self.help = help
        self.file = file
        self.line = line
        self.column = column

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}:{self.column}: " if self.line is not None else ""
        path = f"{self.path}: " if self.path else ""
        advice = f"\n  help: {self.help}" if self.help else ""
        return f"{place}{path}{self.message}{advice}"

    def __reduce__(self):
        return (_made, (self.__dict__,))


def _made(fields):
    return CaseError(**fields)


class OutputError(SignoriniError, OSError):
    """Results cannot be written."""


class InternalError(SignoriniError, RuntimeError):
    """A fault of the program: please report it with the problem that causes it."""

    def __str__(self) -> str:
        return f"internal fault: {self.args[0]}; please report it with the problem that causes it"


class MissingPackage(SignoriniError, ImportError):
    """An optional package is not installed."""


def optional(name: str):
    """Imports an optional package.

    Raises MissingPackage with the line that installs it.
    """
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise MissingPackage(f"{name} is not installed: pip install {name}", name=name) from error
