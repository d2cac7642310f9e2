//! Tells the linker where the memory of the emulated processor lies.

use std::{env, fs, path::Path};

fn main() {
    // A micro:bit (Cortex-M0) and an MPS2 with a Cortex-M3 have memory at the same place, an MPS2 with a Cortex-M33 elsewhere.
    let is_armv8m = env::var("TARGET").is_ok_and(|target| target.starts_with("thumbv8m"));
    let [flash, ram] = if is_armv8m { ["0x10000000", "0x80000000"] } else { ["0x00000000", "0x20000000"] };
    let map = format!("MEMORY {{ FLASH : ORIGIN = {flash}, LENGTH = 256K RAM : ORIGIN = {ram}, LENGTH = 16K }}\n");
    let out = env::var("OUT_DIR").expect("cargo runs this");
    fs::write(Path::new(&out).join("memory.x"), map).expect("the folder can be written");
    println!("cargo::rustc-link-search={out}");
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    println!("cargo::rerun-if-changed=build.rs");
}
