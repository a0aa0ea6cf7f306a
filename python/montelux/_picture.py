"""Pictures as arrays, with their errors."""

from __future__ import annotations

import math
import os
import struct
import zlib
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from . import _core
from ._names import UnknownAttribute, unknown

Pixels = npt.NDArray[np.float32]
Tone = Literal["linear", "srgb", "aces", "agx", "filmic"]


def png_bytes(pixels: npt.NDArray[np.uint8]) -> bytes:
    """A PNG file of 8-bit pixels, shape (h, w, 3) or (h, w, 1) (PNG specification, second edition, W3C 2003)."""
    height, width, channels = pixels.shape
    rows = np.zeros((height, 1 + width * channels), np.uint8)  # each row begins with its filter, 0: none
    rows[:, 1:] = pixels.reshape(height, -1)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 3: 2}[channels], 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"sRGB", b"\0")
        + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6))
        + chunk(b"IEND", b"")
    )


class Picture:
    """A render as it was at some moment. Arrays are float32, linear sRGB, row 0 at the top; they share the
    memory of the picture and cannot be written to."""

    def __init__(self, snapshot: _core.RenderSnapshot) -> None:
        self._held: _core.RenderSnapshot | None = snapshot
        self._made: Mapping[str, Pixels] | None = None

    def _snapshot(self) -> _core.RenderSnapshot:
        assert self._held is not None
        return self._held

    @property
    def mean(self) -> Pixels:
        """The picture, shape (height, width, 3)."""
        return self.layers["mean"]

    @property
    def standard_error(self) -> Pixels:
        """One standard deviation of each number of `mean`; infinite where it is not known yet."""
        return self.layers["standard_error"]

    @property
    def layers(self) -> Mapping[str, Pixels]:
        """All layers by name: 'mean', 'standard_error', 'skewness' (of the mean), 'albedo' and 'normal' of the
        first surface, of shape (h, w, 3); 'samples', 'replicates' (independent parts that the error is made of),
        'outlier', 'warning' (0 where the error can be relied on; docs/images.md) and 'depth', of shape (h, w). Where it
        was asked for also 'denoised', which `standard_error` does not hold for. `scene.film.layers` chooses others:
        'position', 'uv', 'direct', 'light.NAME' ...; 'shape' and 'material' have six pairs of id and coverage. With
        `scene.film.spectral`, 'spectral' and 'spectral_standard_error' have shape (h, w, buckets)."""
        if self._made is None:
            self._made = MappingProxyType(self._snapshot().layers)
        return self._made

    @property
    def relative_error(self) -> float:
        """Root mean square of the standard errors of luminance, over the mean luminance of the picture."""
        return self._snapshot().relative_error

    @property
    def spp(self) -> float:
        """Samples per pixel, on average."""
        return self._snapshot().mean_samples

    @property
    def seconds(self) -> float:
        """Wall time of the rendering."""
        return self._snapshot().seconds

    @property
    def cpu_seconds(self) -> float:
        """CPU time of the rendering, of all threads together."""
        return self._snapshot().cpu_seconds

    @property
    def bad_samples(self) -> int:
        """Samples that were NaN, infinite or negative: left out as zeros."""
        return self._snapshot().bad_samples

    def to_srgb(self, exposure: float | Literal["auto"] | None = None, tone: Tone = "srgb") -> npt.NDArray[np.uint8]:
        """8-bit codes for a screen, shape (height, width, 3): light times 2**exposure through a tone curve
        (docs/images.md); of the denoised picture, where there is one.
        "auto" or None: the exposure that suits the picture."""
        snapshot = self._snapshot()
        stops = snapshot.automatic_exposure() if exposure is None or exposure == "auto" else exposure
        data, height, width, channels = snapshot.screen(stops, tone)
        return np.frombuffer(data, np.uint8).reshape(height, width, channels)

    def visible_error(self, exposure: float | Literal["auto"] = 0.0, tone: Tone = "srgb") -> float | None:
        """Share of the pixels whose standard error of luminance changes their 8-bit code by at least 1: where noise
        shows. None where the picture has no standard errors."""
        snapshot = self._snapshot()
        stops = snapshot.automatic_exposure() if exposure == "auto" else exposure
        return snapshot.visible_error(stops, tone)

    def save(
        self,
        path: str | os.PathLike[str],
        exposure: float | Literal["auto"] = 0.0,
        tone: Tone = "srgb",
        quality: int = 95,
    ) -> None:
        """Writes .exr (all layers), .png, .jpg, .hdr or .pfm (the denoised picture, where there is one), whole or not
        at all; exposure (stops, or "auto"), the tone curve (docs/images.md) and the quality (1 to 100, .jpg) are for
        .png and .jpg. Header entries of .exr are those that `montelux render` writes."""
        snapshot = self._snapshot()
        stops = snapshot.automatic_exposure() if exposure == "auto" else exposure
        snapshot.save(os.fspath(path), stops, tone, quality)

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return np.array(self.mean, dtype=dtype)

    def _repr_png_(self) -> bytes:
        return png_bytes(self.to_srgb(0.0))

    def __repr__(self) -> str:
        height, width = self.mean.shape[:2]
        known = math.isfinite(self.relative_error)
        error = f"relative error {100 * self.relative_error:.3g} %" if known else "error not known yet"
        return (
            f"<{type(self).__name__}: {width} x {height} pixels, {self.spp:.7g} samples per pixel, "
            f"{error}, {self.seconds:.3g} s>"
        )

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        known = [n for n in dir(type(self)) if not n.startswith("_")]
        raise UnknownAttribute(unknown(f"attribute of {type(self).__name__}", name, known))
