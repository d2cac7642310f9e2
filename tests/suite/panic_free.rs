//! No panic can be reached in the core's optimised code: a program whose panic handler cannot be linked, links.

use microphong_sim::board::Board;
use std::{collections::BTreeSet, fs, path::Path, process::Command};

/// Whether the program links with these features, and what the compiler says.
fn link(target: &str, packages: &[&str], features: &str) -> (bool, String) {
    let output = Command::new(env!("CARGO"))
        // With the flags of the firmware.
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../firmware"))
        .args(["build", "--release"])
        .args(packages)
        .args(["--no-default-features", "--features", features])
        .args(["--bin", "panic-free", "--target", target, "--target-dir", "../target/firmware"])
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .output()
        .expect("cargo starts");
    (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn no_panic_can_be_reached() {
    // Code for a Cortex-M33 is almost that for a Cortex-M4F.
    let boards = Board::ALL.into_iter().filter(|&board| !matches!(board, Board::Mps2An505 | Board::Pico2));
    let targets: BTreeSet<_> = boards.map(Board::target).collect();
    assert_eq!(targets.len(), 4);
    for target in targets {
        let (linked, log) = link(target, &["--workspace"], "panic-free/all");
        assert!(linked, "{target}: {log}");
    }
}

#[test]
fn no_panic_can_be_reached_without_features() {
    let target = Board::Lm3s6965evb.target();
    // The features of other packages would be on as well.
    let (linked, log) = link(target, &["-p", "panic-free"], "");
    assert!(linked, "{target}: {log}");
}

/// The program draws in the format of every board.
#[test]
fn no_format_is_left_out() {
    let source = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("panic-free/src/main.rs")).unwrap();
    for board in Board::ALL {
        let format = format!("{:?}", board.format());
        let drawn = if format == "Gray4" { "LightGray<4>" } else { &format };
        let buffers = format!("&'static mut Buffers<{drawn}, {format}>");
        assert!(source.contains(&buffers), "{board}: the program has no {buffers}");
    }
}

#[test]
fn a_panic_is_noticed() {
    let (linked, log) = link("thumbv7m-none-eabi", &["--workspace"], "panic-free/with-a-panic");
    assert!(!linked && log.contains("a_panic_can_be_reached"), "{log}");
}
