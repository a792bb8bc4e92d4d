//! Names the shared library for what its users ask the loader for: the version of the ABI.

/// As `FT_ABI_VERSION` of `src/version.rs`; a test compares them.
const ABI_VERSION: u32 = 1;

fn main() {
    let system = std::env::var("CARGO_CFG_TARGET_OS").unwrap_or_default();
    if system == "linux" {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libfingertip.so.{ABI_VERSION}");
    }
    println!("cargo::rerun-if-changed=build.rs");
}
