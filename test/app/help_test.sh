#!/bin/bash
# Completion of shells, manual pages and --version: what the program says of itself.
. "$(dirname "$0")/common.sh"

# offers WORDS... = EXPECTED...: the completions of the last word.
offers() {
    local words=() got
    while [ "$1" != == ]; do
        words+=("$1")
        shift
    done
    shift
    got=$("$montelux" completion words "${words[@]}" | cut -f 1 | tr '\n' ' ')
    [ "$got" = "${*:+$* }" ] || fail "after '${words[*]}': '$got' instead of '$*'"
}
offers re == render
offers render --ton == --tone
offers render scene.pbrt --tone '' == linear srgb aces agx filmic
offers render --tone a == aces agx
offers render --tone=a == --tone=aces --tone=agx
offers render --tone = a == aces agx # as bash splits it
offers render --tone = == linear srgb aces agx filmic
offers render --adaptive '' == on off
offers render --layers position,de == position,default position,depth position,depth-slopes
offers render --spp '' ==          # a number
offers render --spp 16 -o out == # a file
offers render --quiet --to == --tone # a flag takes no value
offers bake sk == sky
offers bake environment --up '' == y z
offers completion '' == bash zsh fish
offers nothing --x ==
[ "$("$montelux" completion words '' | wc -l)" -ge 12 ] || fail "commands are missing"
"$montelux" completion words render --sp | grep -q $'^--spp\tSamples per pixel' || fail "no description"

# The script of bash itself.
answer=$(bash --norc -c 'source <("$1" completion bash)
    COMP_WORDS=("$1" render --tone a) COMP_CWORD=3
    _montelux && echo "${COMPREPLY[*]}"' bash "$montelux")
[ "$answer" = "aces agx" ] || fail "bash completes '$answer'"
if command -v zsh >/dev/null; then
    "$montelux" completion zsh >_montelux && zsh -n _montelux || fail "the script for zsh"
fi
if command -v fish >/dev/null; then
    "$montelux" completion fish >montelux.fish
    mkdir program && ln -s "$montelux" program/montelux
    answer=$(HOME=$PWD PATH=$PWD/program:$PATH fish --no-config -c \
        'source montelux.fish; complete -C "montelux render --tone a"' | tr '\n' ' ')
    [ "$answer" = "aces agx " ] || fail "fish completes '$answer'"
fi
expect 2 "tcsh not in {bash,zsh,fish}" completion tcsh

# Every command has a page, on which every option of its help stands.
for command in '' $("$montelux" completion words '' | cut -f 1); do
    "$montelux" manual $command >page.1 || fail "manual $command"
    head -1 page.1 | grep -q '^\.TH MONTELUX' || fail "manual $command: no title"
    "$montelux" $command --help | sed -n 's/^  \(-.,\)*\(--[a-z-]*\).*/\2/p' | while read -r option; do
        tr -d '\\' <page.1 | grep -qF -- "fB${option}fR" || echo "$option"
    done >missing.txt
    [ -s missing.txt ] && fail "manual $command lacks $(tr '\n' ' ' <missing.txt)"
    if command -v mandoc >/dev/null; then
        mandoc -T lint -W error page.1 >lint.txt || fail "manual $command: $(cat lint.txt)"
    fi
    if command -v groff >/dev/null && ls /usr/share/groff/*/tmac/an.tmac >/dev/null 2>&1; then
        groff -man -Tutf8 -ww -z page.1 2>warnings.txt && [ ! -s warnings.txt ] || fail "manual $command: $(cat warnings.txt)"
    fi
done
"$montelux" manual bake >page.1
for command in environment brdf report sky; do
    grep -q "^\.SH montelux bake $command" page.1 || fail "manual bake: no section of $command"
done
expect 2 "there is no command 'rendr'" manual rendr

"$montelux" --version >version.txt
grep -q '^montelux [0-9.]*$' version.txt || fail "the version: $(cat version.txt)"
grep -q '^with: .*Embree 3\..*, oneTBB .*, OpenEXR' version.txt || grep -q '^with: .*Embree 4\.' version.txt ||
    fail "the libraries: $(cat version.txt)"
grep -q '^Open Image Denoise: ' version.txt || fail "the denoiser: $(cat version.txt)"
MONTELUX_OIDN_LIBRARY=/nowhere/libnone.so "$montelux" --version | grep -q '^Open Image Denoise: not found' ||
    fail "a denoiser that is not there"
finish
