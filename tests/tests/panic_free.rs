//! No panic can be reached in the core's optimised code: a program whose panic handler cannot be linked, links.

use std::{path::Path, process::Command};

fn link(target: &str, source: &str) -> (bool, String) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = Command::new(env!("CARGO"))
        .current_dir(root.join("panic-free"))
        .args(["build", "--release", "--target", target, "--features", source, "--target-dir"])
        .arg(root.join("../target/firmware"))
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .output()
        .expect("cargo starts");
    (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn no_panic_can_be_reached() {
    for target in ["thumbv6m-none-eabi", "thumbv7m-none-eabi", "thumbv7em-none-eabihf"] {
        let (linked, log) = link(target, "default");
        assert!(linked, "{target}: {log}");
    }
}

#[test]
fn a_panic_is_noticed() {
    let (linked, log) = link("thumbv7m-none-eabi", "with-a-panic");
    assert!(!linked && log.contains("a_panic_can_be_reached"), "{log}");
}
