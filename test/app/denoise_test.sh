#!/bin/sh
# Denoising: messages without the library; file contents with it.
. "$(dirname "$0")/common.sh"
scene ok "$sky Material \"diffuse\" Shape \"sphere\"" 32 24 4
scene long "$sky Shape \"sphere\"" 2000 2000 1000000
expect 0 "ok.exr" render ok.pbrt

# Without the library: an error before the render, which would take hours, and no file.
(
    MONTELUX_OIDN_LIBRARY=$folder/no.so
    export MONTELUX_OIDN_LIBRARY
    expect 1 "MONTELUX_OIDN_LIBRARY: Open Image Denoise cannot be loaded from '$folder/no.so'" \
        render long.pbrt --denoise -o long.exr
    expect 1 "cannot be loaded" denoise ok.exr -o denoised.exr
    echo text >no.so
    expect 1 "cannot be loaded" denoise ok.exr -o denoised.exr
    MONTELUX_OIDN_LIBRARY=libm.so.6
    expect 1 "this is not Open Image Denoise 1.4 or newer: it has no function oidnNewDevice" \
        denoise ok.exr -o denoised.exr
    [ -e long.exr ] || [ -e denoised.exr ] && fail "a picture was written without the library"
    exit $failures
)
failures=$((failures + $?))
expect 2 "--output is required" denoise ok.exr
expect 2 "--threads" denoise ok.exr -o x.exr --threads -1
expect 1 "the extension '.gif'" denoise ok.exr -o x.gif
expect 0 "MONTELUX_OIDN_LIBRARY" denoise --help
expect 0 "--denoise" render --help

if ! "$montelux" denoise ok.exr -o denoised.exr --quiet 2>err; then
    grep -q "pip install pyoidn" err || fail "the message does not say how to get the library: $(cat err)"
    rm -f denoised.exr
    [ $failures -ne 0 ] || { cat err && exit 77; }
    finish
fi

expect 0 "denoised by Open Image Denoise" render ok.pbrt --denoise -o both.exr -o both.pfm -o both.png
grep -q "the error bars are those of the picture before denoising" out || fail "no message about the error bars"
expect 0 '"denoiser" = "Open Image Denoise' info both.exr
for channel in R stderr.R albedo.R N.X denoised.R denoised.G denoised.B; do
    grep -q "^$channel " out || fail "both.exr lacks the channel $channel"
done
# The layers of the render are those of a render without the option.
channels() { "$montelux" info "$1" | grep -E '^(R|G|B|stderr\.[RGB]|albedo\.[RGB]|N\.[XYZ]|samples) '; }
[ "$(channels both.exr)" = "$(channels ok.exr)" ] || fail "denoising changed other layers"

# The other formats show the denoised picture, the same as from the command denoise, on any number of threads.
expect 0 "with albedo and normal" denoise ok.exr -o later.pfm -o later.png -o later.exr --threads 1
cmp -s both.pfm later.pfm || fail "render --denoise and denoise give different pictures"
cmp -s both.png later.png || fail "render --denoise and denoise give different pictures"
expect 0 "ok" render ok.pbrt -o ok.pfm
cmp -s both.pfm ok.pfm && fail "the picture was not denoised"
# The layer is compared and converted as others are.
expect 0 'RMSE' compare both.exr ok.exr --layer-a denoised
grep -q '^A  both.exr  (no standard errors)' out || fail "errors of the denoised layer: $(cat out)"
expect 1 "there is no layer 'denoised'" compare both.exr ok.exr --layer-b denoised
"$montelux" convert both.exr layer.pfm --layer denoised >out 2>&1 || fail "convert --layer denoised: $(cat out)"
cmp -s layer.pfm both.pfm || fail "the layer denoised is not what other formats show"
"$montelux" convert both.exr raw.pfm --layer mean >out 2>&1 && cmp -s raw.pfm ok.pfm || fail "the mean changed"
expect 0 "later.exr" denoise later.exr -o later.exr
expect 0 "32 x 24 pixels" info later.exr
[ "$(grep -c '^denoised\.' out)" -eq 3 ] || fail "denoising twice doubles the layers"
expect 0 "without albedo and normal" denoise ok.pfm -o bare.pfm
pfm nan.pfm 2 1 "$not_a_number" "$one" "$one" "$one" "$one" "$one"
expect 0 "1 pixels have a colour, albedo or normal that is not a number or infinite" denoise nan.pfm -o filled.exr
printf 'Pf\n1 1\n-1\n\000\000\200\077' >grey.pfm
expect 1 "needs the channels R, G and B, but there are Y" denoise grey.pfm -o x.exr
# A render that is stopped is saved at once, as it is.
"$montelux" render long.pbrt --denoise -o stopped.exr >out 2>&1 &
pid=$!
sleep 2
kill -INT $pid
wait $pid
[ $? -eq 130 ] || fail "an interrupted render: exit code is not 130"
grep -q "stopped before the end, not denoised" out || fail "no message that the picture is not denoised: $(cat out)"
finish
