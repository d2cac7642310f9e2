//! The memory of a renderer. All sizes follow from one configuration, [`Layout`].

use crate::{
    edges::FeatureEdge,
    features::LIGHTS,
    geometry::{bin::Entry, projection::ScreenVertex},
    lighting::reflectance::Reflectance,
    math::highlight_lut::HighlightLut,
    method::ErrorBounds,
    pixel::Pixel,
    placement::Placement,
    raster::active::ActiveTriangle,
    scene::{Object, SceneMaterial},
    stream::{
        Stream,
        record::{Instance, NO_OUTLINES},
    },
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// The configuration that decides how much memory a [`Renderer`](crate::Renderer) needs: the size of the picture and of its bands (a band
/// is a group of rows that is drawn at once), and how many vertices, triangles, materials and objects there is room for. Use it as a
/// constant, so that the memory can be a `static`.
///
/// ```
/// use embedded_graphics_core::pixelcolor::Rgb565;
/// use microphong::Layout;
///
/// const LAYOUT: Layout = Layout::new(240, 40).vertices(1024).triangles(1024);
/// static MEMORY: [u64; LAYOUT.words::<Rgb565>()] = [0; LAYOUT.words::<Rgb565>()];
/// // The shapes of eight lights take 128 bytes.
/// assert_eq!(LAYOUT.bytes::<Rgb565>(), if cfg!(feature = "light-shapes") { 77_688 } else { 77_560 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Layout {
    /// The width of the picture in pixels. It has to equal the width that [`Renderer::new`](crate::Renderer::new) is called with.
    pub width: usize,
    /// The number of rows of a band (group of rows drawn at once), at least 1. A picture is drawn and sent band by band, so few rows save
    /// memory, and many rows save time.
    pub rows: usize,
    /// The number of processors that draw at the same time, 1 or 2, each its own rows of the picture. See
    /// [`Frame::in_two`](crate::Frame::in_two).
    pub processors: usize,
    /// The number of transformed vertices that a frame keeps, 32 bytes each. If the scene has more vertices, the picture stays the same,
    /// but the vertices without room are transformed again for each triangle that uses them.
    pub vertices: usize,
    /// The number of visible triangles that a frame keeps in its list, 8 bytes each; triangles that face away need no room. If more
    /// triangles are visible, the picture stays the same, but each band (group of rows drawn at once) goes through all triangles of the
    /// scene.
    pub triangles: usize,
    /// The number of materials that there is room for. A renderer refuses a stream (mesh file) that has more.
    pub materials: usize,
    /// The number of objects that there is room for, at least 1. A renderer refuses a stream (mesh file) that has more, and
    /// [`Scene::add`](crate::Scene::add) fails beyond this number.
    pub objects: usize,
    /// The number of triangles that can continue from one band (group of rows drawn at once) into the next without being set up again, 128
    /// bytes each. If more triangles cross the border between two bands, the picture stays the same, but the next band sets up the others
    /// again.
    pub active_triangles: usize,
    /// Whether there is room for antialiasing, which takes two to three bytes for each pixel of a band (group of rows drawn at once), four rows
    /// more, and 24 bytes for each of [`Self::edges`]. [`Renderer::set_antialias`](crate::Renderer::set_antialias) turns it on. Lines along outlines
    /// need it, too.
    pub antialias: bool,
    /// The number of tables of highlights that there is room for, 8,200 bytes each; more than [`Self::materials`] are never needed. By default
    /// there is one for each material. Materials with equal highlights share one, and materials without highlights need none, except in greys
    /// under one light. See [`Self::highlight_tables`](Self::highlight_tables()).
    pub highlight_tables: usize,
    /// With antialiasing, the number of edges in the outlines of a frame that there is room for, 24 bytes each. If there are more, the picture stays
    /// the same, but each band (group of rows drawn at once) looks for them in all triangles of the scene.
    pub edges: usize,
}

impl Layout {
    /// Creates a layout for pictures that are `width` pixels wide and are drawn in bands (groups) of `rows` rows. It has room for 1,024
    /// vertices, 1,024 triangles, one material, one object, and 48 triangles that cross the border between two bands. It is for one
    /// processor, without antialiasing.
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
            highlight_tables: usize::MAX,
            edges: 512,
        }
    }

    /// Sets the number of processors that draw at the same time, 1 or 2. The default is 1.
    #[must_use]
    pub const fn processors(self, processors: usize) -> Self {
        Self { processors, ..self }
    }

    /// Sets the number of vertices that there is room for. If the scene has more, it is still drawn, but vertices that do not fit are transformed
    /// again for each triangle that uses them, which is slower.
    #[must_use]
    pub const fn vertices(self, vertices: usize) -> Self {
        Self { vertices, ..self }
    }

    /// Sets the number of visible triangles that a frame can keep in its list, 8 bytes each. The default is 1,024.
    #[must_use]
    pub const fn triangles(self, triangles: usize) -> Self {
        Self { triangles, ..self }
    }

    /// Sets the number of materials that there is room for. The default is 1.
    #[must_use]
    pub const fn materials(self, materials: usize) -> Self {
        Self { materials, ..self }
    }

    /// Sets the number of objects that a scene has room for: one for each call of [`Scene::add`](crate::Scene::add). The default is 1.
    #[must_use]
    pub const fn objects(self, objects: usize) -> Self {
        Self { objects, ..self }
    }

    /// Sets the number of triangles that can continue from one band (group of rows drawn at once) into the next without being set up again,
    /// 128 bytes each. The default is 48.
    #[must_use]
    pub const fn active_triangles(self, active_triangles: usize) -> Self {
        Self { active_triangles, ..self }
    }

    /// Sets whether there is room for antialiasing, which takes two to three bytes for each pixel of a band (group of rows drawn at once), and
    /// room for edges. The default is `false`.
    #[must_use]
    pub const fn antialias(self, antialias: bool) -> Self {
        Self { antialias, ..self }
    }

    /// Sets the number of tables of highlights, which take 8,200 bytes each. By default there is one for each material. Materials without highlights
    /// need none, except in greys under one light. Materials with equal highlights share a table. These are all materials of one exponent whose
    /// highlights differ in hue from their diffuse light, as on plastic, or
    /// that are lit by several lights. Under one light, materials of one hue share a table only if their ambient and specular light are equal too.
    ///
    /// If there are too few, [`Frame::next_band`](crate::Frame::next_band) returns
    /// [`RenderError::TooFewHighlightTables`](crate::RenderError::TooFewHighlightTables) with the number that is needed.
    #[must_use]
    pub const fn highlight_tables(self, highlight_tables: usize) -> Self {
        Self { highlight_tables, ..self }
    }

    /// Sets the number of edges in the outlines of a frame that there is room for with antialiasing, 24 bytes each. The default is 512.
    #[must_use]
    pub const fn edges(self, edges: usize) -> Self {
        Self { edges, ..self }
    }

    /// Leaves out the tables of highlights, which take 8,200 bytes for each material. Methods that use the light of vertices alone need none:
    /// [`Shader::FLAT`](crate::Shader::FLAT) and [`Shader::GOURAUD`](crate::Shader::GOURAUD). A renderer refuses all others, see
    /// [`Method::needs_highlight_tables`](crate::method::Method::needs_highlight_tables).
    #[must_use]
    pub const fn without_highlight_tables(self) -> Self {
        self.highlight_tables(0)
    }

    /// Sets the numbers of vertices, triangles, materials and objects to what the scene in the mesh file `stream` needs, and makes room for
    /// antialiasing if the scene has lines along outlines. All other values stay. This suits programs that can allocate memory when they run; a
    /// `static` needs numbers that are known at compile time.
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
        let antialias = self.antialias || stream.header.outlines != NO_OUTLINES;
        Self { vertices, triangles, materials: stream.materials.len(), objects: objects.len(), antialias, ..self }
    }

    /// Returns the number of pixels in a band (group of rows drawn at once): width times rows. The program passes a pixel buffer of this
    /// length to [`Picture::new`](crate::Picture::new) or [`Frame::next_band`](crate::Frame::next_band).
    #[must_use]
    pub const fn band(&self) -> usize {
        self.width * self.rows
    }

    const fn tables(&self) -> usize {
        if self.highlight_tables < self.materials { self.highlight_tables } else { self.materials }
    }

    /// Rows of depth. With antialiasing, those above and below the band belong to them.
    const fn depth(&self) -> usize {
        (self.rows + if self.antialias { 2 } else { 0 }) * self.width * self.processors
    }

    /// Edges, their entries in lists, pixels that can be marked, places of marked pixels, and kept colours: of marked pixels, and of two rows.
    const fn smoothing(&self) -> [usize; 5] {
        if !self.antialias {
            return [0; 5];
        }
        let Self { width, processors, edges, .. } = *self;
        // There is room for the pixels of a row at least.
        let marked = (width + self.band() / 4) * processors;
        [edges, edges * processors, self.band() * processors, marked, marked + 2 * width * processors]
    }

    /// Returns the number of 64-bit words of memory that a renderer needs when it draws in the pixel format `C`.
    /// [`Renderer::new`](crate::Renderer::new) takes a `&mut [u64]` of this length.
    #[must_use]
    pub const fn words<C: Pixel>(&self) -> usize {
        let [edges, edge_entries, marks, places, kept] = self.smoothing();
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
            + padded(edges * size_of::<FeatureEdge>())
            + padded(edge_entries * size_of::<Entry>())
            + padded(marks)
            + padded(places * size_of::<u16>())
            + padded(kept * size_of::<C::Stored>())
            + padded(self.materials * size_of::<C::Ramps>())
            + padded(self.depth() * size_of::<u16>());
        bytes / size_of::<u64>()
    }

    /// Returns the number of bytes of memory that a renderer needs when it draws in the pixel format `C`: 8 times [`Self::words`]. The
    /// pixel buffer for a band ([`Self::band`]) is not included.
    #[must_use]
    pub const fn bytes<C: Pixel>(&self) -> usize {
        self.words::<C>() * size_of::<u64>()
    }
}

/// Each part of the memory begins at a multiple of a word.
const fn padded(bytes: usize) -> usize {
    bytes.next_multiple_of(size_of::<u64>())
}

/// The sizes that docs/design.md states.
const _: () = {
    assert!(size_of::<ScreenVertex>() == 32 && size_of::<Entry>() == 8 && size_of::<ActiveTriangle>() == 128);
    assert!(!LIGHTS || size_of::<Reflectance>() == 396);
    assert!(size_of::<HighlightLut>() == 8200 && size_of::<FeatureEdge>() == 16);
};

/// The memory of a renderer, divided into its parts.
#[derive(Debug)]
pub(crate) struct Memory<'a> {
    /// Transformed vertices.
    pub(crate) vertices: &'a mut [ScreenVertex],
    /// Triangles that face the camera, in lists.
    pub(crate) entries: &'a mut [Entry],
    /// Depth of one band.
    pub(crate) depth: &'a mut [u16],
    /// Objects in the latest frame.
    pub(crate) placements: &'a mut [Placement],
    /// The indices of the objects, in the order in which they are drawn.
    pub(crate) order: &'a mut [u32],
    /// The reflectance of each material.
    pub(crate) reflectances: &'a mut [Reflectance],
    /// Tables of highlights, which materials share, or none.
    pub(crate) tables: &'a mut [HighlightLut],
    /// The error bounds of each material, for methods with an error budget.
    pub(crate) error_bounds: &'a mut [ErrorBounds],
    /// Memory for antialiasing; empty without it.
    pub(crate) smoothing: Smoothing<'a>,
    /// Triangles that are kept from one band to the next.
    pub(crate) active_triangles: &'a mut [ActiveTriangle],
}

/// Memory for antialiasing, of one processor or of two.
#[derive(Debug, Default)]
pub(crate) struct Smoothing<'a> {
    /// The edges of a frame.
    pub(crate) edges: &'a mut [FeatureEdge],
    /// Entries of the lists of edges.
    pub(crate) entries: &'a mut [Entry],
    /// Marks of the pixels of a band. They are 0 between two bands.
    pub(crate) marks: &'a mut [u8],
    /// The pixels that have a mark.
    pub(crate) places: &'a mut [u16],
    /// Colours in the pixel format, as bytes: those of two rows, then those of marked pixels.
    pub(crate) colours: &'a mut [u8],
}

impl<'a> Memory<'a> {
    /// Divides the `bytes` behind the tables of colours into the parts of the memory and the room for objects and materials of the scene. Returns
    /// `None` if there are fewer than [`Layout::words`] says. A colour takes `stored` bytes.
    pub(crate) fn new(layout: &Layout, bytes: &'a mut [u8], stored: usize) -> Option<(Self, &'a mut [Object], &'a mut [SceneMaterial])> {
        let (vertices, bytes) = take(bytes, layout.vertices)?;
        let (entries, bytes) = take(bytes, layout.triangles)?;
        let (active_triangles, bytes) = take(bytes, layout.active_triangles)?;
        let (placements, bytes) = take(bytes, layout.objects)?;
        let (order, bytes) = take(bytes, layout.objects)?;
        let (reflectances, bytes) = take(bytes, layout.materials)?;
        let (tables, bytes) = take(bytes, layout.tables())?;
        let (error_bounds, bytes) = take(bytes, layout.materials)?;
        let [edges, edge_entries, marks, places, kept] = layout.smoothing();
        let (edges, bytes) = take(bytes, edges)?;
        let (edge_entries, bytes) = take(bytes, edge_entries)?;
        let (marks, bytes) = take(bytes, marks)?;
        let (places, bytes) = take(bytes, places)?;
        let (kept, bytes) = take(bytes, kept * stored)?;
        let smoothing = Smoothing { edges, entries: edge_entries, marks, places, colours: kept };
        let (depth, bytes) = take(bytes, layout.depth())?;
        let (objects, bytes) = take(bytes, layout.objects)?;
        let (materials, _) = take(bytes, layout.materials)?;
        Some((
            Self { vertices, entries, depth, placements, order, reflectances, tables, error_bounds, smoothing, active_triangles },
            objects,
            materials,
        ))
    }
}

/// Takes `count` values from the front; returns them and the bytes behind them, or `None` if there are fewer.
pub(crate) fn take<T: FromBytes + IntoBytes + Immutable + KnownLayout>(bytes: &mut [u8], count: usize) -> Option<(&mut [T], &mut [u8])> {
    let (part, rest) = bytes.split_at_mut_checked(padded(count.checked_mul(size_of::<T>())?))?;
    let (values, _) = <[T]>::mut_from_prefix_with_elems(part, count).ok()?;
    Some((values, rest))
}

/// Splits some memory behind the first `length` values, or behind all if there are fewer.
pub(crate) fn halves<T>(memory: &mut [T], length: usize) -> (&mut [T], &mut [T]) {
    let length = length.min(memory.len());
    memory.split_at_mut_checked(length).unwrap_or_default()
}
