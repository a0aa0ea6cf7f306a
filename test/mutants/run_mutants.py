#!/usr/bin/env python3
"""Plants each fault of test/mutants in a copy of the sources, and says which test of `make test` notices it.

A mutant is a patch below a line that says the mistake. The tests of its own room are asked first, then those of the
room with the sanitizers, then all others; the first failure ends a mutant. Exit code 1: one survives, or no longer
applies or compiles.
"""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
MUTANTS = ROOT / "test" / "mutants"
LIMIT = 3600  # seconds for the tests of one mutant: one that never ends is noticed, too


def run(command, folder, limit=None):
    """Exit code and output; 124 at the limit."""
    try:
        done = subprocess.run(command, cwd=folder, timeout=limit, text=True, errors="replace",
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return done.returncode, done.stdout
    except subprocess.TimeoutExpired as e:
        return 124, (e.stdout or b"").decode(errors="replace")


class Copy:
    """The sources beside a link to the shared data, with the build of `make test`."""

    def __init__(self, folder, jobs):
        self.source, self.jobs = folder / "source", str(jobs)
        self.source.mkdir(parents=True, exist_ok=True)
        shared, link = ROOT.parent / "shared", folder / "shared"
        if shared.exists() and not link.exists():
            link.symlink_to(shared)
        self.refresh()
        code, output = run(["cmake", "--preset", "test"], self.source)
        if code != 0:
            sys.exit("CMake fails without any mutant:\n" + output[-4000:])
        targets = run(["ninja", "-C", "build/test", "-t", "targets", "all"], self.source)[1]
        self.targets = set(re.findall(r"^(\S+): ", targets, re.M))

    def refresh(self):
        """Files that differ are copied: what has been built stays valid."""
        listed = run(["git", "ls-files", "-co", "--exclude-standard"], ROOT)[1].splitlines()
        for name in listed:
            here, there = ROOT / name, self.source / name
            if not here.is_file():
                there.unlink(missing_ok=True)
            elif not there.exists() or there.read_bytes() != here.read_bytes():
                there.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(here, there)
                shutil.copymode(here, there)

    def build(self, target=None):
        """Output of a build that failed; empty: it did not."""
        code, output = run(["cmake", "--build", "build/test", "--parallel", self.jobs] +
                           (["--target", target] if target else []), self.source)
        return "" if code == 0 else output

    def failed_test(self, select):
        """Name of a fast test that fails; None: none does."""
        code, output = run(["ctest", "--test-dir", "build/test", "-L", "fast", "-j", self.jobs, "--stop-on-failure",
                            "--no-tests=ignore", "--output-on-failure"] + select, self.source, LIMIT)
        if code == 0:
            return None
        # A share of a program's tests is one test to ctest.
        names = re.findall(r"^\[  FAILED  \] (\S+?)(?:,| \(|$)", output, re.M)
        tests = re.findall(r"^\s+\d+ - (\S+) \((?!Not Run|Disabled)", output, re.M) or re.findall(
            r"Test +#\d+: (\S+) \.*\*\*\*", output)
        if not tests:
            return "no end within the limit" if code == 124 else "ctest itself: " + output[-300:]
        return f"{tests[0]} {names[0]}" if "share_" in tests[0] and names else tests[0]


def room_of(path, targets):
    """Name of the folder of its tests, and the target that they need."""
    parts = path.split("/")
    if parts[0] != "montelux":
        return parts[0], {"app": "montelux", "python": "montelux_python"}.get(parts[0])
    for depth in (3, 2):
        room = "/".join(parts[1:depth])
        target = room.replace("/", "_") + "_test"
        if target in targets:
            return room, target
    return parts[1], None


def plant(copy, patch):
    """Applies a mutant; returns an error message, empty on success."""
    code, output = run(["patch", "-p1", "--forward", "--no-backup-if-mismatch", "--reject-file=-", "-i", str(patch)],
                       copy.source)
    return "" if code == 0 else "does not apply: " + output.strip()


def stages_of(copy, patch):
    """Targets and ctest selections of its room, and of all other tests."""
    touched = re.findall(r"^\+\+\+ b/(\S+)", patch.read_text(), re.M)
    room, target = room_of(touched[0], copy.targets)
    own, sanitized = f"^{re.escape(room)}/", f"^sanitized/{re.escape(room)}/"
    in_room = [(target, ["-R", own])] if target else []
    if f"{target}_sanitized" in copy.targets:
        in_room.append((f"{target}_sanitized", ["-R", sanitized]))
    return {"room": in_room, "all": [(None, ["-E", f"{own}|{sanitized}"] if target else [])]}


def try_stages(copy, stages):
    """Name of the first test that fails with the mutant; None if all pass."""
    for wanted, select in stages:
        if failure := copy.build(wanted):
            # The build also runs programs that it has built, which may fail.
            if "error:" in failure:
                return "does not compile: " + "\n".join(re.findall(r".*error:.*", failure)[:3])
            return "the build, which runs what it has built"
        if test := copy.failed_test(select):
            return test
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build" / "mutants", help="of the copy and its builds")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="", help="parts of names, with commas")
    parser.add_argument("--json", type=pathlib.Path, help="results; what it has already is not run again")
    options = parser.parse_args()
    patches = sorted(p for p in MUTANTS.glob("*/*.patch")
                     if not options.only or any(o in str(p) for o in options.only.split(",")))
    if not patches:
        sys.exit("no such mutant")
    results = json.loads(options.json.read_text()) if options.json and options.json.exists() else {}
    copy = Copy(options.folder, options.jobs)
    if output := copy.build():
        sys.exit("the sources do not compile without any mutant:\n" + output[-4000:])
    # First pass: tests of the room alone. Few mutants need the other tests, which take longest.
    for asked in ("room", "all"):
        for patch in patches:
            name = f"{patch.parent.name}/{patch.stem}"
            known = results.get(name, {"asked": None, "noticed_by": None, "seconds": 0})
            if known["noticed_by"] or known["asked"] in (asked, "all"):
                continue
            begin = time.monotonic()
            try:
                noticed = plant(copy, patch) or try_stages(copy, stages_of(copy, patch)[asked])
            finally:
                copy.refresh()
            results[name] = {"mistake": patch.read_text().split("\n", 1)[0], "asked": asked, "noticed_by": noticed,
                             "seconds": known["seconds"] + round(time.monotonic() - begin)}
            alive = "not noticed in its room" if asked == "room" else "SURVIVES"
            print(f"{name}: {noticed or alive} ({results[name]['seconds']} s)", flush=True)
            if options.json:
                options.json.write_text(json.dumps(results, indent=1) + "\n")
    mine = {n: r for n, r in results.items() if any(n == f"{p.parent.name}/{p.stem}" for p in patches)}
    broken = [n for n, r in mine.items() if (r["noticed_by"] or "").startswith("does not")]
    alive = [n for n, r in mine.items() if r["noticed_by"] is None]
    for n in broken + alive:
        print(f"{n}: {mine[n]['noticed_by'] or 'survives: ' + mine[n]['mistake']}")
    print(f"{len(mine) - len(alive) - len(broken)} of {len(mine)} mutants noticed, {len(alive)} survive, {len(broken)} broken")
    return 1 if alive or broken else 0


if __name__ == "__main__":
    sys.exit(main())
