"""Tables of what methods_agreement.py measured: a row for each scene, a column for each method."""

from __future__ import annotations

from typing import Any, Callable, Dict, List

Row = Dict[str, Any]
# Without a verdict.
CONSISTENT = "merging"


def differs(method: str, row: Row) -> bool:
    return method != CONSISTENT and "differs" in (row.get("bias_verdict"), row.get("z_verdict"))


def _marked(text: str, verdict: str) -> str:
    return {"agrees": text, "open": f"{text} ?", "differs": f"**{text}**"}[verdict]


def _bias(row: Row) -> str:
    return _marked(f"{100 * row['bias']:.2f} ± {100 * row['bias_error']:.2f}", row["bias_verdict"])


def _pooled_z(row: Row) -> str:
    text = f"{row['pooled_z']:.3f} ± {row['pooled_z_error']:.3f}"
    return f"{_marked(text, row['z_verdict'])} ({100 * row['doubtful']:.0f} %)"


def _within(row: Row) -> str:
    shares = ", ".join(f"{100 * s:.1f} ({100 * e:.1f})" for s, e in zip(row["within"][:2], row["expected"]))
    return f"{shares}; {100 * row['doubtful_of_renders']:.0f} %"


def _silent(row: Row) -> str:
    return f"{1000 * (1 - row['within'][2]):.2f} ({1000 * (1 - row['expected'][2]):.2f})"


def _cost(row: Row) -> str:
    return f"{row['samples']} x {row['seeds']}, {row['cpu']:.0f} s"


def table(results: Dict[str, Dict[str, Row]], methods: List[str], cell: Callable[[Row], str]) -> str:
    lines = [f"| scene | {' | '.join(methods)} |", "|---" * (len(methods) + 1) + "|"]
    for scene, rows in results.items():
        cells = ["-" if "refused" in rows[m] else cell(rows[m]) for m in methods]
        lines.append(f"| {scene} | {' | '.join(cells)} |")
    return "\n".join(lines)


def refusals(results: Dict[str, Dict[str, Row]], methods: List[str]) -> str:
    """The scenes of each reason of a method."""
    scenes: Dict[str, List[str]] = {}
    for scene, rows in results.items():
        for m in methods:
            if "refused" in rows[m]:
                scenes.setdefault(f"{m}: {rows[m]['refused']}", []).append(scene)
    return "\n".join(f"- {reason}: {', '.join(names)}" for reason, names in scenes.items())


def summary(results: Dict[str, Dict[str, Row]], method: str) -> str:
    rows = [r[method] for r in results.values() if "refused" not in r[method]]

    def counts(key: str) -> str:
        verdicts = [r[key] for r in rows]
        return ", ".join(f"{verdicts.count(v)} {v}" for v in ("agrees", "open", "differs") if v in verdicts)

    return f"- {method}, {len(rows)} scenes: bias {counts('bias_verdict')}; pooled z {counts('z_verdict')}"


def tables(results: Dict[str, Dict[str, Row]], methods: List[str]) -> str:
    return "\n\n".join(
        [
            "Bias of the mean luminance, per cent, with its standard error",
            table(results, methods, _bias),
            "Pooled z-scores, root mean square; in brackets the doubtful pixels that are left out",
            table(results, methods, _pooled_z),
            "Pixels within one and two claimed errors, per cent (by Student's law); doubtful pixels that are left out",
            table(results, methods, _within),
            "Pixels that fail silently, per thousand: beyond four claimed errors and not doubtful (by Student's law)",
            table(results, methods, _silent),
            "Samples per pixel of each of the renders, their number, and CPU seconds of all",
            table(results, methods, _cost),
            refusals(results, methods) or "No method refused a scene.",
            "\n".join(summary(results, m) for m in methods),
        ]
    )
