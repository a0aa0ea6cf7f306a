"""Pictures of the scenes in a folder by montelux and by the Python package `mitsuba`, held against each other.

Usage: mitsuba_peers.py MONTELUX FOLDER [--only NAME,...] [--variant scalar_spectral] [--side 64] [--json FILE]
Prints a row a scene. Exit status 1 if a scene fails that is not among the known differences (differences.json).
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

try:
    import mitsuba as mi
    import numpy as np
except ImportError as missing:
    print(f"skipped: there is no Python package '{missing.name}'")
    sys.exit(0)

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent / "bench" / "render"))

from llvm_library import environment  # noqa: E402
from program import error_message, last_line  # noqa: E402
from scene_text import prepared_scene, with_moments, write  # noqa: E402
from z_test import compare  # noqa: E402

SPP, MANY, REFERENCE = 256, 1024, 1024
TIME_LIMIT = 900  # seconds for one picture


class Refused(Exception):
    pass


def read_exr(file: Path) -> Tuple[np.ndarray, np.ndarray]:
    mi.set_variant("scalar_rgb")
    bitmap = mi.Bitmap(str(file))
    names = [field.name for field in bitmap.struct_()]
    values = np.array(bitmap, dtype=np.float64)
    colors = [values[..., names.index(c)] for c in "RGB"]
    errors = [values[..., names.index(f"stderr.{c}")] for c in "RGB"]
    return np.stack(colors, axis=-1), np.stack(errors, axis=-1)


def our_picture(program: str, scene: Path, spp: int, seed: int) -> Tuple[np.ndarray, np.ndarray]:
    out = scene.with_suffix(f".{spp}.exr")
    command = [program, "render", str(scene), "-o", str(out), "--spp", str(spp), "--sampler", "independent"]
    done = subprocess.run(command + ["--seed", str(seed)], capture_output=True, text=True, timeout=TIME_LIMIT)
    if done.returncode != 0:
        raise Refused(error_message(done.stderr).replace(f"{scene.parent}/", ""))
    return read_exr(out)


def their_picture(variant: str, scene: Path, spp: int, seed: int) -> Tuple[np.ndarray, np.ndarray]:
    out = scene.with_suffix(".npz")
    command = [sys.executable, str(HERE / "mitsuba_picture.py"), variant, str(scene), str(spp), str(seed), str(out)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=TIME_LIMIT, env=environment())
    if done.returncode != 0:
        raise RuntimeError(f"Mitsuba: {last_line(done.stderr)}")
    picture = np.load(out)
    return picture["mean"], picture["variance"]


def compared(program: str, scene: Path, variant: str, side: int, folder: Path) -> Dict[str, Any]:
    text = prepared_scene(scene, side)
    ours, theirs = folder / "ours.xml", folder / "theirs.xml"
    write(text, ours)
    write(with_moments(text), theirs)
    few, few_errors = our_picture(program, ours, SPP, 1)
    many, many_errors = our_picture(program, ours, MANY, 2)
    mean, variance = their_picture(variant, theirs, REFERENCE, 3)
    if mean.shape != few.shape:
        raise RuntimeError(f"pictures of {few.shape} and {mean.shape}")
    verdict = compare(few, few_errors, SPP, many, many_errors, mean, variance, REFERENCE)
    return {**verdict.__dict__, "passes": verdict.passes, "verdict": verdict.name}


def row(name: str, result: Dict[str, Any], known: Optional[str]) -> str:
    if "message" in result:
        return f"| {name} | {result['verdict']} | | | {known or result['message']} |"
    ratios = " ".join(f"{r:.3f}" for r in result["ratios"])
    shares = f"{100 * result['share']:.2f} ({100 * result['share_by_both']:.2f})"
    return f"| {name} | {result['verdict']} | {shares} | {ratios} | {known or ''} |"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--variant", default="scalar_spectral")
    parser.add_argument("--side", type=int, default=64)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    scenes: List[Path] = sorted(arguments.folder.glob("*.xml"))
    if arguments.only:
        scenes = [s for s in scenes if s.stem in arguments.only.split(",")]
    if not scenes:
        print(f"skipped: there are no scenes in {arguments.folder}")
        return 0
    known: Dict[str, str] = json.loads((HERE / "differences.json").read_text())
    results: Dict[str, Dict[str, Any]] = {}
    failed = 0
    program = os.path.abspath(arguments.program)
    print("| scene | verdict | pixels that pass, % (by both error bars) | mean X, Y, Z, ratio | |")
    print("|---|---|---|---|---|")
    for scene in scenes:
        with tempfile.TemporaryDirectory() as folder:
            try:
                result = compared(program, scene, arguments.variant, arguments.side, Path(folder))
            except Refused as e:
                missing = "there is no file" in str(e)
                verdict = "skipped" if missing else "refused"
                result = {"verdict": verdict, "passes": missing or "is not supported" in str(e), "message": str(e)}
            except (RuntimeError, OSError, ValueError, subprocess.TimeoutExpired) as e:
                result = {"verdict": "no picture", "passes": False, "message": str(e)}
        results[scene.stem] = result
        if not result["passes"] and scene.stem not in known:
            failed += 1
        print(row(scene.stem, result, known.get(scene.stem)), flush=True)
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=1))
    verdicts = [str(r["verdict"]) for r in results.values()]
    counts = ", ".join(f"{verdicts.count(v)} {v}" for v in sorted(set(verdicts)))
    print(f"{len(results)} scenes: {counts}; {failed} without a known reason")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
