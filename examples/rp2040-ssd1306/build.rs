//! Shows the linker the board's memory, `memory.x` in this folder.

fn main() {
    println!("cargo:rustc-link-search={}", env!("CARGO_MANIFEST_DIR"));
    // The last one puts the second stage of the boot loader, part of embassy-rp, in front of the vector table.
    for argument in ["--nmagic", "-Tlink.x", "-Tdefmt.x", "-Tlink-rp.x"] {
        println!("cargo:rustc-link-arg-bins={argument}");
    }
    println!("cargo:rerun-if-changed=memory.x");
}
