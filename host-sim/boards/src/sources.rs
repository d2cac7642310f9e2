//! Finds the sources of microphong, from which firmware and programs for callgrind are compiled.

use anyhow::{Context, Result, ensure};
use std::{
    env,
    path::{Path, PathBuf},
};

/// The environment variable that names their folder.
pub const VARIABLE: &str = "MICROPHONG_SOURCES";

/// The folder in which this program was compiled. The program may have been moved since.
const BUILT_IN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// The folder of the sources: the one that [`VARIABLE`] names; else the nearest one that the current folder lies in; else the one
/// that this program was compiled in.
///
/// # Errors
/// When there is none.
pub fn sources() -> Result<PathBuf> {
    let folder = match env::var_os(VARIABLE) {
        Some(named) => {
            let named = PathBuf::from(named);
            ensure!(are_in(&named), "{}, which {VARIABLE} names, is no folder with the sources of microphong", named.display());
            named
        }
        None => {
            let here = env::current_dir().context("cannot tell the current folder")?;
            let found = here.ancestors().chain([Path::new(BUILT_IN)]).find(|folder| are_in(folder));
            let found = found.with_context(|| {
                format!(
                    "this compiles a program from the sources of microphong, and they are not here: {} is in no clone of them, and the one \
                     that this command was compiled in is gone; run it in a clone, or name the clone's folder in {VARIABLE}",
                    here.display()
                )
            })?;
            found.to_owned()
        }
    };
    folder.canonicalize().with_context(|| format!("cannot open {}", folder.display()))
}

/// Whether all that is compiled at run time lies there.
fn are_in(folder: &Path) -> bool {
    ["firmware", "host-sim/frame", "host-sim/peers", "shared"].iter().all(|part| folder.join(part).join("Cargo.toml").is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn these_are_the_sources() {
        let root = sources().expect("this test's own sources");
        assert_eq!(root, Path::new(BUILT_IN).canonicalize().expect("a folder"));
        assert!(!are_in(&root.join("firmware")));
    }
}
