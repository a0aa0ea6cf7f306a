#!/bin/sh
# Runs mitsuba_scene_test.py with the first of these that has NumPy: the build's Python environment, python3.
# Usage: mitsuba_scene_test.sh BUILD-FOLDER
set -eu
for python in "$1/python-environment/bin/python" python3; do
    if "$python" -c 'import numpy' 2>/dev/null; then
        PYTHONDONTWRITEBYTECODE=1 exec "$python" "$(dirname "$0")/mitsuba_scene_test.py"
    fi
done
echo "skipped: there is no Python with NumPy"
exit 77
