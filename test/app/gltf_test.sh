#!/bin/sh
# glTF scenes from the command line: the choice of a camera, of a variant and of a time.
. "$(dirname "$0")/common.sh"

# A triangle that emits, two cameras, an animation of 2 s that moves the triangle by 5 along z.
cat >scene.gltf <<JSON
{"asset": {"version": "2.0"},
 $gltf_triangle,
 "materials": [{"emissiveFactor": [1, 0, 0]}, {"emissiveFactor": [0, 1, 0]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0, "extensions": {
     "KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}}]}],
 "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1, "aspectRatio": 2}},
             {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 9, "znear": 0}}],
 "nodes": [{"mesh": 0}, {"camera": 0, "name": "front", "translation": [0.3, 0.3, 1]},
           {"camera": 1, "name": "plan", "translation": [0, 0, 2]}],
 $gltf_motion,
 "extensions": {"KHR_materials_variants": {"variants": [{"name": "green"}]}}}
JSON

shot() {
    name=$1
    shift
    expect 0 "$name" render scene.gltf --spp 4 -o "$name" "$@"
}
shot front.pfm --resolution 32x16
shot again.pfm --resolution 32x16 --camera 0
cmp -s front.pfm again.pfm || fail "camera 0 is not the first one"
shot plan.pfm --resolution 32x16 --camera plan
cmp -s front.pfm plan.pfm && fail "--camera has no effect"
shot green.pfm --resolution 32x16 --variant green
cmp -s front.pfm green.pfm && fail "--variant has no effect"
shot later.pfm --resolution 32x16 --time-of-scene 1s
cmp -s front.pfm later.pfm && fail "--time-of-scene has no effect"
shot film.exr --camera front
expect 0 "800 x 400" info film.exr

expect 1 "scene.gltf: there is no camera 'plam' (did you mean 'plan'?); expected 0 'front', 1 'plan'" render scene.gltf --camera plam
expect 1 "scene.gltf: there is no variant 'gren' (did you mean 'green'?); expected 'green'" render scene.gltf --variant gren
expect 2 "--time-of-scene: 'soon' was given" render scene.gltf --time-of-scene soon
scene old "$sky Shape \"sphere\""
expect 1 "old.pbrt: only glTF and Mitsuba scenes have a choice of cameras" render old.pbrt --camera 0
sed 's/"POSITION": 0/"POSITION": 7/' scene.gltf >broken.gltf
expect 1 "broken.gltf: /meshes/0/primitives/0/attributes/POSITION: accessor 7 does not exist (there are 3)" render broken.gltf
finish
