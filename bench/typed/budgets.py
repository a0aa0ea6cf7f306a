#!/usr/bin/env python3
"""Do results get better with more evaluations, and with more time?

    bench/typed/budgets.py MONTELUX [--integrals 30] [--seeds 20] [--evaluations 1e4,1e5,1e6] [--times 0.3,1,3]

Takes every so many of the formulas of formulas.tsv. For each method it prints the root mean squared relative error
after each budget, and names integrals whose error rises from one budget to the next by more than chance: where a
rank test of the errors (Mann and Whitney 1947) or their mean squares differ by more than four of their own errors.
After a time, the ratio in brackets is the error there over that of runs with as many evaluations as each of them made.
"""

from __future__ import annotations

import argparse
import math
import statistics
import sys
from concurrent.futures import ThreadPoolExecutor

from typed_integrals import Case, Run, read, run

CHANCE = 4.0  # standard errors
SAME = 1.1  # ratio of mean squares below which they are alike
FLOOR = 1e-11  # relative error that rounding may cause


def errors(runs: list[Run]) -> list[float]:
    """Relative errors, those of rounding all alike."""
    found = []
    for r in runs:
        value = r.result["value"] if r.result else None
        exact = r.case.exact[0]
        error = math.inf if value is None else abs(value - exact) / (abs(exact) or 1.0)
        found.append(max(error, FLOOR))
    return found


def rises(before: list[float], after: list[float]) -> bool:
    n, m = len(before), len(after)
    above = sum((a > b) + 0.5 * (a == b) for a in after for b in before)
    rank = (above - n * m / 2) / math.sqrt(n * m * (n + m + 1) / 12)
    squares = [[e * e for e in group] for group in (before, after)]
    if any(math.isinf(s) for group in squares for s in group):
        return rank > CHANCE
    means = [statistics.fmean(group) for group in squares]
    spread = sum(statistics.variance(group) / len(group) for group in squares) if min(n, m) > 1 else math.inf
    return means[1] > SAME * means[0] and (rank > CHANCE or means[1] - means[0] > CHANCE * math.sqrt(spread) > 0)


def root_mean_square(group: list[float]) -> float:
    return math.sqrt(statistics.fmean(e * e for e in group))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--methods", default="auto")
    parser.add_argument("--integrals", type=int, default=30)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--evaluations", default="1e4,1e5,1e6")
    parser.add_argument("--times", default="0.3,1,3")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()

    single = [case for case in read("formulas.tsv") if len(case.formulas) == 1 and case.exact is not None]
    step = max(1, len(single) // options.integrals)
    cases: list[Case] = single[::step][: options.integrals]
    budgets = [["--evaluations", n] for n in options.evaluations.split(",") if n]
    budgets += [["--time", t] for t in options.times.split(",") if t]
    worse, of_time = 0, []
    with ThreadPoolExecutor(options.jobs) as pool:
        for method in options.methods.split(","):
            print(f"\n## {method}\n\n| integral | " + " | ".join(" ".join(b)[2:] for b in budgets) + " |")
            print("|---" * (len(budgets) + 1) + "|")
            for case in cases:
                groups, ratios = [], []
                for budget in budgets:
                    jobs = [
                        pool.submit(run, options.program, case, method, "", seed, budget)
                        for seed in range(options.seeds)
                    ]
                    runs = [job.result() for job in jobs]
                    groups.append(errors(runs))
                    ratios.append(math.nan)
                    if budget[0] != "--time" or any(not r.result for r in runs):
                        continue
                    again = [
                        pool.submit(
                            run, options.program, case, method, "", seed,
                            ["--evaluations", str(r.result["evaluations"])],
                        )
                        for seed, r in enumerate(runs)
                    ]
                    same = root_mean_square(errors([job.result() for job in again]))
                    ratios[-1] = root_mean_square(groups[-1]) / same
                    of_time.append(ratios[-1])
                cells, previous = [], None
                for i, (budget, group) in enumerate(zip(budgets, groups)):
                    rose = previous is not None and budget[0] == budgets[i - 1][0] and rises(previous, group)
                    worse += rose
                    ratio = "" if math.isnan(ratios[i]) else f" ({ratios[i]:.2f})"
                    cells.append(f"{root_mean_square(group):.1e}{ratio}" + (" WORSE" if rose else ""))
                    previous = group
                print(f"| {case.name()[:70].replace('|', '/')} | " + " | ".join(cells) + " |", flush=True)
    print(f"\n{worse} of the steps to a larger budget made the error larger than chance does")
    if of_time:
        above = sum(r > 1.5 for r in of_time)
        print(f"Error after a time over that of as many evaluations: median {statistics.median(of_time):.2f}, ", end="")
        print(f"largest {max(of_time):.2f}, above 1.5 for {above} of {len(of_time)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
