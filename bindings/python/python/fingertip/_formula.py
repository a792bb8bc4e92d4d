"""Shapes that are written as functions of Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NoReturn

import numpy as np

from fingertip._native import ShapeError

_LONGEST = 20_000
"""Of a formula, in letters: whoever writes more repeats a long expression many times."""


class Term:
    """A coordinate, or what arithmetic makes of coordinates: remembers how it was made."""

    __slots__ = ("_text",)
    # Arithmetic with arrays and numbers of NumPy comes here, too.
    __array_priority__ = 1000

    def __init__(self, text: str) -> None:
        if len(text) > _LONGEST:
            raise ShapeError(f"the formula is longer than {_LONGEST} letters; write its parts once")
        self._text = text

    def __add__(self, other: Any) -> Term:
        return _two(self, "+", other)

    def __radd__(self, other: Any) -> Term:
        return _two(other, "+", self)

    def __sub__(self, other: Any) -> Term:
        return _two(self, "-", other)

    def __rsub__(self, other: Any) -> Term:
        return _two(other, "-", self)

    def __mul__(self, other: Any) -> Term:
        return _two(self, "*", other)

    def __rmul__(self, other: Any) -> Term:
        return _two(other, "*", self)

    def __truediv__(self, other: Any) -> Term:
        return _two(self, "/", other)

    def __rtruediv__(self, other: Any) -> Term:
        return _two(other, "/", self)

    def __neg__(self) -> Term:
        return _two(0.0, "-", self)

    def __pos__(self) -> Term:
        return self

    def __abs__(self) -> Term:
        return Term(f"abs({self._text})")

    def __pow__(self, exponent: Any) -> Term:
        if isinstance(exponent, Term) or (exponent != 0.5 and exponent != int(exponent)) or abs(exponent) > 64:
            raise ShapeError(f"an exponent must be a whole number up to 64, or 0.5, not {exponent!r}")
        if exponent == 0.5:
            return Term(f"sqrt({self._text})")
        power = Term(f"({self._text}^{abs(int(exponent))})")
        return power if exponent >= 0 else _two(1.0, "/", power)

    def __rpow__(self, base: Any) -> Term:
        raise ShapeError("an exponent must be a whole number: write numpy.exp for a power of e")

    def __array_ufunc__(self, function: Any, method: str, *inputs: Any, **options: Any) -> Term:
        known = _FUNCTIONS.get(function)
        if known is None or method != "__call__" or options:
            names = ", ".join(sorted(function.__name__ for function in _FUNCTIONS))
            raise ShapeError(f"numpy.{function.__name__} is not known to formulas; known are {names}")
        return known(*inputs)

    def _decide(self, *_: Any) -> NoReturn:
        raise ShapeError(
            "a shape must be one formula: what compares coordinates, or turns them into numbers, cannot be followed; "
            "numpy.minimum and numpy.maximum can, numpy.sqrt instead of math.sqrt"
        )

    __bool__ = __float__ = __int__ = __index__ = __len__ = __iter__ = _decide
    __lt__ = __le__ = __gt__ = __ge__ = _decide
    __array__ = _decide
    __hash__ = None  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        self._decide()

    def __repr__(self) -> str:
        return f"<a coordinate, or made of coordinates: {self._text}>"


def _text(given: Any) -> str:
    if isinstance(given, Term):
        return given._text
    number = float(given)
    if not np.isfinite(number):
        raise ShapeError(f"a number of a formula must be finite, not {number}")
    return repr(number) if number >= 0 else f"(0 - {-number!r})"


def _two(first: Any, sign: str, second: Any) -> Term:
    return Term(f"({_text(first)} {sign} {_text(second)})")


def _call(name: str) -> Callable[..., Term]:
    return lambda *terms: Term(f"{name}({', '.join(_text(term) for term in terms)})")


_FUNCTIONS: dict[Any, Callable[..., Term]] = {
    np.add: lambda a, b: _two(a, "+", b),
    np.subtract: lambda a, b: _two(a, "-", b),
    np.multiply: lambda a, b: _two(a, "*", b),
    np.divide: lambda a, b: _two(a, "/", b),
    np.negative: lambda a: -a,
    np.positive: lambda a: a,
    np.square: lambda a: a**2,
    np.power: lambda a, b: a**b,
    np.absolute: abs,
    np.fabs: abs,
    np.sqrt: _call("sqrt"),
    np.exp: _call("exp"),
    np.sin: _call("sin"),
    np.cos: _call("cos"),
    np.minimum: _call("min"),
    np.fmin: _call("min"),
    np.maximum: _call("max"),
    np.fmax: _call("max"),
    np.hypot: lambda a, b: _call("sqrt")(_two(_two(a, "*", a), "+", _two(b, "*", b))),
}


def formula(outside: Callable[[Any, Any, Any], Any]) -> str:
    """The formula that a function of Python works out, as the key `outside` of a scene takes it.

    The function is called once, with coordinates that remember what is done to them, and never again: a shape is as fast as
    if its formula had been written into the scene, no crossing of it is missed, and a controller without Python can have it.

    Parameters
    ----------
    outside : callable
        Takes the coordinates x, y, z [m], gives what is positive outside of the body and negative inside: arithmetic,
        powers, and NumPy's sqrt, exp, sin, cos, absolute, square, hypot, minimum, maximum. What compares coordinates
        cannot be followed.

    Raises
    ------
    ShapeError
        The function does what a formula cannot.

    Examples
    --------
    >>> import numpy as np
    >>> from fingertip import formula
    >>> formula(lambda x, y, z: x**2 + y**2 + np.maximum(z, 0) ** 2 - 0.01**2)
    '((((x^2) + (y^2)) + (max(z, 0.0)^2)) - 0.0001)'
    """
    found = outside(Term("x"), Term("y"), Term("z"))
    if not isinstance(found, Term):
        raise ShapeError(f"the function must give what it makes of its coordinates, not {found!r}")
    return found._text
