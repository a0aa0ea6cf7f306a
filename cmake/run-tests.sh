#!/bin/bash
# Runs the tests with some labels in each build folder; the last line is "N passed, N failed". Failures are
# repeated before it, where they are easy to find.
# Usage: run-tests.sh label-expression jobs build-folder...
set -u
labels=$1 jobs=$2
shift 2
total=0 failed=0 skipped=0 broken=0 again=
for build in "$@"; do
    echo "== $build"
    report=$(mktemp)
    ctest --test-dir "$build" --label-regex "$labels" --parallel "$jobs" --output-on-failure \
        --no-tests=error --output-junit "$report"
    status=$?
    # The attributes of <testsuite> are one per line; an empty report counts as a failed run.
    count() { sed -n "s/.*[[:space:]]$1=\"\([0-9]*\)\".*/\1/p" "$report" | head -n 1; }
    tests=$(count tests) bad=$(count failures) left_out=$(count skipped)
    # A share of a program's tests is one test to ctest; its last lines say how many it ran.
    read -r tests bad left_out <<< "$(awk -v tests="${tests:-0}" -v bad="${bad:-0}" -v left_out="${left_out:-0}" '
        / Testing: / { share = / Testing: .*\/share_[0-9]+_of_[0-9]+$/ }
        !share { next }
        /^\[  PASSED  \] [0-9]+ test/ { tests += $4 - 1 }
        /^\[  SKIPPED \] [0-9]+ test/ { tests += $4; left_out += $4 }
        /^\[  FAILED  \] [0-9]+ test/ { tests += $4; bad += $4 - 1 }
        END { print tests, bad, left_out }' "$build/Testing/Temporary/LastTest.log")"
    total=$((total + ${tests:-0})) failed=$((failed + ${bad:-0})) skipped=$((skipped + ${left_out:-0}))
    if [ $status -ne 0 ] && [ "${bad:-0}" -eq 0 ]; then broken=$((broken + 1)); fi
    rm -f "$report"
    logs=$build/Testing/Temporary
    if [ "${bad:-0}" -gt 0 ]; then
        # Lines like "10:app/mpi"; of each the part of the log from "Command:" on.
        again+=$(awk 'NR == FNR { sub(/^[0-9]+:/, ""); failed[$0]; next }
            / Testing: / { name = $0; sub(/.* Testing: /, "", name) }
            name in failed && / Testing: /, /<end of output>/' "$logs/LastTestsFailed.log" "$logs/LastTest.log")$'\n'
    fi
done
[ -z "$again" ] || printf '== what failed\n%s' "$again"
[ $skipped -eq 0 ] || echo "$skipped skipped (each says why above or in ctest --verbose)"
[ $broken -eq 0 ] || echo "$broken test runs broke off"
echo "$((total - failed - skipped)) passed, $((failed + broken)) failed"
[ $((failed + broken)) -eq 0 ]
