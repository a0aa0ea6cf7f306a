"""WatchedProgram: starts Montelux for the add-on, and keeps what the add-on deletes."""

from __future__ import annotations

import json
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np

_SCRIPT = """#!{python}
import json, os, shutil, sys
from pathlib import Path
folder = Path({folder!r})
run = folder / str(len(list(folder.glob("*"))))
if sys.argv[1] == "render":
    shutil.copytree(Path.cwd(), run)
    (run / "command.json").write_text(json.dumps({{"pid": os.getpid(), "arguments": sys.argv[1:], "cwd": os.getcwd()}}))
os.execv({program!r}, [{program!r}, *sys.argv[1:]])
"""


class WatchedProgram:
    def __init__(self, program: Path, folder: Path):
        self.program = program
        self.folder = folder / "runs"
        self.folder.mkdir(parents=True)
        self.script = folder / "montelux"
        self.script.write_text(_SCRIPT.format(python=sys.executable, folder=str(self.folder), program=str(program)))
        self.script.chmod(0o755)

    @property
    def runs(self) -> list[Path]:
        """Folders with the files that each run was given, in order."""
        return sorted(self.folder.glob("*"), key=lambda path: int(path.name))

    def command(self, run: Path) -> dict:
        return json.loads((run / "command.json").read_text())

    def render_again(self, run: Path) -> Path:
        """The same command on the kept files, without the add-on; the picture."""
        command = self.command(run)
        arguments = [a.replace(command["cwd"], str(run)) for a in command["arguments"] if a != "--view"]
        done = subprocess.run([self.program, *arguments], capture_output=True, text=True, check=False)
        assert done.returncode == 0, f"{shlex.join(arguments)}: {done.stderr}"
        return run / "picture.exr"

    def layer(self, picture: Path, name: str) -> np.ndarray:
        """A layer of a picture, as the program converts it; rows from the top."""
        output = picture.with_suffix(".pfm")
        subprocess.run([self.program, "convert", picture, output, "--layer", name], capture_output=True, check=True)
        kind, size, _, texels = output.read_bytes().split(b"\n", 3)
        width, height = map(int, size.split())
        return np.frombuffer(texels, "<f4").reshape(height, width, 3 if kind == b"PF" else 1)[::-1]
