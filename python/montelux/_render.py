"""Renders that run in the background, give snapshots, and can be stopped early."""

from __future__ import annotations

import time
import warnings
import weakref
from collections.abc import Callable, Iterator
from typing import Any

from . import _core
from ._core import Error
from ._picture import Picture
from ._progress import RenderProgress


class Progress:
    """How far a render is: `samples` of (probably) `samples_total` over all pixels, `seconds`, and the relative
    error of the picture, None while it is not known; `share`, from 0 to 1, of the way to the limit that ends it
    (samples, error or time), and `seconds_left` until then, None while that cannot be estimated."""

    def __init__(
        self,
        samples: int,
        samples_total: int,
        seconds: float,
        relative_error: float | None,
        share: float,
        seconds_left: float | None,
    ) -> None:
        self.samples = samples
        self.samples_total = samples_total
        self.seconds = seconds
        self.relative_error = relative_error
        self.share = share
        self.seconds_left = seconds_left

    def __repr__(self) -> str:
        error = "" if self.relative_error is None else f", relative error {100 * self.relative_error:.3g} %"
        return f"<Progress: {100 * self.share:.0f} %, {self.seconds:.1f} s{error}>"


class View:
    """The page that shows a render while it runs, in a browser (`url`) or as the value of a notebook's cell. It is on
    the loopback address: for a notebook on another machine, forward its port."""

    def __init__(self, url: str) -> None:
        self.url = url

    def __repr__(self) -> str:
        return f"<View: {self.url}>"

    def _repr_html_(self) -> str:
        return (
            f'<iframe src="{self.url}" title="Render" style="width: 100%; height: 720px; border: 0"></iframe>'
            f'<a href="{self.url}" target="_blank">Open in a window of its own</a>'
        )


class Render(Picture):
    """A render of a scene, which runs in the background from the moment that `Scene.render` returns it.

    Reading a result (`mean`, `save`, ...) waits for the end. Iterating gives a `Picture` of the render so far
    every second (or every `every` seconds), and at last the finished one. Ctrl-C during a wait ends the render
    with the result so far: `stopped_by` is then 'cancelled'. The interpreter's lock is released.
    """

    def __init__(
        self,
        job: _core.RenderJob,
        progress: bool | Callable[[Progress], object],
        every: float,
    ) -> None:
        self._job = job
        self._held = None
        self._made = None
        self._every = every
        self._watch = RenderProgress() if progress is True else (progress or None)
        self._end = weakref.finalize(self, _end, job)  # at the exit of the interpreter, too

    @property
    def finished(self) -> bool:
        """Whether it has ended; never waits."""
        return self._held is not None or self._job.wait(0.0)

    @property
    def progress(self) -> Progress:
        """How far it is; never waits."""
        return Progress(*self._job.progress())

    @property
    def view(self) -> View:
        """The page that shows it, for as long as this object lives; after the end, the finished picture. Needs
        `scene.render(view=True)`."""
        url = self._job.view_url
        if not url:
            raise Error("render: no page shows this render; start it by scene.render(view=True)")
        return View(url)

    @property
    def stopped_by(self) -> str:
        """'samples' (all were taken), 'error' (the target was reached), 'time' or 'cancelled'."""
        return self._snapshot().stop

    @property
    def guide(self) -> _core.Guide | None:
        """What paths of a guided render have followed (`scene.integrator.guiding`), after its end; None where they
        followed no guide."""
        self._snapshot()
        return self._job.guide

    def stop(self) -> Render:
        """Ends it now, with the result so far."""
        self._job.cancel()
        return self.wait()

    def wait(self) -> Render:
        """Waits for the end."""
        self._snapshot()
        return self

    def __iter__(self) -> Iterator[Picture]:
        next_snapshot = time.monotonic() + self._every
        while not self._wait_until(next_snapshot):
            try:
                snapshot = self._job.snapshot(0.1)
            except KeyboardInterrupt:
                self._job.cancel()
                break
            if snapshot is None:
                continue  # the render ends, or a sample takes long
            yield Picture(snapshot)
            next_snapshot = time.monotonic() + self._every
        yield self.wait()

    def _wait_until(self, moment: float) -> bool:
        """Waits for the end, but until a moment at most; whether it has come."""
        try:
            # Signals are handled between the waits.
            while not self._job.wait(min(0.05, max(0.0, moment - time.monotonic()))):
                if self._watch is not None:
                    self._watch(self.progress)
                if time.monotonic() >= moment:
                    return False
        except KeyboardInterrupt:
            self._job.cancel()
            while not self._job.wait(1.0):
                pass
        return True

    def _snapshot(self) -> _core.RenderSnapshot:
        if self._held is None:
            self._wait_until(float("inf"))
            if isinstance(self._watch, RenderProgress):
                self._watch.finish()
            self._held = self._job.result()
            for text in self._job.warnings():
                warnings.warn(text, RuntimeWarning, stacklevel=3)
        return self._held

    def __repr__(self) -> str:
        if not self.finished:
            return f"<Render, going on: {self.progress!r}>"
        return super().__repr__()[:-1] + f", stopped by {self.stopped_by}>"


def _end(job: _core.RenderJob) -> None:
    job.cancel()
    while not job.wait(1.0):
        pass
