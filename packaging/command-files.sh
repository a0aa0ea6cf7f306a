#!/bin/sh
# Writes the manual pages and the completion scripts that a program prints of itself below FOLDER/share.
# Usage: command-files.sh PROGRAM FOLDER
set -eu
program=$1 share=$2/share
rm -rf "$share"
man=$share/man/man1 bash=$share/bash-completion/completions zsh=$share/zsh/vendor-completions fish=$share/fish/vendor_completions.d
mkdir -p "$man" "$bash" "$zsh" "$fish"
"$program" manual >"$man/montelux.1"
words=$("$program" completion words '')
[ -n "$words" ] || { echo "command-files.sh: $program names no command" >&2 && exit 1; }
for command in $(echo "$words" | cut -f 1); do
    "$program" manual "$command" >"$man/montelux-$command.1"
done
gzip -9n "$man"/*.1
"$program" completion bash >"$bash/montelux"
"$program" completion zsh >"$zsh/_montelux"
"$program" completion fish >"$fish/montelux.fish"
