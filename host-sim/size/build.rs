//! Gives the linker the memory map of an emulated board with this processor, which has room for any program, and the program the path of a stream
//! to begin with.

use std::{env, error::Error, fs, path::PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    let target = env::var("TARGET")?;
    let board = match target.as_str() {
        "riscv32imc-unknown-none-elf" => "riscv-virt",
        "thumbv8m.main-none-eabihf" => "mps2-an505",
        "thumbv7em-none-eabihf" => "mps2-an386",
        _ => "mps2-an385",
    };
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("run by cargo, which sets OUT_DIR")?);
    let (memory, script) = (format!("../../firmware/boards/{board}.x"), "../../firmware/boards/stream.x");
    for (path, name) in [(memory.as_str(), "memory.x"), (script, "stream.x")] {
        fs::copy(path, out.join(name)).map_err(|e| format!("{path}: {e}"))?;
    }
    println!("cargo:rustc-link-search={}", out.display());
    for argument in ["--nmagic", "-Tlink.x", "-Tstream.x"] {
        println!("cargo:rustc-link-arg-bins={argument}");
    }
    let stream = fs::canonicalize("../../firmware/teapot.tri")?;
    println!("cargo:rustc-env=STREAM_FILE={}", stream.display());
    for path in ["build.rs", &memory, script] {
        println!("cargo:rerun-if-changed={path}");
    }
    println!("cargo:rerun-if-changed={}", stream.display());
    Ok(())
}
