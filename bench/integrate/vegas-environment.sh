#!/bin/sh
# Prepares a Python environment with the package vegas for the comparison of integrators; prints why if it
# cannot.
# Usage: vegas-environment.sh FOLDER
set -eu
folder=$1
vegas="vegas==6.4.1"
skip() {
    echo "The comparison runs without vegas: $1" >&2
    exit 0
}

if [ -x "$folder/bin/python" ] && "$folder/bin/python" -c 'import vegas' 2>/dev/null; then exit 0; fi
command -v python3 >/dev/null 2>&1 || skip "there is no python3"
rm -rf "$folder"
python3 -m venv "$folder" >/dev/null 2>&1 || skip "python3 -m venv does not work (Debian: python3-venv)"
"$folder/bin/python" -m pip install --quiet --disable-pip-version-check "$vegas" ||
    skip "pip could not install $vegas"
