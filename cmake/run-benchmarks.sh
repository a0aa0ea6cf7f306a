#!/bin/bash
# Runs every benchmark program of a build folder, then the benchmark of whole pictures.
# Usage: run-benchmarks.sh build-folder
set -eu
for program in "$1"/bench/*_bench; do
    [ -x "$program" ] || continue
    echo "== $(basename "$program")"
    "$program" --benchmark_counters_tabular=true
done
environments=../shared/environments
if [ -x "$1/bench/environment_sampling" ] && [ -d $environments ]; then
    echo "== environment light"
    "$1/bench/environment_sampling" 8192 $environments/{forest,night,studio,sunrise}.hdr
fi
if [ -x bench/render.sh ]; then
    echo "== pictures"
    bench/render.sh "$1/montelux"
fi
