#!/bin/bash
# CPU time per camera sample on real pbrt-v4 scenes, one thread, beside pbrt-v4.
# Usage: render.sh montelux-program [folder-of-scenes]
# With PBRT=/path/to/pbrt pbrt-v4 is measured in the same run; else its column holds figures that were measured once on
# an idle machine (-O3 -march=native, 16 spp, path integrator) and serve as a rough guide only.
set -eu
montelux=$1
scenes=${2:-$(dirname "$0")/../../shared/scenes/pbrt}
spp=${SPP:-16}
pbrt=${PBRT:-}
declare -A noted=([cornell-box]=5.7 [veach-mis]=4.1 [killeroo-simple]=5.0 [killeroo-gold]=5.7 [coffee]=7.9 [material-testball]=2.7)
[ -d "$scenes" ] || { echo "no scenes at $scenes: skipped"; exit 0; }
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# The least of three runs: other programs only add time.
least() { sort -n | head -n 1; }
ours() {
    for _ in 1 2 3; do
        "$montelux" render "$1" --spp "$spp" --sampler independent --threads 1 -o "$out/m.exr" --stats 2>/dev/null |
            sed -n 's/.* \([0-9.]*\) us of CPU each.*/\1/p'
    done | least
}
theirs() { # microseconds of CPU a sample; loading is taken off by a run with 1 spp
    for _ in 1 2 3; do
        for n in "$spp" 1; do
            /usr/bin/env time -f %U "$pbrt" --quiet --nthreads 1 --spp $n --outfile "$out/p.exr" "$1" 2>&1 >/dev/null | tail -n 1
        done | paste -sd' ' | awk -v pixels="$2" -v spp="$spp" '{print 1e6 * ($1 - $2) / (pixels * (spp - 1))}'
    done | least
}

ratios=()
printf '%-20s %14s %14s %8s\n' scene 'montelux us' 'pbrt-v4 us' ratio
for scene in cornell-box veach-mis killeroo-simple killeroo-gold coffee material-testball; do
    file=$scenes/$scene/scene.pbrt
    [ -f "$file" ] || continue
    a=$(ours "$file")
    if [ -n "$pbrt" ]; then
        pixels=$("$montelux" info "$out/m.exr" --json | sed -n 's/.*"\(width\|height\)": \([0-9]*\).*/\2/p' | paste -sd'*' | bc)
        b=$(theirs "$file" "$pixels")
    else
        b=${noted[$scene]}
    fi
    ratio=$(awk -v a="$a" -v b="$b" 'BEGIN {printf "%.2f", b / a}')
    ratios+=("$ratio")
    printf '%-20s %14s %14s %8s\n' "$scene" "$a" "$b" "$ratio"
done
printf '%s\n' "${ratios[@]}" | sort -n | awk '{r[NR] = $1} END {if (NR) printf "median ratio %.2f, least %.2f\n", (r[int((NR + 1) / 2)] + r[int(NR / 2) + 1]) / 2, r[1]}'
[ -n "$pbrt" ] || echo "pbrt-v4 was not measured in this run (set PBRT to its program)"
