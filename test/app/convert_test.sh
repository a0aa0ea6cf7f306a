#!/bin/sh
# convert, tone curves and exposures, info of scenes and textures: files, options, messages.
. "$(dirname "$0")/common.sh"
half='\000\000\000\077' bright='\000\000\172\104' dark='\254\305\047\067' # 0.5, 1000, 1e-5
scene ok "$sky Material \"diffuse\" Shape \"sphere\"" 16 12 4
expect 0 "ok.exr" render ok.pbrt -o ok.exr -o ok.png -o ok.jpg
[ "$(head -c 3 ok.jpg | od -An -tx1 | tr -d ' ')" = ffd8ff ] || fail "ok.jpg is no JPEG file"
grep -q "exposure" out && fail "a picture in a sensible range got another exposure"

# Pictures: formats and layers.
for end in exr png jpg hdr pfm; do expect 0 "c.$end: 16 x 12 pixels" convert ok.exr c.$end; done
cmp -s ok.png c.png || fail "convert and render give different PNG files"
cmp -s ok.jpg c.jpg || fail "convert and render give different JPEG files"
expect 0 "stderr.R" info c.exr
expect 0 "half.exr" convert ok.exr half.exr --half
[ "$(wc -c <half.exr)" -lt "$(wc -c <c.exr)" ] || fail "--half changes nothing"
for layer in mean error albedo normal depth samples stderr N; do expect 0 "l.png" convert ok.exr l.png --layer $layer; done
expect 0 "3 channels" info l.png
expect 1 "there is no layer 'albdo' (did you mean 'albedo'?); there are mean, " convert ok.exr x.png --layer albdo
grep -q "error" out || fail "the layer error is not listed"
expect 0 "l.exr" convert ok.exr l.exr --layer depth
expect 0 "1 channels" info l.exr
expect 1 "the extension '.gif'" convert ok.exr x.gif
expect 2 "OUT is required" convert ok.exr
expect 1 "none.exr: cannot be opened" convert none.exr x.png
expect 2 "montelux render" convert ok.pbrt x.png
[ -e x.png ] && fail "a failure left a picture"

# Tone curves: the picture changes with each.
for tone in linear srgb aces agx filmic; do
    expect 0 "t_$tone.png" convert ok.exr t_$tone.png --tone $tone
    for other in linear srgb aces agx filmic; do
        [ $other = $tone ] || ! cmp -s t_$tone.png t_$other.png || fail "--tone $tone and $other give one picture"
    done
done
expect 2 "one of linear, srgb, aces, agx, filmic is expected (did you mean 'agx'?)" convert ok.exr x.png --tone agxx
expect 2 "a number from -100 to 100 is expected, or auto" convert ok.exr x.png --exposure bright
expect 2 "'nan' was given" convert ok.exr x.png --exposure nan
expect 2 "--exposure: it is for .png and .jpg pictures; none is written" convert ok.exr x.exr --exposure 1
expect 2 "--tone: it is for .png and .jpg" render ok.pbrt -o x.exr --tone aces
expect 2 "--quality: it is for .jpg" convert ok.exr x.png --quality 50
expect 2 "--bits: it is for .png" convert ok.exr x.jpg --bits 16
expect 2 "8 or 16 is expected" convert ok.exr x.png --bits 10
expect 2 "a whole number from 1 to 100 is expected" convert ok.exr x.jpg --quality 0
expect 2 "--half: it is for .exr" convert ok.exr x.png --half
expect 0 "wide.png" convert ok.exr wide.png --bits 16
expect 0 "16-bit integer" info wide.png
expect 0 "low.jpg" convert ok.exr low.jpg --quality 5
[ "$(wc -c <low.jpg)" -lt "$(wc -c <c.jpg)" ] || fail "--quality changes nothing"
expect 0 "e.png" convert ok.exr e.png --exposure -2 --tone aces
expect 0 "exposure" convert ok.exr a.png --exposure auto

# Exposures that show what 0 would not, and pictures that show nothing.
pfm bright.pfm 2 1 "$bright" "$bright" "$bright" "$bright" "$bright" "$bright"
pfm dark.pfm 2 1 "$dark" "$dark" "$dark" "$dark" "$dark" "$dark"
pfm black.pfm 2 1 "$zero" "$zero" "$zero" "$zero" "$zero" "$zero"
pfm fine.pfm 2 1 "$half" "$half" "$half" "$one" "$one" "$one"
expect 0 "b.png: exposure -12.44 stops, at 0 100 % of the pixels are white" convert bright.pfm b.png
expect 0 "d.png: exposure +14.14 stops, at 0 100 % of the pixels are black" convert dark.pfm d.png
expect 0 '"mean": 0.46' info d.png --json
expect 0 "f.png" convert fine.pfm f.png
grep -q "exposure" out && fail "a picture in a sensible range got another exposure"
expect 0 "z.png: 100 % of the pixels are black; there is no light in the picture" convert black.pfm z.png
expect 0 "w.png: 100 % of the pixels are white; --exposure auto chooses -12.44 stops" convert bright.pfm w.png --exposure 0
"$montelux" convert bright.pfm q.png --quiet >out 2>&1
[ -s out ] && fail "--quiet prints: $(cat out)"
cmp -s b.png q.png || fail "--quiet changes the exposure"
# A film with an exposure of its own chooses it.
lamp='LightSource "infinite" "rgb L" [1000 1000 1000]'
scene lit "$lamp Shape \"sphere\"" 8 6 1
expect 0 "exposure -" render lit.pbrt -o lit.png
sed 's/"string filename"/"float iso" 50 "string filename"/' lit.pbrt >iso.pbrt
expect 0 "100 % of the pixels are white; --exposure auto chooses -" render iso.pbrt -o iso.png
expect 0 "level ground" bake sky --size 16 -o bright.png
grep -q "bright.png: exposure -" out || fail "bake sky: no exposure is chosen"

# Scenes.
scene full "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"rgb reflectance\" [0.9 0.1 0.1]
    NamedMaterial \"red\" $sky Shape \"loopsubdiv\" \"integer levels\" 4 \"point3 P\" [0 0 0 1 0 0 0 1 0 0 0 1]
    \"integer indices\" [0 2 1 0 1 3 1 2 3 0 3 2]" 16 12 4
mkdir other
expect 0 "other/again.pbrt: 1 shapes, 1 lights, 1 files in other/again-files" convert full.pbrt other/again.pbrt
expect 0 "full.exr" render full.pbrt -o full.pfm -o full.exr
expect 0 "again.pfm" render other/again.pbrt -o again.pfm
cmp -s full.pfm again.pfm || fail "the converted scene has another picture"
expect 2 "is read from" convert full.pbrt full.pbrt
expect 2 "is read from" convert other/again.pbrt other/again.pbrt
expect 2 "--layer: it is for pictures" convert full.pbrt x.pbrt --layer mean
expect 2 "--tone: it is for .png and .jpg" convert full.pbrt x.pbrt --tone aces
expect 1 "this is a PNG picture" convert ok.png x.pbrt
expect 1 "none/x.pbrt" convert full.pbrt none/x.pbrt
[ -e x.pbrt ] && fail "a failure left a scene"
[ "$(find . -name '.montelux*' | wc -l)" -eq 0 ] || fail "temporary files are left"

# A textured glTF model, of the studio: pbrt's syntax with extensions holds all that the picture needs.
cat >model.gltf <<'JSON'
{"asset": {"version": "2.0"},
 "buffers": [{"byteLength": 108, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAABAAAAAAAAAAAAAAABAAACAPwAAgD8AAIA/AACAPwAAAD8AAIA/AACAPgAAgD8AAIA/AAAAPwAAgD8AAIA/"}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24},
                 {"buffer": 0, "byteOffset": 60, "byteLength": 48}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
               {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
               {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC4"}],
 "images": [{"uri": "ok.png"}], "samplers": [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9729}],
 "textures": [{"source": 0, "sampler": 0}],
 "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1], "roughnessFactor": 0.5,
     "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"rotation": 0.5, "scale": [2, 3]}}},
     "metallicRoughnessTexture": {"index": 0}}, "normalTexture": {"index": 0, "scale": 0.5}, "alphaMode": "MASK"}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2}, "material": 0}]}],
 "nodes": [{"mesh": 0}], "extensionsUsed": ["KHR_texture_transform"]}
JSON
expect 0 "model.gltf has no camera and no lights: the studio is written with it" convert model.gltf model.pbrt
grep -q warning out && fail "converting a glTF model loses something: $(cat out)"
expect 0 "model.exr" render model.gltf --spp 4 --resolution 32x24 -o model.pfm -o model.exr
expect 0 "model.again" render model.pbrt --spp 4 --resolution 32x24 -o model.again.pfm
cmp -s model.pfm model.again.pfm || fail "the converted model has another picture"

# Info of scenes and textures.
expect 0 "shapes       1 triangle mesh" info full.pbrt
grep -q "lights       1 uniform sky" out || fail "info: no lights"
expect 0 '"primitives": 1024' info full.pbrt --json
expect 0 '"strategy": "mis"' info full.pbrt --json
cp full.pbrt noname && expect 0 "1024 primitives" info noname
pfm square.pfm 2 2 "$one" "$one" "$one" "$one" "$one" "$one" "$one" "$one" "$one" "$one" "$one" "$one"
expect 0 "texels" bake environment square.pfm --size 8 --levels 3 -o t.ktx2 -o t.ktx -o t.dds
expect 0 "KTX 2.0, 8 x 8 texels, 3 levels, 1 layer, 6 faces, R16G16B16A16_SFLOAT" info t.ktx2
grep -q "montelux.roughness" out || fail "info: no notes of the texture"
expect 0 "KTX 1.1, 8 x 8 texels, 3 levels, 1 layer, 6 faces, GL_RGBA16F" info t.ktx
expect 0 "DDS, 8 x 8 texels, 3 levels, 1 layer, 6 faces, " info t.dds
expect 0 '"faces": 6' info t.ktx2 --json
head -c 100 t.ktx2 >cut.ktx2
expect 1 "ends early" info cut.ktx2
expect 0 "--tone" convert --help
finish
