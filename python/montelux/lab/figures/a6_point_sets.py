"""A6: low-discrepancy point sets beside random ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number
from ..marks import square

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

PLAIN = {
    "independent": "random",
    "halton": "Halton",
    "hammersley": "Hammersley",
    "sobol": "Sobol'",
    "golden_ratio": "golden ratio",
    "weyl": "Weyl",
}
RANDOMISED = {
    ("halton", "digit_permutation"): "Halton, permuted",
    ("halton", "scramble"): "Halton, scrambled",
    ("hammersley", "scramble"): "Hammersley, scr.",
    ("sobol", "scramble"): "Sobol', scrambled",
    ("golden_ratio", "shift"): "golden, shifted",
    ("weyl", "shift"): "Weyl, shifted",
}


def counted_discrepancy(points):  # type: ignore[no-untyped-def]
    """From the definition: every box whose corner takes its coordinates from the points or 1, open and closed."""
    x, y = (np.append(points[:, k], 1.0)[:, None] for k in (0, 1))
    volume = x * y.T
    open_ = (points[:, 0] < x).astype(float) @ (points[:, 1] < y).T.astype(float) / len(points)
    closed = (points[:, 0] <= x).astype(float) @ (points[:, 1] <= y).T.astype(float) / len(points)
    return max((volume - open_).max(), (closed - volume).max())


def plain() -> Outcome:
    """256 points of each set; the library's star discrepancies beside those counted box by box."""
    sets = {name: montelux.points(name, 256, 2) for name in PLAIN}
    numbers = [
        Number(
            f"star discrepancy, {PLAIN[name]}", montelux.star_discrepancy(x), 1e-12, counted_discrepancy(x), bound=True
        )
        for name, x in sets.items()
    ]
    corput = montelux.points("halton", 256, 1)[:, 0]
    numbers.append(
        Number(
            "van der Corput, one dimension",
            montelux.star_discrepancy(corput),
            1e-15,
            1 / 256,
            bound=True,
            formula="1/256",
        )
    )
    return Outcome(numbers, {"sets": sets, "names": PLAIN, "discrepancies": [n.measured for n in numbers]})


def randomised() -> Outcome:
    """The same with a random shift, permuted digits or scrambled digits: uniform each, and as even."""
    sets = {key: montelux.points(key[0], 256, 2, key[1], seed=6) for key in RANDOMISED}
    numbers = [
        Number(
            f"star discrepancy, {RANDOMISED[key]}",
            montelux.star_discrepancy(x),
            1e-12,
            counted_discrepancy(x),
            bound=True,
        )
        for key, x in sets.items()
    ]
    # Unbiased: one point alone, over many seeds, is uniform on the square.
    seeds = 2000
    for key, name in RANDOMISED.items():
        first = np.array([montelux.points(key[0], 8, 2, key[1], seed=s)[5].prod() for s in range(seeds)])
        numbers.append(
            Number(f"mean of xy of one point, {name}", first.mean(), first.std() / np.sqrt(seeds), 0.25, formula="1/4")
        )
    return Outcome(numbers, {"sets": sets, "names": RANDOMISED, "discrepancies": [n.measured for n in numbers]})


def draw_sets(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplots(2, 3)
    for a, (key, x), discrepancy in zip(panels.flat, s["sets"].items(), s["discrepancies"]):
        square(a, theme)
        a.set_title(f"{s['names'][key]}\n$D^*$ = {discrepancy:.4f}", fontsize="medium")
        a.set(xticks=[], yticks=[])
        a.plot(x[:, 0], x[:, 1], "o", markersize=3, color=theme.orange if key == "independent" else theme.blue)


FIGURES = (
    Figure(
        "A6",
        "points",
        "Point sets",
        "256 random points clump and leave holes; points of the other sets keep apart. The star discrepancy, the"
        " largest difference between the share of points in a box at the corner and its area, is at most a fifth of"
        " that of random points.",
        (r"D^* = \sup_{a \in [0,1]^2} \left| \frac{\#\{x_i \in [0, a)\}}{N} - a_1 a_2 \right|",),
        plain,
        draw_sets,
        6.6,
        "Six squares of 256 points each, of random points and of five low-discrepancy sets",
        (counted_discrepancy,),
    ),
    Figure(
        "A6",
        "randomised",
        "Point sets, randomised",
        "A shift, a permutation of the digits or a scramble makes each single point uniform and leaves the set even."
        " So the estimates are unbiased, and the spread of several randomisations gives their error.",
        (
            (
                r"x_i \mapsto (x_i + \Delta)\ \mathrm{mod}\ 1, \qquad \mathrm{error}^2 = \frac{1}{R (R - 1)}"
                r" \sum_{r=1}^{R} (F_r - \bar{F})^2"
            ),
        ),
        randomised,
        draw_sets,
        6.6,
        "Six squares of 256 points each, of randomised low-discrepancy sets",
        (counted_discrepancy,),
    ),
)
