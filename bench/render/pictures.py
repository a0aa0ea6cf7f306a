"""Pictures as arrays (height, width, 3), and how far one is from another."""

from __future__ import annotations

from pathlib import Path
from typing import List, Tuple

import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear sRGB
TRIMMED = 0.001  # the share of the pixels, the worst ones, that the trimmed error leaves out


def read_pfm(path: Path) -> np.ndarray:
    with open(path, "rb") as file:
        if file.readline().strip() != b"PF":
            raise ValueError(f"{path} is no colour PFM file")
        width, height = (int(n) for n in file.readline().split())
        order = "<" if float(file.readline()) < 0 else ">"
        pixels = np.frombuffer(file.read(), order + "f4", width * height * 3)
    return pixels.reshape(height, width, 3)[::-1].astype(float)


def relative_errors(picture: np.ndarray, reference: np.ndarray) -> Tuple[float, float]:
    """relMSE = mean of (I - R)^2 / (R^2 + 0.01 mean(R)^2), of all pixels and without the worst of them."""
    squared = (picture - reference) ** 2 / (reference**2 + 0.01 * reference.mean() ** 2)
    each = np.sort(squared.mean(-1).ravel())
    return float(each.mean()), float(each[: len(each) - int(TRIMMED * len(each))].mean())


class Reference:
    """The mean of independent pictures, and its mean luminance with a standard error."""

    def __init__(self, parts: List[np.ndarray]) -> None:
        self.pixels = np.mean(parts, axis=0)
        luminances = [float((part @ LUMINANCE).mean()) for part in parts]
        self.luminance = float(np.mean(luminances))
        self.error = float(np.std(luminances, ddof=1) / len(parts) ** 0.5) if len(parts) > 1 else float("nan")
