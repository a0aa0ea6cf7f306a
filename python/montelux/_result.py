"""What an integration returns."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core
from ._names import UnknownAttribute, unknown

Array = npt.NDArray[np.float64]


class History(NamedTuple):
    """The state after each step of an integration, thinned in long runs; arrays of one length.

    `value` and `standard_error` are of the first component, `seconds` is wall time.
    """

    evaluations: npt.NDArray[np.uint64]
    value: Array
    standard_error: Array
    seconds: Array


@dataclass(frozen=True, repr=False, eq=False)
class Result:
    """A value with its error, and how it came about. `float(result)` is the value of a scalar integrand.

    Where the integrand returned shape (n,), `value`, `standard_error` and `covariance` are numbers; where it
    returned (n, m) they are arrays of shape (m,), (m,) and (m, m).
    """

    value: float | Array
    #: One standard deviation of each value; for deterministic rules their estimate (see `statistical`).
    standard_error: float | Array
    #: Of the values; None where the method or the options leave it out.
    covariance: float | Array | None
    #: Whether the errors are standard deviations of a random estimate.
    statistical: bool
    #: Of the integrand, pilots included.
    evaluations: int
    #: Values that were NaN or infinite: left out as zeros, with a warning.
    non_finite: int
    #: The point of the first of them, shape (dimensions,); None without any.
    first_non_finite_point: Array | None
    #: The method that was asked for, or that Auto picked.
    method: str
    #: Why Auto picked it; else empty.
    reason: str
    #: 'error_target', 'evaluations', 'time', 'cancelled' or 'finished'.
    stop: str
    #: Reasons why the value or its error may be wrong, as sentences. Normally empty.
    warnings: tuple[str, ...]
    #: Do independent parts of the run agree? No degrees of freedom where there is nothing to compare.
    chi_squared: float
    degrees_of_freedom: int
    p_value: float
    #: Wall time.
    seconds: float
    history: History
    #: Why the newest checkpoint could not be resumed and the previous one was; else empty.
    checkpoint_refused_because: str = ""
    _text: str = field(default="", compare=False)

    @property
    def converged(self) -> bool:
        """The targets were met without a warning."""
        return self.stop == "error_target" and not self.warnings

    @property
    def relative_error(self) -> float | Array:
        """The standard error over the size of the value."""
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.asarray(self.standard_error) / np.abs(self.value)
        return float(ratio) if ratio.ndim == 0 else ratio

    def __float__(self) -> float:
        if np.ndim(self.value) > 0 and np.size(self.value) != 1:
            raise TypeError(f"the integral has {np.size(self.value)} components, not a single number; see .value")
        return float(np.asarray(self.value).reshape(()))

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return np.array(self.value, dtype=dtype)

    def __format__(self, form: str) -> str:
        """With a form such as `.3f` the value alone, as that of a float; else all that `str` says."""
        return format(float(self), form) if form else self._text

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        known = [n for n in dir(type(self)) if not n.startswith("_")]
        known += [n for n in type(self).__dataclass_fields__ if not n.startswith("_")]
        raise UnknownAttribute(unknown("attribute of Result", name, set(known)))

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return self._text

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, strings, lists and None, ready for JSON (infinite and NaN become None)."""

        def plain(v: Any) -> Any:
            if isinstance(v, History):
                return {name: plain(column) for name, column in v._asdict().items()}
            if isinstance(v, (np.ndarray, tuple, list)):
                return [plain(item) for item in (v.tolist() if isinstance(v, np.ndarray) else v)]
            if isinstance(v, float):
                return v if np.isfinite(v) else None
            return v

        fields = {name: plain(v) for name, v in vars(self).items() if name != "_text"}
        fields["converged"] = self.converged
        return fields


@dataclass(frozen=True, repr=False, eq=False)
class LogResult:
    """log Z with its error; `float(result)` is log Z. Attributes of `relative` can be read from it directly."""

    #: Natural logarithm of the integral; -inf where that is zero.
    log_value: float
    #: Standard error of log Z to first order, which is the relative error of Z; good while it is small beside 1.
    log_error: float
    #: The integration itself: its values and errors are those of Z exp(-log_reference).
    relative: Result
    log_reference: float
    _text: str = field(default="", compare=False)

    @property
    def converged(self) -> bool:
        """The target was met without a warning."""
        return self.relative.converged

    @property
    def warnings(self) -> tuple[str, ...]:
        """Reasons why the value or its error may be wrong, as sentences. Normally empty."""
        return self.relative.warnings

    @property
    def evaluations(self) -> int:
        """Of the integrand, pilots included."""
        return self.relative.evaluations

    @property
    def method(self) -> str:
        """The method that was asked for, or that Auto picked."""
        return self.relative.method

    @property
    def stop(self) -> str:
        """'error_target', 'evaluations', 'time', 'cancelled' or 'finished'."""
        return self.relative.stop

    @property
    def seconds(self) -> float:
        """Wall time."""
        return self.relative.seconds

    def __float__(self) -> float:
        return self.log_value

    def __format__(self, form: str) -> str:
        """With a form such as `.3f` log Z alone, as that of a float; else all that `str` says."""
        return format(self.log_value, form) if form else self._text

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        known = {n for n in [*dir(type(self)), *type(self).__dataclass_fields__] if not n.startswith("_")}
        raise UnknownAttribute(unknown("attribute of LogResult", name, known))

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return self._text

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, strings, lists and None, ready for JSON (infinite and NaN become None)."""
        logs = {"log_value": self.log_value, "log_error": self.log_error, "log_reference": self.log_reference}
        return {
            **{name: v if np.isfinite(v) else None for name, v in logs.items()},
            "relative": self.relative.to_dict(),
            "converged": self.converged,
        }


def log_from_core(r: _core.LogIntegrationResult, vector: bool) -> LogResult:
    """The Python form of log Z; `vector`: the integrand returns shape (n, 1)."""
    return LogResult(
        log_value=r.log_value,
        log_error=r.log_error,
        relative=from_core(r.relative, vector),
        log_reference=r.log_reference,
        _text=str(r),
    )


def from_core(r: _core.IntegrationResult, vector: bool) -> Result:
    """The Python form of what the library returned; `vector`: the integrand returns shape (n, m)."""

    def shaped(a: Array) -> float | Array:
        if vector:
            return a
        return float(a.flat[0]) if a.size else float("nan")

    covariance = r.covariance
    steps = r.history
    history = History(steps[:, 0].astype(np.uint64), steps[:, 1].copy(), steps[:, 2].copy(), steps[:, 3].copy())
    return Result(
        value=shaped(r.value),
        standard_error=shaped(r.standard_error),
        covariance=None if covariance is None else shaped(covariance),
        statistical=r.statistical,
        evaluations=r.evaluations,
        non_finite=r.non_finite,
        first_non_finite_point=r.first_non_finite_point if r.non_finite else None,
        method=r.method,
        reason=r.reason,
        stop=r.stop,
        warnings=tuple(r.warnings),
        chi_squared=r.chi_squared,
        degrees_of_freedom=r.degrees_of_freedom,
        p_value=r.p_value,
        seconds=r.seconds,
        history=history,
        checkpoint_refused_because=r.checkpoint_refused_because,
        _text=str(r),
    )
