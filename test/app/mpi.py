"""Shared parts of the tests of MPI jobs on this machine."""

import contextlib
import os
import signal
import subprocess

from program import PROGRAM, SKY, ProgramTest, has_command, scene, skip_unless

# Options for containers and small machines: run as root, more ranks than processors.
os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
LAMP = ('AttributeBegin Translate 0 3 1 AreaLightSource "diffuse" "rgb L" [9 9 9] Shape "sphere" "float radius" 0.3 '
        "AttributeEnd")  # fmt: skip


def skip_without_mpi():
    skip_unless(has_command("mpirun"), "there is no mpirun")
    version = subprocess.run([PROGRAM, "--version"], stdout=subprocess.PIPE, text=True).stdout
    skip_unless("MPI (" in version, "built without MPI")


def ball_scene():
    world = 'Material "diffuse" Shape "sphere" Translate 1 0 0 Material "conductor" Shape "sphere"'
    scene("ball", f"{SKY} {LAMP} {world}", 70, 50)


class MpiTest(ProgramTest):
    @classmethod
    def setUpClass(cls):
        skip_without_mpi()
        super().setUpClass()
        cls.addClassCleanup(cls.end_ranks)

    @classmethod
    def prepare(cls):
        ball_scene()

    @classmethod
    def background(cls, n, line, *words, before=()):
        """Starts a job of n ranks of the program, each prefixed by the words `before`."""
        command = ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(n), *before, PROGRAM]
        return cls.started([*command, *line.split(), *words])

    @classmethod
    def ranks(cls, n, line, *words, before=()):
        return cls.background(n, line, *words, before=before).ended()

    @classmethod
    def processes(cls):
        """(rank, process) of each rank that runs here."""
        for entry in filter(str.isdigit, os.listdir("/proc")):
            with contextlib.suppress(OSError):
                with open(f"/proc/{entry}/cmdline", "rb") as file:
                    if not file.read().startswith(PROGRAM.encode() + b"\0"):
                        continue
                if os.readlink(f"/proc/{entry}/cwd") != cls.folder:
                    continue
                with open(f"/proc/{entry}/environ", "rb") as file:
                    for variable in file.read().split(b"\0"):
                        if variable.startswith(b"OMPI_COMM_WORLD_RANK="):
                            yield int(variable.split(b"=")[1]), int(entry)

    @classmethod
    def end_ranks(cls):
        for _, process in cls.processes():
            with contextlib.suppress(OSError):
                os.kill(process, signal.SIGKILL)

    def assert_once(self, outcome, code, text):
        """The job ended with the code, printed the text once and at most one error, and no rank was killed."""
        self.assertEqual(outcome.code, code, outcome)
        self.assertEqual(outcome.text.count(text), 1, f"'{text}' is not printed once. {outcome}")
        self.assertLessEqual(outcome.text.count("montelux: error: "), 1, outcome)
        for sign in "MPI_ABORT", "interrupted, nothing":
            self.assertNotIn(sign, outcome.text, f"ranks were killed. {outcome}")
