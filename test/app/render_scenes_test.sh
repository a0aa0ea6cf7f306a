#!/bin/sh
# Scenes that are invalid, and valid ones that are unusual.
. "$(dirname "$0")/common.sh"

# broken TEXT WORLD: rendering must end with TEXT and leave no picture.
broken() {
    rm -f broken.exr
    scene broken "$sky
$2"
    expect 1 "$1" render broken.pbrt
    [ -e broken.exr ] && fail "a picture of a broken scene was written"
}
broken "broken.pbrt:7:35: there is no file 'no.png'" 'Texture "t" "spectrum" "imagemap" "string filename" "no.png"
Material "diffuse" "texture reflectance" "t" Shape "sphere"'
broken "unknown shape 'spere' (did you mean 'sphere'?)" 'Shape "spere"'
broken "unknown directive 'Shap'" 'Shap "sphere"'
broken "broken.pbrt:7:16: parameter 'radius' has type integer; expected float" 'Shape "sphere" "integer radius" 1'
broken "triangle 0 refers to vertex 7" 'Shape "trianglemesh" "integer indices" [0 1 7] "point3 P" [0 0 0 1 0 0 0 1 0]'
broken "expected a number, read 'nan'" 'Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [0 0 nan 1 0 0 0 1 0]'
broken "this AttributeBegin has no AttributeEnd" 'AttributeBegin'
broken "AttributeEnd without AttributeBegin" 'AttributeEnd'
broken "'broken.pbrt' includes itself" 'Include "broken.pbrt"'
broken "'broken.pbrt' includes itself" 'Import "broken.pbrt"'
printf 'Include "b.pbrt"' >a.pbrt
printf 'Include "a.pbrt"' >b.pbrt
expect 1 "b.pbrt:1:1: 'a.pbrt' includes itself" render a.pbrt
printf 'Include "z.pbrt.gz"' | gzip >z.pbrt.gz
expect 1 "includes itself" render z.pbrt.gz

film() {
    scene film "" "$1" "$2" "$3"
    expect 1 "$4" render film.pbrt
}
film 0 6 4 "parameter 'xresolution' is 0"
film 8 -6 4 "parameter 'yresolution' is -6"
film 99999999 6 4 "expected 1 to 65536 pixels"
film 99999999999 6 4 "too large for a 32-bit integer"
film 65536 65536 4 "GiB of memory"
film 8 6 0 "parameter 'pixelsamples' is 0"
film 8 6 -4 "parameter 'pixelsamples' is -4"

printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >good.ply
mesh='Shape "plymesh" "string filename" "bad.ply"'
for length in 0 3 60 150 175 176; do
    head -c $length good.ply >bad.ply
    broken "broken.pbrt:7:17: bad.ply" "$mesh"
done
sed 's/3 0 1 2/3 0 1 9/' good.ply >bad.ply
broken "refers to vertex 9; the file has 3 vertices" "$mesh"
sed 's/1 0 0/1 0 nan/' good.ply >bad.ply
broken "bad.ply:11: expected a number" "$mesh"
sed 's/vertex 3/vertex 4000000000/' good.ply >bad.ply
broken "more than the file can hold" "$mesh"
sed 's/face 1/face 1000000000000/' good.ply >bad.ply
broken "more than the file can hold" "$mesh"
gzip -c good.ply | head -c 60 >bad.ply.gz
broken "the gzip data ends early" 'Shape "plymesh" "string filename" "bad.ply.gz"'

: >empty.pbrt
expect 1 "empty.pbrt: the file is empty" render empty.pbrt
expect 1 "missing.pbrt: cannot be opened" render missing.pbrt
expect 1 "it is a folder" render .
expect 1 "this is a program; pbrt-v4, glTF 2.0, Mitsuba 3, OBJ, PLY and STL are read" render "$montelux"
expect 1 "cannot be opened" render ''

# Unusual, but valid.
scene none 'Shape "sphere"'
expect 0 "none.pbrt:7:1: the scene has no light; its picture is black" render none.pbrt
printf 'WorldBegin\n' >bare.pbrt
expect 0 "bare.exr: 8 x 6 pixels" render bare.pbrt --resolution 8x6 --spp 1
scene ok "$sky Material \"diffuse\" Shape \"sphere\""
expect 0 "ok.exr" render ok.pbrt -o ok.pfm -o ok.exr
same() { cmp -s ok.pfm same.pfm || fail "$1: the picture is another one"; }
gzip -k ok.pbrt
expect 0 "" render ok.pbrt.gz -o same.pfm && same "gzip"
sed 's/$/\r/' ok.pbrt >crlf.pbrt
expect 0 "" render crlf.pbrt -o same.pfm && same "CR LF"
(printf '\357\273\277' && cat ok.pbrt) >bom.pbrt
expect 0 "" render bom.pbrt -o same.pfm && same "byte order mark"
mkdir -p 'a ü/deep'
sed 's/Shape "sphere"/Include "ball.pbrt"/' ok.pbrt >'a ü/main.pbrt'
printf 'Shape "sphere"' >'a ü/ball.pbrt'
(cd 'a ü/deep' && "$montelux" render ../main.pbrt -o '../ö .pfm' --quiet) || fail "relative paths"
cp 'a ü/ö .pfm' same.pfm && same "a file beside the scene"

# Each warning is printed once.
scene warned 'Shape "sphere" "float raduis" 2 Shape "sphere" "float raduis" 2'
expect 0 "did you mean 'radius'?" render warned.pbrt
[ "$(grep -c raduis out)" -eq 1 ] || fail "a warning was printed twice"
finish
