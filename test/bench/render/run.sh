#!/bin/sh
# Tests of the comparison with Mitsuba, which need no Mitsuba. They run in the first of these that has NumPy: the
# build's Python environment, python3. 77: skipped.
# Usage: run.sh BUILD-FOLDER
set -eu
cd "$(dirname "$0")"
for python in "$1/python-environment/bin/python" python3; do
    if "$python" -c 'import numpy' 2>/dev/null; then
        PYTHONDONTWRITEBYTECODE=1 exec "$python" -m unittest pbrt_scene_test mitsuba_scene_test figures_test
    fi
done
echo "skipped: there is no Python with NumPy"
exit 77
