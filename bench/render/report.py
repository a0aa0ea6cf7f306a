"""The comparison as Markdown."""

from __future__ import annotations

import statistics
from typing import List, Optional, Tuple

from comparison import Comparison, Measurement, ReferenceResult


def table(header: List[str], rows: List[List[str]]) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def base(found: List[Measurement], scene: str, spp: int) -> Optional[Measurement]:
    """What the others are compared with: the first engine that is Montelux."""
    fitting = (m for m in found if m.scene == scene and m.spp == spp and m.engine.startswith("montelux"))
    return next(fitting, None)


def ratio(m: Measurement, to: Optional[Measurement], kind: str) -> Optional[float]:
    if to is None:
        return None
    if kind == "cpu":
        return m.median_cpu() / to.median_cpu()
    trimmed = kind == "trimmed"
    return m.inefficiency(trimmed) / to.inefficiency(trimmed) if to.inefficiency(trimmed) > 0 else None


def shown(value: Optional[float]) -> str:
    return "" if value is None else f"{value:.2f}"


def measurements(comparison: Comparison) -> str:
    """Times and errors. Ratios are those of the engine over Montelux's: above 1 Montelux is better."""
    rows = []
    for m in comparison.measurements:
        to = base(comparison.measurements, m.scene, m.spp)
        ratios = [ratio(m, to, kind) for kind in ("cpu", "all", "trimmed")]
        rows.append(
            [m.scene, str(m.spp), m.engine, f"{m.median_cpu():.2f} ({min(m.cpu):.2f})"]
            + [f"{statistics.median(m.wall):.2f} ({min(m.wall):.2f})", f"{m.error(False):.3g} ({m.error(True):.3g})"]
            + [shown(ratios[0]), f"{shown(ratios[1])} ({shown(ratios[2])})" if to else ""]
        )
    header = ["scene", "spp", "engine", "CPU, us (least)", "wall, us (least)", "relMSE (trimmed)"]
    return table([*header, "CPU time ratio", "time to equal relMSE (trimmed), ratio"], rows)


def summary(comparison: Comparison) -> str:
    """Medians over the scenes of the ratios to Montelux."""
    rows = []
    found = comparison.measurements
    for engine in dict.fromkeys(m.engine for m in found):
        for spp in dict.fromkeys(m.spp for m in found):
            chosen = [m for m in found if m.engine == engine and m.spp == spp]
            medians = []
            for kind in ("cpu", "all", "trimmed"):
                ratios = [ratio(m, base(found, m.scene, spp), kind) for m in chosen]
                known = [r for r in ratios if r is not None]
                medians.append(statistics.median(known) if known else None)
            if medians[0] is not None and base(found, chosen[0].scene, spp) is not chosen[0]:
                rows.append([engine, str(spp), str(len(chosen)), *(shown(v) for v in medians)])
    return (
        table(["engine", "spp", "scenes", "CPU time ratio", "time to equal relMSE", "the same, trimmed"], rows)
        if rows
        else ""
    )


def difference(r: ReferenceResult, to: ReferenceResult) -> Tuple[float, float]:
    """Per cent by which the mean luminance is above Montelux's, and the standard error of that."""
    scale = 100 / to.luminance
    return scale * (r.luminance - to.luminance), scale * (r.error**2 + to.error**2) ** 0.5


def references(comparison: Comparison) -> str:
    rows = []
    for r in comparison.references:
        to = next((b for b in comparison.references if b.scene == r.scene and b.engine.startswith("montelux")), None)
        compared = ""
        if to is not None and to is not r:
            compared = "{:+.2f} % ({:.2f})".format(*difference(r, to))
        rows.append([r.scene, r.engine, str(r.spp), f"{r.luminance:.5g}", compared])
    return table(
        ["scene", "engine", "spp", "mean luminance of the reference", "difference from Montelux's (its error)"], rows
    )


def markdown(comparison: Comparison, machine: List[str]) -> str:
    s = comparison.settings
    engines = ", ".join(f"{e.name} {e.version}" for e in comparison.engines)
    setting = (
        f"{s.width} pixels wide, {s.threads} thread{'s' * (s.threads != 1)}, {s.runs} alternating runs: "
        "times are medians of microseconds per camera sample, errors are medians."
    )
    parts = [
        f"Engines: {engines}.",
        setting,
        *machine,
        measurements(comparison),
        summary(comparison),
        references(comparison),
    ]
    return "\n\n".join(part for part in parts if part)
