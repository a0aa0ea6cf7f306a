"""What drawings share; without matplotlib, which computations do not need."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .style import Theme

#: Lines and marks differ by their shapes too, for those who see no colours.
STROKES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (1, 1.4)), (0, (6, 2, 1, 2)), (0, (3, 1.2)), (0, (8, 3)))
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<")


def grid(axes: Any, theme: Theme) -> None:
    """Faint lines behind the data."""
    axes.grid(True, color=theme.faint, alpha=0.35, linewidth=0.8)
    axes.set_axisbelow(True)


def square(axes: Any, theme: Theme, title: str = "") -> None:
    """The unit square, its frame and its corners alone."""
    axes.set(xlim=(0, 1), ylim=(0, 1), aspect="equal", xticks=[0, 1], yticks=[0, 1])
    for side in ("top", "right"):
        axes.spines[side].set_visible(True)
    if title:
        axes.set_title(title)


def slope(axes: Any, theme: Theme, x: tuple[float, float], y: float, power: float, text: str) -> None:
    """A line of this slope in a plot of logarithms, from (x[0], y), with its name at the end."""
    end = y * (x[1] / x[0]) ** power
    axes.plot(x, (y, end), color=theme.faint, linewidth=1.6, zorder=0)
    axes.annotate(text, (x[1], end), (4, 0), textcoords="offset points", color=theme.ink, va="center", fontsize="small")
