"""The tone curves of montelux/image/tone_curve.cpp in double precision."""

from __future__ import annotations

import numpy as np

TONES = ["linear", "srgb", "aces", "agx", "filmic"]

ACES_IN = np.array([[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]])
ACES_OUT = np.array([[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]])
AGX_IN = np.array([[0.842479062253094, 0.0784335999999992, 0.0792237451477643],
                   [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
                   [0.0423756549057051, 0.0784336, 0.879142973793104]])
AGX_OUT = np.array([[1.19687900512017, -0.0980208811401368, -0.0990297440797205],
                    [-0.0528968517574562, 1.15190312990417, -0.0989611768448433],
                    [-0.0529716355144438, -0.0980434501171241, 1.15107367264116]])


def encoded(v: np.ndarray) -> np.ndarray:
    c = np.clip(v, 0, 1)
    return np.where(c <= 0.04045 / 12.92, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


def aces(light: np.ndarray) -> np.ndarray:
    v = light @ ACES_IN.T
    fit = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081)
    return encoded(fit @ ACES_OUT.T)


def agx(light: np.ndarray) -> np.ndarray:
    least, most = -12.47393, 4.026069
    with np.errstate(divide="ignore"):
        x = (np.clip(np.log2(light @ AGX_IN.T), least, most) - least) / (most - least)
    contrast = np.polynomial.polynomial.polyval(x, [-0.00232, 0.1191, 0.4298, -6.868, 31.96, -40.14, 15.5])
    return encoded(np.clip(contrast @ AGX_OUT.T, 0, 1) ** 2.2)


def filmic(light: np.ndarray) -> np.ndarray:
    a, b, c, d, e, f = 0.15, 0.50, 0.10, 0.20, 0.02, 0.30

    def curve(x: np.ndarray) -> np.ndarray:
        return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f

    return encoded(curve(2 * light) / curve(np.float64(11.2)))


def codes(rgb: np.ndarray, exposure: float, tone: str) -> np.ndarray:
    """8-bit codes of linear light, which may contain NaN, negative and infinite components."""
    with np.errstate(invalid="ignore"):
        light = np.where(rgb > 0, np.minimum(rgb.astype(np.float64) * 2.0 ** exposure, 1e9), 0)
    curve = {"linear": lambda v: np.clip(v, 0, 1), "srgb": encoded, "aces": aces, "agx": agx, "filmic": filmic}[tone]
    return np.floor(curve(light) * 255 + 0.5).astype(int)
