#!/bin/bash
# Progress on terminals of 80 and 40 columns: it fits, and counts towards what ends the render.
. "$(dirname "$0")/common.sh"
if ! command -v script >/dev/null || ! command -v stty >/dev/null; then
    echo "skipped: there is no 'script' or no 'stty'"
    exit 77
fi
content="$sky LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [0 0.9 1.2] Material \"diffuse\"
Shape \"sphere\" Translate 1 0 0 Shape \"sphere\""
scene lit "$content" 480 360
scene large "$content" 1200 900

# on_terminal COLUMNS arguments...: `lines` has what was drawn, a picture of the line each.
on_terminal() {
    columns=$1
    shift
    script -qec "stty cols $columns; '$montelux' $*" /dev/null >out 2>&1 </dev/null
    tr '\r' '\n' <out | sed 's/\x1b\[K//g' | grep -E '[0-9] %  ' >lines
    [ -s lines ] || fail "$columns columns, $*: no progress: $(cat out)"
    awk -v most=$((columns - 1)) 'length($0) > most { print length($0) ": " $0; bad = 1 } END { exit bad }' lines ||
        fail "$columns columns, $*: longer lines (above)"
}

for columns in 80 40; do
    on_terminal $columns render lit.pbrt --time 2 -o x.exr
    # 2 s at first, less later; the number of samples has nothing to do with it.
    awk '/ left/ { n++; match($0, /[0-9.]+ s left/); if (RSTART == 0 || substr($0, RSTART, RLENGTH) + 0 > 2.5) bad = 1 }
         END { exit bad || n == 0 }' lines || fail "$columns columns: seconds left of --time 2: $(cat lines)"
    tail -n 1 lines | grep -q '100 %' || fail "$columns columns: the last line is not 100 %: $(tail -n 1 lines)"
    # While the error is not known, there is no telling when the target is met.
    on_terminal $columns render lit.pbrt --target-error 30% -o x.exr
    grep -E '[0-9]+:[0-9]+:[0-9]+ left' lines && fail "$columns columns: hours are left to an error of 30 %"
    on_terminal $columns render lit.pbrt --spp 8 -o x.exr
    grep -q '100 %' lines || fail "$columns columns: no 100 %: $(cat lines)"
done
on_terminal 80 render lit.pbrt --spp 8 -o x.exr
grep -qE '\[#+\.*\] +[0-9]+ %' lines || fail "no bar of 80 columns: $(cat lines)"
on_terminal 40 render lit.pbrt --spp 8 -o x.exr
grep -q 'elapsed\|left' lines || fail "no time on 40 columns: $(cat lines)"

# Interrupted in its pilot, a render to an error has seen every pixel.
"$montelux" render large.pbrt --target-error 0.1% -o early.exr >out 2>&1 </dev/null &
pid=$!
sleep 5
kill -INT $pid
wait $pid
[ $? -eq 130 ] || fail "interrupted: not exit code 130: $(cat out)"
"$montelux" info early.exr | awk '$1 == "samples" { found = 1; bad = $2 < 1 } END { exit bad || !found }' ||
    fail "an interrupted render left pixels without samples: $("$montelux" info early.exr | grep samples)"
finish
