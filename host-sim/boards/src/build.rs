//! Compiles the firmware for a board, and examples.

use crate::{Board, example::Example, sources::sources};
use anyhow::{Context, Result, ensure};
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
    sync::{Mutex, PoisonError},
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
/// # Errors
/// When the target or the compiler is missing, or the firmware does not compile.
pub fn program(board: Board, name: &str) -> Result<PathBuf> {
    let what = if name == board.name() { format!("the firmware for {board}") } else { format!("{name} for {board}") };
    release(name, &format!("microphong-firmware/{board}"), board.target(), &what)
}

/// Builds the firmware of `board` that draws smooth outlines, and returns the path of a copy of the ELF, as [`styles`] does.
///
/// # Errors
/// When the board has no memory for them, the target or the compiler is missing, or the firmware does not compile.
pub fn antialias(board: Board) -> Result<PathBuf> {
    ensure!(board.smooths(), "the firmware of {board} draws no smooth outlines: they need more memory than it has");
    copied(board, "antialias", "antialias")
}

/// Builds the program `styles` for `board`, which draws in a style or pixel format that cargo features name, and returns the path of a copy of the ELF.
/// Programs for other boards and with other features have other copies, so that tests can run them side by side.
///
/// # Errors
/// When the board has no memory for it, the target or the compiler is missing, or the program does not compile.
pub fn styles(board: Board, features: &str) -> Result<PathBuf> {
    ensure!(board.smooths(), "{board} has no program for styles: they need more memory than it has");
    copied(board, "styles", &format!("styles,{features}"))
}

/// Builds the firmware of `board` with more cargo features than it has, and returns the path of a copy of the ELF, as [`styles`] does.
///
/// # Errors
/// When the target or the compiler is missing, or the firmware does not compile.
pub fn firmware_with(board: Board, features: &str) -> Result<PathBuf> {
    copied(board, board.name(), features)
}

/// Builds the program `name` with `features` and returns the path of a copy.
fn copied(board: Board, name: &str, features: &str) -> Result<PathBuf> {
    static BUILDS: Mutex<()> = Mutex::new(());
    let _one_at_a_time = BUILDS.lock().unwrap_or_else(PoisonError::into_inner);
    let built = release(name, &all(board, features), board.target(), &format!("{name} for {board} with {features}"))?;
    let copy = built.with_file_name(format!("{name}-{board}-{}", features.replace(',', "-")));
    fs::copy(&built, &copy).with_context(|| format!("{} cannot be copied", built.display()))?;
    Ok(copy)
}

/// Features of the firmware for `board` as cargo takes them.
fn all(board: Board, features: &str) -> String {
    let names: Vec<_> = [board.name()].into_iter().chain(features.split(',')).map(|name| format!("microphong-firmware/{name}")).collect();
    names.join(",")
}

/// Builds a program of the workspace `firmware` with only these `features`, and returns its path. `what` is the program's name in messages.
///
/// Features apply to the whole workspace, and all programs share a directory, so dependencies are compiled once for each target.
///
/// # Errors
/// When the target or the compiler is missing, or the program does not compile.
pub fn release(name: &str, features: &str, target: &str, what: &str) -> Result<PathBuf> {
    Ok(releases(&["--workspace"], &[name], features, target, what)?.join(name))
}

/// Builds several programs of the workspace `firmware` together, as [`release`] does, and returns their folder. Features apply to the `packages` alone,
/// which are options of cargo.
///
/// # Errors
/// When the target or the compiler is missing, or a program does not compile.
pub fn releases(packages: &[&str], names: &[&str], features: &str, target: &str, what: &str) -> Result<PathBuf> {
    let root = sources()?;
    let directory = root.join("firmware");
    install_target(target, &directory)?;
    log::info!("compiling {what}");
    let output = root.join("target/firmware");
    let mut cargo = cargo(&directory);
    cargo
        .args(["build", "--quiet", "--release"])
        .args(packages)
        .args(["--no-default-features", "--features", features])
        .args(names.iter().flat_map(|&name| ["--bin", name]))
        .args(["--target", target, "--target-dir"])
        .arg(&output);
    finish(&mut cargo, what)?;
    Ok(output.join(target).join("release"))
}

/// Builds the firmware of an example and returns the ELF's path. The folder says how it is compiled.
///
/// # Errors
/// When the target or the compiler is missing, or the firmware does not compile.
pub fn example(example: Example) -> Result<PathBuf> {
    let (root, name) = (sources()?, example.name());
    let directory = root.join("examples").join(name);
    install_target(example.target(), &directory)?;
    log::info!("compiling the example {name}");
    let output = root.join("target/examples");
    let mut cargo = cargo(&directory);
    cargo.args(["build", "--quiet", "--release", "--target-dir"]).arg(&output);
    // Nobody debugs it here, and it takes a sixth of the time.
    cargo.env("CARGO_PROFILE_RELEASE_DEBUG", "false");
    finish(&mut cargo, name)?;
    Ok(output.join(example.target()).join("release").join(name))
}

/// A command of cargo in a folder of the sources.
fn cargo(directory: &Path) -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    // They would take the place of the flags that the folder asks for, and counts depend on those.
    command.current_dir(directory).env_remove("RUSTFLAGS").env_remove("CARGO_ENCODED_RUSTFLAGS").env_remove("CARGO_BUILD_TARGET");
    command
}

/// Runs a command of cargo that compiles `what`.
fn finish(command: &mut Command, what: &str) -> Result<()> {
    let status = command.status().context("cannot start cargo: install Rust from https://rustup.rs")?;
    ensure!(status.success(), "{what} did not compile; its messages are above");
    Ok(())
}

/// The target of this computer.
///
/// # Errors
/// When the compiler is missing.
pub fn host() -> Result<String> {
    let rustc = Command::new("rustc")
        .args(["--print", "host-tuple"])
        .output()
        .context("cannot start rustc: install Rust from https://rustup.rs")?;
    ensure!(rustc.status.success(), "rustc does not name this computer's target: {}", String::from_utf8_lossy(&rustc.stderr).trim());
    Ok(String::from_utf8_lossy(&rustc.stdout).trim().to_owned())
}

/// Adds `target` to the current toolchain if it is missing.
///
/// # Errors
/// When it cannot be added.
pub fn install_target(target: &str, directory: &Path) -> Result<()> {
    // Two that add a target at the same time fail.
    static ADDING: Mutex<()> = Mutex::new(());
    let _alone = ADDING.lock();
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
