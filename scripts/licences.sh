#!/bin/sh
# Prints the licences of everything that a program contains: sh scripts/licences.sh signorini-cli [TARGET]
set -eu
cd "$(dirname "$0")/.."
target="${2:-$(rustc -vV | sed -n 's/^host: //p')}"
sources="${CARGO_HOME:-$HOME/.cargo}/registry/src"
# Libraries in JavaScript.
for file in crates/*/assets/libraries/LICENSE-*; do
    printf '\n==== %s\n\n' "${file##*/LICENSE-}"
    cat "$file"
done
# Crates; those of the workspace have the licences of signorini.
cargo tree --locked -p "$1" --target "$target" -e normal --prefix none --format '{p}|{l}' |
    sed '/^signorini/d; /(proc-macro)/d; s/ (\*)$//' | sort -u |
    while IFS='|' read -r crate licence; do
        name="${crate%% v*}"
        version="${crate##* v}"
        printf '\n==== %s %s: %s\n\n' "$name" "$version" "$licence"
        find "$sources"/*/"$name-$version" -type f \( -iname 'licen[sc]e*' -o -iname 'copying*' -o -iname 'notice*' \
            -o -iname 'ofl*' -o -iname 'ufl*' \) -exec cat {} +
    done
