#!/bin/sh
# Baking: files, options, messages, odd maps; no partial files are left.
. "$(dirname "$0")/common.sh"
half='\000\000\000\077' two='\000\000\000\100' infinite='\000\000\200\177'
pfm sky.pfm 4 2 "$one" "$half" "$two" "$one" "$one" "$one" "$two" "$half" "$one" "$zero" "$half" "$one" \
    "$one" "$half" "$two" "$one" "$one" "$one" "$two" "$half" "$one" "$zero" "$half" "$one"

# The table.
expect 0 "table.exr: 32 x 32 texels, error below" bake brdf -o table.exr -o table.png -o table.ktx2 --size 32
expect 0 "table.png: 32 x 32 texels, error below 0.002," bake brdf -o table.png --size 32 # half of 1/255
expect 0 "table.ktx2: 32 x 32 texels, error below 0.00026," bake brdf -o table.ktx2 --size 32 # 2^-12 of it
expect 0 "error.G" info table.exr
expect 0 "32 x 32 pixels" info table.png
expect 0 '"largest_error_bound"' bake brdf -o filament.exr --size 8 --terms bias-sum --first-row rough --blue sheen --json
expect 2 "has no channel B" bake brdf -o x.ktx2 --size 8 --blue sheen
expect 0 "x.ktx2" bake brdf -o x.ktx2 --size 8 --blue sheen --format rgba16f
expect 2 "--size" bake brdf -o x.exr --size 0
expect 2 "--output is required" bake brdf
expect 1 "the extension '.gif'" bake brdf -o x.gif
expect 2 "bake" bake
expect 0 "environment" bake --help
expect 0 "--target-error" bake environment --help

# A sky.
expect 0 "level ground gets" bake sky --elevation 20 --turbidity 3 -o clear.exr -o clear.hdr -o clear.pfm --size 64
expect 0 "64 x 32 pixels" info clear.exr
expect 0 '"sun_illuminance": 0.0' bake sky --elevation -3 -o dusk.pfm --size 16 --json
expect 0 "level ground" bake sky --elevation 20 --turbidity 3 -o bare.pfm --size 64 --no-sun
cmp -s clear.pfm bare.pfm && fail "--no-sun changes nothing"
expect 0 "level ground" bake sky --elevation 20 --turbidity 3 -o again.pfm --size 64 --threads 1
cmp -s clear.pfm again.pfm || fail "the number of threads changes the sky"
expect 0 "texels" bake environment clear.exr --size 8 --levels 2 -o clear.ktx2
expect 2 "--elevation" bake sky --elevation 91 -o x.exr
expect 2 "--turbidity" bake sky --turbidity 0 -o x.exr
expect 2 "an even number" bake sky --size 63 -o x.exr
expect 2 "--output is required" bake sky
expect 2 "becomes too large for a float" bake sky --size 16 --scale 1e300 -o x.exr
expect 2 "becomes too small for a float" bake sky --size 16 --scale 1e-300 -o x.exr
expect 0 "texels" bake sky --size 16 --scale 1e-20 -o x.exr

# The chain, in all kinds of files.
expect 0 "equirectangular map of 4 x 2 texels" bake environment sky.pfm --size 8 --levels 3 -o a.ktx2 -o a.ktx -o a.dds \
    -o a.exr -o a.png --preview sheet.png --irradiance i.exr --irradiance-size 4 --harmonics sh.json --harmonics sh.txt
for file in a.ktx2 a.ktx a.dds a_m0.exr a_m1.exr a_m2.exr a_m0.png a_m2.png sheet.png i.exr sh.json sh.txt; do
    [ -s $file ] || fail "$file is missing"
done
expect 0 "stderr.R" info a_m1.exr
expect 0 "32 x 24 pixels" info a_m0.exr
expect 0 "texels" bake environment sky.pfm --size 4 -o strip.exr --layout vertical --target-error 2%
expect 0 "4 x 24 pixels" info strip.exr
expect 0 "texels" bake environment sky.pfm --size 4 --levels 2 -o f.exr --layout faces
[ -s f_m1_nz.exr ] || fail "a face is missing: $(ls)"
expect 0 '"missed": 0' bake environment sky.pfm --size 4 -o b.exr --json
grep -q '"polynomial"' out || fail "the harmonics are missing in the summary"

# The same bytes on any number of threads.
expect 0 "texels" bake environment sky.pfm --size 8 --levels 3 -o t1.pfm --threads 1
expect 0 "texels" bake environment sky.pfm --size 8 --levels 3 -o t3.pfm --threads 3
cmp -s t1_m1.pfm t3_m1.pfm || fail "the number of threads changes the result"
expect 0 "texels" bake environment sky.pfm --size 8 --levels 3 -o up.pfm --up z
cmp -s t1_m1.pfm up_m1.pfm && fail "--up changes nothing"
expect 0 "texels" bake environment sky.pfm --size 8 --levels 3 -o mirror.pfm --mirror
cmp -s t1_m1.pfm mirror_m1.pfm && fail "--mirror changes nothing"
expect 0 "texels" bake environment sky.pfm --size 8 --levels 3 -o turn.pfm --turn 40
cmp -s t1_m1.pfm turn_m1.pfm && fail "--turn changes nothing"

"$montelux" bake environment sky.pfm --size 4 -o q.exr --quiet >out 2>&1 || fail "--quiet ends in an error"
[ -s out ] && fail "--quiet prints: $(cat out)"

# Options that make no sense, and answers of "no".
expect 2 "nothing to bake" bake environment sky.pfm
expect 2 "--seed: '-1' was given; a whole number is expected" bake environment sky.pfm -o x.exr --seed -1
expect 2 "--seed: '-1' was given" bake report sky.pfm --seed -1
expect 2 "--exposure: 'nan' was given; a number from -100 to 100" bake environment sky.pfm -o x.png --exposure nan
expect 2 "--turn: '1e300' was given; a number from -360 to 360" bake environment sky.pfm -o x.exr --turn 1e300
expect 2 "--dark-floor: 'nan' was given" bake environment sky.pfm -o x.exr --dark-floor nan
expect 2 "--elevation: 'nan' was given; a number from" bake sky --elevation nan -o x.exr
expect 2 "--roughness: 'nan' was given" bake report sky.pfm --roughness 0.5,nan
expect 2 "they are of --format rgbm8" bake environment sky.pfm -o x.ktx2 --rgbm-range 7
expect 2 "they are of --format rgbm8" bake environment sky.pfm -o x.ktx2 --rgbm-power 2
expect 0 "texels" bake environment sky.pfm --size 4 --levels 1 -o rgbm.ktx2 --format rgbm8 --rgbm-range 7
expect 2 "--irradiance-size requires --irradiance" bake environment sky.pfm -o x.exr --irradiance-size 8
expect 1 "'.xyz' is not one of .ktx2, .ktx, .dds, .exr, .hdr, .pfm, .png" bake environment sky.pfm -o q.xyz
expect 1 "the extension '.dds' is not one of .exr, .ktx2, .pfm, .hdr, .png" bake brdf -o brdf.dds
expect 2 "does not go with" bake environment sky.pfm -o x.exr --samples 10 --target-error 0.1
expect 2 "'2' was given; a number above 0 and below 1 is expected" bake environment sky.pfm -o x.exr --target-error 2
expect 2 "'-1' was given; a number that is not negative" bake environment sky.pfm -o x.exr --dark-floor -1
expect 2 "'0' was given; a number above 0 is expected" bake sky -o x.exr --scale 0
expect 2 "needs --sampling lobe" bake environment sky.pfm -o x.exr --source-mips
expect 0 "do not include their bias" bake environment sky.pfm --size 4 -o x.exr --sampling lobe --source-mips --samples 64
expect 2 "expected linear, filament, babylon, or numbers" bake environment sky.pfm -o x.exr --roughness 0,2
expect 2 "do not go together" bake environment sky.pfm -o x.exr --roughness 0,1 --levels 3
expect 2 "at most 3 levels" bake environment sky.pfm -o x.exr --size 4 --levels 4
expect 0 "0.4" bake environment sky.pfm --size 4 -o x.exr --roughness 0.4,0.8
expect 2 "does not go into this kind of file" bake environment sky.pfm -o x.dds --format rgbm8
expect 2 "spherical harmonics go into" bake environment sky.pfm --harmonics x.exr
expect 3 "texels exceed the target error" bake environment sky.pfm --size 4 --roughness 0.5 -o x.exr \
    --target-error 1e-5 --samples-max 64
expect 1 "missing.hdr" bake environment missing.hdr -o x.exr
expect 1 "no-folder" bake environment sky.pfm -o no-folder/x.exr

# Odd maps.
pfm one.pfm 1 1 "$one" "$half" "$two"
expect 0 "equal-area map of 1 x 1 texels" bake environment one.pfm --size 2 -o x.exr --roughness 0.5
pfm tall.pfm 1 3 "$one" "$one" "$one" "$half" "$half" "$half" "$one" "$one" "$one"
expect 0 "not twice as wide as high" bake environment tall.pfm --size 2 -o x.exr --roughness 0.5
expect 1 "an equal-area map is square; this picture has 4 x 2 pixels" bake environment sky.pfm -o x.exr --map equal-area
pfm bad.pfm 2 1 "$minus_one" "$not_a_number" "$infinite" "$one" "$one" "$one"
expect 0 "3 samples became 0 (1 not a number, 1 infinite, 1 negative)" bake environment bad.pfm --size 2 -o x.exr --roughness 0.5
pfm black.pfm 2 1 "$zero" "$zero" "$zero" "$zero" "$zero" "$zero"
expect 0 "0 %" bake environment black.pfm --size 4 -o x.exr --irradiance y.exr --roughness 0,0.5

# Texels too large for sums are refused, and large ones have finite results.
huge='\231\166\226\176' too_huge='\346\261\141\177' # 1e38 and 3e38
pfm large.pfm 2 1 "$one" "$one" "$one" "$too_huge" "$one" "$one"
expect 1 "large.pfm: environment map: a sample is 3" bake environment large.pfm --size 2 -o x.exr --roughness 0.5
expect 1 "is expected, so that sums are finite" bake report large.pfm --roughness 0.5 --orientations 2
pfm large.pfm 2 1 "$one" "$huge" "$one" "$one" "$one" "$one"
expect 1 "a sample is 1" bake environment large.pfm --size 2 -o x.exr --roughness 0,0.5

# Nothing is written over the map, and no two outputs share a name.
cp sky.pfm map.pfm && ln -s map.pfm link.pfm && ln map.pfm hard.pfm
for name in map.pfm ./map.pfm link.pfm hard.pfm; do
    expect 2 "this file is read; what is written needs another name" bake environment map.pfm --size 2 --levels 1 -o $name
    expect 2 "this file is read" bake environment map.pfm --size 2 --irradiance $name
    expect 2 "this file is read" bake environment map.pfm --size 2 -o x.ktx2 --preview $name
    expect 2 "this file is read" bake report map.pfm --roughness 0.5 --orientations 2 -o $name
done
cp sky.pfm map_m1.pfm
expect 2 "map_m1.pfm: this file is read" bake environment map_m1.pfm --size 4 --levels 2 -o map.pfm
cmp -s map.pfm sky.pfm && cmp -s map_m1.pfm sky.pfm || fail "a map was written over"
expect 2 "w.ktx2: two outputs have the same name" bake environment sky.pfm --size 4 -o w.ktx2 --irradiance ./w.ktx2
expect 2 "two outputs have the same name" bake environment sky.pfm --size 4 --levels 1 -o w.exr --preview w.exr
expect 2 "w_m1.exr: two outputs" bake environment sky.pfm --size 4 --levels 2 -o w.exr --irradiance w_m1.exr
expect 2 "two outputs have the same name" bake environment sky.pfm --harmonics w.txt --harmonics "$PWD/w.txt"
for part in brdf sky "report sky.pfm"; do
    expect 2 "two outputs have the same name" bake $part -o w.exr -o w.exr
done
ls | grep -q '^w[._]' && fail "a refused command wrote a file: $(ls)"
expect 0 "texels" bake environment sky.pfm --size 4 --levels 2 -o both.exr -o both.pfm --roughness 0.5,1

# One output that cannot be written does not cost the others.
(trap '' XFSZ && ulimit -f 8 && exec "$montelux" bake environment sky.pfm --size 64 --levels 1 --roughness 1 --samples 2 \
    -o lost.exr --harmonics kept.json) >out 2>&1
[ $? -eq 1 ] || fail "a full disk: exit code is not 1: $(cat out)"
grep -q "montelux: error: lost.exr: cannot be written: writing: File too large" out || fail "a full disk: $(cat out)"
[ -e lost.exr ] && fail "a full disk left a file"
[ -s kept.json ] || fail "the output after a failed one was not written"

# The report.
expect 0 "split - full" bake report sky.pfm --roughness 0.3,1 --n-dot-v 0.5 --orientations 4 -o r.exr --sphere-size 8
expect 0 "16 x 24 pixels" info r.exr
expect 0 '"bias_error"' bake report sky.pfm --roughness 0.5 --orientations 2 --json
expect 2 "--roughness" bake report sky.pfm --roughness 0

# Stopped: nothing is written.
"$montelux" bake environment sky.pfm --size 1024 -o stopped.exr --target-error 1e-4 >out 2>&1 &
pid=$!
sleep 1
kill -INT $pid
wait $pid
[ $? -eq 130 ] || fail "an interrupted bake: exit code is not 130"
grep -q "interrupted, nothing was written" out || fail "no message that nothing was written: $(cat out)"
ls | grep -q '^\.\|stopped' && fail "an interrupted bake left a file: $(ls)"
finish
