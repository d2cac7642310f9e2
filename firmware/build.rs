//! Gives the linker the board's memory map, and the program the path of the stream that it embeds.

use std::{env, error::Error, fs, path::PathBuf};

/// The stream, unless another is named: the teapot by the method `auto`.
const TEAPOT: &str = "teapot.tri";

/// The memory map of the board `pico`. The linker finds it by its name, also for programs of another folder.
const PICO: &str = "../memory.x";

/// Boards, and where their memory maps lie: a board has the name of the file.
fn boards() -> Result<Vec<(String, PathBuf)>, Box<dyn Error>> {
    let mut boards = vec![("pico".to_owned(), PICO.into())];
    for file in fs::read_dir("boards")? {
        let path = file?.path();
        // The script of the stream belongs to all of them.
        if let Some(name) = path.file_stem().and_then(|name| name.to_str()).filter(|&name| name != "stream") {
            boards.push((name.to_owned(), path));
        }
    }
    boards.sort();
    Ok(boards)
}

/// Whether the cargo feature is on.
fn is_on(feature: &str) -> bool {
    env::var_os(format!("CARGO_FEATURE_{}", feature.to_uppercase().replace('-', "_"))).is_some()
}

fn main() -> Result<(), Box<dyn Error>> {
    let boards = boards()?;
    let chosen: Vec<_> = boards.iter().filter(|(name, _)| is_on(name)).collect();
    let [(board, memory)] = chosen[..] else {
        let names: Vec<_> = boards.iter().map(|(name, _)| name.as_str()).collect();
        return Err(format!("enable exactly one board: --no-default-features --features NAME, one of {}", names.join(", ")).into());
    };
    let memory = memory.display().to_string();

    // The linker looks for `memory.x` in its working directory first, then here.
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("run by cargo, which sets OUT_DIR")?);
    fs::copy(&memory, out.join("memory.x")).map_err(|e| format!("{memory}: {e}"))?;
    fs::copy("boards/stream.x", out.join("stream.x")).map_err(|e| format!("boards/stream.x: {e}"))?;
    println!("cargo:rustc-link-search={}", out.display());
    // Relocations stay on the host, as symbols do: `microphong bench` tells from them which function needs which.
    for argument in ["--nmagic", "--emit-relocs", "-Tlink.x", "-Tstream.x", "-Tdefmt.x"] {
        println!("cargo:rustc-link-arg-bins={argument}");
    }
    if board == "pico" {
        // Puts the second stage of the boot loader, part of embassy-rp, in front of the vector table.
        println!("cargo:rustc-link-arg-bins=-Tlink-rp.x");
    }

    let stream = env::var_os("MICROPHONG_STREAM").map_or_else(|| PathBuf::from(TEAPOT), PathBuf::from);
    let stream = fs::canonicalize(&stream).map_err(|e| {
        format!("{}: {e}; name one in MICROPHONG_STREAM, as `microphong convert MESH.obj -o MESH.tri` makes them", stream.display())
    })?;
    println!("cargo:rustc-env=STREAM_FILE={}", stream.display());

    for path in ["build.rs", "boards", &memory] {
        println!("cargo:rerun-if-changed={path}");
    }
    println!("cargo:rerun-if-changed={}", stream.display());
    println!("cargo:rerun-if-env-changed=MICROPHONG_STREAM");
    Ok(())
}
