#!/bin/sh
# A signal saves the picture so far; progress on a terminal and elsewhere.
. "$(dirname "$0")/common.sh"
scene long "$sky Material \"diffuse\" Shape \"sphere\"" 400 300 1000000

# A program that does not heed the signal must not keep the test waiting: end_later PID, then wait_for PID.
end_later() {
    (sleep 60 && kill -KILL "$1" 2>/dev/null) >/dev/null 2>&1 &
    watchdog=$!
}
wait_for() {
    wait "$1"
    code=$?
    kill $watchdog 2>/dev/null
}
now() { date +%s%N; }
for sampler in independent sobol; do
    for signal in INT TERM; do
        rm -f long.exr
        "$montelux" render long.pbrt --sampler $sampler --spp 4096 >out 2>&1 &
        pid=$!
        end_later $pid
        sleep 1
        begin=$(now)
        kill -$signal $pid
        wait_for $pid
        milliseconds=$((($(now) - begin) / 1000000))
        [ $code -eq 130 ] || fail "$signal, $sampler: exit code $code instead of 130"
        [ $milliseconds -lt 2000 ] || fail "$signal, $sampler: it took $milliseconds ms to end"
        grep -q "stopped before the end" out || fail "$signal, $sampler: $(cat out)"
        expect 0 '"interrupted" = 1' info long.exr
        # Pixels without samples are 0, no channel of the mean has anything that is not a number.
        "$montelux" info long.exr | awk '$1 ~ /^[RGB]$/ { seen++; if ($5 + $6 > 0) bad = 1 }
            END { exit bad || seen != 3 }' || fail "$signal, $sampler: the mean is not finite"
    done
done

# stopped WHAT SIGNAL SECONDS arguments...: a render that gets the signal then ends with 130.
stopped() {
    what=$1 signal=$2 seconds=$3
    shift 3
    "$montelux" render "$@" >out 2>&1 &
    pid=$!
    end_later $pid
    sleep "$seconds"
    kill -"$signal" $pid
    wait_for $pid
    [ $code -eq 130 ] || fail "$what: exit code $code instead of 130"
}

# Replicates of 62500 samples: no two are finished, and the errors are unknown.
stopped "without errors" TERM 1 long.pbrt --sampler sobol -o none.exr
grep -q "the errors are unknown: fewer than two replicates of 62500 samples per pixel" out ||
    fail "without errors: $(cat out)"
"$montelux" info none.exr --json | grep -q '"relativeError": null' || fail "an unknown error in JSON is not null"

# Paths in a sphere without absorption are long, and the first signal waits for those of a pixel. A second signal
# ends the program at once, but not within the same second. Checkpoints stay.
scene furnace 'Texture "slow" "float" "fbm" "integer octaves" 64
MakeNamedMaterial "white" "string type" "diffuse" "spectrum reflectance" [200 1 900 1]
Material "mix" "string materials" ["white" "white"] "texture amount" "slow" Shape "sphere" "float radius" 5' 1 1
furnace="render furnace.pbrt --sampler independent --adaptive on --max-depth 1000000 --checkpoint furnace.state"
expect 0 "4 samples per pixel" $furnace --spp 4
cp furnace.state furnace.expected
rm -f furnace.exr
"$montelux" $furnace --spp 1000 --resume >out 2>&1 & # 4 samples are next
pid=$!
end_later $pid
sleep 0.5
kill -INT $pid
sleep 0.3
kill -INT $pid
sleep 0.8
kill -0 $pid 2>/dev/null || fail "two signals within a second ended the program at once"
begin=$(now)
kill -INT $pid
wait_for $pid
milliseconds=$((($(now) - begin) / 1000000))
[ $code -eq 130 ] || fail "a second signal: exit code $code instead of 130"
[ $milliseconds -lt 1000 ] || fail "a second signal: it took $milliseconds ms to end"
grep -q "ended at once by another signal: no result was written; checkpoints are as they were" out ||
    fail "a second signal: $(cat out)"
[ -e furnace.exr ] && fail "a second signal: a picture was written"
cmp -s furnace.state furnace.expected || fail "a second signal: the checkpoint has changed"

# While the scene is being read there is nothing to save.
(cat long.pbrt && yes 'AttributeBegin AttributeEnd' | head -n 3000000) >slow.pbrt
rm -f long.exr
stopped "a signal while reading" INT 0.2 slow.pbrt
[ -e long.exr ] && fail "a signal while reading: a picture was written"

# Files here that a process has written more than 64 KiB of: they have no name, or a temporary one. (Elsewhere it
# opens others: its libraries, before it can heed a signal.)
being_written() {
    find -L $(find "/proc/$1/fd" -lname "$(pwd -P)/*") /dev/null -type f -size +64k
    find . -name '.montelux-*' -size +64k
} 2>/dev/null

# Once the picture is being written, signals neither stop it nor leave a part of it behind.
"$montelux" render long.pbrt --resolution 1200x900 --spp 1 --quiet -o large.exr >out 2>&1 &
pid=$!
end_later $pid
in_time=0
while kill -0 $pid 2>/dev/null; do
    # Two of them: the first one would only have asked for an early end.
    if being_written $pid | grep -q . && kill -INT $pid && kill -INT $pid; then
        in_time=$((in_time + 1))
    fi 2>/dev/null
done
wait_for $pid
[ $in_time -ge 1 ] || fail "signals while writing: none came in time"
[ $code -eq 0 ] || fail "signals while writing: exit code $code instead of 0"
expect 0 "1200 x 900 pixels, 20 channels" info large.exr
find . -name '.montelux-*' | grep -q . && fail "a signal while writing left a temporary file behind"
rm -f large.exr

# As many threads as asked for, more than there are processors too.
"$montelux" render long.pbrt --threads 11 --quiet -o threads.exr >out 2>&1 &
pid=$!
end_later $pid
tries=0 threads=0
while [ "$threads" -lt 11 ] && [ $tries -lt 100 ]; do
    sleep 0.1
    threads=$(ls "/proc/$pid/task" 2>/dev/null | wc -l)
    tries=$((tries + 1))
done
kill -INT $pid
wait_for $pid
[ "$threads" -ge 11 ] || fail "--threads 11: $threads threads"

# Lines where there is no terminal, a bar on one.
scene short "$sky Shape \"sphere\""
expect 0 "rendering: 100 %" render short.pbrt
if command -v script >/dev/null; then
    script -qec "'$montelux' render short.pbrt" /dev/null >out 2>&1 </dev/null
    for text in '\[####' '100 %' 'elapsed' 'samples/s' 'error'; do
        grep -q "$text" out || fail "the bar does not show '$text': $(cat out)"
    done
fi
finish
