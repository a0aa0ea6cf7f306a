#!/bin/sh
# Prepares a Python environment with what the tests of the viewer's page need.
# Usage: environment.sh FOLDER
set -eu
folder=$1
if [ -x "$folder/bin/python" ] && "$folder/bin/python" -c 'import playwright, aiohttp, numpy' 2>/dev/null; then exit 0; fi
rm -rf "$folder"
python3 -m venv "$folder"
"$folder/bin/python" -m pip install --quiet --disable-pip-version-check --only-binary :all: playwright aiohttp numpy
