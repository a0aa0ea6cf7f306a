#!/bin/bash
# Holds the headers that most files include to a number of lines after preprocessing (test/house/header_budget.txt):
# one line that pulls in an iostream or the intrinsics costs every file of the house. A third word there is a header that
# it must not include.
# Usage: header_budget.sh compiler
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
macros=$("$1" -x c++ -dM -E /dev/null)
if [[ $macros == *__clang__* || $macros != *"__GNUC__ 12"* ]]; then
    echo "the budgets are of GCC 12 and its library"
    exit 77
fi
failed=0
while read -r header budget without; do
    lines=$("$1" -std=c++20 -I "$root" -x c++ -E -P -w "$root/$header" | grep -c .)
    echo "$header: $lines of $budget lines"
    if [ "$lines" -eq 0 ]; then
        echo "  It cannot be preprocessed."
        failed=1
    elif [ "$lines" -gt "$budget" ]; then
        echo "  Too many: g++ -H shows what it includes; declare in place of including, or move code to a .cpp file."
        failed=1
    fi
    if [ -n "$without" ] && "$1" -std=c++20 -I "$root" -x c++ -M -w "$root/$header" | grep -qF "/$without"; then
        echo "  It includes $without: g++ -H shows how."
        failed=1
    fi
done < <(grep -v '^#' "$root/test/house/header_budget.txt")
exit $failed
