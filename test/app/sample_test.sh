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
