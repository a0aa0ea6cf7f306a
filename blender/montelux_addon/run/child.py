# SPDX-License-Identifier: GPL-3.0-or-later
"""The program as a child process."""

from __future__ import annotations

import re
import signal
import subprocess
import threading
import time
from pathlib import Path

INTERRUPTED = 130
TARGET_MISSED = 3

_address = re.compile(r"The render is shown at (\S+)")
_severity = re.compile(r"montelux: (error|warning): (.*)")


class Child:
    """A running `montelux render`. Its standard error is read on a thread, or a full pipe would stop the program."""

    def __init__(self, arguments: list[str], folder: Path):
        self._lock = threading.Lock()
        self._address: str | None = None
        self._sentences: dict[str, list[str]] = {"error": [], "warning": []}
        self._last_line = ""
        self._process = subprocess.Popen(
            arguments,
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
        )
        self._reader = threading.Thread(target=self._read, name="montelux-messages", daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stderr is not None
        for line in self._process.stderr:
            line = line.strip()
            with self._lock:
                if found := _address.search(line):
                    self._address = found[1]
                elif found := _severity.match(line):
                    self._sentences[found[1]].append(found[2])
                if line:
                    self._last_line = line

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def address(self) -> str | None:
        """Of the page that shows the render, once it is printed."""
        with self._lock:
            return self._address

    @property
    def warnings(self) -> list[str]:
        with self._lock:
            return list(self._sentences["warning"])

    def poll(self) -> int | None:
        """The exit code, or None while the program runs. Once there is one, all messages are there, too."""
        code = self._process.poll()
        if code is not None:
            self._reader.join()
        return code

    def failure(self) -> str:
        """One sentence on why the program failed; its exit code is one of failure."""
        code = self._process.returncode
        with self._lock:
            if self._sentences["error"]:
                return self._sentences["error"][0]
            if code < 0:
                return f"The program was ended by {signal.Signals(-code).name}"
            return f"The program ended with exit code {code}" + (f": {self._last_line}" if self._last_line else "")

    def interrupt(self) -> None:
        """Asks the program to write the picture so far and end."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)

    def kill(self) -> None:
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        self._reader.join()

    def wait(self, seconds: float) -> int | None:
        end = time.monotonic() + seconds
        while (code := self.poll()) is None and time.monotonic() < end:
            time.sleep(0.02)
        return code
