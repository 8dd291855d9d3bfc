#!/usr/bin/env bash
# Builds the live page's module and puts it where the program includes it: crates/program/module/explore.wasm.gz.
#
# The standard library for a browser comes from rustup. Where rustup cannot fetch it, Debian's compiler for the web and its sources are
# unpacked below target/, and the standard library is built with the module. Without either there is no module: exit code 3.
set -euo pipefail
cd "$(dirname "$0")/../.."
target=wasm32-unknown-unknown
module=crates/program/module/explore.wasm.gz
cargo=${CARGO:-cargo}

built() {
    "$cargo" "$@" build --locked --quiet --profile module --package corner-impact-explore-module --target "$target"
}

if [ -d "$(rustc --print sysroot)/lib/rustlib/$target" ] || rustup target add "$target" >/dev/null 2>&1; then
    built
elif command -v apt-get dpkg >/dev/null; then
    tools=$PWD/target/debian-web
    mkdir -p "$tools"
    (
        cd "$tools"
        packages=$(apt-cache depends --recurse --no-recommends --no-suggests --no-conflicts --no-breaks --no-replaces --no-enhances \
            rustc-web rust-web-src | grep -E '^(rustc-web|rust-web-src|libstd-rust-web.*|libllvm[0-9]+)$' | sort -u)
        # shellcheck disable=SC2086
        apt-get download $packages >/dev/null
        for package in *.deb; do dpkg -x "$package" .; done
    ) || { echo "make explore: neither rustup nor apt-get has the standard library for a browser" >&2; exit 3; }
    host=$(rustc -vV | sed -n 's/^host: //p')
    export RUSTC="$tools/usr/bin/rustc" RUSTC_BOOTSTRAP=1
    export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER
    CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER="$(rustc --print sysroot)/lib/rustlib/$host/bin/rust-lld"
    LD_LIBRARY_PATH="$(dirname "$(find "$tools" -name 'libLLVM.so*' | head -1)"):$tools/usr/lib/x86_64-linux-gnu" \
        CARGO_TARGET_DIR=target/debian-web/target built -Zbuild-std=std,panic_abort
else
    echo "make explore: rustup cannot fetch the standard library for a browser, and there is no apt-get" >&2
    exit 3
fi
wasm=target/$target/module/corner_impact_explore_module.wasm
[ -z "${RUSTC_BOOTSTRAP:-}" ] || wasm=target/debian-web/target/$target/module/corner_impact_explore_module.wasm
# Written whole or not at all.
gzip -9 -n -c "$wasm" > "$module.new"
mv "$module.new" "$module"
echo "$module: $(wc -c < "$module") bytes"
