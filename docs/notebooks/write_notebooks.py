"""Executes the notebooks of this folder, whose cells are written in NAME.py, and stores them as NAME.ipynb.

Usage: write_notebooks.py [NAME ...], with montelux and matplotlib at hand; Jupyter is not needed.

NAME.py is in the percent format, which editors and Jupytext know: `# %% [markdown]` begins a cell of text, `# %%` one
of code, `# %% tags=["varies"]` one whose output depends on the clock. Cells that name `plt` draw, and do nothing that
later cells need: python/tests/test_notebooks.py leaves them out where there is no matplotlib.
"""

from __future__ import annotations

import ast
import base64
import contextlib
import hashlib
import io
import json
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parent
NAMES = ("integration", "sampling", "events", "rendering")
Output = dict[str, Any]  # of nbformat 4


@dataclass(frozen=True)
class Cell:
    """A cell; the output of one that varies depends on the clock."""

    text: str
    is_code: bool
    varies: bool = False

    @property
    def draws(self) -> bool:
        return self.is_code and re.search(r"\bplt\b", self.text) is not None

    @property
    def id(self) -> str:
        return hashlib.sha256(self.text.encode()).hexdigest()[:12]


def read_cells(source: str) -> list[Cell]:
    """The cells of a text in percent format."""
    before, *parts = re.split(r"^# %%(.*)\n", source, flags=re.M)
    if before.strip():
        raise ValueError("there is text before the first cell")
    cells = []
    for head, body in zip(parts[::2], parts[1::2]):
        head, body = head.strip(), body.strip("\n")
        if head == "[markdown]":
            cells.append(Cell(re.sub(r"^# ?", "", body, flags=re.M), is_code=False))
        elif head in ("", 'tags=["varies"]'):
            cells.append(Cell(body, is_code=True, varies=head != ""))
        else:
            raise ValueError(f'there is no kind of cell {head!r}; expected [markdown], tags=["varies"] or nothing')
    return cells


class Runner:
    """Executes cells one after the other in one namespace and collects what a notebook shows."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._count = 0
        self._namespace: dict[str, Any] = {"__name__": "__main__"}
        self._outputs: list[Output] = []
        self._text = io.StringIO()

    def execute(self, cell: Cell) -> list[Output]:
        """The outputs of a cell: text, figures, and the value of its last line."""
        self._count += 1
        self._outputs = []
        if cell.draws:
            self._draw_here()
        where = f"{self._name}.py, code cell {self._count}"
        tree = ast.parse(cell.text, where)
        last = None
        if tree.body and isinstance(tree.body[-1], ast.Expr):
            last = ast.Expression(tree.body.pop().value)  # type: ignore[attr-defined]
        with contextlib.redirect_stdout(self._text):
            exec(compile(tree, where, "exec"), self._namespace)
            value = None if last is None else eval(compile(last, where, "eval"), self._namespace)
        self._flush()
        if value is not None:
            data: dict[str, Any] = {}
            if hasattr(value, "_repr_png_"):
                data["image/png"] = _base64(value._repr_png_())
            data["text/plain"] = _lines(repr(value))
            self._outputs.append(
                {"data": data, "execution_count": self._count, "metadata": {}, "output_type": "execute_result"}
            )
        return self._outputs

    def _flush(self) -> None:
        if self._text.getvalue():
            self._outputs.append({"name": "stdout", "output_type": "stream", "text": _lines(self._text.getvalue())})
            self._text.seek(0)
            self._text.truncate()

    def _draw_here(self) -> None:
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        def show() -> None:
            for number in plt.get_fignums():
                file = io.BytesIO()
                plt.figure(number).savefig(file, format="png", metadata={"Software": None})
                plt.close(number)
                self._flush()
                data = {"image/png": _base64(file.getvalue()), "text/plain": ["<Figure>"]}
                self._outputs.append({"data": data, "metadata": {}, "output_type": "display_data"})

        plt.show = show  # type: ignore[assignment]


def as_notebook(cells: list[Cell], outputs: list[list[Output]]) -> str:
    """The notebook (nbformat 4.5) of cells and of the outputs of those that are code; the same for the same."""
    left = iter(outputs)
    written: list[dict[str, Any]] = []
    count = 0
    for cell in cells:
        one: dict[str, Any] = {"cell_type": "code" if cell.is_code else "markdown"}
        if cell.is_code:
            count += 1
            one["execution_count"] = count
        one["id"] = cell.id
        one["metadata"] = {"tags": ["varies"]} if cell.varies else {}
        if cell.is_code:
            one["outputs"] = next(left)
        one["source"] = _lines(cell.text)
        written.append(one)
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    notebook = {
        "cells": written,
        "metadata": {"kernelspec": kernel, "language_info": {"name": "python"}},
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    return json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"


@contextlib.contextmanager
def working_in_a_temporary_folder() -> Iterator[None]:
    before = os.getcwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            yield
        finally:
            os.chdir(before)


def _lines(text: str) -> list[str]:
    return text.splitlines(keepends=True)


def _base64(data: bytes) -> str:
    return base64.b64encode(data).decode() + "\n"


def main(names: list[str]) -> None:
    for name in names or NAMES:
        cells = read_cells((FOLDER / f"{name}.py").read_text(encoding="utf-8"))
        runner = Runner(name)
        with working_in_a_temporary_folder():
            outputs = [runner.execute(cell) for cell in cells if cell.is_code]
        notebook = FOLDER / f"{name}.ipynb"
        notebook.write_text(as_notebook(cells, outputs), encoding="utf-8")
        print(f"{os.path.relpath(notebook)}: {len(cells)} cells, {notebook.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main(sys.argv[1:])
