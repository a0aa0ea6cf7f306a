"""The report: one HTML page that needs neither network nor scripts."""

from __future__ import annotations

import html
import re
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path

import montelux

from ._figure import Figure, Outcome, Picture
from ._number import LIMIT, Number
from .images import formula_svg, write_drawings, write_pictures

GROUPS = {"A": "Estimating integrals", "B": "Random variables", "C": "Light"}


@dataclass(frozen=True)
class Made:
    """A figure of the report."""

    figure: Figure
    outcome: Outcome
    seconds: float
    section: str

    @property
    def wrong(self) -> list[Number]:
        return [n for n in self.outcome.numbers if not n.agrees]


def make_report(
    figures: Sequence[Figure], folder: Path, progress: Callable[[str], None] = lambda line: None, png: bool = False
) -> list[Made]:
    """Computes and draws the figures, and writes folder/index.html with its files beside it."""
    folder.mkdir(parents=True, exist_ok=True)
    made = []
    for figure in figures:
        begin = time.perf_counter()
        outcome = figure.compute()
        section = _section(figure, outcome, folder, png)
        made.append(Made(figure, outcome, time.perf_counter() - begin, section))
        progress(f"{figure.key:28} {made[-1].seconds:6.1f} s  {len(outcome.numbers)} numbers")
    (folder / "index.html").write_text(_page(made), encoding="utf-8")
    return made


def _section(figure: Figure, outcome: Outcome, folder: Path, png: bool) -> str:
    parts = [f'<section id="{figure.key}">', f"<h3><span>{figure.row}</span> {html.escape(figure.title)}</h3>"]
    parts.append(f'<p class="see">{html.escape(figure.see)}</p>')
    if figure.formulas:
        # Separate parts wrap below each other on narrow pages.
        parts_of_lines = (re.split(r"(?<=,)\s*\\q?quad\s*", tex) for tex in figure.formulas)
        lines = "".join(f"<div>{''.join(map(formula_svg, line))}</div>" for line in parts_of_lines)
        parts.append(f'<div class="formulas">{lines}</div>')
    names = write_drawings(figure, outcome, folder, png)
    alt = html.escape(figure.alt or figure.title)
    if names:
        light, dark = names
        parts.append(
            f'<figure><a href="{light}" title="Alone, to enlarge"><picture>'
            f'<source srcset="{dark}" media="(prefers-color-scheme: dark)">'
            f'<img src="{light}" alt="{alt}" width="{8 * 96}" height="{figure.height * 96:.0f}"></picture></a></figure>'
        )
    pictures = write_pictures(figure, outcome, folder)
    if pictures:
        cells = "".join(
            f'<figure{_wide(p)}><a href="{name}"><img src="{name}" alt="{html.escape(p.caption)}" '
            f'width="{p.pixels.shape[1]}" height="{p.pixels.shape[0]}"></a>'
            f"<figcaption>{html.escape(p.caption)}</figcaption></figure>"
            for name, p in pictures
        )
        parts.append(f'<div class="pictures">{cells}</div>')
    if outcome.numbers:
        parts.append(_table(outcome.numbers))
    parts.append(
        f"<details><summary>The code that makes it</summary>"
        f"<p><code>python -m montelux.lab --out lab --only {figure.key}</code></p>"
        f'<pre tabindex="0"><code>{html.escape(figure.code)}</code></pre></details>'
    )
    return "\n".join((*parts, "</section>"))


def _wide(picture: Picture) -> str:
    height, width = picture.pixels.shape[:2]
    return ' class="wide"' if width > 2 * height else ""


def _table(numbers: Sequence[Number]) -> str:
    rows = []
    for n in numbers:
        distance = n.distance_text
        if not n.agrees:
            distance = f"<strong>{distance}: wrong</strong>"
        cells = (html.escape(n.name), html.escape(n.measured_text), html.escape(n.exact_text), distance)
        labels = ("", "measured", "exact", "apart")
        rows.append("<tr>" + "".join(f'<td data-label="{label}">{c}</td>' for label, c in zip(labels, cells)) + "</tr>")
    head = "<thead><tr><th></th><th>measured</th><th>exact</th><th>apart</th></tr></thead>"
    return f"<table>{head}<tbody>{''.join(rows)}</tbody></table>"


def _contents(made: Sequence[Made]) -> str:
    lines = []
    for group, title in GROUPS.items():
        items = [m.figure for m in made if m.figure.row[0] == group]
        if items:
            links = "".join(f'<li><a href="#{f.key}"><b>{f.row}</b> {html.escape(f.title)}</a></li>' for f in items)
            lines.append(f"<div><h2>{title}</h2><ul>{links}</ul></div>")
    return f"<nav>{''.join(lines)}</nav>"


def _page(made: Sequence[Made]) -> str:
    style = resources.files(__package__).joinpath("report.css").read_text(encoding="utf-8")
    count = sum(len(m.outcome.numbers) for m in made)
    wrong = sum(len(m.wrong) for m in made)
    verdict = "each of them agrees" if wrong == 0 else f"<strong>{wrong} of them do not agree</strong>"
    body = []
    for group, title in GROUPS.items():
        sections = [m.section for m in made if m.figure.row[0] == group]
        if sections:
            body.append(f"<h2>{group}. {title}</h2>" + "\n".join(sections))
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>The lab of Montelux</title>
<link rel="icon" href="data:,">
<style>{style}</style>
</head>
<body>
<header>
<h1>The lab</h1>
<p>Monte Carlo integration in figures, from a sum of rectangles to pictures of light. Every sample, density, estimate
and picture comes from <b>Montelux {html.escape(montelux.__version__)}</b>, and the code that computes it is below each
figure.</p>
<p>{count} measured numbers are compared with exact ones: {verdict}. Digits in brackets are the standard error of the last
digits shown: 1.234(56) is 1.234 ± 0.056. A correct number is more than {LIMIT:g} errors off (or the equally improbable
distance, where the error comes from few replicates) once in 26 million times. Numbers of deterministic rules have a
bound instead.</p>
</header>
{_contents(made)}
<main>
{"".join(body)}
</main>
</body>
</html>
"""
