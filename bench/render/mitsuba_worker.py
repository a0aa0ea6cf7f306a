"""Renders with one variant of Mitsuba on request: one JSON object a line in, one a line out.

Usage: mitsuba_worker.py VARIANT

{"load": {"scene", "folder", "width"}} reads a pbrt scene; {"render": {"spp", "seed", "threads", "picture"}} renders it,
writes the pixels to `picture` (.npy), and answers with the times of mitsuba.render alone.
"""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path
from typing import Any, Dict

import numpy as np

from mitsuba_scene import Converter
from mitsuba_values import Values
from pbrt_scene import read_scene


class Worker:
    def __init__(self, variant: str) -> None:
        import mitsuba as mi

        mi.set_variant(variant)
        import drjit as dr

        self.mi, self.dr, self.scene = mi, dr, None
        self.kernels = variant.startswith("llvm")

    def load(self, scene: str, folder: str, width: int) -> Dict[str, Any]:
        # With a pool of one thread Mitsuba 3.9 waits for ever for an EXR file.
        self.dr.set_thread_count(max(2, os.cpu_count() or 1))
        begin = time.perf_counter()
        read = read_scene(Path(scene))
        converted = Converter(read, Path(folder), width).convert()
        self.scene = self.mi.load_dict(Values(self.mi).fill(converted))
        return {"seconds": time.perf_counter() - begin, "notices": read.notices}

    def once(self, spp: int, seed: int) -> Any:
        image = self.mi.render(self.scene, spp=spp, seed=seed)
        self.dr.eval(image)
        self.dr.sync_thread()
        return image

    def render(self, spp: int, seed: int, threads: int, picture: str = "") -> Dict[str, Any]:
        self.dr.set_thread_count(threads)
        wall, cpu = time.perf_counter(), time.process_time()
        image = self.once(spp, seed)
        answer = {"wall": time.perf_counter() - wall, "cpu": time.process_time() - cpu}
        if picture:
            np.save(picture, np.array(image, dtype=np.float32))
        return answer

    def warm_up(self, spp: int, seed: int, threads: int) -> Dict[str, Any]:
        """Two renders: the first compiles; `compiled` says how many kernels the second one still compiled."""
        self.dr.set_thread_count(threads)
        self.once(spp, seed)
        if not self.kernels:
            return {"compiled": 0}
        with self.dr.scoped_set_flag(self.dr.JitFlag.KernelHistory, True):
            self.dr.kernel_history_clear()
            self.once(spp, seed + 1)
            history = self.dr.kernel_history([self.dr.KernelType.JIT])
        return {"compiled": sum(not kernel["cache_hit"] for kernel in history)}

    def answer(self, request: Dict[str, Any]) -> Dict[str, Any]:
        ((name, values),) = request.items()
        return {"load": self.load, "render": self.render, "warm_up": self.warm_up}[name](**values)


def main() -> None:
    # What libraries print must not mix with the answers.
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)
    try:
        worker = Worker(sys.argv[1])
        print(json.dumps({"version": worker.mi.__version__}), file=answers)
    except Exception as error:
        print(json.dumps({"failure": f"{type(error).__name__}: {error}"}), file=answers)
        return
    for line in sys.stdin:
        try:
            reply = worker.answer(json.loads(line))
        except Exception as error:  # a scene that fails must not end the comparison
            reply = {"failure": f"{type(error).__name__}: {error}"}
        print(json.dumps(reply), file=answers)


if __name__ == "__main__":
    main()
