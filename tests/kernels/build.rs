//! Tells the linker where the memory of the emulated processor lies.

use std::{env, fs, path::Path};

fn main() {
    // A micro:bit (Cortex-M0) and an MPS2 with a Cortex-M3 have memory at the same place, an MPS2 with a Cortex-M33 elsewhere.
    let target = env::var("TARGET").expect("cargo says it");
    let [flash, ram] = if target.starts_with("thumbv8m") { ["0x10000000", "0x80000000"] } else { ["0x00000000", "0x20000000"] };
    let bytes = if target.starts_with("thumbv6m") { "16K" } else { "64K" };
    let map = format!("MEMORY {{ FLASH : ORIGIN = {flash}, LENGTH = 256K RAM : ORIGIN = {ram}, LENGTH = {bytes} }}\n");
    let out = env::var("OUT_DIR").expect("cargo runs this");
    fs::write(Path::new(&out).join("memory.x"), map).expect("the folder can be written");
    println!("cargo::rustc-link-search={out}");
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    println!("cargo::rerun-if-changed=build.rs");
}
