//! Files that are there whole or not at all.

use anyhow::{Context, Result};
use std::{
    io::{BufWriter, Write},
    path::{Path, PathBuf},
};
use tempfile::NamedTempFile;

/// A file under construction: it takes its name when it is complete, and is gone when it never is.
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
}

impl Output {
    /// Starts a file; before the work that fills it, so that a place that cannot be written is known at once.
    ///
    /// # Errors
    /// When the directory is not there or cannot be written, or `path` is a directory.
    pub fn create(path: &Path) -> Result<Self> {
        let remedy = || format!("cannot write {}; name a file in a directory that exists and may be written", path.display());
        if path.is_dir() {
            return Err(std::io::Error::from(std::io::ErrorKind::IsADirectory)).with_context(remedy);
        }
        let directory = path.parent().filter(|d| !d.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        builder.prefix(".microphong-");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As any other new file: the user's mask decides.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let file = builder.tempfile_in(directory).with_context(remedy)?;
        Ok(Self { path: path.to_owned(), file: BufWriter::new(file) })
    }

    /// The name that the file will have.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the complete file its name; replaces an older one.
    ///
    /// # Errors
    /// When the last bytes cannot be written or the name cannot be taken.
    pub fn finish(self) -> Result<()> {
        let failed = || format!("cannot write {}", self.path.display());
        let file = self.file.into_inner().map_err(std::io::IntoInnerError::into_error).with_context(failed)?;
        file.persist(&self.path).map_err(|e| e.error).with_context(failed)?;
        Ok(())
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}

/// Writes a whole file at once.
///
/// # Errors
/// Those of [`Output`].
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut output = Output::create(path)?;
    output.write_all(bytes).with_context(|| format!("cannot write {}", path.display()))?;
    output.finish()
}
