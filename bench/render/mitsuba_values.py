"""The parts of a converted scene that depend on Mitsuba's variant: matrices, pictures, environments, free colours."""

from __future__ import annotations

from typing import Any, Dict

import numpy as np

from mitsuba_textures import EQUAL_AREA_MAP, PICTURE, UNBOUNDED


def equal_area_coordinates(direction: np.ndarray) -> np.ndarray:
    """Clarberg's map of the sphere onto the unit square, as in pbrt-v4: directions (..., 3) to points (..., 2)."""
    x, y, z = np.moveaxis(np.abs(direction), -1, 0)
    r = np.sqrt(np.maximum(0, 1 - z))
    phi = np.arctan2(np.minimum(x, y), np.maximum(np.maximum(x, y), 1e-30)) * 2 / np.pi
    phi = np.where(x < y, 1 - phi, phi)
    v, u = phi * r, r - phi * r
    below = direction[..., 2] < 0
    u, v = np.where(below, 1 - v, u), np.where(below, 1 - u, v)
    square = np.stack([np.copysign(u, direction[..., 0]), np.copysign(v, direction[..., 1])], -1)
    return (square + 1) / 2


def latitude_longitude(square: np.ndarray, oversampling: int = 2) -> np.ndarray:
    """A square map (n, n, channels) as one of n x 2n whose rows go from +y down, its columns from -z towards +x."""
    n = square.shape[0]
    rows, columns = (np.arange(k * oversampling) + 0.5 for k in (n, 2 * n))
    theta, phi = np.meshgrid(rows * np.pi / len(rows), columns * 2 * np.pi / len(columns), indexing="ij")
    direction = np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)], -1)
    at = np.minimum((equal_area_coordinates(direction) * n).astype(int), n - 1)
    fine = square[at[..., 1], at[..., 0]]
    return fine.reshape(n, oversampling, 2 * n, oversampling, -1).mean((1, 3)).astype(np.float32)


class Values:
    """Fills in a converted scene for the variant that is set."""

    def __init__(self, mi: Any) -> None:
        self.mi = mi

    def fill(self, value: Any) -> Any:
        if isinstance(value, np.ndarray):
            kind = self.mi.ScalarTransform4f if value.shape == (4, 4) else self.mi.ScalarTransform3f
            return kind(value.tolist())
        if not isinstance(value, dict):
            return value
        special = {PICTURE: self.picture, EQUAL_AREA_MAP: self.environment, UNBOUNDED: self.unbounded}
        if value.get("type") in special:
            return special[value["type"]](value)
        return {key: self.fill(v) for key, v in value.items()}

    def bitmap(self, file: str) -> Any:
        """Many TGA files lack the footer by which Mitsuba recognises the format."""
        if file.lower().endswith(".tga"):
            return self.mi.Bitmap(file, self.mi.Bitmap.FileFormat.TGA)
        return self.mi.Bitmap(file)

    def picture(self, value: Dict[str, Any]) -> Dict[str, Any]:
        bitmap = self.bitmap(value["filename"])
        if value["linear"]:
            bitmap.set_srgb_gamma(False)
        out = {"type": "bitmap", "wrap_mode": value["wrap_mode"], "to_uv": self.fill(value["to_uv"])}
        if not value["invert"] and value["scale"] == [1, 1, 1]:
            return {**out, "bitmap": bitmap}
        linear = bitmap.convert(self.mi.Bitmap.PixelFormat.RGB, self.mi.Struct.Type.Float32, False)
        pixels = np.array(linear) * np.array(value["scale"], dtype=np.float32)
        pixels = np.maximum(1 - pixels if value["invert"] else pixels, 0)
        return {**out, "bitmap": self.mi.Bitmap(pixels.astype(np.float32))}

    def environment(self, value: Dict[str, Any]) -> Dict[str, Any]:
        bitmap = self.bitmap(value["filename"])
        pixels = np.array(bitmap.convert(self.mi.Bitmap.PixelFormat.RGB, self.mi.Struct.Type.Float32, False))
        to_world = value["to_world"]
        if pixels.shape[0] == pixels.shape[1]:
            pixels = latitude_longitude(pixels)
        else:  # rows from +z down, columns from +x towards +y
            to_world = to_world @ np.array([[0, 0, -1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
        return {
            "type": "envmap",
            "bitmap": self.mi.Bitmap(pixels),
            "scale": value["scale"],
            "to_world": self.fill(to_world),
        }

    def unbounded(self, value: Dict[str, Any]) -> Dict[str, Any]:
        """A colour above 1. Spectral variants clamp those of the type rgb, so they get the curve that pbrt-v4 makes:
        that of the colour scaled to a maximum of 1/2, scaled back."""
        color = np.array(value["value"], dtype=float)
        if not self.mi.is_spectral or color.max() <= 0:
            return {"type": "rgb", "value": color.tolist()}
        scale, wavelengths = 2 * color.max(), np.arange(360, 831, 5)
        coefficients = np.ravel(self.mi.srgb_model_fetch(self.mi.ScalarColor3f(*(color / scale).tolist())))
        x = np.polyval(coefficients.astype(float), wavelengths)
        values = scale * (0.5 + x / (2 * np.sqrt(1 + x * x)))
        listed = ", ".join(f"{v:.9g}" for v in values)
        return {"type": "regular", "wavelength_min": 360.0, "wavelength_max": 830.0, "values": listed}
