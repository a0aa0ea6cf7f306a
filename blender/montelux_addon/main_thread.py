# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a function on Blender's main thread, where operators are safe."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeVar

import bpy

Result = TypeVar("Result")

SECONDS_BETWEEN_LOOKS = 0.05


class Cancelled(Exception):
    pass


def on_main_thread(function: Callable[[], Result], is_cancelled: Callable[[], bool]) -> Result:
    """The result of `function`. Renders have a thread of their own in Blender's window, but not in the background.

    Raises what the function raises, or Cancelled before it has begun.
    """
    if bpy.app.background or threading.current_thread() is threading.main_thread():
        return function()
    call = _Call(function)
    bpy.app.timers.register(call.run)
    while not call.ended.wait(SECONDS_BETWEEN_LOOKS):
        if is_cancelled() and call.take_back():
            raise Cancelled
    if call.error is not None:
        raise call.error
    return call.result


class _Call:
    def __init__(self, function: Callable):
        self.function = function
        self.ended = threading.Event()
        self.result = None
        self.error: BaseException | None = None
        self._begins = threading.Lock()

    def run(self) -> None:
        """As a timer: None means once."""
        if not self._begins.acquire(blocking=False):
            return
        try:
            self.result = self.function()
        except BaseException as error:  # goes to the thread that waits
            self.error = error
        self.ended.set()

    def take_back(self) -> bool:
        """Whether the function will never begin."""
        return self._begins.acquire(blocking=False)
