"""Signals during a render: the picture so far is saved, or nothing is left."""

import os
import signal
import time

from program import SKY, ProgramTest, read, scene, write


class Signals(ProgramTest):
    @classmethod
    def prepare(cls):
        scene("long", f'{SKY} Material "diffuse" Shape "sphere"', 400, 300, 1000000)

    def test_picture_so_far_is_saved(self):
        for sampler in "independent", "sobol":
            for number in signal.SIGINT, signal.SIGTERM:
                with self.subTest(sampler, signal=number):
                    job = self.start(f"render long.pbrt --sampler {sampler} --spp 4096")
                    text = self.interrupted(job, number, works=0.2, seconds=2)
                    self.assertIn("stopped before the end", text)
                    info = self.expect(0, '"interrupted" = 1', "info long.exr")
                    # Pixels without samples are black.
                    rows = [line.split() for line in info.splitlines() if line[:2] in ("R ", "G ", "B ")]
                    self.assertEqual(len(rows), 3, info)
                    for row in rows:
                        self.assertEqual(row[4:6], ["0", "0"], f"values that are not finite: {info}")
                os.remove("long.exr")

    def test_errors_are_unknown_where_no_two_replicates_are_finished(self):
        text = self.interrupted(self.start("render long.pbrt --sampler sobol -o none.exr"), signal.SIGTERM)
        self.assertIn("the errors are unknown: fewer than two replicates of 62500 samples per pixel", text)
        self.expect(0, '"relativeError": null', "info none.exr --json")

    def test_second_signal_ends_at_once_and_leaves_checkpoints(self):
        """The first signal waits for the long paths of a pixel in a sphere without absorption. A second one is ignored
        within the same second."""
        scene("furnace", '''Texture "slow" "float" "fbm" "integer octaves" 64
MakeNamedMaterial "white" "string type" "diffuse" "spectrum reflectance" [200 1 900 1]
Material "mix" "string materials" ["white" "white"] "texture amount" "slow" Shape "sphere" "float radius" 5''', 1, 1)
        furnace = ("render furnace.pbrt --sampler independent --adaptive on --max-depth 1000000"
                   " --checkpoint furnace.state")  # fmt: skip
        self.expect(0, "4 samples per pixel", f"{furnace} --spp 4")
        before = read("furnace.state")
        os.remove("furnace.exr")
        job = self.start(f"{furnace} --spp 1000 --resume")  # the next step takes 4 samples
        self.until(lambda: job.works(0.4), "a render", job)
        job.signal(signal.SIGINT)
        time.sleep(0.3)
        job.signal(signal.SIGINT)
        time.sleep(0.8)
        self.assertTrue(job.runs(), "two signals within a second ended the program at once")
        text = self.interrupted(job, seconds=1)
        self.assertIn("ended at once by another signal: no result was written; checkpoints are as they were", text)
        self.assert_absent("furnace.exr")
        self.assertEqual(read("furnace.state"), before, "the checkpoint has changed")

    def test_nothing_is_saved_while_the_scene_is_read(self):
        write("slow.pbrt", read("long.pbrt") + b"AttributeBegin AttributeEnd\n" * 3000000)
        job = self.start("render slow.pbrt -o unread.exr")
        self.interrupted(job, works=0.2)
        self.assert_absent("unread.exr")

    def being_written(self, job):
        """Whether the job has written more than 64 KiB of a file here, which has no name yet, or a temporary one.
        Elsewhere it opens others: its libraries, before it can heed a signal."""
        folder = f"/proc/{job.pid}/fd"
        try:
            for entry in os.listdir(folder):
                if os.readlink(f"{folder}/{entry}").startswith(self.folder + "/"):
                    if os.stat(f"{folder}/{entry}").st_size > 1 << 16:
                        return True
        except OSError:
            pass
        return any(name.startswith(".montelux-") and os.path.getsize(name) > 1 << 16 for name in os.listdir("."))

    def test_picture_that_is_being_written_is_finished(self):
        job = self.start("render long.pbrt --resolution 800x600 --spp 1 --quiet -o large.exr")
        in_time = 0
        while job.runs():
            if self.being_written(job):
                job.signal(signal.SIGINT)
                job.signal(signal.SIGINT)  # the first one alone only requests an early end
                in_time += 1
        outcome = job.ended()
        self.assertGreaterEqual(in_time, 1, "no signal came in time")
        self.assertEqual(outcome.code, 0, outcome)
        self.expect(0, "800 x 600 pixels, 20 channels", "info large.exr")
        self.assert_absent(".montelux-*")

    def test_more_threads_than_processors(self):
        job = self.start("render long.pbrt --threads 11 --quiet -o threads.exr")
        self.until(lambda: len(os.listdir(f"/proc/{job.pid}/task")) >= 11, "11 threads", job=job)
        job.signal(signal.SIGINT)
        job.ended()
