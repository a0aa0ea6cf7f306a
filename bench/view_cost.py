#!/usr/bin/env python3
"""What a page costs a render, and what attacks on it do: CPU seconds of whole renders, in turns.

view_cost.py PROGRAM SCENE [--rounds 6] [--ways plain,served,watched,attacked] [--connections 10000] [-- RENDER OPTIONS]

Each round renders the scene once in each way, on one thread: `plain` without a page, `served` with one that no
browser opens, `watched` with one that shows the layers mean and error, `attacked` with attacks until the render has ended
(`hostile` of test/app/view_client.py). The program has one processor, so what its page takes is what the render loses;
pages and attackers have the others. Printed are medians, over the rounds, of the ratio to the first way of the same
round:

    process    CPU time of the whole process
    samples    CPU time of the samples, as --stats says
    page       CPU time of the page's threads over that of the rendering one, in percent
"""

from __future__ import annotations

import argparse
import os
import re
import statistics
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

client = Path(__file__).resolve().parent.parent / "test" / "app" / "view_client.py"
sys.path.insert(0, str(client.parent))
import view_client  # noqa: E402

processors = sorted(os.sched_getaffinity(0))


def thread_seconds(pid: int) -> dict[int, float]:
    """CPU seconds of each thread that lives."""
    seconds = {}
    for thread in os.listdir(f"/proc/{pid}/task"):
        try:
            with open(f"/proc/{pid}/task/{thread}/schedstat") as file:
                seconds[int(thread)] = int(file.read().split()[0]) * 1e-9
        except (OSError, IndexError):  # it ended meanwhile
            pass
    return seconds


class Watcher(threading.Thread):
    """Reads what a page would read."""

    def __init__(self, url: str):
        super().__init__(daemon=True)
        self.viewer = view_client.Viewer(url)
        self.viewer.ask(type="show", layers=["mean", "error"])
        self.bytes = 0

    def run(self) -> None:
        try:
            while True:
                message = self.viewer.message()
                self.bytes += len(message) if isinstance(message, bytes) else 0
        except (OSError, EOFError):
            pass


class Attacks(threading.Thread):
    """Attacks from another process, one after the other."""

    def __init__(self, url: str, connections: int):
        super().__init__(daemon=True)
        self.command = [sys.executable, str(client), url, str(connections)]
        self.process: subprocess.Popen | None = None
        self.ends = False
        self.whole = 0

    def run(self) -> None:
        while not self.ends:
            self.process = subprocess.Popen(self.command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.whole += self.process.wait() == 0

    def stop(self) -> None:
        self.ends = True
        if self.process:
            self.process.kill()


def rendered(way: str, options: argparse.Namespace, out: str) -> dict[str, float]:
    command = [options.program, "render", options.scene, "--threads", "1", "--stats", "-o", out, *options.render]
    if way != "plain":
        command.append("--view")
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        preexec_fn=lambda: os.sched_setaffinity(0, {processors[0]}))  # fmt: skip
    errors: list[str] = []
    url = None
    if way != "plain":
        for line in process.stderr:
            if found := re.search(r"The render is shown at (\S+)", line):
                url = found[1]
                break
            errors.append(line)
        if url is None:
            sys.exit(f"{way}: no page: {''.join(errors)}")
    drain = threading.Thread(target=lambda: errors.append(process.stderr.read()), daemon=True)
    drain.start()
    visitor = Watcher(url) if way == "watched" else Attacks(url, options.connections) if way == "attacked" else None
    if visitor:
        visitor.start()
    threads: dict[int, float] = {}
    while os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
        threads.update(thread_seconds(process.pid))
        drain.join(0.05)
    text = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    if isinstance(visitor, Attacks):
        visitor.stop()
    found = re.search(r"([0-9.]+) s of CPU", text)
    if status != 0 or not found:
        sys.exit(f"{way}: exit status {status}: {text}{''.join(errors)}")
    main = threads.pop(process.pid)
    return {"process": usage.ru_utime + usage.ru_stime, "samples": float(found[1]), "page": 100 * sum(threads.values()) / main}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("scene")
    parser.add_argument("--rounds", type=int, default=6)
    parser.add_argument("--ways", type=lambda text: text.split(","), default=["plain", "served", "watched", "attacked"])
    parser.add_argument("--connections", type=int, default=10000, help="of one attack")
    split = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    options = parser.parse_args(sys.argv[1:split])
    options.render = sys.argv[split + 1 :]
    if len(processors) > 1:
        os.sched_setaffinity(0, set(processors[1:]))
    results: dict[str, list[dict[str, float]]] = {way: [] for way in options.ways}
    with tempfile.TemporaryDirectory() as folder:
        for i in range(options.rounds):
            # Forwards and backwards in turns: a machine that gets slower favours none.
            for way in options.ways if i % 2 == 0 else reversed(options.ways):
                results[way].append(rendered(way, options, folder + "/picture.exr"))
                print(f"# {i} {way}", *(f"{k} {v:.3f}" for k, v in results[way][-1].items()), file=sys.stderr, flush=True)
    first = results[options.ways[0]]
    print("| | process | samples | page |\n|---|---|---|---|")
    for way, runs in results.items():
        ratios = {k: [run[k] / base[k] for run, base in zip(runs, first)] for k in ("process", "samples")}
        cells = [f"{statistics.median(r):.3f} ({min(r):.3f} to {max(r):.3f})" for r in ratios.values()]
        if way == options.ways[0]:
            cells = [f"{statistics.median(run[k] for run in runs):.2f} s" for k in ratios]
        print(f"| {way} | {' | '.join(cells)} | {statistics.median(run['page'] for run in runs):.2f} % |")


if __name__ == "__main__":
    main()
