#!/bin/sh
# Slices join to the whole; slices that do not fit are refused with a message.
. "$(dirname "$0")/common.sh"
scene ball "$sky Material \"diffuse\" Shape \"sphere\"" 16 12
for sampler in independent sobol; do
    expect 0 "" render ball.pbrt --spp 48 --sampler $sampler -o whole.exr
    for k in 1 2 3; do
        expect 0 "samples per pixel" render ball.pbrt --spp 48 --sampler $sampler --slice $k/3 -o part$k.exr
    done
    expect 0 "of 3 slices, 48 samples per pixel" merge part2.exr part1.exr part3.exr -o joined.exr -o joined.png
    "$montelux" compare joined.exr whole.exr --json >comparison
    awk -F '[:,]' '/"rmse"/ { found = 1; far = $2 + 0 >= 1e-6 } END { exit !found || far }' comparison ||
        fail "$sampler: the joined slices differ from the whole: $(cat comparison)"
done
# Fireflies are found from the replicates of all slices, also where each slice has a single one.
scene lamp "$sky Material \"diffuse\" Shape \"sphere\" AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [500 500 500]
    Translate 1.1 0.6 0 Shape \"sphere\" \"float radius\" 0.008 AttributeEnd" 16 12
# Least, mean and largest value of two layers.
roughness() {
    "$montelux" info "$1" | awk '$1 == "outlier" || $1 == "warning" { print $1, $2, $3, $4 }'
}
expect 0 "192 pixels have too few samples to check their error bars" render lamp.pbrt --spp 255 --sampler halton -o few.exr
expect 0 "are fireflies" render lamp.pbrt --spp 256 --sampler halton -o whole.exr
roughness whole.exr >expected
for n in 3 16; do
    rm -f lamp-*.exr
    for k in $(seq $n); do
        expect 0 "" render lamp.pbrt --spp 256 --sampler halton --slice $k/$n -o lamp-$k.exr
    done
    expect 0 "of $n slices" merge lamp-*.exr -o joined.exr
    grep -q "are fireflies" out || fail "$n slices: no firefly is reported: $(cat out)"
    roughness joined.exr | paste -d ' ' - expected | awk '{ for (i = 2; i <= 4; i++) {
            far = $i - $(i + 4); if (far < 0) far = -far; if (far > 1e-4) bad = 1 } seen++ }
        END { exit bad || seen != 2 }' ||
        fail "$n slices: outlier and warning differ: $(roughness joined.exr) instead of $(cat expected)"
done
# Clamped light is reported for the joined picture as for the whole.
expect 0 "samples were clamped, which removed" render ball.pbrt --spp 48 --clamp 0.5 -o whole.exr
clamped=$(grep clamped out)
for k in 1 2 3; do
    expect 0 "" render ball.pbrt --spp 48 --clamp 0.5 --slice $k/3 -o clamped$k.exr
done
expect 0 "$clamped" merge clamped1.exr clamped2.exr clamped3.exr -o joined.exr
expect 0 "clampedLuminance" info joined.exr
expect 0 "samples per pixel" render ball.pbrt --spp 32 --sampler sobol --slice 16/16 -o sixteenth.exr
expect 0 "without slice 2: the picture is right" merge part1.exr part3.exr -o two.exr
expect 0 "without slices 2, 3: the picture is right" merge part1.exr -o one.exr
expect 0 "of 1 slice, " merge part1.exr -o one.exr
expect 1 "part1.exr: it is given twice" merge part1.exr part1.exr -o x.exr
cp part1.exr copy.exr
expect 1 "copy.exr: it is slice 1, as part1.exr is" merge part1.exr copy.exr -o x.exr
expect 0 "" render ball.pbrt --spp 48 --sampler sobol --seed 5 --slice 2/3 -o other.exr
expect 1 "other.exr: it is of another render than part1.exr" merge part1.exr other.exr -o x.exr
expect 0 "" render ball.pbrt --spp 48 --sampler sobol --slice 1/4 -o quarter.exr
expect 1 "quarter.exr: it is one of 4 slices, but part2.exr is one of 3" merge part2.exr quarter.exr -o x.exr
expect 1 "an EXR file that montelux render --slice wrote is expected" merge joined.png -o x.exr
expect 1 "missing.exr" merge part1.exr missing.exr -o x.exr
expect 2 "it is one of the slices" merge part1.exr part2.exr -o part1.exr
expect 2 "K/N is expected" render ball.pbrt --slice 4/3 -o x.exr
expect 2 "slices share a number of samples" render ball.pbrt --slice 1/3 --target-error 0.1 -o x.exr
expect 2 "--slice: there are fewer replicates than slices" render ball.pbrt --spp 2 --slice 3/3 -o x.exr
expect 2 "--slice: there are fewer replicates than slices" render ball.pbrt --spp 2 --slice 3/3 --debug-sample 1,1,0
[ -e x.exr ] && fail "a refused command wrote a picture"
finish
