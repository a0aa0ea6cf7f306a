"""Functions of one number with their first two derivatives, by the names of NumPy."""

from __future__ import annotations

import math
from collections.abc import Callable

Derivatives = tuple[float, float, float]


def over(a: float, b: float) -> float:
    """a / b, infinite at a pole."""
    return a / b if b else math.copysign(math.inf, a)


def _exp(x: float) -> Derivatives:
    e = math.exp(x)
    return e, e, e


def _log(x: float, base: float = 1.0) -> Derivatives:
    return math.log(x) / base, 1 / (x * base), -1 / (x * x * base)


def _sqrt(x: float) -> Derivatives:
    root = math.sqrt(x)
    return root, over(0.5, root), over(-0.25, root * x)


def _tan(x: float) -> Derivatives:
    t = math.tan(x)
    return t, 1 + t * t, 2 * t * (1 + t * t)


def _arcsin(x: float) -> Derivatives:
    rest = (1 - x) * (1 + x)
    return math.asin(x), over(1, math.sqrt(rest)), over(x, rest * math.sqrt(rest))


def _arccos(x: float) -> Derivatives:
    _, first, second = _arcsin(x)
    return math.acos(x), -first, -second


def _tanh(x: float) -> Derivatives:
    t = math.tanh(x)
    slope = 1 / math.cosh(x) ** 2 if abs(x) < 300 else 0.0
    return t, slope, -2 * t * slope


def _arccosh(x: float) -> Derivatives:
    rest = (x - 1) * (x + 1)
    return math.acosh(x), over(1, math.sqrt(rest)), over(-x, rest * math.sqrt(rest))


def _abs(x: float) -> Derivatives:
    return abs(x), math.copysign(1, x), 0.0


FUNCTIONS: dict[str, Callable[[float], Derivatives]] = {
    "exp": _exp,
    "expm1": lambda x: (math.expm1(x), math.exp(x), math.exp(x)),
    "log": _log,
    "log2": lambda x: (math.log2(x), *_log(x, math.log(2))[1:]),
    "log10": lambda x: (math.log10(x), *_log(x, math.log(10))[1:]),
    "log1p": lambda x: (math.log1p(x), 1 / (1 + x), -1 / (1 + x) ** 2),
    "sqrt": _sqrt,
    "sin": lambda x: (math.sin(x), math.cos(x), -math.sin(x)),
    "cos": lambda x: (math.cos(x), -math.sin(x), -math.cos(x)),
    "tan": _tan,
    "arcsin": _arcsin,
    "arccos": _arccos,
    "arctan": lambda x: (math.atan(x), 1 / (1 + x * x), -2 * x / (1 + x * x) ** 2),
    "sinh": lambda x: (math.sinh(x), math.cosh(x), math.sinh(x)),
    "cosh": lambda x: (math.cosh(x), math.sinh(x), math.cosh(x)),
    "tanh": _tanh,
    "arcsinh": lambda x: (math.asinh(x), 1 / math.hypot(1, x), -x / math.hypot(1, x) ** 3),
    "arccosh": _arccosh,
    "arctanh": lambda x: (math.atanh(x), 1 / ((1 - x) * (1 + x)), 2 * x / ((1 - x) * (1 + x)) ** 2),
    "abs": _abs,
}


def curvature(first: float, second: float, error: float) -> float:
    """The second-order term over the first, for an argument with this standard error."""
    if error == 0 or second == 0:
        return 0.0
    ratio = over(abs(second) * error, 2 * abs(first)) if not math.isinf(first) else math.inf
    return math.inf if math.isnan(ratio) else ratio


def curvature_of_abs(value: float, error: float) -> float:
    """The bias of |x| over the error of x, which is normal."""
    if error == 0:
        return 0.0
    z = abs(value) / error
    return 2 * math.exp(-z * z / 2) / math.sqrt(2 * math.pi) - z * math.erfc(z / math.sqrt(2))
