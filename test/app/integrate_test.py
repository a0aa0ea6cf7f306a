"""montelux integrate with formulas: results, files, limits, messages for mistakes."""

import json
import os
import re
import shutil
import signal
import time
import xml.etree.ElementTree

from program import ProgramTest, csv_rows, read, remove, without_seconds, write

# (value, tolerance, formula and options)
VALUES = [
    (0.5, 0.02, "sin(x)*y --over x=0:pi/2 --over y=0:1 --relative-error 5e-3"),
    # Ranges: infinite ones, formulas at their ends, several variables at once.
    (1, 0.02, "exp(-x) --over x=0:inf --method basic --evaluations 1e5"),
    (1.7724539, 0.05, "exp(-x^2) --over x=-inf:inf --method basic --evaluations 1e5"),
    (8, 1e-9, "1 --over x,y=-1:1 --over 'z=0:sqrt(4)'"),
    (32, 1e-9, "1 --over x1..x5=0:2"),
    (2, 0.01, "'x<1 ? 2 : 2' --over x=0:1"),
    (1, 0.02, "'(x^2 - 2*x + 1)*3' --over x=0:1"),
    (0.842700793, 0.01, "'erf(1) + 0*x' --over x=0:1"),
    (2, 0.01, "e --over e=0:2"),  # a variable may be called like a constant
    # Peaks at numbers in the formula: beside a variable, as a root, as a constant.
    (6.5973446, 0.03, "exp(-(x^2+y^2)/2)+1e5*exp(-1e6*((x-0.37)^2+(0.61+y)^2)) --over x,y=-5:5 --relative-error 1e-3"),
    (1.4322889, 0.003, "cos(x)+1e4*exp(-((3*x-1)*1e4)^2) --over x=0:1 --relative-error 1e-3"),
    (1.0886227, 0.003, "1+500*exp(-((x-sqrt(0.37))/1e-4)^2) --over x=0:1 --relative-error 1e-3"),
    (12.566371, 0.03, "exp(-((x-3)^2+y^2)/2)+1e4*exp(-5000*((x+4)^2+(y-2)^2)) --over x,y=-10:10 --relative-error 1e-3"),
    (9.424778, 0.03,
     "--relative-error 1e-3 exp(-(x^2+y^2)/2)+1e4*exp(-((x+y-4)^2+(x-y+2.5)^2)/2e-4) --over x,y=-10:10"),
    (9.93449, 0.03,
     "--domain sphere 'max(0,z)+(0.6*x+0.8*z>cos(0.00465) ? 1e5 : 0)' --over x,y,z --relative-error 1e-3"),
    # A leading minus sign begins a formula, not an option.
    (-0.33333333, 1e-6, "-x^2 --over x=0:1"),
    (-0.5, 1e-6, "-(x) --over x=0:1"),
    (-1, 1e-6, "--over x=0:1 -2*x"),
    # Without a target, auto keeps the samples taken so far.
    (1, 1e-6, "exp(-x) --over x=0:inf --evaluations 1e5"),
    (0.25, 1e-6, "x*y --over x,y=0:1 --evaluations 1e5"),
    (-206.7736, 0.002, "asinh(x)/1e9 --over x=-1e10:-1e9 --relative-error 1e-6"),
    # Poles that cancel or are integrable.
    (1.892166140734366, 1e-9, "sin(x)/x --over x=-1:1 --absolute-error 1e-9"),
    (4, 1e-5, "1/sqrt(abs(x)) --over x=-1:1 --absolute-error 1e-6"),
    # Densities: the integrand over its own density has no error.
    (0.2, 1e-9, "exp(-5*x) --over x=0:inf --density x=exp(-5*x) --method basic --evaluations 5000"),
    (0.2, 0.002, "exp(-5*x)*2*y --over x=0:inf --over y=0:1 --density x='3*exp(-5*x)' --evaluations 1e5"),
    (2, 0.02, "1/sqrt(x) --over x=0:1 --density 1/sqrt(x) --evaluations 5000"),
    # Domains
    (3.14159265, 1e-6, "1 --domain ball --over x,y"),
    (0.16666667, 1e-6, "1 --domain simplex --over x,y,z"),
    (50.2654825, 1e-5, "1 --domain sphere --radius 2 --centre 1,2,pi --over x,y,z"),
    (5000, 0.05, "'x9999 + x10000 + 4999' --over x1..x10000=0:1 --method basic --evaluations 2000"),
]  # fmt: skip
DIVERGES, REACHED = "diverges, or converges too slowly", "error target reached"
OUTCOMES = [
    (0, REACHED, "sin(x)*y --over x=0:pi/2 --over y=0:1 --relative-error 1e-2"),  # the command of the README
    (0, "1.5000", "'(0<x)==(x<=0.5) && x!=2 || max(x<0,x>1)>0' --over x=-1:1 --evaluations 1e4"),
    (0, "-0.5000", "--over x=0:1 -- -x"),
    # A target that is reached with a warning is not a success.
    (3, "error target reached, but with a warning", "sqrt(x) --over x=-1:1 --relative-error 1e-2"),
    # Values that are left out are reported, and the target does not count as reached.
    (3, "were not finite and were left out", "sqrt(1-x^2-y^2) --over x,y=-1:1 --absolute-error 3e-5"),
    # A pole whose sides cancel does not converge; a single missing value does no harm.
    (3, DIVERGES, "1/x --over x=-1:1 --absolute-error 1e-6"),
    (3, DIVERGES, "1/(x-0.5) --over x=0:1 --relative-error 1e-3"),
    (3, DIVERGES, "1/x --over x=-1:1 --absolute-error 1e-6 --evaluations 1e5 --method auto"),
    (3, DIVERGES, "1/x --over x=-1:1 --absolute-error 1e-6 --evaluations 1e5 --method cubature"),
    (3, DIVERGES, "x/(x*x+y*y)^2 --over x,y=-1:1 --absolute-error 1e-3 --evaluations 1e5 --method auto"),
    (3, DIVERGES, "x/(x*x+y*y)^2 --over x,y=-1:1 --absolute-error 1e-3 --evaluations 1e5 --method cubature"),
    (0, REACHED, "sin(x)/x --over x=-1:1 --absolute-error 1e-9 --method auto"),
    (0, REACHED, "sin(x)/x --over x=-1:1 --absolute-error 1e-9 --method cubature"),
    (3, "stopped at the number of evaluations",
     "x --over x=0:1 --method basic --relative-error 1e-9 --evaluations 1e4"),
    (3, "stopped by time", "x --over x=0:1 --method basic --relative-error 1e-12 --time 0.3"),
    (0, "stopped by time", "x --over x=0:1 --method basic --time 0.2"),
    (0, "stopped by time", "x --over x=0:1 --method basic --time 0.1s"),
    (0, REACHED, "x --over x=0:1 --method basic --relative-error 1%"),
    (0, "log Z = -4999.08106", "--log -5000-x^2/2 --over x=-inf:inf --relative-error 1e-6"),
    (3, "stopped at the number of evaluations",
     "--log -5000-x^2/2 --over x=-inf:inf --relative-error 1e-6 --method basic --evaluations 10k"),
    (3, "digits that the integrand loses", "--log log(sqrt(1e16+x)-1e8) --over x=0:10 --relative-error 1e-3"),
    (0, "log Z = -inf", "--log log(0*x) --over x=0:1 --method basic --evaluations 1000"),
]  # fmt: skip
# (logarithm, formula and options)
LOGARITHMS = [
    (-4999.081061466796, "-5000-x^2/2 --over x=-inf:inf --relative-error 1e-6"),
    (5000.918938533204, "5000-x^2/2 --over x=-inf:inf --relative-error 1e-3 --method vegas"),
    (-1998.162122933590, "-2000-(x^2+y^2)/2 --over x,y=-inf:inf --relative-error 1e-3 --method adaptive"),
    (-2001.609437912434, "'x<0 ? -inf : -2000-5*x' --over x=-1:9 --relative-error 1e-3 --method quasi"),
    (-8001.609437912434, "-8000-5*x --over x=0:inf --density x=exp(-5*x) --method basic --relative-error 1e-3"),
    (-898.567588041694, "-900 --domain ball --over x,y,z --relative-error 1e-6"),
]
LOST, BY_POLE = "digits that the integrand loses by cancellation", "closer to an end or a pole than doubles can tell"
# Rounding errors: (exact value, warning, formula and options at 1e-3).
CANCELLATIONS = [
    (1.33333333, LOST, "(1-cos(1e-8*x))/1e-16 --over x=0:2"),
    (50, LOST, "(sqrt(1e16+x)-1e8)*2e8 --over x=0:10"),
    (0.25, LOST, "(x*y+1e15)-1e15 --over x,y=0:1"),
    (1.71828183, LOST, "(1+x/1e15)^1e15 --over x=0:1"),
    (41.06024, LOST, "log(1+1/x) --over x=1:1e18"),
    (10.341142, LOST, "(1-cos(x))/x^3 --over x=1e-9:1"),
    (5e-8, LOST, "(1-cos(x))/x^2 --over x=0:1e-7"),
    (2.660806, BY_POLE, "(exp(x)-1-x)/x^2.8 --over x=0:1"),
    # Terms that round alike, zeros in a branch, constants, coordinates.
    (1.33333333, LOST, "1+abs((1e15+x)-(1e15+y)) --over x,y=0:1"),
    (1.5, LOST, "1e20*(exp(-1e-20*t)-exp(-2e-20*t))+1 --over t=0:1"),
    (0.5625, LOST, "'v<1 ? (1/sqrt(1-(v/299792458)^2)-1)*299792458^2 : v^2/2' --over v=0:1.5"),
    (99, LOST, "log(1+exp(-x))*exp(x) --over x=0:100"),
    (1.5, LOST, "x+(1e16+1-1e16) --over x=0:1"),
    (1.5, LOST, "x+a --let b=1e16 --let a=b+1-b --over x=0:1"),
    (1.5, LOST, "1+mod(1e20*x,1) --over x=0:1"),
    (1, LOST, "exp(-(x-1e16)) --over x=1e16:inf"),
    (7.809502, LOST, "(1-cos(x*y*z))/(x*y*z)^2.6 --over x,y,z=0:1 --evaluations 1e5"),
]
# Functions that round: what they lose in sums of nearly equal values is known.
ROUNDED = ["acos(x)", "asin(x)", "asinh(x)", "atan(x)", "atan2(x,2)", "atanh(x)", "cbrt(x)", "cos(x)", "cosh(x)", "erf(x)",
           "erfc(x)", "exp(x)", "expm1(x)", "gamma(x)", "hypot(x,2)", "lgamma(x)", "ln(x)", "log(x)", "log10(x)", "log1p(x)",
           "log2(x)", "pow(x,1.3)", "sin(x)", "sinh(x)", "sqrt(x)", "tan(x)", "tanh(x)", "acosh(x+1)"]  # fmt: skip
WHOLE = ["2^x", "atan2(floor(2*x)-1,x)", "floor(log2(floor(10*x)))", "floor(hypot(3*floor(10*x),4*floor(10*x)))"]
EXACT = ["abs(x)", "ceil(x)", "floor(x)", "max(x,0)", "min(x,1)", "sign(x)", "rint(x)", "avg(x,x)", "mod(x,1)"]
MISTAKES = [
    (2, "expected a FORMULA, --library or --source", ""),
    (2, "--log: 2 formulas were given; expected one", "--log x 1 --over x=0:1"),
    (2, "expected --relative-error, which is the error of log Z", "--log x --over x=0:1 --absolute-error 1"),
    (2, "leave out one of --log and --plot", "--log x --over x=0:1 --plot plot.svg"),
    (1, "is zero where '-5*x-8000' is not", "--log -5*x-8000 --over x=-1:1 --density 'x=x<0 ? 0 : exp(-5*x)'"),
    (2, "a box has none", "1 --over x=0:1 --radius 2"),
    (2, "a simplex has none", "1 --domain simplex --over x,y --centre 1,1"),
    (2, "--checkpoint-every: expected --checkpoint FILE", "1 --over x=0:1 --checkpoint-every 5"),
    (2, "the name of a file is expected", "1 --over x=0:1 --checkpoint ''"),
    (2, "two outputs have the same name", "x --over x=0:1 --checkpoint p.svg --plot p.svg"),
    (2, "there is no variable 'a'; a number is expected here", "x --over x=a:1"),
    (2, "expected a finite number above 0", "x --over x=0:1 --relative-error 0%"),
    (2, "--time: at character", "x --over x=0:1 --time 10x"),
    (2, "no variable is given", "sin(x)"),
    (2, "the range is reversed", "x --over x=1:0"),
    (2, "the range is empty", "x --over x=1:1"),
    (2, "the upper end 'nan' is not a number", "x --over x=0:nan"),
    (2, "the lower end '0/0' is not a number", "x --over x=0/0:1"),
    (2, "is not a range", "x --over x=0"),
    (2, "the range has no upper end", "x --over x=0:"),
    (2, "no range is given", "x --over x"),
    (2, "is not a name of a variable", "x --over 2x=0:1"),
    (2, "'sin' is a function", "x --over sin=0:1"),
    (2, "is given twice", "x --over x=0:1 --over x=0:2"),
    (2, "there is no variable 'z'", "x*z --over x=0:1"),
    (2, "at character 3", "x*z --over x=0:1"),
    (2, "\n      ^\n", "x*z --over x=0:1"),  # a caret under the mistake
    (2, "there is no function 'sine' (did you mean 'sin'?)", "sine(x) --over x=0:1"),
    (2, "the function 'sin' takes its arguments in brackets: sin(x)", "'sin x' --over x=0:1"),
    (2, "the function 'pow' takes its arguments in brackets: pow(x, y)", "2*pow --over x=0:1"),
    (2, "there is no variable 'sine' (did you mean 'sin'?)", "'sine x' --over x=0:1"),
    (2, "at character 4: the function 'exp' takes", "'-2*exp x' --over x=0:1"),
    (2, "at character 2: '**' is not expected here; powers are written x^2", "x**2 --over x=0:1"),
    (2, "there is no variable 'o', and no option '-o'", "x -o out.txt --over x=0:1"),
    (2, "there is no option '--evaluation' (did you mean '--evaluations'?)", "x --over x=0:1 --evaluation 10"),
    (2, "a closing bracket is missing", "sin(x --over x=0:1"),
    (2, "the formula ends too early", "x+ --over x=0:1"),
    (2, "the formula is empty", "'' --over x=0:1"),
    (2, "products need a '*'", "3x --over x=0:1"),
    (2, "'==' compares", "x=3 --over x=0:1"),
    (2, "comparisons are not chained", "'0<x<0.5' --over x=-1:1"),
    (2, "an argument of its own", "x,x --over x=0:1"),
    (2, "gets too many arguments", "sin(x,x) --over x=0:1"),
    (2, "there is no variable 'y'", "x --over x=0:y"),
    (2, "there is no method 'basci' (did you mean 'basic'?)", "x --over x=0:1 --method basci"),
    (2, "there is no domain 'bal' (did you mean 'ball'?)", "x --over x --domain bal"),
    (2, "at least 2 dimensions", "x --over x --domain sphere"),
    (2, "only a box has ranges", "x --over x=0:1 --domain ball"),
    (2, "2 coordinates were given for 3 variables", "x --over x,y,z --domain ball --centre 1,2"),
    (2, "expected a finite number above 0", "x --over x=0:1 --relative-error 0"),
    (2, "expected a finite number above 0", "x --over x=0:1 --absolute-error -1"),
    (2, "expected a finite number above 0 of seconds", "x --over x=0:1 --time nan"),
    (2, "expected a whole number from 1", "x --over x=0:1 --evaluations 0"),
    (2, "expected a whole number", "x --over x=0:1 --evaluations 1.5"),
    (2, "'1.0005k' was given; expected a whole number", "x --over x=0:1 --evaluations 1.0005k"),
    (2, "--evaluations: at character", "x --over x=0:1 --evaluations k"),
    (2, "expected a whole number from 0 to 4096", "x --over x=0:1 --threads -1"),
    (2, "there is no policy 'ignore'", "x --over x=0:1 --non-finite ignore"),
    (2, "expected --checkpoint FILE", "x --over x=0:1 --resume"),
    (2, "ends in .svg", "x --over x=0:1 --plot plot.png"),
    (1, "/no/such/folder/p.svg", "x --over x=0:1 --plot /no/such/folder/p.svg"),
    (1, "/no/such/folder/p.csv", "x --over x=0:1 --points /no/such/folder/p.csv"),
    (1, "/no/such/folder/state", "x --over x=0:1 --checkpoint /no/such/folder/state"),
    (1, "is zero where '1' is not", "1 --over x=0:1 --density 'x<0.5 ? 1 : 0'"),
    (1, "is zero where '-1-x' is not", "--over x=0:1 --density 'x<0.5 ? 1 : 0' -- -1-x"),
    (1, "--density 'x - 0.5'", "1 --over x=0:1 --density 'x - 0.5'"),
    (1, "--density '1/x'", "1 --over x=0:1 --density 1/x"),
    (1, "--density '0*x'", "1 --over x=0:1 --density 0*x"),
    (2, "--density x: at character 1: there is no variable 'y'", "1 --over x=0:1 --over y=0:1 --density x=y"),
    (2, "there is no variable 'z'", "1 --over x=0:1 --density z=1"),
    (2, "has a density already", "1 --over x=0:1 --density x=1 --density x=2"),
    (1, "is a finite number", "sqrt(-1-x) --over x=0:1"),
    (1, "the integrand is nan at (", "sqrt(x-0.5) --over x=0:1 --non-finite throw"),
]
KEYS = """value standard_error covariance evaluations method reason chi_squared degrees_of_freedom
chi_squared_per_degree p_value converged stop warnings non_finite history""".split()


def first(value):
    return value[0] if isinstance(value, list) else value


class Results(ProgramTest):
    def test_values(self):
        for exact, tolerance, line in VALUES:
            with self.subTest(line):
                result = self.json(f"integrate --quiet {line}")
                self.assert_near(first(result["value"]), exact, tolerance)

    def test_cancellation_is_in_the_error(self):
        for exact, warning, line in CANCELLATIONS:
            with self.subTest(line):
                result = json.loads(self.expect(3, warning, f"integrate --json --relative-error 1e-3 {line}", apart=True))
                self.assert_near(first(result["value"]), exact, 3 * first(result["standard_error"]))
                self.assertLess(first(result["standard_error"]), 6 * exact)

    def test_rounding_of_every_function_is_known(self):
        for f in ROUNDED:
            with self.subTest(f):
                at_half = re.sub(r"\bx\b", "0.5", f)
                self.expect(3, LOST, f"integrate --relative-error 1e-3 {f}-{at_half} --over x=0.5:0.5+1e-15")
        for f in EXACT + WHOLE:
            with self.subTest(f):
                result = self.json(f"integrate --relative-error 1e-3 {f}+0.1 --over x=0.4:0.9")
                self.assertEqual([], [w for w in result["warnings"] if LOST in w])
        known = re.search("expected one of (.*)", self.expect(2, "", "integrate none(x) --over x=0:1"))[1]
        tested = {f.split("(")[0] for f in ROUNDED + EXACT} | {"sum"}
        self.assertEqual(sorted(tested), sorted(known.split(", ")))

    def test_long_formulas(self):
        result = self.json("integrate --relative-error 1e-3 --over x=0:1", "+".join(["x"] * 2400))
        self.assert_near(first(result["value"]), 1200, 1e-6)

    def test_outcomes(self):
        self.expect_each(OUTCOMES, "integrate ")

    def test_formulas_and_options_may_begin_with_a_minus_sign(self):
        text = self.expect(0, "", "integrate -x x^2 -.5*x --over=x=0:1 --evaluations 1e4")
        self.assertEqual([line.split(":")[0] for line in text.splitlines()[:3]], ["-x", "x^2", "-.5*x"])

    def test_counts_have_units(self):
        for count, text in [(3000, "3k"), (3000, "3e3"), (2500, "2.5k"), (100000, ".1M"), (1000000, "1M"),
                            (2000000, "0.002G")]:  # fmt: skip
            with self.subTest(text):
                printed = self.expect(0, "", f"integrate x --over x=0:1 --method basic --evaluations {text}")
                self.assertRegex(printed, rf"(?m)^{count} evaluations")

    def test_every_method_integrates_or_reports_an_error(self):
        listed = re.search(r"How: (.*?)Default", self.output("integrate --help"), re.S)[1]
        methods = re.findall(r"[a-z_]+", listed)
        self.assertIn("vegas", methods)
        for method in methods:
            with self.subTest(method):
                line = f"integrate sin(x) --over x=0:pi/2 --method {method} --evaluations 20000 --quiet --json"
                outcome = self.outcome(line, apart=True)
                if outcome.code == 0:
                    self.assert_near(json.loads(outcome.text)["value"], 1, 0.05)
                else:
                    self.assertIn("montelux: error: ", outcome.errors)

    def test_json_of_scalars_vectors_and_unknown_numbers(self):
        vector = self.json("integrate x x^2 --over x=0:1 --method basic --evaluations 5000")
        self.assertEqual([key for key in KEYS if key not in vector], [])
        self.assertEqual([key for key in vector if "chi2" in key], [])
        self.assertEqual((len(vector["value"]), len(vector["standard_error"])), (2, 2))
        covariance = vector["covariance"]
        self.assertEqual((len(covariance), len(covariance[0])), (2, 2))
        self.assertEqual(covariance[0][1], covariance[1][0])
        self.assertEqual((vector["stop"], vector["converged"], vector["evaluations"]), ("evaluations", False, 5000))
        self.assertEqual(vector["history"][-1]["evaluations"], 5000)
        one = self.json("integrate x --over x=0:1 --method basic --evaluations 1")  # an infinite error
        self.assertIsInstance(one["value"], float)
        self.assertIsNone(one["standard_error"])
        self.assertIsNone(one["covariance"])
        nan = self.json("integrate 'x<0.5 ? 1 : nan' --over x=0:1 --method basic --evaluations 5000")
        self.assert_near(nan["value"], 0.5, 0.1)
        self.assertGreater(nan["non_finite"], 2000)
        self.assertEqual(len(nan["warnings"]), 1)
        self.assertGreater(nan["first_non_finite_point"][0], 0.5)

    def test_results_depend_on_the_seed_and_not_on_threads(self):
        line = "integrate sin(x*y) --over x,y=0:1 --evaluations 1e5 --json"
        one, two, five = (without_seconds(self.output(f"{line} --threads {n}")) for n in (1, 2, 5))
        self.assertEqual(one, two)
        self.assertEqual(one, five)
        self.assertNotEqual(one, without_seconds(self.output(f"{line} --seed 1")))

    def test_logarithms_of_integrals_beyond_double_precision(self):
        for exact, line in LOGARITHMS:
            with self.subTest(line):
                result = self.json(f"integrate --log --quiet {line}")
                self.assert_near(result["log_value"], exact, 5 * result["log_error"] + 1e-11)
                self.assertIs(result["converged"], True)
        self.assertNotIn("value", result, "a relative value is printed as Z")

    def test_threads_compile_formulas_at_the_same_time(self):
        formulas = [f"1.5*x+{k}.5" for k in range(1, 201)]
        for _ in range(20):
            self.expect(0, "", "integrate --over x=0:1 --method quasi --evaluations 1024 --threads 16", *formulas)

    def test_threads_share_the_parsers_of_a_density(self):
        line = "integrate exp(-x) --over x=0:1 --density x=1+x --method basic --evaluations 1e5 --quiet"
        self.assertEqual(self.output(f"{line} --threads 8"), self.output(f"{line} --threads 1"))

    def test_warning_for_values_that_are_left_out(self):
        text = self.expect(0, "were not finite and were left out",
                           "integrate sqrt(x-0.5) --over x=0:1 --evaluations 1e4")  # fmt: skip
        self.assertRegex(text, "(?m)^warning: ")
        self.assertNotIn("doubt", text, "another word for a warning")

    def test_progress_on_a_terminal_shows_the_value(self):
        outcome = self.on_terminal("integrate x --over x=0:1 --method basic --relative-error 1e-9 --time 0.5")
        self.assertIn("evaluations, 0.", outcome.text)

    def test_mistakes(self):
        self.expect_each(MISTAKES, "integrate ")

    def test_plot_and_points(self):
        line = "integrate x*y --over x,y=0:1 --method basic --evaluations 1e5 --points-limit 100"
        self.expect(0, "100000 evaluations", f"{line} --points points.csv --plot plot.svg")
        plot = read("plot.svg").decode()
        for text in "evaluations N", "standard error", "value", "1/√N", "</svg>":
            self.assertIn(text, plot)
        xml.etree.ElementTree.fromstring(plot)
        names, rows = csv_rows(read("points.csv").decode())
        self.assertEqual(names, ["x", "y", "x*y"])
        self.assertEqual(len(rows), 100)
        for x, y, value in rows:
            self.assert_near(value, x * y, 1e-12)
        self.expect(0, "100000 evaluations", f"{line} --points again.csv")
        self.assert_same("points.csv", "again.csv")


class Checkpoints(ProgramTest):
    LINE = "integrate sin(x)*y --over x,y=0:1 --method basic"

    def kill_and_resume(self, line, wait):
        """Result of a run that is killed after its first checkpoint and resumed, as lines."""
        remove("state", "state.previous")
        job = self.start(f"{line} --checkpoint state --checkpoint-every 0")
        self.until(lambda: os.path.exists("state"), "a checkpoint", job=job)
        time.sleep(wait)
        job.signal(signal.SIGKILL)
        self.assertIn(job.ended().code, (0, -signal.SIGKILL))
        return without_seconds(self.output(f"{line} --checkpoint state --resume --json"))

    def test_killed_run_resumes_to_the_same_result(self):
        line = f"{self.LINE} --evaluations 1e7 --quiet"
        wanted = without_seconds(self.output(f"{line} --json"))
        for wait in 0, 0.03, 0.1:
            with self.subTest(seconds=wait):
                self.assertEqual(self.kill_and_resume(line, wait), wanted)

    def test_killed_run_of_logarithms_resumes_to_the_same_result(self):
        line = "integrate --log x*y-3000 --over x,y=0:1 --method basic --evaluations 5M --quiet"
        self.assertEqual(self.kill_and_resume(line, 0.05), without_seconds(self.output(f"{line} --json")))

    def test_checkpoints_of_other_runs_are_refused(self):
        self.expect(0, "", f"{self.LINE} --evaluations 1e6 --checkpoint kept")
        shutil.copy("kept", "alone.previous")  # the previous generation alone is a valid checkpoint
        for name in "kept", "alone":
            self.expect(2, "exists already; add --resume", f"integrate sin(x)*y --over x,y=0:1 --checkpoint {name}")
        self.assert_same("kept", "alone.previous", "a refused run replaced the previous generation")
        self.expect(0, "", f"{self.LINE} --evaluations 1e6 --checkpoint alone --resume")
        self.expect(1, "belongs to another integrand, domain, method or seed",
                    "integrate x --over x=0:1 --method basic --checkpoint kept --resume")
        write("cut", read("kept")[:100])
        self.expect(1, "is cut short", f"{self.LINE} --checkpoint cut --resume")
        shutil.copy("kept", "cut.previous")
        self.expect(0, "is cut short", f"{self.LINE} --checkpoint cut --resume")
        text = self.expect(0, "", f"{self.LINE} --checkpoint cut --resume")
        self.assertNotIn("warning", text, "of an undamaged checkpoint")
        write("text", "hello\n")
        self.expect(1, "is not a saved state", "integrate x --over x=0:1 --checkpoint text --resume")

    def test_interruption_prints_the_result_so_far(self):
        job = self.start("integrate x --over x=0:1 --method basic --relative-error 1e-12 --quiet --json")
        result = json.loads(self.interrupted(job))
        self.assert_near(result["value"], 0.5, 0.01)
        self.assertEqual(result["stop"], "interrupted")
