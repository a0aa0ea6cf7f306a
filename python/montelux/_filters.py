"""Pixel filters by their names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Union

from ._core import BoxFilter, Error, GaussianFilter, LanczosFilter, MitchellFilter, TriangleFilter
from ._names import unknown

PixelFilter = Union[BoxFilter, TriangleFilter, GaussianFilter, MitchellFilter, LanczosFilter]

_FILTERS: dict[str, type[PixelFilter]] = {
    "box": BoxFilter,
    "triangle": TriangleFilter,
    "gaussian": GaussianFilter,
    "mitchell": MitchellFilter,
    "lanczos": LanczosFilter,
}


def pixel_filter(name: str, radius: float | Sequence[float] | None = None, **settings: float) -> PixelFilter:
    """The pixel filter 'box', 'triangle', 'gaussian', 'mitchell' or 'lanczos'.

    radius: half width, or half width and half height, in pixels; None: that of scene files. Settings: sigma of
    'gaussian', b and c of 'mitchell', tau of 'lanczos'. It has value(offsets) and sample(u), and can be set as
    `scene.film.filter`.
    """
    if name not in _FILTERS:
        raise Error("pixel_filter: " + unknown("filter", name, _FILTERS))
    made = _FILTERS[name](**settings)
    if radius is not None:
        made.radius = (radius, radius) if isinstance(radius, (int, float)) else (radius[0], radius[1])
    return made
