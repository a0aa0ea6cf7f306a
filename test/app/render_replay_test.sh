#!/bin/sh
# Replayed samples: refused arguments, the printed record, and the option that the message on bad samples gives.
. "$(dirname "$0")/common.sh"
scene ok "$sky Material \"coateddiffuse\" Shape \"sphere\"" 64 48

for value in 1,2 1,2,3,4 1,2,x 1.5,2,3 1,2,-3 1,2,1e1 '' ,, 99999999999,0,0; do
    expect 2 "--debug-sample: '$value' was given" render ok.pbrt --debug-sample "$value"
done
expect 2 "--debug-sample: pixel 64,0: the film has columns 0 to 63 and rows 0 to 47" render ok.pbrt --debug-sample 64,0,0
expect 2 "pixel 0,48" render ok.pbrt --debug-sample 0,48,0
expect 2 "pixel -1,0" render ok.pbrt --debug-sample -1,0,0
expect 2 "sample 4: the pixel has 4 samples, counted from 0" render ok.pbrt --debug-sample 0,0,4
expect 2 "the crop of the film has columns 32 to 63 and rows 0 to 23" render ok.pbrt --crop 0.5,1,0,0.5 \
    --debug-sample 0,0,0
expect 0 "sample 8 of 9 of pixel 32,24, sampler halton, seed 5, strategy light" render ok.pbrt --spp 9 \
    --sampler halton --seed 5 --strategy light --debug-sample 32,24,8
expect 0 "strategy mis-bsdf with the power heuristic" render ok.pbrt --strategy mis-bsdf --debug-sample 32,24,3
scene lamp 'LightSource "point" "point3 from" [0 0 3] Shape "sphere"' 64 48
expect 0 "to the term mis-light, which is left out" render lamp.pbrt --strategy mis-bsdf --debug-sample 32,24,0
expect 0 "to the term mis-bsdf, which is left out" render ok.pbrt --strategy mis-light --debug-sample 0,0,0
# A lamp that no path can hit, but not a point light: its radiance has a density.
scene hidden 'AttributeBegin AreaLightSource "diffuse" "bool twosided" true Translate 0 0 3 Shape "disk" "float alpha" 0 AttributeEnd
    Shape "sphere"' 64 48
expect 0 "per steradian; weight 1" render hidden.pbrt --strategy bsdf --debug-sample 32,20,0
grep -q irradiance out && fail "a hidden lamp: $(cat out)"
expect 0 "vertex 1: shape 0, a sphere, material 0" render ok.pbrt --debug-sample 32,24,0
expect 0 "coated diffuse" render ok.pbrt --debug-sample 32,24,0
expect 0 "the path left the scene" render ok.pbrt --debug-sample 0,0,0
expect 0 "--debug-sample renders no picture" render ok.pbrt --debug-sample 0,0,0 -o picture.exr
expect 0 "the pixel gets" render ok.pbrt --debug-sample 0,0,0 --quiet -o picture.exr
grep -q warning out && fail "--quiet printed a warning"
[ -e ok.exr ] || [ -e picture.exr ] && fail "a picture was written"

# The picture of one sample per pixel is that sample.
"$montelux" render ok.pbrt --quiet --spp 1 --crop 0.5,0.51,0.5,0.51 -o one.pfm || fail "render"
"$montelux" render ok.pbrt --quiet --spp 1 --debug-sample 32,24,0 >record || fail "replay"
pixel=$(od -A n -t f4 -j $(($(wc -c <one.pfm) - 12)) one.pfm | awk '{ printf "%.5g %.5g %.5g", $1, $2, $3 }')
replayed=$(awk '/the pixel gets/ { printf "%.5g %.5g %.5g", $4, $5, $6 }' record)
[ -n "$replayed" ] && [ "$pixel" = "$replayed" ] || fail "the pixel is $pixel, the replay says $replayed"

# A metal whose index overflows is not a number. The option in the message shows where it first occurs.
scene bad "$sky Material \"conductor\" \"spectrum eta\" [300 1e30 900 1e30] \"spectrum k\" [300 1 900 1]
    \"float roughness\" 0.3 Shape \"sphere\""
expect 0 "not a number, is sample" render bad.pbrt
option=$(grep -o -- '--debug-sample [0-9,]*$' out)
[ -n "$option" ] || fail "the message does not end with the option that replays: $(cat out)"
expect 0 "left out: it is not a number, first at vertex 1, in the value of the BSDF" render bad.pbrt $option

# The same metal, hit by one sample in 1e5: the render completes and reports how many samples were left out.
metal='Material "conductor" "spectrum eta" [300 1e30 900 1e30] "spectrum k" [300 1 900 1] "float roughness" 0.3'
scene rare "$sky Material \"diffuse\" Shape \"disk\" \"float radius\" 9 \"float height\" -1
    $metal Translate 0.6 0 0 Shape \"sphere\" \"float radius\" 0.006" 64 48 200
expect 0 "samples were left out" render rare.pbrt
left_out=$(sed -n 's/.*warning: \([0-9]*\) samples were left out.*/\1/p' out)
[ "${left_out:-0}" -ge 1 ] && [ "$left_out" -le 60 ] || fail "$left_out of 614400 samples were left out"
option=$(grep -o -- '--debug-sample [0-9,]*$' out)
expect 0 "left out: it is not a number, first at vertex" render rare.pbrt $option
expect 0 '"badSamples" = '"$left_out" info rare.exr
"$montelux" info rare.exr | awk '$1 ~ /^(R|G|B|stderr|samples)/ && $5 != 0 { bad = 1 } END { exit bad }' ||
    fail "the picture holds values that are not a number"
finish
