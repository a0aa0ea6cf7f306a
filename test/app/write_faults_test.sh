#!/bin/sh
# If any call on a file fails, or the program is killed after it, each output is the complete old file or the
# complete new one. Every call of each command below is made to fail once.
# MONTELUX_FAULT_KINDS="ENOSPC EIO ..." (test/fault/fault_injection.cpp) chooses what happens; "all": everything.
. "$(dirname "$0")/common.sh"
library=$(dirname "$montelux")/libmontelux_fault_injection.so
[ -e "$library" ] || { echo "skipped: $library is not built" && exit 77; }
every_kind="ENOSPC EIO EDQUOT EINTR full-disk short kill-before kill-after"
kinds=${MONTELUX_FAULT_KINDS:-ENOSPC short kill-before}
[ "$kinds" = all ] && kinds=$every_kind

# with_fault N KIND command...: in the folder `work`, the only one where calls are counted.
with_fault() {
    n=$1 kind=$2
    shift 2
    rm -f report
    # What the shell says of a child that was killed goes to `killed`.
    (cd work && MONTELUX_FAULT_FOLDER=$PWD MONTELUX_FAULT_CALL=$n MONTELUX_FAULT_KIND=$kind \
        MONTELUX_FAULT_REPORT=$folder/report LD_PRELOAD=$library timeout 60 "$montelux" "$@" \
        >"$folder/out" 2>&1 </dev/null
        exit $?) 2>killed
}

# whole FILE WANTED: is FILE what a run without faults made? Files with times are read instead.
whole() {
    cmp -s "$1" "$2" && return
    case $1 in
    *.exr) "$montelux" compare "$1" "$2" 2>/dev/null | grep -qF 'RMSE 0, relMSE 0 ' ;;
    *) return 1 ;;
    esac
}

# begin_case prepares `work` for the next run: files that are there before. Replaced by the cases.
begin_case() { :; }
# A case may check more after each fault: check_case KIND CODE.
check_case() { :; }

# faults NAME "OUTPUTS" command...: the loop over kinds and calls. OUTPUTS are names in `work`.
faults() {
    name=$1 outputs=$2
    shift 2
    rm -rf work new && mkdir work
    begin_case
    with_fault 0 none "$@"
    code=$?
    [ $code -eq 0 ] || { fail "$name: exit code $code without a fault: $(cat out)" && return; }
    grep -q unseen report 2>/dev/null && fail "$name: writes that no fault can reach: $(cat report)"
    mv work new
    for kind in $kinds; do
        call=0
        while :; do
            call=$((call + 1))
            rm -rf work && mkdir work
            begin_case
            rm -rf old && cp -a work old
            with_fault $call "$kind" "$@"
            code=$?
            where="$name, $kind at call $call"
            if ! [ -e report ]; then
                [ $code -eq 0 ] || fail "$where: exit code $code though nothing went wrong: $(cat out)"
                break
            fi
            where="$where ($(head -n 1 report | sed "s|$folder/||"))"
            for output in $outputs; do
                if [ $code -eq 0 ]; then
                    whole "work/$output" "new/$output" || fail "$where: $output is not the new file"
                elif [ -e "work/$output" ]; then
                    whole "work/$output" "old/$output" || whole "work/$output" "new/$output" ||
                        fail "$where: $output is half a file"
                elif [ -e "old/$output" ]; then
                    fail "$where: $output is lost"
                fi
            done
            case $kind in
            kill-*) [ $code -eq 137 ] || fail "$where: exit code $code instead of 137: $(cat out)" ;;
            *)
                left=$(cd work && find . -name '.montelux-*' -o -name '*.tmp')
                [ -z "$left" ] || fail "$where: $left was left behind"
                if [ $code -eq 1 ]; then
                    [ "$(grep -c 'montelux: error: ' out)" -eq 1 ] || fail "$where: not one error: $(cat out)"
                elif [ $code -ne 0 ]; then
                    fail "$where: exit code $code: $(cat out)"
                fi
                # The first failure is named, even where a library swallows it.
                [ "$kind" != ENOSPC ] || [ $code -ne 1 ] || grep -q 'No space left on device' out ||
                    fail "$where: the message lacks the reason: $(cat out)"
                # Probes and what is only read may fail to open or close; nothing else goes unnoticed.
                case $kind in ENOSPC | EIO | EDQUOT | full-disk)
                    [ $code -eq 1 ] || grep -q 'montelux: warning: ' out || head -n 1 report | grep -q 'fault \(open\|close\)' ||
                        fail "$where: went unnoticed"
                    ;;
                esac
                # Half a write is no fault, and interrupted calls can be made again, but for renaming.
                case $kind in short | EINTR)
                    [ $code -eq 0 ] || grep -q 'fault \(rename\|link\)' report || fail "$where: $(cat out)"
                    ;;
                esac
                ;;
            esac
            check_case "$kind" $code
            [ $call -lt 400 ] || { fail "$name, $kind: no end of faults" && break; }
        done
        # A case without faults would test nothing.
        [ $call -gt 5 ] || fail "$name, $kind: only $((call - 1)) calls were counted"
        [ -z "${MONTELUX_VERBOSE-}" ] || echo "$name, $kind: $((call - 1)) calls"
    done
}

scene tiny "$sky Shape \"sphere\"" 8 6 1
begin_case() { printf 'old' >work/x.exr && printf 'old' >work/x.png && printf 'old' >work/x.pfm; }
faults pictures "x.exr x.png" render ../tiny.pbrt --seed 1 --quiet -o x.exr -o x.png
faults floats "x.pfm x.hdr" render ../tiny.pbrt --seed 1 --quiet -o x.pfm -o x.hdr

begin_case() { printf 'old' >work/points.csv; }
faults points "points.csv" integrate 'x*y' --over x,y=0:1 --method basic --evaluations 2000 --quiet \
    --points points.csv
faults plot "plot.svg" integrate 'x*y' --over x,y=0:1 --method midpoint --evaluations 2000 --quiet --plot plot.svg

begin_case() { printf 'old' >work/points.csv; }
faults samples "points.csv" sample --set sobol --n 2000 --dim 3 -o points.csv

# Checkpoints contain elapsed times, so resumed results are compared instead of their bytes.
integral="integrate x*y --over x,y=0:1 --method basic --quiet --json --checkpoint state --checkpoint-every 0"
# A step ends there in the longer run, too.
"$montelux" $integral --evaluations 16384 >/dev/null
mkdir saved && mv state* saved
"$montelux" integrate 'x*y' --over x,y=0:1 --method basic --quiet --json --evaluations 50000 | grep -v seconds >uninterrupted
begin_case() { cp saved/* work; }
check_case() {
    (cd work && "$montelux" $integral --evaluations 50000 --resume) >resumed 2>warnings ||
        fail "$where: cannot be resumed: $(cat warnings)"
    grep -q warning warnings && fail "$where: $(cat warnings)"
    grep -v seconds resumed | cmp -s - uninterrupted || fail "$where: resumes to other digits"
}
faults checkpoint "" $integral --evaluations 50000 --resume

picture="render ../tiny.pbrt --seed 1 --quiet --checkpoint state"
rm -rf saved && mkdir saved && (cd saved && "$montelux" $picture --spp 3 -o x.pfm && "$montelux" $picture --spp 5 -o x.pfm --resume)
"$montelux" render tiny.pbrt --seed 1 --quiet --spp 9 -o uninterrupted.pfm
begin_case() { cp saved/* work; }
check_case() {
    (cd work && "$montelux" $picture --spp 9 -o y.pfm --resume) >out 2>warnings ||
        fail "$where: cannot be resumed: $(cat warnings)"
    grep -q warning warnings && fail "$where: $(cat warnings)"
    cmp -s work/y.pfm uninterrupted.pfm || fail "$where: resumes to another picture"
}
faults "render checkpoint" x.pfm $picture --spp 7 -o x.pfm --resume
finish
