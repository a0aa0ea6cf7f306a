"""C10: one scene by every method in the same time."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number
from ..light import displayed, luminance, scene
from ..marks import grid
from ..sky import show

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

#: CPU time of a render, all threads together, and renders of each method with seeds of their own.
SECONDS, RENDERS = 0.5, 16
WAYS: dict[str, dict[str, Any]] = {
    "path": {"method": "path"},
    "guided": {"method": "path", "guiding": "on"},
    "Metropolis": {"method": "metropolis"},
    "bidirectional": {"method": "bidirectional"},
    "merging": {"method": "bidirectional", "merging": montelux.Merging()},
}
#: Relative errors are of luminance plus this share of the picture's mean.
FLOOR = 0.1


def rendered_by(way: str, spp: int, seed: int) -> montelux.Render:
    """A render of the room by a method."""
    s: montelux.Scene = scene("shades")
    s.film.resolution = 80, 60
    for name, value in WAYS[way].items():
        setattr(s.integrator, name, value)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of merging, that it is biased
        return s.render(spp=spp, seed=seed).wait()


def samples_for(way, seconds):  # type: ignore[no-untyped-def]
    """The samples per pixel that take so much CPU time, by two renders of less; what Metropolis needs for errors."""
    n = 16
    for share in (0.5, 1.0):
        n = max(16 if way == "Metropolis" else 4, round(n * share * seconds / rendered_by(way, n, 99).cpu_seconds))
    return n


def ratio(name, a, b, together):  # type: ignore[no-untyped-def]
    """The mean of some numbers over that of others, which were found in pairs or apart: one is expected."""
    value, n = a.mean() / b.mean(), len(a)
    spread = (a - value * b).std(ddof=1) if together else np.hypot(a.std(ddof=1), value * b.std(ddof=1))
    return Number(name, value, spread / b.mean() / np.sqrt(n), 1, degrees_of_freedom=n - 1)


def methods(seconds: float = SECONDS) -> Outcome:
    """Renders by each method in the same CPU time; their errors as measured against longer ones, and as they claim."""
    n = samples_for("bidirectional", 3 * seconds)
    long = [rendered_by("bidirectional", n, 100 + i) for i in range(RENDERS)]
    reference = np.mean([luminance(r.mean) for r in long], axis=0)
    noise = np.mean([luminance(r.standard_error) ** 2 for r in long], axis=0) / RENDERS
    known = noise < np.quantile(noise, 0.98)  # where the reference is of use
    scale = 1 / (reference + FLOOR * reference.mean()) ** 2
    means = np.array([luminance(r.mean).mean() for r in long])
    numbers, found = [], {}
    for way in WAYS:
        n = samples_for(way, seconds)
        renders = [rendered_by(way, n, 1 + i) for i in range(RENDERS)]
        pictures, claimed = (
            np.array([luminance(p) for p in part]) for part in zip(*((r.mean, r.standard_error) for r in renders))
        )
        found[way] = {
            "measured": (((pictures - reference) ** 2 - noise) * scale)[:, known].mean(axis=1),  # less the reference's
            "claimed": (claimed**2 * scale)[:, known].mean(axis=1),
            "picture": renders[0].mean,
            "error": np.abs(pictures[0] - reference) * np.sqrt(scale),
            "spp": n,
            "seconds": np.mean([r.cpu_seconds for r in renders]),
        }
        numbers.append(ratio(f"{way}: mean over the reference", pictures.mean(axis=(1, 2)), means, False))
        if way != "merging":  # its standard errors leave out the bias
            numbers.append(ratio(f"{way}: claimed over measured", found[way]["claimed"], found[way]["measured"], True))
    return Outcome(numbers, {"found": found, "reference": reference})


def draw_methods(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    parts: Any = figure.subfigures(2, 1, height_ratios=[0.92, 1])
    top, bottom = parts
    found = s["found"]
    axes = top.subplots(2, len(found))
    exposure = 0.22 / s["reference"].mean()
    for (above, below), (way, f) in zip(axes.T, found.items()):
        show(above, displayed(f["picture"], exposure))
        show(below, theme.map(np.clip(f["error"], 0, 1)))
        above.set_title(way, fontsize="small")
        below.set_xlabel(f"{f['spp']} spp\n{f['seconds']:.2f} s", fontsize="x-small")
    axes[0, 0].set_ylabel("picture", fontsize="small")
    axes[1, 0].set_ylabel("error", fontsize="small")
    a = bottom.subplots()
    grid(a, theme)
    for name, marker, color, shift in (("measured", "o", theme.blue, -0.08), ("claimed", "s", theme.orange, 0.08)):
        v = np.array([f[name] for f in found.values()])
        mean, error = v.mean(axis=1), v.std(axis=1, ddof=1) / np.sqrt(v.shape[1])
        x = np.arange(len(found)) + shift
        label = "measured against the reference" if name == "measured" else "as the renders claim"
        a.errorbar(x, mean, error, fmt=marker, color=color, capsize=5, elinewidth=2, label=label)
    a.set(yscale="log", ylabel="squared error", xlim=(-0.5, len(found) - 0.5), title="")
    a.set_xticks(range(len(found)), list(found))
    a.legend()


FIGURES = (
    Figure(
        "C10",
        "methods",
        "One room by five methods in the same time",
        "The lamps stand in shades, so most light comes by a detour that path tracing seldom finds. Light paths that are"
        " joined to those of the camera find it at once; a guide and Metropolis chains pay in longer renders than these,"
        " half a second of CPU time each. The errors that the renders claim (squares) agree with those measured"
        " against longer ones (circles), even where they are noise, but for the bias of merging. Bars are standard errors"
        " over 16 seeds; the number of samples (spp: per pixel) follows from the speed of the machine.",
        (r"\mathrm{squared\ error} = \frac{1}{P} \sum_{p=1}^{P} \frac{(\bar{L}_p - L_p)^2}{(L_p + \epsilon)^2}",),
        methods,
        draw_methods,
        6.6,
        "Five pictures of a room with their errors, and below the squared errors with bars",
        slow=True,
        helpers=(rendered_by, samples_for, ratio),
    ),
)
