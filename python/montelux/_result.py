"""What an integration returns."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core, _notation
from ._names import UnknownAttribute, unknown
from ._sources import Run
from ._uncertain import Computes, Uncertain, linear, of_run

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
class Result(Computes):
    """A value with its error, and how it came about. `float(result)` is the value of a scalar integrand.

    Where the integrand returned shape (n,), `value`, `standard_error` and `covariance` are numbers; where it
    returned (n, m) they are read-only arrays of shape (m,), (m,) and (m, m).

    Results compute, `a / b`, `np.exp(a)`, to values of type Uncertain; of a vector its components `r[i]` do, with
    their covariance. Results of different runs are independent if their seeds differ. Two results are equal if they
    are of one run, pickled or not.
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
    #: 'error_target', 'evaluations', 'time', 'interrupted', 'finished' or 'diverges'.
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
    #: How the result was judged, as sentences that are no warnings.
    notes: tuple[str, ...] = ()
    #: What the method learned about the integrand; None where it trains no density.
    density: _core.TrainedDensity | None = None
    _text: str = ""
    _run: Run = field(default_factory=lambda: Run(0.0))

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

    @property
    def uncertain(self) -> Uncertain:
        """The value of a scalar integrand with its error, for computing; the components of a vector are `r[i]`."""
        if np.size(self.value) != 1:
            raise TypeError(
                f"the integral has {np.size(self.value)} components, not a single number; compute with r[0], r[1], "
                "... or np.array(list(r))"
            )
        return of_run(float(self), self._run)

    def __getitem__(self, component: int) -> Uncertain:
        """A component of a vector with its error; with other components of this result it has their covariance."""
        values = self._vector()
        try:
            i = range(len(values))[component]
        except TypeError:
            raise TypeError(f"component {component!r} was asked for; expected a whole number") from None
        except IndexError:
            raise IndexError(f"component {component} was asked for; the integral has {len(values)}") from None
        return of_run(float(values[i]), self._run, i)

    def __iter__(self) -> Iterator[Uncertain]:
        return (of_run(float(v), self._run, i) for i, v in enumerate(self._vector()))

    def _vector(self) -> Array:
        if not isinstance(self.value, np.ndarray):
            raise TypeError("the integral is a single number, without components; see .uncertain")
        return self.value

    def to_gvar(self) -> Any:
        """A gvar.GVar, or an array of them, shape (m,), for a vector. Needs the package gvar."""
        from ._gvar import to_gvar

        return to_gvar(list(self) if isinstance(self.value, np.ndarray) else self)

    def __float__(self) -> float:
        if np.ndim(self.value) > 0 and np.size(self.value) != 1:
            raise TypeError(f"the integral has {np.size(self.value)} components, not a single number; see .value")
        return float(np.asarray(self.value).reshape(()))

    def __eq__(self, other: object) -> bool:
        return self._run == other._run if isinstance(other, Result) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._run)

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

    def _estimates(self) -> list[str]:
        pairs = zip(np.atleast_1d(self.value), np.atleast_1d(self.standard_error))
        return [_notation.concise(float(v), float(e)) for v, e in pairs]

    def _repr_html_(self) -> str:
        estimates = self._estimates()
        details = self._text.splitlines()[len(estimates) :]
        return _notation.result_html(estimates, details, isinstance(self.value, np.ndarray))

    def _repr_latex_(self) -> str:
        return _notation.result_latex(self._estimates(), isinstance(self.value, np.ndarray))

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

        fields = {name: plain(v) for name, v in vars(self).items() if not name.startswith("_")}
        del fields["density"]
        fields["converged"] = self.converged
        return fields


@dataclass(frozen=True, repr=False, eq=False)
class LogResult(Computes):
    """log Z with its error; `float(result)` is log Z. Attributes of `relative` can be read from it directly.

    It computes as a Result does: `a - b` is the logarithm of a quotient of integrals, a Bayes factor.
    """

    #: Natural logarithm of the integral; -inf where that is zero.
    log_value: float
    #: Standard error of log Z to first order, which is the relative error of Z; good while it is small beside 1.
    log_error: float
    #: The integration itself: its values and errors are those of Z exp(-log_reference).
    relative: Result
    log_reference: float
    _text: str = ""

    @property
    def uncertain(self) -> Uncertain:
        """log Z with its error, for computing."""
        z = self.relative.uncertain
        return linear(self.log_value, [(1 / z.value if z.value else np.inf, z)], "log", z.relative_error / 2)

    @property
    def converged(self) -> bool:
        """The target was met without a warning."""
        return self.relative.converged

    @property
    def warnings(self) -> tuple[str, ...]:
        """Reasons why the value or its error may be wrong, as sentences. Normally empty."""
        return self.relative.warnings

    @property
    def notes(self) -> tuple[str, ...]:
        """How the result was judged, as sentences that are no warnings."""
        return self.relative.notes

    @property
    def evaluations(self) -> int:
        """Of the integrand, pilots included."""
        return self.relative.evaluations

    @property
    def density(self) -> _core.TrainedDensity | None:
        """What the method learned about the integrand; None where it trains no density."""
        return self.relative.density

    @property
    def method(self) -> str:
        """The method that was asked for, or that Auto picked."""
        return self.relative.method

    @property
    def stop(self) -> str:
        """'error_target', 'evaluations', 'time', 'interrupted', 'finished' or 'diverges'."""
        return self.relative.stop

    @property
    def seconds(self) -> float:
        """Wall time."""
        return self.relative.seconds

    def to_gvar(self) -> Any:
        """A gvar.GVar of log Z. Needs the package gvar."""
        return self.uncertain.to_gvar()

    def __float__(self) -> float:
        return self.log_value

    def __eq__(self, other: object) -> bool:
        return self.relative == other.relative if isinstance(other, LogResult) else NotImplemented

    def __hash__(self) -> int:
        return hash((LogResult, self.relative))

    def _repr_html_(self) -> str:
        text = _notation.concise(self.log_value, self.log_error)
        return _notation.result_html([text], self._text.splitlines()[1:], False).replace("<b>", "<b>log Z = ", 1)

    def _repr_latex_(self) -> str:
        return rf"$\log Z = {_notation.latex(_notation.concise(self.log_value, self.log_error))}$"

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


def log_from_core(r: _core.LogIntegrationResult, vector: bool, seed: int) -> LogResult:
    """The Python form of log Z; `vector`: the integrand returns shape (n, 1)."""
    return LogResult(
        log_value=r.log_value,
        log_error=r.log_error,
        relative=from_core(r.relative, vector, seed),
        log_reference=r.log_reference,
        _text=str(r),
    )


def from_core(r: _core.IntegrationResult, vector: bool, seed: int) -> Result:
    """The Python form of what the library returned; `vector`: the integrand returns shape (n, m)."""

    def shaped(a: Array) -> float | Array:
        if vector:
            a.flags.writeable = False  # computing with components uses them later
            return a
        return float(a.flat[0]) if a.size else float("nan")

    covariance = r.covariance
    standard_error = r.standard_error
    steps = r.history
    history = History(steps[:, 0].astype(np.uint64), steps[:, 1].copy(), steps[:, 2].copy(), steps[:, 3].copy())
    return Result(
        value=shaped(r.value),
        standard_error=shaped(standard_error),
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
        notes=tuple(r.notes),
        density=r.density,
        _text=str(r),
        _run=Run(standard_error, covariance, seed if r.statistical else None, tuple(r.warnings)),
    )
