#!/bin/sh
# Makes the archive of a release, in target/archives: the command, its completions, manual pages, README and licences.
# With a target, for that one: sh scripts/release.sh x86_64-unknown-linux-musl. It must run on this machine.
set -eu
cd "$(dirname "$0")/.."
target="${1:-$(rustc -vV | sed -n 's/^host: //p')}"
built="${CARGO_TARGET_DIR:-target}"
cargo build --release --locked -p signorini-cli --target "$target"
case "$target" in
    *windows*) command="signorini.exe" ;;
    *) command="signorini" ;;
esac
version=$(cargo pkgid -p signorini-cli | sed 's/.*[#@]//')
name="signorini-$version-$target"
archives="$built/archives"
folder="$archives/$name"
rm -rf "$folder"
mkdir -p "$folder/completions" "$folder/man/man1" "$folder/licences"
cp "$built/$target/release/$command" README.md CITATION.cff CHANGELOG.md "$folder"
cp LICENSE-MIT LICENSE-APACHE "$folder/licences"
"$folder/$command" completions bash > "$folder/completions/signorini.bash"
"$folder/$command" completions zsh > "$folder/completions/_signorini"
"$folder/$command" completions fish > "$folder/completions/signorini.fish"
"$folder/$command" man "$folder/man/man1" > /dev/null
sh scripts/licences.sh signorini-cli "$target" > "$folder/licences/THIRD-PARTY.txt"
tar -czf "$archives/$name.tar.gz" -C "$archives" "$name"
rm -r "$folder"
echo "$archives/$name.tar.gz"
