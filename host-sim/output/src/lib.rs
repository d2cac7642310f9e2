//! Output files that are complete or do not exist, and that replace no file which the program has read.
//!
//! A file has no name while it is written, so if the program ends, nothing of it stays. Linux gives a complete file its name in one step. If an older
//! file has this name, two steps are needed: first a name beside it, then the exchange. On other systems the file is copied to the name. If the
//! program ends between two steps, a file that begins with `.microphong-` stays.

use anyhow::{Context, Result, ensure};
use std::{
    collections::BTreeSet,
    fmt,
    fs::{self, File, Permissions},
    io::{self, BufWriter, Error, ErrorKind, IntoInnerError, Seek, Write},
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};

/// The real paths of the files that the program has read.
static READ: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Keeps a file that the program reads: no [`Output`] replaces it. The texture of a model often has the name of the picture of the model.
pub fn keep(path: &Path) {
    if let Ok(path) = path.canonicalize() {
        READ.lock().unwrap_or_else(PoisonError::into_inner).insert(path);
    }
}

/// The error for a name that a file has which the program has read.
#[derive(Debug)]
pub struct Kept(PathBuf);

impl fmt::Display for Kept {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "this would overwrite {}, which it reads; name another file with -o", self.0.display())
    }
}

impl std::error::Error for Kept {}

/// A file that is being written. It gets its name when it is complete, and is gone if it never is.
///
/// A link keeps its name, and the file that it points to is replaced. A file that replaces another takes its permissions. Devices, pipes and
/// standard output receive the bytes at once.
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    file: BufWriter<File>,
    /// The name that the file will have; `None` if it is written directly.
    name: Option<PathBuf>,
}

impl Output {
    /// Starts a file; before the work that fills it, so that a place that cannot be written is known at once.
    ///
    /// # Errors
    /// [`Kept`] when the program has read a file of this name. Another error when the directory is not there or cannot be written, or `path` is a
    /// directory.
    pub fn create(path: &Path) -> Result<Self> {
        ensure!(!is_kept(path), Kept(path.to_owned()));
        let started = place(path).and_then(|place| match place {
            Place::Directly(file) => Ok((file, None)),
            Place::Name(name) => {
                // What is wrong with the directory, in the system's own words.
                fs::metadata(directory(&name))?;
                Ok((tempfile::tempfile_in(directory(&name)).map_err(without_path)?, Some(name)))
            }
        });
        let (file, name) = started
            .with_context(|| format!("cannot write {}; name a file in a directory that exists and may be written", path.display()))?;
        Ok(Self { path: path.to_owned(), file: BufWriter::new(file), name })
    }

    /// The name that was asked for.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the complete file its name; replaces an older one.
    ///
    /// # Errors
    /// When the last bytes cannot be written or the name cannot be taken.
    pub fn finish(self) -> Result<()> {
        let Self { path, file, name } = self;
        let end = || {
            let mut file = file.into_inner().map_err(IntoInnerError::into_error)?;
            name.map_or(Ok(()), |name| take(&mut file, &name))
        };
        end().with_context(|| format!("cannot write {}", path.display()))
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Writes a whole file at once.
///
/// # Errors
/// Errors of [`Output`].
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut output = Output::create(path)?;
    output.write_all(bytes).with_context(|| format!("cannot write {}", path.display()))?;
    output.finish()
}

/// Whether `path` is a name of standard output.
#[must_use]
pub fn is_stdout(path: &Path) -> bool {
    cfg!(unix) && ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].iter().any(|&name| path == Path::new(name))
}

/// Whether the program has read the regular file of this name.
fn is_kept(path: &Path) -> bool {
    let is_read = |path: &PathBuf| path.is_file() && READ.lock().unwrap_or_else(PoisonError::into_inner).contains(path);
    path.canonicalize().is_ok_and(|path| is_read(&path))
}

/// Ways to write a file.
enum Place {
    /// Under this name, where a regular file is or nothing.
    Name(PathBuf),
    /// Writes directly into an existing device or pipe.
    Directly(File),
}

fn place(path: &Path) -> io::Result<Place> {
    #[cfg(unix)]
    if is_stdout(path) {
        use std::os::fd::AsFd;
        // Not opened again: the same place in the same file, and sockets cannot be opened.
        return Ok(Place::Directly(io::stdout().as_fd().try_clone_to_owned()?.into()));
    }
    match fs::metadata(path) {
        Ok(known) if known.is_dir() => Err(ErrorKind::IsADirectory.into()),
        Ok(known) if known.is_file() => Ok(Place::Name(path.canonicalize()?)),
        Ok(_) => Ok(Place::Directly(File::options().write(true).open(path)?)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Place::Name(pointed_to(path))),
        Err(error) => Err(error),
    }
}

/// The target of a link to a file that does not exist; `path` itself if it is not a link. Circles of links do not come here,
/// because opening one is another error.
fn pointed_to(path: &Path) -> PathBuf {
    fs::read_link(path).map_or_else(|_| path.to_owned(), |next| pointed_to(&directory(path).join(next)))
}

fn directory(path: &Path) -> &Path {
    path.parent().filter(|directory| !directory.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The error alone: it names a file that nobody asked for.
fn without_path(error: Error) -> Error {
    error.kind().into()
}

/// Gives `file` its name.
fn take(file: &mut File, name: &Path) -> io::Result<()> {
    if link(file, name).is_ok() {
        return Ok(());
    }
    let permissions = fs::metadata(name).ok().map(|replaced| replaced.permissions());
    if let Some(permissions) = &permissions {
        file.set_permissions(permissions.clone())?;
    }
    // It is in use, and only a file that has a name can take the place of another.
    let linked = |path: &Path| {
        link(file, path)
            .or_else(|error| if error.kind() == ErrorKind::AlreadyExists { Err(error) } else { copy(file, path, permissions.as_ref()) })
    };
    let named = tempfile::Builder::new().prefix(".microphong-").make_in(directory(name), linked).map_err(without_path)?;
    named.persist(name).map_err(|error| error.error)?;
    Ok(())
}

/// Gives a file without a name one that nothing has.
#[cfg(target_os = "linux")]
fn link(file: &File, name: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd;
    let own = format!("/proc/self/fd/{}", file.as_raw_fd());
    Ok(linkat(CWD, own, CWD, name, AtFlags::SYMLINK_FOLLOW)?)
}

#[cfg(not(target_os = "linux"))]
fn link(_: &File, _: &Path) -> io::Result<()> {
    Err(ErrorKind::Unsupported.into())
}

/// Does the work of [`link`] where the system cannot.
fn copy(mut file: &File, name: &Path, permissions: Option<&Permissions>) -> io::Result<()> {
    let mut named = File::create_new(name)?;
    let copied = permissions
        .map_or(Ok(()), |permissions| named.set_permissions(permissions.clone()))
        .and_then(|()| file.rewind())
        .and_then(|()| io::copy(&mut file, &mut named));
    if copied.is_err() {
        // The error is reported, and not that of removing what it has left.
        let _ = fs::remove_file(name);
    }
    copied.map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file that had a name and lost it gets no other by a link, as on file systems without files that never had one.
    #[test]
    fn what_cannot_be_linked_is_copied() {
        let directory = tempfile::tempdir().unwrap();
        let name = directory.path().join("whole");
        for text in ["new", "newer"] {
            let (mut file, own_name) = tempfile::NamedTempFile::new_in(directory.path()).unwrap().into_parts();
            own_name.close().unwrap();
            file.write_all(text.as_bytes()).unwrap();
            take(&mut file, &name).unwrap();
            assert_eq!(fs::read_to_string(&name).unwrap(), text);
            assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
            if text == "newer" {
                assert!(fs::metadata(&name).unwrap().permissions().readonly(), "the permissions of the file that was replaced");
            }
            let mut permissions = fs::metadata(&name).unwrap().permissions();
            permissions.set_readonly(true);
            fs::set_permissions(&name, permissions).unwrap();
        }
    }
}
