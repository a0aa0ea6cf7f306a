#!/bin/sh
# Renders by MPI ranks are bit-identical to those of one process, also after a rank was killed and the job resumed.
. "$(dirname "$0")/common.sh"
command -v mpirun >/dev/null || { echo "skipped: there is no mpirun" && exit 77; }
"$montelux" --version | grep -q "MPI (" || { echo "skipped: built without MPI" && exit 77; }
# Containers and small machines: as root, and more ranks than processors.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

# ranks N arguments...: the program on N ranks; its output in `out`, its exit code in `code`.
ranks() {
    n=$1
    shift
    timeout 60 mpirun --oversubscribe --bind-to none -n "$n" "$montelux" "$@" >out 2>&1 </dev/null
    code=$?
}
# same NAME A B: two EXR files are equal, except for the render time in their headers.
same() {
    [ "$(wc -c <"$2")" = "$(wc -c <"$3")" ] && [ "$(cmp -l "$2" "$3" | wc -l)" -le 4 ] ||
        fail "$1: the pictures differ in $(cmp -l "$2" "$3" | wc -l) bytes"
}
# prints_once NAME CODE TEXT: of the last job; also checks that no rank was killed.
prints_once() {
    [ $code -eq "$2" ] || fail "$1: exit code $code instead of $2: $(cat out)"
    [ "$(grep -cF -- "$3" out)" -eq 1 ] || fail "$1: '$3' is not printed once: $(cat out)"
    [ "$(grep -c 'montelux: error: ' out)" -le 1 ] || fail "$1: more than one error message: $(cat out)"
    ! grep -q 'MPI_ABORT\|interrupted, nothing' out || fail "$1: ranks were killed: $(cat out)"
}

light='AttributeBegin Translate 0 3 1 AreaLightSource "diffuse" "rgb L" [9 9 9] Shape "sphere" "float radius" 0.3 AttributeEnd'
scene ball "$sky $light Material \"diffuse\" Shape \"sphere\" Translate 1 0 0 Material \"conductor\" Shape \"sphere\"" 70 50

for options in '--spp 40 --sampler independent' '--spp 40' '--target-error 4% --sampler independent' '--spp 30 --adaptive on --seed 7'; do
    "$montelux" render ball.pbrt $options --quiet --threads 7 -o one.exr 2>messages || fail "one process: $(cat messages)"
    for n in 1 2 3 4; do
        [ $n -eq 1 ] || [ $n -eq 4 ] || [ "$options" = '--spp 40' ] || continue
        ranks $n render ball.pbrt $options --threads 1 -o many.exr
        prints_once "$options on $n ranks" 0 'many.exr: 70 x 50 pixels'
        same "$options on $n ranks" one.exr many.exr
    done
done

# The other integrators, and a guide.
for options in '--spp 16 --integrator bidirectional' '--spp 5 --integrator light-tracing --sampler independent' \
    '--spp 64 --integrator metropolis' '--spp 64 --guiding on' '--spp 300 --integrator auto' '--spp 6 --integrator bidirectional --merging auto'; do
    "$montelux" render ball.pbrt $options --quiet --threads 7 -o one.exr 2>messages || fail "one process: $(cat messages)"
    ranks 3 render ball.pbrt $options --threads 1 -o many.exr
    prints_once "$options on 3 ranks" 0 'many.exr: 70 x 50 pixels'
    same "$options on 3 ranks" one.exr many.exr
done
sed 's/Film "rgb"/Film "spectral"/' ball.pbrt >spectral.pbrt
"$montelux" render spectral.pbrt --spp 8 --quiet -o one.exr 2>messages || fail "a spectral film: $(cat messages)"
ranks 2 render spectral.pbrt --spp 8 -o many.exr
same "a spectral film on 2 ranks" one.exr many.exr

# Four slices of the samples, merged.
for k in 1 2 3 4; do
    ranks 2 render ball.pbrt --spp 40 --sampler independent --slice $k/4 --threads 1 --quiet -o part$k.exr
    [ $code -eq 0 ] || fail "slice $k: $(cat out)"
done
"$montelux" render ball.pbrt --spp 40 --sampler independent --quiet -o one.exr
"$montelux" merge part?.exr -o merged.exr >out 2>&1 || fail "merge: $(cat out)"
"$montelux" compare merged.exr one.exr >out 2>&1
awk '/^[RGB] / && $4 ~ /%/ { seen++; if (!($6 < 1e-6)) bad = 1 } END { exit bad || seen != 3 }' out || fail "slices: $(cat out)"

# Mistakes give one message and the exit code of a single process, without delay.
ranks 3 render missing.pbrt
prints_once "missing scene" 1 "montelux: error: missing.pbrt"
scene bad 'Shape "spher"'
ranks 3 render bad.pbrt
prints_once "bad scene" 1 "montelux: error: bad.pbrt:6:"
ranks 3 render ball.pbrt --spp none
prints_once "bad option" 2 "'none' was given"
# The message of rank 0 is printed even if it is the last: launchers end the job with the first rank that fails.
for mistake in 'render ball.pbrt --spp none' 'integrate x* --over x=0:1'; do
    timeout 60 mpirun --oversubscribe --bind-to none -n 3 sh -c \
        '[ "$OMPI_COMM_WORLD_RANK" = 1 ] || sleep 2; exec "$@"' - "$montelux" $mistake >out 2>&1 </dev/null
    code=$?
    "$montelux" $mistake >alone 2>&1
    [ $code -eq $? ] || fail "$mistake: exit code $code: $(cat out)"
    prints_once "$mistake, rank 0 late" $code "$(head -n 1 alone)"
done
# Mistakes that every rank finds; and one that only another rank than 0 finds, when it builds the scene.
ranks 3 render ball.pbrt --spp 4 --slice 5/9
prints_once "empty slice" 2 "montelux: error: --slice: there are fewer"
timeout 60 mpirun --oversubscribe --bind-to none -n 3 sh -c \
    '[ "$OMPI_COMM_WORLD_RANK" != 1 ] || set -- "$@" --crop 0.5001,0.5002,0,1; exec "$@"' - \
    "$montelux" render ball.pbrt --spp 40 -o alone.exr >out 2>&1 </dev/null
code=$?
prints_once "a mistake of rank 1 alone" 1 "montelux: error: rank 1: "
ranks 3 render ball.pbrt --crop 0.5001,0.5002,0,1
prints_once "empty crop" 2 "no pixel"
ranks 3 render ball.pbrt --debug-sample 35,25,3
prints_once "one sample" 0 "vertex 1:"
ranks 2 info one.exr
prints_once "what cannot be shared" 0 "70 x 50 pixels"
ranks 2 render ball.pbrt --spp 40 --stats -o many.exr
prints_once "statistics" 0 "ranks              2, with"

# background N arguments...: starts the job; `job` is mpirun.
background() {
    n=$1
    shift
    timeout 60 mpirun --oversubscribe --bind-to none -n "$n" "$montelux" "$@" >out 2>&1 </dev/null &
    job=$!
}
# rank K: the process of that rank.
rank() {
    for p in $(pgrep -f "^$montelux render "); do
        tr '\0' '\n' <"/proc/$p/environ" 2>/dev/null | grep -qx "OMPI_COMM_WORLD_RANK=$1" &&
            grep -qxz "PWD=$PWD" "/proc/$p/environ" && echo "$p" && return
    done
}
now() { date +%s%N; }
wait_for_file() {
    tries=0
    while [ ! -e "$1" ] && [ $tries -lt 200 ]; do sleep 0.05 && tries=$((tries + 1)); done
    [ -e "$1" ] || fail "$1 was not written: $(cat out)"
}
# ended NAME SECONDS: waits for the job; it must not take longer.
ended() {
    wait $job
    code=$?
    milliseconds=$((($(now) - begin) / 1000000))
    [ $milliseconds -lt $(($2 * 1000)) ] || fail "$1: the job took $milliseconds ms to end"
}
whole='render ball.pbrt --sampler independent --spp 1500 --adaptive on --seed 3'
"$montelux" $whole --quiet -o one.exr

# Killed ranks: the job ends with a message, and the checkpoint is good for the rest.
for victim in 0 2; do
    rm -f state* many.exr
    background 3 $whole --spp 100000 --threads 1 -o many.exr --checkpoint state --checkpoint-every 0.3
    wait_for_file state
    sleep 0.5
    begin=$(now)
    kill -KILL "$(rank $victim)" || fail "there is no rank $victim"
    ended "rank $victim killed" 10
    [ $code -ne 0 ] || fail "rank $victim killed: exit code 0"
    grep -q "signal 9" out || fail "rank $victim killed: no message: $(cat out)"
    ranks 2 $whole --threads 1 --quiet -o many.exr --checkpoint state --resume
    # The killed rank may have been further.
    [ $code -eq 0 ] || fail "rank $victim killed: resumed: exit code $code: $(cat out)"
done
# The same with a target: killed as soon as there is a checkpoint, and resumed to the same bits. A render that ends
# before the kill is repeated.
for try in 1 2 3 4 5; do
    rm -f state* many.exr
    background 3 $whole --threads 1 -o many.exr --checkpoint state --checkpoint-every 0.05
    wait_for_file state
    kill -KILL "$(rank 1)" 2>/dev/null
    wait $job
    [ -e many.exr ] && ! "$montelux" info many.exr | grep -q '"interrupted" = 1' || break
    [ $try -lt 5 ] || fail "the render had ended before rank 1 was killed"
done
ranks 4 $whole --threads 1 --quiet -o many.exr --checkpoint state --resume
[ $code -eq 0 ] || fail "resumed after a kill: $(cat out)"
same "resumed after a kill" one.exr many.exr

for options in '--spp 192 --integrator bidirectional' '--spp 640 --integrator metropolis' '--spp 640 --guiding on'; do
    "$montelux" render ball.pbrt $options --quiet -o one.exr
    rm -f state* many.exr
    background 3 render ball.pbrt $options --threads 1 -o many.exr --checkpoint state --checkpoint-every 0.05
    wait_for_file state
    kill -KILL "$(rank 2)" 2>/dev/null
    wait $job
    ranks 2 render ball.pbrt $options --threads 1 --quiet -o many.exr --checkpoint state --resume
    [ $code -eq 0 ] || fail "$options resumed after a kill: $(cat out)"
    same "$options resumed after a kill" one.exr many.exr
done

# Integrals: the digits of one process.
for options in 'sin(x)*y+exp(-40*(z-0.5)^2) --method basic' '1/(x+y+z) --method vegas' 'x*y*z --method cubature'; do
    "$montelux" integrate $options --over x,y,z=0:1 --evaluations 3e5 --seed 3 --json --quiet | grep -v seconds >alone
    for n in 2 3; do
        ranks $n integrate $options --over x,y,z=0:1 --evaluations 3e5 --seed 3 --json --quiet --threads 1
        grep -v seconds out | cmp -s - alone || fail "$options on $n ranks: $(cat out)"
    done
done
ranks 3 integrate 'x*' --over x=0:1
prints_once "bad formula" 2 "montelux: error: "

# A signal to mpirun, as from Ctrl-C, and to a single rank: the picture and the checkpoint are written.
for target in mpirun 0 1; do
    rm -f state* many.exr
    background 3 $whole --spp 100000 --threads 1 -o many.exr --checkpoint state --checkpoint-every 0.3
    wait_for_file state
    begin=$(now)
    if [ $target = mpirun ]; then kill -INT "$(pgrep -P $job mpirun)"; else kill -INT "$(rank $target)"; fi
    ended "a signal to $target" 8
    [ $code -ne 0 ] || fail "a signal to $target: exit code 0"
    [ $target = mpirun ] || [ $code -eq 130 ] || fail "a signal to rank $target: exit code $code: $(cat out)"
    expect 0 '"interrupted" = 1' info many.exr
    [ -e state ] || fail "a signal to $target: there is no checkpoint"
done

# A hanging rank ends the job.
rm -f state* many.exr
background 3 $whole --spp 100000 --threads 1 -o many.exr --checkpoint state --checkpoint-every 0.3 --rank-timeout 2
wait_for_file state
begin=$(now)
kill -STOP "$(rank 1)"
ended "a rank hangs" 10
grep -q "error: rank 1 has not answered for" out || fail "a rank hangs: $(cat out)"
expect 0 '"interrupted" = 1' info many.exr

# So does one that hangs before it has built the scene, which rank 0 reads first.
scene slow "$sky $(yes 'Shape "sphere" "float radius" 0.01' | head -n 250000)" 70 50
rm -f state* many.exr
background 2 render slow.pbrt --spp 1000000 --adaptive on --threads 1 -o many.exr --checkpoint state --checkpoint-every 0.05 \
    --rank-timeout 2
wait_for_file state
begin=$(now)
kill -STOP "$(rank 1)"
ended "a rank hangs while it builds the scene" 10
[ $code -eq 1 ] || fail "a rank hangs while it builds the scene: exit code $code: $(cat out)"
grep -q "error: rank 1 has not answered for" out || fail "a rank hangs while it builds the scene: $(cat out)"
expect 0 '"interrupted" = 1' info many.exr
expect 0 'many.exr: 70 x 50' render slow.pbrt --spp 1 --adaptive on -o many.exr --checkpoint state --resume
finish
