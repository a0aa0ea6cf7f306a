"""The page of every command and option, from the program itself: command_line.py PROGRAM > PAGE.

Needs the standard library only.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys


def help_of(program, command):
    environment = {**os.environ, "COLUMNS": "100", "LC_ALL": "C"}
    run = subprocess.run([program, *command, "--help"], capture_output=True, text=True, env=environment, check=False)
    if run.returncode:
        sys.exit(f"command_line.py: {program} {' '.join(command)} --help: {run.stderr.strip()}")
    return run.stdout.rstrip()


def subcommands(text):
    """The names below "Subcommands:" of a help text."""
    block = re.search(r"^Subcommands:\n((?:  .*\n?|\n)*)", text + "\n", flags=re.M)
    return re.findall(r"^  (\S+)", block[1], flags=re.M) if block else []


def sections(program, command=()):
    text = help_of(program, command)
    yield command, text
    for name in subcommands(text):
        yield from sections(program, (*command, name))


def main():
    program = sys.argv[1]
    print("# Every command and option")
    print("\nWhat `montelux COMMAND --help` prints. [Guide](../usage.md).")
    for command, text in sections(program):
        if command:
            print(f"\n{'#' * (1 + len(command))} {' '.join(command)}")
        print(f"\n```text\n$ montelux {' '.join((*command, '--help'))}\n{text.replace(program, 'montelux')}\n```")


main()
