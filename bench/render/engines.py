"""The programs that are compared. Each opens a scene, warms up and renders; times are seconds of the render alone."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Optional

import numpy as np

import llvm_library
import montelux_scene
from mitsuba_scene import film_size
from pbrt_scene import read_scene
from pictures import read_pfm

WORKER = Path(__file__).resolve().parent / "mitsuba_worker.py"


class EngineError(Exception):
    """An engine, or a scene in it, that does not work here."""


@dataclass
class Run:
    wall: float
    cpu: float
    pixels: np.ndarray


class Montelux:
    """`montelux` or `montelux:SAMPLER`."""

    def __init__(self, name: str, program: Path, folder: Path) -> None:
        self.name, self.program, self.folder = name, program, folder
        self.sampler = name.partition(":")[2] or "independent"
        self.version = self._call(["--version"]).split()[1].rstrip(",")

    def _call(self, arguments: List[str]) -> str:
        try:
            done = subprocess.run([str(self.program), *arguments], capture_output=True, text=True)
        except OSError as error:
            raise EngineError(f"{self.program}: {error.strerror}") from error
        if done.returncode:
            raise EngineError(done.stderr.strip().splitlines()[-1] if done.stderr.strip() else "it failed")
        return done.stdout

    def open(self, scene: Path, width: int) -> List[str]:
        read = read_scene(scene)
        self.size = film_size(read, width)
        folder = tempfile.mkdtemp(dir=self.folder)
        self.scene = montelux_scene.copy_scene(scene, Path(folder))
        return []

    def warm_up(self, spp: int, seed: int, threads: int) -> None:
        self.render(spp, seed, threads)

    def render(self, spp: int, seed: int, threads: int) -> Run:
        out = self.folder / "montelux.pfm"
        size = "x".join(str(n) for n in self.size)
        text = self._call(
            ["render", str(self.scene), "--spp", str(spp), "--seed", str(seed), "--threads", str(threads), "--stats"]
            + ["--sampler", self.sampler, "--resolution", size, "-o", str(out)]
        )
        times = re.search(r"^render +([\d.]+) s, ([\d.]+) s of CPU", text, re.M)
        if not times:
            raise EngineError("--stats printed no times of the render")
        return Run(float(times[1]), float(times[2]), read_pfm(out))

    def close(self) -> None:
        pass


class Mitsuba:
    """A variant of Mitsuba, in a process of its own."""

    def __init__(self, name: str, python: str, folder: Path) -> None:
        self.name, self.folder = name, folder
        self.process = subprocess.Popen(
            [python, str(WORKER), name],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=llvm_library.environment(),
        )  # fmt: skip
        self.version = self._answer()["version"]

    def _answer(self) -> Dict[str, Any]:
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        if not line:
            raise EngineError(f"its process ended with the code {self.process.wait()}")
        answer = json.loads(line)
        if "failure" in answer:
            raise EngineError(answer["failure"])
        return answer

    def _ask(self, what: str, **values: Any) -> Dict[str, Any]:
        assert self.process.stdin is not None
        try:
            print(json.dumps({what: values}), file=self.process.stdin, flush=True)
        except BrokenPipeError:
            raise EngineError("its process has ended") from None
        return self._answer()

    def open(self, scene: Path, width: int) -> List[str]:
        folder = self.folder / f"meshes-{self.name}"
        folder.mkdir(exist_ok=True)
        return self._ask("load", scene=str(scene), folder=str(folder), width=width)["notices"]

    def warm_up(self, spp: int, seed: int, threads: int) -> None:
        compiled = self._ask("warm_up", spp=spp, seed=seed, threads=threads)["compiled"]
        if compiled:
            print(
                f"{self.name}: {compiled} kernels are compiled anew in each render; times contain that", file=sys.stderr
            )

    def render(self, spp: int, seed: int, threads: int) -> Run:
        out = self.folder / f"{self.name}.npy"
        answer = self._ask("render", spp=spp, seed=seed, threads=threads, picture=str(out))
        return Run(answer["wall"], answer["cpu"], np.load(out).astype(float))

    def close(self) -> None:
        if self.process.stdin and not self.process.stdin.closed:
            self.process.stdin.close()
        self.process.wait()


def start(names: List[str], program: Path, python: str, folder: Path) -> List[Any]:
    """The engines that work here; a message says which are skipped."""
    engines: List[Any] = []
    for name in names:
        engine: Optional[Any] = None
        try:
            if name.partition(":")[0] == "montelux":
                engine = Montelux(name, program, folder)
            else:
                engine = Mitsuba(name, python, folder)
        except (EngineError, OSError) as error:
            print(f"{name} is skipped: {error}", file=sys.stderr)
        if engine:
            engines.append(engine)
    return engines
