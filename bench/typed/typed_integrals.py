#!/usr/bin/env python3
"""Integrals as people type them, through the program: which results claim their target and are wrong?

    bench/typed/typed_integrals.py MONTELUX [--methods auto,quasi] [--targets 1e-2,1e-3,1e-4] [--seeds 4]
                                            [--families wide]

Reads formulas.tsv (integrals with known values) and convergence.tsv (divergent and slowly convergent ones), both
beside this file. A run is silently wrong if it exits with code 0 although a component is more than four of its errors
from the truth; a divergent integral must end with the reason "diverges".
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import subprocess
import sys
import time
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parent
PATIENCE = 100.0  # seconds after which a run is ended by force
ROUNDING = 1e-13  # relative error of values that rounding may cause


@dataclass(frozen=True)
class Case:
    family: str
    formulas: tuple[str, ...]
    over: tuple[str, ...]
    exact: tuple[float, ...] | None  # None: diverges

    def name(self) -> str:
        return " ; ".join(self.formulas) + "  over " + " ".join(self.over)


@dataclass(frozen=True)
class Run:
    case: Case
    method: str
    target: str
    seed: int
    seconds: float
    code: int
    result: dict | None

    def _numbers(self, key: str) -> list[float]:
        value = self.result[key]
        many = value if isinstance(value, list) else [value]
        return [math.inf if v is None else v for v in many]

    def within(self, errors: float) -> bool:
        """Is the truth within so many claimed errors, in every component?"""
        exact = self.case.exact
        assert exact is not None
        return all(
            abs(v - t) <= errors * e + ROUNDING * abs(t)
            for v, e, t in zip(self._numbers("value"), self._numbers("standard_error"), exact)
        )

    def claims(self) -> bool:
        return self.code == 0 and self.result is not None

    def silent(self) -> bool:
        return self.claims() and (self.case.exact is None or not self.within(4))

    def called_divergent(self) -> bool:
        return self.result is not None and self.result["stop"] == "diverges"


def read(name: str) -> list[Case]:
    cases = []
    with open(HERE / name, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file, delimiter="\t", quoting=csv.QUOTE_NONE):
            exact = None if row["exact"] == "diverges" else tuple(float(v) for v in row["exact"].split(" ; "))
            cases.append(Case(row["family"], tuple(row["formulas"].split(" ; ")), tuple(row["over"].split()), exact))
    return cases


def run(program: str, case: Case, method: str, target: str, seed: int, limit: list[str]) -> Run:
    """An empty target: none."""
    words = [program, "integrate", "--json", "--quiet", "--threads", "1", "--method", method, "--seed", str(seed)]
    words += [*(["--relative-error", target] if target else []), *limit]
    for over in case.over:
        words += ["--over", over]
    begin = time.monotonic()
    try:
        done = subprocess.run([*words, "--", *case.formulas], capture_output=True, text=True, timeout=PATIENCE)
        code, text = done.returncode, done.stdout
    except subprocess.TimeoutExpired:
        code, text = -1, ""
    seconds = time.monotonic() - begin
    return Run(case, method, target, seed, seconds, code, json.loads(text) if text else None)


def table(runs: list[Run]) -> None:
    print("| family | runs | silent | claimed | honest | called divergent | longest, s |")
    print("|---|---|---|---|---|---|---|")
    groups: dict[str, list[Run]] = defaultdict(list)
    for r in runs:
        groups[r.case.family].append(r)
    groups["all"] = runs
    for family, own in groups.items():
        silent = sum(r.silent() for r in own)
        claimed = sum(r.claims() for r in own)
        called = sum(r.called_divergent() for r in own)
        print(
            f"| {family} | {len(own)} | {100 * silent / len(own):.2f} % ({silent}) | {100 * claimed / len(own):.1f} % "
            f"| {100 * (claimed - silent) / len(own):.1f} % | {called} | {max(r.seconds for r in own):.1f} |"
        )
    sampled = [r for r in runs if r.claims() and r.case.exact is not None and r.result["statistical"]]
    if sampled:
        one, two = (sum(r.within(k) for r in sampled) / len(sampled) for k in (1, 2))
        print(f"\n{len(sampled)} sampled results: {one:.3f} within one error, {two:.3f} within two (of all components)")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--lists", default="formulas.tsv,convergence.tsv")
    parser.add_argument("--families", default="")
    parser.add_argument("--methods", default="auto")
    parser.add_argument("--targets", default="1e-2,1e-3,1e-4")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--evaluations", default="")
    parser.add_argument("--time", default="")
    parser.add_argument("--jobs", type=int, default=2)
    a = parser.parse_args()
    limit = (["--evaluations", a.evaluations] if a.evaluations else []) + (["--time", a.time] if a.time else [])
    families = set(a.families.split(",")) if a.families else None
    cases = [c for name in a.lists.split(",") for c in read(name) if families is None or c.family in families]
    for method in a.methods.split(","):
        plan = [(c, t, s) for c in cases for t in a.targets.split(",") for s in range(a.seeds)]
        with ThreadPoolExecutor(a.jobs) as pool:
            runs = list(pool.map(lambda p: run(a.program, p[0], method, p[1], p[2], limit), plan))
        print(f"\n## {method}\n")
        table(runs)
        print()
        for r in runs:
            wrong = (
                "SILENT" if r.silent() else
                "no answer" if r.result is None else
                "called divergent" if r.called_divergent() and r.case.exact is not None else
                "not called divergent" if r.case.exact is None and not r.called_divergent() else
                "")
            if wrong:
                got = r.result and f"{r.result['value']} +- {r.result['standard_error']}, {r.result['method']}, " \
                    f"{r.result['evaluations']} evaluations, {r.result['stop']} {r.result['warnings']}"
                print(f"- {wrong}: {r.case.name()} at {r.target}, seed {r.seed}: {got}; exact {r.case.exact}")
        sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
