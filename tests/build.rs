//! Where the project is, for paths in it.

fn main() {
    let here = std::path::PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    println!("cargo::rustc-env=PROJECT={}", here.parent().unwrap_or(&here).display());
}
