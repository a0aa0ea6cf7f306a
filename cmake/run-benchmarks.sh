#!/bin/bash
# Runs every benchmark program of a build folder, then the benchmark of whole pictures.
# Usage: run-benchmarks.sh build-folder
set -eu
for program in "$1"/bench/*_bench; do
    [ -x "$program" ] || continue
    echo "== $(basename "$program")"
    "$program" --benchmark_counters_tabular=true
done
if [ -x bench/render.sh ]; then
    echo "== pictures"
    bench/render.sh "$1/montelux"
fi
