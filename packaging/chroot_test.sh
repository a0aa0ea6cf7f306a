#!/bin/bash
# Installs the wheel and the Debian packages on a bare Debian 12 and uses them; as root, with a network.
# Usage: chroot_test.sh FOLDER-OF-WHEELS FOLDER-OF-DEBS CHROOT, from the root of the repository. Exit code 77: cannot be done here.
set -eu
wheels=$1 debs=$2 root=$3
suite=bookworm
[ "$(id -u)" -eq 0 ] || { echo "skipped: a chroot needs root" && exit 77; }
command -v debootstrap >/dev/null || { echo "skipped: there is no debootstrap" && exit 77; }
mkdir -p "$root"
root=$(cd "$root" && pwd)

if ! [ -e "$root/bare" ]; then # a bare system is made once and copied for each test
    rm -rf "$root/new"
    debootstrap --variant=minbase $suite "$root/new" >"$root/debootstrap.log" || { tail "$root/debootstrap.log" && exit 1; }
    mv "$root/new" "$root/bare"
fi

# The network as it is here: names, mirrors, certificates, pip's index.
connect() {
    local file
    rm -f "$1/etc/apt/sources.list"
    for file in /etc/resolv.conf /etc/hosts /etc/apt/sources.list /etc/apt/sources.list.d /etc/apt/apt.conf.d /etc/pip.conf; do
        [ -e "$file" ] || continue
        mkdir -p "$1$(dirname "$file")"
        rm -rf "${1:?}$file"
        cp -rL "$file" "$1$file"
    done
    echo 'Dpkg::Use-Pty "0";' >"$1/etc/apt/apt.conf.d/99-no-terminal"
    cp -L /etc/ssl/certs/ca-certificates.crt "$1/certificates.crt" 2>/dev/null || true
}
enter() {
    local system=$1
    shift
    local certificates=()
    [ -e "$system/certificates.crt" ] && certificates=({SSL_CERT_FILE,PIP_CERT,REQUESTS_CA_BUNDLE}=/certificates.crt)
    env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "${certificates[@]}" \
        $(env | grep -iE '^(https?_proxy|no_proxy|pip_(extra_)?index_url)=' || true) \
        unshare --mount --pid --fork --kill-child chroot "$system" sh -c 'mount -t proc proc /proc && exec "$@"' sh "$@"
}
fresh() {
    rm -rf "${root:?}/$1"
    cp -a "$root/bare" "$root/$1"
    connect "$root/$1"
    mkdir "$root/$1/montelux"
    git archive HEAD README.md pyproject.toml docs montelux scenes python/tests examples packaging | tar -x -C "$root/$1/montelux"
}

fresh wheel
cp "$wheels"/*.whl "$root/wheel/montelux/"
enter "$root/wheel" sh -eu /montelux/packaging/use_wheel.sh
fresh debian
cp "$debs"/*.deb "$root/debian/montelux/"
enter "$root/debian" sh -eu /montelux/packaging/use_packages.sh
echo "the packages work on a bare Debian 12 ($suite)"
