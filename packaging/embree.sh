#!/bin/sh
# Builds Embree for wheels at FOLDER/install, from Debian's source package: for AVX2 alone and without the shapes that
# Montelux does not use, a quarter of the size of Debian's library, which holds the code for several levels of processors.
# Usage: embree.sh FOLDER JOBS
set -eu
mkdir -p "$1"
folder=$(cd "$1" && pwd)
[ -e "$folder/done" ] && exit 0
cd "$folder"
# Sources of packages are off by default; this switches them on for this folder alone.
mkdir -p sources lists/partial
for file in /etc/apt/sources.list.d/*.sources; do
    [ -e "$file" ] && sed 's/^Types:.*/Types: deb-src/' "$file" >"sources/$(basename "$file")"
done
[ -e /etc/apt/sources.list ] && sed -n 's/^deb /deb-src /p' /etc/apt/sources.list >sources/main.list
apt() {
    apt-get -qq -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$folder/sources" -o Dir::State::lists="$folder/lists" \
        -o APT::Sandbox::User=root "$@"
}
apt update
apt source --tar-only embree
tar xf embree_*.orig.tar.*
source=$(echo embree-*/)
touch "${source}readme.pdf" # is installed, and left out of Debian's sources
features=
for part in SUBDIVISION CURVE GRID POINT QUAD; do features="$features -D EMBREE_GEOMETRY_$part=OFF"; done
for level in SSE2 SSE42 AVX AVX512; do features="$features -D EMBREE_ISA_$level=OFF"; done
# shellcheck disable=SC2086
cmake -S "$source" -B build -G Ninja -D CMAKE_BUILD_TYPE=Release -D CMAKE_INSTALL_PREFIX="$folder/install" \
    -D EMBREE_MAX_ISA=NONE -D EMBREE_ISA_AVX2=ON $features -D EMBREE_RAY_PACKETS=OFF -D EMBREE_ISPC_SUPPORT=OFF \
    -D EMBREE_TUTORIALS=OFF -D EMBREE_TASKING_SYSTEM=TBB >cmake.log
cmake --build build --parallel "$2" --target install >build.log 2>&1 || { tail -20 build.log && exit 1; }
touch done
