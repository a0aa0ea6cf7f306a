"""Pictures of the lab's own scenes."""

from __future__ import annotations

from importlib import resources
from typing import Any

import numpy as np

import montelux

from ._number import Number


def scene(name: str) -> Any:
    """A scene of the lab, as it was read."""
    with resources.as_file(resources.files(__package__) / "scenes" / f"{name}.pbrt") as path:
        return montelux.load(path)


def rendered(which: Any, samples: int, seed: int, strategy: str = "mis", heuristic: str = "power") -> Any:
    """A render of a scene, by its name or as it is, which has ended."""
    s = scene(which) if isinstance(which, str) else which
    s.integrator.strategy, s.integrator.heuristic = strategy, heuristic
    return s.render(spp=samples, seed=seed).wait()


def displayed(linear: Any, exposure: float = 1.0) -> Any:
    """sRGB values in [0, 1] of linear ones; what is brighter than white is rolled off, hue kept."""
    v = np.maximum(np.asarray(linear, dtype=float) * exposure, 0)
    peak = v.max(axis=-1, keepdims=True)
    # The identity up to 0.7, then ever flatter towards 1.
    rolled = np.where(peak > 0.7, 1 - 0.3 * np.exp(-(np.maximum(peak, 0.7) - 0.7) / 0.3), peak)
    v = v * np.divide(rolled, peak, out=np.ones_like(peak), where=peak > 0)
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * np.maximum(v, 1e-9) ** (1 / 2.4) - 0.055)


def luminance(linear: Any) -> Any:
    """Of linear sRGB; of standard errors too, for the channels of a pixel share their samples: their errors add up."""
    return np.asarray(linear, dtype=float) @ np.array([0.2126, 0.7152, 0.0722])


def mean_luminance(render: Any) -> tuple[float, float]:
    """Of a picture whose pixels are independent, with its standard error."""
    mean, error = luminance(render.mean), luminance(render.standard_error)
    return float(mean.mean()), float(np.sqrt((error**2).sum())) / mean.size


def same_mean(name: str, a: Any, b: Any) -> Number:
    """The difference of two pictures' means over that of the second one, which should be nothing."""
    (va, ea), (vb, eb) = mean_luminance(a), mean_luminance(b)
    return Number(name, va / vb - 1, float(np.hypot(ea, eb)) / vb, 0.0)
