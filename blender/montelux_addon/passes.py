# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of Blender and the channels of the program's file they are made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np

from .run.exr import ExrPicture


def _as_it_is(values: np.ndarray) -> np.ndarray:
    return values


def _to_blender(values: np.ndarray) -> np.ndarray:
    """Vectors of glTF's world (y up) in Blender's (z up)."""
    return np.stack([values[..., 0], -values[..., 2], values[..., 1]], axis=-1)


@dataclass(frozen=True)
class Pass:
    name: str
    components: str  # Blender's ids of the channels
    kind: str  # of RenderEngine.register_pass
    layer: str  # of the program's --layers
    channels: tuple[str, ...]
    convert: Callable[[np.ndarray], np.ndarray] = _as_it_is


_BY_SETTING = {
    "use_error": Pass("Standard Error", "RGB", "COLOR", "error", ("stderr.R", "stderr.G", "stderr.B")),
    "use_samples": Pass("Samples", "X", "VALUE", "samples", ("samples",)),
    "use_albedo": Pass("Albedo", "RGB", "COLOR", "albedo", ("albedo.R", "albedo.G", "albedo.B")),
    "use_normal": Pass("Normal", "XYZ", "VECTOR", "normal", ("N.X", "N.Y", "N.Z"), _to_blender),
    "use_distance": Pass("Distance", "X", "VALUE", "depth", ("depth.Z",)),
}
NOISY = Pass("Noisy", "RGBA", "COLOR", "mean", ("R", "G", "B"))


def passes_of(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> list[Pass]:
    """Beside Combined."""
    chosen = [p for setting, p in _BY_SETTING.items() if getattr(view_layer.montelux, setting)]
    return chosen + ([NOISY] if scene.montelux.denoise else [])


def layers_for(passes: list[Pass]) -> tuple[str, ...]:
    """The program's layers. The denoiser asks for albedo and normal itself."""
    return tuple(dict.fromkeys(["mean", *(p.layer for p in passes)]))


def combined_of(picture: ExrPicture) -> np.ndarray:
    """RGBA in linear light, multiplied by alpha as Blender's pictures are; denoised where that is there."""
    colour = picture.stack("denoised.R", "denoised.G", "denoised.B")
    if colour is None:
        colour = picture.stack("R", "G", "B")
    if colour is None:
        colour = np.repeat(picture.channels["Y"][..., None], 3, axis=-1)
    return with_alpha(colour, picture.channels.get("A"))


def with_alpha(colour: np.ndarray, alpha: np.ndarray | None = None) -> np.ndarray:
    rgba = np.ones((*colour.shape[:2], 4), np.float32)
    rgba[..., :3] = colour
    if alpha is not None:
        rgba[..., 3] = alpha
    return rgba


def values_of(shown: Pass, picture: ExrPicture) -> np.ndarray | None:
    values = picture.stack(*shown.channels)
    if values is None:
        return None
    if shown is NOISY:
        return with_alpha(values, picture.channels.get("A"))
    return shown.convert(values)
