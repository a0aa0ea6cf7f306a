"""Runs of montelux: what they say when they fail, and the CPU time that they take."""

from __future__ import annotations

import os
import subprocess
import tempfile
from dataclasses import dataclass
from typing import List


def last_line(text: str) -> str:
    lines = [line for line in text.strip().splitlines() if line.strip()]
    return lines[-1].strip() if lines else "no message"


def error_message(text: str) -> str:
    return last_line(text).removeprefix("montelux: error: ")


@dataclass(frozen=True)
class Run:
    status: int
    messages: str  # on its standard error
    cpu: float  # seconds


def run(command: List[str]) -> Run:
    with tempfile.TemporaryFile() as messages:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=messages)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        messages.seek(0)
        text = messages.read().decode(errors="replace")
    return Run(process.returncode, text, usage.ru_utime + usage.ru_stime)
