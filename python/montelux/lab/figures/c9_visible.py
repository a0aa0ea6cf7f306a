"""C9: importance sampling made visible."""

from __future__ import annotations

from .._figure import Figure, Outcome, Picture
from ..light import displayed, rendered, same_mean

FIVE = {
    "uniform": "uniform directions",
    "bsdf": "directions of the material",
    "light": "points on the lamp",
    "mis": "both, weighted",
}


def five() -> Outcome:
    """A room at five samples per pixel, by uniform directions and by samples that know the lamp and the material."""
    many = rendered("room", 64, seed=9)
    pictures, numbers = [], []
    for name, caption in FIVE.items():
        r = rendered("room", 5, 2, name)
        pictures.append(Picture(f"{caption}, 5 samples per pixel", displayed(r.mean)))
        numbers.append(same_mean(f"{caption}: picture's mean against 64 samples", r, many))
    return Outcome(numbers, {}, pictures)


def spheres() -> Outcome:
    """Gold spheres at 64 samples per pixel: uniform directions, and directions of the GGX law."""
    pictures, renders = [], []
    for name, caption in (("uniform", "uniform directions"), ("bsdf", "directions of the GGX law")):
        renders.append(rendered("spheres", 64, 3, name))
        pictures.append(Picture(f"{caption}, 64 samples per pixel", displayed(renders[-1].mean)))
    return Outcome([same_mean("means of the pictures, apart", *renders)], {}, pictures)


FIGURES = (
    Figure(
        "C9",
        "five",
        "Five samples per pixel",
        "The same room with the same number of samples in different directions. Uniform directions hardly ever find"
        " the lamp; points on the lamp light the walls smoothly but leave the glossy ball noisy; both together,"
        " weighted, render both well.",
        (r"L_o = \frac{1}{N} \sum_{i=1}^{N} \frac{f_r\,L_i \cos\theta_i}{p(\omega_i)}",),
        five,
        slow=True,
        alt="Four pictures of a room with a lamp and two balls, ever less noisy",
    ),
    Figure(
        "C9",
        "spheres",
        "Gold spheres at 64 samples",
        "Roughness grows from left to right. Uniform directions miss the narrow reflections of the smooth spheres,"
        " which stay black with bright specks; directions drawn from the law of the microfacets find them.",
        (r"p(\omega_i) = \frac{p(h)}{4\,(\omega_o \cdot h)}",),
        spheres,
        slow=True,
        alt="Five spheres of growing roughness, by uniform directions and by directions of the material",
    ),
)
