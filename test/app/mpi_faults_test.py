"""MPI jobs in which a rank is killed, hangs or gets a signal end with a message, and resume to the same bits."""

import os
import signal
import time

from mpi import MpiTest
from program import SKY, remove, scene

WHOLE = "render ball.pbrt --sampler independent --spp 600 --adaptive on --seed 3"
ENDLESS = WHOLE + " --spp 100000 --threads 1 -o many.exr --checkpoint state --checkpoint-every 0.1"


class FaultTest(MpiTest):
    def setUp(self):
        self.clear()

    def clear(self):
        remove("state", "state.previous", "many.exr")

    def saving(self, n, line):
        """Starts a job and waits for its first checkpoint."""
        job = self.background(n, line)
        self.until(lambda: os.path.exists("state"), "a checkpoint", job=job)
        return job

    def send(self, number, rank):
        process = dict(self.processes()).get(rank)
        if process is None:
            return False
        os.kill(process, number)
        return True

    def ended_within(self, job, seconds):
        begin = time.monotonic()
        outcome = job.ended()
        self.assertLess(time.monotonic() - begin, seconds, outcome)
        return outcome

    def resumed(self, n, line):
        outcome = self.ranks(n, f"{line} --threads 1 --quiet -o many.exr --checkpoint state --resume")
        self.assertEqual(outcome.code, 0, outcome)

    def was_interrupted(self):
        return '"interrupted" = 1' in self.outcome("info many.exr").text


class KilledRanks(FaultTest):
    def test_job_ends_with_a_message_and_resumes(self):
        for victim in 0, 2:
            with self.subTest(rank=victim):
                self.clear()
                job = self.saving(3, ENDLESS)
                written = os.stat("state").st_ino
                self.until(lambda: os.path.exists("state.previous") or os.stat("state").st_ino != written,
                           "another checkpoint", job=job)
                self.assertTrue(self.send(signal.SIGKILL, victim), "there is no such rank")
                outcome = self.ended_within(job, 10)
                self.assertNotEqual(outcome.code, 0, outcome)
                self.assertIn("signal 9", outcome.text)
                self.resumed(2, WHOLE)  # the bits may differ: the killed rank may have been ahead

    def kill_and_resume(self, line, n, victim):
        """Kills a rank at the first checkpoint; repeated where the render ends before that."""
        self.quietly(f"{line} -o one.exr")
        for _ in range(5):
            self.clear()
            job = self.saving(3, f"{line} --threads 1 -o many.exr --checkpoint state --checkpoint-every 0.05")
            self.send(signal.SIGKILL, victim)
            job.ended()
            if not os.path.exists("many.exr") or self.was_interrupted():
                break
        else:
            self.fail(f"the render had ended before rank {victim} was killed")
        self.resumed(n, line)
        self.assert_same_but_seconds("one.exr", "many.exr", line)

    def test_adaptive_render_resumes_to_the_same_bits(self):
        self.kill_and_resume(WHOLE, 4, 1)

    def test_other_integrators_resume_to_the_same_bits(self):
        for options in ("--spp 192 --integrator bidirectional", "--spp 128 --integrator metropolis",
                        "--spp 256 --guiding on"):  # fmt: skip
            with self.subTest(options):
                self.kill_and_resume(f"render ball.pbrt {options}", 2, 2)


class Signals(FaultTest):
    def test_picture_and_checkpoint_are_written(self):
        """The signal goes to mpirun, as from Ctrl-C, or to a single rank."""
        for target in "mpirun", 0, 1:
            with self.subTest(target):
                self.clear()
                job = self.saving(3, ENDLESS)
                if target == "mpirun":
                    job.signal(signal.SIGINT)
                else:
                    self.assertTrue(self.send(signal.SIGINT, target), "there is no such rank")
                outcome = self.ended_within(job, 8)
                self.assertNotEqual(outcome.code, 0, outcome)
                if target != "mpirun":
                    self.assertEqual(outcome.code, 130, outcome)
                self.expect(0, '"interrupted" = 1', "info many.exr")
                self.assertTrue(os.path.exists("state"), "there is no checkpoint")


class HangingRanks(FaultTest):
    def test_job_ends_with_a_message(self):
        job = self.saving(3, ENDLESS + " --rank-timeout 2")
        self.assertTrue(self.send(signal.SIGSTOP, 1), "there is no such rank")
        outcome = self.ended_within(job, 10)
        self.assertIn("error: rank 1 has not answered for", outcome.text)
        self.expect(0, '"interrupted" = 1', "info many.exr")

    def test_job_ends_before_the_rank_has_built_the_scene(self):
        """Rank 0 reads the scene first, and renders."""
        scene("slow", f"{SKY} " + 'Shape "sphere" "float radius" 0.01\n' * 250000, 70, 50)
        job = self.saving(2, "render slow.pbrt --spp 1000000 --adaptive on --threads 1 -o many.exr --checkpoint state"
                             " --checkpoint-every 0.05 --rank-timeout 2")  # fmt: skip
        self.assertTrue(self.send(signal.SIGSTOP, 1), "there is no such rank")
        outcome = self.ended_within(job, 10)
        self.assertEqual(outcome.code, 1, outcome)
        self.assertIn("error: rank 1 has not answered for", outcome.text)
        self.expect(0, '"interrupted" = 1', "info many.exr")
        self.expect(0, "many.exr: 70 x 50",
                    "render slow.pbrt --spp 1 --adaptive on -o many.exr --checkpoint state --resume")  # fmt: skip
