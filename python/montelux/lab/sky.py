"""A map of the lab's own to light by, and rough mirrors that reflect it."""

from __future__ import annotations

from typing import Any

import numpy as np

HEIGHT = 128
#: The direction of the sun, the cosine of its radius (two degrees), its radiance.
SUN = np.array([np.sin(0.9) * np.cos(2.0), np.sin(0.9) * np.sin(2.0), np.cos(0.9)])
SUN_COSINE = float(np.cos(0.035))
SUN_RADIANCE = (420.0, 360.0, 260.0)


def sky(height: int = HEIGHT) -> Any:
    """A sky that pales towards the horizon and the sun, a warm lamp, dim ground: shape (height, 2 height, 3).

    Latitude-longitude; each pixel has the value of the formula at its middle.
    """
    theta = np.pi * (np.arange(height)[:, None] + 0.5) / height
    phi = np.pi * (np.arange(2 * height) + 0.5) / height
    w = np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), axis=-1)
    up, to_sun = w[..., 2:], (w @ SUN)[..., None]
    zenith, horizon, ground = (np.array(c) for c in ((0.10, 0.22, 0.55), (0.65, 0.72, 0.80), (0.10, 0.09, 0.07)))
    light = zenith + (horizon - zenith) * np.exp(-3.5 * np.maximum(up, 0)) + 1.5 * np.maximum(to_sun, 0) ** 24
    light = np.where(up > 0, light, ground)
    x, y = (phi - 5.0) / 0.3, (theta - 1.3) / 0.2
    lamp = (0.08 + 0.92 * (1 - x**2) * (1 - y**2))[..., None] * np.array([17.0, 10.0, 5.0])
    light = np.where(((np.abs(x) < 1) & (np.abs(y) < 1))[..., None], lamp, light)
    return np.where(to_sun > SUN_COSINE, np.array(SUN_RADIANCE), light)


def sun_pixels(image: Any) -> Any:
    """Where a map of `sky` shows the sun, shape (height, width)."""
    return image[..., 0] == SUN_RADIANCE[0]


def parts_of_pixels(image: Any, n: int) -> Any:
    """The middles of n x n parts of each pixel of a map, places in pixels: equal solid angles within a pixel."""
    y, x = ((np.arange(count * n) + 0.5) / n for count in image.shape[:2])
    return np.stack(np.meshgrid(x, y), axis=-1)


def smith(w: Any, alpha: float) -> Any:
    """Lambda of directions, shape (..., 3) (Walter et al. 2007, equation 34): G1 = 1 / (1 + Lambda)."""
    cosine = np.maximum(w[..., 2], 1e-6)
    return 0.5 * (np.sqrt(1 + alpha**2 * (1 - cosine**2) / cosine**2) - 1)


def rough_mirror(v: Any, l: Any, alpha: float) -> Any:  # noqa: E741
    """f n.l of facets that reflect everything, GGX with height-correlated masking; directions around +z."""
    h = v + l
    h = h / np.linalg.norm(h, axis=-1, keepdims=True)
    d = alpha**2 / (np.pi * ((alpha**2 - 1) * h[..., 2] ** 2 + 1) ** 2)
    reflected = d / (1 + smith(v, alpha) + smith(l, alpha)) / (4 * v[2])
    return np.where(l[..., 2] > 0, reflected, 0)


def axes_of(normal: Any) -> Any:
    """Rows x, y and z of a frame with this normal as z: axes @ w is w as the surface sees it."""
    n = np.asarray(normal) / np.linalg.norm(normal)
    x = np.cross([0.0, 1.0, 0.0], n)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(n, x), n])


def side_by_side(pictures: Any) -> Any:
    """Square pictures of one size in a row with gaps of a twelfth of it, through which the paper is seen."""
    height = pictures[0].shape[0]
    scale = -(-12 // height)  # gaps are whole pixels
    pictures = [p.repeat(scale, axis=0).repeat(scale, axis=1) for p in pictures]
    height *= scale
    gap = np.zeros((height, height // 12, 4))
    opaque = [p if p.shape[-1] == 4 else np.concatenate([p, np.ones((height, height, 1))], axis=-1) for p in pictures]
    return np.concatenate([part for p in opaque for part in (p, gap)][:-1], axis=1)


def show(axes: Any, picture: Any) -> None:
    """A picture on bare axes, whose units are its pixels."""
    height, width = picture.shape[:2]
    axes.imshow(picture, extent=(0, width, height, 0), interpolation="nearest", aspect="equal")
    axes.set(xticks=[], yticks=[], xlim=(0, width), ylim=(height, 0))
    for side in axes.spines.values():
        side.set_visible(False)
