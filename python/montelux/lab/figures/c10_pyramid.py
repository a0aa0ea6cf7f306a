"""C10: the strategies of bidirectional path tracing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number
from ..light import displayed, luminance, scene
from ..sky import show

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

#: Scattering events of the longest paths, samples per pixel, and columns of pixels that show the left wall alone.
DEPTH, SAMPLES, WALL = 4, 48, 16


def room() -> montelux.Scene:
    """The room with lamps in shades, for bidirectional path tracing."""
    s: montelux.Scene = scene("shades")
    s.integrator.method = "bidirectional"
    s.integrator.max_depth = DEPTH
    return s


def pyramid() -> Outcome:
    """A picture of each strategy; their weighted sum beside the render, and strategies that find the same paths."""
    s = room()
    pictures = s.strategy_pictures(spp=SAMPLES, seed=6)
    render = np.asarray(s.render(spp=SAMPLES, seed=6).mean, dtype=float)
    total = np.sum([p.weighted for p in pictures], axis=0)
    apart = np.abs(total - render).max() / render.max()
    numbers = [Number("weighted sum less the render, farthest, of the brightest pixel", apart, 1e-5, 0, bound=True)]
    # Lamp, left wall, eye: every strategy finds these paths. Renders of several seeds give the errors.
    walls = []
    for seed in range(20, 36):
        few = room()
        few.integrator.max_depth = 1
        found = {
            p.s: luminance(p.unweighted[:, :WALL]).mean()
            for p in few.strategy_pictures(spp=8, seed=seed)
            if p.s + p.t == 3
        }
        walls.append([found[k] for k in range(3)])
    mean, error = (np.mean(walls, axis=0), np.std(walls, axis=0, ddof=1) / np.sqrt(len(walls)))
    for k in (0, 2):
        name = f"left wall, 3 vertices: s = {k} alone over s = 1 alone"
        ratio = mean[k] / mean[1]
        numbers.append(
            Number(
                name,
                ratio,
                ratio * np.hypot(error[k] / mean[k], error[1] / mean[1]),
                1,
                degrees_of_freedom=len(walls) - 1,
            )
        )
    return Outcome(numbers, {"pictures": pictures})


def draw_pyramid(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    longest = DEPTH + 2
    parts: Any = figure.subfigures(2, 1)
    for part, kind in zip(parts, ("weighted", "unweighted")):
        part.suptitle(f"{kind}: the sum is the picture" if kind == "weighted" else "each alone", fontsize="medium")
        # A picture is two columns wide; a row with one picture more begins a column earlier.
        cells = part.add_gridspec(longest - 2, 2 * longest)
        for row, length in enumerate(range(3, longest + 1)):
            mine = [p for p in s["pictures"] if p.s + p.t == length]
            exposure = 0.35 / np.sum([luminance(p.weighted) for p in mine], axis=0).mean()
            for p in mine:
                first = longest - length + 2 * p.s
                a = part.add_subplot(cells[row, first : first + 2])
                show(a, displayed(getattr(p, kind), exposure))
                a.set_title(f"s={p.s}, t={p.t}", fontsize=9, pad=2)


FIGURES = (
    Figure(
        "C10",
        "pyramid",
        "Strategies of a bidirectional path",
        "A path of n vertices can be found in n ways: s vertices from a lamp and t from the eye, then joined. Each row is"
        " paths of one more vertex, and brighter by its own factor; s grows to the right. Above, each path counts by its"
        " weight among the strategies of its row, so that the pictures add up to the render. Below, each strategy is"
        " alone: all of a row expect the same light where they can find it, but with very different noise; the caustic"
        " below the ball is clear where t = 1 alone. After Veach (1997), figure 10.2.",
        (
            r"I = \sum_{s \geq 0} \sum_{t \geq 1} w_{s,t}(x)\,\frac{f(x)}{p_{s,t}(x)}, \qquad \sum_{s + t = n}"
            r" w_{s,t}(x) = 1",
        ),
        pyramid,
        draw_pyramid,
        9.6,
        "Two pyramids of pictures of a room, by the strategies that found their paths",
        slow=True,
        helpers=(room,),
    ),
)
