//! The records of a triangle stream, exactly as they lie in flash.
//!
//! Little-endian, no padding, read in place. Host and core share these types,
//! so there is one definition of the format.
//!
//! Fields are plain integers, as they are read in place. Each has a method of its name that gives its value as a number of the
//! crate [`fixed`], and `new` makes a record of such numbers; [`crate::Stream::parse`] checks what does not follow from the type.

#[doc(no_inline)]
pub use crate::format::{
    ErrorBudget, Focal, Gain, GeometricError, Haversine, InverseAltitude, Length, NormalLength, Radius, Rotation, Scale, Share, Unit,
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

#[cfg(target_endian = "big")]
compile_error!("streams are read in place and are little-endian");

/// First four bytes of every stream.
pub const MAGIC: [u8; 4] = *b"mTRI";
/// The version of the format that this core reads and the host writes.
pub const VERSION: u16 = 7;

/// The start of a stream. The arrays follow in the order of the counts, and the names of meshes behind them, if there are any: see
/// [`crate::Stream::names`].
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Header {
    /// [`MAGIC`].
    pub magic: [u8; 4],
    /// [`VERSION`].
    pub version: u16,
    /// Shading method to use unless the caller names one: its [`crate::method::Facts::id`].
    pub shader: u16,
    /// Bytes in the whole stream, this header included.
    pub length: u32,
    /// CRC-32 (ISO-HDLC: polynomial 04C11DB7, reflected) of all other bytes.
    pub crc: u32,
    /// Number of [`Mesh`] records, at least 1.
    pub meshes: u16,
    /// Number of [`Material`] records.
    pub materials: u16,
    /// Number of [`Light`] records, at most [`crate::format::MAX_LIGHTS`].
    pub lights: u16,
    /// Frames in the animation, at least 1.
    pub frames: u16,
    /// Number of [`Vertex`] records.
    pub vertices: u32,
    /// Number of [`Triangle`] records.
    pub triangles: u32,
    /// Number of [`Instance`] records. Without any, the scene is one object of all meshes.
    pub instances: u16,
    /// Number of [`Track`] records.
    pub tracks: u16,
    /// Number of [`Key`] records.
    pub keys: u32,
    /// Colour where no triangle is drawn, in the first row: red, green, blue.
    pub background: [u8; 3],
    /// How far a pixel may be off from Phong shading by a method that keeps to a budget, [`ErrorBudget`] from 1/2 to 16.
    pub budget: u8,
    /// Ambient light, red, green, blue, [`Gain`] at most 2; it is multiplied by the ambient colour of a material.
    pub ambient: [u16; 3],
    /// No vertex lies farther from the origin of object space, [`Radius`], rounded up.
    pub radius: u16,
    /// Colour where no triangle is drawn, in the last row. If it is that of the first row all rows have it, else the rows between have even
    /// steps.
    pub background_bottom: [u8; 3],
    /// Number of [`Label`] records.
    pub labels: u8,
    /// The camera.
    pub camera: Camera,
}

impl Header {
    /// Ambient light.
    #[must_use]
    pub fn ambient(&self) -> [Gain; 3] {
        self.ambient.map(Gain::from_bits)
    }

    /// How far a pixel may be off from Phong shading by a method that keeps to a budget, in 1/255 of full intensity.
    #[must_use]
    pub fn budget(&self) -> ErrorBudget {
        ErrorBudget::from_bits(self.budget)
    }

    /// Radius of the ball about the origin that contains all vertices.
    #[must_use]
    pub fn radius(&self) -> Radius {
        Radius::from_bits(self.radius)
    }
}

/// Highlights use one direction to the eye for the whole scene: cheaper, and constant H for directional lights.
pub const VIEWER_INFINITE: u8 = 0;
/// Highlights use the direction from each point to the eye.
pub const VIEWER_LOCAL: u8 = 1;

/// A camera that looks along +z of its own space (x right, y up, z away from the eye) and may orbit.
///
/// `eye_space = rotation · orbit(frame) · object_space + translation`, where
/// `orbit` turns by `frame / period` of a revolution about `axis`.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Camera {
    /// Rows of the rotation from object to eye space in frame 0, [`Rotation`] in [-1, 1]: orthonormal, squared lengths to 1/256 and
    /// products to 1/4096; determinant -1, for object space is right-handed, eye space left-handed.
    pub rotation: [[i32; 3]; 3],
    /// Where the origin of object space lies in eye space, [`Length`] in [-16, 16].
    pub translation: [i32; 3],
    /// Axis of the orbit in object space, [`Rotation`] in [-1, 1], squared length 1 to 1/256.
    pub axis: [i32; 3],
    /// Frames per revolution; 0 stands still. The angle is right to 0.1 degrees.
    pub period: u16,
    /// [`PERSPECTIVE`] or [`ORTHOGRAPHIC`].
    pub projection: u8,
    /// [`VIEWER_INFINITE`] or [`VIEWER_LOCAL`].
    pub viewer: u8,
    /// [`Focal`] in [1/16, 16]. Perspective: half of the viewport's smaller side is seen under the slope `1 / focal`.
    /// Orthographic: half of the viewport's smaller side shows `1 / focal` units.
    pub focal: u32,
    /// Nearest depth drawn, along z of eye space, [`Length`] in [1/64, 16).
    pub near: i32,
    /// Orthographic only: farthest depth drawn, [`Length`], above `near` and at most 32.
    pub far: i32,
}

impl Camera {
    /// A camera that stands still and draws what lies between two depths; `projection` is [`PERSPECTIVE`] or [`ORTHOGRAPHIC`].
    #[must_use]
    pub fn new(projection: u8, rotation: [[Rotation; 3]; 3], translation: [Length; 3], focal: Focal, [near, far]: [Length; 2]) -> Self {
        Self {
            rotation: rotation.map(|row| row.map(Rotation::to_bits)),
            translation: translation.map(Length::to_bits),
            axis: [Rotation::ZERO, Rotation::ONE, Rotation::ZERO].map(Rotation::to_bits),
            period: 0,
            projection,
            viewer: VIEWER_INFINITE,
            focal: focal.to_bits(),
            near: near.to_bits(),
            far: far.to_bits(),
        }
    }

    /// This camera, near enough that highlights use the direction from each point to the eye.
    #[must_use]
    pub fn with_local_viewer(self) -> Self {
        Self { viewer: VIEWER_LOCAL, ..self }
    }

    /// This camera, which orbits once around `axis` in `period` frames.
    #[must_use]
    pub fn orbiting(self, axis: [Rotation; 3], period: u16) -> Self {
        Self { axis: axis.map(Rotation::to_bits), period, ..self }
    }

    /// Rows of the rotation from object to eye space in frame 0.
    #[must_use]
    pub fn rotation(&self) -> [[Rotation; 3]; 3] {
        self.rotation.map(|row| row.map(Rotation::from_bits))
    }

    /// Where the origin of object space lies in eye space.
    #[must_use]
    pub fn translation(&self) -> [Length; 3] {
        self.translation.map(Length::from_bits)
    }

    /// Unit axis of the orbit in object space.
    #[must_use]
    pub fn axis(&self) -> [Rotation; 3] {
        self.axis.map(Rotation::from_bits)
    }

    /// Perspective: the distance of the eye from the viewport over half of its smaller side. Orthographic: one unit over that half side.
    #[must_use]
    pub fn focal(&self) -> Focal {
        Focal::from_bits(self.focal)
    }

    /// Nearest depth drawn.
    #[must_use]
    pub fn near(&self) -> Length {
        Length::from_bits(self.near)
    }

    /// Farthest depth drawn by an orthographic camera.
    #[must_use]
    pub fn far(&self) -> Length {
        Length::from_bits(self.far)
    }
}

/// A perspective camera: rays meet in the eye.
pub const PERSPECTIVE: u8 = 0;
/// An orthographic camera: rays are parallel.
pub const ORTHOGRAPHIC: u8 = 1;

/// A run of vertices and triangles with one material, or a coarser level of detail of the mesh before.
///
/// Meshes follow one another without a gap. Each may be followed by coarser levels of itself, from fine to coarse: fewer triangles on some
/// of the same vertices, for pictures that are too small to show the difference. A frame has one level of each mesh, see
/// [`crate::Stream::meshes_within`].
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Mesh {
    /// Index of its first [`Vertex`]; a coarser level has that of its mesh.
    pub first_vertex: u32,
    /// Index of its first [`Triangle`].
    pub first_triangle: u32,
    /// Number of triangles.
    pub triangles: u32,
    /// Number of vertices; a coarser level has that of its mesh.
    pub vertices: u16,
    /// Index of its [`Material`]; a coarser level has that of its mesh.
    pub material: u16,
    /// 0 for a mesh as it is. For a coarser level, [`GeometricError`], rounded up and more than that of the level before: no point of its
    /// triangles lies farther from the triangles of the mesh as it is, and no point of those farther from its own.
    pub error: u16,
    /// Bit 0: [`CLOSED_CONVEX`], of the triangles of this level.
    pub flags: u16,
}

impl Mesh {
    /// How far this level lies from the mesh as it is; 0 for the mesh as it is.
    #[must_use]
    pub fn error(&self) -> GeometricError {
        GeometricError::from_bits(self.error)
    }
}

/// The mesh is closed and convex, so its front faces never hide one another; see `geometry/depth_elision.rs`. It promises:
///
/// - The mesh is one closed surface, all of its triangles counter-clockwise seen from outside.
/// - Each vertex is a corner of a convex body, in the ball of radius one about the origin, with coordinates rounded to the
///   nearest; 0.36 units of the last place are left for the body's own arithmetic.
/// - By that rounding no triangle has leaned by more than 2^-[`LEAN`] rad.
pub const CLOSED_CONVEX: u16 = 1;

/// How far a triangle of a [`CLOSED_CONVEX`] mesh may have leaned: 2^-6 rad, 0.9 degrees.
pub const LEAN: u32 = 6;

/// Colours in [`Gain`], at most 2, red, green, blue.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Material {
    /// Share of the ambient light that is reflected.
    pub ambient: [u16; 3],
    /// Share of each light that is reflected evenly.
    pub diffuse: [u16; 3],
    /// Share of each light that is reflected in the highlight.
    pub specular: [u16; 3],
    /// Exponent of N·H in the highlight (Blinn 1977), or of R·V in place of it (Phong 1975): 1 to 1024.
    pub exponent: u16,
}

impl Material {
    /// A material; see the fields.
    #[must_use]
    pub fn new(ambient: [Gain; 3], diffuse: [Gain; 3], specular: [Gain; 3], exponent: u16) -> Self {
        let [ambient, diffuse, specular] = [ambient, diffuse, specular].map(|colour| colour.map(Gain::to_bits));
        Self { ambient, diffuse, specular, exponent }
    }

    /// Share of the ambient light that is reflected.
    #[must_use]
    pub fn ambient(&self) -> [Gain; 3] {
        self.ambient.map(Gain::from_bits)
    }

    /// Share of each light that is reflected evenly.
    #[must_use]
    pub fn diffuse(&self) -> [Gain; 3] {
        self.diffuse.map(Gain::from_bits)
    }

    /// Share of each light that is reflected in the highlight.
    #[must_use]
    pub fn specular(&self) -> [Gain; 3] {
        self.specular.map(Gain::from_bits)
    }
}

/// A light without fall-off.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Light {
    /// [`Length`] in [-16, 16]. Directional: vector towards the light, squared length 1 to 1/256; the renderer normalises it. Point: the
    /// light's position.
    pub vector: [i32; 3],
    /// Red, green, blue, [`Gain`] at most 2.
    pub colour: [u16; 3],
    /// [`DIRECTIONAL`] or [`POINT`].
    pub kind: u8,
    /// [`OBJECT_SPACE`] or [`EYE_SPACE`].
    pub space: u8,
}

impl Light {
    /// A light; `kind` is [`DIRECTIONAL`] or [`POINT`], `space` [`OBJECT_SPACE`] or [`EYE_SPACE`].
    #[must_use]
    pub fn new(kind: u8, space: u8, vector: [Length; 3], colour: [Gain; 3]) -> Self {
        Self { vector: vector.map(Length::to_bits), colour: colour.map(Gain::to_bits), kind, space }
    }

    /// Directional: unit vector towards the light. Point: its position.
    #[must_use]
    pub fn vector(&self) -> [Length; 3] {
        self.vector.map(Length::from_bits)
    }

    /// Red, green, blue.
    #[must_use]
    pub fn colour(&self) -> [Gain; 3] {
        self.colour.map(Gain::from_bits)
    }
}

/// A directional light, infinitely far.
pub const DIRECTIONAL: u8 = 0;
/// A point light, at a position.
pub const POINT: u8 = 1;
/// The light stays with the object.
pub const OBJECT_SPACE: u8 = 0;
/// The light stays with the camera.
pub const EYE_SPACE: u8 = 1;

/// An object of the scene: some meshes of the stream, with their coarser levels. Several objects may have the same meshes.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Instance {
    /// Index of its first [`Mesh`].
    pub first_mesh: u16,
    /// Number of meshes.
    pub meshes: u16,
    /// Index of the [`Material`] of all its meshes, or [`OWN_MATERIALS`].
    pub material: u16,
    /// Unused, for alignment.
    pub reserved: u16,
}

/// The meshes of an object have each its own material.
pub const OWN_MATERIALS: u16 = u16::MAX;

/// How an object, a light or the camera moves from frame to frame: by its keys, and linearly between them.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Track {
    /// [`OBJECT_TRACK`], [`LIGHT_TRACK`] or [`CAMERA_TRACK`].
    pub kind: u16,
    /// Index of the [`Instance`] or [`Light`].
    pub index: u16,
    /// Index of its first [`Key`]; tracks follow one another without a gap.
    pub first_key: u32,
    /// Number of keys, at least 1.
    pub keys: u32,
}

/// A track of an object: its pose.
pub const OBJECT_TRACK: u16 = 0;
/// A track of a light: the position of its keys is [`Light::vector`].
pub const LIGHT_TRACK: u16 = 1;
/// A track of the camera: it looks along the z axis of its keys, and sees their y axis upwards.
pub const CAMERA_TRACK: u16 = 2;

/// Where something is in a frame. Before the first key of its track it is there, behind the last one as well.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Key {
    /// Number of the frame; keys of a track are in this order.
    pub frame: u32,
    /// Quaternion w, x, y, z, [`Rotation`]; squared length 1 to 1/256.
    pub rotation: [i32; 4],
    /// [`Length`], at most [`MAX_POSITION`] in size along each axis; for a camera, no longer than that.
    pub position: [i32; 3],
    /// [`Scale`] from 1/16 to 8; 0 hides the object up to its next key.
    pub scale: u32,
}

/// Largest component of a position in the world: 16 units.
pub const MAX_POSITION: Length = Length::from_bits(16 << 14);

/// Position and unit normal.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Vertex {
    /// In object space, [`Unit`] in [-2, 2), rounded to the nearest: right to 3.1e-5, half a step, along each axis.
    pub position: [i16; 3],
    /// Unit normal in object space, [`Unit`] in [-1, 1] and hardly beyond, rounded to the lattice point nearby whose length is nearest to
    /// 1. The length is 1 to 3.1e-5, half a step, as written; readers accept squared lengths of 1 to 1/256.
    pub normal: [i16; 3],
}

impl Vertex {
    /// A vertex of zeros.
    pub const ZERO: Self = Self { position: [0; 3], normal: [0; 3] };

    /// A vertex at `position` with a unit normal.
    #[must_use]
    pub fn new(position: [Unit; 3], normal: [Unit; 3]) -> Self {
        Self { position: position.map(Unit::to_bits), normal: normal.map(Unit::to_bits) }
    }

    /// Position in object space.
    #[must_use]
    pub fn position(&self) -> [Unit; 3] {
        self.position.map(Unit::from_bits)
    }

    /// Unit normal in object space.
    #[must_use]
    pub fn normal(&self) -> [Unit; 3] {
        self.normal.map(Unit::from_bits)
    }
}

/// Three vertices, and the constants that depend on neither camera nor light.
///
/// Seen from its front side the vertices run counter-clockwise in object space
/// (right-handed). Edge `k` joins corner `k` and corner `k + 1`.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Triangle {
    /// Indices relative to the mesh's first vertex.
    pub corners: [u16; 3],
    /// Per edge the reciprocal length of the sum of the normals at its ends, minus its least value: 1/|Ni+Nj| - 1/2, unsigned Q0.17 in [0,
    /// 1/2), rounded to the nearest. It normalises the sum at the midpoint. 65535 where the normals are 120 degrees apart or more, for
    /// which the renderer computes it.
    pub inverse_sum_length: [u16; 3],
    /// Per edge the haversine of the angle between the normals at its ends, (1 - Ni·Nj)/2 = 1 - |Ni+Nj|²/4, [`Haversine`] in [0, 1],
    /// rounded to the nearest, 65535 at most. The squared length of the interpolated normal at the midpoint is 1 minus this.
    pub haversine: [u16; 3],
    /// The least length of the interpolated normal on the triangle, [`NormalLength`] in [0, 1], rounded down: the root of 1 less the squared
    /// radius of the smallest circle around the ends of the corners' unit normals.
    pub min_normal_length: u16,
    /// Unit normal of the plane in object space, [`Unit`], rounded as that of a vertex.
    pub normal: [i16; 3],
    /// Distance of the plane from the origin, [`Unit`] in [-2, 2), rounded down such that every point a camera can be at with
    /// `normal · p` below it sees the back.
    pub offset: i16,
    /// 1 over the least altitude of the stored corners, longest side over twice the area, [`InverseAltitude`] in 1/units, rounded up, so
    /// at least one step; 65535 where that is too little. It tells how far the triangle must face away before no rounding of
    /// corners can turn it to the front, see [`crate::geometry::cull`].
    pub inverse_altitude: u16,
}

impl Triangle {
    /// Per edge the haversine of the angle between the normals at its ends.
    #[must_use]
    pub fn haversine(&self) -> [Haversine; 3] {
        self.haversine.map(Haversine::from_bits)
    }

    /// Lower bound of the interpolated normal's length.
    #[must_use]
    pub fn min_normal_length(&self) -> NormalLength {
        NormalLength::from_bits(self.min_normal_length)
    }

    /// Unit normal of the plane.
    #[must_use]
    pub fn normal(&self) -> [Unit; 3] {
        self.normal.map(Unit::from_bits)
    }

    /// Distance of the plane from the origin.
    #[must_use]
    pub fn offset(&self) -> Unit {
        Unit::from_bits(self.offset)
    }

    /// 1 over the least altitude.
    #[must_use]
    pub fn inverse_altitude(&self) -> InverseAltitude {
        InverseAltitude::from_bits(self.inverse_altitude)
    }
}

/// A text over the picture. It lies where the scene behind it lies in pictures of any size.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Label {
    /// How far right of the centre of the picture it is, and how far below, [`Share`].
    pub position: [i16; 2],
    /// Height of a line, [`Share`], more than 0: the largest of the program's fonts is taken that is not higher. Without one the label
    /// is not drawn.
    pub height: i16,
    /// Red, green, blue.
    pub colour: [u8; 3],
    /// What lies at its position: [`LEFT`], [`MIDDLE`] or [`RIGHT`] of the text.
    pub alignment: u8,
    /// Characters of ISO 8859-1, at least one, then zeros. None of them is a control character.
    pub text: [u8; LABEL_TEXT],
}

/// Height of a line of the smallest font, pixels.
pub const LEAST_LINE: u32 = 6;

/// Characters that a [`Label`] has room for.
pub const LABEL_TEXT: usize = 30;

/// The position of a label is its left end, half of its height.
pub const LEFT: u8 = 0;
/// The position of a label is its middle.
pub const MIDDLE: u8 = 1;
/// The position of a label is its right end, half of its height.
pub const RIGHT: u8 = 2;

impl Label {
    /// A label; see the fields. Of `text` what there is room for is kept.
    #[must_use]
    pub fn new(position: [Share; 2], height: Share, colour: [u8; 3], alignment: u8, text: &[u8]) -> Self {
        let mut room = [0; LABEL_TEXT];
        room.iter_mut().zip(text).for_each(|(room, character)| *room = *character);
        Self { position: position.map(Share::to_bits), height: height.to_bits(), colour, alignment, text: room }
    }

    /// How far right of the centre of the picture it is, and how far below.
    #[must_use]
    pub fn position(&self) -> [Share; 2] {
        self.position.map(Share::from_bits)
    }

    /// Height of a line.
    #[must_use]
    pub fn height(&self) -> Share {
        Share::from_bits(self.height)
    }

    /// Its characters.
    pub fn characters(&self) -> impl Iterator<Item = char> + '_ {
        self.text.iter().take_while(|&&character| character != 0).map(|&character| character.into())
    }
}
