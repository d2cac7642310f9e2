//! The memory of a renderer. All sizes follow from one configuration, [`Layout`].

use crate::{
    coverage::sample::Sample,
    geometry::{bin::Entry, projection::ScreenVertex},
    lighting::reflectance::Reflectance,
    math::highlight_lut::HighlightLut,
    method::ErrorBounds,
    pixel::Pixel,
    placement::Placement,
    raster::active::ActiveTriangle,
    scene::{Object, SceneMaterial},
    stream::{Stream, record::Instance},
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// The size of the picture's bands, and the number of vertices, triangles and other things that a renderer has room for.
///
/// ```
/// use embedded_graphics_core::pixelcolor::Rgb565;
/// use microphong::Layout;
///
/// const LAYOUT: Layout = Layout::new(240, 40).vertices(1024).triangles(1024);
/// static MEMORY: [u64; LAYOUT.words::<Rgb565>()] = [0; LAYOUT.words::<Rgb565>()];
/// assert_eq!(LAYOUT.bytes::<Rgb565>(), 77_744);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Layout {
    /// Columns of the picture.
    pub width: usize,
    /// Rows of a band. A band is drawn at once. More rows take more memory, fewer rows more time.
    pub rows: usize,
    /// Processors that draw at the same time, each a band of its own: 1 or 2. See [`crate::Frame::in_two`].
    pub processors: usize,
    /// Vertices that a frame keeps. If the stream has more, each triangle transforms the others again.
    pub vertices: usize,
    /// Triangles that a frame keeps; triangles that face away need no room. If there are more, each band walks the whole stream.
    pub triangles: usize,
    /// Number of materials, at least as many as the stream has.
    pub materials: usize,
    /// Number of objects, at least as many as the scene has.
    pub objects: usize,
    /// Triangles that are kept from one band to the next, 132 bytes each. If more triangles cross the border of a band, the next band sets up the
    /// others again.
    pub active_triangles: usize,
    /// Whether there is room for antialiasing, which takes 72 bytes for each pixel of a band.
    pub antialias: bool,
    /// Whether there is room for tables of highlights, one for each material. See [`Self::without_highlight_tables`].
    pub highlight_tables: bool,
}

impl Layout {
    /// A layout for pictures of `width` columns in bands of `rows` rows. It has room for 1,024 vertices, 1,024 triangles, one material, one object
    /// and 48 triangles that cross the border of a band. It has no room for antialiasing.
    #[must_use]
    pub const fn new(width: usize, rows: usize) -> Self {
        Self {
            width,
            rows,
            processors: 1,
            vertices: 1024,
            triangles: 1024,
            materials: 1,
            objects: 1,
            active_triangles: 48,
            antialias: false,
            highlight_tables: true,
        }
    }

    /// Sets the number of processors that draw at the same time: 1 or 2.
    #[must_use]
    pub const fn processors(self, processors: usize) -> Self {
        Self { processors, ..self }
    }

    /// Sets the number of vertices that there is room for.
    #[must_use]
    pub const fn vertices(self, vertices: usize) -> Self {
        Self { vertices, ..self }
    }

    /// Sets the number of triangles that there is room for.
    #[must_use]
    pub const fn triangles(self, triangles: usize) -> Self {
        Self { triangles, ..self }
    }

    /// Sets the number of materials that there is room for.
    #[must_use]
    pub const fn materials(self, materials: usize) -> Self {
        Self { materials, ..self }
    }

    /// Sets the number of objects that there is room for.
    #[must_use]
    pub const fn objects(self, objects: usize) -> Self {
        Self { objects, ..self }
    }

    /// Sets the number of triangles across the border of a band that there is room for.
    #[must_use]
    pub const fn active_triangles(self, active_triangles: usize) -> Self {
        Self { active_triangles, ..self }
    }

    /// Sets whether there is room for antialiasing.
    #[must_use]
    pub const fn antialias(self, antialias: bool) -> Self {
        Self { antialias, ..self }
    }

    /// Leaves out the tables of highlights, which take 8,200 bytes for each material. The methods [`Shader::FLAT`](crate::Shader::FLAT) and
    /// [`Shader::GOURAUD`](crate::Shader::GOURAUD) need none, and a renderer refuses all others.
    #[must_use]
    pub const fn without_highlight_tables(self) -> Self {
        Self { highlight_tables: false, ..self }
    }

    /// Sets the numbers of vertices, triangles, materials and objects to those of a stream.
    #[must_use]
    pub fn with_room_for(self, stream: &Stream<'_>) -> Self {
        let whole = [Instance { first_mesh: 0, meshes: stream.meshes.len() as u16, material: 0, reserved: 0 }];
        let objects = if stream.instances.is_empty() { &whole } else { stream.instances };
        let (mut vertices, mut triangles) = (0usize, 0usize);
        for object in objects {
            let meshes = stream.meshes.iter().skip(object.first_mesh.into()).take(object.meshes.into());
            for mesh in meshes.filter(|mesh| mesh.error == 0) {
                vertices = vertices.saturating_add(mesh.vertices.into());
                triangles = triangles.saturating_add(mesh.triangles as usize);
            }
        }
        Self { vertices, triangles, materials: stream.materials.len(), objects: objects.len(), ..self }
    }

    /// Number of pixels in a band. A program needs a buffer of this length.
    #[must_use]
    pub const fn band(&self) -> usize {
        self.width * self.rows
    }

    const fn tables(&self) -> usize {
        if self.highlight_tables { self.materials } else { 0 }
    }

    const fn samples(&self) -> usize {
        if self.antialias { self.band() * self.processors } else { 0 }
    }

    /// Number of 64-bit words that a renderer needs in the pixel format `C`. The slice for [`crate::Renderer::new`] has this length.
    #[must_use]
    pub const fn words<C: Pixel>(&self) -> usize {
        let bytes = padded(self.vertices * size_of::<ScreenVertex>())
            + padded(self.triangles * size_of::<Entry>())
            + padded(self.active_triangles * size_of::<ActiveTriangle>())
            + padded(self.objects * size_of::<Placement>())
            + padded(self.objects * size_of::<u32>())
            + padded(self.objects * size_of::<Object>())
            + padded(self.materials * size_of::<SceneMaterial>())
            + padded(self.materials * size_of::<Reflectance>())
            + padded(self.tables() * size_of::<HighlightLut>())
            + padded(self.materials * size_of::<ErrorBounds>())
            + padded(self.samples() * size_of::<Sample>())
            + padded(self.materials * size_of::<C::Ramps>())
            + padded(self.band() * self.processors * size_of::<u16>());
        bytes / size_of::<u64>()
    }

    /// Number of bytes that a renderer needs in the pixel format `C`. The buffer for a band is not included.
    #[must_use]
    pub const fn bytes<C: Pixel>(&self) -> usize {
        self.words::<C>() * size_of::<u64>()
    }
}

/// Each part of the memory begins at a multiple of a word.
const fn padded(bytes: usize) -> usize {
    bytes.next_multiple_of(size_of::<u64>())
}

/// The sizes that docs/design.md tells.
const _: () = {
    assert!(size_of::<ScreenVertex>() == 32 && size_of::<Entry>() == 8 && size_of::<ActiveTriangle>() == 132);
    assert!(size_of::<Reflectance>() == 396 && size_of::<HighlightLut>() == 8200 && size_of::<Sample>() == 72);
};

/// The memory of a renderer, divided into its parts.
#[derive(Debug)]
pub(crate) struct Memory<'a> {
    /// Transformed vertices.
    pub(crate) vertices: &'a mut [ScreenVertex],
    /// Triangles that face the camera.
    pub(crate) bins: &'a mut [Entry],
    /// Depth of one band.
    pub(crate) depth: &'a mut [u16],
    /// Objects in the latest frame.
    pub(crate) placements: &'a mut [Placement],
    /// Their indices, in the order in which they are drawn.
    pub(crate) order: &'a mut [u32],
    /// One for each material.
    pub(crate) reflectances: &'a mut [Reflectance],
    /// One table of highlights for each material, or none.
    pub(crate) tables: &'a mut [HighlightLut],
    /// For each material, what a method with an error budget knows of it.
    pub(crate) error_bounds: &'a mut [ErrorBounds],
    /// Samples for antialiasing; empty without it.
    pub(crate) samples: &'a mut [Sample],
    /// Triangles that are kept from one band to the next.
    pub(crate) active_triangles: &'a mut [ActiveTriangle],
}

/// Takes the tables of colours of all materials from `words`; returns them and the bytes behind them. `None` if there are fewer than
/// [`Layout::words`] says.
pub(crate) fn take_ramps<'a, C: Pixel>(layout: &Layout, words: &'a mut [u64]) -> Option<(&'a mut [C::Ramps], &'a mut [u8])> {
    take(words.as_mut_bytes(), layout.materials)
}

impl<'a> Memory<'a> {
    /// Divides the `bytes` behind the tables of colours: the memory, and room for objects and materials of the scene. `None` if there are fewer than
    /// [`Layout::words`] says.
    pub(crate) fn new(layout: &Layout, bytes: &'a mut [u8]) -> Option<(Self, &'a mut [Object], &'a mut [SceneMaterial])> {
        let (vertices, bytes) = take(bytes, layout.vertices)?;
        let (bins, bytes) = take(bytes, layout.triangles)?;
        let (active_triangles, bytes) = take(bytes, layout.active_triangles)?;
        let (placements, bytes) = take(bytes, layout.objects)?;
        let (order, bytes) = take(bytes, layout.objects)?;
        let (reflectances, bytes) = take(bytes, layout.materials)?;
        let (tables, bytes) = take(bytes, layout.tables())?;
        let (error_bounds, bytes) = take(bytes, layout.materials)?;
        let (samples, bytes) = take(bytes, layout.samples())?;
        let (depth, bytes) = take(bytes, layout.band() * layout.processors)?;
        let (objects, bytes) = take(bytes, layout.objects)?;
        let (materials, _) = take(bytes, layout.materials)?;
        Some((
            Self { vertices, bins, depth, placements, order, reflectances, tables, error_bounds, samples, active_triangles },
            objects,
            materials,
        ))
    }
}

/// Takes `count` values from the front; returns them and the bytes behind them.
fn take<T: FromBytes + IntoBytes + Immutable + KnownLayout>(bytes: &mut [u8], count: usize) -> Option<(&mut [T], &mut [u8])> {
    let (part, rest) = bytes.split_at_mut_checked(padded(count.checked_mul(size_of::<T>())?))?;
    let (values, _) = <[T]>::mut_from_prefix_with_elems(part, count).ok()?;
    Some((values, rest))
}
