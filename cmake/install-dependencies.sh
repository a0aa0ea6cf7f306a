#!/bin/sh
# Installs the Debian packages that are missing, and only those; as root, or with sudo.
# Usage: install-dependencies.sh [build|bench|bench-render|browser|docs|fuzz|lint|packages] [--dry-run]
set -eu

# docs/dependencies.md says what each is for.
packages="make cmake ninja-build g++ libtbb-dev libboost-math-dev libembree-dev libopenexr-dev libpng-dev
    libjpeg62-turbo-dev zlib1g-dev libxxhash-dev libstb-dev nlohmann-json3-dev libexpat1-dev libnanovdb-dev libblosc-dev libmeshoptimizer-dev libdraco-dev libwebp-dev
    libcli11-dev libmuparser-dev
    libgtest-dev libbenchmark-dev libopenmpi-dev openmpi-bin python3-dev python3-venv"
dry_run=no
for argument in "$@"; do
    case $argument in
    build) ;;
    bench) packages="$packages libgsl-dev libcubature-dev" ;;
    bench-render) packages="$packages libllvm19" ;;
    browser) packages="$packages chromium" ;;
    docs) packages="$packages doxygen" ;;
    fuzz) packages="$packages clang libclang-rt-14-dev" ;;
    lint) packages="$packages clang-format clang-tidy" ;;
    packages) packages="$packages dpkg-dev file gzip lintian debootstrap" ;;
    --dry-run) dry_run=yes ;;
    *) echo "install-dependencies.sh: unknown argument '$argument' (expected build, bench, bench-render, browser, docs, fuzz, lint, packages or --dry-run)" >&2
       exit 2 ;;
    esac
done

if ! command -v dpkg-query >/dev/null 2>&1 || ! command -v apt-get >/dev/null 2>&1; then
    echo "Not a Debian system, so nothing is installed. Montelux needs what these Debian packages hold:" \
        $packages >&2
    exit 0
fi

missing=
for package in $packages; do
    status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
    case $status in
    installed*) ;;
    *) missing="$missing $package" ;;
    esac
done
[ -n "$missing" ] || exit 0

run=
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null 2>&1; then
        echo "Montelux needs these packages, and neither are you root nor is there a sudo. As root, run:" >&2
        echo "    apt-get update && apt-get install --no-install-recommends$missing" >&2
        exit 1
    fi
    run=sudo
fi

echo "Installing packages that are missing:$missing"
if [ $dry_run = yes ]; then
    echo "would run: ${run:+$run }apt-get install --yes --no-install-recommends$missing"
    exit 0
fi
# `env` carries the setting through sudo, which drops the environment.
install() { $run env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends $missing; }
# Package lists may be absent (container images) or too old: then fetch them and try again.
if install 2>/dev/null; then exit 0; fi
echo "The package lists are absent or stale; fetching them."
$run apt-get update
if ! install; then
    echo "apt-get could not install:$missing (its own message is above)." >&2
    exit 1
fi
