"""The measurements: engines in alternation on one scene, errors against each engine's own reference."""

from __future__ import annotations

import os
import statistics
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Dict, List, Tuple

from engines import EngineError
from pictures import Reference, relative_errors

REFERENCE_PARTS = 8  # independent renders; their scatter gives the error of the mean luminance
REFERENCE_SEED = 1_000_000
WARM_UP_SEED = 2_000_000


@dataclass
class Settings:
    width: int
    samples: List[int]
    reference_samples: int
    runs: int
    threads: int


@dataclass
class Measurement:
    """One engine at one sample count. Times are microseconds per camera sample, one for each run."""

    scene: str
    engine: str
    spp: int
    cpu: List[float]
    wall: List[float]
    errors: List[Tuple[float, float]]  # relMSE of all pixels and without the worst

    def median_cpu(self) -> float:
        return statistics.median(self.cpu)

    def error(self, trimmed: bool) -> float:
        return statistics.median(e[trimmed] for e in self.errors)

    def inefficiency(self, trimmed: bool) -> float:
        """Error times CPU time: the time that reaches a given error is proportional to it."""
        return self.error(trimmed) * self.median_cpu()


@dataclass
class ReferenceResult:
    scene: str
    engine: str
    spp: int
    luminance: float
    error: float


def estimator(name: str) -> str:
    """Engines of one estimator share a reference: scalar and llvm variants, all samplers of Montelux."""
    return name.partition(":")[0].replace("llvm_ad", "scalar")


class Comparison:
    def __init__(self, engines: List[Any], settings: Settings) -> None:
        self.engines, self.settings = engines, settings
        self.measurements: List[Measurement] = []
        self.references: List[ReferenceResult] = []

    def run(self, scene: Path, name: str) -> None:
        engines = self.open(scene, name)
        references: Dict[str, Reference] = {}
        for engine in sorted(engines, key=lambda e: e.name.startswith("scalar")):  # the fastest of an estimator
            if estimator(engine.name) not in references:
                progress(f"{name}: reference of {engine.name}")
                references[estimator(engine.name)] = found = self.reference(engine)
                spp = REFERENCE_PARTS * self.part_samples()
                self.references.append(ReferenceResult(name, engine.name, spp, found.luminance, found.error))
        for spp in self.settings.samples:
            self.alternate(engines, references, name, spp)

    def open(self, scene: Path, name: str) -> List[Any]:
        opened, notices = [], {}  # type: List[Any], Dict[str, None]
        for engine in self.engines:
            progress(f"{name}: loading into {engine.name}")
            try:
                notices.update(dict.fromkeys(engine.open(scene, self.settings.width)))
                engine.warm_up(1, WARM_UP_SEED, self.settings.threads)
                opened.append(engine)
            except EngineError as error:
                print(f"{name} is skipped in {engine.name}: {error}", file=sys.stderr)
        for notice in notices:
            print(f"not the same in Mitsuba: {notice}", file=sys.stderr)
        return opened

    def part_samples(self) -> int:
        return max(1, self.settings.reference_samples // REFERENCE_PARTS)

    def reference(self, engine: Any) -> Reference:
        processors = os.cpu_count() or 1
        seeds = range(REFERENCE_SEED, REFERENCE_SEED + REFERENCE_PARTS)
        return Reference([engine.render(self.part_samples(), seed, processors).pixels for seed in seeds])

    def alternate(self, engines: List[Any], references: Dict[str, Reference], name: str, spp: int) -> None:
        rows = {e.name: Measurement(name, e.name, spp, [], [], []) for e in engines}
        for engine in engines:
            progress(f"{name}, {spp} spp: warming up {engine.name}")
            engine.warm_up(spp, WARM_UP_SEED, self.settings.threads)
        for run in range(self.settings.runs):
            for engine in engines:
                progress(f"{name}, {spp} spp, run {run + 1} of {self.settings.runs}: {engine.name}")
                done = engine.render(spp, run + 1, self.settings.threads)
                samples = 1e-6 * done.pixels.shape[0] * done.pixels.shape[1] * spp
                row = rows[engine.name]
                row.cpu.append(done.cpu / samples)
                row.wall.append(done.wall / samples)
                row.errors.append(relative_errors(done.pixels, references[estimator(engine.name)].pixels))
        self.measurements += rows.values()

    def as_json(self) -> Dict[str, Any]:
        return {
            "settings": asdict(self.settings),
            "engines": {e.name: e.version for e in self.engines},
            "measurements": [asdict(m) for m in self.measurements],
            "references": [asdict(r) for r in self.references],
        }


def progress(text: str) -> None:
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)


def progress_done() -> None:
    if sys.stderr.isatty():
        print("\r\033[K", end="", file=sys.stderr, flush=True)
