#!/bin/sh
# A render needs as much memory for many samples per pixel as for few.
. "$(dirname "$0")/common.sh"

# Fluctuations of the page count are below the tolerance of 1 % for a picture of this size.
printf 'PF\n2048 2048\n-1\n' >sky.pfm
head -c 50331648 /dev/zero | tr '\0' '?' >>sky.pfm
printf '%s\n' 'Film "rgb" "integer xresolution" 8 "integer yresolution" 8' 'WorldBegin' \
    'LightSource "infinite" "string filename" "sky.pfm"' 'Shape "sphere"' >scene.pbrt

# peak SPP arguments...: sets `mib` to the peak of one render.
peak() {
    spp=$1
    shift
    "$montelux" render scene.pbrt --spp "$spp" --threads 1 --stats -o out.exr "$@" >out 2>&1 || {
        fail "montelux render --spp $spp $*"
        cat out
    }
    mib=$(awk '/^peak memory/ { print $3 }' out)
}

# least A B: the lesser of two numbers, A where B is empty.
least() {
    echo "$1 $2" | awk '{ print(NF > 1 && $2 < $1 ? $2 : $1) }'
}

# Kernels count pages per processor in batches, so peaks fluctuate between runs; true growth shows in every run.
for arguments in '--sampler independent' '--sampler sobol' '--adaptive on'; do
    few='' many='' runs=0
    until [ $runs -gt 0 ] && awk -v few="$few" -v many="$many" 'BEGIN { exit !(many <= 1.01 * few) }'; do
        if [ $runs -eq 4 ]; then
            fail "$arguments: $few MiB for 16 samples per pixel, $many MiB for 16384"
            break
        fi
        # shellcheck disable=SC2086
        peak 16 $arguments
        few=$(least "$mib" "$few")
        # shellcheck disable=SC2086
        peak 16384 $arguments
        many=$(least "$mib" "$many")
        runs=$((runs + 1))
    done
    echo "$arguments: $few MiB for 16 samples per pixel, $many MiB for 16384, the least of $runs"
    awk -v few="$few" -v many="$many" 'BEGIN { exit !(few > 96 && many > 96) }' ||
        fail "$arguments: $few and $many MiB are less than the picture of the scene alone"
done
finish
