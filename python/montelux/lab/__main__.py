"""`python -m montelux.lab --out DIR`: writes the report."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import montelux

from . import all_figures, chosen_figures


def main(arguments: list[str] | None = None) -> int:
    """Returns 0; 1 where a number is wrong or something is missing; 2 for wrong usage."""
    parser = argparse.ArgumentParser(prog="python -m montelux.lab", description="Draws the figures of the lab.")
    parser.add_argument("--out", metavar="DIR", type=Path, help="the folder of the report; its page is DIR/index.html")
    parser.add_argument(
        "--only", metavar="NAME", action="append", help="rows or figures, 'A4' or 'A4-race'; several with commas"
    )
    parser.add_argument("--list", action="store_true", help="lists the figures")
    parser.add_argument("--png", action="store_true", help="also writes the drawings as PNG")
    given = parser.parse_args(arguments)
    try:
        figures = chosen_figures(given.only) if given.only else all_figures()
    except montelux.Error as error:
        print(f"montelux.lab: error: {error}", file=sys.stderr)
        return 2
    if given.list:
        for figure in figures:
            print(f"{figure.key:28} {figure.title}")
        return 0
    if given.out is None:
        print("montelux.lab: error: expected a folder, --out DIR", file=sys.stderr)
        return 2
    try:
        from .report import make_report
    except ModuleNotFoundError as error:
        if error.name and error.name.partition(".")[0] == "matplotlib":
            print("montelux.lab: error: matplotlib is missing; pip install 'montelux[lab]'", file=sys.stderr)
            return 1
        raise
    begin = time.perf_counter()
    made = make_report(figures, given.out, lambda line: print(line, flush=True), given.png)
    count = f"{len(made)} figure{'s' if len(made) != 1 else ''}"
    print(f"{given.out / 'index.html'}: {count}, {time.perf_counter() - begin:.0f} s")
    wrong = [(m.figure.key, n) for m in made for n in m.wrong]
    for key, n in wrong:
        print(f"{key}: {n.name}: {n.measured_text} was measured; expected {n.exact_text}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
