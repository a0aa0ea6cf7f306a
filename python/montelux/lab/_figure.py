"""What a figure of the lab is made of."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._number import Number

if TYPE_CHECKING:
    import matplotlib.figure

    from .style import Theme


@dataclass(frozen=True)
class Picture:
    """A picture in pixels, shape (height, width, 3), of sRGB values in [0, 1]."""

    caption: str
    pixels: npt.NDArray[np.floating[Any]]


@dataclass(frozen=True)
class Outcome:
    """What the computation of a figure found."""

    numbers: Sequence[Number]
    #: What the drawing needs, by name.
    series: dict[str, Any] = field(default_factory=dict)
    pictures: Sequence[Picture] = ()


Draw = Callable[["matplotlib.figure.Figure", "Theme", dict[str, Any]], None]


@dataclass(frozen=True)
class Figure:
    """A figure: its texts, the function that computes it and the one that draws it.

    `compute` samples and integrates by the library, with a seed that is fixed; the report shows its source.
    """

    row: str
    name: str
    title: str
    #: What to see, two sentences.
    see: str
    #: In TeX as matplotlib knows it, one line each.
    formulas: Sequence[str]
    compute: Callable[[], Outcome]
    #: None where pictures are all there is.
    draw: Draw | None = None
    #: Inches; the width is eight.
    height: float = 4.6
    #: What the picture shows, for those who do not see it.
    alt: str = ""
    #: Further functions whose source belongs to the figure.
    helpers: Sequence[Callable[..., Any]] = ()
    #: Its computation takes more than a second or two.
    slow: bool = False

    @property
    def key(self) -> str:
        """'A4-race'."""
        return f"{self.row}-{self.name}"

    @property
    def code(self) -> str:
        """The source of the computation."""
        return "\n\n".join(inspect.getsource(f).rstrip() for f in (*self.helpers, self.compute)) + "\n"
