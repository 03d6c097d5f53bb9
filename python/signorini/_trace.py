"""Callables as expressions: a function is called once with symbols and what it computes is written down."""

from __future__ import annotations

import inspect
from typing import Any, Callable

import numpy as np

from ._errors import CaseError

#: Functions of NumPy by what they are called in expressions.
FUNCTIONS = {
    np.sin: "sin", np.cos: "cos", np.tan: "tan", np.arcsin: "asin", np.arccos: "acos", np.arctan: "atan",
    np.arctan2: "atan2", np.sinh: "sinh", np.cosh: "cosh", np.tanh: "tanh", np.exp: "exp", np.log: "log",
    np.log10: "log10", np.sqrt: "sqrt", np.absolute: "abs", np.fabs: "abs", np.sign: "sign", np.floor: "floor",
    np.ceil: "ceil", np.minimum: "min", np.maximum: "max", np.fmin: "min", np.fmax: "max", np.hypot: "hypot",
}
OPERATORS = {
    np.add: "+", np.subtract: "-", np.multiply: "*", np.divide: "/", np.power: "^", np.float_power: "^",
    np.less: "<", np.less_equal: "<=", np.greater: ">", np.greater_equal: ">=", np.equal: "==", np.not_equal: "!=",
    np.logical_and: "&&", np.logical_or: "||", np.bitwise_and: "&&", np.bitwise_or: "||",
}


class Untraceable(TypeError):
    """A function does something with a symbol that no expression does."""


class Term:
    """An expression that stands in place of numbers."""

    def __init__(self, text: str) -> None:
        self.text = text

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> "Term":
        if method != "__call__" or options:
            raise Untraceable(f"numpy.{ufunc.__name__}.{method} with options")
        terms = [_text(value) for value in inputs]
        if ufunc in OPERATORS:
            return Term(f"({terms[0]} {OPERATORS[ufunc]} {terms[1]})")
        if ufunc in FUNCTIONS:
            return Term(f"{FUNCTIONS[ufunc]}({', '.join(terms)})")
        if ufunc is np.square:
            return Term(f"({terms[0]}^2)")
        if ufunc is np.negative:
            return Term(f"(-{terms[0]})")
        if ufunc in (np.logical_not, np.invert):
            return Term(f"(!{terms[0]})")
        raise Untraceable(f"numpy.{ufunc.__name__}")

    def __array_function__(self, function: Any, types: Any, args: tuple, kwargs: dict) -> "Term":
        if function is np.where and len(args) == 3 and not kwargs:
            return Term(f"if({', '.join(_text(value) for value in args)})")
        if function is np.clip and len(args) == 3 and not kwargs:
            return Term(f"min(max({_text(args[0])}, {_text(args[1])}), {_text(args[2])})")
        raise Untraceable(f"numpy.{function.__name__}")

    def __neg__(self) -> "Term":
        return Term(f"(-{self.text})")

    def __pos__(self) -> "Term":
        return self

    def __abs__(self) -> "Term":
        return Term(f"abs({self.text})")

    def __invert__(self) -> "Term":
        return Term(f"(!{self.text})")

    def __bool__(self) -> bool:
        raise Untraceable("a branch that depends on the position: use numpy.where")

    def __float__(self) -> float:
        raise Untraceable("a number made of the position, as functions of `math` do: use those of numpy")

    __int__ = __index__ = __float__
    __hash__ = None  # type: ignore[assignment]

    def __iter__(self) -> Any:
        raise Untraceable("a loop over the position")


def _operator(name: str, ufunc: Any) -> None:
    setattr(Term, f"__{name}__", lambda self, other: self.__array_ufunc__(ufunc, "__call__", self, other))
    setattr(Term, f"__r{name}__", lambda self, other: self.__array_ufunc__(ufunc, "__call__", other, self))


for _name, _ufunc in {
    "add": np.add, "sub": np.subtract, "mul": np.multiply, "truediv": np.divide, "pow": np.power,
    "lt": np.less, "le": np.less_equal, "gt": np.greater, "ge": np.greater_equal, "eq": np.equal, "ne": np.not_equal,
    "and": np.bitwise_and, "or": np.bitwise_or,
}.items():
    _operator(_name, _ufunc)


def _text(value: Any) -> str:
    if isinstance(value, Term):
        return value.text
    number = np.asarray(value)
    if number.ndim == 0 and number.dtype.kind in "iuf" and np.isfinite(number):
        return f"({number.item()!r})" if number < 0 else repr(number.item())
    raise Untraceable(f"an array or a value that is no finite number: {value!r}")


def traced(function: Callable[..., Any], path: str) -> Any:
    """The expression, or the number, that a function of x, y, z, t computes; its arguments are known by their names.

    >>> import numpy as np
    >>> traced(lambda x, y: -0.1 + 0.05 * np.cos(np.pi * x) * y**2, "")
    '((-0.1) + ((0.05 * cos((3.141592653589793 * x))) * (y ^ 2)))'
    >>> traced(lambda t: np.where(t < 1, t, 2 - t), "")
    'if((t < 1), t, (2 - t))'
    """
    try:
        names = list(inspect.signature(function).parameters)
    except (TypeError, ValueError):
        names = ["x", "y", "z", "t"]
    try:
        found = function(*(Term(name) for name in names))
        return found.text if isinstance(found, Term) else float(found)
    except Exception as error:  # whatever the function of the user raises
        advice = "use functions of numpy, or sample it: signorini.Samples.of(f, min=[…], max=[…], counts=[…])"
        if not isinstance(error, Untraceable):
            advice = f"{type(error).__name__} was raised; {advice}"
        raise CaseError(f"the function is no expression: {error}", path=path, help=advice) from error
