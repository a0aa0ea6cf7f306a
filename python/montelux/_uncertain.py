"""Values with errors that compute: propagation to first order, with the covariances of the runs they are from."""

from __future__ import annotations

import math
import numbers
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, NoReturn, Union

import numpy as np
import numpy.typing as npt

from . import _notation, _sources
from ._core import Error
from ._derivatives import FUNCTIONS, curvature, curvature_of_abs, over
from ._functions import Functions
from ._names import UnknownAttribute, is_number, public_names, unknown
from ._propagation import check_curvature, check_seeds
from ._sources import Gradient, Run, combined


class Computes(ABC):
    """What computes as a value with an error: sums, products, quotients, powers, and functions of NumPy.

    There is no order: `a < b` is a TypeError. Compare `float(a) < float(b)`, or the z-score `(a - b).z_score()`.
    """

    __slots__ = ()

    @property
    @abstractmethod
    def uncertain(self) -> Uncertain:
        """The value with its error."""

    def __add__(self, other: Operand) -> Uncertain:
        a, b = self.uncertain, _operand(other)
        return NotImplemented if b is None else _made(a._value + b._value, "add", (1.0, a), (1.0, b))

    __radd__ = __add__

    def __sub__(self, other: Operand) -> Uncertain:
        a, b = self.uncertain, _operand(other)
        return NotImplemented if b is None else _made(a._value - b._value, "subtract", (1.0, a), (-1.0, b))

    def __rsub__(self, other: Operand) -> Uncertain:
        b = _operand(other)
        return NotImplemented if b is None else b - self

    def __mul__(self, other: Operand) -> Uncertain:
        a, b = self.uncertain, _operand(other)
        return NotImplemented if b is None else _product(a, b)

    __rmul__ = __mul__

    def __truediv__(self, other: Operand) -> Uncertain:
        a, b = self.uncertain, _operand(other)
        return NotImplemented if b is None else _quotient(a, b)

    def __rtruediv__(self, other: Operand) -> Uncertain:
        b = _operand(other)
        return NotImplemented if b is None else _quotient(b, self.uncertain)

    def __pow__(self, other: Operand) -> Uncertain:
        a, b = self.uncertain, _operand(other)
        return NotImplemented if b is None else _power(a, b)

    def __rpow__(self, other: Operand) -> Uncertain:
        b = _operand(other)
        return NotImplemented if b is None else _power(b, self.uncertain)

    def __neg__(self) -> Uncertain:
        a = self.uncertain
        return _made(-a._value, "negative", (-1.0, a))

    def __pos__(self) -> Uncertain:
        return self.uncertain

    def __abs__(self) -> Uncertain:
        return self.uncertain._apply("abs")

    def __lt__(self, other: object) -> NoReturn:
        raise TypeError(
            "values with errors have no order; compare float(a) < float(b), or the z-score (a - b).z_score()"
        )

    __le__ = __gt__ = __ge__ = __lt__

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **named: Any) -> Any:
        """np.exp(a), array * a: element by element, as an array of objects. np.arctan2 and the like need `propagate`."""
        if method != "__call__":
            return NotImplemented
        return ufunc(*(_boxed(x.uncertain) if isinstance(x, Computes) else x for x in inputs), **named)


Operand = Union[Computes, float]


class Uncertain(Computes, Functions):
    """A number with a standard error, which remembers where the error is from.

    Uncertain(value, standard_error) is independent of all others; results of integrals convert by `.uncertain`,
    or, of vectors, by `r[i]`. Computing gives the errors to first order (linear propagation), with all covariances:
    `a - a` is 0 with error 0. NumPy's functions apply, `np.exp(a)`, and are methods, `a.exp()`; `math.exp(a)` is
    that of the value alone, as is `float(a)`. Nothing of it ever changes.

    `a == b` if both are one random variable: equal in value, and in the derivatives with respect to all sources of
    error. A number equals an Uncertain without error.
    """

    __slots__ = ("_gradient", "_known_error", "_sentences", "_value")

    _value: float
    _gradient: Gradient
    _known_error: float | None
    _sentences: tuple[str, ...]

    def __init__(self, value: float, standard_error: float) -> None:
        for name, number in (("value", value), ("standard_error", standard_error)):
            if not is_number(number):
                raise Error(f"Uncertain: {name}={number!r} was given; expected a number")
        if not standard_error >= 0:
            raise Error(f"Uncertain: standard_error={standard_error!r} was given; expected 0 or more")
        _fill(self, float(value), {Run(standard_error): {0: 1.0}} if standard_error else {}, ())

    @staticmethod
    def correlated(values: npt.ArrayLike, covariance: npt.ArrayLike) -> list[Uncertain]:
        """Numbers of shape (m,) with their covariance, shape (m, m); raises Error where it is not one."""
        v, c = np.array(values, dtype=float), np.array(covariance, dtype=float)
        if v.ndim != 1 or c.shape != (len(v), len(v)):
            raise Error(
                f"Uncertain.correlated: shapes {v.shape} and {c.shape} were given; expected (m,) values and an "
                "(m, m) covariance"
            )
        if not np.all(np.isfinite(c)) or np.any(np.diag(c) < 0):
            raise Error("Uncertain.correlated: the covariance is not finite, or has a negative variance")
        deviation = np.sqrt(np.diag(c))
        units = np.where(deviation > 0, deviation, 1.0)
        correlation = c / np.outer(units, units)
        if not np.allclose(correlation, correlation.T, rtol=0, atol=1e-9):
            raise Error("Uncertain.correlated: the covariance is not symmetric")
        if len(v) and np.linalg.eigvalsh(correlation)[0] < -1e-9:
            raise Error("Uncertain.correlated: the covariance has a negative eigenvalue, so that no values have it")
        run = Run(deviation, c)
        return [of_run(float(x), run, i) for i, x in enumerate(v)]

    @property
    def uncertain(self) -> Uncertain:
        """Itself."""
        return self

    @property
    def value(self) -> float:
        """The estimate."""
        return self._value

    @property
    def standard_error(self) -> float:
        """One standard deviation of the value, to first order."""
        error = self._known_error
        if error is None:  # on demand: long sums have no use for those of their parts
            error = _sources.standard_error(self._gradient)
            object.__setattr__(self, "_known_error", error)
        return error

    @property
    def relative_error(self) -> float:
        """The standard error over the size of the value."""
        return over(self.standard_error, abs(self._value)) if self.standard_error else 0.0

    @property
    def warnings(self) -> tuple[str, ...]:
        """Reasons why the value or its error may be wrong, as sentences: those of the runs, and of the computation."""
        of_runs = (sentence for run in self._gradient for sentence in run.warnings)
        return tuple(dict.fromkeys((*of_runs, *self._sentences)))

    def covariance(self, other: Operand) -> float:
        """With another value, to first order: 0 if they share no run."""
        return _sources.covariance(self._gradient, _expected(other)._gradient)

    def correlation(self, other: Operand) -> float:
        """The covariance over both standard errors, from -1 to 1; NaN where one of them is 0."""
        b = _expected(other)
        errors = self.standard_error * b.standard_error
        return float(np.clip(self.covariance(b) / errors, -1, 1)) if errors else math.nan

    def z_score(self, expected: Operand = 0.0) -> float:
        """(value - expected) / standard error, with the error and the covariance of `expected` where it has them.

        About standard normal where both are estimates of one number; infinite where a difference has no error.
        """
        difference = self - _expected(expected)
        return over(difference._value, difference.standard_error) if difference._value else 0.0

    def to_gvar(self) -> Any:
        """A gvar.GVar, with all correlations to others that were made by to_gvar(). Needs the package gvar."""
        from ._gvar import to_gvar

        return to_gvar(self)

    @staticmethod
    def from_gvar(values: Any) -> Any:
        """One Uncertain, or a list for a sequence of gvars, with the covariance of the sequence. Needs gvar."""
        from ._gvar import from_gvar

        return from_gvar(values)

    def _apply(self, name: str) -> Uncertain:
        value, first, second = FUNCTIONS[name](self._value)
        curved = (
            curvature_of_abs(self._value, self.standard_error)
            if name == "abs"
            else curvature(first, second, self.standard_error)
        )
        return _made(value, name, (first, self), curved=curved)

    def __float__(self) -> float:
        return self._value

    def __bool__(self) -> bool:
        raise TypeError("a value with an error is neither true nor false; ask its float(), or its z_score()")

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Uncertain):
            return self._value == other._value and self._gradient == other._gradient
        if isinstance(other, numbers.Real):
            return self._value == float(other) and not self._gradient
        return NotImplemented

    def __hash__(self) -> int:
        return hash((self._value, frozenset(self._gradient))) if self._gradient else hash(self._value)

    def __setattr__(self, name: str, value: object) -> NoReturn:
        if name in public_names(type(self)):
            raise AttributeError(f"an Uncertain does not change: {name} cannot be set")
        raise UnknownAttribute(unknown("attribute of Uncertain", name, public_names(type(self))))

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or isinstance(getattr(np, name, None), np.ufunc):  # which look for methods here
            raise AttributeError(name)
        raise UnknownAttribute(unknown("attribute of Uncertain", name, public_names(type(self))))

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self._value, self._gradient, self._sentences)

    def __copy__(self) -> Uncertain:
        return self

    def __deepcopy__(self, memo: object) -> Uncertain:
        return self

    def __str__(self) -> str:
        return _notation.concise(self._value, self.standard_error)

    __repr__ = __str__

    def __format__(self, form: str) -> str:
        """With a form such as `.3f` the value alone, as that of a float; else value and error as `str`."""
        return format(self._value, form) if form else str(self)

    def _repr_html_(self) -> str:
        return _notation.html(str(self))

    def _repr_latex_(self) -> str:
        return f"${_notation.latex(str(self))}$"


def of_run(value: float, run: Run, component: int = 0, derivative: float = 1.0) -> Uncertain:
    """A value whose error is the derivative times that of a component of a run."""
    gradient: Gradient = {run: {component: derivative}} if run.standard_error[component] and derivative else {}
    return _again(value, gradient, ())


def linear(value: float, terms: Sequence[tuple[float, Uncertain]], name: str, curved: float = 0.0) -> Uncertain:
    """A value whose derivatives with respect to others are given.

    For warnings: the name of the function, and the size of its second-order term in units of the first.
    """
    return _made(value, name, *terms, curved=curved)


def covariance(values: Sequence[Operand]) -> npt.NDArray[np.float64]:
    """The covariance of computed values, results or numbers, shape (m, m), to first order."""
    all_values = [_expected(v) for v in values]
    matrix = np.zeros((len(all_values), len(all_values)))
    for i, a in enumerate(all_values):
        for j in range(i + 1):
            matrix[i, j] = matrix[j, i] = a.covariance(all_values[j])
    return matrix


def _fill(u: Uncertain, value: float, gradient: Gradient, sentences: tuple[str, ...]) -> None:
    object.__setattr__(u, "_value", value)
    object.__setattr__(u, "_gradient", gradient)
    object.__setattr__(u, "_sentences", sentences)
    object.__setattr__(u, "_known_error", None)


def _again(value: float, gradient: Gradient, sentences: tuple[str, ...]) -> Uncertain:
    u = object.__new__(Uncertain)
    _fill(u, value, gradient, sentences)
    return u


def _made(
    value: float, name: str, *terms: tuple[float, Uncertain], curved: float = 0.0, second: float = 0.0
) -> Uncertain:
    """A computed value. `second`: the size of the second-order term; `curved`: that in units of the first."""
    gradient = combined((derivative, term._gradient) for derivative, term in terms)
    known = tuple(dict.fromkeys(sentence for _, term in terms for sentence in term._sentences))
    if second:
        curved = over(second, _sources.standard_error(gradient))
    new = check_seeds(gradient, known)
    if gradient or math.isinf(curved):  # what cancels has no error
        new += check_curvature(name, curved, [term for _, term in terms if term._gradient])
    return _again(value, gradient, (*known, *(sentence for sentence in new if sentence not in known)))


def _exact(value: float) -> Uncertain:
    return _again(value, {}, ())


def _operand(x: object) -> Uncertain | None:
    if isinstance(x, Computes):
        return x.uncertain
    return _exact(float(x)) if isinstance(x, numbers.Real) else None


def _expected(x: object) -> Uncertain:
    u = _operand(x)
    if u is None:
        raise TypeError(f"an object of type '{type(x).__name__}' was given; expected a number or a value with an error")
    return u


def _boxed(u: Uncertain) -> npt.NDArray[np.object_]:
    box = np.empty((), dtype=object)
    box[()] = u
    return box


def _product(a: Uncertain, b: Uncertain) -> Uncertain:
    return _made(
        a._value * b._value, "multiply", (b._value, a), (a._value, b), second=a.standard_error * b.standard_error
    )


def _quotient(a: Uncertain, b: Uncertain) -> Uncertain:
    # The second-order term is the first-order one times -db / b.
    ratio = a._value / b._value
    return _made(ratio, "divide", (1 / b._value, a), (-ratio / b._value, b), curved=b.relative_error)


def _power(a: Uncertain, b: Uncertain) -> Uncertain:
    x, y = a._value, b._value
    value = x**y
    if isinstance(value, complex):
        raise ValueError(f"{a} ** {b} is not real")
    terms: list[tuple[float, Uncertain]] = []
    curved = 0.0
    if a.standard_error and y:
        terms.append((y * _real_power(x, y - 1), a))
        curved = curvature(terms[0][0], y * (y - 1) * _real_power(x, y - 2) if y != 1 else 0.0, a.standard_error)
    if b.standard_error:
        terms.append((value * math.log(x), b))
        curved = max(curved, abs(math.log(x)) * b.standard_error / 2)
    return _made(value, "power", *(terms or [(0.0, a)]), curved=curved)


def _real_power(x: float, y: float) -> float:
    return math.inf if x == 0 and y < 0 else float(x**y)


def propagate(function: Callable[..., float], *arguments: Operand) -> Uncertain:
    """The value of any function of numbers, with its error to first order.

    Derivatives are differences over one standard error to each side of each argument (GUM 5.1.3, note 2), so that
    the function must be defined there: `propagate(scipy.special.gamma, r)`.
    """
    given = [_expected(a) for a in arguments]
    values = [a._value for a in given]
    value = float(function(*values))
    terms: list[tuple[float, Uncertain]] = []
    curved = 0.0
    for i, a in enumerate(given):
        if not a.standard_error:
            continue
        step = a.standard_error if math.isfinite(a.standard_error) else 1e-5 * max(1.0, abs(a._value))
        below, above = (float(function(*values[:i], values[i] + s, *values[i + 1 :])) for s in (-step, step))
        terms.append(((above - below) / (2 * step), a))
        curved = max(curved, over(abs(above - 2 * value + below), abs(above - below)) if above != below else 0.0)
    return _made(value, getattr(function, "__name__", "function"), *terms, curved=curved)
