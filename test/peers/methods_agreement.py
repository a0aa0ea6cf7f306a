"""Every method beside path tracing on many scenes: the same picture, and error bars that hold?

Usage: methods_agreement.py MONTELUX [--shared FOLDER] [--only SCENE,...] [--methods METHOD,...] [--seeds N] [--jobs N]
                            [--json FILE]

Renders each scene of agreement_scenes.json with several seeds by each method, and prints Markdown tables of what
agreement.py measures. 'path' is path tracing against itself: half of its seeds against the other half, which shows what
the test gives where nothing differs. With four times the seeds errors of the bias are half as large. 'merging' is consistent, not unbiased: it has no verdict. Rows that --json FILE
contains already are not rendered again. Exit status 1 if a method differs.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Dict, List, Optional

try:
    import numpy as np
except ImportError as missing:
    print(f"skipped: there is no Python package '{missing.name}'")
    sys.exit(0)

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.append(str(ROOT / "blender" / "montelux_addon" / "run"))

from agreement import Renders, agreement  # noqa: E402
from agreement_tables import Row, differs, tables  # noqa: E402
from exr import ExrError, ExrPicture  # noqa: E402
from program import error_message, run  # noqa: E402

SEEDS = 16
MOST_SEEDS = 1000  # those of the methods must differ


@dataclass(frozen=True)
class Method:
    options: List[str]
    samples: float  # per pixel, over those of the scene
    first_seed: int  # with the same seeds methods would share random numbers, and agree too well


METHODS = {
    "path": Method(["--integrator", "path"], 4, 1),
    "guided": Method(["--integrator", "path", "--guiding", "on"], 1, 1001),
    "bidirectional": Method(["--integrator", "bidirectional"], 1, 2001),
    "metropolis": Method(["--integrator", "metropolis"], 1, 3001),
    "manifold": Method(["--integrator", "path", "--manifold-sampling", "on"], 0.25, 4001),
    "merging": Method(["--integrator", "bidirectional", "--merging", "auto"], 0.25, 5001),
}


class Refused(Exception):
    pass


@dataclass(frozen=True)
class Scene:
    name: str
    file: Path
    samples: int
    options: List[str]

    def command(self, program: str, method: Method, seed: int, out: Path) -> List[str]:
        samples = max(16, round(method.samples * self.samples))
        return [program, "render", str(self.file), "-o", str(out), "--spp", str(samples), "--seed", str(seed),
                "--sampler", "independent", "--threads", "1", "--layers", "default,replicates",
                *method.options, *self.options]  # fmt: skip


def read_scenes(shared: Path, generated: Path) -> List[Scene]:
    scenes = []
    for entry in json.loads((HERE / "agreement_scenes.json").read_text()):
        text = entry["file"]
        file = shared / text.removeprefix("shared/") if text.startswith("shared/") else ROOT / text
        if file.suffix == ".py":  # it writes the scene
            written = generated / f"{entry['name']}.pbrt"
            with open(written, "w") as out:
                subprocess.run([sys.executable, str(file), *entry["arguments"]], stdout=out, check=True)
            file = written
        options = [o.replace("shared/", f"{shared}/") if o.startswith("shared/") else o for o in entry["options"]]
        scenes.append(Scene(entry["name"], file, entry["samples"], options))
    return scenes


def rendered(
    program: str, scene: Scene, name: str, seeds: int, folder: Path, pool: ThreadPoolExecutor
) -> tuple[Renders, float]:
    """By one method with all seeds, and the CPU time of all."""
    method = METHODS[name]

    def picture(index: int) -> tuple[ExrPicture, float]:
        out = folder / f"{name}.{index}.exr"
        done = run(scene.command(program, method, method.first_seed + index, out))
        if done.status != 0:
            raise Refused(error_message(done.messages))
        if "manifold sampling has no effect" in done.messages:
            raise Refused("no effect: nothing in the scene is covered")
        read = ExrPicture(out)
        out.unlink()
        return read, done.cpu

    pictures = [picture(0)]  # refusals show at once
    pictures += pool.map(picture, range(1, seeds))

    def stacked(*names: str) -> np.ndarray:
        arrays = [p.stack(*names) for p, _ in pictures]
        return np.array([a if len(names) > 1 else a[..., 0] for a in arrays], dtype=np.float64)

    renders = Renders(
        stacked("R", "G", "B"),
        stacked("stderr.R", "stderr.G", "stderr.B"),
        stacked("replicates"),
        np.isin(stacked("warning"), (1, 2)),
    )
    return renders, sum(cpu for _, cpu in pictures)


def rows_of(
    program: str, scene: Scene, names: List[str], seeds: int, known: Dict[str, Row], pool: ThreadPoolExecutor
) -> Dict[str, Row]:
    rows: Dict[str, Row] = {}
    reference: Optional[Renders] = None
    wanted = [n for n in names if n not in known]
    if not wanted:
        return rows
    with tempfile.TemporaryDirectory() as folder:
        for name in ["path"] + [n for n in wanted if n != "path"]:
            try:
                renders, cpu = rendered(program, scene, name, seeds, Path(folder), pool)
            except (Refused, ExrError) as e:
                rows[name] = {"refused": str(e).replace(f"{scene.file.parent}/", "")}
                if name == "path":
                    return {n: rows["path"] for n in wanted}
                continue
            if name == "path":
                reference = renders
                half = seeds // 2
                result = agreement(renders.part(slice(0, half)), renders.part(slice(half, seeds)))
            else:
                assert reference is not None
                result = agreement(reference, renders)
            samples = int(scene.command(program, METHODS[name], 0, Path())[6])
            rows[name] = {
                **asdict(result),
                "bias_verdict": result.bias_verdict,
                "z_verdict": result.z_verdict,
                "samples": samples,
                "seeds": seeds,
                "size": "x".join(str(n) for n in renders.means.shape[2:0:-1]),
                "cpu": cpu,
            }
            print(f"{scene.name}, {name}: bias {100 * result.bias:.2f} +- {100 * result.bias_error:.2f} %, "
                  f"pooled z {result.pooled_z:.3f} +- {result.pooled_z_error:.3f}, {cpu:.1f} s",
                  file=sys.stderr, flush=True)  # fmt: skip
    return rows


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--shared", type=Path, default=ROOT.parent / "shared", help="default: beside the repository")
    parser.add_argument("--only", default="", help="names of scenes")
    parser.add_argument("--methods", default=",".join(METHODS))
    parser.add_argument("--seeds", type=int, default=SEEDS, help="renders of each scene by each method (16)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="renders at the same time, of one thread each")
    parser.add_argument("--json", type=Path, help="figures, read and written")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    if not os.access(program, os.X_OK):
        parser.error(f"there is no program '{arguments.program}'")
    if not 4 <= arguments.seeds <= MOST_SEEDS:
        parser.error(f"expected 4 to {MOST_SEEDS} seeds")
    names = arguments.methods.split(",")
    if unknown := sorted(set(names) - set(METHODS)):
        parser.error(f"unknown method '{unknown[0]}': there are {', '.join(METHODS)}")
    results: Dict[str, Dict[str, Row]] = {}
    if arguments.json and arguments.json.exists():
        results = json.loads(arguments.json.read_text())
    with tempfile.TemporaryDirectory() as generated, ThreadPoolExecutor(arguments.jobs) as pool:
        scenes = read_scenes(arguments.shared.resolve(), Path(generated))
        if arguments.only:
            if unknown := sorted(set(arguments.only.split(",")) - {s.name for s in scenes}):
                parser.error(f"unknown scene '{unknown[0]}': there are {', '.join(s.name for s in scenes)}")
            scenes = [s for s in scenes if s.name in arguments.only.split(",")]
        for scene in scenes:
            rows = results.setdefault(scene.name, {})
            rows.update(rows_of(program, scene, names, arguments.seeds, rows, pool))
            if arguments.json:
                arguments.json.write_text(json.dumps(results, indent=1))
    print(tables({s.name: results[s.name] for s in scenes}, names))
    return 1 if any(differs(name, row) for rows in results.values() for name, row in rows.items()) else 0


if __name__ == "__main__":
    sys.exit(main())
