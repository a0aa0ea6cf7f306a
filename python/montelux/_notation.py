"""Values with errors as text: 0.4999(12), the digits in brackets being the error of the last digits shown."""

from __future__ import annotations

import html as markup
import re
from collections.abc import Sequence

from ._core import concise as concise

#: A notebook's cell shows as many components of a vector.
MOST_ROWS = 50


def _split(text: str) -> tuple[str, int | None]:
    """Digits with the error, and the power of ten of 1.2(3)e-5 or 1e-20(0)."""
    power = re.search(r"e([+-]?\d+)", text)
    return (text.replace(power.group(), ""), int(power.group(1))) if power else (text, None)


def latex(text: str) -> str:
    """Of concise(), for math mode."""
    digits, power = _split(text)
    for found, meant in (("inf", r"\infty"), ("nan", r"\mathrm{NaN}")):
        digits = digits.replace(found, meant)
    return digits if power is None else rf"{digits} \times 10^{{{power}}}"


def html(text: str) -> str:
    """Of concise()."""
    digits, power = _split(text)
    digits = markup.escape(digits).replace("-", "&minus;")
    return digits if power is None else f"{digits} &times; 10<sup>{str(power).replace('-', '&minus;')}</sup>"


def result_html(estimates: Sequence[str], details: Sequence[str], vector: bool) -> str:
    """Of a result: `estimates` as of concise(), one per component, then lines of `details`."""
    if vector:
        rows = [f"<tr><td>{i}</td><td>{html(e)}</td></tr>" for i, e in enumerate(estimates[:MOST_ROWS])]
        if len(estimates) > MOST_ROWS:
            rows.append(f"<tr><td></td><td>and {len(estimates) - MOST_ROWS} more</td></tr>")
        head = f"<table><thead><tr><th>component</th><th>value</th></tr></thead><tbody>{''.join(rows)}</tbody></table>"
    else:
        head = f"<div><b>{html(estimates[0])}</b></div>"
    lines = (f"<b>{markup.escape(d)}</b>" if d.startswith("warning") else markup.escape(d) for d in details)
    return head + "".join(f"<div>{line}</div>" for line in lines)


def result_latex(estimates: Sequence[str], vector: bool) -> str:
    """Of a result, as `result_html`."""
    parts = [latex(e) for e in estimates[:MOST_ROWS]] + ([r"\dots"] if len(estimates) > MOST_ROWS else [])
    if not vector:
        return f"${parts[0]}$"
    return r"$\left(" + r",\; ".join(parts) + r"\right)$"
