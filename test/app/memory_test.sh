#!/bin/sh
# A render needs as much memory for many samples a pixel as for few.
. "$(dirname "$0")/common.sh"

# Beside this picture the pages that are now there and now not are below the hundredth that is asked for.
printf 'PF\n1024 1024\n-1\n' >sky.pfm
head -c 12582912 /dev/zero | tr '\0' '?' >>sky.pfm
printf '%s\n' 'Film "rgb" "integer xresolution" 8 "integer yresolution" 8' 'WorldBegin' \
    'LightSource "infinite" "string filename" "sky.pfm"' 'Shape "sphere"' >scene.pbrt

# peak SPP arguments...: sets `mib` to the least of the peaks of a few runs, whose pages are never quite the same.
peak() {
    spp=$1
    shift
    mib=$(for run in 1 2; do
        "$montelux" render scene.pbrt --spp "$spp" --threads 1 --stats -o out.exr "$@" 2>/dev/null
    done | awk '/^peak memory/ { if (!n++ || $3 < least) least = $3 } END { print least }')
}

for arguments in '--sampler independent' '--sampler sobol' '--adaptive on'; do
    # shellcheck disable=SC2086
    peak 16 $arguments
    few=$mib
    # shellcheck disable=SC2086
    peak 16384 $arguments
    echo "$arguments: $few MiB for 16 samples a pixel, $mib MiB for 16384"
    awk -v few="$few" -v many="$mib" 'BEGIN { exit !(few > 24 && many > 24 && many <= 1.01 * few) }' ||
        fail "$arguments: $few MiB for 16 samples a pixel, $mib MiB for 16384"
done
finish
