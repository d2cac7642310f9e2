//! Builds the page of the playground: `cargo run --release -p microphong-web`.
//!
//! The page is one file. A page that is opened from disk can fetch nothing, so the module, its style and its scripts are in its text. The module is
//! packed by gzip, which every browser can unpack.

use anyhow::{Context, Result, ensure};
use base64::{Engine, engine::general_purpose::STANDARD};
use flate2::{Compression, write::GzEncoder};
use std::{
    env, fs,
    io::Write,
    path::{Path, PathBuf},
    process::Command,
};

/// Largest number of bytes of the packed module.
const LARGEST: usize = 2_500_000;

/// The parts of the page that take the place of their names in its text.
const PARTS: [(&str, &str); 3] = [
    ("/* style.css */", include_str!("../page/style.css")),
    ("/* worker.js */", include_str!("../page/worker.js")),
    ("/* page.js */", include_str!("../page/page.js")),
];

fn main() -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let module = fs::read(module(&root, &target)?).context("cannot read the module")?;
    let packed = packed(&module)?;
    ensure!(
        packed.len() <= LARGEST,
        "the module has {} bytes when it is packed, and may have {LARGEST}; find what has grown",
        packed.len()
    );
    let mut page = include_str!("../page/index.html").to_owned();
    for (name, text) in PARTS.into_iter().chain([("/* module */", STANDARD.encode(&packed).as_str())]) {
        ensure!(page.matches(name).count() == 1, "the page names {name} more or less than once");
        page = page.replace(name, text);
    }
    let folder = target.join("playground");
    fs::create_dir_all(&folder).with_context(|| format!("cannot create {}", folder.display()))?;
    let file = folder.join("microphong.html");
    fs::write(&file, &page).with_context(|| format!("cannot write {}", file.display()))?;
    let file = file.canonicalize().unwrap_or(file);
    println!("{}: {} bytes; the module has {} bytes, packed {}", file.display(), page.len(), module.len(), packed.len());
    println!("Open it in a browser.");
    Ok(())
}

/// Compiles the module, and returns its file.
fn module(root: &Path, target: &Path) -> Result<PathBuf> {
    const TRIPLE: &str = "wasm32-unknown-unknown";
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["build", "--locked", "--profile", "web", "--target", TRIPLE, "-p", "microphong-web-module", "--target-dir"]).arg(target);
    // Cargo tells it to the programs that it runs, and it would name the wrong package here.
    let status = cargo.current_dir(root).env_remove("CARGO_MANIFEST_DIR").status().context("cannot run cargo")?;
    ensure!(status.success(), "the module does not compile; if its target is missing, run: rustup target add {TRIPLE}");
    Ok(target.join(TRIPLE).join("web/microphong_web_module.wasm"))
}

/// The bytes packed by gzip.
fn packed(bytes: &[u8]) -> Result<Vec<u8>> {
    let mut packer = GzEncoder::new(Vec::new(), Compression::best());
    packer.write_all(bytes)?;
    Ok(packer.finish()?)
}
