"""In a window of Blender, where renders have a thread of their own: Debian's on a virtual screen, if it is there."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest
from build_zip import build_zip

SESSION = Path(__file__).with_name("gui_session.py")

needs_blender = pytest.mark.skipif(
    not (shutil.which("blender") and shutil.which("xvfb-run")),
    reason="needs blender and xvfb-run (Debian: blender python3-numpy xvfb)",
)


def run_session(way: str, program: Path, folder: Path) -> dict:
    build_zip(folder / "montelux-blender.zip")
    arguments = ["xvfb-run", "-a", "blender", "--factory-startup", "--python", SESSION, "--"]
    arguments += [folder / "montelux-blender.zip", program, folder / "picture", way]
    own = {name: value for name, value in os.environ.items() if not name.startswith(("BLENDER_", "PYTHON"))}
    done = subprocess.run(
        arguments, capture_output=True, text=True, timeout=120, check=False, env={**own, "HOME": str(folder)}
    )
    (line,) = (line for line in done.stdout.splitlines() if line.startswith("SEEN ")) or (None,)
    assert line is not None and "Traceback" not in done.stderr + done.stdout, done.stdout + done.stderr
    return json.loads(line.removeprefix("SEEN "))


@needs_blender
def test_still(program: Path, tmp_path: Path) -> None:
    seen = run_session("still", program, tmp_path)
    assert seen["ended"] == "complete"
    assert seen["export on the main thread"] == [True] and seen["render on the main thread"] == [False]
    assert seen["live"] >= 2 and seen["scenes"] == 1
    assert (tmp_path / "picture.png").stat().st_size > 1000


@needs_blender
def test_animation(program: Path, tmp_path: Path) -> None:
    seen = run_session("animation", program, tmp_path)
    assert seen["ended"] == "complete" and seen["export on the main thread"] == [True, True]
    assert (tmp_path / "picture0003.png").is_file() and (tmp_path / "picture0004.png").is_file()


@needs_blender
def test_cancel(program: Path, tmp_path: Path) -> None:
    seen = run_session("cancel", program, tmp_path)
    assert seen["seconds"] < 20  # as long as the add-on waits before it kills the program
    assert (tmp_path / "picture.png").stat().st_size > 1000
