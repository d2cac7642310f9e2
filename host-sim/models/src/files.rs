//! Reads the file of a model, and the files that it names, from disk or from memory.
//!
//! A model may come from anybody. So the files that it names are opened only if they are regular files in its folder, and no file is read without end.

use crate::number::grouped;
use anyhow::{Context, Result, bail, ensure};
use microphong_render::output;
use std::{
    fmt,
    fs::{self, File},
    io::{self, Read},
    path::{Component, Path, PathBuf},
    sync::Arc,
};

/// Largest number of bytes of a file.
pub(crate) const LARGEST_FILE: u64 = 1 << 30;

/// Number of bytes that are read at first.
const STEP: u64 = 1 << 16;

/// The place that files are read from.
#[derive(Clone, Debug)]
pub enum Files {
    /// The disk.
    OnDisk,
    /// Files in memory, by their paths with slashes. There are no others.
    InMemory(Arc<[(String, Vec<u8>)]>),
}

impl Files {
    /// Files in memory, by their paths with slashes.
    #[must_use]
    pub fn in_memory(files: impl IntoIterator<Item = (String, Vec<u8>)>) -> Self {
        Self::InMemory(files.into_iter().collect())
    }

    /// Reads a file that the user names. On disk it may be a pipe.
    ///
    /// # Errors
    /// When the file cannot be read, or is too large.
    pub fn read(&self, path: &Path) -> Result<Vec<u8>> {
        match self {
            Self::OnDisk => limited(path, LARGEST_FILE),
            Self::InMemory(files) => {
                let file = files.iter().find(|(name, _)| Path::new(name) == path);
                file.map(|(_, bytes)| bytes.clone()).ok_or_else(|| Missing(path.to_owned()).into())
            }
        }
    }

    /// Whether there is a file that can be read.
    #[must_use]
    pub fn has(&self, path: &Path) -> bool {
        match self {
            Self::OnDisk => path.is_file(),
            Self::InMemory(files) => files.iter().any(|(name, _)| Path::new(name) == path),
        }
    }
}

/// Reads a file of at most `largest` bytes.
fn limited(path: &Path, largest: u64) -> Result<Vec<u8>> {
    let place = || format!("cannot read {}", path.display());
    let mut file = File::open(path).with_context(place)?;
    output::keep(path);
    let mut bytes = Vec::new();
    // A device has no length: what is read counts. There is never room for more than is allowed.
    loop {
        let count = bytes.len() as u64;
        let more = (count.max(STEP)).min(largest - count);
        bytes.try_reserve_exact(more as usize).map_err(io::Error::from).with_context(place)?;
        if (file.by_ref().take(more).read_to_end(&mut bytes).with_context(place)? as u64) < more || more == 0 {
            break;
        }
    }
    if bytes.len() as u64 == largest {
        let has_more = file.read(&mut [0]).with_context(place)? > 0;
        ensure!(
            !has_more,
            "{}: the file has more than {} bytes, which are too many; simplify it in another program",
            path.display(),
            grouped(largest)
        );
    }
    Ok(bytes)
}

/// The error for a file that is not there.
#[derive(Debug)]
pub(crate) struct Missing(pub(crate) PathBuf);

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot read {}; put it beside the mesh", self.0.display())
    }
}

impl std::error::Error for Missing {}

/// The files that a model names.
#[derive(Clone, Debug)]
pub(crate) struct Folder {
    files: Files,
    folder: PathBuf,
    allow_outside: bool,
}

impl Folder {
    /// The folder of a model; with `allow_outside`, files elsewhere on a disk are read, too.
    pub(crate) fn of(files: &Files, model: &Path, allow_outside: bool) -> Self {
        let folder = model.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
        Self { files: files.clone(), folder: folder.to_owned(), allow_outside }
    }

    /// Reads a file by its name in the model, as Windows and others write it.
    ///
    /// # Errors
    /// When there is no such file, or it lies outside the folder, is no regular file, or is too large.
    pub(crate) fn read(&self, name: &str) -> Result<(PathBuf, Vec<u8>)> {
        let path = self.find(name)?;
        ensure!(self.files.has(&path), "{} is no regular file; export the model again", path.display());
        let bytes = self.files.read(&path)?;
        Ok((path, bytes))
    }

    /// The path of a file.
    ///
    /// # Errors
    /// [`Missing`] when there is no such file, and another error when it lies outside the folder.
    pub(crate) fn find(&self, name: &str) -> Result<PathBuf> {
        let slashes = name.replace('\\', "/");
        let given = Path::new(&slashes);
        let is_inside = given.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) && !has_drive(&slashes);
        let inside = if self.allow_outside || is_inside { self.known(Path::new(name)).or_else(|| self.known(given)) } else { None };
        if let Some(path) = inside {
            self.check(&path)?;
            return Ok(path);
        }
        // Models are moved without the folders of the computer that made them.
        let bare = slashes.rsplit('/').next().unwrap_or_default();
        if !bare.is_empty()
            && ![".", ".."].contains(&bare)
            && let Some(path) = self.known(Path::new(bare))
        {
            self.check(&path)?;
            return Ok(path);
        }
        let place = self.folder.join(bare);
        // Memory has nothing outside that could be allowed.
        if !is_inside && !self.allow_outside && matches!(self.files, Files::OnDisk) {
            bail!("{name:?} lies outside the folder of the model; put it at {}, or allow such files with --allow-outside", place.display());
        }
        // As it was given: a folder that is `.` is not said.
        let named = if self.folder == Path::new(".") { given.to_owned() } else { self.folder.join(given) };
        Err(Missing(named).into())
    }

    /// The path of what is there under this name, or under the name in other capitals.
    fn known(&self, name: &Path) -> Option<PathBuf> {
        let path = self.folder.join(name);
        if let Files::InMemory(files) = &self.files {
            return in_memory(files, &path);
        }
        if fs::symlink_metadata(&path).is_ok() {
            return Some(path);
        }
        let mut found = if name.is_absolute() { PathBuf::from("/") } else { self.folder.clone() };
        for part in name.components() {
            match part {
                Component::Normal(part) => {
                    let exact = found.join(part);
                    found = if fs::symlink_metadata(&exact).is_ok() { exact } else { in_other_capitals(&found, part.to_str()?)? };
                }
                Component::ParentDir => found.push(".."),
                Component::CurDir | Component::RootDir | Component::Prefix(_) => {}
            }
        }
        Some(found)
    }

    /// Passes files of the folder: a link may lead out of it.
    fn check(&self, path: &Path) -> Result<()> {
        if self.allow_outside || matches!(self.files, Files::InMemory(_)) {
            return Ok(());
        }
        let place = || format!("cannot read {}", path.display());
        let (real, folder) = (path.canonicalize().with_context(place)?, self.folder.canonicalize().with_context(place)?);
        ensure!(
            real.starts_with(folder),
            "{} is a link out of the folder of the model; copy the file into it, or allow such files with --allow-outside",
            path.display()
        );
        Ok(())
    }
}

/// The file in memory that has this path, or the first one, by the order of names, whose path differs in capitals only.
fn in_memory(files: &[(String, Vec<u8>)], path: &Path) -> Option<PathBuf> {
    /// The path without its dots, which mean nothing.
    fn plain(path: &Path) -> PathBuf {
        path.components().filter(|part| !matches!(part, Component::CurDir)).collect()
    }
    let wanted = plain(path);
    let small = |path: &Path| path.to_string_lossy().to_lowercase();
    let known = || files.iter().map(|(name, _)| PathBuf::from(name));
    known().find(|file| plain(file) == wanted).or_else(|| known().filter(|file| small(&plain(file)) == small(&wanted)).min())
}

/// Whether a path begins with the drive of a Windows computer.
fn has_drive(path: &str) -> bool {
    matches!(path.as_bytes(), [letter, b':', ..] if letter.is_ascii_alphabetic())
}

/// The first file, by the order of names, whose name differs in capitals only.
fn in_other_capitals(folder: &Path, name: &str) -> Option<PathBuf> {
    let wanted = name.to_lowercase();
    let files = fs::read_dir(folder).ok()?.flatten().map(|file| file.path());
    files.filter(|file| file.file_name().is_some_and(|name| name.to_string_lossy().to_lowercase() == wanted)).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said<T>(result: Result<T>) -> String {
        result.err().map_or_else(String::new, |error| format!("{error:#}"))
    }

    #[test]
    fn files_are_found_as_windows_writes_them() {
        let place = tempfile::tempdir().unwrap();
        fs::create_dir(place.path().join("Maps")).unwrap();
        fs::write(place.path().join("A b.mtl"), "one").unwrap();
        fs::write(place.path().join("Maps/c.mtl"), "two").unwrap();
        let folder = Folder::of(&Files::OnDisk, &place.path().join("a.obj"), false);
        for name in [
            "A b.mtl",
            "a B.MTL",
            ".\\A b.mtl",
            "./a b.mtl",
            "C:\\Users\\me\\a b.mtl",
            "/home/me/A b.mtl",
            "..\\..\\a b.mtl",
            "old/a b.mtl",
        ] {
            assert_eq!(folder.read(name).unwrap().1, b"one", "{name}");
        }
        for name in ["maps\\C.mtl", "Maps/c.mtl", ".\\MAPS\\c.mtl"] {
            assert_eq!(folder.read(name).unwrap().1, b"two", "{name}");
        }
        for name in ["none.mtl", "", ".", "Maps", "Maps/"] {
            assert!(!said(folder.read(name)).is_empty(), "{name}");
        }
        assert!(said(folder.read("none.mtl")).ends_with("none.mtl; put it beside the mesh"));
        assert!(said(folder.read("Maps")).ends_with("Maps is no regular file; export the model again"));
    }

    #[test]
    fn files_outside_the_folder_are_opened_only_if_that_is_allowed() {
        let place = tempfile::tempdir().unwrap();
        let inside = place.path().join("inside");
        fs::create_dir(&inside).unwrap();
        let secret = place.path().join("secret.bin");
        fs::write(&secret, "secret").unwrap();
        let [closed, open] = [false, true].map(|outside| Folder::of(&Files::OnDisk, &inside.join("a.gltf"), outside));
        for name in [&secret.display().to_string()[..], "../secret.bin", "..\\secret.bin", "x/../../secret.bin"] {
            let error = said(closed.read(name));
            assert!(error.contains("lies outside the folder of the model") && error.contains("--allow-outside"), "{name}: {error}");
        }
        assert_eq!(open.read("../secret.bin").unwrap().1, b"secret");
        assert_eq!(open.read(&secret.display().to_string()).unwrap().1, b"secret");
        assert!(said(closed.read("/dev/zero")).contains("lies outside"));
        assert!(said(open.read("/dev/zero")).contains("/dev/zero is no regular file"));
        #[cfg(unix)]
        {
            for (to, name) in [("../secret.bin", "link.bin"), ("/dev/zero", "zero.bin"), ("real.bin", "within.bin")] {
                std::os::unix::fs::symlink(to, inside.join(name)).unwrap();
            }
            fs::write(inside.join("real.bin"), "real").unwrap();
            for name in ["link.bin", "zero.bin"] {
                assert!(said(closed.read(name)).contains("is a link out of the folder of the model"), "{name}");
            }
            assert_eq!(open.read("link.bin").unwrap().1, b"secret");
            assert_eq!(closed.read("within.bin").unwrap().1, b"real");
        }
    }

    #[test]
    fn files_in_memory_are_found_as_those_of_a_folder_are() {
        let files = Files::in_memory([("a.mtl", "one"), ("Maps/c.png", "two")].map(|(name, text)| (name.to_owned(), text.into())));
        let folder = Folder::of(&files, Path::new("a.obj"), false);
        for name in ["a.mtl", "A.MTL", "./a.mtl", ".\\a.mtl", "C:\\Users\\me\\a.mtl", "/home/me/a.mtl", "../../a.mtl"] {
            assert_eq!(folder.read(name).unwrap().1, b"one", "{name}");
        }
        for name in ["Maps/c.png", "maps\\C.png"] {
            assert_eq!(folder.read(name).unwrap().1, b"two", "{name}");
        }
        // Nothing of the disk is seen, even if that is allowed.
        for folder in [&folder, &Folder::of(&files, Path::new("a.obj"), true)] {
            for name in ["Cargo.toml", "/dev/zero", "c.png", "Maps", "", "."] {
                assert!(said(folder.read(name)).ends_with("put it beside the mesh"), "{name}");
            }
        }
        let inside = Folder::of(&files, Path::new("Maps/b.obj"), false);
        assert_eq!(inside.read("c.png").unwrap().1, b"two");
        assert!(said(inside.read("a.mtl")).ends_with("Maps/a.mtl; put it beside the mesh"));
    }

    #[test]
    fn no_file_is_read_without_end() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("a");
        fs::write(&file, [0; 101]).unwrap();
        assert_eq!(limited(&file, 101).unwrap().len(), 101);
        assert!(
            said(limited(&file, 100)).ends_with("a: the file has more than 100 bytes, which are too many; simplify it in another program")
        );
        #[cfg(unix)]
        assert!(said(limited(Path::new("/dev/zero"), 100)).contains("more than 100 bytes"));
    }
}
