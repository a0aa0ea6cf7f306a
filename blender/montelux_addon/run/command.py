# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of a render."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class Film:
    """A film of whole pixels, and the part of it that is rendered, from the top left."""

    width: int
    height: int
    x0: int
    y0: int
    x1: int
    y1: int

    @property
    def crop_width(self) -> int:
        return self.x1 - self.x0

    @property
    def crop_height(self) -> int:
        return self.y1 - self.y0

    @property
    def is_cropped(self) -> bool:
        return (self.x0, self.y0, self.x1, self.y1) != (0, 0, self.width, self.height)


@dataclass(frozen=True)
class Command:
    scene: Path
    output: Path
    camera: str
    film: Film
    environment: Path | None = None
    interpolate_environment: bool = True
    transparent: bool = False
    layers: tuple[str, ...] = ()
    # What ends the render, and the other settings, as options of the program.
    options: tuple[str, ...] = field(default_factory=tuple)

    def arguments(self, program: Path) -> list[str]:
        film = self.film
        # --ground off, and always --environment: without lights the program would add those of its studio.
        a = [str(program), "render", str(self.scene), "-o", str(self.output), "--camera", self.camera]
        a += ["--resolution", f"{film.width}x{film.height}", "--ground", "off"]
        a += ["--environment", str(self.environment) if self.environment else "none"]
        a += ["--environment-lookup", "bilinear" if self.interpolate_environment else "nearest"]
        if film.is_cropped:
            edges = (film.x0 / film.width, film.x1 / film.width, film.y0 / film.height, film.y1 / film.height)
            a += ["--crop", ",".join(repr(edge) for edge in edges)]
        if self.transparent:
            a += ["--background", "transparent"]
        if self.layers:
            a += ["--layers", ",".join(self.layers)]
        return a + list(self.options)
