# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the program is, and which version."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

SECONDS_TO_ANSWER = 10


class ProgramError(Exception):
    """One sentence for the user."""


def find_program(preference: str) -> Path:
    """The program that the preferences name, or else the one on PATH."""
    where = "set its path in Preferences > Add-ons > Montelux"
    if preference:
        path = Path(preference).expanduser()
        if not path.is_file():
            raise ProgramError(f"There is no program at {path}: {where}, or leave it empty to search PATH")
        return path
    found = shutil.which("montelux")
    if found is None:
        raise ProgramError(f"The program 'montelux' is not on PATH: {where}")
    return Path(found)


def version_of(program: Path) -> str:
    """What `montelux --version` prints."""
    try:
        answer = subprocess.run(
            [program, "--version"], capture_output=True, text=True, timeout=SECONDS_TO_ANSWER, check=False
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise ProgramError(f"{program} does not run: {error}") from error
    text = answer.stdout.strip()
    if answer.returncode != 0 or not text.startswith("montelux"):
        raise ProgramError(f"{program} is not Montelux: '--version' gives exit code {answer.returncode}")
    return text
