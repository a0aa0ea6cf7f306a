#!/bin/sh
# Layers of a render are chosen by name; halfs; films that ask for layers.
. "$(dirname "$0")/common.sh"
scene ball "$sky
Attribute \"light\" \"string group\" \"lamp\"
LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [2 2 3]
MakeNamedMaterial \"gold\" \"string type\" \"conductor\" \"float roughness\" 0.3 NamedMaterial \"gold\"
Shape \"sphere\" \"string name\" \"globe\"" 32 24 16
render() { "$montelux" render ball.pbrt --quiet "$@" >out 2>&1 || fail "render $*: $(cat out)"; }

expect 2 "no layer 'positon' (did you mean 'position'?); expected a list of default" render ball.pbrt --layers positon
expect 2 "--layer-space: 'object' was given; world or camera is expected" render ball.pbrt --layer-space object
expect 2 "--light-groups: 'all' was given; light or kind is expected" render ball.pbrt --light-groups all
expect 2 "add --layers default" render ball.pbrt --layers uv --slice 1/2
[ -e ball.exr ] && fail "a picture was written in spite of an error"

render -o default.exr
render --layers default -o same.exr
expect 0 "32 x 24 pixels, 20 channels" info default.exr
"$montelux" info same.exr | grep '"layers"' && fail "the standard layers are named in the header"
render --layers mean -o mean.exr -o mean.pfm
expect 0 "32 x 24 pixels, 3 channels" info mean.exr
expect 0 '"layers" = "mean"' info mean.exr
all=default,variance,relative-variance,geometric-normal,position,uv,depth-slopes,motion,alpha,direct,indirect
render --layers $all,light-groups,shape,material --layer-space camera -o all.exr -o all.pfm -o all.png
for text in 'P.X' 'uv.U' 'dzdx' 'motion.Y' 'light.lamp.G' 'light.uniform-sky-0.R' 'direct.R' 'relativeVariance.B' \
    'CryptoShape02.A' '"layerSpace" = "camera"' 'globe' 'gold' 'MurmurHash3_32'; do
    expect 0 "$text" info all.exr
done
expect 0 "3 channels, 8-bit" info all.png
cmp mean.pfm all.pfm || fail "layers changed the mean"
expect 0 "RMSE 0, relMSE 0 " compare all.exr default.exr

# Halfs: half the bytes, and the rounded values.
render --layers default,position,shape --half -o half.exr
render --layers default,position,shape -o full.exr
expect 0 "RMSE" compare half.exr full.exr
[ "$(wc -c <half.exr)" -lt "$(($(wc -c <full.exr) * 3 / 4))" ] || fail "halfs are not small: $(wc -c half.exr full.exr)"
render --layers mean --half -o half_mean.exr
expect 0 "16-bit float" info half_mean.exr
render --layers mean --no-half -o full_mean.exr
expect 0 "32-bit float" info full_mean.exr
sed 's/Film "rgb"/Film "rgb" "bool savefp16" true/' ball.pbrt >fp16.pbrt
expect 0 "" render fp16.pbrt --layers mean -o fp16.exr
cmp -s fp16.exr full_mean.exr && fail "savefp16 has no effect"
expect 0 "16-bit float" info fp16.exr
expect 0 "" render fp16.pbrt --layers mean --no-half -o wide.exr
expect 0 "32-bit float" info wide.exr
sed 's/"rgb I" \[9 9 9\]/"rgb I" [9e9 9e9 9e9]/' ball.pbrt >bright.pbrt
expect 0 "values beyond the range of 16-bit floats became 65504" render bright.pbrt --layers mean --half -o bright.exr

# pbrt's film, in camera space unless it says otherwise; a crop of it.
sed 's/Film "rgb"/Film "gbuffer"/' ball.pbrt >gbuffer.pbrt
expect 0 "" render gbuffer.pbrt -o g.exr
for text in 'P.Z' 'Ng.X' 'dzdy' 'uv.V' 'variance.G' '"layerSpace" = "camera"'; do expect 0 "$text" info g.exr; done
expect 2 "add --layers default" render gbuffer.pbrt --slice 1/2
expect 0 "" render gbuffer.pbrt --layers default --slice 1/2 -o slice.exr
expect 0 "" render gbuffer.pbrt --crop 0.25,0.75,0.5,1 -o c.exr
expect 0 "16 x 12 pixels that both pictures have (columns 8 to 23, rows 12 to 23), 192 compared" compare c.exr g.exr
expect 0 "RMSE 0, relMSE 0 " compare c.exr g.exr

# Checkpoints keep the sums of layers.
render --layers uv --spp 8 --checkpoint state -o x.exr
expect 1 "the layers of the film (--layers) differ" render ball.pbrt --checkpoint state --resume -o x.exr
render --layers uv --checkpoint state --resume -o resumed.exr
render --layers uv -o whole.exr
"$montelux" info resumed.exr | grep '^ *uv' >resumed
"$montelux" info whole.exr | grep '^ *uv' >whole
[ -s whole ] && cmp whole resumed || fail "the resumed layers differ"
finish
