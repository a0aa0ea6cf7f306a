#!/bin/sh
# Commands, help, info and compare: cli_test.sh path/to/montelux
. "$(dirname "$0")/common.sh"

# Two grey float pictures of two pixels, 1 and 0.5 (bottom up, little-endian), and one of other size.
printf 'Pf\n1 2\n-1\n\000\000\200\077\000\000\000\077' >a.pfm
printf 'Pf\n1 2\n-1\n\000\000\200\077\000\000\200\077' >b.pfm
printf 'Pf\n2 1\n-1\n\000\000\200\077\000\000\200\077' >wide.pfm

expect 0 "montelux render scene.pbrt --spp 64 -o out.exr" --help
expect 0 "montelux " --version
# A processor that lacks what the program was built for (x86-64 alone; emulated, where the emulator is installed).
if command -v qemu-x86_64 >/dev/null && "$montelux" --version | grep -q 'x86-64-v[34]'; then
    code=0
    qemu-x86_64 -cpu Nehalem "$montelux" --version >old.txt 2>&1 || code=$?
    [ $code -eq 1 ] && grep -q 'this processor has no AVX2, which the program was built for' old.txt ||
        fail "on an old processor: exit code $code, $(cat old.txt)"
fi
for command in integrate sample render info compare; do expect 0 "Example" $command --help; done
expect 0 "--max-depth N" render --help
expect 2 "a command is expected: integrate, sample, render, view, merge, compare, denoise, bake, convert, info, formats, completion, manual" # no arguments
expect 2 "there is no command 'rendr' (did you mean 'render'?)" rendr
expect 2 "there is no bake command 'skye' (did you mean 'sky'?); expected one of environment" bake skye
expect 2 "a bake command is expected: environment, brdf, report, sky" bake
expect 2 "there is no option '--speed' (did you mean '--seed'?)" render x.pbrt --speed 3
expect 2 "there is no option '--speed' (did you mean '--seed'?)" render --speed=3 x.pbrt
expect 2 "there is no option '-z'" info -z a.pfm
expect 2 "'b.pfm' is not expected" info a.pfm b.pfm c.pfm
expect 2 "--nonsense" --nonsense
expect 2 "--nonsense" info --nonsense a.pfm
expect 2 "Run 'montelux info --help'" info
expect 2 "required" compare a.pfm
expect 2 "'nan' was given; a number from 0 to 99.999 is expected" compare a.pfm b.pfm --set-aside nan
expect 2 "set-aside" compare a.pfm b.pfm --set-aside 100
expect 2 "difference" compare a.pfm b.pfm --full-scale 1

expect 0 "1 x 2 pixels" info a.pfm
expect 0 '"maximum": 1.0' info a.pfm --json
expect 1 "montelux: error: none.exr: cannot be opened" info none.exr
expect 1 "it is a folder" info .
printf 'no picture' >text.png
expect 1 "montelux: error: text.png: is not a picture" info text.png

expect 0 "gbuffer             yes: as 'rgb', with its layers" formats pbrt
expect 0 '"plugin": "bilinearmesh"' formats pbrt --json
expect 2 "a formats command is expected: pbrt, gltf, mitsuba" formats
expect 0 "light    KHR_lights_punctual                  in part: " formats gltf
expect 0 '"feature": "KHR_materials_sheen"' formats gltf --json
expect 2 "there is no formats command 'pbr' (did you mean 'pbrt'?); expected one of pbrt, gltf, mitsuba" formats pbr

expect 0 "RMSE 0.353553" compare a.pfm b.pfm
expect 0 "neither picture has standard errors" compare a.pfm b.pfm
if "$montelux" compare a.pfm b.pfm | grep -q nan; then fail "compare prints 'nan' where nothing is known"; fi
expect 0 "full at 0.4995" compare a.pfm b.pfm --difference d.png
expect 0 "1 x 2 pixels, 3 channels, 8-bit integer, sRGB" info d.png
expect 0 "standard errors of B alone" compare a.pfm b.pfm --stderr-b b.pfm
expect 0 '"largest": 0.5' compare a.pfm b.pfm --stderr-b b.pfm --json
expect 1 "wide.pfm is 2 x 1" compare a.pfm wide.pfm
expect 2 "expected a name that ends in .png" compare a.pfm b.pfm --difference d.gif
expect 1 "standard errors" compare a.pfm b.pfm --set-aside 1
expect 1 "standard errors" compare a.pfm b.pfm --difference d.png --difference-of z

# An input of compare is never overwritten, under any of its names.
cp d.png e.png && ln -s e.png link.png && ln e.png hard.png && cp e.png kept.png
for name in e.png ./e.png link.png hard.png "$PWD/e.png"; do
    expect 2 "this file is read; what is written needs another name" compare d.png e.png --difference "$name"
    expect 2 "this file is read" compare e.png d.png --difference "$name"
    expect 2 "this file is read" compare d.png d.png --stderr-b e.png --difference "$name"
done
cmp -s e.png kept.png || fail "compare overwrote its input"

# Non-finite values are counted; minimum, mean and maximum are of the finite ones.
infinite='\000\000\200\177'
pfm infinite.pfm 2 1 "$one" "$infinite" "$one" "$one" "$infinite" "$not_a_number"
"$montelux" info infinite.pfm >out || fail "info of infinite values: exit code $?"
awk '$1 == "R" { r = $2 == 1 && $4 == 1 } $1 == "G" { g = $2 == "-" && $3 == "-" && $4 == "-" && $6 == 2 }
    END { exit !r || !g }' out || fail "infinite values: $(cat out)"
expect 0 '"maximum": null' info infinite.pfm --json

# The JSON of many layers is longer than what is kept until the end.
scene layers "$sky" 2 2 1
expect 0 "layers.exr" render layers.pbrt
for command in "info a.pfm" "info layers.exr --json" --version --help "compare a.pfm b.pfm --json"; do
    "$montelux" $command >/dev/full 2>err && fail "$command: a full disk behind standard output went unnoticed"
    "$montelux" $command >&- 2>err && fail "$command: a closed standard output went unnoticed"
done
if "$montelux" info a.pfm >/dev/full 2>err; then fail "a full disk behind standard output went unnoticed"; fi
if "$montelux" info a.pfm >&- 2>err; then fail "a closed standard output went unnoticed"; fi
finish
