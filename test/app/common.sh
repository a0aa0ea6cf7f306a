# What the tests of the command line program share: a scratch folder, `expect`, small scenes and pictures.
# Sourced with the program's path in $1; a test ends with `finish`.
set -u
montelux=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

finish() {
    [ $failures -eq 0 ]
    exit
}

# expect CODE TEXT arguments...: runs the program; its output and errors must contain TEXT.
expect() {
    code=$1 text=$2
    shift 2
    timeout 60 "$montelux" "$@" >out 2>&1 </dev/null
    got=$?
    if [ $got -ne "$code" ]; then
        fail "montelux $*: exit code $got instead of $code"
        cat out
    elif ! grep -qF -- "$text" out; then
        fail "montelux $*: '$text' is missing in:"
        cat out
    elif [ "$code" -eq 1 ] && [ "$(grep -c 'montelux: error: ' out)" -ne 1 ]; then
        fail "montelux $*: not exactly one error message"
        cat out
    fi
}

# scene NAME WORLD [WIDTH HEIGHT [SPP]]: NAME.pbrt, whose output is NAME.exr. The world begins in line 6.
scene() {
    printf '%s\n' "Film \"rgb\" \"integer xresolution\" ${3:-8} \"integer yresolution\" ${4:-6}" \
        "  \"string filename\" \"$1.exr\"" \
        "Sampler \"independent\" \"integer pixelsamples\" ${5:-4}" \
        'LookAt 0 0 4 0 0 0 0 1 0 Camera "perspective" "float fov" 40' \
        'WorldBegin' "$2" >"$1.pbrt"
}

# Colour PFM of WIDTH x HEIGHT pixels: pfm FILE WIDTH HEIGHT BYTES..., each BYTES a little-endian float in octal.
pfm() {
    file=$1 width=$2 height=$3
    shift 3
    printf 'PF\n%d %d\n-1\n' "$width" "$height" >"$file"
    for value; do printf "$value" >>"$file"; done
}
one='\000\000\200\077' minus_one='\000\000\200\277' not_a_number='\000\000\300\177' zero='\000\000\000\000'
sky='LightSource "infinite" "rgb L" [1 1 1]'

# Members of a glTF file: the positions of a triangle (accessor 0), and an animation of 2 s that moves node 0 by 5 along z.
gltf_triangle='"buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAoEA="}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                 {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
               {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR"},
               {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}]'
gltf_motion='"animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                 "samplers": [{"input": 1, "output": 2}]}]'
