#!/bin/sh
# Brings Open Image Denoise (PyPI: pyoidn) into a folder and prints the path of its library; nothing, and why, if that
# cannot be. A library that the system has, or that MONTELUX_OIDN_LIBRARY names, is left to be found as it is.
# Usage: denoiser.sh FOLDER
set -eu
folder=$1
package="pyoidn==2.5.1.0"
skip() {
    echo "The picture is not denoised: $1" >&2
    exit 0
}

if [ -n "${MONTELUX_OIDN_LIBRARY:-}" ]; then
    echo "$MONTELUX_OIDN_LIBRARY"
    exit 0
fi
library() { find "$folder" -name 'libOpenImageDenoise.so.2' 2>/dev/null | head -n 1; }
if [ -z "$(library)" ]; then
    command -v python3 >/dev/null 2>&1 || skip "there is no python3 to fetch Open Image Denoise"
    echo "Fetching Open Image Denoise ($package, 84 MB) into $folder" >&2
    rm -rf "$folder"
    python3 -m venv "$folder" >/dev/null 2>&1 || skip "python3 -m venv does not work (Debian: python3-venv)"
    "$folder/bin/python" -m pip install --quiet --disable-pip-version-check --only-binary :all: --no-deps "$package" ||
        skip "pip could not install $package"
fi
[ -n "$(library)" ] || skip "$package has no library for this machine"
realpath "$(library)"
