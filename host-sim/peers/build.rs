//! Gives the linker the memory map of the boards.

use std::{env, error::Error, fs, path::PathBuf};

/// Linker scripts of the firmware. Both boards have the same memory.
const SCRIPTS: [(&str, &str); 2] = [("memory.x", "../../firmware/boards/mps2-an385.x"), ("stream.x", "../../firmware/boards/stream.x")];

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=build.rs");
    if env::var_os("CARGO_FEATURE_MPS2").is_none() {
        return Ok(());
    }
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("run by cargo, which sets OUT_DIR")?);
    for (name, path) in SCRIPTS {
        fs::copy(path, out.join(name)).map_err(|e| format!("{path}: {e}"))?;
        println!("cargo:rerun-if-changed={path}");
    }
    let stream = fs::canonicalize("../../firmware/teapot.tri")?;
    println!("cargo:rustc-env=STREAM_FILE={}", stream.display());
    println!("cargo:rustc-link-search={}", out.display());
    for argument in ["--nmagic", "-Tlink.x", "-Tstream.x", "-Tdefmt.x"] {
        println!("cargo:rustc-link-arg-bin=mps2={argument}");
    }
    Ok(())
}
