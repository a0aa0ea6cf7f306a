#!/bin/sh
# Sequences: the frames of animations and turntables, what is skipped, and what an interruption leaves.
. "$(dirname "$0")/common.sh"

# A triangle that emits and moves by 5 along z within 2 s; no camera.
cat >moving.gltf <<JSON
{"asset": {"version": "2.0"},
 $gltf_triangle,
 "materials": [{"emissiveFactor": [1, 0, 0]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
 "nodes": [{"mesh": 0}],
 $gltf_motion}
JSON
small='--resolution 32x24 --spp 2'

# Frame n is the scene at (n - 1) / rate, under the camera of the whole animation.
expect 0 "out.0003.png, out.0003.pfm: 32 x 24 pixels" render moving.gltf $small --frames 1-5x2 --frame-rate 2 -o out.png -o out.pfm
ls out.0*.p* | tr '\n' ' ' | grep -qF "out.0001.pfm out.0001.png out.0003.pfm out.0003.png out.0005.pfm out.0005.png" ||
    fail "other files than those of 1, 3 and 5: $(ls)"
cmp -s out.0001.pfm out.0003.pfm && fail "nothing moves between frames"
sed 's/"nodes": \[/"cameras": [{"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 2, "zfar": 9, "znear": 0}}],\n "nodes": [{"camera": 0, "rotation": [0, 0.38268343, 0, 0.92387953], "translation": [6, 0.5, 7]}, /; s/"node": 0/"node": 1/' moving.gltf >framed.gltf
expect 0 "still.pfm" render framed.gltf $small --time-of-scene 0.5 -o still.pfm
expect 0 "film.0004.pfm" render framed.gltf $small --frames 4 --frame-rate 6 -o film.pfm
cmp -s still.pfm film.0004.pfm || fail "frame 4 at 6 frames per second is not the scene at 0.5 s"
expect 0 "the animation ends at 2 s; frame 60 and those behind it show its end" render framed.gltf $small --frames 60 -o film.pfm

# The shutter: none, seconds, and an angle of the time of a frame.
blur() {
    name=$1
    shift
    expect 0 "$name" render framed.gltf $small --time-of-scene 0.5 -o "$name" "$@"
}
blur none.pfm --shutter 0
cmp -s still.pfm none.pfm || fail "--shutter 0 is not a still"
blur blur.pfm --shutter 0.25s
cmp -s still.pfm blur.pfm && fail "--shutter has no effect"
blur angle.pfm --shutter 180deg --frame-rate 2
cmp -s blur.pfm angle.pfm || fail "180 degrees of a frame of 0.5 s are not 0.25 s"
expect 0 "film.0004.pfm: 32 x 24" render framed.gltf $small --frames 4 --frame-rate 6 --shutter 0.25 -o film.pfm
cmp -s blur.pfm film.0004.pfm || fail "a blurred frame is not the scene at 0.5 s with that shutter"

# Finished frames are skipped: of these settings, and with these bytes.
cp out.0001.png before.png
expect 0 "finished before and skipped: frames 1,3 (out.frames)" render moving.gltf $small --frames 1,3 --frame-rate 2 -o out.png -o out.pfm
grep -q "pixels" out && fail "a finished frame was rendered: $(cat out)"
rm out.0003.pfm
printf x >>out.0005.png
expect 0 "skipped: frames 1 (" render moving.gltf $small --frames 1-5x2 --frame-rate 2 -o out.png -o out.pfm
[ "$(grep -c pixels out)" -eq 2 ] || fail "a lost and a damaged file: $(cat out)"
expect 0 "out.0001.png, out.0001.pfm: 32 x 24 pixels, 3 samples" render moving.gltf --resolution 32x24 --spp 3 --frames 1 --frame-rate 2 -o out.png -o out.pfm
for change in '--seed 7' '--tone aces' '--exposure 1' '--layers default,uv' '--frame-rate 3 --time 60' '--background white'; do
    expect 0 "out.0002.png: 32 x 24" render moving.gltf $small --frames 2 $change -o out.png
done
expect 0 "out.0002.png: 32 x 24" render moving.gltf $small --frames 2 -o out.png
expect 0 "skipped: frames 2" render moving.gltf $small --frames 2 -o out.png
sed 's/\[1, 0, 0\]/[0, 1, 0]/' moving.gltf >red.gltf && mv red.gltf moving.gltf
expect 0 "out.0002.png: 32 x 24" render moving.gltf $small --frames 2 -o out.png
# The folder can be moved; lines of a log that someone edited are left out.
mkdir old && expect 0 "old/out.0002.png" render moving.gltf $small --frames 2 -o old/out.png && mv old new
expect 0 "skipped: frames 2 (new/out.frames)" render moving.gltf $small --frames 2 -o new/out.png
printf 'montelux frames 1\nnonsense\n0 0 0\n' >new/out.frames
expect 0 "new/out.0002.png: 32 x 24" render moving.gltf $small --frames 2 -o new/out.png
echo "a diary" >diary.frames
expect 1 "diary.frames: the finished frames are kept in a file of this name" render moving.gltf $small --frames 2 -o diary.png
[ -e diary.0002.png ] && fail "a frame was rendered beside another file's log"

# A turntable: all formats; its first frame is the picture without it, and half a turn later two are opposite.
printf 'v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 2 0\nf 1 2 3 4\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n' >tent.obj
expect 0 "tent.obj has no camera" render tent.obj $small --turntable 4 -o turn.pfm
expect 0 "" render tent.obj $small -o tent.pfm
cmp -s tent.pfm turn.0001.pfm || fail "the first frame of a turntable is turned"
expect 0 "" render tent.obj $small --orbit 215,18 -o back.pfm
expect 0 "RMSE" compare back.pfm turn.0003.pfm
sed -n 's/.*RMSE \([0-9.e-]*\),.*/\1/p' out | head -n 1 | awk '{ exit !($1 < 0.01) }' || fail "half a turn: $(cat out)"
[ -e turn.0005.pfm ] && fail "a turntable of 4 frames has a fifth"
expect 0 "skipped: frames 2-3" render tent.obj $small --turntable 4 --frames 2-3 -o turn.pfm
# Each frame chooses its integrator, and is found again.
expect 0 "montelux: integrator path: " render tent.obj --resolution 32x24 --spp 8 --turntable 2 --integrator auto -o chosen.exr
[ "$(grep -c "montelux: integrator path: " out)" -eq 2 ] || fail "not both frames chose an integrator: $(cat out)"
expect 0 "skipped: frames 1-2" render tent.obj --resolution 32x24 --spp 8 --turntable 2 --integrator auto -o chosen.exr
expect 0 "target reached" render tent.obj --resolution 32x24 --max-spp 256 --target-error 50% --turntable 1 -o turn.exr
expect 3 "samples are used up before the target was reached" render tent.obj --resolution 32x24 --max-spp 2 --target-error 0.01% --turntable 2 -o never.exr
[ -e never.0002.exr ] || fail "a frame that missed its target ended the sequence"
scene ball "$sky Shape \"sphere\" Translate 1 0 0 Shape \"sphere\" \"float radius\" 0.5"
expect 0 "ball.0002.exr" render ball.pbrt --turntable 2
cp ball.0002.exr second.exr
expect 0 "ball.exr" render ball.pbrt
"$montelux" compare second.exr ball.exr >out 2>&1
grep -q "RMSE 0," out && fail "the camera of a pbrt scene does not turn"

# An interruption keeps whole frames only.
"$montelux" render tent.obj --resolution 64x48 --spp 40000 --turntable 3 -o slow.exr >out 2>&1 &
pid=$!
(sleep 60 && kill -KILL $pid 2>/dev/null) >/dev/null 2>&1 &
watchdog=$!
sleep 1
kill -INT $pid
wait $pid
code=$?
kill $watchdog 2>/dev/null
[ $code -eq 130 ] || fail "an interrupted sequence: exit code $code instead of 130: $(cat out)"
grep -q "interrupted: 0 of 3 frames are finished; the same command renders the others" out || fail "$(cat out)"
ls -A | grep -q 'slow\|montelux-' && fail "an interrupted frame left something: $(ls -A)"

# Obvious mistakes.
expect 1 "ball.pbrt: only glTF scenes have a time of animations" render ball.pbrt --frames 1-4
sed '/"animations"/,$d; s/"nodes": \[{"mesh": 0}\],/"nodes": [{"mesh": 0}]}/' moving.gltf >rest.gltf
expect 2 "--frames: rest.gltf has no animation; --turntable N takes the camera around it" render rest.gltf --frames 1-4
for list in 0 3-1 1- 1-4x 1-4x0 1,,2 1-1000001 one 1-4y2 -3 ' 1'; do
    expect 2 "--frames: '$list' was given; frames from 1 to 1000000 are expected" render moving.gltf "--frames=$list"
done
expect 2 "--shutter: expected --time-of-scene TIME, when it opens, or --frames" render moving.gltf --shutter 1
expect 2 "--shutter: '361deg' was given; an angle from 0deg to 360deg is expected" render moving.gltf --frames 1 --shutter 361deg
expect 2 "--shutter: '-1' was given" render moving.gltf --frames 1 --shutter=-1
expect 2 "--shutter: 'long' was given" render moving.gltf --frames 1 --shutter long
expect 2 "--frames: there is no frame 5; the turntable has 4" render tent.obj --turntable 4 --frames 1-5
expect 2 "--turntable: '0' was given" render tent.obj --turntable 0
expect 2 "--frame-rate: '0' was given" render moving.gltf --frames 1 --frame-rate 0
expect 2 "--checkpoint: a sequence has no checkpoint: it skips frames that are finished" render tent.obj --turntable 4 --checkpoint a
expect 2 "--resume: a sequence has no checkpoint" render tent.obj --turntable 4 --resume
expect 2 "--debug-sample: it replays a sample of one picture" render tent.obj --turntable 4 --debug-sample 1,1,0
expect 2 "--time-of-scene: the frames of --frames have times of their own" render moving.gltf --frames 1 --time-of-scene 1
pfm map.0001.pfm 2 1 $one $one $one $one $one $one
expect 2 "map.0001.pfm: the scene is read from this file" render tent.obj --turntable 1 --environment map.0001.pfm -o map.pfm
finish
