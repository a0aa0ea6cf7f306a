#!/bin/sh
# Models by themselves: the studio, and the options that change it for every scene.
. "$(dirname "$0")/common.sh"
printf 'v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 2 0\nf 1 2 3 4\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n' >tent.obj
small='--resolution 32x24 --spp 8'

expect 0 "montelux: tent.obj has no camera and no lights: a studio was added (--environment, --orbit, --ground, --background change it)" \
    render tent.obj $small -o tent.exr -o tent.png
expect 0 "32 x 24 pixels, 8 samples per pixel" render tent.obj $small -o tent.exr
expect 0 '"background"' info tent.exr
"$montelux" render tent.obj $small -o quiet.exr --quiet >out 2>&1
[ -s out ] && fail "--quiet: $(cat out)"
expect 0 "RMSE 0, relMSE 0 " compare quiet.exr tent.exr
expect 0 "tent.exr: 800 x 600 pixels" render tent.obj --spp 1
expect 0 "tent.obj has no camera: a studio" render tent.obj $small --environment none -o dark.exr
"$montelux" info dark.exr --json | grep -q '"maximum": 0' || fail "a scene without light is not black"

# A camera from elsewhere, another distance, no ground.
for options in '--orbit 120,10' '--orbit 35,18,2' '--ground off'; do
    expect 0 "tent.exr" render tent.obj $small $options -o other.exr -o tent.exr
    cmp -s other.exr quiet.exr && fail "$options has no effect"
done
expect 0 "" render tent.obj $small --orbit 35,18,1 -o other.exr
expect 0 "RMSE 0, relMSE 0 " compare other.exr quiet.exr
# An elevation below 0 is an argument of its own.
expect 0 "" render tent.obj $small --orbit -35,-10 --ground off -o other.exr

# The background: exact, and not seen by the light.
corner='--crop 0,0.1,0,0.1 --ground off'
expect 0 "" render tent.obj $small $corner --background '#4080ff' -o blue.png
expect 0 '"minimum": 0.25098' info blue.png --json
expect 0 "" render tent.obj $small $corner --background 0.25,0.5,3 -o linear.exr
expect 0 '"minimum": 3.0' info linear.exr --json
expect 0 '"maximum": 0.25' info linear.exr --json
for name in black grey white; do
    expect 0 "" render tent.obj $small --ground off --background $name --checkpoint $name.state -o $name.exr
done
expect 1 "the integrator differs" render tent.obj $small --ground off --background black --checkpoint white.state --resume -o x.exr
expect 0 "" render tent.obj $small --ground off --background white --checkpoint white.state --resume -o x.exr
expect 0 "RMSE 0, relMSE 0 " compare x.exr white.exr
expect 0 "" render tent.obj $small --ground off --background transparent -o clear.png -o clear.exr -o clear.pfm
expect 0 "4 channels, 8-bit" info clear.png
expect 0 "A " info clear.exr
expect 0 "3 channels" info clear.pfm

# Every format: a pbrt scene changes only as the options say.
scene ball "$sky Shape \"sphere\""
expect 0 "" render ball.pbrt -o ball.exr
grep -q studio out && fail "a pbrt scene got a studio"
expect 0 "" render ball.pbrt --background black -o black.exr
expect 0 "" render ball.pbrt --orbit 0,0 --ground on -o orbit.exr
cp ball.exr map.exr
expect 1 "8 x 6 pixels; an environment map must be square" render ball.pbrt --environment map.exr -o x.exr
pfm sky.pfm 2 1 $one $zero $zero $one $zero $zero
expect 0 "" render ball.pbrt --environment sky.pfm -o red.exr
expect 2 "sky.pfm: the scene is read from this file" render ball.pbrt --environment sky.pfm -o sky.pfm
scene dark 'Shape "sphere"'
expect 0 "dark.pbrt:7:1: the scene has no light; its picture is black" render dark.pbrt
expect 0 "" render dark.pbrt --environment sky.pfm

# Obvious mistakes.
expect 2 "--orbit: '90' was given; expected AZ,EL or AZ,EL,DIST" render tent.obj --orbit 90
expect 2 "--orbit: '90,100' was given" render tent.obj --orbit 90,100
expect 2 "--orbit: '90,10,0' was given" render tent.obj --orbit 90,10,0
expect 2 "--orbit: '90,10,1,1' was given" render tent.obj --orbit 90,10,1,1
expect 2 "--orbit: 'front' was given" render tent.obj --orbit front
expect 2 "--ground: 'yes' was given; on or off is expected" render tent.obj --ground yes
expect 2 "--background: 'redish' was given; expected transparent, black, grey, white, #rrggbb" render tent.obj --background redish
expect 2 "--background: '#12345' was given" render tent.obj --background '#12345'
expect 2 "--background: '1,2' was given" render tent.obj --background 1,2
expect 2 "--background: '1,-2,0' was given" render tent.obj --background 1,-2,0
expect 1 "nowhere.hdr" render tent.obj --environment nowhere.hdr
expect 2 "--environment" render tent.obj --environment ''
printf 'v 0 0 0\nv 1 0 0\nf 1 2 3\n' >broken.obj
expect 1 "broken.obj:3: the face refers to vertex 3; there are 2 so far" render broken.obj
printf 'v 0 0 0\nv 1 0 0\n' >empty.obj
expect 1 "empty.obj: the file has no faces" render empty.obj
printf '#usda 1.0\n' >model.usda
expect 1 "model.usda: this is a USD scene (text); pbrt-v4, glTF 2.0, Mitsuba 3, OBJ, PLY and STL are read" render model.usda

# Materials and what is missing of them.
mkdir models
printf '%s\n' 'newmtl red' 'Kd 1 0 0' 'map_Kd C:\textures\brick.png' 'newmtl lamp' 'Ke 5 5 5' >models/m.mtl
(printf 'mtllib m.mtl\nmtllib other.mtl\n' && sed 's/^f 1 2 3 4/usemtl red\n&/; s/^f 2 5 3/usemtl lost\n&/' tent.obj) >models/red.obj
expect 0 "models/red.obj:2: there is no file 'other.mtl' in the folder of the OBJ file" render models/red.obj $small -o red.exr
expect 0 "models/m.mtl:3: there is no picture 'C:\\textures\\brick.png' in the folder" render models/red.obj $small -o red.exr
expect 0 "models/red.obj:12: no MTL file has the material 'lost'" render models/red.obj $small -o red.exr
(printf 'mtllib models/m.mtl\n' && sed 's/^f 1 2 3 4/usemtl lamp\n&/' tent.obj) >lamp.obj
expect 0 "lamp.obj has no camera: a studio was added" render lamp.obj $small -o lamp.exr
finish
