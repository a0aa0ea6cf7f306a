"""C5: sampling lights and materials together."""

from __future__ import annotations

import numpy as np

from .._figure import Figure, Outcome, Picture
from .._number import Number
from ..light import displayed, mean_luminance, rendered, same_mean

STRATEGIES = {
    "bsdf": ("directions of the material", None),
    "light": ("points on the lamps", None),
    "balance": ("both, balance heuristic", "balance"),
    "power": ("both, power heuristic", "power"),
}


def plates() -> Outcome:
    """The plates by each strategy at 4 samples per pixel, and by both strategies at 64."""
    many = rendered("plates", 64, seed=9)
    pictures, numbers = [], []
    for name, (caption, heuristic) in STRATEGIES.items():
        r = rendered("plates", 4, 1, "mis" if heuristic else name, heuristic or "power")
        pictures.append(Picture(f"{caption}, 4 samples per pixel", displayed(r.mean)))
        numbers.append(same_mean(f"{caption}: picture's mean against 64 samples", r, many))
    pictures.append(Picture("both, power heuristic, 64 samples per pixel", displayed(many.mean)))
    return Outcome(numbers, {}, pictures)


#: Red and green of Okabe and Ito (2008), which colour-blind readers can distinguish.
RED, GREEN = np.array([0.67, 0.11, 0.0]), np.array([0.0, 0.34, 0.17])  # linear


def weights() -> Outcome:
    """The two terms whose sum is the picture, 16 samples per pixel with one seed, as red and green."""
    both, bsdf, light = (rendered("plates", 16, 2, name) for name in ("mis", "mis-bsdf", "mis-light"))
    sums = np.asarray(bsdf.mean, dtype=float) + np.asarray(light.mean, dtype=float)
    apart = np.abs(sums - np.asarray(both.mean, dtype=float)).max() / np.asarray(both.mean).max()
    numbers = [Number("sum of the terms less the picture, farthest, over its maximum", apart, 1e-5, 0, bound=True)]
    many = rendered("plates", 16, 3)
    luminance = np.array([0.2126, 0.7152, 0.0722])
    means = [mean_luminance(r) for r in (bsdf, light, many)]
    # The terms share their samples: their errors add up at most.
    error = np.hypot(means[0][1] + means[1][1], means[2][1]) / means[2][0]
    numbers.append(
        Number("sum of the terms over a picture of another seed", (means[0][0] + means[1][0]) / means[2][0], error, 1)
    )
    red, green = (np.asarray(r.mean, dtype=float) @ luminance for r in (bsdf, light))
    pictures = [
        Picture(
            "red: found by directions of the material, green: by points on the lamps, each by its weight",
            displayed(red[..., None] * RED + green[..., None] * GREEN, 1.6),
        ),
        Picture("directions of the material alone, by their weight", displayed(bsdf.mean)),
        Picture("points on the lamps alone, by their weight", displayed(light.mean)),
    ]
    return Outcome(numbers, {}, pictures)


FIGURES = (
    Figure(
        "C5",
        "plates",
        "Four plates, four lamps",
        "Directions of the material find the large lamp in the smooth plates and miss the small one in the rough"
        " plates; points on the lamps do the reverse. Both together, weighted, are good everywhere. All are right on"
        " average.",
        (
            (
                r"w_i = \frac{p_i}{p_1 + p_2}\ \ \mathrm{(balance)}, \qquad w_i = \frac{p_i^2}{p_1^2 +"
                r" p_2^2}\ \ \mathrm{(power)}"
            ),
        ),
        plates,
        slow=True,
        alt="Five pictures of four plates that reflect four lamps",
    ),
    Figure(
        "C5",
        "weights",
        "Who finds the light",
        "The picture is the sum of two terms: the weighted light found by directions of the material, in red, and by"
        " points on the lamps, in green. Large lamps in smooth plates are red, small lamps in rough plates and on the"
        " walls are green. Lamps that the camera sees are red, since only directions find them.",
        (
            (
                r"\langle I \rangle = w_{bsdf}\,\frac{f\,L}{p_{bsdf}}"
                r" + w_{light}\,\frac{f\,L}{p_{light}}, \qquad w_i = \frac{p_i^2}{p_{bsdf}^2 + p_{light}^2}"
            ),
        ),
        weights,
        slow=True,
        alt="The plates in red and green by the strategy that found their light, and the two terms by themselves",
    ),
)
