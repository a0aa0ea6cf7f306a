"""C5: sampling lights and materials together."""

from __future__ import annotations

from .._figure import Figure, Outcome, Picture
from ..light import displayed, rendered, same_mean

STRATEGIES = {
    "bsdf": ("directions of the material", None),
    "light": ("points on the lamps", None),
    "balance": ("both, balance heuristic", "balance"),
    "power": ("both, power heuristic", "power"),
}


def plates() -> Outcome:
    """The plates by each strategy at 4 samples a pixel, and by both strategies at 64."""
    many = rendered("plates", 64, seed=9)
    pictures, numbers = [], []
    for name, (caption, heuristic) in STRATEGIES.items():
        r = rendered("plates", 4, 1, "mis" if heuristic else name, heuristic or "power")
        pictures.append(Picture(f"{caption}, 4 samples a pixel", displayed(r.mean)))
        numbers.append(same_mean(f"{caption}: picture's mean against 64 samples", r, many))
    pictures.append(Picture("both, power heuristic, 64 samples a pixel", displayed(many.mean)))
    return Outcome(numbers, {}, pictures)


FIGURES = (
    Figure(
        "C5",
        "plates",
        "Four plates, four lamps",
        "Directions of the material find the large lamp in the smooth plates and miss the small one in the rough"
        " plates; points on the lamps do the reverse. Both together, each believed where it is good, are good"
        " everywhere; all are right on average.",
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
)
