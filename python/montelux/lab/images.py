"""Files of the report: figures as SVG in both themes, formulas as SVG that takes the colour of the text, PNG."""

from __future__ import annotations

import io
import re
from pathlib import Path

import matplotlib
import matplotlib.figure
import matplotlib.image
import numpy as np

from ._figure import Figure, Outcome, Picture
from .style import FONT_SIZE, THEMES, Theme, drawing, new_figure

_METADATA = {"Date": None, "Creator": "Montelux"}


def draw(figure: Figure, outcome: Outcome, theme: Theme) -> matplotlib.figure.Figure:
    """The drawing of a figure that was computed."""
    assert figure.draw is not None
    with drawing(theme):
        canvas = new_figure(figure.height)
        figure.draw(canvas, theme, outcome.series)
    return canvas


def write_drawings(figure: Figure, outcome: Outcome, folder: Path, png: bool = False) -> list[str]:
    """Writes KEY-light.svg and KEY-dark.svg (with `png` as pictures too, on paper); their names."""
    if figure.draw is None:
        return []
    names = []
    for theme in THEMES:
        canvas = draw(figure, outcome, theme)
        names.append(f"{figure.key}-{theme.name}.svg")
        with drawing(theme):
            canvas.savefig(folder / names[-1], format="svg", dpi=160, metadata=_METADATA)
            if png:
                canvas.savefig(folder / f"{figure.key}-{theme.name}.png", dpi=100, facecolor=theme.paper)
    return names


def write_pictures(figure: Figure, outcome: Outcome, folder: Path) -> list[tuple[str, Picture]]:
    """Writes the pictures as PNG; their names."""
    written = []
    for i, picture in enumerate(outcome.pictures):
        name = f"{figure.key}-{i + 1}.png"
        pixels = np.round(np.clip(picture.pixels, 0, 1) * 255).astype(np.uint8)
        matplotlib.image.imsave(folder / name, pixels)
        written.append((name, picture))
    return written


def formula_svg(tex: str) -> str:
    """A formula as an SVG element in the colour of the text around it; its height follows the font."""
    canvas = matplotlib.figure.Figure()
    out = io.StringIO()
    with matplotlib.rc_context({"svg.fonttype": "path", "svg.hashsalt": tex, "mathtext.fontset": "stix"}):
        canvas.text(0, 0, f"${tex.replace('frac', 'dfrac')}$", fontsize=FONT_SIZE, color="#123456")
        canvas.savefig(out, format="svg", transparent=True, bbox_inches="tight", pad_inches=0.03, metadata=_METADATA)
    svg = out.getvalue()
    svg = svg[svg.index("<svg") :].replace("#123456", "currentColor")
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
    width, height = (float(re.search(rf'{side}="([\d.]+)pt"', svg).group(1)) for side in ("width", "height"))  # type: ignore[union-attr]
    em = 13.5  # points of this drawing that are one em of the page
    head = rf'<svg viewBox="\1" role="img" {_label(tex)} {_size(width / em, height / em)}>'
    svg = re.sub(r'<svg [^>]*?viewBox="([^"]+)"[^>]*>', head, svg, count=1)
    # Ids must be unique in the page that holds many formulas.
    prefix = f"f{abs(hash_of(tex)):x}-"
    svg = re.sub(r'\bid="', f'id="{prefix}', svg)
    svg = re.sub(r'href="#', f'href="#{prefix}', svg)
    svg = re.sub(r"url\(#", f"url(#{prefix}", svg)
    return svg.replace("xlink:href", "href")


def _label(tex: str) -> str:
    text = tex.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;").replace("\\", "\\\\")
    return f'aria-label="{text}"'


def _size(width: float, height: float) -> str:
    return f'class="formula" style="width:{width:.2f}em;aspect-ratio:{width:.2f}/{height:.2f}"'


def hash_of(text: str) -> int:
    """The same number for the same text in every run (Python's own hash differs)."""
    value = 2166136261
    for byte in text.encode():
        value = (value ^ byte) * 16777619 % 2**32
    return value
