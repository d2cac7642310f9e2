//! Cross-checks of whole programs; see the files in `tests/`.

use serde_json::Value;
use std::{
    path::{Path, PathBuf},
    process::Command,
    sync::LazyLock,
};

/// The command `microphong`; built here, because a package's tests build only the package's own programs.
///
/// # Panics
/// When it does not compile.
#[must_use]
pub fn program() -> &'static Path {
    static PROGRAM: LazyLock<PathBuf> = LazyLock::new(|| {
        let cargo = Command::new(env!("CARGO"))
            .args(["build", "--quiet", "--package", "microphong-sim", "--bin", "microphong", "--message-format", "json"])
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .expect("cargo");
        assert!(cargo.status.success(), "{}", String::from_utf8_lossy(&cargo.stderr));
        String::from_utf8_lossy(&cargo.stdout)
            .lines()
            .filter_map(|line| serde_json::from_str::<Value>(line).ok())
            .find_map(|message| message["executable"].as_str().map(PathBuf::from))
            .expect("the program's path")
    });
    &PROGRAM
}
