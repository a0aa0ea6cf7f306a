#!/bin/bash
# Checks the format of the sources and runs clang-tidy over them, in parallel.
# Usage: lint.sh jobs [files...]; without files, every tracked one.
set -eu -o pipefail
jobs=$1
shift
if [ $# -gt 0 ]; then sources=("$@"); else mapfile -t sources < <(git ls-files '*.h' '*.cpp'); fi
clang-format --dry-run --Werror "${sources[@]}"

# clang-tidy reads the compiler's command lines; those of a debug build suit both compilers.
cmake --preset lint >/dev/null
mapfile -t units < <(printf '%s\n' "${sources[@]}" | grep '\.cpp$' | while read -r f; do
    if grep -q "/${f#./}\"" build/lint/compile_commands.json; then echo "$f"; fi
done)
[ ${#units[@]} -gt 0 ] || exit 0
printf '%s\n' "${units[@]}" | xargs -P "$jobs" -n 1 clang-tidy -p build/lint --quiet \
    --extra-arg=-Wno-unknown-warning-option
echo "${#sources[@]} files formatted well, ${#units[@]} analysed without a warning"
