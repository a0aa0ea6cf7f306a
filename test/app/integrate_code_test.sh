#!/bin/sh
# montelux integrate with functions in C and C++, from sources and libraries, and with constants.
. "$(dirname "$0")/common.sh"
command -v cc >/dev/null || { echo "SKIPPED: no C compiler"; exit 77; }

# value EXACT TOLERANCE arguments...: the first value of a run.
value() {
    exact=$1 tolerance=$2
    shift 2
    "$montelux" integrate "$@" --json --quiet >json 2>err || fail "montelux integrate $*: exit code $?: $(cat err)"
    tr -d ' \n' <json | sed 's/.*"value":\[*\([^],]*\).*/\1/' |
        awk -v b="$exact" -v t="$tolerance" '{ d = $1 - b; exit !(d * d <= t * t) }' ||
        fail "montelux integrate $*: $(head -n 8 json) instead of $exact"
}

cat >f.c <<'C'
#include <math.h>
double integrand(int n, const double *x) { double s = 0; for (int i = 0; i < n; ++i) s += x[i] * x[i]; return s; }
double scaled(int n, const double *x, const double *parameters) { return parameters[1] * exp(-x[0] / parameters[0]); }
void moments(int n, const double *x, int m, double *y) { for (int c = 0; c < m; ++c) y[c] = pow(x[0], c); }
void lines(int n, const double *x, int m, double *y, const double *parameters) {
    for (int c = 0; c < m; ++c) y[c] = parameters[c] * x[0];
}
double minus_half_square(int n, const double *x) { return -5000 - x[0] * x[0] / 2; }
C
# Formulas and the function give the same digits; a name with a colon, one in a folder, and the function named or not.
mkdir 'a b' && cp f.c 'a b/g:h.c'
"$montelux" integrate 'x1*x1+x2*x2+x3*x3' --over x1..x3=0:1 --evaluations 1e4 --quiet >formula
for place in f.c f.c:integrand "$folder/f.c" 'a b/g:h.c' 'a b/g:h.c:integrand'; do
    "$montelux" integrate --source "$place" --over x1..x3=0:1 --evaluations 1e4 --quiet >out 2>&1
    cmp -s formula out || fail "--source $place: $(cat out) instead of $(cat formula)"
done
cc -shared -fPIC -o f.so f.c -lm
for place in f.so ./f.so:integrand "$folder/f.so:integrand"; do
    "$montelux" integrate --library "$place" --over x1..x3=0:1 --evaluations 1e4 --threads 2 --quiet >out 2>&1
    cmp -s formula out || fail "--library $place: $(cat out)"
done
value 1 1e-3 --library f.so:moments --components 3 --over x=0:1
"$montelux" integrate --library f.so:moments --components 3 --over x=0:1 >out 2>/dev/null
[ "$(cut -d: -f1 out | head -n 3 | tr '\n' ' ')" = "moments[0] moments[1] moments[2] " ] || fail "names: $(cat out)"
value 6 1e-3 --source f.c:scaled --let length=2 --let height=3*length/2 --over x=0:inf
value 2 1e-3 --source f.c:lines --components 2 --let a=4 --let b=6 --over x=0:1
"$montelux" integrate --log --library f.so:minus_half_square --over x=-inf:inf --evaluations 1e5 >out 2>&1
grep -q '^log Z = -4999.08' out || fail "--log: $(cat out)"
# C++, the compiler and its options by the environment.
printf 'extern "C" double twice(int, const double *x) { return FACTOR * x[0]; }\n' >g.cpp
export CXXFLAGS=-DFACTOR=2
value 1 1e-3 --source g.cpp:twice --over x=0:1
unset CXXFLAGS
export CXX='c++ -DFACTOR=4'
value 2 1e-3 --source g.cpp:twice --over x=0:1
# A checkpoint of the function continues; another function's is refused.
"$montelux" integrate --source f.c --over x=0:1 --method vegas --evaluations 2e4 --checkpoint state >/dev/null 2>&1
expect 0 "0.333" integrate --source f.c --over x=0:1 --method vegas --evaluations 4e4 --checkpoint state --resume
expect 1 "state" integrate --source f.c:scaled --let a=1 --let b=2 --over x=0:1 --method vegas --evaluations 4e4 --checkpoint state --resume
ls -d "${TMPDIR:-/tmp}"/montelux-?????? 2>/dev/null | while read -r left; do
    [ "$left" -nt f.c ] && fail "a folder was left: $left"
done

# Constants in formulas, ranges and densities; pi and e give way to them.
value 4.5 1e-3 'a*x' --let a=4 --over x=0:b --let b=a*3/8
value 1 1e-3 'k*exp(-k*x)' --let k=5 --over x=0:inf --density 'x=exp(-k*x)'
value 3 1e-3 'e' --let e=3 --over x=0:1
value 0.15 1e-9 s --let s=0.1*3 --domain simplex --over x,y
expect 2 "--let S=VALUE a constant" integrate 'S*x' --let s=1 --over x=0:1
expect 2 "no value is given" integrate x --let s --over x=0:1
expect 2 "is given twice" integrate x --let s=1 --let s=2 --over x=0:1
expect 2 "'s' is a constant of --let" integrate x --let s=1 --over s=0:1
expect 2 "'sin' is a function" integrate x --let sin=1 --over x=0:1
expect 2 "there is no variable 't'" integrate x --let s=t --let t=1 --over x=0:1
expect 2 "is not a number" integrate x --let s=0/0 --over x=0:1

# Mistakes.
expect 2 "none is given; expected a FORMULA, --library or --source" integrate --over x=0:1
expect 2 "more than one is given" integrate x --source f.c --over x=0:1
expect 2 "more than one is given" integrate --library f.so --source f.c --over x=0:1
expect 2 "each component of a vector is a FORMULA of its own" integrate x --components 2 --over x=0:1
expect 2 "log f has one value" integrate --log --library f.so:moments --components 2 --over x=0:1
expect 2 "expected a whole number from 1" integrate --library f.so:moments --components 0 --over x=0:1
expect 1 "no.so: there is no such file" integrate --library no.so:f --over x=0:1
expect 1 "f.so: has no function 'none'" integrate --library f.so:none --over x=0:1
expect 1 "is not a shared library that can be loaded" integrate --library f.c --over x=0:1
expect 1 "is a folder" integrate --library . --over x=0:1
expect 1 "g.cpp: has no function 'integrand'" integrate --source g.cpp --over x=0:1
printf 'double integrand(int n, const double *x) { return x[0] }\n' >bad.c
expect 1 "bad.c: the compiler cc ended with exit code 1" integrate --source bad.c --over x=0:1
grep -q "bad.c:1:" out || fail "the compiler's message is missing: $(cat out)"
# A function of another form is not called.
expect 2 "f.c: the function 'moments' is declared as void moments(int n, const double *x, int m, double *y)" \
    integrate --source f.c:moments --over x=0:1
expect 2 "expected double moments(int n, const double *x), or --components M" integrate --source f.c:moments --over x=0:1
expect 2 "or --let NAME=VALUE for each parameter" integrate --source f.c:scaled --over x=0:1
expect 2 "or --components M and --let NAME=VALUE" integrate --source f.c:lines --over x=0:1
expect 2 "or no --components" integrate --source f.c --components 2 --over x=0:1
expect 2 "'twice' is declared as double twice" integrate --source g.cpp:twice --components 2 --over x=0:1
printf 'double integrand(double x) { return x; }\n' >h.c
expect 2 "'integrand' is declared otherwise; expected double integrand(int n, const double *x)" \
    integrate --source h.c --over x=0:1
printf 'double integrand(int n, double *x) { return x[0]; }\n' >h.c
value 0.5 1e-3 --source h.c --over x=0:1
value 0.5 1e-3 --source f.c:lines --components 1 --let a=1 --over x=0:a
value 0.333333 1e-3 --source f.c --let b=1 --over x=0:b # a function may ignore its parameters
expect 1 "is not a source in C (.c) or C++" integrate --source formula --over x=0:1
export CC=no-such-compiler
expect 1 "no-such-compiler: cannot be started" integrate --source f.c --over x=0:1
unset CC
export TMPDIR=/no/such
expect 1 "set TMPDIR" integrate --source f.c --over x=0:1
finish
