//! Gives the linker the memory map of the firmware, and an entry to the files with one scene each.

fn main() {
    println!("cargo:rustc-link-search={}", std::env::var("CARGO_MANIFEST_DIR").unwrap_or_default());
    println!("cargo:rustc-link-arg-bin=firmware=-Tlink.x");
    for scene in ["scene_a", "scene_b", "scene_c", "scene_d", "scene_e", "control"] {
        println!("cargo:rustc-link-arg-bin={scene}=--entry=scene");
        println!("cargo:rustc-link-arg-bin={scene}=--gc-sections");
    }
    println!("cargo:rerun-if-changed=memory.x");
}
