"""How far two pictures are apart, and whether their errors explain the distance."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Union

import numpy.typing as npt

from . import _core
from ._core import Error
from ._picture import Picture

Source = Union[Picture, "os.PathLike[str]", str, npt.ArrayLike, "tuple[npt.ArrayLike, npt.ArrayLike]"]


@dataclass(frozen=True)
class ChannelComparison:
    """Figures of one channel; `b` is the reference."""

    name: str
    mean_a: float
    mean_b: float
    #: mean_a / mean_b - 1.
    relative_mean_difference: float
    #: Standard error of mean_a - mean_b from the known errors; NaN without any.
    mean_difference_error: float
    rmse: float
    rel_mse: float


@dataclass(frozen=True)
class ZScores:
    """z = (a - b) / sqrt(error_a^2 + error_b^2) over pixels and channels."""

    count: int
    mean: float
    standard_deviation: float
    #: Shares of |z| <= 1, 2 and 3; of Gaussian errors 0.683, 0.954 and 0.997.
    within: tuple[float, float, float]
    largest: float
    equal_without_error: int
    unexplained: int
    invalid_errors: int


@dataclass(frozen=True, repr=False)
class Comparison:
    """What `compare` found. docs/images.md defines all figures."""

    channels: tuple[ChannelComparison, ...]
    #: Root of the mean of (a - b)^2 over pixels and channels.
    rmse: float
    #: Mean of (a - b)^2 / (b^2 + epsilon).
    rel_mse: float
    #: What both pictures have, x0, y0, x1, y1 (ends exclusive): of crops less than the whole.
    window: tuple[int, int, int, int]
    #: Compared, and left out as the noisiest or as not finite.
    pixels: int
    set_aside: int
    not_finite: int
    #: None where no errors are known.
    z: ZScores | None
    #: With errors pooled over 3 x 3 pixels: their mean is near 0 for unbiased pictures, however skewed.
    z_pooled: ZScores | None
    #: Corrected for the skewness of the samples, where that is known.
    z_skew_corrected: ZScores | None

    def __repr__(self) -> str:
        lines = ["channel        mean A        mean B     A/B - 1        RMSE      relMSE"]
        for c in self.channels:
            lines.append(
                f"{c.name:7} {c.mean_a:13.6g} {c.mean_b:13.6g} {100 * c.relative_mean_difference:10.4f}% "
                f"{c.rmse:11.5g} {c.rel_mse:11.5g}"
            )
        lines.append(f"RMSE {self.rmse:.6g}, relMSE {self.rel_mse:.6g}, {self.pixels} pixels")
        for name, z in (("z-scores", self.z), ("z-scores with pooled errors", self.z_pooled)):
            if z is not None:
                shares = ", ".join(f"{100 * share:.2f} %" for share in z.within)
                lines.append(
                    f"{name}: mean {z.mean:.4f}, standard deviation {z.standard_deviation:.4f}; within 1, 2, 3: {shares}"
                )
        return "\n".join(lines)


def _picture(source: Any, name: str) -> tuple[_core.Picture, str]:
    if isinstance(source, Picture):
        return _core.picture_of_snapshot(source._snapshot()), name
    if isinstance(source, (str, os.PathLike)):
        return _core.picture_of_file(os.fspath(source)), os.fspath(source)
    if isinstance(source, tuple):
        if len(source) != 2:
            raise Error(f"compare: a tuple of {len(source)} was given; expected (mean, standard error)")
        return _core.picture_of_arrays(source[0], source[1], name), name
    return _core.picture_of_arrays(source, None, name), name


def compare(a: Source, b: Source, *, epsilon: float = 0.01, set_aside: float = 0.0) -> Comparison:
    """Compares picture a with the reference b: renders, files, arrays of shape (h, w, 3) or (h, w), or pairs of
    arrays (mean, standard error). A crop is compared with the whole, and with other crops, where both have pixels:
    renders and .exr files know their place.

    epsilon: of the relative mean squared error, in squared units of the picture. set_aside: per cent of the
    pixels, those whose reference is the noisiest, that are left out.
    """
    found = _core.compare(*_picture(a, "picture a"), *_picture(b, "picture b"), epsilon, set_aside)
    found["channels"] = tuple(ChannelComparison(**c) for c in found["channels"])
    for name in ("z", "z_pooled", "z_skew_corrected"):
        if found[name] is not None:
            found[name] = ZScores(**found[name])
    return Comparison(**found)
