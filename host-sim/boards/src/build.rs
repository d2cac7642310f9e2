//! Compiles the firmware for a board.

use crate::{Board, sources::sources};
use anyhow::{Context, Result, ensure};
use std::{
    env,
    path::{Path, PathBuf},
    process::Command,
};

/// Builds the firmware of `board` and returns the ELF's path.
///
/// # Errors
/// When the target or the compiler is missing, or the firmware does not compile.
pub fn firmware(board: Board) -> Result<PathBuf> {
    program(board, board.name())
}

/// Builds a program of the package `firmware` for `board` and returns the ELF's path.
///
/// All boards, and whatever else is compiled for them, share a target directory, so that dependencies are compiled once.
///
/// # Errors
/// When the target or the compiler is missing, or the firmware does not compile.
pub fn program(board: Board, name: &str) -> Result<PathBuf> {
    let root = sources()?;
    let directory = root.join("firmware");
    install_target(board.target(), &directory)?;

    let output = root.join("target/firmware");
    let what = if name == board.name() { format!("the firmware for {board}") } else { format!("{name} for {board}") };
    let arguments = ["--no-default-features", "--features", board.name(), "--bin", name, "--target", board.target()];
    release(&directory, &arguments, &output, &what)?;
    Ok(output.join(board.target()).join("release").join(name))
}

/// Builds the workspace in `directory` into `output`; `what` is its name in messages.
///
/// # Errors
/// When the compiler is missing, or the program does not compile.
pub fn release(directory: &Path, arguments: &[&str], output: &Path, what: &str) -> Result<()> {
    log::info!("compiling {what}");
    let status = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .current_dir(directory)
        .args(["build", "--quiet", "--release", "--target-dir"])
        .arg(output)
        .args(arguments)
        // They would take the place of the flags that the workspace asks for, and counts depend on those.
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env_remove("CARGO_BUILD_TARGET")
        .status()
        .context("cannot start cargo: install Rust from https://rustup.rs")?;
    ensure!(status.success(), "{what} did not compile; its messages are above");
    Ok(())
}

/// Adds `target` to the toolchain in use unless it is there.
///
/// # Errors
/// When it cannot be added.
pub fn install_target(target: &str, directory: &Path) -> Result<()> {
    let remedy = format!("run `rustup target add {target}`");
    let query = Command::new("rustc").current_dir(directory).args(["--print", "target-libdir", "--target", target]).output();
    let query = query.with_context(|| format!("cannot start rustc to look for the target {target}: {remedy}"))?;
    if query.status.success() && Path::new(String::from_utf8_lossy(&query.stdout).trim()).is_dir() {
        return Ok(());
    }
    let added = Command::new("rustup").current_dir(directory).args(["target", "add", target]).status();
    ensure!(added.is_ok_and(|status| status.success()), "the Rust target {target} is missing and could not be added: {remedy}");
    Ok(())
}
