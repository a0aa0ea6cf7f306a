"""Renders and integrals by MPI ranks: results equal those of one process, and errors are printed once."""

from mpi import MpiTest
from program import edited, scene, without_seconds

INTEGRATORS = [
    "--spp 16 --integrator bidirectional", "--spp 5 --integrator light-tracing --sampler independent",
    "--spp 24 --integrator metropolis", "--spp 32 --guiding on", "--spp 300 --integrator auto",
    "--spp 6 --integrator bidirectional --merging auto",
]  # fmt: skip
ADAPTIVE = ["--target-error 4% --sampler independent", "--spp 30 --adaptive on --seed 7"]
EMPTY_CROP = "--crop 0.5001,0.5002,0,1"


class Pictures(MpiTest):
    def assert_bits(self, options, counts, scene="ball"):
        """Compares the picture of the ranks with that of one process with more threads."""
        with self.subTest(options):
            self.quietly(f"render {scene}.pbrt {options} --threads 7 -o one.exr")
            for n in counts:
                outcome = self.ranks(n, f"render {scene}.pbrt {options} --threads 1 -o many.exr")
                self.assert_once(outcome, 0, "many.exr: 70 x 50 pixels")
                self.assert_same_but_seconds("one.exr", "many.exr", f"{options} on {n} ranks")

    def test_any_number_of_ranks(self):
        self.assert_bits("--spp 40", [1, 2, 3, 4])

    def test_independent_sampler(self):
        self.assert_bits("--spp 40 --sampler independent", [1, 4])

    def test_adaptive(self):
        for options in ADAPTIVE:
            self.assert_bits(options, [1, 4])

    def test_integrators_and_guide(self):
        for options in INTEGRATORS:
            self.assert_bits(options, [3])

    def test_spectral_film(self):
        edited("ball.pbrt", "spectral.pbrt", ('Film "rgb"', 'Film "spectral"'))
        self.assert_bits("--spp 8", [2], "spectral")

    def test_merged_slices_equal_the_whole(self):
        options = "render ball.pbrt --spp 40 --sampler independent --quiet"
        for k in 1, 2, 3, 4:
            outcome = self.ranks(2, f"{options} --slice {k}/4 --threads 1 -o part{k}.exr")
            self.assertEqual(outcome.code, 0, outcome)
        self.quietly(options.removesuffix(" --quiet") + " -o one.exr")
        self.expect(0, "", "merge part1.exr part2.exr part3.exr part4.exr -o merged.exr")
        errors = {channel["name"]: channel["rmse"] for channel in self.json("compare merged.exr one.exr")["channels"]}
        self.assertEqual(sorted(errors), ["B", "G", "R"])
        self.assertLess(max(errors.values()), 1e-6)

    def test_statistics_count_ranks(self):
        outcome = self.ranks(2, "render ball.pbrt --spp 40 --stats -o many.exr")
        self.assert_once(outcome, 0, "ranks              2, with")


# Its numbers say where the peak is.
PEAK = "x*y*z+exp(-1e5*((x-0.3)^2+(y-0.7)^2+(z-0.45)^2))"


class Integrals(MpiTest):
    def test_integrals_equal_those_of_one_process(self):
        formulas = {"basic": "sin(x)*y+exp(-40*(z-0.5)^2)", "vegas": "1/(x+y+z)", "cubature": PEAK}
        for method, formula in formulas.items():
            line = f"integrate {formula} --method {method} --over x,y,z=0:1 --evaluations 3e5 --seed 3 --json --quiet"
            alone = without_seconds(self.output(line))
            jobs = [self.background(n, line + " --threads 1") for n in (2, 3)]
            for n, job in zip((2, 3), jobs, strict=True):
                with self.subTest(method, ranks=n):
                    outcome = job.ended()
                    self.assertEqual(without_seconds(outcome.text), alone, outcome)


class Mistakes(MpiTest):
    def test_one_message_and_the_exit_code_of_one_process(self):
        scene("bad", 'Shape "spher"')
        mistakes = [
            (3, 1, "montelux: error: missing.pbrt", "render missing.pbrt"),
            (3, 1, "montelux: error: bad.pbrt:6:", "render bad.pbrt"),
            (3, 2, "'none' was given", "render ball.pbrt --spp none"),
            (3, 2, "montelux: error: --slice: there are fewer", "render ball.pbrt --spp 4 --slice 5/9"),
            (3, 2, "no pixel", f"render ball.pbrt {EMPTY_CROP}"),
            (3, 2, "montelux: error: ", "integrate x* --over x=0:1"),
        ]
        jobs = [self.background(n, line) for n, _, _, line in mistakes]
        for (_, code, text, line), job in zip(mistakes, jobs, strict=True):
            with self.subTest(line):
                self.assert_once(job.ended(), code, text)

    def test_message_of_rank_0_is_printed_if_it_fails_last(self):
        """Launchers kill the job as soon as one rank fails."""
        late = ["sh", "-c", '[ "$OMPI_COMM_WORLD_RANK" = 1 ] || sleep 2; exec "$@"', "-"]
        lines = "render ball.pbrt --spp none", "integrate x* --over x=0:1"
        jobs = [self.background(3, line, before=late) for line in lines]
        for line, job in zip(lines, jobs, strict=True):
            with self.subTest(line):
                alone = self.outcome(line)
                self.assert_once(job.ended(), alone.code, alone.text.splitlines()[0])

    def test_mistake_that_rank_1_alone_finds(self):
        """Rank 1 fails while it builds the scene."""
        other = ["sh", "-c", f'[ "$OMPI_COMM_WORLD_RANK" != 1 ] || set -- "$@" {EMPTY_CROP}; exec "$@"', "-"]
        outcome = self.ranks(3, "render ball.pbrt --spp 40 -o alone.exr", before=other)
        self.assert_once(outcome, 1, "montelux: error: rank 1: ")

    def test_commands_that_cannot_be_shared_print_once(self):
        self.quietly("render ball.pbrt --spp 1 -o one.exr")
        self.assert_once(self.ranks(3, "render ball.pbrt --debug-sample 35,25,3"), 0, "vertex 1:")
        self.assert_once(self.ranks(2, "info one.exr"), 0, "70 x 50 pixels")
