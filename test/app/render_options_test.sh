#!/bin/sh
# Options of the render command: refused values, and effects on the picture.
. "$(dirname "$0")/common.sh"
scene ok "$sky
LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [2 2 3]
Material \"coateddiffuse\" Shape \"sphere\" Translate 1 0 0 Shape \"sphere\"" 64 48

expect 2 "SCENE is required" render
expect 2 "extra" render ok.pbrt extra
expect 2 "--nonsense" render ok.pbrt --nonsense
for value in 0x0 axb 8 8x 8x8x8 -8x8 1e9x1 99999x9 8,8 ''; do
    expect 2 "--resolution: '$value' was given" render ok.pbrt --resolution "$value"
done
for value in 0,1 0,1,0,1,1 a,b,c,d 1,0,0,1 0,0,0,0 -1,1,0,1 nan,1,0,1 0,1,0,2 ''; do
    expect 2 "--crop: '$value' was given" render ok.pbrt --crop "$value"
done
expect 2 "no pixel of the 64x48 film" render ok.pbrt --crop 0.001,0.002,0,1
for option in --spp --seed --threads --max-depth; do
    for value in -1 1.5 1e-1 1e30 99999999999999999999 0x10 x ''; do
        expect 2 "$option: '$value' was given" render ok.pbrt $option "$value"
    done
done
expect 0 "20 samples per pixel" render ok.pbrt --resolution 8x6 --spp 2e1 --seed 1e3 -o twenty.pfm
expect 2 "--checkpoint-every requires --checkpoint" render ok.pbrt --checkpoint-every 5
expect 2 "--checkpoint: the name of a file is expected" render ok.pbrt --checkpoint ''
expect 2 "--spp: '0' was given; a whole number from 1 to" render ok.pbrt --spp 0
expect 2 "--threads: '5000'" render ok.pbrt --threads 5000
expect 2 "--rank-timeout: '1' was given; a time of at least 2s" render ok.pbrt --rank-timeout 1
for option in --sampler --integrator --strategy --heuristic --light-sampling --microfacet-scattering --shading-terminator; do
    expect 2 "$option: 'foo' was given; one of" render ok.pbrt $option foo
done
expect 2 "path, bidirectional, light-tracing, metropolis, auto is expected" render ok.pbrt --integrator bdpt
expect 1 "leave out --adaptive or choose 'path'" render ok.pbrt --integrator bidirectional --adaptive on
expect 1 "cannot be replayed" render ok.pbrt --integrator bidirectional --debug-sample 0,0,0
expect 2 "--merging: '0' was given; off, auto or a radius above 0" render ok.pbrt --integrator bidirectional --merging 0
expect 2 "expected --merging auto or a radius" render ok.pbrt --integrator bidirectional --merging-memory 64
expect 1 "only the integrator 'bidirectional' merges paths, not 'path'" render ok.pbrt --merging auto
expect 2 "mis, mis-bsdf, mis-light is expected" render ok.pbrt --strategy mis_bsdf
expect 1 "GiB of memory; this machine has" render ok.pbrt --resolution 65536x65536
[ -e ok.exr ] && fail "a picture was written in spite of an error"

expect 0 "32 x 12 pixels, 2 samples per pixel" render -o a.exr -o a.png -o a.hdr -o a.pfm ok.pbrt \
    --resolution 64x48 --spp 2 --seed 18446744073709551615 --sampler halton --crop 0,0.5,0.5,0.75 --max-depth 3
expect 0 "32 x 12 pixels, 20 channels" info a.exr
for entry in '"spp" = 2' '"seed" = "18446744073709551615"' '"sampler" = "halton"' '"maxDepth" = 3' \
    '"cropPixels" = [0.0,24.0,32.0,36.0]' '"fullResolution" = [64.0,48.0]' '"scene" = "ok.pbrt"' \
    '"sceneHash" = "' '"software" = "Montelux ' '"renderSeconds" = ' '"worldToCamera" = [[' '"interrupted" = 0'; do
    expect 0 "$entry" info a.exr
done
expect 0 "32 x 12 pixels, 3 channels, 8-bit integer, sRGB" info a.png
expect 0 "z-scores use the standard errors of B alone" compare a.hdr a.exr
expect 0 "z-scores with errors pooled over 3 x 3 pixels of" compare a.hdr a.exr
expect 0 '"z_pooled": {' compare a.hdr a.exr --json

render() { "$montelux" render ok.pbrt --quiet --spp 8 "$@" >out 2>&1 || fail "montelux render $*: $(cat out)"; }
# The words (of 4 bytes; 3 are the header) of columns 16 to 47 of the lower 24 of 48 rows of 64; rows go upwards.
lower_middle() {
    row=0
    while [ $row -lt 24 ]; do
        dd if="$1" bs=4 skip=$((3 + row * 192 + 48)) count=96 2>/dev/null
        row=$((row + 1))
    done
}
for sampler in independent stratified halton hammersley sobol sobol-blue-noise; do
    render --sampler $sampler --threads 1 -o one.pfm
    render --sampler $sampler --threads 2 -o two.pfm
    cmp -s one.pfm two.pfm || fail "$sampler: the picture depends on the number of threads"
    render --sampler $sampler --seed 1 -o seed.pfm
    cmp -s one.pfm seed.pfm && fail "$sampler: another seed gives the same picture"
    render --sampler $sampler --crop 0.25,0.75,0.5,1 -o crop.pfm
    lower_middle one.pfm >expected
    dd if=crop.pfm bs=4 skip=3 of=got 2>/dev/null
    [ -s expected ] && cmp -s expected got || fail "$sampler: a crop differs from that part of the picture"
done
for change in "--max-depth 1" "--spp 9" "--sampler halton" "--strategy bsdf" "--integrator bidirectional" "--integrator light-tracing" "--heuristic balance" "--light-sampling uniform"; do
    render -o one.pfm
    render -o two.pfm $change
    cmp -s one.pfm two.pfm && fail "$change changes nothing"
done
[ -s out ] && fail "--quiet printed something: $(cat out)"

# An integrator chosen by a pilot: the picture of that integrator, and what it says.
scene shaded "LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [0 0 2]
AttributeBegin Material \"dielectric\" Translate 0 0 2 Shape \"sphere\" \"float radius\" 0.3 AttributeEnd
Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-5 -5 -1  5 -5 -1  -5 5 -1  5 5 -1]" 64 48
for case in "ok path --spp 512" "shaded bidirectional --spp 512" "shaded bidirectional --target-error 15%"; do
    set -- $case
    scene=$1.pbrt kind=$2
    shift 2
    expect 0 "montelux: integrator $kind: to the same error " render $scene "$@" --integrator auto -o chosen.exr -o chosen.pfm
    expect 0 "\"integratorChoice\" = \"$kind: to the same error " info chosen.exr
    expect 0 "\"integrator\" = \"$kind\"" info chosen.exr
    "$montelux" render $scene "$@" --integrator $kind --quiet -o by_name.pfm
    cmp -s by_name.pfm chosen.pfm || fail "$case: the picture is not that of --integrator $kind"
done
expect 0 "about " render shaded.pbrt --target-error 15% --integrator auto -o chosen.pfm
expect 0 "the render is too short to try bidirectional and metropolis" render ok.pbrt --spp 4 --integrator auto -o chosen.pfm
expect 0 "not a candidate: integrator bidirectional: its light paths reach all pixels" render ok.pbrt --spp 64 \
    --adaptive on --integrator auto -o chosen.pfm
expect 1 "all slices of a picture must be rendered by the same integrator" render ok.pbrt --spp 64 --slice 1/2 \
    --integrator auto -o chosen.exr
expect 1 "choose path, bidirectional or metropolis" render ok.pbrt --integrator auto --debug-sample 0,0,0
"$montelux" render shaded.pbrt --spp 256 --integrator auto --quiet --checkpoint chosen.ckpt -o part.pfm
expect 0 "272 samples per pixel" render shaded.pbrt --spp 272 --integrator auto --checkpoint chosen.ckpt --resume -o resumed.exr
expect 0 '"integratorChoice" = "bidirectional: ' info resumed.exr
expect 0 '"integrator" = "bidirectional"' info resumed.exr
expect 0 "inside Embree" render ok.pbrt --stats

# Options of surfaces change what they are for, and by default nothing.
scene rough "LightSource \"distant\" \"point3 from\" [3 1 -0.3]
Material \"conductor\" \"float roughness\" 0.5 Translate -0.9 0 0 Shape \"sphere\" \"float radius\" 0.7
Material \"diffuse\" Translate 1.7 0 0
Shape \"trianglemesh\" \"point3 P\" [-0.7 -0.7 0  0.7 -0.7 0  0 0.7 0] \"integer indices\" [0 1 2]
    \"normal N\" [-0.9 -0.2 0.2  0.9 -0.2 0.2  0 0.9 0.2]" 64 48
render_rough() { "$montelux" render rough.pbrt --quiet --spp 8 "$@" >out 2>&1 || fail "montelux render $*: $(cat out)"; }
render_rough -o one.pfm
render_rough -o two.pfm --microfacet-scattering single --shading-terminator hard
cmp -s one.pfm two.pfm || fail "the defaults of surfaces, given as options, change the picture"
for change in "--microfacet-scattering multiple" "--shading-terminator soft"; do
    render_rough -o two.pfm $change
    cmp -s one.pfm two.pfm && fail "$change changes nothing"
done
render_rough -o two.exr --microfacet-scattering multiple --shading-terminator soft --checkpoint two.ckpt
expect 0 '"microfacetScattering" = "multiple"' info two.exr
expect 0 '"shadingTerminator" = "soft"' info two.exr
expect 1 "the integrator differs" render rough.pbrt --spp 16 -o two.exr --microfacet-scattering multiple \
    --checkpoint two.ckpt --resume
expect 0 "16 samples per pixel" render rough.pbrt --spp 16 -o two.exr --microfacet-scattering multiple \
    --shading-terminator soft --checkpoint two.ckpt --resume
expect 0 "peak of the process" render ok.pbrt --memory

# Textures in a temporary file: the same bits, digest and checkpoints, for any number of threads; no file is left.
for value in 1M 15.9M 500 M -20M 20MB 20m nanG '' 1e; do
    expect 2 "--texture-memory: '$value' was given; a size from 16M on is expected" render ok.pbrt --texture-memory "$value"
done
render -o map.exr -o map.png --resolution 300x200
textured="$sky"
for filter in point bilinear trilinear ewa; do
    for file in map.png map.exr; do
        textured="$textured
Texture \"$filter $file\" \"spectrum\" \"imagemap\" \"string filename\" \"$file\" \"string filter\" \"$filter\"
Material \"diffuse\" \"texture reflectance\" \"$filter $file\" Translate 0.4 0 0.1 Shape \"sphere\""
    done
done
scene textured "$textured" 64 48
render_textured() { "$montelux" render textured.pbrt --quiet --spp 8 "$@" >out 2>&1 || fail "montelux render $*: $(cat out)"; }
mkdir temporary
render_textured -o one.pfm -o one.exr --threads 1
for threads in 1 3; do
    TMPDIR="$PWD/temporary" render_textured -o two.pfm -o two.exr --threads $threads --texture-memory 16M
    cmp -s one.pfm two.pfm || fail "--texture-memory changes the picture of $threads threads"
done
[ "$(ls -A temporary)" ] && fail "a temporary file is left"
hash_of() { "$montelux" info "$1" | grep '"sceneHash"'; }
[ "$(hash_of one.exr)" = "$(hash_of two.exr)" ] || fail "--texture-memory changes the hash of the scene"
render_textured -o one.exr --checkpoint textured.ckpt --texture-memory 1.5G
expect 0 "16 samples per pixel" render textured.pbrt --spp 16 -o one.exr --checkpoint textured.ckpt --resume
expect 0 "MiB in a temporary file" render textured.pbrt --memory --texture-memory 0.5G
expect 0 "2 images, " render textured.pbrt --memory --texture-memory 0.5G
TMPDIR="$PWD/missing"
export TMPDIR
expect 1 "set TMPDIR to another folder" render textured.pbrt --texture-memory 16M
unset TMPDIR
finish
