"""Lines on standard error that say how far a run is."""

from __future__ import annotations

import shutil
import sys
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._render import Progress
    from ._result import Result


class ProgressLine:
    """A line that is written over itself on a terminal; elsewhere a new one every ten seconds."""

    def __init__(self) -> None:
        self._terminal = sys.stderr.isatty()
        self._next = 0.0 if self._terminal else time.monotonic() + 10
        self._width = 0

    def show(self, text: str) -> None:
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + (0.1 if self._terminal else 10)
        if self._terminal:
            text = text[: shutil.get_terminal_size().columns - 1]  # a line that wraps cannot be written over
            sys.stderr.write("\r" + text.ljust(self._width))
            self._width = len(text)
        else:
            sys.stderr.write(text + "\n")
        sys.stderr.flush()

    def finish(self) -> None:
        if self._width:
            sys.stderr.write("\r" + " " * self._width + "\r")
            sys.stderr.flush()
            self._width = 0


class IntegrationProgress:
    """Shows value, evaluations and time of an integration."""

    def __init__(self, relative: bool) -> None:
        self._line = ProgressLine()
        self._relative = relative  # the unit of the value says nothing to a reader

    def __call__(self, r: Result) -> None:
        said = f"relative error {r.relative_error:.2g}" if self._relative else str(r).splitlines()[0]
        self._line.show(f"integrating: {said}  {r.evaluations:.3g} evaluations, {r.seconds:.1f} s")

    def finish(self) -> None:
        self._line.finish()


class RenderProgress:
    """Shows share, time and error of a render."""

    def __init__(self) -> None:
        self._line = ProgressLine()

    def __call__(self, p: Progress) -> None:
        error = "" if p.relative_error is None else f", error {100 * p.relative_error:.3g} %"
        left = "" if p.seconds_left is None else f", about {p.seconds_left:.0f} s left"
        self._line.show(f"rendering: {100 * p.share:3.0f} %  {p.seconds:.1f} s elapsed{left}{error}")

    def finish(self) -> None:
        self._line.finish()
