//! Builds the page of the playground: `cargo run --release -p microphong-web`.
//!
//! The page is one file. A page that is opened from disk can fetch nothing, so the module, its style and its scripts are in its text. The module is
//! packed by LZMA, and a second, small module unpacks it: loops for several pixel formats are alike, and gzip looks for likeness in 32 KB alone. Browsers
//! unpack the second module themselves, which is packed by gzip.

use anyhow::{Context, Result, ensure};
use base64::{Engine, engine::general_purpose::STANDARD};
use flate2::{Compression, write::GzEncoder};
use lzma_rust2::{LzmaOptions, LzmaWriter};
use std::{
    env, fs,
    io::Write,
    path::{Path, PathBuf},
    process::Command,
};

/// Largest number of bytes of both packed modules.
const LARGEST: usize = 1_020_000;

/// Bytes in which LZMA looks for likeness: more than the module has.
const DICTIONARY: u32 = 8 << 20;

/// The parts of the page that take the place of their names in its text.
const PARTS: [(&str, &str); 3] = [
    ("/* style.css */", include_str!("../page/style.css")),
    ("/* worker.js */", include_str!("../page/worker.js")),
    ("/* page.js */", include_str!("../page/page.js")),
];

fn main() -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    compile(&root, &target)?;
    let [module, unpacker] = ["module", "unpacker"].map(|name| {
        let file = target.join(TRIPLE).join(format!("web/microphong_web_{name}.wasm"));
        fs::read(&file).with_context(|| format!("cannot read {}", file.display()))
    });
    let (module, unpacker) = (module?, unpacker?);
    let (packed, unpacker) = (packed(&module)?, gzipped(&unpacker)?);
    let all = packed.len() + unpacker.len();
    ensure!(all <= LARGEST, "the packed modules have {all} bytes, and may have {LARGEST}; find what has grown");
    let length = module.len().to_string();
    let [packed, unpacker] = [packed, unpacker].map(|bytes| STANDARD.encode(bytes));
    let modules = [("/* module */", &packed[..]), ("/* length */", &length), ("/* unpacker */", &unpacker)];
    let mut page = include_str!("../page/index.html").to_owned();
    for (name, text) in PARTS.into_iter().chain(modules) {
        ensure!(page.matches(name).count() == 1, "the page names {name} more or less than once");
        page = page.replace(name, text);
    }
    let folder = target.join("playground");
    fs::create_dir_all(&folder).with_context(|| format!("cannot create {}", folder.display()))?;
    let file = folder.join("microphong.html");
    fs::write(&file, &page).with_context(|| format!("cannot write {}", file.display()))?;
    let file = file.canonicalize().unwrap_or(file);
    println!("{}: {} bytes; the module has {length} bytes, packed {all}", file.display(), page.len());
    println!("Open it in a browser.");
    Ok(())
}

/// The target that modules are compiled for.
const TRIPLE: &str = "wasm32-unknown-unknown";

/// Compiles both modules.
fn compile(root: &Path, target: &Path) -> Result<()> {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args([
        "build",
        "--locked",
        "--profile",
        "web",
        "--target",
        TRIPLE,
        "-p",
        "microphong-web-module",
        "-p",
        "microphong-web-unpacker",
    ]);
    cargo.arg("--target-dir").arg(target);
    // Cargo tells it to the programs that it runs, and it would name the wrong package here.
    let status = cargo.current_dir(root).env_remove("CARGO_MANIFEST_DIR").status().context("cannot run cargo")?;
    ensure!(status.success(), "the modules do not compile; if their target is missing, run: rustup target add {TRIPLE}");
    Ok(())
}

/// The bytes packed by LZMA.
fn packed(bytes: &[u8]) -> Result<Vec<u8>> {
    // Instructions do not lie at multiples of four. Long matches, and four bits of the byte before, gain half a percent.
    let options = LzmaOptions { dict_size: DICTIONARY, lc: 4, pb: 0, nice_len: 273, ..LzmaOptions::with_preset(9) };
    let mut packer = LzmaWriter::new_use_header(Vec::new(), &options, Some(bytes.len() as u64))?;
    packer.write_all(bytes)?;
    Ok(packer.finish()?)
}

/// The bytes packed by gzip.
fn gzipped(bytes: &[u8]) -> Result<Vec<u8>> {
    let mut packer = GzEncoder::new(Vec::new(), Compression::best());
    packer.write_all(bytes)?;
    Ok(packer.finish()?)
}
