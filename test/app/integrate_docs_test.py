"""Commands in the documentation print the output that is shown below them.

Each `$ montelux integrate ...` and `$ montelux sample ...` of a code block, up to the next `$` or the end of the block.
Of a line that ends with ... the beginning is compared.
"""

import os
import re
import subprocess

from program import PROGRAM, ROOT, ProgramTest, write

PAGES = ["accelerator.md", "integration.md", "sampling.md", "usage.md", "start.md", "tutorials/integrate.md"]


def commands(page):
    """(line number, command, lines that it shows) of each command; the C files that a page shows are written."""
    block = command = shown = file = None
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if file is not None:
            if line.startswith("```"):
                file = None
            else:
                with open(file, "a", encoding="utf-8") as out:
                    out.write(line + "\n")
        elif title := re.match('```c title="(.*?)"', line):
            file = title[1]
            write(file, "")
        elif line.startswith("```"):
            if command is not None:
                yield start, command, shown
            command, block = None, block is None and re.fullmatch("```(text|sh|console)", line) or None
        elif block and command is not None and command.endswith("\\"):
            command += "\n" + line
        elif block and line.startswith("$ "):
            if command is not None:
                yield start, command, shown
            command = line[2:] if re.match(r"\$ montelux (integrate|sample) ", line) else None
            start, shown = number, []
        elif command is not None:
            shown.append(line)


def agrees(printed, shown):
    return printed.startswith(shown[:-3]) if shown.endswith("...") else printed == shown


class Documentation(ProgramTest):
    @classmethod
    def prepare(cls):
        os.mkdir("bin")
        os.symlink(PROGRAM, "bin/montelux")
        cls.environment = {**os.environ, "PATH": f"{os.path.abspath('bin')}:{os.environ['PATH']}"}

    def setUp(self):
        self.addCleanup(os.chdir, os.getcwd())

    def test_output_of_commands(self):
        for page in PAGES:
            os.makedirs(f"{self.folder}/{page}")
            os.chdir(f"{self.folder}/{page}")
            count = 0
            for number, command, shown in list(commands(ROOT / "docs" / page)):
                count += 1
                with self.subTest(f"docs/{page}:{number}: {command}"):
                    done = subprocess.run(["sh", "-c", command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                          stderr=subprocess.STDOUT, env=self.environment, timeout=60)  # fmt: skip
                    printed = done.stdout.decode().splitlines()
                    if len(printed) != len(shown) or not all(map(agrees, printed, shown)):
                        self.assertEqual(printed, shown)
            if page == "usage.md":
                self.assertGreaterEqual(count, 4, "commands were found")
