//! The bytes of a stream, aligned so that they can be read in place.

use crate::files::Files;
use anyhow::{Result, anyhow};
use microphong::{
    Light, Outlines, Stream, StreamError,
    format::ErrorBudget,
    stream::{
        record::{Camera, Header, Material, NO_OUTLINES, OUTLINES_ALONE, OUTLINES_OVER_SURFACES},
        seal,
    },
};
use microphong_render::{
    neighbours::{has_neighbours, with_neighbours},
    shader::Shader,
};
use std::path::Path;
use zerocopy::{FromBytes, IntoBytes};

/// A stream in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StreamBytes {
    words: Vec<u32>,
    length: usize,
}

impl From<&[u8]> for StreamBytes {
    fn from(bytes: &[u8]) -> Self {
        let mut words = vec![0u32; bytes.len().div_ceil(4)];
        words.as_mut_bytes()[..bytes.len()].copy_from_slice(bytes);
        Self { words, length: bytes.len() }
    }
}

impl StreamBytes {
    /// Reads a `.tri` file and checks it.
    ///
    /// # Errors
    /// The error names the file, its fault and the remedy.
    pub fn read(path: &Path) -> Result<Self> {
        Self::read_from(&Files::OnDisk, path)
    }

    /// Reads a `.tri` file of these files, and checks it.
    ///
    /// # Errors
    /// The error names the file, its fault and the remedy.
    pub fn read_from(files: &Files, path: &Path) -> Result<Self> {
        let bytes = files.read(path)?;
        let stream = Self::from(bytes.as_slice());
        let checked = stream.parse().and_then(|stream| stream.names().try_for_each(|entry| entry.map(drop)));
        checked.map_err(|error| anyhow!("{}: {error}", path.display()))?;
        Ok(stream)
    }

    /// The bytes as they lie in a file or in flash.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        &self.words.as_bytes()[..self.length]
    }

    /// Changes how far a pixel may be off by a method that keeps to a budget.
    #[must_use]
    pub fn with_budget(self, budget: ErrorBudget) -> Self {
        self.with_header(|header| header.budget = budget.to_bits())
    }

    /// States this budget, unless the stream states one.
    #[must_use]
    pub fn or_budget(self, budget: ErrorBudget) -> Self {
        self.with_header(|header| {
            if header.budget().is_none() {
                header.budget = budget.to_bits();
            }
        })
    }

    /// Names another method.
    #[must_use]
    pub fn with_shader(self, shader: Shader) -> Self {
        self.with_header(|header| header.shader = shader.facts().id)
    }

    /// Puts one colour behind the picture.
    #[must_use]
    pub fn with_background(self, colour: [u8; 3]) -> Self {
        self.with_header(|header| (header.background, header.background_bottom) = (colour, colour))
    }

    /// Changes the camera.
    #[must_use]
    pub fn with_camera(self, change: impl FnOnce(&mut Camera)) -> Self {
        self.with_header(|header| change(&mut header.camera))
    }

    /// Changes the header.
    fn with_header(mut self, change: impl FnOnce(&mut Header)) -> Self {
        let length = self.length;
        let bytes = &mut self.words.as_mut_bytes()[..length];
        if let Ok((header, _)) = Header::mut_from_prefix(bytes) {
            change(header);
            seal(bytes);
        }
        self
    }

    /// Gives all surfaces this material.
    ///
    /// # Errors
    /// Errors of [`Self::parse`], or when the material is not valid.
    pub fn with_material(&self, material: Material) -> Result<Self> {
        let stream = self.parse()?;
        let (first, count) = (size_of::<Header>() + size_of_val(stream.meshes), stream.materials.len());
        let mut bytes = self.as_bytes().to_vec();
        let records = bytes.iter_mut().skip(first).take(count * size_of::<Material>());
        records.zip(material.as_bytes().iter().cycle()).for_each(|(old, &new)| *old = new);
        seal(&mut bytes);
        let changed = Self::from(&bytes[..]);
        changed.parse()?;
        Ok(changed)
    }

    /// Puts other lights in place of those that there are.
    ///
    /// # Errors
    /// Errors of [`Self::parse`], or when the lights are not valid.
    pub fn with_lights(&self, lights: &[Light]) -> Result<Self> {
        let stream = self.parse()?;
        let before = size_of::<Header>() + size_of_val(stream.meshes) + size_of_val(stream.materials);
        let (before, rest) = self.as_bytes().split_at(before);
        let rest = rest.get(size_of_val(stream.lights)..).unwrap_or_default();
        let bytes = [before, lights.as_bytes(), rest].concat();
        let length = bytes.len() as u32;
        let changed = Self::from(&bytes[..]).with_header(|header| (header.lights, header.length) = (lights.len() as u16, length));
        changed.parse()?;
        Ok(changed)
    }

    /// States lines along outlines in place of those that there are, and adds the neighbours that they need.
    ///
    /// # Errors
    /// Errors of [`Self::with_neighbours`].
    pub fn with_outlines(&self, Outlines { colour, alone, .. }: Outlines) -> Result<Self> {
        let outlines = if alone { OUTLINES_ALONE } else { OUTLINES_OVER_SURFACES };
        let stream = self.with_neighbours()?;
        Ok(stream.with_header(|header| (header.outlines, header.outline_colour) = (outlines, colour)))
    }

    /// Removes the lines along outlines, which are no part of what references of shading draw. The neighbours stay.
    #[must_use]
    pub fn without_outlines(self) -> Self {
        self.with_header(|header| (header.outlines, header.outline_colour) = (NO_OUTLINES, [0; 3]))
    }

    /// Adds the neighbours of all triangles, which antialiasing and lines along outlines need.
    ///
    /// # Errors
    /// Errors of [`Self::parse`], or when a mesh has too many triangles.
    pub fn with_neighbours(&self) -> Result<Self> {
        let stream = self.parse()?;
        if has_neighbours(&stream) {
            return Ok(self.clone());
        }
        let words = with_neighbours(&stream)?;
        let (header, _) = Header::ref_from_prefix(words.as_bytes()).map_err(|_| anyhow!("the stream has no header"))?;
        let changed = Self { length: header.length as usize, words };
        changed.parse()?;
        Ok(changed)
    }

    /// The view of bytes that are known to be a stream, because they are unchanged since they were checked.
    ///
    /// # Errors
    /// Errors of [`Stream::parse_included`].
    pub fn view(&self) -> Result<Stream<'_>, StreamError> {
        Stream::parse_included(self.as_bytes())
    }

    /// The checked view of the bytes.
    ///
    /// # Errors
    /// Errors of [`Stream::parse`].
    pub fn parse(&self) -> Result<Stream<'_>, StreamError> {
        Stream::parse(self.as_bytes())
    }
}
