#!/bin/sh
# Damaged pictures and models of other projects: damaged_files_test.sh path/to/montelux path/to/shared
bad=$2/bad
if [ ! -d "$bad" ]; then
    echo "$bad is absent: skipped"
    exit 77
fi
. "$(dirname "$0")/common.sh"

# attempt WORLD: a picture or one sentence, in 10 s and, where no sanitizer reserves address space, 1.5 GiB.
attempt() {
    scene attempt "$1"
    (
        nm -D "$montelux" 2>/dev/null | grep -q __asan || ulimit -v 1572864
        timeout -s KILL 10 "$montelux" render attempt.pbrt --threads 2 >out 2>&1 </dev/null
    )
    code=$?
    [ $code -eq 0 ] && return
    if [ $code -ne 1 ] || [ "$(grep -c '^montelux: error: attempt.pbrt:' out)" -ne 1 ] || [ "$(wc -l <out)" -ne 1 ]; then
        fail "exit code $code for $1: $(head -c 500 out)"
    fi
}
count=0
for file in "$bad"/exr/* "$bad"/images/*; do
    cp "$file" named.exr
    for name in "$file" named.exr; do
        attempt "$sky
Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"$name\"
Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\""
        attempt "LightSource \"infinite\" \"string filename\" \"$name\" Shape \"sphere\""
    done
    count=$((count + 1))
done
for file in "$bad"/models/* "$bad"/models/*/*; do
    [ -f "$file" ] || continue
    attempt "$sky Shape \"plymesh\" \"string filename\" \"$file\""
    count=$((count + 1))
done
[ $count -gt 50 ] || fail "only $count damaged files were found"
finish
