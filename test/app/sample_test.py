"""montelux sample: point sets and samples of densities, in every format."""

import os
import re
import shutil
import signal
import struct

from program import ProgramTest, csv_rows, has_command, read, skip_unless, write

MISTAKES = """
    2 expected --set NAME, or --density $
    2 'sobl' is not known (did you mean 'sobol'?) $ --set sobl
    2 'scrambel' is not known (did you mean 'scramble'?) $ --set sobol --randomisation scrambel
    2 randomisation 'scramble' of weyl $ --set weyl --randomisation scramble
    2 expected 1 to 1024 $ --set sobol --dim 2000
    2 expected a whole number $ --set sobol --dim 0
    2 expected a whole number $ --set sobol --n 0
    2 'xml' is not known $ --set sobol --format xml
    1 /no/such/folder/p.csv $ --set sobol -o /no/such/folder/p.csv
    2 expected --over with it $ --set sobol --let k=5
    2 expected --log with it $ --set sobol --sampler slice
    2 such files hold chains $ --set sobol --format netcdf
    2 such files hold chains $ --set sobol -o points.nc
    2 has the dimensions of its variables $ --density exp(-x) --over x=0:inf --dim 3
    2 is infinite and has no uniform density $ --over x=0:inf
    2 no variable is given $ --density exp(-x)
    1 --density 'x-1' $ --density x-1 --over x=0:2
    2 expected --from FILE $ --unweighted
    1 none.mx $ --from none.mx
"""
CHAIN_MISTAKES = """
    2 expected --log with a formula $ -x --over x=0:1
    1 the density is zero at all of 1000 points $ log(0) --log --over x=0:1
    2 2 numbers were given for 1 variables $ -x --log --over x=0:1 --start 1,2
    2 'slce' is not known (did you mean 'slice'?) $ -x --log --over x=0:1 --sampler slce
    2 3 are too few for 2 variables; expected at least 4 $ -x --log --over x,y=0:1 --sampler slice --walkers 3
    2 chains of metropolis have none $ -x --log --over x=0:1 --walkers 8
    2 3 starts were given for 4 chains $ -x --log --over x=0:1 --start 0.1 --start 0.2 --start 0.3
    2 has the name of a column $ -draw --log --over draw=0:1 -o chains.nc
    2 has the name of a column $ -chain --log --over chain=0:1
    2 1000000000 chains or walkers in all are too many for 1 variable; expected at most 536870912
      $ -x --log --over x=0:1 --sampler slice --walkers 100000 --chains 10000
    1 lie in a subspace
      $ -x^2-y^2 --log --over x,y=-1:1 --sampler slice --chains 1 --walkers 4 --start 0,0.1\
 --start 0,0.2 --start 0,0.3 --start 0,0.4
"""


def mean(values):
    values = list(values)
    return sum(values) / len(values)


class SampleTest(ProgramTest):
    def sample(self, line, **how):
        """The columns that a command prints, by name."""
        names, rows = csv_rows(self.output(f"sample {line}", **how))
        return dict(zip(names, zip(*rows)))


class Points(SampleTest):
    def test_first_sobol_points(self):
        self.assertEqual(self.output("sample --set sobol --n 4 --dim 2"), "u1,u2\n0,0\n0.5,0.5\n0.25,0.75\n0.75,0.25\n")

    def test_every_set_fills_the_cube(self):
        listed = re.search(r"Which points of \[0, 1\)\^d: (.*)", self.output("sample --help"))[1]
        sets = {*re.findall(r"\w+", listed), "halton", "hammersley"}
        self.assertIn("sobol", sets)
        for name in sets:
            with self.subTest(name):
                columns = self.sample(f"--set {name} --n 512 --dim 3 --seed 5 --randomisation shift")
                self.assertEqual([len(column) for column in columns.values()], [512] * 3)
                for column in columns.values():
                    self.assertTrue(0 <= min(column) and max(column) < 1)
                    self.assert_near(mean(column), 0.5, 0.1)

    def test_seed_changes_the_points(self):
        one, two = (self.output(f"sample --set sobol --n 64 --randomisation scramble --seed {k}") for k in (1, 2))
        self.assertNotEqual(one, two)

    def test_density(self):
        """An exponential variable of rate 5 has mean 0.2."""
        columns = self.sample("--density exp(-5*x) --over x=0:inf --n 20000")
        self.assertEqual(list(columns), ["x"])
        self.assertGreaterEqual(min(columns["x"]), 0)
        self.assert_near(mean(columns["x"]), 0.2, 0.01)
        self.assert_near(mean(x * x for x in columns["x"]), 0.08, 0.01)

    def test_quasi_random_samples_have_means_of_small_error(self):
        """A variable without a density is uniform."""
        columns = self.sample("--density x=exp(-5*x) --over x=0:inf --over y=2:4 --set sobol --randomisation scramble"
                              " --n 4096")  # fmt: skip
        self.assert_near(mean(columns["x"]), 0.2, 0.001)
        self.assert_near(mean(columns["y"]), 3, 0.001)

    def test_formats_hold_the_same_numbers(self):
        for format in "csv", "npy", "bin":
            self.expect(0, "", f"sample --set weyl --n 100 --dim 3 -o points.{format}")
        binary, npy = read("points.bin"), read("points.npy")
        self.assertEqual(len(binary), 2400)
        self.assertEqual(npy[-2400:], binary)
        self.assertEqual((len(npy) - 2400) % 64, 0, "the header is aligned")
        self.assertIn(b"'shape': (100, 3)", npy[:128])
        rows = csv_rows(read("points.csv").decode())[1]
        self.assertEqual(tuple(sum(rows, [])), struct.unpack("<300d", binary))

    def test_full_disk_is_noticed(self):
        with open("/dev/full", "wb") as full:
            job = self.start("sample --set sobol --n 100000", stdout=full)
            self.assertNotEqual(job.ended().code, 0)

    def test_mistakes(self):
        self.expect_each(MISTAKES, "sample ")


class TrainedDensities(SampleTest):
    """Weighted samples, whose weights add up to the integral 1/8, and unweighted ones that follow the integrand."""

    @classmethod
    def prepare(cls):
        cls.output("integrate x*exp(-50*(x-y)^2) --over x=0:1 --over y=-1:2 --method adaptive --evaluations 50k"
                   " --save-density trained.mx --quiet")  # fmt: skip

    def test_uniform_density_is_reported(self):
        """adaptive does not train where uniform points suffice."""
        self.expect(0, "the density in 'flat.mx' is uniform", "integrate 1+x --over x=0:1 --method adaptive"
                    " --relative-error 0.01 --save-density flat.mx")  # fmt: skip

    def test_weights_add_up_to_the_integral(self):
        columns = self.sample("--from trained.mx --n 20000")
        self.assertEqual(list(columns), ["x", "y", "weight"])
        self.assert_near(sum(columns["weight"]), 0.125, 0.003)

    def test_unweighted_samples_follow_the_integrand(self):
        text = self.expect(0, "", "sample --from trained.mx --unweighted --n 20000 -o out.csv")
        self.assertRegex(text, r"20000 unweighted samples, efficiency 0\.[4-9]")
        rows = csv_rows(read("out.csv").decode())[1]
        self.assertEqual(len(rows), 20000)
        self.assert_near(sum(x * weight for x, _, weight in rows) / sum(row[2] for row in rows), 0.667, 0.01)
        self.quietly("sample --from trained.mx --unweighted --n 20000 --threads 1 -o one.csv")
        self.assert_same("out.csv", "one.csv", "threads change the samples")

    def test_histogram(self):
        columns = self.sample("--from trained.mx --histogram x=0:1:2 --covariance --n 50000")
        self.assertEqual(list(columns), "lower,upper,value,standard_error,covariance_1,covariance_2".split(","))
        lower, upper = columns["value"]
        self.assert_near(lower / (lower + upper), 0.25, 0.01)

    def test_logarithm(self):
        self.output("integrate --log -5000-x^2/2 --over x=-inf:inf --method vegas --evaluations 20k"
                    " --save-density log.mx")  # fmt: skip
        self.expect(0, "log Z = -4999.08", "sample --from log.mx --unweighted --n 5000")

    def test_ball(self):
        self.output("integrate 1+x --domain ball --over x,y --method vegas --evaluations 20k --save-density ball.mx")
        columns = self.sample("--from ball.mx --n 2000")
        self.assertLessEqual(max(x * x + y * y for x, y in zip(columns["x"], columns["y"])), 1)
        self.assert_near(sum(columns["weight"]), 3.15, 0.05)

    def test_draws_are_limited(self):
        self.expect(3, "only 5 of 100 samples were found in 5 draws", "sample --from trained.mx --n 100 --max-draws 5")

    def test_observables_that_are_not_numbers(self):
        self.expect(0, "have an observable that is not finite",
                    "sample --from trained.mx --histogram sqrt(x-0.5)=0:1:2 --n 1000")  # fmt: skip

    def test_mistakes(self):
        write("cut.mx", read("trained.mx")[:300])
        shutil.copy("trained.mx", "kept.mx")
        self.expect_each("""
            1 cut.mx $ sample --from cut.mx
            1 trains no density $ integrate x --over x=0:1 --save-density cubature.mx
            2 'basic' trains no density
              $ integrate x --over x=0:1 --method basic --evaluations 1e15 --save-density basic.mx
            2 leave it out with --histogram $ sample --from trained.mx --histogram x=0:1:2 --max-draws 5
            2 kept.mx $ sample --from kept.mx -o kept.mx
            2 --set: leave it out with --from $ sample --from trained.mx --set sobol
            2 expected --unweighted $ sample --from trained.mx --pilot 100
            2 expected OBSERVABLE=LOWER:UPPER:BINS $ sample --from trained.mx --histogram x
            2 there is no variable 'q' $ sample --from trained.mx --histogram q=0:1:3
            1 /no/such/folder/p.csv $ sample --from trained.mx -o /no/such/folder/p.csv
            2 leave it out with --from $ sample --from trained.mx --let k=5
        """)


class Chains(SampleTest):
    GAUSSIAN = "sample -x^2-y^2+x*y --log --over x,y=-inf:inf"

    def test_metropolis(self):
        text = self.expect(0, "", f"{self.GAUSSIAN} --n 5000 -o chains.npy")
        self.assertEqual(os.path.getsize("chains.npy") % 32, 0)
        self.assertRegex(text, r"x: mean .*R-hat 1\.00.*effective samples")

    def test_ensembles(self):
        for sampler in "ensemble", "slice":
            with self.subTest(sampler):
                line = f"{self.GAUSSIAN} --n 2000 --sampler {sampler}"
                outcome = self.outcome(f"{line} --threads 1", apart=True)
                self.assertEqual(outcome.code, 0, outcome)
                self.assertIn("4 ensembles of 8 walkers, 2000 draws each", outcome.errors)
                self.assertEqual(self.output(f"{line} --quiet"), outcome.text, "threads change the draws")
                values = [row[2] for row in csv_rows(outcome.text)[1]]
                self.assertEqual(len(values), 64000)
                variance = mean(x * x for x in values) - mean(values) ** 2
                self.assert_near(variance, 2 / 3, 0.035)

    def test_number_of_walkers(self):
        text = self.output("sample -x --log --over x=0:1 --n 1000 --sampler slice --chains 2 --walkers 5 --start 0.5")
        self.assertEqual(text.count("\n"), 10001)

    def test_chains_that_disagree(self):
        starts = "--start=-20 --start 20 --start=-20 --start 20"
        self.expect(0, "warning: the chains disagree: R-hat of 'x'",
                    f"sample log(exp(-(x-20)^2)+exp(-(x+20)^2)) --log --over x=-30:30 {starts}")  # fmt: skip

    def test_report_is_of_the_draws_that_are_written(self):
        """Thinned draws are nearly independent."""
        text = self.expect(0, "", "sample -x^2/2 --log --over x=-inf:inf --n 1000 --thin 50")
        self.assert_near(float(re.search(r"effective samples ([0-9.e+]+)", text)[1]), 4000, 1000)

    def test_chains_at_rest(self):
        self.expect(0, "the draws of 'x' are all equal: no chain moved",
                    "sample 0-(x*1e9)^2 --log --over x=-1:1 --start 0 --burn-in 0 --n 200")  # fmt: skip

    def test_thinned_chains_follow_the_density(self):
        rows = csv_rows(self.output("sample -x --log --over x=0:inf --n 20000 --chains 2 --quiet --thin 5"))[1]
        values = [row[2] for row in rows]
        self.assertEqual(len(values), 40000)
        self.assertGreaterEqual(min(values), 0)
        self.assert_near(mean(values), 1, 0.05)

    def test_netcdf_library_that_is_missing(self):
        outcome = self.outcome("sample -x --log --over x=0:1 -o chains.nc",
                               environment={"MONTELUX_NETCDF_LIBRARY": "/no/such/library.so"})  # fmt: skip
        self.assertNotEqual(outcome.code, 0, outcome)
        self.assertIn("netCDF cannot be loaded from '/no/such/library.so'", outcome.text)

    def test_netcdf(self):
        line = "sample -x^2-y^2 --log --over x,y=-inf:inf --n 500 --sampler slice --quiet"
        outcome = self.outcome(f"{line} -o chains.nc")
        if outcome.code != 0:
            self.assertIn("libnetcdf was not found", outcome.text)
            self.skipTest("netCDF files are not written, which needs libnetcdf")
        self.assertEqual(read("chains.nc")[1:4], b"HDF")
        with open("piped.nc", "wb") as piped:
            self.assertEqual(self.start(f"{line} --format netcdf", stdout=piped).ended().code, 0)
        self.assert_same("chains.nc", "piped.nc")
        try:
            import h5py
        except ImportError:
            self.skipTest("netCDF files are not read back, which needs h5py")
        rows = csv_rows(self.output(line))[1]
        with h5py.File("chains.nc") as file:
            group = file["posterior"]
            self.assertEqual((list(group["chain"]), list(group["draw"])), (list(range(32)), list(range(500))))
            dimensions = group["x"].dims
            self.assertEqual([d[0].name for d in dimensions], ["/posterior/chain", "/posterior/draw"])
            for k, name in enumerate("xy"):
                self.assertEqual(group[name].shape, (32, 500))
                self.assertEqual([float(v) for chain in group[name] for v in chain], [row[2 + k] for row in rows])

    def test_mistakes(self):
        self.expect_each(CHAIN_MISTAKES, "sample ")


class Constants(SampleTest):
    """Constants and the path of a C source in files of densities."""

    def test_constants_in_formulas(self):
        for one, other in [("--density exp(-k*x) --let k=5 --over x=0:inf --n 3",
                            "--density exp(-5*x) --over x=0:inf --n 3"),
                           ("--log --let k=5 -k*x --over x=0:inf --n 100 --quiet",
                            "--log -5*x --over x=0:inf --n 100 --quiet")]:  # fmt: skip
            self.assertEqual(self.output(f"sample {one}"), self.output(f"sample {other}"))

    def source(self, factor=""):
        write("f.c", "double integrand(int n, const double *x, const double *p) "
              f"{{ return {factor}p[0] * x[0] * x[n - 1]; }}\n")  # fmt: skip

    def train(self):
        skip_unless(has_command("cc"), "there is no C compiler")
        self.source()
        self.output("integrate --source f.c --let k=4 --over x=0:1 --over y=0:k/4 --method vegas --save-density c.mx")

    def test_density_of_a_source(self):
        self.train()
        columns = self.sample("--from c.mx --histogram k*x=0:k:2 --n 20000")
        self.assert_near(columns["value"][0], 0.25, 0.01)
        self.assert_near(columns["value"][1], 0.75, 0.01)
        os.mkdir("elsewhere")
        self.expect(0, "", "sample --from ../c.mx --n 5", cwd="elsewhere")
        self.assertNotIn("has changed", self.expect(0, "", "sample --from c.mx --n 5"))
        self.source("2 * ")
        self.assertIn("f.c' has changed since the density was trained", self.outcome("sample --from c.mx --n 5").text)
        os.remove("f.c")
        self.expect(1, "f.c: there is no such file", "sample --from c.mx")

    def test_source_is_not_overwritten(self):
        self.train()
        before = read("f.c")
        self.expect(2, "f.c", "integrate --source f.c --let k=4 --over x=0:1 --method vegas --save-density f.c")
        self.assertEqual(read("f.c"), before)

    def test_signal_while_compiling_leaves_no_folder(self):
        skip_unless(has_command("cc"), "there is no C compiler")
        self.source()
        os.mkdir("temporary")
        write("slow-cc", '#!/bin/sh\ntouch started\nsleep 1\nexec cc "$@"\n')
        os.chmod("slow-cc", 0o755)
        job = self.start("integrate --source f.c --let k=4 --over x=0:1",
                         environment={"TMPDIR": os.path.abspath("temporary"), "CC": "./slow-cc"})  # fmt: skip
        self.until(lambda: os.path.exists("started"), "a compiler", job=job)
        self.assertNotEqual(os.listdir("temporary"), [], "the compiler's folder is elsewhere")
        job.signal(signal.SIGTERM)
        self.assertEqual(job.ended().code, 130)
        self.assertEqual(os.listdir("temporary"), [])
