"""montelux integrate with functions in C and C++, from sources and libraries, with constants, and on a device."""

import contextlib
import ctypes
import os
import shutil
import signal
import subprocess

from program import ProgramTest, edited, has_command, skip_unless, write

FUNCTIONS = """#include <math.h>
double integrand(int n, const double *x) { double s = 0; for (int i = 0; i < n; ++i) s += x[i] * x[i]; return s; }
double scaled(int n, const double *x, const double *parameters) { return parameters[1] * exp(-x[0] / parameters[0]); }
void moments(int n, const double *x, int m, double *y) { for (int c = 0; c < m; ++c) y[c] = pow(x[0], c); }
void lines(int n, const double *x, int m, double *y, const double *parameters) {
    for (int c = 0; c < m; ++c) y[c] = parameters[c] * x[0];
}
double minus_half_square(int n, const double *x) { return -5000 - x[0] * x[0] / 2; }
"""
# (value, tolerance, function and options)
VALUES = [
    (1, 1e-3, "--library f.so:moments --components 3 --over x=0:1"),
    (6, 1e-3, "--source f.c:scaled --let length=2 --let height=3*length/2 --over x=0:inf"),
    (2, 1e-3, "--source f.c:lines --components 2 --let a=4 --let b=6 --over x=0:1"),
    (0.5, 1e-3, "--source other.c --over x=0:1"),
    (0.5, 1e-3, "--source f.c:lines --components 1 --let a=1 --over x=0:a"),
    (0.333333, 1e-3, "--source f.c --let b=1 --over x=0:b"),  # a function may ignore its parameters
    # Constants in formulas, ranges and densities; they may redefine pi and e.
    (4.5, 1e-3, "a*x --let a=4 --over x=0:b --let b=a*3/8"),
    (1, 1e-3, "k*exp(-k*x) --let k=5 --over x=0:inf --density x=exp(-k*x)"),
    (3, 1e-3, "e --let e=3 --over x=0:1"),
    (0.15, 1e-9, "s --let s=0.1*3 --domain simplex --over x,y"),
]
MISTAKES = """
    2 --let S=VALUE a constant $ S*x --let s=1 --over x=0:1
    2 no value is given $ x --let s --over x=0:1
    2 is given twice $ x --let s=1 --let s=2 --over x=0:1
    2 's' is a constant of --let $ x --let s=1 --over s=0:1
    2 'sin' is a function $ x --let sin=1 --over x=0:1
    2 there is no variable 't' $ x --let s=t --let t=1 --over x=0:1
    2 is not a number $ x --let s=0/0 --over x=0:1
    2 none is given; expected a FORMULA, --library or --source $ --over x=0:1
    2 more than one is given $ x --source f.c --over x=0:1
    2 more than one is given $ --library f.so --source f.c --over x=0:1
    2 each component of a vector is a FORMULA of its own $ x --components 2 --over x=0:1
    2 log f has one value $ --log --library f.so:moments --components 2 --over x=0:1
    2 expected a whole number from 1 $ --library f.so:moments --components 0 --over x=0:1
    1 no.so: there is no such file $ --library no.so:f --over x=0:1
    1 f.so: has no function 'none' $ --library f.so:none --over x=0:1
    1 is not a shared library that can be loaded $ --library f.c --over x=0:1
    1 is a folder $ --library . --over x=0:1
    1 g.cpp: has no function 'integrand' $ --source g.cpp --over x=0:1
    1 is not a source in C (.c) or C++ $ --source text --over x=0:1
    # A function of another form is not called.
    2 f.c: the function 'moments' is declared as void moments(int n, const double *x, int m, double *y)
      $ --source f.c:moments --over x=0:1
    2 expected double moments(int n, const double *x), or --components M $ --source f.c:moments --over x=0:1
    2 or --let NAME=VALUE for each parameter $ --source f.c:scaled --over x=0:1
    2 or --components M and --let NAME=VALUE $ --source f.c:lines --over x=0:1
    2 or no --components $ --source f.c --components 2 --over x=0:1
    2 'twice' is declared as double twice $ --source g.cpp:twice --components 2 --over x=0:1
    2 'integrand' is declared otherwise; expected double integrand(int n, const double *x)
      $ --source scalar.c --over x=0:1
"""


class CodeTest(ProgramTest):
    """Tests whose temporary files are in a folder of their own."""

    @classmethod
    def prepare(cls):
        skip_unless(has_command("cc") and has_command("c++"), "there is no C or C++ compiler")
        write("f.c", FUNCTIONS)
        subprocess.run("cc -shared -fPIC -o f.so f.c -lm".split(), check=True)
        write("g.cpp", 'extern "C" double twice(int, const double *x) { return FACTOR * x[0]; }\n')
        write("other.c", "double integrand(int n, double *x) { return x[0]; }\n")
        write("scalar.c", "double integrand(double x) { return x; }\n")
        write("text", "integrand: 1\n")
        os.mkdir("temporary")
        before = os.environ.get("TMPDIR")
        os.environ["TMPDIR"] = os.path.abspath("temporary")
        cls.addClassCleanup(os.environ.update, {"TMPDIR": before} if before else {})
        cls.addClassCleanup(os.environ.pop, "TMPDIR")

    def tearDown(self):
        self.assertEqual(os.listdir("temporary"), [], "temporary files are left")

    def interrupted_while_compiling(self, variable, compiler, line):
        """The exit code of a program that gets a signal while its slow compiler works."""
        write("slow-compiler", f'#!/bin/sh\nsleep 1\nexec {compiler} "$@"\n')
        os.chmod("slow-compiler", 0o755)
        job = self.start(line, environment={variable: os.path.abspath("slow-compiler")})
        self.until(lambda: os.listdir("temporary"), "a temporary folder", job=job)
        job.signal(signal.SIGTERM)
        return job.ended().code


class Functions(CodeTest):
    def test_formula_and_function_give_the_same_digits(self):
        """File names with a colon and in a folder, with and without the name of the function."""
        os.mkdir("a b")
        shutil.copy("f.c", "a b/g:h.c")
        options = "--over x1..x3=0:1 --evaluations 1e4 --quiet"
        wanted = self.expect(0, "", f"integrate x1*x1+x2*x2+x3*x3 {options}")
        for place in "f.c", "f.c:integrand", os.path.abspath("f.c"), "a b/g:h.c", "a b/g:h.c:integrand":
            with self.subTest(place):
                self.assertEqual(self.expect(0, "", f"integrate {options} --source", place), wanted)
        for place in "f.so", "./f.so:integrand", os.path.abspath("f.so") + ":integrand":
            with self.subTest(place):
                self.assertEqual(self.expect(0, "", f"integrate {options} --threads 2 --library", place), wanted)

    def test_values(self):
        for exact, tolerance, line in VALUES:
            with self.subTest(line):
                value = self.json(f"integrate --quiet {line}")["value"]
                self.assert_near(value[0] if isinstance(value, list) else value, exact, tolerance)

    def test_components_and_logarithm(self):
        text = self.output("integrate --library f.so:moments --components 3 --over x=0:1")
        self.assertEqual([line.split(":")[0] for line in text.splitlines()[:3]], [f"moments[{k}]" for k in range(3)])
        text = self.output("integrate --log --library f.so:minus_half_square --over x=-inf:inf --evaluations 1e5")
        self.assertRegex(text, r"(?m)^log Z = -4999\.08")

    def test_environment_chooses_compiler_and_options(self):
        for exact, environment in (1, {"CXXFLAGS": "-DFACTOR=2"}), (2, {"CXX": "c++ -DFACTOR=4"}):
            value = self.json("integrate --source g.cpp:twice --over x=0:1", environment=environment)["value"]
            self.assert_near(value, exact, 1e-3)

    def test_checkpoint_belongs_to_the_function(self):
        line = "integrate --over x=0:1 --method vegas --checkpoint state"
        self.output(f"{line} --source f.c --evaluations 2e4")
        self.expect(0, "0.333", f"{line} --source f.c --evaluations 4e4 --resume")
        self.expect(1, "state", f"{line} --source f.c:scaled --let a=1 --let b=2 --evaluations 4e4 --resume")

    def test_mistakes(self):
        os.environ["CXXFLAGS"] = "-DFACTOR=2"
        self.addCleanup(os.environ.pop, "CXXFLAGS")
        self.expect_each(MISTAKES, "integrate ")

    def test_messages_of_the_compiler(self):
        write("bad.c", "double integrand(int n, const double *x) { return x[0] }\n")
        text = self.expect(1, "bad.c: the compiler cc ended with exit code 1", "integrate --source bad.c --over x=0:1")
        self.assertIn("bad.c:1:", text)
        line = "integrate --source f.c --over x=0:1"
        self.expect(1, "no-such-compiler: cannot be started", line, environment={"CC": "no-such-compiler"})
        self.expect(1, "set TMPDIR", line, environment={"TMPDIR": "/no/such"})


class Device(CodeTest):
    """Results on an emulated device equal those of the processor; errors name what is missing."""

    @classmethod
    def prepare(cls):
        super().prepare()
        write("f.c", """#include <math.h>
double integrand(int n, const double *x) { double s = 0; for (int i = 0; i < n; ++i) s += x[i] * x[i]; return exp(-s); }
void powers(int n, const double *x, int m, double *y, const double *parameters) {
    for (int c = 0; c < m; ++c) y[c] = parameters[0] * pow(x[0], c);
}
""")
        edited("f.c", "g.cu", ("(?m)^double", 'extern "C" __device__ double'))

    def same(self, line, **how):
        with self.subTest(line):
            here, there = (self.expect(0, "", f"integrate {line} --quiet{device}", **how)
                           for device in ("", " --device emulated"))  # fmt: skip
            self.assertEqual(here, there)

    def test_formulas(self):
        for method in "basic", "quasi", "vegas", "vegas_sobol", "adaptive":
            self.same(f"exp(-x^2)*cos(y) --over x=0:inf --over y=0:pi/2 --method {method} --evaluations 50k --seed 3")
        self.same("1 a*x^2 --let a=3 --over x=-1:2 --method vegas --evaluations 20k")
        self.same("--log -5000-x^2/2 --over x=-inf:inf --method quasi --evaluations 20k")
        self.same("'1/(x-0.5)*0 + (x < 0.1 ? sqrt(0-1) : y)' --over x,y=0:1 --method basic --evaluations 20k")

    def test_flags_of_the_user_do_not_change_the_arithmetic(self):
        """-ffast-math would break infinite ranges."""
        self.same("exp(-x^2)*cos(y) --over x=0:inf --over y=0:pi/2 --method vegas --evaluations 20k",
                  environment={"CXXFLAGS": "-ffast-math"})  # fmt: skip

    def test_sources(self):
        options = "--over x1..x5=0:1 --method vegas --evaluations 50k"
        self.same(f"--source f.c {options}")
        self.same("--source f.c:powers --components 3 --let a=2 --over x=0:1 --method quasi --evaluations 20k")
        here = self.expect(0, "", f"integrate --source f.c {options} --quiet")
        self.assertEqual(self.expect(0, "", f"integrate --source g.cu {options} --quiet --device emulated"), here)

    def test_json_names_the_device(self):
        result = self.json("integrate x --over x=0:1 --method basic --device emulated")
        self.assertEqual(result["device"], "emulation by one thread of the processor")

    def test_checkpoint_is_resumed(self):
        line = "integrate x*x --over x=0:1 --method vegas --checkpoint state --device emulated"
        self.output(f"{line} --evaluations 2e4")
        self.assertIn("0.333", self.output(f"{line} --evaluations 4e4 --resume"))

    def test_signal_waits_for_the_compiler_and_leaves_no_file(self):
        line = "integrate x --over x=0:1 --method basic --device emulated"
        self.assertNotEqual(self.interrupted_while_compiling("CXX", "c++", line), 0)

    def test_mistakes(self):
        write("bad.cu", "double integrand(int n, const double *x) { return y; }\n")
        self.expect_each("""
            2 there is no device 'gpu'; expected one of cuda, emulated $ x --over x=0:1 --method basic --device gpu
            2 the method 'auto' does not run on a device, and is the default; expected adaptive, vegas,\
 vegas_sobol, quasi or basic $ x --over x=0:1 --device emulated
            2 the method 'metropolis' does not run on a device; expected adaptive, vegas, vegas_sobol, quasi or basic
              $ x --over x=0:1 --method metropolis --device emulated
            2 there is no function 'sqt' $ sqt(x) --over x=0:1 --method basic --device emulated
            2 a device compiles sources and does not call libraries
              $ --library f.so --over x=0:1 --method basic --device emulated
            2 the points of a device stay there $ x --over x=0:1 --method basic --device emulated --points p.csv
            1 points of a ball in 2 dimensions are not drawn on a device
              $ x --over x,y --domain ball --method basic --device emulated
            1 by density are not drawn on a device $ x --over x=0:1 --density x=exp(-x) --method basic --device emulated
            1 g.cu: is a CUDA source, for $ --source g.cu --over x=0:1
            2 'g.cu' is a CUDA source, which
              $ --source g.cu --over x=0:1 --method vegas --device emulated --save-density d.density
            1 no.cu: there is no such file $ --source no.cu --over x=0:1 --method basic --device emulated
            1 bad.cu:1 $ --source bad.cu --over x=0:1 --method basic --device emulated
        """, "integrate ")
        self.assert_absent("d.density", "p.csv")

    def test_driver_that_is_missing(self):
        with contextlib.suppress(OSError):
            ctypes.CDLL("libcuda.so.1")
            self.skipTest("there is a CUDA driver")
        self.expect(1, "device 'cuda': there is no NVIDIA driver",
                    "integrate x --over x=0:1 --method basic --device cuda")  # fmt: skip
