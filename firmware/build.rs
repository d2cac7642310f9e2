//! Gives the linker the board's memory map, and the program the path of the stream that it embeds.

use std::{env, error::Error, fs, path::PathBuf};

/// The stream, unless another is named: the teapot by the method `auto`.
const TEAPOT: &str = "teapot.tri";

/// Features that choose a board, and where its memory map lies.
const BOARDS: [(&str, &str); 4] = [
    ("PICO", "../memory.x"),
    ("LM3S6965EVB", "boards/lm3s6965evb.x"),
    ("MPS2_AN385", "boards/mps2-an385.x"),
    ("MPS2_AN386", "boards/mps2-an386.x"),
];

fn main() -> Result<(), Box<dyn Error>> {
    let chosen: Vec<_> = BOARDS.iter().filter(|(feature, ..)| env::var_os(format!("CARGO_FEATURE_{feature}")).is_some()).collect();
    let [(board, memory)] = chosen[..] else {
        return Err("enable exactly one board: --no-default-features --features lm3s6965evb (or pico, mps2-an385, mps2-an386)".into());
    };

    // The linker looks for `memory.x` in its working directory first, then here.
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("run by cargo, which sets OUT_DIR")?);
    fs::copy(memory, out.join("memory.x")).map_err(|e| format!("{memory}: {e}"))?;
    fs::copy("boards/stream.x", out.join("stream.x")).map_err(|e| format!("boards/stream.x: {e}"))?;
    println!("cargo:rustc-link-search={}", out.display());
    // Relocations stay on the host, as symbols do: `microphong bench` tells from them which function needs which.
    for argument in ["--nmagic", "--emit-relocs", "-Tlink.x", "-Tstream.x", "-Tdefmt.x"] {
        println!("cargo:rustc-link-arg-bins={argument}");
    }
    if *board == "PICO" {
        // Puts the second stage of the boot loader, part of embassy-rp, in front of the vector table.
        println!("cargo:rustc-link-arg-bins=-Tlink-rp.x");
    }

    let stream = env::var_os("MICROPHONG_STREAM").map_or_else(|| PathBuf::from(TEAPOT), PathBuf::from);
    let stream = fs::canonicalize(&stream).map_err(|e| {
        format!("{}: {e}; name one in MICROPHONG_STREAM, as `microphong convert MESH.obj -o MESH.tri` makes them", stream.display())
    })?;
    println!("cargo:rustc-env=STREAM_FILE={}", stream.display());

    for path in ["build.rs", "boards", memory] {
        println!("cargo:rerun-if-changed={path}");
    }
    println!("cargo:rerun-if-changed={}", stream.display());
    println!("cargo:rerun-if-env-changed=MICROPHONG_STREAM");
    Ok(())
}
