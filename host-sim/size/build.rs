//! Gives the linker a memory map with room for any program, and the program the path of a stream to begin with.

use std::{env, error::Error, fs, path::PathBuf};

/// Flash, RAM and the memory for streams are where the boards mps2-an* of QEMU have memory.
const MAP: &str = "\
MEMORY
{
  FLASH  : ORIGIN = 0x00000000, LENGTH = 4M
  RAM    : ORIGIN = 0x20000000, LENGTH = 4M
  STREAM : ORIGIN = 0x21000000, LENGTH = 16M
}
";
/// Names that the linker script of RISC-V has for them.
const REGIONS: [(&str, &str); 6] =
    [("TEXT", "FLASH"), ("RODATA", "FLASH"), ("DATA", "RAM"), ("BSS", "RAM"), ("HEAP", "RAM"), ("STACK", "RAM")];

fn main() -> Result<(), Box<dyn Error>> {
    let is_riscv = env::var("TARGET")?.starts_with("riscv32");
    let mut map = MAP.to_owned();
    if is_riscv {
        map.extend(REGIONS.map(|(region, memory)| format!("REGION_ALIAS(\"REGION_{region}\", {memory});\n")));
    }
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("run by cargo, which sets OUT_DIR")?);
    fs::write(out.join("memory.x"), map)?;
    let script = "../../firmware/boards/stream.x";
    fs::copy(script, out.join("stream.x")).map_err(|e| format!("{script}: {e}"))?;
    println!("cargo:rustc-link-search={}", out.display());
    if is_riscv {
        println!("cargo:rustc-link-arg-bins=-Tmemory.x");
    }
    for argument in ["--nmagic", "-Tlink.x", "-Tstream.x"] {
        println!("cargo:rustc-link-arg-bins={argument}");
    }
    let stream = fs::canonicalize("../../firmware/teapot.tri")?;
    println!("cargo:rustc-env=STREAM_FILE={}", stream.display());
    for path in ["build.rs", script] {
        println!("cargo:rerun-if-changed={path}");
    }
    println!("cargo:rerun-if-changed={}", stream.display());
    Ok(())
}
