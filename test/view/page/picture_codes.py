"""Codes of pixels that the page must display, and their comparison."""

from __future__ import annotations

import numpy as np

import tone_reference
from page_harness import Viewer


VIRIDIS = np.array([[int(c[i:i + 2], 16) for i in (0, 2, 4)] for c in (
    "440154 482475 414487 355f8d 2a788e 21918c 22a884 44bf70 7ad151 bddf26 fde725").split()])


def viridis(t: np.ndarray) -> np.ndarray:
    t = np.clip(t, 0, 1) * 10
    return np.stack([np.interp(t, np.arange(11), VIRIDIS[:, c]) for c in range(3)], -1)


def assert_close(found: np.ndarray, expected: np.ndarray, bound: float, what: str) -> None:
    difference = np.abs(np.asarray(found, float) - np.asarray(expected, float))
    worst = np.unravel_index(np.argmax(difference), difference.shape)
    assert difference.max() <= bound, (f"{what}: {difference.max():.3g} at {tuple(map(int, worst))}: "
                                       f"{found[worst]} instead of {expected[worst]}")


def mean_codes(v: Viewer, exposure: float = 0, tone: str = "srgb") -> np.ndarray:
    return tone_reference.codes(v.server.picture.layer("mean"), exposure, tone)
