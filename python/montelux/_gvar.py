"""Values to and from the package gvar (G. P. Lepage), correlations included. The package is optional."""

from __future__ import annotations

import importlib
import weakref
from collections.abc import Sequence
from typing import Any

import numpy as np

from ._core import Error
from ._sources import Run
from ._uncertain import Computes, Uncertain

# One GVar of mean 0 per component of a run, so that all values of it are correlated in gvar, too.
_OF_RUNS: weakref.WeakKeyDictionary[Run, Any] = weakref.WeakKeyDictionary()


def _gvar() -> Any:
    try:
        return importlib.import_module("gvar")
    except ImportError:
        raise Error("the package gvar is not installed; expected it from 'pip install gvar'") from None


def _errors_of(run: Run) -> Any:
    found = _OF_RUNS.get(run)
    if found is None:
        m = len(run.standard_error)
        if run.covariance is None and m > 1:
            raise Error("to_gvar: the covariance of the components is not known; expected covariance=True")
        spread = run.standard_error[:1] ** 2 * np.eye(1) if m == 1 else run.covariance
        found = _OF_RUNS[run] = _gvar().gvar(np.zeros(m), spread)
    return found


def to_gvar(values: Computes | Sequence[Computes]) -> Any:
    """A GVar, or an array of them, shape (m,)."""
    gvar = _gvar()
    if not isinstance(values, Computes):
        return np.array([to_gvar(v) for v in values], dtype=object)
    u = values.uncertain
    total = gvar.gvar(u.value, 0.0)
    for run, parts in u._gradient.items():
        errors = _errors_of(run)
        for i, derivative in parts.items():
            total = total + derivative * errors[i]
    return total


def from_gvar(values: Any) -> Any:
    """One Uncertain, or a list of them for a sequence, with the covariance that gvar knows of."""
    gvar = _gvar()
    one = np.ndim(values) == 0
    flat = np.atleast_1d(np.asarray(values, dtype=object))
    made = Uncertain.correlated(gvar.mean(flat), gvar.evalcov(flat))
    return made[0] if one else made
