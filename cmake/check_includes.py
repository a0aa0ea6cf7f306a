#!/usr/bin/env python3
"""Compiles each source file alone, without making code: files compiled as one hide a missing include.

Generated files that no build has made yet are left out.

Usage: check_includes.py compile_commands.json jobs
"""

import concurrent.futures
import json
import os
import shlex
import subprocess
import sys


def errors(entry):
    words = shlex.split(entry["command"])
    at = words.index("-o")  # the object and its name
    done = subprocess.run([*words[:at], *words[at + 2 :], "-fsyntax-only"], cwd=entry["directory"],
                          stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)  # fmt: skip
    return done.stderr if done.returncode else ""


def main(database, jobs):
    with open(database) as file:
        entries = [entry for entry in json.load(file) if os.path.exists(entry["file"])]
    with concurrent.futures.ThreadPoolExecutor(int(jobs)) as pool:
        found = [text for text in pool.map(errors, entries) if text]
    print("\n".join(found), file=sys.stderr, end="")
    print(f"{len(entries)} files compiled alone, {len(found)} with errors")
    return 1 if found or not entries else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
