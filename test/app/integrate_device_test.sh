#!/bin/sh
# montelux integrate on a device: its emulation gives the processor's digits, and what is missing is said.
. "$(dirname "$0")/common.sh"
command -v c++ >/dev/null || { echo "SKIPPED: no C++ compiler"; exit 77; }

# same arguments...: the same report on the processor and on the emulated device.
same() {
    "$montelux" integrate "$@" --quiet >here 2>&1 || fail "montelux integrate $*: $(cat here)"
    "$montelux" integrate "$@" --quiet --device emulated >there 2>&1 || fail "$* --device emulated: $(cat there)"
    cmp -s here there || fail "$*: $(cat there) on the emulated device instead of $(cat here)"
}
for method in basic quasi vegas vegas_sobol adaptive; do
    same 'exp(-x^2)*cos(y)' --over x=0:inf --over y=0:pi/2 --method $method --evaluations 50k --seed 3
done
same 1 'a*x^2' --let a=3 --over x=-1:2 --method vegas --evaluations 20k
same --log '-5000-x^2/2' --over x=-inf:inf --method quasi --evaluations 20k
same '1/(x-0.5)*0 + (x < 0.1 ? sqrt(0-1) : y)' --over x,y=0:1 --method basic --evaluations 20k

cat >f.c <<'C'
#include <math.h>
double integrand(int n, const double *x) { double s = 0; for (int i = 0; i < n; ++i) s += x[i] * x[i]; return exp(-s); }
void powers(int n, const double *x, int m, double *y, const double *parameters) {
    for (int c = 0; c < m; ++c) y[c] = parameters[0] * pow(x[0], c);
}
C
same --source f.c --over x1..x5=0:1 --method vegas --evaluations 50k
same --source f.c:powers --components 3 --let a=2 --over x=0:1 --method quasi --evaluations 20k
sed 's/^double/extern "C" __device__ double/' f.c >g.cu
"$montelux" integrate --source g.cu --over x1..x5=0:1 --method vegas --evaluations 50k --quiet --device emulated >out 2>&1
"$montelux" integrate --source f.c --over x1..x5=0:1 --method vegas --evaluations 50k --quiet >here 2>&1
cmp -s out here || fail "g.cu: $(cat out) instead of $(cat here)"
"$montelux" integrate x --over x=0:1 --method basic --device emulated --json >json 2>/dev/null
grep -q '"device": "emulation by one thread of the processor"' json || fail "--json: no device: $(cat json)"
# A checkpoint continues to the same digits.
"$montelux" integrate x*x --over x=0:1 --method vegas --evaluations 2e4 --checkpoint state --device emulated >/dev/null 2>&1
"$montelux" integrate x*x --over x=0:1 --method vegas --evaluations 4e4 --checkpoint state --resume --device emulated >out 2>/dev/null
grep -q 0.333 out || fail "--resume: $(cat out)"
# The user's flags do not change the arithmetic: -ffast-math knows no infinite ranges.
CXXFLAGS=-ffast-math
export CXXFLAGS
same 'exp(-x^2)*cos(y)' --over x=0:inf --over y=0:pi/2 --method vegas --evaluations 20k
unset CXXFLAGS
# A signal waits for the compiler, and its temporary files are removed.
mkdir tmp
printf '#!/bin/sh\nsleep 1\nexec c++ "$@"\n' >slow-c++
chmod +x slow-c++
TMPDIR=$PWD/tmp CXX=$PWD/slow-c++ "$montelux" integrate x --over x=0:1 --method basic --device emulated >/dev/null 2>&1 &
job=$!
for _ in 1 2 3 4 5 6 7 8 9 10; do [ -n "$(ls tmp)" ] && break; sleep 0.2; done
kill -TERM $job
wait $job && fail "SIGTERM while the emulation compiles: exit code 0"
[ -n "$(ls tmp)" ] && fail "SIGTERM while the emulation compiles left $(ls tmp)"

# Mistakes.
expect 2 "there is no device 'gpu'; expected one of cuda, emulated" integrate x --over x=0:1 --method basic --device gpu
expect 2 "the method 'auto' does not run on a device, and is the default; expected adaptive, vegas, vegas_sobol, quasi or basic" integrate x --over x=0:1 --device emulated
expect 2 "the method 'metropolis' does not run on a device; expected adaptive, vegas, vegas_sobol, quasi or basic" integrate x --over x=0:1 --method metropolis --device emulated
expect 2 "there is no function 'sqt'" integrate 'sqt(x)' --over x=0:1 --method basic --device emulated
expect 2 "a device compiles sources and does not call libraries" integrate --library f.so --over x=0:1 --method basic --device emulated
expect 2 "the points of a device stay there" integrate x --over x=0:1 --method basic --device emulated --points p.csv
expect 1 "points of a ball in 2 dimensions are not drawn on a device" integrate x --over x,y --domain ball --method basic --device emulated
expect 1 "by density are not drawn on a device" integrate x --over x=0:1 --density 'x=exp(-x)' --method basic --device emulated
expect 1 "g.cu: is a CUDA source, for" integrate --source g.cu --over x=0:1
expect 2 "'g.cu' is a CUDA source, which" integrate --source g.cu --over x=0:1 --method vegas --device emulated --save-density d.density
[ -e d.density ] && fail "--save-density with a CUDA source left a file"
expect 1 "no.cu: there is no such file" integrate --source no.cu --over x=0:1 --method basic --device emulated
printf 'double integrand(int n, const double *x) { return y; }\n' >bad.cu
expect 1 "bad.cu:1" integrate --source bad.cu --over x=0:1 --method basic --device emulated
[ -e p.csv ] && fail "--points left a file"
# Where there is no driver.
if ! ldconfig -p 2>/dev/null | grep -q libcuda.so.1; then
    expect 1 "device 'cuda': there is no NVIDIA driver" integrate x --over x=0:1 --method basic --device cuda
fi
finish
