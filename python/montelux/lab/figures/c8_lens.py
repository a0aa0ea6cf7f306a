"""C8: the lens, as two more variables of a pixel's integral."""

from __future__ import annotations

import numpy as np

from .._figure import Figure, Outcome, Picture
from .._number import Number
from ..light import displayed, rendered, scene

# As in scenes/lamps.pbrt: metres, and pixels at the focal distance.
RADIUS, FOCUS, DEPTHS = 0.25, 4.0, (2, 3, 4, 6, 12)
PLACES = (-2.1, -1.05, 0.0, 1.05, 2.1)  # of the lamps, on the plane in focus
PIXELS = 120 / (2 * FOCUS * np.tan(np.radians(10)))  # a metre there
LAMP = 0.005  # radius of a lamp over its depth


def spread(depth: float, place: float) -> float:
    """The mean squared distance from the middle of a lamp's image, in pixels squared: lens, lamp and pixel add up."""
    blur = RADIUS * abs(depth - FOCUS) / depth * PIXELS
    # A small sphere off the axis is an ellipse, 1 / cos longer towards the side.
    lamp = LAMP * FOCUS * PIXELS
    return float(blur**2 / 2 + lamp**2 / 4 * (2 + (place / FOCUS) ** 2) + 2 / 12)


def lens() -> Outcome:
    """Five lamps through a lens and through a pinhole; the sizes of their images by the law of the thin lens."""
    s = scene("lamps")
    r = rendered(s, 512, 4)
    numbers, height, width = [], r.mean.shape[0], r.mean.shape[1]
    y, x = np.mgrid[0:height, 0:width] + 0.5
    light, error = (np.asarray(v, dtype=float).sum(axis=2) for v in (r.mean, r.standard_error))
    for depth, place in zip(DEPTHS, PLACES):
        middle = width / 2 + place * PIXELS
        near = (np.abs(x - middle) < 44) & np.isfinite(error)
        squared = (x - middle) ** 2 + (y - height / 2) ** 2
        total = light[near].sum()
        moment = (light * squared)[near].sum() / total
        # Of a quotient of sums over independent pixels.
        deviation = np.sqrt((error[near] ** 2 * (squared[near] - moment) ** 2).sum()) / total
        sharp = depth == FOCUS  # its edge is a pixel wide, of which the middles of pixels know little
        numbers.append(
            Number(
                f"lamp at {depth} m: mean squared radius, pixels²",
                moment,
                0.15 if sharp else deviation,
                spread(depth, place),
                bound=sharp,
            )
        )
    s.camera.lens_radius = 0
    pinhole = rendered(s, 256, 4)
    pictures = [
        Picture("lens of 25 cm radius, focused at 4 m", displayed(r.mean, 40)),
        Picture("pinhole", displayed(pinhole.mean)),
    ]
    return Outcome(numbers, {}, pictures)


FIGURES = (
    Figure(
        "C8",
        "lens",
        "The thin lens",
        "Five lamps are 2, 3, 4, 6 and 12 metres away, and the lens is focused at 4: each of the others becomes a"
        " disc of the lens's shape. Through a pinhole all are points. The light of a disc is spread out, so the first"
        " picture is shown forty times brighter.",
        (r"R = A\,\frac{|d - f|}{d} \quad \mathrm{on\ the\ plane\ in\ focus}, \qquad \mathrm{E}\,r^2 = \frac{R^2}{2}",),
        lens,
        slow=True,
        alt="Five discs of light of different sizes, and five points",
        helpers=(spread,),
    ),
)
