//! Selects the kernels of the processor that is compiled for, by the name of the target. No `cfg` of Rust tells Thumb from ARM code, or the small
//! instruction set of a Cortex-M23, for which there are no kernels, from the whole one.

fn main() {
    println!("cargo::rustc-check-cfg=cfg(kernels, values(none(), \"armv6m\", \"armv7m\"))");
    println!("cargo::rerun-if-changed=build.rs");
    let target = std::env::var("TARGET").unwrap_or_default();
    let kernels = match target.split('-').next() {
        Some("thumbv6m") => "armv6m",
        Some("thumbv7m" | "thumbv7em" | "thumbv8m.main") => "armv7m",
        _ => return,
    };
    println!("cargo::rustc-cfg=kernels");
    println!("cargo::rustc-cfg=kernels=\"{kernels}\"");
}
