"""How figures look: light and dark, readable from the last row, safe for the colour-blind."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import matplotlib
import matplotlib.figure
from cycler import cycler
from matplotlib.colors import LinearSegmentedColormap

WIDTH = 8.0  # inches
FONT_SIZE = 15.0  # points at that width


@dataclass(frozen=True)
class Theme:
    """Colours after Okabe and Ito (2008), "Color Universal Design", made to stand out on this background."""

    name: str
    paper: str
    ink: str
    faint: str
    blue: str
    orange: str
    green: str
    purple: str
    yellow: str

    @property
    def cycle(self) -> tuple[str, ...]:
        return (self.blue, self.orange, self.green, self.purple, self.ink, self.yellow)

    @property
    def map(self) -> Any:
        """Colours of growing numbers, none of which is lost against the background."""
        cividis = matplotlib.colormaps["cividis"]
        ends = (0.0, 0.85) if self.name == "light" else (0.25, 1.0)
        steps = [cividis(ends[0] + (ends[1] - ends[0]) * i / 63) for i in range(64)]
        return LinearSegmentedColormap.from_list("lab", steps)


LIGHT = Theme("light", "#ffffff", "#1a1a1f", "#8a8a92", "#0072B2", "#D55E00", "#007F5C", "#B0568B", "#9A7400")
DARK = Theme("dark", "#121216", "#ececf0", "#85858f", "#56B4E9", "#E69F00", "#2FBF93", "#E39AC4", "#F0E442")
THEMES = (LIGHT, DARK)


@contextmanager
def drawing(theme: Theme) -> Iterator[None]:
    """Within it matplotlib draws in this theme."""
    settings: Any = {
        "svg.fonttype": "path",  # the same letters on every machine
        "svg.hashsalt": "montelux",  # the same file from the same data
        "font.family": "DejaVu Sans",
        "font.size": FONT_SIZE,
        "axes.titlesize": FONT_SIZE,
        "axes.labelsize": FONT_SIZE,
        "xtick.labelsize": FONT_SIZE - 2,
        "ytick.labelsize": FONT_SIZE - 2,
        "legend.fontsize": FONT_SIZE - 2,
        "legend.frameon": False,
        "legend.handlelength": 1.8,
        "lines.linewidth": 2.4,
        "lines.markersize": 7,
        "axes.linewidth": 1.2,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.prop_cycle": cycler(color=theme.cycle),
        "text.color": theme.ink,
        "axes.edgecolor": theme.ink,
        "axes.labelcolor": theme.ink,
        "xtick.color": theme.ink,
        "ytick.color": theme.ink,
        "axes.facecolor": "none",
        "figure.facecolor": "none",
        "savefig.facecolor": "none",
        "mathtext.fontset": "dejavusans",
        "figure.constrained_layout.use": True,
        "image.cmap": "cividis",
        "hatch.linewidth": 1.0,
    }
    with matplotlib.rc_context(settings):
        yield


def new_figure(height: float) -> matplotlib.figure.Figure:
    """An empty figure, apart from pyplot: nothing is shown or kept."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure = matplotlib.figure.Figure(figsize=(WIDTH, height))
    FigureCanvasAgg(figure)
    return figure
