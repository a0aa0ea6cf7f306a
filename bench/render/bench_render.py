"""Montelux beside Mitsuba 3 on pbrt scenes: time per camera sample, error, time to equal error.

All engines render the same scenes in alternation: the same resolution, box filter, path depth and start of Russian
roulette, independent samples. Loading and the compilation of kernels do not count.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
import tempfile
from pathlib import Path
from typing import List

ENGINES = "montelux,llvm_ad_rgb,llvm_ad_spectral,scalar_spectral"


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="Ratios are to Montelux: above 1 Montelux needs less. See docs/measurements/render.md.",
    )
    parser.add_argument("montelux", type=Path, help="program to measure")
    parser.add_argument("scenes", type=Path, nargs="+", metavar="SCENE", help="pbrt scene, or folder with a scene.pbrt")
    parser.add_argument("--python", default=sys.executable, help="Python that has mitsuba; default: this one")
    parser.add_argument(
        "--engines",
        default=ENGINES,
        type=names,
        metavar="A,B",
        help=f"montelux[:SAMPLER] and variants of Mitsuba; default: {ENGINES}",
    )
    parser.add_argument("--spp", default="16,64", type=counts, metavar="N,M", help="samples per pixel; default: 16,64")
    parser.add_argument("--runs", default=3, type=count, metavar="N", help="alternating runs; default: 3")
    parser.add_argument("--threads", default=1, type=count, metavar="N", help="threads of each engine; default: 1")
    parser.add_argument(
        "--width", default=200, type=count, metavar="PIXELS", help="width of the pictures; default: 200"
    )
    parser.add_argument(
        "--reference-spp",
        default=2048,
        type=count,
        metavar="N",
        help="samples per pixel of the references; default: 2048",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="also write every figure to this file")
    return parser.parse_args()


def count(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError("must be at least 1")
    return value


def counts(text: str) -> List[int]:
    return [count(part) for part in text.split(",")]


def names(text: str) -> List[str]:
    return [part for part in text.split(",") if part]


def scene_file(path: Path) -> Path:
    """A folder means its scene.pbrt, or else its only .pbrt file."""
    if not path.is_dir():
        return path
    found = sorted(path.glob("*.pbrt"))
    return path / "scene.pbrt" if len(found) != 1 else found[0]


def load() -> str:
    return " ".join(f"{value:.2f}" for value in os.getloadavg())


def processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()


def main() -> int:
    options = arguments()
    try:
        import numpy  # noqa: F401
    except ImportError:
        print("bench_render.py needs numpy (Debian: python3-numpy); nothing was measured", file=sys.stderr)
        return 1
    from comparison import Comparison, Settings, progress_done
    from engines import EngineError, start
    from pbrt_text import SceneError
    from report import markdown

    settings = Settings(options.width, options.spp, options.reference_spp, options.runs, options.threads)
    before = load()
    with tempfile.TemporaryDirectory() as folder:
        engines = start(options.engines, options.montelux.resolve(), options.python, Path(folder))
        if not engines:
            print("no engine works here; nothing was measured", file=sys.stderr)
            return 1
        comparison = Comparison(engines, settings)
        failed = False
        for given in options.scenes:
            file = scene_file(given).resolve()
            name = file.parent.name if file.name == "scene.pbrt" else file.stem
            try:
                comparison.run(file, name)
            except (EngineError, SceneError) as error:
                print(f"{name}: {error}", file=sys.stderr)
                failed = True
        for engine in engines:
            engine.close()
    progress_done()
    machine = [f"Machine: {processor()}, {os.cpu_count()} processors; load average {before} before, {load()} after."]
    print(markdown(comparison, machine))
    if options.json:
        options.json.write_text(json.dumps({"machine": machine[0], **comparison.as_json()}, indent=1) + "\n")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
