#!/bin/sh
# `pip install .` in a fresh virtual environment, then the Python example of the README and the tests of the package.
# Usage: package_test.sh WORK-FOLDER
set -eu
source=$(cd "$(dirname "$0")/../.." && pwd)
work=$1
python=/usr/bin/python3
[ -x "$python" ] || python=python3
rm -rf "$work"
mkdir -p "$work"
"$python" -m venv "$work/environment" || { echo "python3 -m venv does not work"; exit 77; }
"$work/environment/bin/python" -m pip download --quiet --no-deps --dest "$work/download" nanobind >/dev/null 2>&1 ||
    { echo "there is no network to install nanobind from"; exit 77; }
# A folder of its own, so that a compiler cache knows the files again.
"$work/environment/bin/python" -m pip install --quiet --disable-pip-version-check "$source[test,gvar]" \
    --config-settings=build-dir="$work/build"
cd "$work"
ln -s "$source/scenes" scenes
awk '/^```python$/ {inside = 1; next} /^```$/ {inside = 0} inside' "$source/README.md" >example.py
[ -s example.py ]
"$work/environment/bin/python" example.py
test -s studio.png
"$work/environment/bin/python" -m pytest -q -p no:cacheprovider "$source/python/tests"
