"""Shared parts of the tests of the command line program: a scratch folder, `expect`, small scenes and pictures.

    MONTELUX=build/test/montelux python3 test/app/program.py NAME_test[.CLASS[.TEST]] ...

MONTELUX_SHARED is the folder of shared data, by default the one beside the repository. Exit code 77: all was skipped.
"""

import contextlib
import fcntl
import itertools
import json
import os
import pty
import re
import shlex
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import threading
import time
import unittest
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.path.abspath(os.environ["MONTELUX"])
SHARED = Path(os.path.abspath(os.environ.get("MONTELUX_SHARED") or ROOT.parent / "shared"))
FAULT_LIBRARY = os.path.join(os.path.dirname(PROGRAM), "libmontelux_fault_injection.so")
NAN, INFINITE = float("nan"), float("inf")
ROW = re.compile(r"(\d+) (?:(.*) )?\$(?: (.*))?")
# Formats of scenes, as error messages list them
FORMATS = "pbrt-v4, glTF 2.0, Mitsuba 3, OBJ, PLY and STL are read"
SKY = 'LightSource "infinite" "rgb L" [1 1 1]'
# A model (OBJ)
TENT = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 2 0\nf 1 2 3 4\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n"
# Members of a glTF file: positions of a triangle (accessor 0), and an animation of 2 s that moves node 0 by 5 along z.
GLTF_TRIANGLE = {
    "buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAA"
                 "AAgD8AAAAAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAoEA="}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                    {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR"},
                  {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
}  # fmt: skip
GLTF_MOTION = {
    "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                    "samplers": [{"input": 1, "output": 2}]}],
}  # fmt: skip


def read(name):
    return Path(name).read_bytes()


def write(name, text):
    Path(name).write_bytes(text.encode() if isinstance(text, str) else text)


def remove(*names):
    for name in names:
        Path(name).unlink(missing_ok=True)


def edited(name, new, *changes):
    """Writes a copy of a text file with (pattern, replacement) applied; each must match."""
    text = read(name).decode()
    for pattern, replacement in changes:
        text, count = re.subn(pattern, replacement, text)
        assert count, f"{pattern} is not in {name}"
    write(new, text)


def scene(name, world, width=8, height=6, spp=4):
    """Writes NAME.pbrt, whose output is NAME.exr. The world begins in line 6."""
    write(name + ".pbrt", f"""Film "rgb" "integer xresolution" {width} "integer yresolution" {height}
  "string filename" "{name}.exr"
Sampler "independent" "integer pixelsamples" {spp}
LookAt 0 0 4 0 0 0 0 1 0 Camera "perspective" "float fov" 40
WorldBegin
{world}
""")


def pfm(name, width, height, *values, channels=3):
    """Writes a PFM, bottom row first; the values are repeated to fill it."""
    floats = itertools.islice(itertools.cycle(values), channels * width * height)
    write(name, b"P%c\n%d %d\n-1\n" % (b"F" if channels == 3 else b"f", width, height)
          + b"".join(struct.pack("<f", value) for value in floats))  # fmt: skip


def read_pfm(name):
    """(width, height, floats) of a colour PFM, bottom row first."""
    width, height, data = re.fullmatch(rb"PF\s(\d+)\s(\d+)\s-1\S*\n(.*)", read(name), re.S).groups()
    return int(width), int(height), struct.unpack(f"<{3 * int(width) * int(height)}f", data)


def csv_rows(text):
    """(names of columns, rows of numbers) of a CSV text."""
    first, *lines = text.splitlines()
    return first.split(","), [[float(word) for word in line.split(",")] for line in lines]


def table_lines(text):
    """Lines without comments; a line that begins with $ or & continues the line above."""
    lines = map(str.strip, re.sub(r"\n *([$&])", r" \1", text).strip().split("\n"))
    return [line for line in lines if not line.startswith("#")]


def without_seconds(text):
    """Lines of bytes or text, except those that contain "seconds"."""
    return [line for line in text.splitlines() if (b"seconds" if isinstance(text, bytes) else "seconds") not in line]


def bytes_that_differ(a, b):
    return abs(len(a) - len(b)) + sum(map(int.__ne__, a, b))


def has_command(name):
    return shutil.which(name) is not None


def skip_unless(condition, reason):
    if not condition:
        raise unittest.SkipTest(reason)


def skip_without_faults():
    skip_unless(os.path.exists(FAULT_LIBRARY), f"{FAULT_LIBRARY} is not built")


class Outcome(NamedTuple):
    """Exit code of a program (minus the number of the signal that ended it) and its output."""

    command: str
    code: int
    text: str  # standard output and, unless kept apart, standard error
    errors: str = ""

    def __str__(self):
        return f"{self.command}: exit code {self.code}; it printed:\n{self.text}{self.errors}"


class Job:
    """A running program, whose output can be read at any time."""

    def __init__(self, command, environment=None, stdout=None, **how):
        self.printed = tempfile.TemporaryFile()
        self.command = shlex.join(["montelux" if word == PROGRAM else word for word in command])
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=stdout or self.printed,
                                        stderr=self.printed, env={**os.environ, **(environment or {})}, **how)
        self.pid, self.signal = self.process.pid, self.process.send_signal

    def output(self):
        return os.pread(self.printed.fileno(), 1 << 24, 0).decode(errors="replace")

    def runs(self):
        return self.process.poll() is None

    def ended(self, seconds=60):
        """Waits for its end and returns the outcome."""
        try:
            self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            self.kill()
            raise AssertionError(f"{self.command} ran for {seconds} s; it printed:\n{self.output()}") from None
        return Outcome(self.command, self.process.returncode, self.output())

    def kill(self):
        self.process.kill()
        self.process.wait()

    def works(self, seconds):
        """Whether it has used this much CPU time and handles SIGINT."""
        with contextlib.suppress(OSError):
            caught = re.search(r"SigCgt:\s*(\w+)", Path(f"/proc/{self.pid}/status").read_text())[1]
            fields = Path(f"/proc/{self.pid}/stat").read_text().rpartition(")")[2].split()
            used = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
            return used >= seconds and int(caught, 16) >> (signal.SIGINT - 1) & 1
        return False


class ProgramTest(unittest.TestCase):
    """Tests that run in a shared scratch folder, which `prepare` fills.

    A command is a line that is split as by a shell, followed by words that are not split.
    """

    maxDiff = None

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.folder = os.path.realpath(tempfile.mkdtemp(prefix="app-test-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.addClassCleanup(os.chdir, os.getcwd())
        os.chdir(cls.folder)
        cls.prepare()

    @classmethod
    def prepare(cls):
        pass

    @classmethod
    def started(cls, command, **how):
        """Starts a Job that is killed, if still running, after the tests of the class."""
        job = Job(command, **how)
        cls.addClassCleanup(job.printed.close)
        cls.addClassCleanup(job.kill)
        return job

    @classmethod
    def start(cls, line, *words, **how):
        return cls.started([PROGRAM, *shlex.split(line), *map(str, words)], **how)

    @staticmethod
    def outcome(line, *words, seconds=60, apart=False, environment=None, **how):
        """Runs the program; `apart` separates standard error from standard output."""
        command = [PROGRAM, *shlex.split(line), *map(str, words)]
        shown = shlex.join(["montelux", *command[1:]])
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, timeout=seconds,
                                  stderr=subprocess.PIPE if apart else subprocess.STDOUT,
                                  env={**os.environ, **(environment or {})}, **how)  # fmt: skip
        except subprocess.TimeoutExpired as late:
            raise AssertionError(f"{shown} ran for {seconds} s; it printed:\n{late.stdout}{late.stderr}") from None
        printed = [(text or b"").decode(errors="replace") for text in (done.stdout, done.stderr)]
        return Outcome(shown, done.returncode, *printed)

    @classmethod
    def expect(cls, code, text, line, *words, **how):
        """Runs the program and returns its output. Checks the exit code, that the output contains TEXT, or each of
        TEXT & TEXT ..., and that there is exactly one error message if the code is 1."""
        outcome = cls.outcome(line, *words, **how)
        printed = outcome.text + outcome.errors
        if outcome.code != code:
            raise AssertionError(f"exit code {code} is expected. {outcome}")
        for part in text.split(" & "):
            if part not in printed:
                raise AssertionError(f"'{part}' is missing. {outcome}")
        if code == 1 and printed.count("montelux: error: ") != 1:
            raise AssertionError(f"one error message is expected. {outcome}")
        return outcome.text

    def expect_each(self, table, prefix=""):
        """Expects each row (code, text, line, words ...), or each line CODE TEXT $ LINE of a text, as a subtest."""
        if isinstance(table, str):
            table = [ROW.fullmatch(line).groups("") for line in table_lines(table)]
        for code, text, line, *words in table:
            with self.subTest(" ".join([prefix + line, *words])):
                self.expect(int(code), text, prefix + line, *words)

    @classmethod
    def take(cls, text):
        """Runs the lines of `steps` one after the other."""
        comparisons = {"==": cls.assert_same, "!=": cls.assert_differ, "~": cls.assert_same_pixels}
        for line in table_lines(text):
            words = line.split()
            if row := ROW.fullmatch(line):
                cls.expect(int(row[1]), row[2] or "", row[3])
            elif words[0] == "no":
                cls.assert_absent(*words[1:])
            else:
                comparisons[words[1]](words[0], words[2])

    @classmethod
    def output(cls, line, *words, **how):
        """Standard output of a command that must succeed."""
        return cls.expect(0, "", line, *words, apart=True, **how)

    @classmethod
    def json(cls, line, *words, **how):
        def refuse(constant):
            raise AssertionError(f"{constant} is no JSON: {line}")

        return json.loads(cls.output(line + " --json", *words, **how), parse_constant=refuse)

    @classmethod
    def quietly(cls, line, *words, **how):
        """Runs a command with --quiet, which must succeed and print nothing."""
        outcome = cls.outcome(line + " --quiet", *words, **how)
        if outcome.code != 0 or outcome.text:
            raise AssertionError(f"success without a word is expected. {outcome}")

    @staticmethod
    def on_terminal(line, columns=80):
        """The outcome of the program on a terminal of this width."""
        leader, follower = pty.openpty()
        with open(leader, "rb", buffering=0) as screen:
            fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("4H", 24, columns, 0, 0))
            process = subprocess.Popen([PROGRAM, *shlex.split(line)], stdin=follower, stdout=follower, stderr=follower,
                                       start_new_session=True)  # fmt: skip
            os.close(follower)
            limit = threading.Timer(60, process.kill)
            limit.start()
            text = b""
            with contextlib.suppress(OSError):  # the program has ended
                while chunk := screen.read(1 << 16):
                    text += chunk
            code = process.wait()
            limit.cancel()
            return Outcome(f"montelux {line}", code, text.decode(errors="replace"))

    @staticmethod
    def until(condition, what, job, seconds=30):
        """Waits for a true value of the condition and returns it; fails if the job ends before."""
        end = time.monotonic() + seconds
        while not (value := condition()):
            if not job.runs() or time.monotonic() > end:
                if value := condition():
                    break
                raise AssertionError(f"waited in vain: {what}; {job.command} printed:\n{job.output()}")
            time.sleep(0.005)
        return value

    def interrupted(self, job, number=signal.SIGINT, works=0.4, seconds=INFINITE):
        """Sends the signal after `works` s of CPU time; expects exit code 130 within `seconds`; returns the output."""
        self.until(lambda: job.works(works), f"{works} s of work", job)
        begin = time.monotonic()
        job.signal(number)
        outcome = job.ended()
        self.assertEqual(outcome.code, 130, outcome)
        self.assertLess(time.monotonic() - begin, seconds, outcome)
        return outcome.text

    @classmethod
    def assert_same(cls, a, b, message="", most=0):
        """Fails unless the files have the same size and differ in at most `most` bytes."""
        x, y = read(a), read(b)
        count = 0 if x == y else bytes_that_differ(x, y)
        if count > most or len(x) != len(y):
            raise AssertionError(f"{a} and {b} differ in {count} bytes of {len(x)} and {len(y)}. {message}")

    @classmethod
    def assert_same_but_seconds(cls, a, b, message=""):
        """Compares EXR files, ignoring the render time in their headers."""
        cls.assert_same(a, b, message, most=4)

    @classmethod
    def assert_differ(cls, a, b, message=""):
        if read(a) == read(b):
            raise AssertionError(f"{a} and {b} have the same bytes. {message}")

    @classmethod
    def assert_same_pixels(cls, a, b):
        cls.expect(0, "RMSE 0, relMSE 0 ", "compare", a, b)

    @classmethod
    def assert_absent(cls, *patterns):
        if there := [str(path) for pattern in patterns for path in Path().glob(pattern)]:
            raise AssertionError(f"{there} should not be there")

    def assert_near(self, value, exact, tolerance, message=""):
        if not abs(value - exact) <= tolerance:
            self.fail(f"{value} instead of {exact} within {tolerance}. {message}")


def steps(text):
    """A test of consecutive lines: CODE TEXT $ LINE runs a command, A == B expects files of the same bytes, A != B of
    different bytes, A ~ B pictures of the same pixels, and `no A B` the absence of files."""
    return lambda self: self.take(text)


def each(table, prefix=""):
    """A test of independent lines or rows, see expect_each()."""
    return lambda self: self.expect_each(table, prefix)


class Result(unittest.TextTestResult):
    passed = 0

    def addSuccess(self, test):
        super().addSuccess(test)
        self.passed += 1


def run(names):
    """Runs tests; returns 0, 1 after failures, or 77 if all were skipped."""
    tests = unittest.defaultTestLoader.loadTestsFromNames(names)
    result = unittest.TextTestRunner(resultclass=Result, verbosity=2).run(tests)
    return 0 if result.passed and result.wasSuccessful() else 77 if result.skipped and result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(run(sys.argv[1:]))
