"""C10: chains of paths walk over a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, mean_of
from ..light import displayed, luminance, scene
from ..marks import grid
from ..sky import show

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

#: Samples per pixel; steps that are drawn; the row of pixels that crosses ball and wall.
SAMPLES, STEPS, ROW = 256, 250, 58


def room() -> montelux.Scene:
    """The room with lamps in shades, for Metropolis light transport."""
    s: montelux.Scene = scene("shades")
    s.integrator.method = "metropolis"
    return s


def chains() -> Outcome:
    """Chains as the render walks them; laws of their steps, and the render beside a bidirectional one."""
    s = room()
    walks = s.path_chains(chains=16, spp=SAMPLES, seed=3)
    width, height = s.film.resolution
    numbers = [
        mean_of(f"large steps: mean place, {side}", walks.proposed[walks.large, axis] / size, 0.5, "1/2")
        for axis, (side, size) in enumerate((("from the left", width), ("from the top", height)))
    ]
    # Each step is accepted with its own probability, whatever came before it.
    spread = np.sqrt((walks.acceptance * (1 - walks.acceptance)).sum())
    steps = walks.acceptance.size
    accepted = (walks.accepted - walks.acceptance).sum()
    numbers.append(Number("share of accepted steps less its mean probability", accepted / steps, spread / steps, 0))
    ratio = np.minimum(1, walks.proposed_size / walks.size[:, :-1])
    apart = np.abs(ratio - walks.acceptance).max()
    numbers.append(Number("probabilities less min(1, f(y) / f(x)), farthest", apart, 1e-9, 0, bound=True))
    render = s.render(spp=SAMPLES, seed=3).wait()
    s.integrator.method = "bidirectional"
    other = s.render(spp=SAMPLES // 2, seed=4).wait()
    return Outcome(numbers, {"walks": walks, "render": render, "other": other})


def draw_chains(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    walks, picture = s["walks"], luminance(s["other"].mean)
    parts: Any = figure.subfigures(2, 1, height_ratios=[1.2, 1])
    gray = displayed(np.repeat(picture[..., None], 3, axis=2), 0.25 / picture.mean())
    for a, chain in zip(parts[0].subplots(1, 2), (0, 5)):
        show(a, gray)
        a.set_title(f"chain {chain + 1}, {STEPS} steps", fontsize="medium")
        film, jumps = (walks.film[chain, : STEPS + 1], walks.large[chain, :STEPS] & walks.accepted[chain, :STEPS])
        for i in range(STEPS):
            if walks.accepted[chain, i]:
                style = (
                    {"color": theme.orange, "linewidth": 0.9, "linestyle": (0, (3, 2))}
                    if jumps[i]
                    else {"color": theme.blue, "linewidth": 1.2}
                )
                a.plot(film[i : i + 2, 0], film[i : i + 2, 1], **style)
        a.plot(*film.T, "o", color=theme.blue, markersize=2.5)
    a, b = parts[1].subplots(1, 2, width_ratios=[1.7, 1])
    render = s["render"]
    value, error = luminance(render.mean)[ROW], luminance(render.standard_error)[ROW]
    x = np.arange(len(value)) + 0.5
    a.errorbar(x, value, error, fmt="o", color=theme.blue, markersize=3, elinewidth=1.2, label="chains, ± one error")
    a.plot(x, luminance(s["other"].mean)[ROW], color=theme.orange, linewidth=1.6, label="bidirectional")
    a.set(xlabel=f"pixels of row {ROW}", ylabel="luminance", yscale="log")
    a.legend()
    grid(a, theme)
    bins = np.linspace(0, 1, 21)
    for large, color, hatch, name in ((True, theme.orange, "//", "large"), (False, theme.blue, None, "small")):
        b.hist(
            walks.acceptance[walks.large == large],
            bins=bins,
            density=True,
            histtype="step",
            linewidth=2,
            color=color,
            hatch=hatch,
            label=name,
        )
    b.set(xlabel="acceptance", yticks=[], yscale="log")
    b.legend(title="steps")


FIGURES = (
    Figure(
        "C10",
        "chains",
        "Chains of paths over a picture",
        "A path is a list of random numbers; a small step (blue) moves each of them a little, a large one (orange, dashed)"
        " draws all anew. What chains follow is the brightness of a path over that of its part of a coarse picture. A"
        " proposal with more of it is always accepted, one with less sometimes: most large steps find too little, and small"
        " ones stay near light that is hard to find. Below, the picture is the mean of 32 independent groups of chains,"
        " whose spread is its error bar; neighbouring pixels share chains and err together. After Kelemen, Szirmay-Kalos, Antal and Csonka (2002).",
        (
            r"a(x \to y) = \min\left(1,\ \frac{\hat{f}(y)}{\hat{f}(x)}\right), \qquad \hat{f} = \frac{\mathrm{brightness\ of\ the\ path}}{\mathrm{of\ its\ part\ of\ the\ film}}",
        ),
        chains,
        draw_chains,
        7.4,
        "Two walks of chains over a room, a row of pixels with error bars, and how likely steps are accepted",
        slow=True,
        helpers=(room,),
    ),
)
