"""What arguments are, and sentences for names that do not exist, with the nearest one that does."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import wraps
from inspect import Parameter, signature
from typing import Any, TypeVar

import numpy as np

from ._core import Error, nearest_name

#: Of a call; more are a mistake, and the system gives way far earlier.
MOST_THREADS = 4096


def is_number(value: Any) -> bool:
    """Whether a value is a real number, of Python or NumPy."""
    return isinstance(value, (int, float, np.integer, np.floating))


def is_whole(value: Any) -> bool:
    """Whether a value is an integer, of Python or NumPy."""
    return isinstance(value, (int, np.integer))


# What other integrators and libraries of statistics call the same.
_ELSEWHERE = {
    "relative_error": ("rtol", "reltol", "rel_tol", "epsrel", "eps_rel", "rel_err", "tol"),
    "absolute_error": ("atol", "abstol", "abs_tol", "epsabs", "eps_abs", "abs_err"),
    "evaluations": ("neval", "nitn", "maxeval", "max_eval", "max_nfev", "nfev", "n", "N", "n_samples", "num_samples"),
    "time": ("seconds", "timeout", "time_limit", "max_time"),
    "seconds": ("time", "elapsed", "wall_time"),
    "threads": ("nproc", "n_jobs", "n_threads", "num_threads"),
    "workers": ("processes", "num_workers", "n_workers", "max_workers", "pool"),
    "seed": ("rng", "random_state"),
    "value": ("mean", "val", "integral", "result", "estimate"),
    "standard_error": ("sdev", "std", "stderr", "error", "err", "sigma", "abserr", "uncertainty"),
    "covariance": ("cov",),
    "chi_squared": ("chi2", "chisq"),
    "degrees_of_freedom": ("dof",),
    "p_value": ("Q", "pvalue"),
    "warnings": ("warnings",),
    "converged": ("success",),
    "log_value": ("logz", "logZ", "log_z"),
    "log_error": ("logzerr", "logz_err"),
}
_OF_LOGARITHMS = {"value": "log_value", "standard_error": "log_error"}
_OURS: dict[str, list[str]] = {}
for _ours, _names in _ELSEWHERE.items():
    for _theirs in _names:
        _OURS.setdefault(_theirs, []).append(_ours)


_Function = TypeVar("_Function", bound=Callable[..., Any])


class UnknownAttribute(Error, AttributeError):
    """An attribute that does not exist; the message offers the nearest one that does."""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """`" (did you mean 'x'?)"`, or nothing where no known name is near."""
    known = list(known)
    ours = _OURS.get(name, [name])
    near = [*ours, *(_OF_LOGARITHMS.get(n) for n in ours)]
    nearest = next((n for n in near if n in known), None) or nearest_name(name, known)
    return f" (did you mean '{nearest}'?)" if nearest else ""


def unknown(what: str, name: str, known: Iterable[str]) -> str:
    """The sentence for a name that is not among the known ones."""
    names = sorted(known)
    return f"there is no {what} '{name}'{did_you_mean(name, names)}; expected one of {', '.join(names)}"


def public_attributes(kind: type) -> list[str]:
    """The attributes of a class that users may read or set, methods left out."""
    return sorted(
        name
        for base in kind.__mro__
        for name, value in vars(base).items()
        if not name.startswith("_") and not callable(value) and not isinstance(value, (staticmethod, classmethod))
    )


def public_names(kind: type) -> list[str]:
    """The attributes and the methods of a class."""
    return sorted({name for base in kind.__mro__ for name in vars(base) if not name.startswith("_")})


def settings_of(kind: type) -> list[str]:
    """The attributes of a class of settings that can be set, in the order of their declaration."""
    return [name for name, value in vars(kind).items() if isinstance(value, property) and value.fset is not None]


def strict_arguments(function: _Function) -> _Function:
    """A function that answers an argument that it does not have with the nearest name."""
    parameters = signature(function).parameters.values()
    known = [p.name for p in parameters if p.kind is Parameter.KEYWORD_ONLY]
    called = function.__qualname__.removesuffix(".__init__").split(".")[-1]

    @wraps(function)
    def checked(*values: Any, **named: Any) -> Any:
        for name in named:
            if name not in known:
                raise Error(f"{called}: " + unknown("argument", name, known))
        return function(*values, **named)

    return checked  # type: ignore[return-value]


def strict(*kinds: type) -> None:
    """Makes classes of the extension refuse attributes that they do not have, with the nearest name."""
    for kind in kinds:
        _make_strict(kind)


def _make_strict(kind: type) -> None:
    plain_set = kind.__setattr__

    def set_attribute(self: object, name: str, value: object) -> None:
        if not hasattr(type(self), name):
            raise UnknownAttribute(unknown(f"attribute of {type(self).__name__}", name, public_attributes(type(self))))
        plain_set(self, name, value)  # type: ignore[call-arg, arg-type]

    def get_attribute(self: object, name: str) -> object:
        if name.startswith("__"):
            raise AttributeError(name)
        raise UnknownAttribute(unknown(f"attribute of {type(self).__name__}", name, public_names(type(self))))

    kind.__setattr__ = set_attribute  # type: ignore[method-assign, assignment]
    kind.__getattr__ = get_attribute  # type: ignore[attr-defined]
