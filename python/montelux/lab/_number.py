"""Measured numbers with their errors beside the exact ones."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import montelux

#: Largest distance from the exact number, in standard errors; a correct number exceeds it once in 2.6e7 times.
LIMIT = 5.5
#: The probability of that, on one side.
_TAIL = 1.899e-8


@dataclass(frozen=True)
class Number:
    """A measured number with its error, and what it should be.

    `error` is one standard deviation of `measured`; where `bound` is true it is the largest difference that
    rounding or a known remainder can make.
    """

    name: str
    #: These three are floats, or what NumPy makes of one.
    measured: Any
    error: Any
    exact: Any
    bound: bool = False
    #: Of an error that comes from the spread of that many replicates less one; infinite: known well.
    degrees_of_freedom: float = math.inf
    #: The exact number as it is written in the text, '1' or 'pi^2/8 - 1'; empty: its digits.
    formula: str = ""

    def __post_init__(self) -> None:
        for name in ("measured", "error", "exact"):
            object.__setattr__(self, name, float(getattr(self, name)))

    @property
    def limit(self) -> float:
        """The errors that may lie between measured and exact: as improbable as LIMIT of a normal law."""
        if self.bound:
            return 1.0
        if math.isinf(self.degrees_of_freedom):
            return LIMIT
        return float(montelux.Distribution.student_t(self.degrees_of_freedom).quantile_complement(_TAIL))

    @property
    def distance(self) -> float:
        """From measured to exact, in errors; the sign is that of measured less exact."""
        difference = self.measured - self.exact
        if self.error > 0:
            return float(difference / self.error)
        return 0.0 if difference == 0 else math.copysign(math.inf, difference)

    @property
    def agrees(self) -> bool:
        return math.isfinite(self.measured) and abs(self.distance) <= self.limit

    @property
    def measured_text(self) -> str:
        """'1.234(56)'; of a bounded number the digits that are known."""
        if self.bound:
            return digits_of(self.measured, self.error) if self.exact != 0 else short(self.measured)
        return concise(self.measured, self.error)

    @property
    def distance_text(self) -> str:
        """How far measured and exact are apart."""
        return f"bound {short(self.error)}" if self.bound else f"{abs(self.distance):.1f} errors"

    @property
    def exact_text(self) -> str:
        """The exact number with two digits more than the measured one is known to."""
        digits = digits_of(self.exact, self.error)
        return f"{self.formula} = {digits}" if self.formula and self.formula != digits else digits


def of(name: str, result: montelux.Result, exact: float, formula: str = "", replicates: int = 0) -> Number:
    """The value of an integration beside the exact one; `replicates` where its error comes from their spread."""
    freedom = replicates - 1.0 if replicates else math.inf
    return Number(name, result.value, result.standard_error, exact, degrees_of_freedom=freedom, formula=formula)


def mean_of(name: str, samples: montelux._result.Array, exact: float, formula: str = "") -> Number:
    """The mean of independent samples, with its standard error."""
    n = len(samples)
    return Number(name, float(samples.mean()), float(samples.std(ddof=1)) / math.sqrt(n), exact, formula=formula)


def share_of(name: str, hits: int, tries: int, exact: float, formula: str = "") -> Number:
    """How often something happened, beside its probability, which gives the error."""
    return Number(name, hits / tries, math.sqrt(exact * (1 - exact) / tries), exact, formula=formula)


def concise(value: float, error: float) -> str:
    """The value with the last two digits of its error in brackets, '1.234(56)'; '1.2(?)' where it is unknown."""
    if error == 0 and math.isfinite(value):
        return f"{value:.12g}"
    if not (math.isfinite(value) and math.isfinite(error)):
        return f"{value:.6g}(?)"
    last = _exponent(error) - 1
    first = max(_exponent(value) if value != 0 else last, last + 1)
    shift = first if first > 5 or first < -4 or last > 0 else 0
    digits = f"{value / 10.0**shift:.{max(0, shift - last)}f}({error / 10.0**last:.0f})"
    return digits.replace("-", "\N{MINUS SIGN}") + (f" × 10{superscript(shift)}" if shift else "")


def digits_of(value: float, error: float) -> str:
    """A number that is known exactly, to one digit more than another with this error."""
    if value == 0 or float(value).is_integer() and abs(value) < 1e6:
        return f"{value:.0f}".replace("-", "\N{MINUS SIGN}")
    known = _exponent(value) - _exponent(error) + 3 if 0 < error < math.inf else 10
    text = f"{value:.{min(max(known, 3), 12)}g}"
    if "e" in text:
        mantissa, exponent = text.split("e")
        text = f"{mantissa} × 10{superscript(int(exponent))}"
    return text.replace("-", "\N{MINUS SIGN}")


def short(value: float) -> str:
    """Two digits: '1.5 × 10⁻¹⁵'."""
    text = f"{value:.2g}"
    if "e" in text:
        mantissa, exponent = text.split("e")
        text = f"{mantissa} × 10{superscript(int(exponent))}".removeprefix("1 × ")
    return text.replace("-", "\N{MINUS SIGN}")


def superscript(n: int) -> str:
    return str(n).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def _exponent(v: float) -> int:
    # By way of the printed form, which rounds as the final one does.
    return int(f"{abs(v):.1e}".split("e")[1])
