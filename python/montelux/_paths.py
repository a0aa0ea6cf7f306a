"""Looking into a picture: what each strategy brings to it, and where chains of paths walk."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ._names import UnknownAttribute, unknown
from ._result import Array

Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True, repr=False, eq=False)
class StrategyPicture:
    """What one strategy of bidirectional path tracing brings to a picture (`Scene.strategy_pictures`): linear sRGB,
    shape (height, width, 3)."""

    #: Vertices of its paths on the light's side, ...
    s: int
    #: ... and on the camera's.
    t: int
    #: Of paths weighted among all strategies that find them: these pictures of all strategies add up to the render.
    weighted: Array
    #: As if it were the only strategy: all that can find paths of s + t vertices estimate the same picture.
    unweighted: Array

    def __repr__(self) -> str:
        height, width = self.weighted.shape[:2]
        return f"<StrategyPicture: s = {self.s}, t = {self.t}, {width} x {height} pixels>"

    def __getattr__(self, name: str) -> Any:
        raise _unknown(self, name)


@dataclass(frozen=True, repr=False, eq=False)
class PathChains:
    """Walks of the chains of a Metropolis render over its film (`Scene.path_chains`)."""

    #: Where the states of the chains lie on the film, in pixels: shape (chains, steps + 1, 2), each state as often as
    #: the chain stayed there.
    film: Array
    #: What chains follow, of these: the brightness of the path over that of its part of a coarse picture; shape
    #: (chains, steps + 1).
    size: Array
    #: Where the proposed states lie: shape (chains, steps, 2).
    proposed: Array
    #: What chains follow, of these: shape (chains, steps).
    proposed_size: Array
    #: Which steps drew all numbers of a path anew.
    large: Flags
    #: The probabilities with which the steps are accepted, ...
    acceptance: Array
    #: ... and which were.
    accepted: Flags

    @classmethod
    def of(cls, trace: Mapping[str, Any]) -> PathChains:
        """From the points of the film that were proposed."""
        accepted = trace["accepted"] != 0
        chains, steps = accepted.shape
        # The last step up to each that was accepted; 0: the start.
        at = np.maximum.accumulate(np.where(accepted, np.arange(1, steps + 1), 0), axis=1)
        at = np.concatenate([np.zeros((chains, 1), dtype=at.dtype), at], axis=1)
        film = np.concatenate([trace["start"][:, None], trace["proposed"]], axis=1)
        size = np.concatenate([trace["start_size"][:, None], trace["size"]], axis=1)
        return cls(
            np.take_along_axis(film, at[..., None], axis=1),
            np.take_along_axis(size, at, axis=1),
            trace["proposed"],
            trace["size"],
            trace["large"] != 0,
            trace["acceptance"],
            accepted,
        )

    def __repr__(self) -> str:
        chains, steps = self.accepted.shape
        mean = f", {100 * self.accepted.mean():.0f} % accepted" if self.accepted.size else ""
        return f"<PathChains: {chains} chain{'s' if chains != 1 else ''} of {steps} steps{mean}>"

    def __getattr__(self, name: str) -> Any:
        raise _unknown(self, name)


def _unknown(value: Any, name: str) -> AttributeError:
    if name.startswith("__"):
        return AttributeError(name)
    return UnknownAttribute(unknown(f"attribute of {type(value).__name__}", name, type(value).__dataclass_fields__))
