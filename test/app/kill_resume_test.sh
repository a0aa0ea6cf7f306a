#!/bin/sh
# A run that is killed by SIGKILL at random moments and resumed equals an uninterrupted one bit for bit. Half
# of the kills come after a random time, half at a random call on a file: in the middle of writing a checkpoint.
# MONTELUX_KILLS: how often each case is killed; MONTELUX_KILL_SEED: other moments.
. "$(dirname "$0")/common.sh"
kills=${MONTELUX_KILLS:-17}
seed=${MONTELUX_KILL_SEED:-1}
library=$(dirname "$montelux")/libmontelux_fault_injection.so
[ -e "$library" ] || { echo "skipped: $library is not built" && exit 77; }

# random N: N numbers in [0, 1), one a line; the same ones for the same seed.
random() {
    awk -v seed="$seed" -v n="$1" 'BEGIN { srand(seed); for (i = 0; i < n; i++) printf "%.6f\n", rand() }'
}
scaled() { awk -v x="$1" -v y="$2" 'BEGIN { printf "%.4f", x * y }'; }
now() { date +%s%N; }

# launch FOLDER KILL command...: runs it in the folder. KILL is `never`, `time SECONDS` or `call N`. Sets `code`.
launch() {
    where=$1 kill=$2
    shift 2
    preload='' call=0
    case $kill in call*) preload=$library call=${kill#call } ;; esac
    (
        cd "$where" || exit 1
        MONTELUX_FAULT_FOLDER=$PWD MONTELUX_FAULT_CALL=$call MONTELUX_FAULT_KIND=kill-before LD_PRELOAD=$preload \
            exec "$montelux" "$@" >printed 2>messages </dev/null
    ) &
    pid=$!
    case $kill in time*) sleep "${kill#time }" && kill -KILL $pid 2>/dev/null ;; esac
    wait $pid 2>/dev/null
    code=$?
}

# survives NAME "OUTPUTS" CALLS command...: kills it until it was killed often enough, and compares the OUTPUTS of
# each run that ended with those of the uninterrupted one. The command resumes if there is a checkpoint; a run
# makes about CALLS calls on files. Lines with times are left out.
survives() {
    name=$1 outputs=$2 calls=$3
    shift 3
    rm -rf unbroken broken && mkdir unbroken broken
    begin=$(now)
    launch unbroken never "$@"
    [ $code -eq 0 ] || { fail "$name: exit code $code: $(cat unbroken/messages)" && return; }
    seconds=$(scaled 1e-9 $(($(now) - begin)))
    killed=0 ended=0 resumed=0 tries=0
    random $((20 * kills + 20)) >moments
    while read -r moment; do
        tries=$((tries + 1))
        if [ $killed -ge "$kills" ]; then
            kill=never
        elif [ $((tries % 2)) -eq 0 ]; then
            kill="call $(scaled "$moment" "$calls" | awk '{ print 1 + int($1) }')"
        else
            kill="time $(scaled "$moment" "$seconds")"
        fi
        before=$killed
        launch broken "$kill" "$@"
        # The newest checkpoint is never damaged.
        grep -q 'montelux: \(warning\|error\)' broken/messages && fail "$name, killed $killed times, last $kill: $(cat broken/messages)"
        case $code in
        137) killed=$((killed + 1)) ;;
        0)
            ended=$((ended + 1))
            for output in $outputs; do
                grep -av seconds "unbroken/$output" >a
                grep -av seconds "broken/$output" >b
                cmp -s a b || fail "$name, killed $killed times: $output differs from that of an uninterrupted run"
            done
            [ "$kill" = never ] && break
            rm -rf broken && mkdir broken
            ;;
        *) fail "$name, $kill: exit code $code: $(cat broken/messages)" && break ;;
        esac
        [ $killed -gt $before ] && [ -e broken/state ] && resumed=$((resumed + 1))
    done <moments
    [ "$kill" = never ] || fail "$name: killed only $killed times in $tries tries"
    # Kills before the first checkpoint would show nothing.
    [ $((2 * resumed)) -ge "$kills" ] || fail "$name: only $resumed of $killed kills left a checkpoint"
    [ -z "${MONTELUX_VERBOSE-}" ] ||
        echo "$name: $seconds s, killed $killed times, $resumed with a checkpoint, $ended ends compared"
}

# Each case keeps its checkpoint in `state`.
checkpoints='--checkpoint state --checkpoint-every 0 --resume --quiet --json'
for method in basic vegas adaptive; do
    survives $method printed 90 integrate 'sin(x)*y+exp(-40*(z-0.5)^2)' --over x,y,z=0:1 --method $method \
        --evaluations 2e6 $checkpoints
done
scene ball "$sky Material \"diffuse\" Shape \"sphere\"" 32 24
for sampler in independent sobol; do
    for adaptive in on off; do
        survives "$sampler pictures, adaptive $adaptive" x.pfm 90 render ../ball.pbrt --sampler $sampler --spp 200 \
            --adaptive $adaptive --seed 1 --quiet -o x.pfm --checkpoint state --checkpoint-every 0.001 --resume
    done
done
finish
