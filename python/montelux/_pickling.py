"""Pickle and copy of the compiled classes: each is made again by the constructor that made it.

Classes with a __dict__ note there what they were made from, as `_recipe`: the name of the method that makes them
(None: the class), its arguments, and its named ones. Constructors in C++ note theirs (python/src/recipe.h).
"""

from __future__ import annotations

import copyreg
from collections.abc import Callable
from functools import wraps
from typing import Any

import numpy as np

from . import _core
from ._integrate import METHODS
from ._names import settings_of
from ._regions import Region, as_region


def _kept(argument: Any) -> Any:
    """An argument that its owner cannot change any more; functions and objects of the library are shared."""
    if isinstance(argument, np.ndarray):
        return argument.copy()
    if isinstance(argument, (list, tuple)):
        return tuple(_kept(item) for item in argument)
    return argument


def note_recipes(kind: type, functions: tuple[str, ...], methods: tuple[str, ...] = ()) -> None:
    """Makes static functions and methods of a class note in each object how it was made."""

    def noting(name: str) -> Callable[..., Any]:
        function = getattr(kind, name)

        @wraps(function, updated=())
        def make(*arguments: Any, **named: Any) -> Any:
            made = function(*arguments, **named)
            vars(made)["_recipe"] = (name, _kept(arguments), {n: _kept(a) for n, a in named.items()})
            return made

        return make

    for name in functions:
        setattr(kind, name, staticmethod(noting(name)))
    for name in methods:
        setattr(kind, name, noting(name))


def _made_again(kind: type, maker: str | None, arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
    return (getattr(kind, maker) if maker else kind)(*arguments, **named)


def _reduced(made: Any) -> tuple[Any, ...]:
    kind = type(made)
    maker, arguments, named = getattr(made, "__dict__", {}).get("_recipe", (None, (), {}))
    settings = {name: getattr(made, name) for name in settings_of(kind)}
    return _made_again, (kind, maker, arguments, {**named, **settings})


def _reduced_map(grid: _core.AdaptiveMap) -> tuple[Any, ...]:
    return _core.AdaptiveMap, ([grid.edges(variable) for variable in range(grid.dimensions)],)


def _reduced_density(density: _core.TrainedDensity) -> tuple[Any, ...]:
    return _density_again, (density._bytes(), getattr(density, "_region", None))


def _density_again(content: bytes, region: Region | None) -> _core.TrainedDensity:
    density = _core.TrainedDensity._from_bytes(content, region and region.domain)
    density._region = region  # type: ignore[attr-defined]
    return density


def _note_domain(load: Callable[..., _core.TrainedDensity]) -> Callable[..., _core.TrainedDensity]:
    """TrainedDensity.load that keeps the domain, with which the density is pickled."""

    @wraps(load, updated=())
    def loading(path: str, domain: _core.Domain | None = None) -> _core.TrainedDensity:
        density = load(path, domain)
        density._region = None if domain is None else as_region(domain)  # type: ignore[attr-defined]
        return density

    return loading


def make_picklable(*kinds: type) -> None:
    """Registers classes of the extension with pickle and copy."""
    for kind in kinds:
        copyreg.pickle(kind, _reduced)


FAMILIES = (
    "uniform",
    "normal",
    "log_normal",
    "exponential",
    "gamma",
    "chi_squared",
    "beta",
    "cauchy",
    "student_t",
    "laplace",
    "logistic",
    "pareto",
    "power_law",
    "weibull",
    "triangular",
    "linear",
    "quadratic",
    "cosine",
    "ggx_angle",
)

note_recipes(_core.Domain, ("box", "unit_cube", "simplex", "ball", "sphere", "product", "mapped"))
note_recipes(_core.Technique, ("functions", "uniform"))
note_recipes(
    _core.Distribution,
    ("from_density", "tabulated", "piecewise_constant", "mixture", *FAMILIES),
    ("truncated", "scaled"),
)
make_picklable(_core.Domain, _core.Technique, _core.Distribution, _core.Discrete, _core.AliasTable, *METHODS.values())
copyreg.pickle(_core.AdaptiveMap, _reduced_map)
copyreg.pickle(_core.TrainedDensity, _reduced_density)
setattr(_core.TrainedDensity, "load", staticmethod(_note_domain(_core.TrainedDensity.load)))
