//! Streams: mesh files that `microphong convert` writes, with meshes, materials, lights, a camera and an animation.
//!
//! A stream is read in place, from flash. [`Stream::parse`] checks length, checksum, all indices and all ranges, once. Rendering relies on these
//! checks and repeats none of them.

mod included;
mod names;
#[doc(hidden)]
pub mod record;

use crate::{
    features::{TEXTURED, TEXTURES},
    format::{GeometricError, LARGEST_BUDGET, LEAST_BUDGET, MAX_LIGHTS, NORMAL_LENGTH, ROTATION, UNIT},
    math::vector::{cross, dot},
};
use core::{fmt, ops::Range};
#[doc(hidden)]
pub use included::check_included;
#[doc(hidden)]
pub use names::MAX_NAME;
pub use names::{Names, UnknownMesh};
use record::{
    CAMERA_TRACK, Colour, CornerColours, Cut, EYE_SPACE, HAS_COLOURS, HAS_NEIGHBOURS, HAS_TEXTURE, Instance, Key, LARGEST_TEXTURE,
    LIGHT_TRACK, Label, Light, MAGIC, MAX_POSITION, Material, NO_OUTLINES, Neighbours, OBJECT_TRACK, OPEN, ORTHOGRAPHIC, OUTLINES_ALONE,
    OWN_MATERIALS, PALETTE, PERSPECTIVE, POINT, RIGHT, SKY, Texture, TextureCorners, Track, Triangle, VERSION, VIEWER_LOCAL, Vertex,
};
#[doc(inline)]
pub use record::{Camera, Header, Mesh};
use zerocopy::{FromBytes, Immutable, KnownLayout};

/// A wrapper that aligns its contents to four bytes, as [`Stream::parse`] needs. Wrap the result of `include_bytes!` in it, or use
/// [`include_stream!`](crate::include_stream!), which does so. `B` is the type of the contents, for example `[u8; 1000]`.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(4))]
pub struct Aligned<B: ?Sized>(
    /// The bytes that are aligned.
    pub B,
);

/// A view of a mesh file ("stream") that `microphong convert` has written: meshes, materials, lights, a camera and an animation. It is read in place:
/// a `Stream` only borrows the bytes, and copies cost nothing. [`Self::parse`] has checked all of it but the names of objects.
#[derive(Clone, Copy, Debug)]
pub struct Stream<'a> {
    /// The first record of the stream (mesh file), with the camera, the background and the number of records of each kind.
    pub header: &'a Header,
    /// The meshes. Each is followed by its coarser levels of detail, if it has any.
    pub meshes: &'a [Mesh],
    /// The materials: their colours and highlight exponents. A mesh refers to them by index.
    pub materials: &'a [Material],
    /// The lights that the scene has at first; a program can change them, see [`Scene::set_lights`](crate::Scene::set_lights). Each light shines on
    /// all meshes.
    pub lights: &'a [Light],
    /// Objects of the scene. If there are none, the scene is one object of all meshes.
    #[doc(hidden)]
    pub instances: &'a [Instance],
    /// Movements of objects, lights and the camera.
    #[doc(hidden)]
    pub tracks: &'a [Track],
    /// Keys of all tracks.
    #[doc(hidden)]
    pub keys: &'a [Key],
    /// Triangles that cut each other, for antialiasing and lines.
    #[doc(hidden)]
    pub cuts: &'a [Cut],
    /// Vertices of all meshes.
    #[doc(hidden)]
    pub vertices: &'a [Vertex],
    /// Triangles of all meshes and of their levels of detail.
    #[doc(hidden)]
    pub triangles: &'a [Triangle],
    /// Neighbours of all triangles, for antialiasing and lines; empty if `microphong convert` wrote the file without `--antialias`.
    #[doc(hidden)]
    pub neighbours: &'a [Neighbours],
    /// Colours at the corners of the first triangles; empty if no mesh has any.
    #[doc(hidden)]
    pub corner_colours: &'a [CornerColours],
    /// The palettes of all meshes and textures.
    #[doc(hidden)]
    pub colours: &'a [Colour],
    /// The textures. A program without the feature has no room for them.
    #[doc(hidden)]
    pub textures: [TextureRecords<'a>; TEXTURED],
    /// Texts that are drawn over the picture.
    #[doc(hidden)]
    pub labels: &'a [Label],
    /// Names of the meshes as bytes of the file; empty if there are none. [`Stream::names`] reads them.
    #[doc(hidden)]
    pub names: &'a [u8],
}

/// The colours at the corners of the triangles of a mesh.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct MeshColours<'a> {
    /// The colours of the mesh, and of others behind them.
    pub palette: &'a [Colour],
    /// For each triangle.
    pub corners: &'a [CornerColours],
}

/// The records of textures in a stream.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, Default)]
pub struct TextureRecords<'a> {
    /// The textures.
    pub list: &'a [Texture],
    /// Where the triangles of meshes with textures lie in these, one mesh after the other.
    pub corners: &'a [TextureCorners],
    /// The texels of all textures.
    pub texels: &'a [u8],
}

/// The texture of a mesh.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct MeshTexture<'a> {
    /// The colours of the texture, and of others behind them.
    pub palette: &'a [Colour],
    /// The texels, row by row: indices of the palette.
    pub texels: &'a [u8],
    /// The binary logarithms of width and height.
    pub size: [u8; 2],
    /// Whether it may have holes.
    pub has_holes: bool,
    /// For each triangle.
    pub corners: &'a [TextureCorners],
}

/// The reason why bytes are not a valid stream (a mesh file that `microphong convert` has written).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum StreamError {
    /// The bytes do not begin at an address that is a multiple of four. [`Aligned`] or [`include_stream!`](crate::include_stream!) aligns
    /// them.
    Misaligned,
    /// The slice is shorter than the length in the header of the mesh file says, for example because the file was cut off.
    Truncated {
        /// The number of bytes that are needed.
        need: u32,
        /// The number of bytes in the slice.
        have: u32,
    },
    /// The bytes are not a stream (mesh file), because they do not begin with `mTRI`.
    Magic,
    /// The stream (mesh file) was written for another version of this crate. Convert the mesh again with `microphong convert`.
    Version {
        /// The version of the format in the stream.
        found: u16,
    },
    /// The checksum of the stream (mesh file) does not match, because its bytes have changed since they were written.
    Checksum {
        /// The checksum in the header of the stream (mesh file).
        stored: u32,
        /// The checksum of the bytes in the slice.
        computed: u32,
    },
    /// The header of the stream (mesh file) contradicts itself: its length is too small for the numbers of records that it states.
    Length {
        /// The smallest length in bytes that the numbers of meshes, vertices and triangles in the header require.
        need: u32,
        /// The length in bytes that the header states.
        claimed: u32,
    },
    /// A field in the stream (mesh file) has a value outside of its range.
    Field {
        /// The name of the field whose value is out of its range, such as "light colour".
        name: &'static str,
        /// The index of the record that has the field, among the records of its kind (meshes, lights and so on).
        record: u32,
    },
}

impl fmt::Display for StreamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Misaligned => write!(f, "the stream does not begin at a multiple of 4 bytes; embed it with include_stream!"),
            Self::Truncated { need, have } => write!(f, "the stream is truncated to {have} bytes of {need}; copy or convert it again"),
            Self::Magic => write!(f, "offset 0: this is not a stream (wrong magic); make one with `microphong convert`"),
            Self::Version { found } => {
                write!(f, "offset 4: the format has version {found}, but this program reads {VERSION}; convert the mesh again")
            }
            Self::Checksum { stored, computed } => {
                write!(f, "offset 12: the stream is damaged (checksum {computed:08x} instead of {stored:08x}); copy or convert it again")
            }
            Self::Length { need, claimed } => {
                write!(f, "offset 8: the length is {claimed} bytes, but the records take {need}; convert the mesh again")
            }
            Self::Field { name, record } => write!(f, "{name} of record {record} is out of range; convert the mesh again"),
        }
    }
}

impl core::error::Error for StreamError {}

/// The algorithm of the checksums of streams and pictures: CRC-32 (ISO-HDLC). It uses a small table, which saves flash.
#[doc(hidden)]
pub const CRC: crc::Crc<u32, crc::NoTable> = crc::Crc::<u32, crc::NoTable>::new(&crc::CRC_32_ISO_HDLC);

/// Offset of the stored checksum.
const CRC_AT: Range<usize> = 12..16;

/// Checksum of a stream, over all its bytes but those of the checksum.
fn checksum(bytes: &[u8]) -> u32 {
    let mut digest = CRC.digest();
    digest.update(bytes.get(..CRC_AT.start).unwrap_or_default());
    digest.update(bytes.get(CRC_AT.end..).unwrap_or_default());
    digest.finalize()
}

/// [`checksum`] of at least as many bytes as the header's checksum ends at, by a large table: it needs fewer steps for each byte, and each step takes
/// the compiler long. No board needs it, because boards only read streams.
const fn checksum_by_table(bytes: &[u8]) -> u32 {
    static ALGORITHM: crc::Crc<u32, crc::Table<16>> = crc::Crc::<u32, crc::Table<16>>::new(&crc::CRC_32_ISO_HDLC);
    let mut digest = ALGORITHM.digest();
    digest.update(bytes.split_at(CRC_AT.start).0);
    digest.update(bytes.split_at(CRC_AT.end).1);
    digest.finalize()
}

/// Writes the checksum of `bytes` into their header. A program that writes streams does this last.
#[doc(hidden)]
pub fn seal(bytes: &mut [u8]) {
    if bytes.len() < CRC_AT.end {
        return;
    }
    let crc = checksum_by_table(bytes);
    if let Some(stored) = bytes.get_mut(CRC_AT) {
        stored.copy_from_slice(&crc.to_le_bytes());
    }
}

fn field(ok: bool, name: &'static str, record: usize) -> Result<(), StreamError> {
    if ok { Ok(()) } else { Err(StreamError::Field { name, record: record as u32 }) }
}

/// Splits `count` records off the front of `bytes`; the caller has checked that they are there.
fn take<'a, T: FromBytes + Immutable + KnownLayout>(bytes: &mut &'a [u8], count: usize) -> Result<&'a [T], StreamError> {
    let (records, rest) = <[T]>::ref_from_prefix_with_elems(bytes, count).map_err(|_| StreamError::Misaligned)?;
    *bytes = rest;
    Ok(records)
}

/// Splits the records of textures off the front of `bytes`.
fn textures<'a>(bytes: &mut &'a [u8], header: &Header) -> Result<[TextureRecords<'a>; TEXTURED], StreamError> {
    let mut textures = [TextureRecords::default(); TEXTURED];
    if let Some(TextureRecords { list, corners, texels }) = textures.first_mut() {
        *list = take(bytes, header.textures.into())?;
        *corners = take(bytes, header.texture_corners as usize)?;
        *texels = take(bytes, header.texels as usize)?;
    } else {
        let sizes = usize::from(header.textures) * size_of::<Texture>() + header.texture_corners as usize * size_of::<TextureCorners>();
        let _: &[u8] = take(bytes, sizes + header.texels as usize)?;
    }
    Ok(textures)
}

/// Length in bytes of a stream with the numbers of records in `header`, without names and neighbours; `None` beyond 4 GiB.
#[doc(hidden)]
#[must_use]
pub fn length(header: &Header) -> Option<u32> {
    let sizes = [
        (1, size_of::<Header>()),
        (u32::from(header.meshes), size_of::<Mesh>()),
        (u32::from(header.materials), size_of::<Material>()),
        (u32::from(header.lights), size_of::<Light>()),
        (u32::from(header.instances), size_of::<Instance>()),
        (u32::from(header.tracks), size_of::<Track>()),
        (header.keys, size_of::<Key>()),
        (header.vertices, size_of::<Vertex>()),
        (header.triangles, size_of::<Triangle>()),
        (header.labels.into(), size_of::<Label>()),
        (header.cuts, size_of::<Cut>()),
        (header.corner_colours, size_of::<CornerColours>()),
        (header.colours.into(), size_of::<Colour>()),
        (header.textures.into(), size_of::<Texture>()),
        (header.texture_corners, size_of::<TextureCorners>()),
        (header.texels, 1),
    ];
    sizes.iter().try_fold(0u32, |sum, &(count, size)| sum.checked_add(count.checked_mul(size as u32)?))
}

impl<'a> Stream<'a> {
    /// Checks `bytes` and returns a view of the stream (mesh file) in them. Length, checksum, indices and ranges are checked once, here.
    /// Bytes after the end of the stream are ignored.
    ///
    /// # Errors
    /// Returns a [`StreamError`] that describes the first fault.
    // Copies of it on the way stay off the stack of the frame loop.
    #[inline(never)]
    pub fn parse(bytes: &'a [u8]) -> Result<Self, StreamError> {
        let stream = Self::read(bytes)?;
        let header = stream.header;
        let computed = checksum(bytes.get(..header.length as usize).unwrap_or_default());
        if computed != header.crc {
            return Err(StreamError::Checksum { stored: header.crc, computed });
        }
        stream.check()?;
        Ok(stream)
    }

    /// Finds the records in `bytes`, which begin with a header.
    fn read(bytes: &'a [u8]) -> Result<Self, StreamError> {
        let have = bytes.len() as u32;
        let truncated = |need| StreamError::Truncated { need, have };
        let (header, _) = Header::ref_from_prefix(bytes).map_err(|e| match e {
            zerocopy::ConvertError::Alignment(_) => StreamError::Misaligned,
            _ => truncated(size_of::<Header>() as u32),
        })?;
        if header.magic != MAGIC {
            return Err(StreamError::Magic);
        }
        if header.version != VERSION {
            return Err(StreamError::Version { found: header.version });
        }
        let stream = bytes.get(..header.length as usize).ok_or(truncated(header.length))?;
        let claimed = |need: Option<u32>| match need {
            None => Err(StreamError::Field { name: "count", record: 0 }),
            Some(need) if need > header.length => Err(StreamError::Length { need, claimed: header.length }),
            Some(need) => Ok(need),
        };
        let need = claimed(length(header))?;
        let mut rest = stream.get(size_of::<Header>()..).ok_or(truncated(need))?;
        let meshes: &[Mesh] = take(&mut rest, header.meshes.into())?;
        let has_neighbours = meshes.first().is_some_and(|mesh| mesh.flags & HAS_NEIGHBOURS != 0);
        let neighbours = if has_neighbours { header.triangles } else { 0 };
        claimed(neighbours.checked_mul(size_of::<Neighbours>() as u32).and_then(|bytes| bytes.checked_add(need)))?;
        Ok(Self {
            header,
            meshes,
            materials: take(&mut rest, header.materials.into())?,
            lights: take(&mut rest, header.lights.into())?,
            instances: take(&mut rest, header.instances.into())?,
            tracks: take(&mut rest, header.tracks.into())?,
            keys: take(&mut rest, header.keys as usize)?,
            cuts: take(&mut rest, header.cuts as usize)?,
            vertices: take(&mut rest, header.vertices as usize)?,
            triangles: take(&mut rest, header.triangles as usize)?,
            neighbours: take(&mut rest, neighbours as usize)?,
            corner_colours: take(&mut rest, header.corner_colours as usize)?,
            colours: take(&mut rest, header.colours.into())?,
            textures: textures(&mut rest, header)?,
            labels: take(&mut rest, header.labels.into())?,
            names: rest,
        })
    }

    /// The ranges that the renderer's arithmetic relies on.
    fn check(&self) -> Result<(), StreamError> {
        let header = self.header;
        field(header.frames > 0, "frames", 0)?;
        field(header.budget().is_none_or(|budget| (LEAST_BUDGET..=LARGEST_BUDGET).contains(&budget)), "budget", 0)?;
        field(self.lights.len() <= MAX_LIGHTS, "lights", 0)?;
        field(header.outlines <= OUTLINES_ALONE, "outlines", 0)?;
        let has_outlines = header.outlines != NO_OUTLINES;
        field(has_outlines || header.outline_colour == [0; 3], "outline colour", 0)?;
        field(header.corner_colours <= header.triangles, "corner colours", 0)?;
        field(!TEXTURES || header.texels.is_multiple_of(4), "texels", 0)?;
        field(!has_outlines || header.triangles == 0 || !self.neighbours.is_empty(), "neighbours for outlines", 0)?;
        let fault = |fault: Option<&'static str>, i: usize| fault.map_or(Ok(()), |name| field(false, name, i));
        fault(header.camera.fault(), 0)?;
        for (i, material) in self.materials.iter().enumerate() {
            fault(material.fault(), i)?;
        }
        field(is_gain(header.ambient), "ambient light", 0)?;
        for (i, light) in self.lights.iter().enumerate() {
            fault(light.fault(), i)?;
        }
        let (mut next_vertex, mut next_triangle, mut textured) = (0, 0, 0);
        let Some(mut finer) = self.meshes.first() else { return field(false, "meshes", 0) };
        for (i, mesh) in self.meshes.iter().enumerate() {
            // The first record has none before it, and so none that is finer than itself.
            let is_level = mesh.error > 0;
            let expected = if is_level { finer.first_vertex } else { next_vertex };
            field(mesh.first_vertex == expected, "mesh first vertex", i)?;
            let is_coarser = mesh.error > finer.error
                && mesh.vertices == finer.vertices
                && mesh.material == finer.material
                && mesh.palette == finer.palette
                && (mesh.flags ^ finer.flags) & HAS_TEXTURE == 0
                && mesh.transparency() == finer.transparency();
            field(!is_level || is_coarser, "mesh level", i)?;
            finer = mesh;
            next_vertex = expected.saturating_add(mesh.vertices.into());
            field(mesh.first_triangle == next_triangle, "mesh first triangle", i)?;
            next_triangle = next_triangle.saturating_add(mesh.triangles);
            field(usize::from(mesh.material) < self.materials.len(), "mesh material", i)?;
            field(self.vertices_of(mesh).is_some(), "mesh vertices", i)?;
            let triangles = self.triangles_of(mesh).ok_or(StreamError::Field { name: "mesh triangles", record: i as u32 })?;
            for (k, triangle) in triangles.iter().enumerate() {
                let name = "triangle corner";
                field(triangle.corners.iter().all(|&c| c < mesh.vertices), name, mesh.first_triangle as usize + k)?;
            }
            let has_neighbours = mesh.flags & HAS_NEIGHBOURS != 0;
            field(has_neighbours != self.neighbours.is_empty() || header.triangles == 0, "mesh neighbours", i)?;
            self.check_colours(mesh, i)?;
            if TEXTURES {
                textured += self.check_texture(mesh, i)?;
            }
            for (k, Neighbours(edges)) in self.neighbours_of(mesh).iter().enumerate() {
                let exists = |&other: &u16| other & OPEN == OPEN || u32::from(other & OPEN) < mesh.triangles;
                field(edges.iter().all(exists), "triangle neighbour", mesh.first_triangle as usize + k)?;
            }
        }
        field(next_vertex == header.vertices && next_triangle == header.triangles, "mesh coverage", self.meshes.len())?;
        field(!TEXTURES || textured == header.texture_corners, "texture corners", 0)?;
        self.check_scene()?;
        for (i, vertex) in self.vertices.iter().enumerate() {
            field(is_one(square(vertex.normal).into(), 2 * UNIT), "vertex normal", i)?;
            field(square(vertex.position) <= u32::from(header.radius) * u32::from(header.radius), "vertex position", i)?;
        }
        for (i, triangle) in self.triangles.iter().enumerate() {
            field(is_one(square(triangle.normal).into(), 2 * UNIT), "triangle normal", i)?;
            field(triangle.min_normal_length <= 1 << NORMAL_LENGTH, "triangle normal length", i)?;
            field(triangle.inverse_altitude > 0, "triangle altitude", i)?;
        }
        for (i, label) in self.labels.iter().enumerate() {
            field(label.is_valid(), "label", i)?;
        }
        for (i, Cut { triangles, objects }) in self.cuts.iter().enumerate() {
            let exist = objects.iter().all(|&object| object < header.instances.max(1));
            field(exist && triangles.iter().all(|&triangle| triangle < header.triangles), "cut", i)?;
        }
        Ok(())
    }

    /// The colours at the corners of the triangles of `mesh`, which is number `i`.
    fn check_colours(&self, mesh: &Mesh, i: usize) -> Result<(), StreamError> {
        let Some(MeshColours { palette, corners }) = self.colours_of(mesh) else {
            return field(mesh.flags & HAS_COLOURS == 0 && (mesh.palette == 0 || mesh.flags & HAS_TEXTURE != 0), "mesh colours", i);
        };
        for (k, &corner) in corners.iter().enumerate() {
            let [a, b, c] = corner.colours.map(|colour| palette.get(usize::from(colour)));
            let is_right = matches!((a, b, c), (Some(&a), Some(&b), Some(&c)) if CornerColours::new(corner.colours, [a, b, c]) == corner);
            field(is_right, "colour of a corner", mesh.first_triangle as usize + k)?;
        }
        Ok(())
    }

    /// The texture of `mesh`, which is number `i`. Returns the number of triangles that have one.
    fn check_texture(&self, mesh: &Mesh, i: usize) -> Result<u32, StreamError> {
        if mesh.flags & HAS_TEXTURE == 0 {
            return Ok(0);
        }
        field(mesh.flags & HAS_COLOURS == 0, "mesh colours", i)?;
        let MeshTexture { palette, texels, has_holes, .. } =
            self.texture_of(mesh).ok_or(StreamError::Field { name: "mesh texture", record: i as u32 })?;
        let exists = |&texel: &u8| palette.get(usize::from(texel)).is_some_and(|colour| colour.hole <= u8::from(has_holes));
        field(texels.iter().all(exists), "texel of a mesh", i)?;
        Ok(mesh.triangles)
    }

    /// Objects, and what moves.
    fn check_scene(&self) -> Result<(), StreamError> {
        // Coarser levels belong to their mesh.
        let starts = |index: usize| self.meshes.get(index).is_none_or(|mesh| mesh.error == 0);
        for (i, instance) in self.instances.iter().enumerate() {
            let (first, end) = (usize::from(instance.first_mesh), usize::from(instance.first_mesh) + usize::from(instance.meshes));
            field(instance.meshes > 0 && end <= self.meshes.len() && starts(first) && starts(end), "object meshes", i)?;
            let material = usize::from(instance.material);
            field(instance.material == OWN_MATERIALS || material < self.materials.len(), "object material", i)?;
        }
        let mut next = 0u32;
        for (i, track) in self.tracks.iter().enumerate() {
            let index = usize::from(track.index);
            let exists = match track.kind {
                OBJECT_TRACK => index < self.instances.len().max(1),
                LIGHT_TRACK => index < self.lights.len(),
                kind => kind == CAMERA_TRACK,
            };
            field(exists, "what a track moves", i)?;
            field(track.keys > 0 && track.first_key == next, "keys of a track", i)?;
            next = next.saturating_add(track.keys);
            let keys = self.keys_of(track).ok_or(StreamError::Field { name: "keys of a track", record: i as u32 })?;
            field(keys.windows(2).all(|pair| matches!(pair, [a, b] if a.frame < b.frame)), "order of keys in a track", i)?;
            let is_directional = track.kind == LIGHT_TRACK && self.lights.get(index).is_some_and(|light| light.kind != POINT);
            for (k, key) in keys.iter().enumerate() {
                let record = track.first_key as usize + k;
                let [w, x, y, z] = key.rotation.map(|c| i64::from(c >> 1));
                field(key.rotation.iter().all(|&c| within(c, 1 << ROTATION)), "key rotation", record)?;
                field(is_one(w * w + x * x + y * y + z * z, 2 * (ROTATION - 1)), "key rotation", record)?;
                let length = wide_square(key.position);
                let in_reach = track.kind != CAMERA_TRACK || length <= i64::from(MAX_LENGTH) * i64::from(MAX_LENGTH);
                field(key.position.iter().all(|&c| within(c, MAX_POSITION.to_bits())) && in_reach, "key position", record)?;
                field(!is_directional || is_one(length, 2 * UNIT), "key direction", record)?;
                field(key.scale == 0 || (MIN_SCALE..=MAX_SCALE).contains(&key.scale), "key scale", record)?;
            }
        }
        field(next == self.header.keys, "keys", self.tracks.len())
    }

    /// Returns the keyframes of `track`, which is the movement of one object, light or camera. Returns `None` if the stream does not have
    /// them; this happens only for a track of another stream.
    #[doc(hidden)]
    #[must_use]
    pub fn keys_of(&self, track: &Track) -> Option<&'a [Key]> {
        self.keys.get(track.first_key as usize..)?.get(..track.keys as usize)
    }

    /// Returns `true` if all lights are directional and the viewer is infinitely distant, so that the directions to light and viewer are
    /// equal at all points. Drawing is fastest then.
    #[doc(hidden)]
    #[must_use]
    pub fn is_constant(&self) -> bool {
        !self.header.camera.has_local_viewer() && self.lights.iter().all(|light| light.kind != POINT)
    }

    /// Returns `true` if the camera is a perspective one, and `false` if it is orthographic.
    #[must_use]
    pub fn is_perspective(&self) -> bool {
        self.header.camera.projection == PERSPECTIVE
    }

    /// Returns one level of detail for each mesh: the coarsest one whose surface is no farther than `error` from the full mesh, in units of
    /// object space. With an error of 0 these are the full meshes.
    #[doc(hidden)]
    pub fn meshes_within(&self, error: GeometricError) -> impl DoubleEndedIterator<Item = &'a Mesh> + use<'a> {
        self.levels_within(0..self.meshes.len() as u16, error)
    }

    /// The levels of the meshes with these indices, as in [`Self::meshes_within`].
    pub(crate) fn levels_within(&self, meshes: Range<u16>, error: GeometricError) -> impl DoubleEndedIterator<Item = &'a Mesh> + use<'a> {
        let all = self.meshes;
        meshes.filter_map(move |i| level(all, i.into(), error.to_bits()))
    }

    /// Returns the vertices of `mesh`. Returns `None` if the stream does not have them; this happens only for a mesh of another stream.
    #[doc(hidden)]
    #[must_use]
    pub fn vertices_of(&self, mesh: &Mesh) -> Option<&'a [Vertex]> {
        self.vertices.get(mesh.first_vertex as usize..)?.get(..mesh.vertices as usize)
    }

    /// Returns the triangles of `mesh`. Returns `None` if the stream does not have them; this happens only for a mesh of another stream.
    #[doc(hidden)]
    #[must_use]
    pub fn triangles_of(&self, mesh: &Mesh) -> Option<&'a [Triangle]> {
        self.triangles.get(mesh.first_triangle as usize..)?.get(..mesh.triangles as usize)
    }

    /// The colours at the corners of the triangles of `mesh`; `None` if it has none.
    #[doc(hidden)]
    #[must_use]
    pub fn colours_of(&self, mesh: &Mesh) -> Option<MeshColours<'a>> {
        let corners = self.corner_colours.get(mesh.first_triangle as usize..)?.get(..mesh.triangles as usize)?;
        let palette = self.colours.get(usize::from(mesh.palette) * PALETTE..)?;
        (mesh.flags & HAS_COLOURS != 0).then_some(MeshColours { palette, corners })
    }

    /// The textures; none in a program without the feature.
    #[doc(hidden)]
    #[must_use]
    pub fn textures(&self) -> TextureRecords<'a> {
        self.textures.first().copied().unwrap_or_default()
    }

    /// The texture of `mesh`, and where its triangles lie in it; `None` if it has none.
    #[doc(hidden)]
    #[must_use]
    pub fn texture_of(&self, mesh: &Mesh) -> Option<MeshTexture<'a>> {
        if mesh.flags & HAS_TEXTURE == 0 {
            return None;
        }
        let TextureRecords { list, corners, texels } = self.textures();
        let (before, texture) = (list.get(..usize::from(mesh.palette))?, list.get(usize::from(mesh.palette))?);
        let &Texture { size, palette, has_holes } = texture;
        let first_texel = before.iter().try_fold(0, |sum: usize, texture| sum.checked_add(texture.texels()?))?;
        let texels = texels.get(first_texel..)?.get(..texture.texels()?)?;
        let palette = self.colours.get(usize::from(palette) * PALETTE..)?;
        // Meshes follow one another in the order of their triangles.
        let before = |other: &&Mesh| other.first_triangle < mesh.first_triangle && other.flags & HAS_TEXTURE != 0;
        let first = self.meshes.iter().filter(before).fold(0u32, |sum, other| sum.saturating_add(other.triangles));
        let corners = corners.get(first as usize..)?.get(..mesh.triangles as usize)?;
        Some(MeshTexture { palette, texels, size, has_holes: has_holes != 0, corners })
    }

    /// Whether a texture has holes.
    pub(crate) fn has_holes(&self) -> bool {
        self.textures().list.iter().any(|texture| texture.has_holes != 0)
    }

    /// Returns the neighbours of the triangles of `mesh`: one for each triangle, or none if the stream does not have them.
    #[doc(hidden)]
    #[must_use]
    pub fn neighbours_of(&self, mesh: &Mesh) -> &'a [Neighbours] {
        let all = self.neighbours.get(mesh.first_triangle as usize..).unwrap_or_default();
        all.get(..mesh.triangles as usize).unwrap_or_default()
    }
}

impl Texture {
    /// The number of its texels; `None` if the record is wrong.
    fn texels(&self) -> Option<usize> {
        let [width, height] = self.size;
        (width.max(height) <= LARGEST_TEXTURE && self.has_holes <= 1).then(|| 1 << (width + height))
    }
}

impl Camera {
    /// What is out of its range, if anything is.
    pub(crate) fn fault(&self) -> Option<&'static str> {
        let unit = |v: &[i32; 3]| {
            let square = v.iter().map(|&c| i64::from(c >> 1) * i64::from(c >> 1)).sum::<i64>();
            v.iter().all(|&c| within(c, 1 << ROTATION)) && is_one(square, 2 * (ROTATION - 1))
        };
        let [x, y, z] = self.rotation;
        let square = |a: [i32; 3], b: [i32; 3]| dot(a, b).abs() <= 1 << (2 * ROTATION - 12);
        let turns = dot(cross(x, y).map(|c| (c >> ROTATION) as i32), z) < 0;
        let depth = self.near < self.far && self.far <= 2 * MAX_LENGTH;
        fault([
            (self.viewer <= VIEWER_LOCAL, "viewer"),
            (self.rotation.iter().all(unit), "camera rotation"),
            (square(x, y) && square(y, z) && square(z, x) && turns, "camera rotation"),
            (unit(&self.axis), "camera axis"),
            (self.translation.iter().all(|&c| within(c, MAX_LENGTH)), "camera translation"),
            (self.projection <= ORTHOGRAPHIC, "camera projection"),
            ((MIN_FOCAL..=MAX_FOCAL).contains(&self.focal), "camera focal"),
            ((MIN_NEAR..MAX_LENGTH).contains(&self.near), "camera near"),
            (self.projection == PERSPECTIVE || depth, "camera far"),
        ])
    }
}

impl Light {
    /// What is out of its range, if anything is.
    pub(crate) fn fault(&self) -> Option<&'static str> {
        let square = wide_square(self.vector);
        fault([
            (self.kind <= SKY && self.space <= EYE_SPACE, "light kind"),
            (is_gain(self.colour), "light colour"),
            (self.vector.iter().all(|&c| within(c, MAX_LENGTH)), "light vector"),
            (self.kind == POINT || is_one(square, 2 * UNIT), "light direction"),
            (self.range == 0 || self.kind == POINT && self.range >= MIN_RANGE, "light range"),
            (self.has_valid_cone(), "light cone"),
        ])
    }

    /// Whether there is no cone, or the light is at a point, its axis of unit length, and its cosines in order.
    fn has_valid_cone(&self) -> bool {
        let [edge, full] = self.cone;
        match self.axis {
            [0, 0, 0] => self.cone == [0; 2],
            axis => self.kind == POINT && is_one(square(axis).into(), 2 * UNIT) && -1 << UNIT <= edge && edge < full && full <= 1 << UNIT,
        }
    }
}

impl Label {
    /// Whether all is in its range: there are characters, and nothing but zeros behind them.
    fn is_valid(&self) -> bool {
        let mut rest = self.text.iter().skip_while(|&&character| is_printed(character));
        let [first, ..] = self.text;
        self.height > 0 && self.alignment <= RIGHT && first != 0 && rest.all(|&character| character == 0)
    }
}

/// Whether a character of ISO 8859-1 is no control character.
fn is_printed(character: u8) -> bool {
    (character & 0x7F) >= 0x20 && character != 0x7F
}

impl Material {
    /// What is out of its range, if anything is.
    pub(crate) fn fault(&self) -> Option<&'static str> {
        let colours = [self.ambient, self.diffuse, self.specular];
        fault([((1..=MAX_EXPONENT).contains(&self.exponent), "material exponent"), (colours.into_iter().all(is_gain), "material colour")])
    }
}

/// The name of the first condition that does not hold.
fn fault<const N: usize>(conditions: [(bool, &'static str); N]) -> Option<&'static str> {
    conditions.into_iter().find_map(|(holds, name)| (!holds).then_some(name))
}

/// Whether a colour is in range.
pub(crate) fn is_gain(colour: [u16; 3]) -> bool {
    colour.iter().all(|&c| c <= MAX_GAIN)
}

/// Record `i`, if it is the coarsest level of its mesh whose error is at most `error`.
// A call: drawing walks meshes in several places, and triangles take the time.
#[inline(never)]
fn level(meshes: &[Mesh], i: usize, error: u16) -> Option<&Mesh> {
    let coarser = |mesh: &Mesh| mesh.error > 0 && mesh.error <= error;
    let is_coarsest = |mesh: &&Mesh| mesh.error <= error && !meshes.get(i.wrapping_add(1)).is_some_and(coarser);
    meshes.get(i).filter(is_coarsest)
}

/// Largest exponent of a highlight.
#[doc(hidden)]
pub const MAX_EXPONENT: u16 = 1024;
/// Largest reflectance, or colour of a light, as the bits of a [`crate::format::Gain`]: 2.
#[doc(hidden)]
pub const MAX_GAIN: u16 = 2 << UNIT;
/// Largest component of a translation or of a light's position, as the bits of a [`crate::format::Length`]: 16 units.
#[doc(hidden)]
pub const MAX_LENGTH: i32 = 16 << UNIT;
/// Smallest range of a light, as the bits of a [`crate::format::Reach`]: 1/16 unit.
#[doc(hidden)]
pub const MIN_RANGE: u16 = 1 << 7;
/// Smallest scale of an object, as the bits of a [`crate::format::Scale`]: 1/16.
#[doc(hidden)]
pub const MIN_SCALE: u32 = 1 << 12;
/// Largest scale of an object, as the bits of a [`crate::format::Scale`]: 8.
#[doc(hidden)]
pub const MAX_SCALE: u32 = 8 << 16;
/// Smallest distance of the near plane, as the bits of a [`crate::format::Length`]: 1/64 unit.
#[doc(hidden)]
pub const MIN_NEAR: i32 = 1 << (UNIT - 6);
/// Smallest focal length, as the bits of a [`crate::format::Focal`]: 1/16.
#[doc(hidden)]
pub const MIN_FOCAL: u32 = 1 << 12;
/// Largest focal length, as the bits of a [`crate::format::Focal`]: 16.
#[doc(hidden)]
pub const MAX_FOCAL: u32 = 16 << 16;

fn within(c: i32, limit: i32) -> bool {
    (-limit..=limit).contains(&c)
}

/// The squared length of a vector, exactly: each square is at most 2^30.
fn square([x, y, z]: [i16; 3]) -> u32 {
    let square = |c: i16| u32::from(c.unsigned_abs()) * u32::from(c.unsigned_abs());
    square(x) + square(y) + square(z)
}

/// The squared length of a vector. It saturates: three squares of 2^62 are more than a sum can have.
fn wide_square(v: [i32; 3]) -> i64 {
    v.iter().fold(0, |sum: i64, &c| sum.saturating_add(i64::from(c) * i64::from(c)))
}

/// Whether `square`, with `bits` fraction bits, is 1 to 1/256.
fn is_one(square: i64, bits: u32) -> bool {
    (square - (1 << bits)).abs() <= 1 << (bits - 8)
}
