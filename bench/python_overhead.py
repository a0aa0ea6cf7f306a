"""What the Python package costs beside the library: microseconds per call of an integrand, and per cent of a render.

Usage: PYTHONPATH=BUILD/python python3 bench/python_overhead.py [BUILD/montelux]
"""

from __future__ import annotations

import operator
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import montelux
from montelux._core import call_integrand

SCENE = Path(__file__).resolve().parents[1] / "scenes/demo/studio.pbrt"


def integrands() -> None:
    """A call of a function that does nothing, and one that returns an array, less an empty call from Python."""
    print("microseconds per call of an integrand")
    for points in (8, 1024):
        for dimensions in (1, 4):
            values = np.zeros(points)
            into = min(call_integrand(operator.is_, points, dimensions, 500, True)[0] for _ in range(300))
            returned = min(call_integrand(lambda x: values, points, dimensions, 500)[0] for _ in range(300))
            print(
                f"  {points:5} points, {dimensions} variables: {1e6 * into:.3f} writing into the values, "
                f"{1e6 * returned:.3f} returning an array"
            )


def renders(program: str) -> None:
    """CPU time of the render loop, by turns in the program and here; neighbours of the processor only add to it."""
    times: list[tuple[float, float]] = []
    samples = 32
    scene = montelux.load(SCENE)
    scene.film.resolution = 240, 135
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(9):
            size = ["--resolution", "240x135", "--spp", str(samples), "--threads", "1"]
            command = [program, "render", str(SCENE), *size]
            text = subprocess.run(
                [*command, "-o", f"{folder}/out.exr", "--stats"], check=True, capture_output=True, text=True
            ).stdout
            line = next(line for line in text.splitlines() if line.startswith("render "))
            there = float(line.split(",")[1].split()[0])
            render = scene.render(spp=samples, threads=1, progress=lambda p: None).wait()
            here = render._look().cpu_seconds
            times.append((there, here))
            print(f"  render loop: {there:.3f} s of CPU in the program, {here:.3f} s here", flush=True)
    there, here = (min(column) for column in zip(*times))
    print(f"  difference of the shortest: {100 * (here / there - 1):+.2f} %")


integrands()
if len(sys.argv) > 1:
    renders(sys.argv[1])
