#!/bin/sh
# Prepares a Python environment with Blender as a module, which the tests of the add-on need (a download of 400 MB).
# Usage: environment.sh FOLDER
set -eu
folder=$1
if [ -x "$folder/bin/python" ] && "$folder/bin/python" -c 'import bpy, pytest, numpy' 2>/dev/null; then exit 0; fi
# Wheels of bpy are for one version of Python each.
python=$(command -v python3.11 || true)
if [ -z "$python" ]; then
    echo "the tests of the Blender add-on need Python 3.11, for which bpy 5.0 is made" >&2
    exit 1
fi
rm -rf "$folder"
"$python" -m venv "$folder"
"$folder/bin/python" -m pip install --quiet --disable-pip-version-check --only-binary :all: 'bpy==5.0.*' pytest numpy
