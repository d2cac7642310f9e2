//! The records of a triangle stream, exactly as they lie in flash.
//!
//! Little-endian, no padding, read in place. Host and core share these types,
//! so there is one definition of the format.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

#[cfg(target_endian = "big")]
compile_error!("streams are read in place and are little-endian");

/// First four bytes of every stream.
pub const MAGIC: [u8; 4] = *b"mTRI";
/// The version of the format that this core reads and the host writes.
pub const VERSION: u16 = 3;

/// How a stream starts. The arrays follow in the order of the counts.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Header {
    /// [`MAGIC`].
    pub magic: [u8; 4],
    /// [`VERSION`].
    pub version: u16,
    /// Shading method to use unless the caller names one: index into [`crate::Shader::ALL`].
    pub shader: u16,
    /// Bytes in the whole stream, this header included.
    pub length: u32,
    /// CRC-32 (ISO-HDLC) of all other bytes.
    pub crc: u32,
    /// Number of [`Mesh`] records.
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
    /// Colour where no triangle is drawn: red, green, blue.
    pub background: [u8; 3],
    /// [`VIEWER_INFINITE`] or [`VIEWER_LOCAL`].
    pub viewer: u8,
    /// Light that is there without lights, per channel, [`crate::format::Gain`]; times the material's ambient colour.
    pub ambient: [u16; 3],
    /// All vertices lie in the ball of this radius about the origin, unsigned Q2.14.
    pub radius: u16,
    /// Where the scene is seen from.
    pub camera: Camera,
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
    /// Rows of the rotation from object to eye space in frame 0, Q2.30, orthonormal, determinant -1:
    /// object space is right-handed, eye space left-handed.
    pub rotation: [[i32; 3]; 3],
    /// Translation, [`crate::format::Length`].
    pub translation: [i32; 3],
    /// Unit axis of the orbit in object space, Q2.30.
    pub axis: [i32; 3],
    /// Frames per revolution; 0 stands still.
    pub period: u16,
    /// [`PERSPECTIVE`] or [`ORTHOGRAPHIC`].
    pub projection: u8,
    /// Must be 0.
    pub reserved: u8,
    /// Perspective: half of the viewport's smaller side is seen under the slope `1 / focal`, Q16.16.
    /// Orthographic: half of the viewport's smaller side shows `1 / focal` units.
    pub focal: u32,
    /// Nearest distance drawn, [`crate::format::Length`], at least 1/64.
    pub near: i32,
    /// Orthographic only: farthest distance drawn, [`crate::format::Length`].
    pub far: i32,
}

/// Rays meet in the eye.
pub const PERSPECTIVE: u8 = 0;
/// Rays are parallel.
pub const ORTHOGRAPHIC: u8 = 1;

/// A run of vertices and triangles with one material. The meshes follow one another without a gap.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Mesh {
    /// Index of its first [`Vertex`].
    pub first_vertex: u32,
    /// Number of vertices.
    pub vertices: u32,
    /// Index of its first [`Triangle`].
    pub first_triangle: u32,
    /// Number of triangles.
    pub triangles: u32,
    /// Index of its [`Material`].
    pub material: u16,
    /// Bit 0: [`CLOSED_CONVEX`].
    pub flags: u16,
}

/// The mesh is closed and convex, so its front faces never hide one another; see [`crate::convex`]. It promises:
///
/// - The mesh is one closed surface, all of its triangles counter-clockwise seen from outside.
/// - Each vertex is a corner of a convex body, in the ball of radius one about the origin, with coordinates rounded to the
///   nearest; 0.36 units of the last place are left for the body's own arithmetic.
/// - By that rounding no triangle has leaned by more than 2^-[`LEAN`] rad.
pub const CLOSED_CONVEX: u16 = 1;

/// See [`CLOSED_CONVEX`].
pub const LEAN: u32 = 6;

/// Colours in [`crate::format::Gain`], red, green, blue.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Material {
    /// Share of the ambient light that is reflected.
    pub ambient: [u16; 3],
    /// Share of each light that is reflected evenly.
    pub diffuse: [u16; 3],
    /// Share of each light that is reflected in the highlight.
    pub specular: [u16; 3],
    /// Exponent of N·H, 1 to 1024.
    pub exponent: u16,
}

/// A light without fall-off.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Light {
    /// Directional: unit vector towards the light, Q18.14. Point: its position, [`crate::format::Length`].
    pub vector: [i32; 3],
    /// Colour, [`crate::format::Gain`].
    pub colour: [u16; 3],
    /// [`DIRECTIONAL`] or [`POINT`].
    pub kind: u8,
    /// [`OBJECT_SPACE`] or [`EYE_SPACE`].
    pub space: u8,
}

/// Infinitely far.
pub const DIRECTIONAL: u8 = 0;
/// At a position.
pub const POINT: u8 = 1;
/// The light stays with the object.
pub const OBJECT_SPACE: u8 = 0;
/// The light stays with the camera.
pub const EYE_SPACE: u8 = 1;

/// Position and unit normal, both [`crate::format::Unit`].
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Vertex {
    /// Object space.
    pub position: [i16; 3],
    /// Unit length to 3.1e-5, half a step: of the lattice points around it the one of the best length.
    pub normal: [i16; 3],
}

impl Vertex {
    /// No vertex.
    pub const ZERO: Self = Self { position: [0; 3], normal: [0; 3] };
}

/// Three vertices and all that does not depend on camera or light.
///
/// Seen from its front side the vertices run counter-clockwise in object space
/// (right-handed). Edge `k` joins corner `k` and corner `k + 1`.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Triangle {
    /// Indices relative to the mesh's first vertex.
    pub corners: [u16; 3],
    /// Per edge 1/|Ni+Nj| - 1/2, unsigned Q0.17: normalises the normal at the midpoint.
    /// 65535 where the normals are 120 degrees apart or more: then the renderer works it out.
    pub rsum: [u16; 3],
    /// Per edge 1 - |Ni+Nj|²/4 = (1 - Ni·Nj)/2, unsigned Q0.16, 65535 at most:
    /// what the squared length of the interpolated normal lacks to 1 at the midpoint.
    pub bend: [u16; 3],
    /// Lower bound of the interpolated normal's length on the triangle, sqrt((1 + 2 min Ni·Nj)/3), unsigned Q1.15, rounded down.
    pub rho: u16,
    /// Unit normal of the plane, [`crate::format::Unit`].
    pub normal: [i16; 3],
    /// Distance of the plane from the origin, [`crate::format::Unit`], rounded down such that every point with
    /// `normal · p` below it sees the back.
    pub offset: i16,
    /// 1 over the least altitude, twice the area over the longest side, of the triangle of the stored corners, unsigned Q14.2, in 1/units:
    /// at least 1, rounded up, 65535 where that is too little. It tells how far the triangle must face away before no rounding of
    /// corners on the screen can turn it to the front, see [`crate::cull`].
    pub inverse_altitude: u16,
}
