#!/bin/bash
# Fuzzes each loader for so many seconds, one after the other, from its corpus. New inputs that reach new code are kept
# in the build folder and are the start of the next run. Ends with 1 if any input crashed a loader, took more than 30 s
# or more than 2 GB, or leaked.
# Usage: run_fuzzers.sh build-folder seconds loader...
set -u
build=$1 seconds=$2
shift 2
corpus=$(cd "$(dirname "$0")" && pwd)/corpus
failed=0
for loader in "$@"; do
    work=$build/runs/$loader
    mkdir -p "$work/inputs" "$work/failures"
    options=(-max_total_time="$seconds" -rss_limit_mb=2048 -timeout=30 -max_len=16384 -print_final_stats=1)
    dictionary=$(dirname "$corpus")/$loader.dict
    [ ! -e "$dictionary" ] || options+=(-dict="$dictionary")
    echo "== $loader: $seconds s, log in $work/log"
    if "$build/test/fuzz/fuzz_$loader" "${options[@]}" -artifact_prefix="$work/failures/" "$work/inputs" "$corpus/$loader" \
        > "$work/log" 2>&1; then
        grep -E 'number_of_executed_units|slowest_unit_time_sec|peak_rss_mb' "$work/log"
    else
        failed=1
        grep -E 'ERROR|SUMMARY|Test unit written' "$work/log"
        echo "$loader fails: repeat it with $build/test/fuzz/fuzz_$loader FILE-IN-$work/failures"
    fi
done
exit $failed
