"""Montelux: Monte Carlo integration you can trust, from a one-line integral to a rendered picture.

    >>> import numpy as np, montelux
    >>> montelux.integrate(lambda x: np.sin(x), (0, np.pi / 2), relative_error=1e-9)
    1.0000000000000000(12)
    ...

docs/python.md is the guide; docs/integration.md says which method is for what.
"""

from __future__ import annotations

from ._core import (
    Adaptive,
    AdaptiveMap,
    AliasTable,
    AreaLight,
    Auto,
    BasicMonteCarlo,
    BoxFilter,
    CoatedConductor,
    CoatedDiffuse,
    Conductor,
    ControlVariate,
    Cubature,
    Dielectric,
    Diffuse,
    Discrete,
    DistantLight,
    Distribution,
    Domain,
    EnvironmentLight,
    Error,
    Film,
    GaussianFilter,
    Importance,
    Integrator,
    LanczosFilter,
    Metropolis,
    MidpointRule,
    MitchellFilter,
    MultipleImportance,
    OrthographicCamera,
    PerspectiveCamera,
    PointLight,
    Quasi,
    Recursive,
    RiemannSum,
    Sampler,
    Shape,
    Spectrum,
    SphericalCamera,
    SpotLight,
    Stratified,
    Technique,
    ThinDielectric,
    TrapezoidRule,
    TriangleFilter,
    UniformInfiniteLight,
    Vegas,
    VegasSobol,
    l2_star_discrepancy,
    mis_weights,
    points,
    read_channels,
    star_discrepancy,
)
from ._core import version as __version__
from ._chains import Chains, metropolis
from ._compare import ChannelComparison, Comparison, ZScores, compare
from ._filters import pixel_filter
from ._integrate import METHODS, integrate, train_map
from ._names import UnknownAttribute, strict
from ._picture import Picture
from ._render import Progress, Render
from ._result import History, Result
from ._scene import Scene, load, parse

from . import warp

__all__ = [
    "__version__",
    "Adaptive",
    "AdaptiveMap",
    "AliasTable",
    "AreaLight",
    "Auto",
    "BasicMonteCarlo",
    "BoxFilter",
    "Chains",
    "ChannelComparison",
    "CoatedConductor",
    "CoatedDiffuse",
    "compare",
    "Comparison",
    "Conductor",
    "ControlVariate",
    "Cubature",
    "Dielectric",
    "Diffuse",
    "Discrete",
    "DistantLight",
    "Distribution",
    "Domain",
    "EnvironmentLight",
    "Error",
    "Film",
    "GaussianFilter",
    "History",
    "Importance",
    "integrate",
    "Integrator",
    "l2_star_discrepancy",
    "LanczosFilter",
    "load",
    "METHODS",
    "Metropolis",
    "metropolis",
    "MidpointRule",
    "mis_weights",
    "MitchellFilter",
    "MultipleImportance",
    "OrthographicCamera",
    "parse",
    "PerspectiveCamera",
    "Picture",
    "pixel_filter",
    "PointLight",
    "points",
    "Progress",
    "Quasi",
    "read_channels",
    "Recursive",
    "Render",
    "Result",
    "RiemannSum",
    "Sampler",
    "Scene",
    "Shape",
    "Spectrum",
    "SphericalCamera",
    "SpotLight",
    "star_discrepancy",
    "Stratified",
    "Technique",
    "ThinDielectric",
    "train_map",
    "TrapezoidRule",
    "TriangleFilter",
    "UniformInfiniteLight",
    "UnknownAttribute",
    "Vegas",
    "VegasSobol",
    "warp",
    "ZScores",
]

strict(*METHODS.values(), Distribution, Domain, Technique, AdaptiveMap, Spectrum, warp.Warp)
