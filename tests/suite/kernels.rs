//! The kernels in assembler store the same bits as loops in Rust, on emulated processors. That whole pictures are the same is tested in `verify`.

use std::{path::Path, process::Command};

/// Runs the comparison of so many cases on this machine of QEMU.
fn compare(target: &str, machine: &str, cases: u32) {
    let firmware = Path::new(env!("CARGO_MANIFEST_DIR")).join("../firmware");
    let built = Command::new(env!("CARGO"))
        .current_dir(&firmware)
        .args(["build", "--release", "--no-default-features", "-p", "kernels"])
        .args(["--target", target, "--target-dir", "../target/firmware"])
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .output()
        .expect("cargo starts");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let program = firmware.join(format!("../target/firmware/{target}/release/kernels"));
    // A loop without end would never be reported.
    let output = Command::new("timeout")
        .args(["120", "qemu-system-arm", "-M", machine, "-nographic", "-semihosting", "-kernel"])
        .arg(&program)
        .output()
        .expect("timeout starts");
    let said = String::from_utf8_lossy(&output.stdout);
    println!("{machine}: {said}");
    let failed = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.starts_with(&format!("{cases} cases of ")), "{machine}: {said}{failed}");
}

#[test]
fn those_of_armv6m_store_what_loops_do() {
    compare("thumbv6m-none-eabi", "microbit", 140_000);
}

#[test]
fn those_of_armv7m_store_what_loops_do() {
    compare("thumbv7m-none-eabi", "mps2-an385", 700_000);
}

#[test]
fn those_of_armv7m_run_on_armv8m() {
    compare("thumbv8m.main-none-eabihf", "mps2-an505", 700_000);
}
