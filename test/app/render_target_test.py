"""Renders with a target error, a time limit and checkpoints: exit codes, messages, wrong usage."""

import re

from program import SKY, ProgramTest, read, read_pfm, scene, write

REACHED = """
    0 target reached $ --target-error 2%
    0 target reached $ --target-error 0.02 --adaptive off --sampler sobol
    0 target reached $ --target-error 0.05 --target-quantile 95%
    3 samples are used up before the target was reached $ --target-error 1e-5 --max-spp 16
    3 time is up before the target was reached $ --target-error 1e-7 --time 0.2
    0 time is up $ --time 0.2s
    0 16 samples per pixel $ --time 1h --spp 16
    0 samples were clamped, which removed $ --clamp 0.5
    # Advice on options for half the error.
    0 for half the error: --spp 16, about  $
    0 for half the error: --target-error 4%, about  $ --target-error 8%
    0 for half the error: --time 1s $ --time 0.1 --sampler independent
    3 to reach the target: --max-spp  $ --target-error 0.1% --max-spp 32
    3 to reach the target: --time  $ --target-error 1e-5 --time 0.1
"""
MISTAKES = [
    *[(2, f"--target-error: '{v}' was given", "--target-error", v)
      for v in ("0", "-1", "1", "2", "nan", "x", "", "120%", "1e-2x")],
    *[(2, f"--time: '{v}' was given", "--time", v) for v in ("0", "-1", "10x", "m", "1m1h", "1h30", "", "nan")],
    (2, "--target-quantile: expected --target-error", "--target-quantile 0.9"),
    (2, "--resume: expected --checkpoint FILE", "--resume"),
    (2, "--adaptive: 'maybe' was given; on or off", "--adaptive maybe"),
    (2, "--clamp: '0' was given", "--clamp 0"),
    (2, "the scene is read from this file", "--checkpoint ball.pbrt"),
    (1, "nowhere", "--checkpoint nowhere/state"),
]  # fmt: skip


class TargetTest(ProgramTest):
    @classmethod
    def prepare(cls):
        scene("ball", f'{SKY} Material "diffuse" Shape "sphere"', 24, 18)


class Targets(TargetTest):
    def test_reports(self):
        self.expect_each(REACHED, "render ball.pbrt -o x.exr ")

    def test_share_of_light_that_clamping_removes(self):
        def luminance(option):
            text = self.expect(0, "", f"render ball.pbrt --spp 4 --sampler independent -o light.pfm {option}")
            red, green, blue = (sum(read_pfm("light.pfm")[2][c::3]) for c in range(3))
            return text, 0.2126 * red + 0.7152 * green + 0.0722 * blue

        text, left = luminance("--clamp 0.25")
        share = float(re.search(r"clamped, which removed ([0-9.]+) % of the light", text)[1])
        self.assert_near(share, 100 * (1 - left / luminance("")[1]), 0.1)

    def test_file_records_the_reason_of_the_end(self):
        self.expect(0, "target reached", "render ball.pbrt --target-error 2% -o ended.exr")
        self.expect(0, "stoppedBy", "info ended.exr")

    def test_share_of_visible_errors_is_reported(self):
        text = self.expect(0, "", "render ball.pbrt -o x.exr")
        self.assertRegex(text, r"relative error [0-9.]+ %, visible in [0-9.]+ % of the pixels, ")

    def test_no_advice_without_visible_errors(self):
        scene("even", SKY, 24, 18)
        text = self.expect(0, "visible in none of the pixels", "render even.pbrt --spp 4096 -o x.exr")
        self.assertNotIn("for half the error", text)

    def test_mistakes(self):
        self.expect_each(MISTAKES, "render ball.pbrt -o y.exr ")
        self.assert_absent("y.exr")


class Checkpoints(TargetTest):
    RENDER = "render ball.pbrt --resume --checkpoint "

    def test_finished_render_resumes_to_more_samples(self):
        resume = self.RENDER + "state"
        self.expect(0, "is not there yet: rendering from the start", f"{resume} --spp 20 -o a.pfm")
        self.expect(0, "52 samples per pixel", f"{resume} --spp 52 -o a.pfm")
        self.expect(0, "state has 52 samples per pixel already, more than the requested 20",
                    f"{resume} --spp 20 -o less.pfm")  # fmt: skip
        self.assert_same("a.pfm", "less.pfm")
        self.expect(0, "state: nothing is left to render: all its samples are taken already; a larger --spp continues"
                    " it", f"{resume} --spp 52 -o a.pfm")  # fmt: skip
        self.expect(0, "", "render ball.pbrt --spp 52 -o b.pfm")
        self.assert_same("a.pfm", "b.pfm")
        self.expect(1, "of another render: the sampler or seed differs", f"{resume} --seed 9 -o x.pfm")
        self.expect(1, "the film differs", f"{resume} --clamp 3 -o x.pfm")
        write("state", read("state") + b"x")
        self.expect(0, "resuming from the checkpoint before the last", f"{resume} --spp 52 -o c.pfm")
        self.assert_same("c.pfm", "b.pfm")
        for name in "state", "state.previous":
            write(name, read(name) + b"x")
        self.expect(1, "state", f"{resume} --spp 52 -o x.pfm")
        self.assert_absent("x.pfm")

    def test_resume_names_why_nothing_is_left(self):
        for name, option, reason in [
            ("by_error", "--target-error 2%", "the target error is reached already; a smaller --target-error"),
            ("by_time", "--time 0.2", "0.2 s are used up.*; a longer --time"),
        ]:
            with self.subTest(option):
                line = f"render ball.pbrt {option} --resume --checkpoint {name} -o a.exr"
                self.expect(0, f"{name} is not there yet", line)
                self.assertRegex(self.expect(0, f"{name}: nothing is left to render: ", line), reason)

    def test_names_of_files_that_exist(self):
        self.expect(0, "", "render ball.pbrt -o a.pfm")
        self.expect_each("""
            2 the file exists; add --resume $ render ball.pbrt --checkpoint a.pfm -o x.pfm
            2 the checkpoint has this name $ render ball.pbrt --checkpoint z.pfm -o z.pfm
        """)
        self.assert_absent("x.pfm", "z.pfm")

    def test_checkpoint_after_every_step(self):
        self.expect(0, "4 samples per pixel", "render ball.pbrt --checkpoint often --checkpoint-every 0 --threads 1"
                    " -o often.pfm")  # fmt: skip
