#!/bin/sh
# Prepares a virtual environment in which the Python package can be built and tested; on failure prints why
# and exits with 1.
# Usage: python-environment.sh FOLDER
set -eu
folder=$1
packages="nanobind==3.1.0 numpy>=1.22 pytest>=7 mypy>=1.11"
python=/usr/bin/python3
[ -x "$python" ] || python=python3
fail() {
    echo "$1" >&2
    exit 1
}

if [ -x "$folder/bin/python" ] && "$folder/bin/python" -c 'import mypy, nanobind, numpy, pytest' 2>/dev/null; then exit 0; fi
command -v "$python" >/dev/null 2>&1 || fail "there is no python3"
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 10))' || fail "python3 is older than 3.10"
[ -e "$("$python" -c 'import sysconfig; print(sysconfig.get_path("include"))')/Python.h" ] ||
    fail "there are no headers of Python (Debian: python3-dev)"
rm -rf "$folder"
"$python" -m venv "$folder" >/dev/null 2>&1 || fail "python3 -m venv does not work (Debian: python3-venv)"
# A machine without a network must not wait for it.
# shellcheck disable=SC2086
"$folder/bin/python" -m pip install --quiet --disable-pip-version-check --only-binary :all: --retries 1 --timeout 10 \
    $packages >"$folder/pip.log" 2>&1 || { rm -rf "$folder"; fail "pip could not install $packages"; }
