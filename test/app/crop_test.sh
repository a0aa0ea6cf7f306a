#!/bin/sh
# Crops keep their place in EXR files: compare, merge, denoise and resumed renders use it.
. "$(dirname "$0")/common.sh"
scene ball "$sky Material \"diffuse\" Shape \"sphere\"" 64 48
render() { "$montelux" render ball.pbrt --quiet --sampler independent --spp 16 "$@" >out 2>&1 || fail "render $*: $(cat out)"; }
render -o whole.exr -o whole.pfm
render --crop 0.25,0.75,0.5,1 -o crop.exr -o crop.png -o crop.pfm
render --crop 0.5,1,0.25,0.75 -o other.exr
render --crop 0,0.25,0,0.25 -o far.exr
for entry in '"dataWindow.x" = 16' '"dataWindow.y" = 24' '"displayWindow.width" = 64' '"displayWindow.height" = 48' \
    'crop.exr: 32 x 24 pixels'; do
    expect 0 "$entry" info crop.exr
done
"$montelux" info whole.exr | grep -E "(data|display)Window" && fail "a whole picture has a place"

# The pixels are those of the whole, bit for bit.
for pair in 'crop.exr whole.exr' 'whole.exr crop.exr' 'crop.exr whole.pfm'; do
    expect 0 "32 x 24 pixels that both pictures have (columns 16 to 47, rows 24 to 47), 768 compared" compare $pair
    expect 0 "RMSE 0, relMSE 0 " compare $pair
done
expect 0 "16 x 12 pixels that both pictures have (columns 32 to 47, rows 24 to 35), 192 compared" compare crop.exr other.exr
expect 0 "RMSE 0, relMSE 0 " compare crop.exr other.exr
"$montelux" compare crop.exr whole.exr --json | tr -d ' \n' | grep -q '"width":32,"height":24,"window":\[16,24,48,48\]' ||
    fail "compare --json says no window"
expect 1 "they have no pixel in common" compare crop.exr far.exr
expect 1 "64 x 48" compare crop.pfm whole.exr # PFM keeps no place
expect 0 "768 compared" compare crop.pfm crop.exr
# Errors in a file of their own have the size of their picture.
expect 0 "that both pictures have (columns 16" compare crop.exr whole.exr --stderr-b whole.pfm --difference d.png
expect 0 "d.png: 32 x 24 pixels" info d.png

# Slices of a crop, and a crop that is resumed.
for k in 1 2; do render --crop 0.25,0.75,0.5,1 --slice $k/2 -o part$k.exr; done
expect 0 "" merge part1.exr part2.exr -o joined.exr
expect 0 '"displayWindow.width" = 64' info joined.exr
expect 0 "that both pictures have (columns 16 to 47, rows 24 to 47)" compare joined.exr whole.exr
expect 1 "another render" merge part1.exr far.exr -o x.exr
render --crop 0.25,0.75,0.5,1 --spp 8 --checkpoint state -o half.exr
expect 1 "the film differs" render ball.pbrt --sampler independent --crop 0.5,1,0.25,0.75 --resume --checkpoint state -o x.exr
render --crop 0.25,0.75,0.5,1 --checkpoint state --resume -o resumed.exr
expect 0 "RMSE 0, relMSE 0 " compare resumed.exr whole.exr
finish
