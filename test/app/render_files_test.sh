#!/bin/sh
# Pictures in and out of the render command.
. "$(dirname "$0")/common.sh"
scene ok "$sky Shape \"sphere\""

# Outputs are checked before the render: this one would take hours.
scene long "$sky Shape \"sphere\"" 2000 2000 1000000
expect 1 "nowhere/x.exr: cannot be written" render long.pbrt -o nowhere/x.exr
expect 1 "cannot be written" render long.pbrt -o long.pbrt/x.exr
mkdir folder.exr
expect 1 "it is a folder" render long.pbrt -o folder.exr
expect 1 "the extension '.gif' is not one of .exr, .png, .jpg, .hdr, .pfm" render long.pbrt -o x.gif
expect 1 "the extension '.pbrt'" render long.pbrt -o long.pbrt
expect 1 "the name has no extension" render long.pbrt -o x
expect 1 "the name has no extension" render long.pbrt -o ''
long_name=$(printf 'x%.0s' $(seq 252)) # with .exr it has a letter too many
expect 1 "File name too long" render long.pbrt -o $long_name.exr
expect 1 "File name too long" render long.pbrt -o x.exr --checkpoint ${long_name%xxxxxxx} # too long with .previous
expect 1 "no files can be made in the folder '/proc'" render long.pbrt -o /proc/x.exr
expect 1 "it is a folder" render long.pbrt -o x.exr --checkpoint folder.exr
mkdir locked && chmod 500 locked
if [ "$(id -u)" -ne 0 ]; then expect 1 "Permission denied" render long.pbrt -o locked/x.exr; fi

# A file that is not a scene: the message names its kind.
expect 0 "8 x 6 pixels" render ok.pbrt -o picture.exr --checkpoint ok.state
expect 1 "picture.exr: this is an OpenEXR picture; pbrt-v4, glTF 2.0, Mitsuba 3, OBJ, PLY and STL are read" render picture.exr
expect 1 "ok.state: this is a checkpoint of Montelux; pbrt-v4, glTF 2.0, Mitsuba 3, OBJ, PLY and STL are read: give the scene itself" render ok.state
printf '<?xml version="1.0"?>\n<COLLADA version="1.4.1"/>' >scene.xml
expect 1 "scene.xml: this is a COLLADA scene; pbrt-v4" render scene.xml
cp ok.pbrt 'any name'
expect 0 "8 x 6 pixels" render 'any name' -o picture.exr

# A full disk leaves the older file as it was, and nothing else.
printf 'old' >limited.exr
(trap '' XFSZ && ulimit -f 1 && "$montelux" render ok.pbrt --resolution 300x200 -o limited.exr >out 2>&1)
[ $? -eq 1 ] || fail "a full disk: exit code is not 1"
[ "$(cat limited.exr)" = old ] || fail "a full disk: the older file is damaged"
grep -q "limited.exr: cannot be written: writing: File too large" out || fail "a full disk: $(cat out)"
# The outputs after it are written.
(trap '' XFSZ && ulimit -f 800 && "$montelux" render ok.pbrt --resolution 300x200 -o limited.exr -o small.png \
    -o big.pfm -o small.hdr >out 2>&1)
[ $? -eq 1 ] || fail "a full disk: exit code is not 1"
[ "$(grep -c 'montelux: error: ' out)" -eq 1 ] || fail "a full disk: not one error: $(cat out)"
grep -q "error: limited.exr: .*File too large; big.pfm: .*File too large" out || fail "a full disk: $(cat out)"
grep -q '^limited.exr: 300' out && fail "a file that was not written is reported as written: $(cat out)"
expect 0 "300 x 200 pixels" info small.png
expect 0 "300 x 200 pixels" info small.hdr
find . -name '.montelux-*' | grep -q . && fail "a temporary file was left behind"
"$montelux" render ok.pbrt >/dev/full 2>err && fail "a full disk behind standard output went unnoticed"
# Messages must not get into a picture that is opened while the standard streams are closed.
"$montelux" render ok.pbrt -o closed.exr >&- 2>&- <&-
expect 0 "8 x 6 pixels" info closed.exr
# A closed reader of the messages does not stop the render.
rm -f ok.exr
"$montelux" render ok.pbrt --spp 64 2>&1 | true
[ -e ok.exr ] || fail "a closed pipe stopped the render"

# with KIND FILE: a scene with the picture as texture or as environment.
with() {
    if [ "$1" = texture ]; then
        scene picture "$sky
Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"$2\"
Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\""
    else
        scene picture "LightSource \"infinite\" \"string filename\" \"$2\" Shape \"sphere\""
    fi
}
pfm one.pfm 1 1 "$one" "$one" "$one"
pfm wide.pfm 3 1 "$one" "$one" "$one" "$one" "$one" "$one" "$one" "$one" "$one"
pfm negative.pfm 1 1 "$one" "$one" "$minus_one"
pfm nan.pfm 1 1 "$one" "$one" "$not_a_number"
pfm black.pfm 1 1 "$zero" "$zero" "$zero"
printf 'Pf\n1 1\n-1\n\000\000\200\077' >grey.pfm
for kind in texture environment; do
    for file in one grey; do
        with $kind $file.pfm
        expect 0 "picture.exr" render picture.pbrt
    done
done
with environment wide.pfm
expect 1 "an environment map must be square" render picture.pbrt
with environment negative.pfm
expect 0 "negative.pfm has negative pixels; they count as 0" render picture.pbrt
with environment nan.pfm
expect 1 "nan.pfm has a pixel that is not finite" render picture.pbrt
with environment black.pfm
expect 0 "black.pfm is black; the light gives nothing" render picture.pbrt
with texture nan.pfm
expect 0 "nan.pfm has 1 values that are not finite; they count as 0" render picture.pbrt
# A grey map is a white one.
with environment one.pfm
expect 0 "" render picture.pbrt -o a.pfm
with environment grey.pfm
expect 0 "" render picture.pbrt -o b.pfm
cmp -s a.pfm b.pfm || fail "a grey environment is not a white one"

# The picture must not overwrite files of the scene.
with texture one.pfm
expect 2 "one.pfm: the scene is read from this file" render picture.pbrt -o one.pfm
expect 0 "1 x 1 pixels" info one.pfm
finish
