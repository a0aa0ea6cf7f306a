"""A run that is killed by SIGKILL at random moments and resumed equals an uninterrupted one bit for bit.

Half of the kills come after a random time, half at a random call on a file, while a checkpoint is written.
MONTELUX_KILLS: how often each case is killed; MONTELUX_KILL_SEED: other moments.
"""

import itertools
import os
import random
import shutil
import signal
import subprocess
import time

from program import FAULT_LIBRARY, PROGRAM, SKY, ProgramTest, read, scene, skip_without_faults, without_seconds

KILLS = int(os.environ.get("MONTELUX_KILLS", 17))
SEED = int(os.environ.get("MONTELUX_KILL_SEED", 1))
CALLS = 90  # file operations of a run, about


class Run:
    """One run of a command in a folder, killed after some seconds, at a call on a file, or never."""

    def __init__(self, folder, command, seconds=None, call=None):
        self.kill = f"killed after {seconds:.4f} s" if seconds else f"killed at call {call}" if call else "not killed"
        environment = dict(os.environ)
        if call:
            environment |= {"MONTELUX_FAULT_FOLDER": os.path.abspath(folder), "MONTELUX_FAULT_CALL": str(call),
                            "MONTELUX_FAULT_KIND": "kill-before", "LD_PRELOAD": FAULT_LIBRARY}  # fmt: skip
        with open(f"{folder}/printed", "wb") as printed, open(f"{folder}/messages", "wb") as messages:
            process = subprocess.Popen([PROGRAM, *command], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                       stdout=printed, stderr=messages)  # fmt: skip
            if seconds:
                time.sleep(seconds)
                process.kill()
            try:
                self.code = process.wait(60)
            finally:
                process.kill()
        self.messages = read(f"{folder}/messages").decode()


class KillResume(ProgramTest):
    @classmethod
    def prepare(cls):
        skip_without_faults()
        scene("ball", f'{SKY} Material "diffuse" Shape "sphere"', 32, 24)

    def survives(self, output, line):
        """Kills the command KILLS times; each start resumes from `state` if it exists. The output of every run that
        ends is compared with that of an uninterrupted one."""
        command = line.split()
        for folder in "unbroken", "broken":
            shutil.rmtree(folder, ignore_errors=True)
            os.mkdir(folder)
        begin = time.monotonic()
        whole = Run("unbroken", command)
        seconds = time.monotonic() - begin
        self.assertEqual(whole.code, 0, whole.messages)
        wanted = without_seconds(read(f"unbroken/{output}"))
        moments = random.Random(SEED)
        killed = resumed = ended = 0
        for attempt in range(20 * KILLS + 20):
            enough = killed >= KILLS
            moment = moments.random()
            how = {} if enough else {"call": 1 + int(moment * CALLS)} if attempt % 2 else {"seconds": moment * seconds}
            run = Run("broken", command, **how)
            state = f"killed {killed} times, now {run.kill}: exit code {run.code}: {run.messages}"
            # The newest checkpoint must never be damaged, nor reported so.
            self.assertNotRegex(run.messages, "montelux: (warning|error)", state)
            self.assertIn(run.code, (0, -signal.SIGKILL), state)
            if run.code == 0:
                ended += 1
                self.assertEqual(without_seconds(read(f"broken/{output}")), wanted, state)
                if enough:
                    break
                shutil.rmtree("broken")
                os.mkdir("broken")
            else:
                killed += 1
                resumed += os.path.exists("broken/state")
        else:
            self.fail(f"killed only {killed} times")
        print(f"{seconds:.2f} s, {killed} kills, {resumed} with a checkpoint, {ended} ends compared", end=" ... ")
        self.assertGreaterEqual(2 * resumed, KILLS, "kills before the first checkpoint would show nothing")

    def integral(self, method, evaluations):
        self.survives("printed", f"integrate sin(x)*y+exp(-40*(z-0.5)^2) --over x,y,z=0:1 --method {method}"
                      f" --evaluations {evaluations} --checkpoint state --checkpoint-every 0 --resume --quiet"
                      " --json")  # fmt: skip

    def test_basic_integral(self):
        self.integral("basic", "1e6")

    def test_vegas_integral(self):
        self.integral("vegas", "1e6")

    def test_adaptive_integral(self):
        self.integral("adaptive", "5e5")

    def test_pictures(self):
        for sampler, adaptive in itertools.product(("independent", "sobol"), ("on", "off")):
            with self.subTest(sampler, adaptive=adaptive):
                self.survives("x.pfm", f"render ../ball.pbrt --sampler {sampler} --spp 200 --adaptive {adaptive} --seed"
                              " 1 --quiet -o x.pfm --checkpoint state --checkpoint-every 0.001 --resume")  # fmt: skip
