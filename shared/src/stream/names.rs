//! Names of meshes. They are optional, follow all other records, and are read only if a program asks for one.
//!
//! Each [`Mesh`] record has an entry: one byte for the length of its name, and the name in UTF-8. A length of 0 means that the mesh belongs to the
//! object of the mesh before. An object of several materials has several meshes, and a mesh may have coarser levels.

use super::{Stream, StreamError, record::Mesh};
use core::{fmt, ops::Range, str};

/// Largest length of a name, in bytes.
pub const MAX_NAME: usize = u8::MAX as usize;

/// An iterator over the named objects of a stream, which [`Stream::names`] returns. Each item is a name and the range of indices of the
/// object's meshes. If the names in the file are damaged, the last item is an error.
#[derive(Clone, Debug)]
pub struct Names<'a> {
    meshes: &'a [Mesh],
    entries: &'a [u8],
    /// The next mesh.
    next: usize,
}

impl<'a> Names<'a> {
    /// The entry of the next mesh, with all meshes that continue it. `None` if it is not valid.
    fn entry(&mut self) -> Option<(&'a str, Range<u16>)> {
        let (&length, rest) = self.entries.split_first()?;
        let (name, rest) = rest.split_at_checked(length.into())?;
        let further = rest.iter().take_while(|&&length| length == 0).count();
        let end = self.next.checked_add(1)?.checked_add(further)?;
        let is_whole = self.meshes.get(self.next..end)?.first()?.error == 0;
        if length == 0 || !is_whole {
            return None;
        }
        let meshes = self.next as u16..end as u16;
        (self.entries, self.next) = (rest.get(further..)?, end);
        Some((str::from_utf8(name).ok()?, meshes))
    }
}

impl<'a> Iterator for Names<'a> {
    type Item = Result<(&'a str, Range<u16>), StreamError>;

    fn next(&mut self) -> Option<Self::Item> {
        // A stream without names has no entries at all, a stream with names one for each mesh.
        if self.entries.is_empty() && (self.next == 0 || self.next == self.meshes.len()) {
            return None;
        }
        let record = self.next as u32;
        let entry = self.entry();
        if entry.is_none() {
            (self.entries, self.next) = (&[], 0);
        }
        Some(entry.ok_or(StreamError::Field { name: "mesh name", record }))
    }
}

/// The error of [`Stream::mesh`]: the stream has no object of this name. Its message lists the names that there are.
#[derive(Clone, Debug)]
pub struct UnknownMesh<'a> {
    /// The name that the program asked for.
    pub name: &'a str,
    /// The named objects that the stream has.
    pub names: Names<'a>,
}

impl fmt::Display for UnknownMesh<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the stream has no mesh {:?}; ", self.name)?;
        if self.names.clone().next().is_none() {
            return f.write_str("its meshes have no names: convert a file that names objects, without --merge");
        }
        f.write_str("it has ")?;
        for (k, entry) in self.names.clone().enumerate() {
            let separator = if k > 0 { ", " } else { "" };
            match entry {
                Ok((name, _)) => write!(f, "{separator}{name:?}")?,
                Err(error) => write!(f, "{separator}a fault: {error}")?,
            }
        }
        Ok(())
    }
}

impl core::error::Error for UnknownMesh<'_> {}

#[cfg(feature = "defmt")]
impl defmt::Format for UnknownMesh<'_> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", defmt::Display2Format(self));
    }
}

impl<'a> Stream<'a> {
    /// Returns an iterator over the named objects of the stream, in the order of their meshes. It is empty if the stream has no names.
    ///
    /// [`Stream::parse`] does not check the names, so that programs that need none contain no code for them. The iterator checks them.
    #[must_use]
    pub fn names(&self) -> Names<'a> {
        Names { meshes: self.meshes, entries: self.names, next: 0 }
    }

    /// Returns the indices of the meshes of the object `name`, as [`Scene::add`](crate::Scene::add) takes them. `convert` keeps the names that
    /// objects have in a model file.
    ///
    /// ```no_run
    /// # use microphong::{Pose, Renderer, Stream, pixel::Pixel};
    /// # fn two<C: Pixel>(stream: Stream<'static>, renderer: &mut Renderer<'_, C>) -> Result<(), Box<dyn core::error::Error>> {
    /// let needle = renderer.scene().add(stream.mesh("needle")?, Pose::IDENTITY)?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Returns [`UnknownMesh`] if the stream has no object of this name. The error lists the available names.
    pub fn mesh<'n>(&self, name: &'n str) -> Result<Range<u16>, UnknownMesh<'n>>
    where
        'a: 'n,
    {
        let found = self.names().flatten().find(|&(other, _)| other == name);
        found.map(|(_, meshes)| meshes).ok_or(UnknownMesh { name, names: self.names() })
    }
}
