#!/bin/sh
# Runs the Python tests of a folder, which need NumPy alone, in the first of these that has it: the build's Python
# environment, python3. 77: skipped.
# Usage: python_tests.sh BUILD-FOLDER FOLDER MODULE...
set -eu
build=$1
cd "$2"
shift 2
for python in "$build/python-environment/bin/python" python3; do
    if "$python" -c 'import numpy' 2>/dev/null; then
        PYTHONDONTWRITEBYTECODE=1 exec "$python" -m unittest "$@"
    fi
done
echo "skipped: there is no Python with NumPy"
exit 77
