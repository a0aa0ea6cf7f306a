"""Warnings of computing with errors: where the first order is not enough, where independence is not known."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ._sources import Gradient, shared_seed

if TYPE_CHECKING:
    from ._uncertain import Uncertain

#: Second-order terms of this share of the first are warned of. A quotient has there a bias of a tenth of its error.
MOST_CURVATURE = 0.1

_PACKAGE = str(Path(__file__).parent)


class PropagationWarning(UserWarning):
    """The error of a computed value may be wrong: propagation to first order is rough, or runs share a seed."""


def check_curvature(name: str, curved: float, arguments: Sequence[Uncertain]) -> list[str]:
    """Warns where the second-order term of a function is not small beside the first."""
    if not curved > MOST_CURVATURE:
        return []
    of = ", ".join(str(a) for a in arguments)
    size = f"{100 * curved:.2g} % of" if curved < 10 else "more than ten times"
    return _warn(f"{name}({of}): the error is of first order, and the second-order term is {size} the first")


def check_seeds(gradient: Gradient, known: Sequence[str]) -> list[str]:
    """Warns where runs with one seed meet; not again where `known` has it."""
    seed = shared_seed(gradient)
    if seed is None:
        return []
    sentence = (
        f"runs with one seed ({seed}) are combined as if they were independent, but have the same random "
        "numbers; expected a seed for each, or one run of a vector"
    )
    return [] if sentence in known else _warn(sentence)


def _warn(sentence: str) -> list[str]:
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        level, frame = level + 1, frame.f_back
    warnings.warn(sentence, PropagationWarning, stacklevel=level)
    return [sentence]
