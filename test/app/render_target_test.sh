#!/bin/sh
# Renders to an error, to a time, with checkpoints: exit codes, sentences, mistakes.
. "$(dirname "$0")/common.sh"
scene ball "$sky Material \"diffuse\" Shape \"sphere\"" 24 18
expect 0 "target reached" render ball.pbrt --target-error 2% -o x.exr
expect 0 "stoppedBy" info x.exr
expect 0 "target reached" render ball.pbrt --target-error 0.02 --adaptive off --sampler sobol -o x.exr
expect 0 "target reached" render ball.pbrt --target-error 0.05 --target-quantile 95% -o x.exr
expect 3 "samples are used up before the target was reached" render ball.pbrt --target-error 1e-5 --max-spp 16 -o x.exr
expect 3 "time is up before the target was reached" render ball.pbrt --target-error 1e-7 --time 0.2 -o x.exr
expect 0 "time is up" render ball.pbrt --time 0.2s -o x.exr
expect 0 "16 samples per pixel" render ball.pbrt --time 1h --spp 16 -o x.exr
expect 0 "samples were clamped, which removed" render ball.pbrt --clamp 0.5 -o x.exr
# What would be cleaner: nothing where no error is visible.
expect 0 "for half the error: --spp 16, about " render ball.pbrt -o x.exr
grep -qE 'relative error [0-9.]+ %, visible in [0-9.]+ % of the pixels, ' out || fail "no share of visible errors: $(cat out)"
expect 0 "for half the error: --target-error 4%, about " render ball.pbrt --target-error 8% -o x.exr
expect 0 "for half the error: --time 1s" render ball.pbrt --time 0.1 --sampler independent -o x.exr
expect 3 "to reach the target: --max-spp " render ball.pbrt --target-error 0.1% --max-spp 32 -o x.exr
expect 3 "to reach the target: --time " render ball.pbrt --target-error 1e-5 --time 0.1 -o x.exr
scene even "$sky"
expect 0 "visible in none of the pixels" render even.pbrt --spp 4096 -o x.exr
grep -q "for half the error" out && fail "advice for a picture without noise: $(cat out)"
# The bar is not full while the target is open.
if command -v script >/dev/null; then
    scene lit "$sky LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [0 0.9 1.2] Material \"diffuse\"
Shape \"sphere\" Translate 1 0 0 Shape \"sphere\"" 200 150
    script -qec "'$montelux' render lit.pbrt --target-error 7% -o x.exr" /dev/null >out 2>&1 </dev/null
    tr '\r' '\n' <out | awk '/100 %/ && / error / { sub(/.* error /, ""); if ($1 + 0 > 7) bad = 1 } END { exit bad }' ||
        fail "100 % above the target: $(tr '\r' '\n' <out | grep '100 %')"
fi
for value in 0 -1 1 2 nan x '' 120% 1e-2x; do
    expect 2 "--target-error: '$value' was given" render ball.pbrt --target-error "$value" -o y.exr
done
for value in 0 -1 10x m 1m1h 1h30 '' nan; do
    expect 2 "--time: '$value' was given" render ball.pbrt --time "$value" -o y.exr
done
expect 2 "--target-quantile: expected --target-error" render ball.pbrt --target-quantile 0.9 -o y.exr
expect 2 "--resume: expected --checkpoint FILE" render ball.pbrt --resume -o y.exr
expect 2 "--adaptive: 'maybe' was given; on or off" render ball.pbrt --adaptive maybe -o y.exr
expect 2 "--clamp: '0' was given" render ball.pbrt --clamp 0 -o y.exr
[ -e y.exr ] && fail "a refused command wrote a picture"

# A finished render resumes to more samples, and equals an uninterrupted one.
expect 0 "is not there yet: rendering from the start" render ball.pbrt --spp 20 --resume --checkpoint state -o a.pfm
expect 0 "52 samples per pixel" render ball.pbrt --spp 52 --resume --checkpoint state -o a.pfm
expect 0 "state has 52 samples per pixel already, more than the requested 20" render ball.pbrt --spp 20 --resume \
    --checkpoint state -o less.pfm
cmp -s a.pfm less.pfm || fail "a render that had more samples than asked for changed"
expect 0 "state: nothing is left to render: all its samples are taken already; a larger --spp continues it" \
    render ball.pbrt --spp 52 --resume --checkpoint state -o a.pfm
for option in "--target-error 2%" "--time 0.2"; do
    rm -f again again.previous
    # shellcheck disable=SC2086 # two words
    expect 0 "again is not there yet" render ball.pbrt $option --resume --checkpoint again -o a.exr
    expect 0 "again: nothing is left to render: " render ball.pbrt $option --resume --checkpoint again -o a.exr
    grep -qE 'the target error is reached already; a smaller --target-error|0.2 s are used up.*; a longer --time' out ||
        fail "$option: why nothing is left: $(cat out)"
done
expect 0 "" render ball.pbrt --spp 52 -o b.pfm
cmp -s a.pfm b.pfm || fail "a resumed render differs"
expect 1 "of another render: the sampler or seed differs" render ball.pbrt --seed 9 --resume --checkpoint state -o x.pfm
expect 1 "the film differs" render ball.pbrt --clamp 3 --resume --checkpoint state -o x.pfm
printf x >>state
expect 0 "resuming from the checkpoint before the last" render ball.pbrt --spp 52 --resume --checkpoint state -o c.pfm
cmp -s c.pfm b.pfm || fail "a render that was resumed from the previous checkpoint differs"
printf x >>state.previous
printf x >>state
expect 1 "state" render ball.pbrt --spp 52 --resume --checkpoint state -o x.pfm
expect 2 "the file exists; add --resume" render ball.pbrt --checkpoint a.pfm -o x.pfm
expect 2 "the checkpoint has this name" render ball.pbrt --checkpoint z.pfm -o z.pfm
expect 0 "4 samples per pixel" render ball.pbrt --checkpoint often --checkpoint-every 0 --threads 1 -o often.pfm
expect 2 "the scene is read from this file" render ball.pbrt --checkpoint ball.pbrt -o x.pfm
expect 1 "nowhere" render ball.pbrt --checkpoint nowhere/state -o x.pfm
[ -e x.pfm ] && fail "a refused command wrote a picture"
finish
