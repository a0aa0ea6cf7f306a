#!/usr/bin/env python3
"""Light that is hard to find: the error of each method after the same time.

Renders a scene by path tracing, with guided paths, bidirectionally without and with merging, and by Metropolis
transport, each for the same wall time, and compares with a reference picture (its noise is in every relMSE, and makes
ratios smaller). Usage:

    bench/hidden_light.py build/release/montelux scene.pbrt reference.exr --seconds 60 [--threads 2] [--keep FOLDER]
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

METHODS = {
    "path": ["--integrator", "path"],
    "guided": ["--integrator", "path", "--guiding", "on"],
    "guided-auto": ["--integrator", "path", "--guiding", "auto"],
    "bidirectional": ["--integrator", "bidirectional"],
    "merging": ["--integrator", "bidirectional", "--merging", "auto"],
    "metropolis": ["--integrator", "metropolis"],
    "auto": ["--integrator", "auto"],
}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("scene")
    parser.add_argument("reference")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--set-aside", type=float, default=0.1, help="per cent of the pixels, noisiest in the reference")
    parser.add_argument("--options", default="", help="more options of every render, such as '--resolution 200x112'")
    parser.add_argument("--methods", default=",".join(METHODS), help="of these, separated by commas")
    parser.add_argument("--keep", help="a folder for the pictures")
    arguments = parser.parse_args()
    names = arguments.methods.split(",")
    if unknown := [name for name in names if name not in METHODS]:
        parser.error(f"there is no method '{unknown[0]}'; expected some of {', '.join(METHODS)}")
    folder = pathlib.Path(arguments.keep or tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    first = None
    print("| method | samples per pixel | relMSE | first one's over it |\n|---|---|---|---|")
    for name in names:
        options = METHODS[name]
        picture = folder / f"{name}.exr"
        render = subprocess.run(
            [arguments.program, "render", arguments.scene, "--time", str(arguments.seconds), "--spp", "1000000",
             "--threads", str(arguments.threads), "--quiet", "-o", str(picture), *arguments.options.split(), *options],
            capture_output=True, text=True)
        if not picture.exists():
            print(f"| {name} | | {render.stderr.strip().splitlines()[-1] if render.stderr.strip() else 'failed'} | |")
            continue
        compared = json.loads(subprocess.run(
            [arguments.program, "compare", "--json", "--set-aside", str(arguments.set_aside), str(picture),
             arguments.reference], check=True, capture_output=True, text=True).stdout)
        info = subprocess.run([arguments.program, "info", str(picture)], capture_output=True, text=True).stdout
        samples = next((line.split()[-1] for line in info.splitlines() if "samplesTaken" in line), "")
        error = compared["rel_mse"]
        first = first or error
        print(f"| {name} | {samples} | {error:.4g} | {first / error:.3g} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
