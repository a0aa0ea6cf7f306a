#!/bin/sh
# The commands that the documentation shows print what it shows: each `$ montelux integrate ...` and
# `$ montelux sample ...` of a code block, up to the next `$` or the end of the block. Where a line shown ends with ..., its beginning is compared.
docs=$(cd "$(dirname "$0")/../../docs" && pwd)
. "$(dirname "$0")/common.sh"

mkdir bin && ln -s "$montelux" bin/montelux
PATH=$folder/bin:$PATH
# The C files that a page shows (```c title="NAME"), and files NUMBER.command and NUMBER.shown for each command of a page.
split() {
    awk '
        /^```c title="/ { split($0, part, "\""); file = part[2]; printf "" >file; next }
        file != "" { if (/^```/) file = ""; else print >file; next }
        /^```/ && inside { inside = 0; shown = ""; next }
        /^```(text|sh|console)$/ { inside = 1; next }
        inside && continued { print >command; continued = /\\$/; next }
        inside && /^\$ / {
            shown = ""
            if ($0 !~ /^\$ montelux (integrate|sample) /) next
            name = sprintf("%03d", ++count)
            command = name ".command"
            shown = name ".shown"
            print "# line " FNR >command
            sub(/^\$ /, "")
            print >command
            printf "" >shown
            continued = /\\$/
            next
        }
        inside && shown != "" { print >shown }
    ' "$1"
}

for page in accelerator.md integration.md sampling.md usage.md start.md tutorials/integrate.md; do
    mkdir -p "$folder/$page" && cd "$folder/$page" || exit 1
    split "$docs/$page"
    for command in *.command; do
        [ -e "$command" ] || break
        sh "$command" >out 2>&1 </dev/null
        awk '
            NR == FNR { printed[FNR] = $0; lines = FNR; next }
            {
                beginning = /\.\.\.$/ ? substr($0, 1, length($0) - 3) : ""
                if (beginning == "" ? printed[FNR] != $0 : index(printed[FNR], beginning) != 1) bad = 1
                shown = FNR
            }
            END { exit bad || shown != lines }
        ' out "${command%.command}.shown" || {
            fail "docs/$page, $(head -n 1 "$command" | cut -c 3-): $(tail -n +2 "$command") prints"
            cat out
            echo "instead of"
            cat "${command%.command}.shown"
        }
    done
done
cd "$folder" || exit 1
[ -e usage.md/004.command ] || fail "no commands were found in docs/usage.md"
finish
