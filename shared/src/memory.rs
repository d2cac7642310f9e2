//! The memory that rendering takes: one configuration says how much of what, and works out all sizes.

use crate::{
    coverage::sample::Sample,
    format::RAMP,
    geometry::{bin::Entry, projection::ScreenVertex},
    lighting::materials::Reflectance,
    pixel::Pixel,
    raster::active::ActiveTriangle,
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// How much a renderer is to have room for.
///
/// ```
/// use embedded_graphics_core::pixelcolor::Rgb565;
/// use microphong::Layout;
///
/// const LAYOUT: Layout = Layout::new(240, 40).vertices(1024).triangles(1024);
/// static MEMORY: [u64; LAYOUT.words::<Rgb565>()] = [0; LAYOUT.words::<Rgb565>()];
/// assert_eq!(LAYOUT.bytes::<Rgb565>(), 67_472);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Columns of the picture.
    pub width: usize,
    /// Rows that are drawn at once: more rows take more memory, fewer rows more time.
    pub rows: usize,
    /// Vertices of the stream that are kept in a frame; those beyond are transformed anew by each triangle.
    pub vertices: usize,
    /// Triangles that face the camera and are kept in a frame; if there are more, each band walks all of the stream.
    pub triangles: usize,
    /// Materials of the stream.
    pub materials: usize,
    /// Triangles that one band hands on to the next, 128 bytes each; those beyond are set up anew there.
    pub active_triangles: usize,
    /// Antialiasing, 72 bytes a pixel of a band.
    pub antialias: bool,
}

impl Layout {
    /// For pictures of `width` columns, drawn `rows` at once; streams of 1,024 vertices, 1,024 triangles and one material; 48 triangles
    /// across a band's border; no antialiasing.
    #[must_use]
    pub const fn new(width: usize, rows: usize) -> Self {
        Self { width, rows, vertices: 1024, triangles: 1024, materials: 1, active_triangles: 48, antialias: false }
    }

    /// With room for so many vertices.
    #[must_use]
    pub const fn vertices(self, vertices: usize) -> Self {
        Self { vertices, ..self }
    }

    /// With room for so many triangles.
    #[must_use]
    pub const fn triangles(self, triangles: usize) -> Self {
        Self { triangles, ..self }
    }

    /// With room for so many materials.
    #[must_use]
    pub const fn materials(self, materials: usize) -> Self {
        Self { materials, ..self }
    }

    /// With room for so many triangles across a band's border.
    #[must_use]
    pub const fn active_triangles(self, active_triangles: usize) -> Self {
        Self { active_triangles, ..self }
    }

    /// With room for antialiasing.
    #[must_use]
    pub const fn antialias(self, antialias: bool) -> Self {
        Self { antialias, ..self }
    }

    /// Pixels of a band: what a buffer for pixels has to hold.
    #[must_use]
    pub const fn band(&self) -> usize {
        self.width * self.rows
    }

    const fn samples(&self) -> usize {
        if self.antialias { self.band() } else { 0 }
    }

    /// Words of 64 bits that a renderer of this layout takes in the pixel format `C`: the length of the slice that
    /// [`crate::Renderer::new`] wants.
    #[must_use]
    pub const fn words<C: Pixel>(&self) -> usize {
        let bytes = padded(self.vertices * size_of::<ScreenVertex>())
            + padded(self.triangles * size_of::<Entry>())
            + padded(self.active_triangles * size_of::<ActiveTriangle>())
            + padded(self.materials * size_of::<Reflectance>())
            + padded(self.samples() * size_of::<Sample>())
            + padded(self.materials * size_of::<[C::Stored; RAMP]>())
            + padded(self.band() * size_of::<u16>());
        bytes / size_of::<u64>()
    }

    /// Bytes that a renderer of this layout takes in the pixel format `C`, its band of pixels not included.
    #[must_use]
    pub const fn bytes<C: Pixel>(&self) -> usize {
        self.words::<C>() * size_of::<u64>()
    }
}

/// Each part begins where a word does.
const fn padded(bytes: usize) -> usize {
    bytes.next_multiple_of(size_of::<u64>())
}

/// The memory of a renderer, taken apart.
#[derive(Debug)]
pub(crate) struct Memory<'a, C: Pixel> {
    /// Transformed vertices.
    pub(crate) vertices: &'a mut [ScreenVertex],
    /// Triangles that face the camera.
    pub(crate) bins: &'a mut [Entry],
    /// Depth of one band.
    pub(crate) depth: &'a mut [u16],
    /// One per material, and its table of colours.
    pub(crate) reflectances: &'a mut [Reflectance],
    pub(crate) ramps: &'a mut [[C::Stored; RAMP]],
    /// For antialiasing.
    pub(crate) samples: &'a mut [Sample],
    /// What bands hand on to the next.
    pub(crate) active_triangles: &'a mut [ActiveTriangle],
}

impl<'a, C: Pixel> Memory<'a, C> {
    /// Takes `words` apart; `None` if they are fewer than [`Layout::words`].
    pub(crate) fn new(layout: &Layout, words: &'a mut [u64]) -> Option<Self> {
        let bytes = words.as_mut_bytes();
        let (vertices, bytes) = take(bytes, layout.vertices)?;
        let (bins, bytes) = take(bytes, layout.triangles)?;
        let (active_triangles, bytes) = take(bytes, layout.active_triangles)?;
        let (reflectances, bytes) = take(bytes, layout.materials)?;
        let (samples, bytes) = take(bytes, layout.samples())?;
        let (ramps, bytes) = take(bytes, layout.materials)?;
        let (depth, _) = take(bytes, layout.band())?;
        Some(Self { vertices, bins, depth, reflectances, ramps, samples, active_triangles })
    }
}

/// `count` values from the front, and the bytes behind them.
fn take<T: FromBytes + IntoBytes + Immutable + KnownLayout>(bytes: &mut [u8], count: usize) -> Option<(&mut [T], &mut [u8])> {
    let (part, rest) = bytes.split_at_mut_checked(padded(count.checked_mul(size_of::<T>())?))?;
    let (values, _) = <[T]>::mut_from_prefix_with_elems(part, count).ok()?;
    Some((values, rest))
}
