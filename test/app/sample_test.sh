#!/bin/sh
# montelux sample: points of sets and samples of densities, in every format.
. "$(dirname "$0")/common.sh"

"$montelux" sample --set sobol --n 4 --dim 2 >out || fail "sobol: exit code $?"
printf 'u1,u2\n0,0\n0.5,0.5\n0.25,0.75\n0.75,0.25\n' | cmp -s - out || fail "the first Sobol' points: $(cat out)"
for set in $("$montelux" sample --help | sed -n 's/.*Which points of \[0, 1)^d: //p' | tr -d ,) halton hammersley; do
    "$montelux" sample --set "$set" --n 512 --dim 3 --seed 5 --randomisation shift >out 2>&1 || fail "$set: $(cat out)"
    awk -F, 'NR > 1 { for (i = 1; i <= 3; ++i) { s[i] += $i; if ($i < 0 || $i >= 1) exit 1 } }
        END { for (i = 1; i <= 3; ++i) if (s[i] / 512 < 0.4 || s[i] / 512 > 0.6) exit 1; exit NR != 513 }' out ||
        fail "$set: points are not spread over the cube"
done
"$montelux" sample --set sobol --n 64 --randomisation scramble --seed 1 >one
"$montelux" sample --set sobol --n 64 --randomisation scramble --seed 2 >two
cmp -s one two && fail "the seed changes nothing"
# An exponential variable of rate 5 has mean 0.2.
"$montelux" sample --density 'exp(-5*x)' --over x=0:inf --n 20000 >out || fail "density: exit code $?"
awk 'NR == 1 { named = $1 == "x" } NR > 1 { s += $1; q += $1 * $1; if ($1 < 0) bad = 1 }
    END { m = s / 20000; exit bad || !named || m < 0.19 || m > 0.21 || q / 20000 < 0.07 || q / 20000 > 0.09 }' out ||
    fail "samples of the exponential density"
# Through quasi-random numbers, the error of the mean is far smaller; a variable without a density is uniform.
"$montelux" sample --density x='exp(-5*x)' --over x=0:inf --over y=2:4 --set sobol --randomisation scramble --n 4096 >out
awk -F, 'NR > 1 { s += $1; t += $2 } END { m = s / 4096 - 0.2; n = t / 4096 - 3
    exit m > 0.001 || m < -0.001 || n > 0.001 || n < -0.001 }' out || fail "quasi-random samples of two variables"
for format in csv npy bin; do
    "$montelux" sample --set weyl --n 100 --dim 3 -o points.$format || fail "$format: exit code $?"
done
[ "$(wc -c <points.bin)" -eq 2400 ] || fail "bin: $(wc -c <points.bin) bytes"
tail -c 2400 points.npy | cmp -s - points.bin || fail "npy and bin hold other numbers"
[ $((($(wc -c <points.npy) - 2400) % 64)) -eq 0 ] || fail "npy: the header is not aligned"
head -c 128 points.npy | grep -aq "'shape': (100, 3)" || fail "npy: the header has no shape"
if command -v python3 >/dev/null; then
    python3 - <<'END' || fail "csv and bin hold other numbers"
import struct
rows = [list(map(float, l.split(","))) for l in open("points.csv").read().split()[1:]]
assert [x for r in rows for x in r] == list(struct.unpack("<300d", open("points.bin", "rb").read()))
END
fi
# Adaptive trains nothing where uniform points suffice, and says so.
"$montelux" integrate 1+x --over x=0:1 --method adaptive --relative-error 0.01 --save-density flat.mx >out 2>err ||
    fail "flat: exit code $?"
grep -q "the density in 'flat.mx' is uniform" err || fail "uniform density: $(cat out err)"
# A trained density: weighted samples, whose weights add up to the integral 1/2; unweighted ones of density 2x.
"$montelux" integrate 'x*exp(-50*(x-y)^2)' --over x=0:1 --over y=-1:2 --method adaptive --evaluations 50k \
    --save-density trained.mx --quiet >out || fail "save-density: exit code $?"
"$montelux" sample --from trained.mx --n 20000 >out 2>err || fail "from: exit code $?: $(cat err)"
awk -F, 'NR == 1 { named = $0 == "x,y,weight" } NR > 1 { s += $3 } END { exit !named || s < 0.122 || s > 0.128 }' out ||
    fail "weights of a trained density: $(head -n 2 out)"
"$montelux" sample --from trained.mx --unweighted --n 20000 -o out.csv 2>err || fail "unweighted: exit code $?"
grep -q "20000 unweighted samples, efficiency 0\.[4-9]" err || fail "unweighted: $(cat err)"
awk -F, 'NR > 1 { s += $1 * $3; w += $3 } END { exit s / w < 0.657 || s / w > 0.677 || NR != 20001 }' out.csv ||
    fail "unweighted samples do not follow the integrand"
"$montelux" sample --from trained.mx --unweighted --n 20000 --threads 1 --quiet -o one.csv || fail "one thread"
cmp -s out.csv one.csv || fail "threads change the samples"
"$montelux" sample --from trained.mx --histogram x=0:1:2 --covariance --n 50000 >out 2>err || fail "histogram: $(cat err)"
awk -F, 'NR == 1 { named = $0 == "lower,upper,value,standard_error,covariance_1,covariance_2" } NR > 1 { v[NR] = $3 }
    END { exit !named || v[2] / (v[2] + v[3]) < 0.24 || v[2] / (v[2] + v[3]) > 0.26 }' out || fail "histogram: $(cat out)"
"$montelux" integrate --log -5000-x^2/2 --over x=-inf:inf --method vegas --evaluations 20k --save-density log.mx --quiet >out
"$montelux" sample --from log.mx --unweighted --n 5000 >out 2>err || fail "logarithm: $(cat err)"
grep -q "log Z = -4999\.08" err || fail "logarithm: $(cat err)"
"$montelux" integrate 1+x --domain ball --over x,y --method vegas --evaluations 20k --save-density ball.mx --quiet >out
"$montelux" sample --from ball.mx --n 2000 2>err | awk -F, 'NR > 1 { s += $3; if ($1 * $1 + $2 * $2 > 1) exit 1 }
    END { exit s < 3.1 || s > 3.2 }' || fail "ball: $(cat err)"
"$montelux" sample --from trained.mx --n 100 --max-draws 5 >out 2>err
[ $? -eq 3 ] && grep -q "only 5 of 100 samples were found in 5 draws" err || fail "max-draws: $(cat err)"
# Chains.
"$montelux" sample -x^2-y^2+x*y --log --over x,y=-inf:inf --n 5000 -o chains.npy 2>err || fail "chains: $(cat err)"
[ $(($(wc -c <chains.npy) % 32)) -eq 0 ] && grep -q "x: mean .*R-hat 1\.00.*effective samples" err || fail "chains: $(cat err)"
for sampler in ensemble slice; do
    "$montelux" sample -x^2-y^2+x*y --log --over x,y=-inf:inf --n 2000 --sampler $sampler --threads 1 >one 2>err ||
        fail "$sampler: $(cat err)"
    grep -q "4 ensembles of 8 walkers, 2000 draws each" err || fail "$sampler: $(cat err)"
    "$montelux" sample -x^2-y^2+x*y --log --over x,y=-inf:inf --n 2000 --sampler $sampler --quiet 2>err | cmp -s - one ||
        fail "$sampler: threads change the draws"
    # Variance 2/3.
    awk -F, 'NR > 1 { s += $3; q += $3 * $3 } END { n = NR - 1; v = q / n - s * s / n / n
        exit n != 64000 || v < 0.63 || v > 0.70 }' one || fail "$sampler: $(head -n 3 one)"
done
"$montelux" sample -x --log --over x=0:1 --n 1000 --sampler slice --chains 2 --walkers 5 --start 0.5 --quiet >out || fail "start"
[ "$(wc -l <out)" -eq 10001 ] || fail "walkers: $(wc -l <out) lines"
"$montelux" sample 'log(exp(-(x-20)^2)+exp(-(x+20)^2))' --log --over x=-30:30 --start=-20 --start 20 --start=-20 --start 20 \
    >out 2>err
grep -q "warning: the chains disagree: R-hat of 'x'" err || fail "chains that disagree: $(cat err)"
# What is reported is of the draws that are written: thinned ones are nearly independent.
"$montelux" sample -x^2/2 --log --over x=-inf:inf --n 1000 --thin 50 2>err >out
awk '/effective samples/ { sub(".*effective samples ", ""); if ($1 < 3000 || $1 > 5000) exit 1 }' err ||
    fail "thinned draws: $(cat err)"
expect 2 "'slce' is not known (did you mean 'slice'?)" sample -x --log --over x=0:1 --sampler slce
expect 2 "3 are too few for 2 variables; expected at least 4" sample -x --log --over x,y=0:1 --sampler slice --walkers 3
expect 2 "chains of metropolis have none" sample -x --log --over x=0:1 --walkers 8
expect 2 "expected --log with it" sample --set sobol --sampler slice
expect 2 "3 starts were given for 4 chains" sample -x --log --over x=0:1 --start 0.1 --start 0.2 --start 0.3
# netCDF, if its library is installed.
expect 2 "such files hold chains" sample --set sobol --format netcdf
expect 2 "such files hold chains" sample --set sobol -o points.nc
expect 2 "has the name of a column" sample -draw --log --over draw=0:1 -o chains.nc
expect 2 "has the name of a column" sample -chain --log --over chain=0:1
expect 2 "1000000000 chains or walkers in all are too many for 1 variable; expected at most 536870912" \
    sample -x --log --over x=0:1 --sampler slice --walkers 100000 --chains 10000
expect 1 "lie in a subspace" sample -x^2-y^2 --log --over x,y=-1:1 --sampler slice --chains 1 --walkers 4 \
    --start 0,0.1 --start 0,0.2 --start 0,0.3 --start 0,0.4
"$montelux" sample '0-(x*1e9)^2' --log --over x=-1:1 --start 0 --burn-in 0 --n 200 2>err >out
grep -q "the draws of 'x' are all equal: no chain moved" err || fail "chains at rest: $(cat err)"
MONTELUX_NETCDF_LIBRARY=/no/such/library.so "$montelux" sample -x --log --over x=0:1 -o chains.nc >out 2>err &&
    fail "netCDF without its library"
grep -q "netCDF cannot be loaded from '/no/such/library.so'" err || fail "netCDF: $(cat err)"
if "$montelux" sample -x^2-y^2 --log --over x,y=-inf:inf --n 500 --sampler slice --quiet -o chains.nc 2>err; then
    head -c 4 chains.nc | tail -c 3 | grep -q HDF || fail "netCDF: $(head -c 8 chains.nc | od -c)"
    "$montelux" sample -x^2-y^2 --log --over x,y=-inf:inf --n 500 --sampler slice --quiet --format netcdf >piped.nc
    cmp -s chains.nc piped.nc || fail "netCDF: standard output differs from a file"
    "$montelux" sample -x^2-y^2 --log --over x,y=-inf:inf --n 500 --sampler slice --quiet -o chains.csv
    read_back=0
    python3 - 2>err <<'END' || read_back=$?
import sys
try:
    import h5py
except ImportError:
    sys.exit(77)
rows = [list(map(float, line.split(","))) for line in open("chains.csv").read().split()[1:]]
with h5py.File("chains.nc") as file:
    group = file["posterior"]
    assert list(group["chain"]) == list(range(32)) and list(group["draw"]) == list(range(500))
    assert group["x"].dims[0][0].name == "/posterior/chain" and group["x"].dims[1][0].name == "/posterior/draw"
    for k, name in enumerate("xy"):
        assert group[name].shape == (32, 500)
        assert [float(v) for chain in group[name] for v in chain] == [row[2 + k] for row in rows]
END
    case $read_back in
    0) ;;
    77) echo "note: netCDF files were not read back, which needs h5py" ;;
    *) fail "netCDF read back: $(cat err)" ;;
    esac
else
    grep -q "libnetcdf was not found" err || fail "netCDF: $(cat err)"
    echo "note: netCDF files were not written, which needs libnetcdf"
fi
"$montelux" sample -x --log --over x=0:inf --n 20000 --chains 2 --quiet --thin 5 >out || fail "chains: exit code $?"
awk -F, 'NR > 1 { s += $3; if ($3 < 0) exit 1 } END { exit NR != 40001 || s / 40000 < 0.95 || s / 40000 > 1.05 }' out ||
    fail "chains do not follow exp(-x)"
# Constants, which the file of a density keeps, as it does the place of a source in C.
"$montelux" sample --density 'exp(-k*x)' --let k=5 --over x=0:inf --n 3 >out
"$montelux" sample --density 'exp(-5*x)' --over x=0:inf --n 3 | cmp -s - out || fail "--let with --density"
"$montelux" sample --log --let k=5 -k*x --over x=0:inf --n 100 --quiet >out
"$montelux" sample --log -5*x --over x=0:inf --n 100 --quiet | cmp -s - out || fail "--let with --log"
expect 2 "expected --over with it" sample --set sobol --let k=5
expect 2 "leave it out with --from" sample --from trained.mx --let k=5
printf 'double integrand(int n, const double *x, const double *p) { return p[0] * x[0] * x[n - 1]; }\n' >f.c
if command -v cc >/dev/null; then
    "$montelux" integrate --source f.c --let k=4 --over x=0:1 --over y=0:k/4 --method vegas --save-density c.mx --quiet >out
    "$montelux" sample --from c.mx --histogram 'k*x=0:k:2' --n 20000 >out 2>err || fail "source in a density: $(cat err)"
    awk -F, 'NR > 1 { v[NR] = $3 } END { exit v[2] < 0.24 || v[2] > 0.26 || v[3] < 0.74 || v[3] > 0.76 }' out ||
        fail "histogram with constants: $(cat out)"
    mkdir -p elsewhere && (cd elsewhere && "$montelux" sample --from ../c.mx --n 5 >/dev/null 2>&1) || fail "another folder"
    "$montelux" sample --from c.mx --n 5 2>&1 >/dev/null | grep -q "has changed" && fail "a source that is as it was"
    sed 's/p\[0\]/2 * p[0]/' f.c >twice.c && cp f.c first.c && cp twice.c f.c
    "$montelux" sample --from c.mx --n 5 2>&1 >/dev/null | grep -q "f.c' has changed since the density was trained" ||
        fail "a source that has changed"
    cp first.c f.c
    # Ctrl-C while the compiler runs leaves no temporary folder.
    mkdir -p temporary
    printf '#!/bin/sh\ntouch started\nsleep 1\nexec cc "$@"\n' >slow-cc && chmod +x slow-cc
    rm -f started
    TMPDIR=$PWD/temporary CC=./slow-cc "$montelux" integrate --source f.c --let k=4 --over x=0:1 >out 2>&1 &
    job=$!
    while [ ! -e started ]; do sleep 0.05; done
    [ -n "$(ls temporary)" ] || fail "the compiler's folder is elsewhere"
    kill -TERM $job
    wait $job
    [ $? -eq 130 ] || fail "a signal while compiling: exit code $?"
    [ -z "$(ls temporary)" ] || fail "a signal while compiling leaves $(ls temporary)"
    cp f.c kept.c
    expect 2 "f.c" integrate --source f.c --let k=4 --over x=0:1 --method vegas --save-density f.c
    cmp -s f.c kept.c || fail "a density replaced its source"
    rm f.c
    expect 1 "f.c: there is no such file" sample --from c.mx
fi
head -c 300 trained.mx >cut.mx
expect 1 "cut.mx" sample --from cut.mx
expect 1 "none.mx" sample --from none.mx
expect 1 "trains no density" integrate x --over x=0:1 --save-density cubature.mx
expect 2 "'basic' trains no density" integrate x --over x=0:1 --method basic --evaluations 1e15 --save-density basic.mx
expect 2 "leave it out with --histogram" sample --from trained.mx --histogram x=0:1:2 --max-draws 5
cp trained.mx kept.mx
expect 2 "kept.mx" sample --from kept.mx -o kept.mx
"$montelux" sample --from trained.mx --histogram 'sqrt(x-0.5)=0:1:2' --n 1000 >out 2>err
grep -q "have an observable that is not finite" err || fail "observables that are no numbers: $(cat err)"
expect 2 "--set: leave it out with --from" sample --from trained.mx --set sobol
expect 2 "expected --from FILE" sample --unweighted
expect 2 "expected --unweighted" sample --from trained.mx --pilot 100
expect 2 "expected OBSERVABLE=LOWER:UPPER:BINS" sample --from trained.mx --histogram x
expect 2 "there is no variable 'q'" sample --from trained.mx --histogram q=0:1:3
expect 2 "expected --log with a formula" sample -x --over x=0:1
expect 1 "the density is zero at all of 1000 points" sample 'log(0)' --log --over x=0:1
expect 2 "2 numbers were given for 1 variables" sample -x --log --over x=0:1 --start 1,2
expect 1 "/no/such/folder/p.csv" sample --from trained.mx -o /no/such/folder/p.csv
expect 2 "expected --set NAME, or --density" sample
expect 2 "'sobl' is not known (did you mean 'sobol'?)" sample --set sobl
expect 2 "'scrambel' is not known (did you mean 'scramble'?)" sample --set sobol --randomisation scrambel
expect 2 "randomisation 'scramble' of weyl" sample --set weyl --randomisation scramble
expect 2 "expected 1 to 1024" sample --set sobol --dim 2000
expect 2 "expected a whole number" sample --set sobol --dim 0
expect 2 "expected a whole number" sample --set sobol --n 0
expect 2 "'xml' is not known" sample --set sobol --format xml
expect 2 "has the dimensions of its variables" sample --density 'exp(-x)' --over x=0:inf --dim 3
expect 2 "is infinite and has no uniform density" sample --over x=0:inf
expect 2 "no variable is given" sample --density 'exp(-x)'
expect 1 "/no/such/folder/p.csv" sample --set sobol -o /no/such/folder/p.csv
expect 1 "--density 'x-1'" sample --density 'x-1' --over x=0:2
if "$montelux" sample --set sobol --n 100000 >/dev/full 2>err; then fail "a full disk went unnoticed"; fi
finish
