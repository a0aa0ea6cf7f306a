#!/bin/sh
# Prepares a Python environment with Mitsuba 3 and NumPy for the comparison of pictures; prints why if it cannot.
# The llvm variants also need LLVM (Debian: libllvm19), which they load while they run; see llvm_library.py.
# Usage: mitsuba-environment.sh FOLDER
set -eu
folder=$1
mitsuba="mitsuba==3.9.1"
numpy="numpy==2.4.6"
old_numpy="numpy>=1.22" # for Python below 3.11
skip() {
    echo "The comparison runs without Mitsuba: $1" >&2
    exit 0
}

python=$folder/bin/python
if [ -x "$python" ] && "$python" -c 'import mitsuba, numpy' 2>/dev/null; then exit 0; fi
command -v python3 >/dev/null 2>&1 || skip "there is no python3"
rm -rf "$folder"
python3 -m venv "$folder" >/dev/null 2>&1 || skip "python3 -m venv does not work (Debian: python3-venv)"
pip() { "$python" -m pip install --quiet --disable-pip-version-check --only-binary :all: "$@"; }
pip "$numpy" 2>/dev/null || pip "$old_numpy" || skip "pip could not install NumPy"
pip "$mitsuba" || skip "pip could not install $mitsuba"
