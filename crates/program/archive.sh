#!/usr/bin/env bash
# Builds the program for one target and packs what a release offers: the program, manual pages, completions and licences.
#
#   crates/program/archive.sh [TARGET]        the host's own without TARGET
#
# Writes target/dist/corner-impact-VERSION-TARGET.tar.gz (.zip for Windows) and its checksum beside it. For another target than the
# host's, and for Linux with its oldest C library, cargo-zigbuild links (`pip install cargo-zigbuild` brings it with zig).
set -euo pipefail
cd "$(dirname "$0")/../.."
cargo=${CARGO:-cargo}
host=$(rustc -vV | sed -n 's/^host: //p')
target=${1:-$host}
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
[ -s crates/program/module/explore.wasm.gz ] || { echo "archive: run \`make explore\` first: a release has the live page" >&2; exit 2; }

# Manual pages and completions are the host's to print.
"$cargo" build --release --locked --quiet --package corner-impact-cli
prints=target/release/corner-impact
case $target in
    *-linux-gnu) "$cargo" zigbuild --release --locked --quiet --package corner-impact-cli --target "$target.2.28" ;;
    "$host" | *-msvc) "$cargo" build --release --locked --quiet --package corner-impact-cli --target "$target" ;;
    *-darwin) [ "$(uname)" = Darwin ] && link=build || link=zigbuild
        "$cargo" $link --release --locked --quiet --package corner-impact-cli --target "$target" ;;
    *) "$cargo" zigbuild --release --locked --quiet --package corner-impact-cli --target "$target" ;;
esac

name=corner-impact-$version-$target
new=target/dist/$name.new
rm -rf "$new"
mkdir -p "$new/$name/completions" "$new/$name/man"
case $target in *-windows-*) program=corner-impact.exe ;; *) program=corner-impact ;; esac
cp "target/$target/release/$program" README.md CHANGELOG.md CITATION.cff LICENSE-* "$new/$name/"
# The names under which the shells look for them.
for file in bash:corner-impact.bash elvish:corner-impact.elv fish:corner-impact.fish powershell:_corner-impact.ps1 zsh:_corner-impact; do
    "$prints" completions "${file%%:*}" > "$new/$name/completions/${file#*:}"
done
"$prints" man --quiet --out "$new/$name/man"
cd target/dist
case $target in
    *-windows-*) file=$name.zip; (cd "$name.new" && python3 -m zipfile -c "../$file" "$name") ;;
    *) file=$name.tar.gz; tar --create --gzip --file "$file" --directory "$name.new" "$name" ;;
esac
rm -rf "$name.new"
python3 -c 'import hashlib, sys; print(hashlib.sha256(open(sys.argv[1], "rb").read()).hexdigest(), sys.argv[1], sep="  ")' "$file" > "$file.sha256"
echo "target/dist/$file: $(wc -c < "$file") bytes"
