"""NumPy's functions of one number as methods: NumPy calls these for arrays of objects."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._uncertain import Uncertain


class Functions(ABC):
    """Functions of a value with an error, to first order. Outside their domain they raise what `math` does."""

    __slots__ = ()

    @abstractmethod
    def _apply(self, name: str) -> Uncertain:
        """A function of _derivatives.py by its name."""

    def exp(self) -> Uncertain:
        """e to this power."""
        return self._apply("exp")

    def expm1(self) -> Uncertain:
        """exp(x) - 1, with all digits at 0."""
        return self._apply("expm1")

    def log(self) -> Uncertain:
        """Natural logarithm."""
        return self._apply("log")

    def log2(self) -> Uncertain:
        """Logarithm to base 2."""
        return self._apply("log2")

    def log10(self) -> Uncertain:
        """Logarithm to base 10."""
        return self._apply("log10")

    def log1p(self) -> Uncertain:
        """log(1 + x), with all digits at 0."""
        return self._apply("log1p")

    def sqrt(self) -> Uncertain:
        """Square root."""
        return self._apply("sqrt")

    def sin(self) -> Uncertain:
        """Sine."""
        return self._apply("sin")

    def cos(self) -> Uncertain:
        """Cosine."""
        return self._apply("cos")

    def tan(self) -> Uncertain:
        """Tangent."""
        return self._apply("tan")

    def arcsin(self) -> Uncertain:
        """Inverse sine, in radians."""
        return self._apply("arcsin")

    def arccos(self) -> Uncertain:
        """Inverse cosine, in radians."""
        return self._apply("arccos")

    def arctan(self) -> Uncertain:
        """Inverse tangent, in radians."""
        return self._apply("arctan")

    def sinh(self) -> Uncertain:
        """Hyperbolic sine."""
        return self._apply("sinh")

    def cosh(self) -> Uncertain:
        """Hyperbolic cosine."""
        return self._apply("cosh")

    def tanh(self) -> Uncertain:
        """Hyperbolic tangent."""
        return self._apply("tanh")

    def arcsinh(self) -> Uncertain:
        """Inverse hyperbolic sine."""
        return self._apply("arcsinh")

    def arccosh(self) -> Uncertain:
        """Inverse hyperbolic cosine."""
        return self._apply("arccosh")

    def arctanh(self) -> Uncertain:
        """Inverse hyperbolic tangent."""
        return self._apply("arctanh")
