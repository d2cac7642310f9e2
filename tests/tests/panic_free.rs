//! No panic can be reached in the core's optimised code: a program whose panic handler cannot be linked, links.

use microphong_sim::board::Board;
use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// The program's directory.
fn program() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("panic-free")
}

/// Whether the program links with these features, and what the compiler says.
fn link(target: &str, features: &[&str]) -> (bool, String) {
    let output = Command::new(env!("CARGO"))
        .current_dir(program())
        .args(["build", "--release", "--target", target, "--target-dir", "../../target/firmware"])
        .args(features)
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .output()
        .expect("cargo starts");
    (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn no_panic_can_be_reached() {
    let targets: BTreeSet<_> = Board::ALL.into_iter().map(Board::target).collect();
    assert_eq!(targets.len(), 3);
    for target in targets {
        let (linked, log) = link(target, &[]);
        assert!(linked, "{target}: {log}");
    }
}

#[test]
fn no_panic_can_be_reached_without_features() {
    let target = Board::Lm3s6965evb.target();
    let (linked, log) = link(target, &["--no-default-features"]);
    assert!(linked, "{target}: {log}");
}

/// The program draws in the format of every board.
#[test]
fn no_format_is_left_out() {
    let source = fs::read_to_string(program().join("src/main.rs")).unwrap();
    for board in Board::ALL {
        let buffers = format!("&'static mut Buffers<{:?}>", board.format());
        assert!(source.contains(&buffers), "{board}: the program has no {buffers}");
    }
}

#[test]
fn a_panic_is_noticed() {
    let (linked, log) = link("thumbv7m-none-eabi", &["--features", "with-a-panic"]);
    assert!(!linked && log.contains("a_panic_can_be_reached"), "{log}");
}
