"""Montelux: Monte Carlo integration you can trust, from a one-line integral to a rendered picture.

    >>> import numpy as np, montelux
    >>> montelux.integrate(lambda x: np.sin(x), (0, np.pi / 2), relative_error=1e-9)
    1.0000000000000000(12)
    ...

docs/python.md is the guide; docs/integration.md says which method is for what.
"""

from __future__ import annotations

from ._core import (
    AdaptiveMap,
    Adaptive,
    Auto,
    BasicMonteCarlo,
    ControlVariate,
    Cubature,
    Distribution,
    Domain,
    Error,
    Importance,
    Metropolis,
    MidpointRule,
    MultipleImportance,
    Quasi,
    Recursive,
    RiemannSum,
    Stratified,
    Technique,
    TrapezoidRule,
    Vegas,
    VegasSobol,
    __version__,
    l2_star_discrepancy,
    mis_weights,
    points,
    star_discrepancy,
)
from ._chains import Chains, metropolis
from ._integrate import METHODS, integrate, train_map
from ._names import UnknownAttribute, strict
from ._result import History, Result

from . import warp

strict(*METHODS.values())
