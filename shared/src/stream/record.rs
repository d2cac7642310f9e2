//! The records of a triangle stream, in the layout that they have in flash.
//!
//! Records are little-endian, have no padding, and are read in place. Host and core share these types, so the format is defined once.
//!
//! Fields are plain integers. A method of the same name returns a field as a number of the crate [`fixed`], and `new` makes a record from such
//! numbers. [`crate::Stream::parse`] checks the ranges.

#[doc(no_inline)]
use crate::features::LIGHT_SHAPES;
pub use crate::format::{
    ErrorBudget, Focal, Gain, GeometricError, Haversine, InverseAltitude, Length, NormalLength, Radius, Reach, Rotation, Scale, Share,
    TextureCoordinate, Unit,
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

#[cfg(target_endian = "big")]
compile_error!("streams are read in place and are little-endian");

/// First four bytes of every stream.
pub const MAGIC: [u8; 4] = *b"mTRI";
/// Version of the format.
pub const VERSION: u16 = 12;

/// The first record of a stream (mesh file): the camera, the background, and the number of records of each kind. Most programs only read
/// [`Self::frames`].
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Header {
    /// The first four bytes of every stream (mesh file): `mTRI`.
    #[doc(hidden)]
    pub magic: [u8; 4],
    /// The version of the file format. A program reads only files of its own version.
    #[doc(hidden)]
    pub version: u16,
    /// The number of the shading method that the stream (mesh file) asks for, as in [`Facts::id`](crate::method::Facts::id).
    /// [`Renderer::with_shader`](crate::Renderer::with_shader) ignores it.
    pub shader: u16,
    /// The length of the whole stream (mesh file) in bytes.
    #[doc(hidden)]
    pub length: u32,
    /// The checksum of all bytes of the stream (mesh file) except this field: CRC-32 as in zip files (polynomial 04C11DB7, reflected).
    #[doc(hidden)]
    pub crc: u32,
    /// The number of [`Mesh`] records, at least 1. Levels of detail are counted as well.
    pub meshes: u16,
    /// The number of [`Material`] records.
    pub materials: u16,
    /// The number of [`Light`] records, at most 8.
    pub lights: u16,
    /// The number of frames in the animation, at least 1. Frame numbers are 0 to `frames - 1`.
    pub frames: u16,
    /// The number of vertices of all meshes.
    pub vertices: u32,
    /// The number of triangles of all meshes and of their coarser levels of detail.
    pub triangles: u32,
    /// The number of objects in the scene. If it is 0, the scene has one object, which consists of all meshes.
    #[doc(hidden)]
    pub instances: u16,
    /// The number of movements in the animation, each of one object, light or camera.
    #[doc(hidden)]
    pub tracks: u16,
    /// The number of keyframes of all movements.
    #[doc(hidden)]
    pub keys: u32,
    /// The background colour of the first row: red, green, blue, each 0 to 255.
    #[doc(hidden)]
    pub background: [u8; 3],
    /// The error budget of [`Shader::AUTO`](crate::Shader::AUTO) as an integer, in units of 1/8 of 1/255 of full intensity: 4 to 128. If it is 0, the
    /// display decides. [`Self::budget`] returns it as a number.
    #[doc(hidden)]
    pub budget: u8,
    /// The ambient light as integers: red, green, blue, each 0 to 32,768, where 16,384 is full intensity. [`Self::ambient`] returns it as
    /// numbers.
    #[doc(hidden)]
    pub ambient: [u16; 3],
    /// The radius of the sphere about the origin of object space that contains all vertices, as an integer: units of 1/16,384, rounded up.
    /// [`Self::radius`] returns it as a number.
    #[doc(hidden)]
    pub radius: u16,
    /// The background colour of the last row: red, green, blue, each 0 to 255. The colour changes evenly from the first row to the last.
    #[doc(hidden)]
    pub background_bottom: [u8; 3],
    /// The number of texts that are drawn over the picture.
    #[doc(hidden)]
    pub labels: u8,
    /// The number of [`Cut`] records.
    #[doc(hidden)]
    pub cuts: u32,
    /// The colour of the lines along outlines: red, green, blue, each 0 to 255; zero if there are no lines.
    #[doc(hidden)]
    pub outline_colour: [u8; 3],
    /// The lines along outlines: 0 for none, 1 for lines over the surfaces, 2 for lines alone on the background.
    #[doc(hidden)]
    pub outlines: u8,
    /// The number of [`CornerColours`] records: one for each of the first triangles of the stream, up to the last one of a mesh that has colours at
    /// its corners.
    #[doc(hidden)]
    pub corner_colours: u32,
    /// The number of [`Colour`] records.
    #[doc(hidden)]
    pub colours: u16,
    /// The number of [`Texture`] records.
    #[doc(hidden)]
    pub textures: u16,
    /// The number of [`TextureCorners`] records: one for each triangle of the meshes that have a texture.
    #[doc(hidden)]
    pub texture_corners: u32,
    /// The number of texels of all textures, a multiple of 4.
    #[doc(hidden)]
    pub texels: u32,
    /// The camera at the beginning of the animation.
    pub camera: Camera,
}

impl Header {
    /// Returns the ambient light: red, green, blue, each 0 to 2, where 1 is full intensity. It is multiplied by a material's ambient
    /// colour.
    #[must_use]
    pub fn ambient(&self) -> [Gain; 3] {
        self.ambient.map(Gain::from_bits)
    }

    /// Returns the error budget of [`Shader::AUTO`](crate::Shader::AUTO): the largest difference of a pixel from Phong shading, in units of
    /// 1/255 of full intensity, from 1/2 to 16. If the stream states none, the budget is [`Pixel::BUDGET`](crate::pixel::Pixel::BUDGET) of the pixel
    /// format.
    #[must_use]
    pub fn budget(&self) -> Option<ErrorBudget> {
        (self.budget > 0).then(|| ErrorBudget::from_bits(self.budget))
    }
}

/// The scene has no lines along outlines.
pub const NO_OUTLINES: u8 = 0;
/// The scene has lines along outlines, over the shaded surfaces.
pub const OUTLINES_OVER_SURFACES: u8 = 1;
/// The scene has lines along outlines, on the background without the surfaces.
pub const OUTLINES_ALONE: u8 = 2;

/// The viewer is infinitely far: highlights use one direction to the eye for the whole scene. This is cheaper.
pub const VIEWER_INFINITE: u8 = 0;
/// The viewer is near: highlights use the direction from each point to the eye.
pub const VIEWER_LOCAL: u8 = 1;

/// The camera of a scene: where it stands, where it looks, its focal length, and whether it orbits.
///
/// [`Scene::look_at`](crate::Scene::look_at) moves it. To change the focal length, take [`Scene::camera`](crate::Scene::camera), call
/// [`Camera::with_focal`], and pass the result to [`Scene::set_camera`](crate::Scene::set_camera).
// In eye space x points to the right, y up, and z away from the viewer. A point is transformed by
// `eye_space = rotation · orbit(frame) · object_space + translation`, where `orbit` turns by `frame / period` of a revolution about `axis`.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Camera {
    /// The rows of the rotation matrix from object space to eye space in frame 0, in units of 2^-30, so that 1 is `1 << 30`. The matrix is
    /// orthonormal to within 1/256. Its determinant is -1, because object space is right-handed and eye space left-handed.
    #[doc(hidden)]
    pub rotation: [[i32; 3]; 3],
    /// The position of the origin of object space in eye space, in units of 1/16,384, each coordinate -16 to 16.
    #[doc(hidden)]
    pub translation: [i32; 3],
    /// The axis of the orbit in object space: a unit vector in units of 2^-30.
    #[doc(hidden)]
    pub axis: [i32; 3],
    /// The number of frames in which the camera orbits once, or 0 if it stands still.
    #[doc(hidden)]
    pub period: u16,
    /// The kind of projection: 0 for perspective, 1 for orthographic (parallel rays).
    #[doc(hidden)]
    pub projection: u8,
    /// The kind of viewer for highlights: 0 for an infinitely distant viewer, which is faster, and 1 for a local viewer, with the exact
    /// direction from each point to the eye.
    #[doc(hidden)]
    pub viewer: u8,
    /// The focal length in units of 1/65,536, from 1/16 to 16. In perspective, the tangent of half the field of view of the picture's
    /// smaller side is 1 / focal. An orthographic picture shows 1 / focal units of object space in half of its smaller side.
    #[doc(hidden)]
    pub focal: u32,
    /// The distance of the near plane along z of eye space, in units of 1/16,384, from 1/64 to less than 16. Nothing nearer is drawn.
    #[doc(hidden)]
    pub near: i32,
    /// The distance of the far plane of an orthographic camera along z of eye space, in units of 1/16,384: more than `near`, at most 32. A
    /// perspective camera has no far plane and ignores it.
    #[doc(hidden)]
    pub far: i32,
}

impl Camera {
    /// Makes the viewer local: highlights use the exact direction from each point to the eye. This takes more time than an infinitely
    /// distant viewer.
    #[must_use]
    pub fn with_local_viewer(self) -> Self {
        Self { viewer: VIEWER_LOCAL, ..self }
    }

    /// Whether the viewer is local. Under an orthographic camera it is infinitely far.
    #[must_use]
    pub fn has_local_viewer(&self) -> bool {
        self.viewer == VIEWER_LOCAL && self.projection == PERSPECTIVE
    }

    /// Makes the camera orbit about `axis`, a unit vector in object space, once in `period` frames. A period of 0 makes it stand still.
    #[must_use]
    pub fn orbiting(self, axis: [Rotation; 3], period: u16) -> Self {
        Self { axis: axis.map(Rotation::to_bits), period, ..self }
    }

    /// Returns a copy of this camera with another focal length, from 1/16 to 16. A longer one shows a smaller part of the scene, larger.
    #[must_use]
    pub fn with_focal(self, focal: Focal) -> Self {
        Self { focal: focal.to_bits(), ..self }
    }

    /// Returns the focal length. In perspective, the tangent of half the field of view of the picture's smaller side is 1 / focal. An
    /// orthographic picture shows 1 / focal units of object space in half of its smaller side.
    #[must_use]
    pub fn focal(&self) -> Focal {
        Focal::from_bits(self.focal)
    }

    /// Returns the distance of the near plane along the viewing direction, in units of object space. Nothing nearer is drawn.
    #[must_use]
    pub fn near(&self) -> Length {
        Length::from_bits(self.near)
    }

    /// Returns the distance of the far plane of an orthographic camera, in units of object space. A perspective camera has no far plane.
    #[must_use]
    pub fn far(&self) -> Length {
        Length::from_bits(self.far)
    }
}

/// A perspective camera: rays meet in the eye.
pub const PERSPECTIVE: u8 = 0;
/// An orthographic camera: rays are parallel.
pub const ORTHOGRAPHIC: u8 = 1;

/// A mesh of a stream (mesh file): some consecutive vertices and triangles that have one material. A mesh can be followed by coarser levels
/// of detail, records of this type that have fewer triangles on the same vertices. A frame draws one level of each mesh.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Mesh {
    /// The index of the first vertex among all vertices of the stream (mesh file). A coarser level of detail has the vertices of its mesh.
    #[doc(hidden)]
    pub first_vertex: u32,
    /// The index of the first triangle among all triangles of the stream (mesh file).
    #[doc(hidden)]
    pub first_triangle: u32,
    /// The number of triangles of the mesh.
    pub triangles: u32,
    /// The number of vertices of the mesh. A coarser level of detail has the vertices of its mesh.
    pub vertices: u16,
    /// The index of the material in [`Stream::materials`](crate::Stream::materials).
    pub material: u16,
    /// The largest distance between this level of detail and the full mesh (Hausdorff distance), in units of 1/16,384, rounded up; 0 for a
    /// full mesh.
    #[doc(hidden)]
    pub error: u16,
    /// Properties as bits. Bit 0 is 1 if the mesh is closed and convex, so that none of its front faces can hide another; the renderer then
    /// leaves out depth tests. Bit 1 is 1 if the stream has the neighbours of the mesh's triangles. Bit 2 is 1 if the corners of its triangles have
    /// colours. Bit 3 is 1 if the mesh has a texture. The upper four bits are the transparency: the part of the light from behind that the surface
    /// lets through, in sixteenths; 0 if nothing is seen through it.
    #[doc(hidden)]
    pub flags: u8,
    /// The first [`Colour`] of the mesh's palette, in units of [`PALETTE`] colours; the index of its [`Texture`] if it has one.
    #[doc(hidden)]
    pub palette: u8,
}

impl Mesh {
    /// Whether the corners of the triangles have colours, or the mesh has a texture.
    #[inline]
    pub(crate) fn is_coloured(&self) -> bool {
        self.flags & (HAS_COLOURS | HAS_TEXTURE) != 0
    }

    /// Returns the part of the light from behind that the surface lets through, in sixteenths, 0 to 15.
    #[inline]
    #[must_use]
    pub fn transparency(&self) -> u8 {
        self.flags >> TRANSPARENCY_SHIFT
    }

    /// Whether something is seen through the surface.
    #[inline]
    #[must_use]
    pub fn is_transparent(&self) -> bool {
        self.transparency() > 0
    }

    /// Returns the largest distance between this level of detail and the full mesh (Hausdorff distance), in units of object space; 0 for a
    /// full mesh.
    #[must_use]
    pub fn error(&self) -> GeometricError {
        GeometricError::from_bits(self.error)
    }
}

/// The mesh is closed and convex, so none of its front faces can hide another: see `geometry/depth_elision.rs`. It promises:
///
/// - The mesh is one closed surface, all of its triangles counter-clockwise seen from outside.
/// - Each vertex is a corner of a convex body, in the ball of radius one about the origin, with coordinates rounded to the
///   nearest; 0.36 units of the last place are left for the body's own arithmetic.
/// - By that rounding no triangle has leaned by more than 2^-[`LEAN`] rad.
pub const CLOSED_CONVEX: u8 = 1;

/// The stream has [`Neighbours`] for the triangles of the mesh. All meshes of a stream have this property, or none.
pub const HAS_NEIGHBOURS: u8 = 2;

/// The stream has [`CornerColours`] for the triangles of the mesh.
pub const HAS_COLOURS: u8 = 4;

/// The mesh has a [`Texture`], and the stream has [`TextureCorners`] for its triangles. Their corners have no colours of their own.
pub const HAS_TEXTURE: u8 = 8;

/// The bits of a mesh's flags below its transparency.
pub const TRANSPARENCY_SHIFT: u32 = 4;

/// Palettes begin at a multiple of this number of colours.
pub const PALETTE: usize = 16;

/// The largest angle by which rounding may have tilted a triangle of a [`CLOSED_CONVEX`] mesh is 2^-`LEAN` rad: 0.9 degrees.
pub const LEAN: u32 = 6;

/// A material of the Phong lighting model: how much of the light it reflects. Fields are integers, where 16,384 stands for 1; [`Self::new`]
/// makes a material from numbers.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Material {
    /// The ambient reflectance, by which the ambient light is multiplied: red, green, blue, each 0 to 32,768, where 16,384 is 1.
    #[doc(hidden)]
    pub ambient: [u16; 3],
    /// The diffuse reflectance, which is the colour of the surface: red, green, blue, each 0 to 32,768, where 16,384 is 1.
    #[doc(hidden)]
    pub diffuse: [u16; 3],
    /// The specular reflectance, which is the colour of highlights: red, green, blue, each 0 to 32,768, where 16,384 is 1.
    #[doc(hidden)]
    pub specular: [u16; 3],
    /// The exponent of the highlight, 1 to 1024. A larger exponent makes a smaller highlight. It is applied to N·H, where N is the normal
    /// and H the half vector between light and viewer (Blinn).
    pub exponent: u16,
}

impl Material {
    /// Creates a material from its ambient, diffuse and specular reflectance (red, green, blue, each 0 to 2) and the exponent of its
    /// highlight (1 to 1024). [`Scene::set_material`](crate::Scene::set_material) checks these ranges.
    #[must_use]
    pub fn new(ambient: [Gain; 3], diffuse: [Gain; 3], specular: [Gain; 3], exponent: u16) -> Self {
        let [ambient, diffuse, specular] = [ambient, diffuse, specular].map(|colour| colour.map(Gain::to_bits));
        Self { ambient, diffuse, specular, exponent }
    }

    /// Returns the ambient reflectance, by which the ambient light is multiplied: red, green, blue, each 0 to 2.
    #[must_use]
    pub fn ambient(&self) -> [Gain; 3] {
        self.ambient.map(Gain::from_bits)
    }

    /// Returns the diffuse reflectance, which is the colour of the surface: red, green, blue, each 0 to 2.
    #[must_use]
    pub fn diffuse(&self) -> [Gain; 3] {
        self.diffuse.map(Gain::from_bits)
    }

    /// Returns the specular reflectance, which is the colour of highlights: red, green, blue, each 0 to 2.
    #[must_use]
    pub fn specular(&self) -> [Gain; 3] {
        self.specular.map(Gain::from_bits)
    }
}

/// A light: directional, at a point, or from the sky. Create one by [`Self::directional`], [`Self::near`] or [`Self::sky`]; the fields are
/// integers as the stream stores them.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Light {
    /// The unit vector towards a directional light or to the middle of the sky, or the position of a point light, in units of 1/16,384. Positions are
    /// within 16 units of the origin along each axis.
    #[doc(hidden)]
    pub vector: [i32; 3],
    /// The colour: red, green, blue, each 0 to 32,768, where 16,384 is full intensity.
    #[doc(hidden)]
    pub colour: [u16; 3],
    /// The kind of light: 0 for directional, 1 for a point light, 2 for the sky.
    #[doc(hidden)]
    pub kind: u8,
    /// The space of the vector and of the axis: 0 if the light is fixed in the world, 1 if it moves with the camera.
    #[doc(hidden)]
    pub space: u8,
    /// The axis of a point light's cone, from the light to where it shines: a unit vector in units of 1/16,384. Zero if the light shines all around.
    #[doc(hidden)]
    pub axis: [i16; 3],
    /// The distance at which a point light ends, a [`Reach`] of 1/16 to less than 32 units; 0 if it does not weaken with distance.
    #[doc(hidden)]
    pub range: u16,
    /// The cosines of the angles between the axis of a cone and the edge of its light, and between the axis and where the light is full; in units of
    /// 1/16,384, the second greater than the first. Zero if there is no axis.
    #[doc(hidden)]
    pub cone: [i16; 2],
}

impl Light {
    /// Creates a light from the values of its fields: `kind` is 0 for a directional light, 1 for a point light and 2 for the sky, `space` is 0 for the
    /// world and 1 for eye space (x to the right, y up, z away from the viewer), and each channel of `colour` is 0 to 2.
    /// [`Self::directional`], [`Self::near`] and [`Self::sky`] are easier to use, and check their arguments.
    #[doc(hidden)]
    #[must_use]
    pub fn new(kind: u8, space: u8, vector: [Length; 3], colour: [Gain; 3]) -> Self {
        let (vector, colour) = (vector.map(Length::to_bits), colour.map(Gain::to_bits));
        Self { vector, colour, kind, space, axis: [0; 3], range: 0, cone: [0; 2] }
    }

    /// Returns the colour: red, green, blue, each 0 to 2, where 1 is full intensity.
    #[must_use]
    pub fn colour(&self) -> [Gain; 3] {
        self.colour.map(Gain::from_bits)
    }

    /// Returns the distance at which a point light ends, or 0 if it does not weaken with distance.
    #[must_use]
    pub fn range(&self) -> Reach {
        Reach::from_bits(self.range)
    }

    /// Whether the light comes from the sky.
    #[inline]
    pub(crate) fn is_sky(&self) -> bool {
        LIGHT_SHAPES && self.kind == SKY
    }

    /// Whether the light has a range or a cone, or comes from the sky.
    #[doc(hidden)]
    #[must_use]
    pub fn has_shape(&self) -> bool {
        self.kind == SKY || self.range > 0 || self.axis != [0; 3]
    }
}

/// A directional light, which is infinitely far.
pub const DIRECTIONAL: u8 = 0;
/// A point light, which has a position.
pub const POINT: u8 = 1;
/// Light from a half of the sky, all around its middle: a surface gets (1 + N·L)/2 of it, and it makes no highlight.
pub const SKY: u8 = 2;
/// The light stands still in the world.
pub const OBJECT_SPACE: u8 = 0;
/// The light moves with the camera.
pub const EYE_SPACE: u8 = 1;

/// An object of the scene: meshes of the stream, with their coarser levels. Several objects can have the same meshes.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Instance {
    /// Index of the object's first [`Mesh`].
    pub first_mesh: u16,
    /// Number of the object's meshes.
    pub meshes: u16,
    /// Index of the [`Material`] of all meshes of the object, or [`OWN_MATERIALS`].
    pub material: u16,
    /// Unused, for alignment.
    pub reserved: u16,
}

/// Each mesh of the object has its own material.
pub const OWN_MATERIALS: u16 = u16::MAX;

/// The movement of an object, a light or the camera: keys, and linear interpolation between them.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Track {
    /// What moves: [`OBJECT_TRACK`], [`LIGHT_TRACK`] or [`CAMERA_TRACK`].
    pub kind: u16,
    /// Index of the [`Instance`] or [`Light`].
    pub index: u16,
    /// Index of the track's first [`Key`]. Tracks follow one another without a gap.
    pub first_key: u32,
    /// Number of keys, at least 1.
    pub keys: u32,
}

/// The track moves an object: its keys are poses.
pub const OBJECT_TRACK: u16 = 0;
/// The track moves a light: the position of a key is its [`Light::vector`].
pub const LIGHT_TRACK: u16 = 1;
/// The track moves the camera: it looks along the z axis of a key, whose y axis points upwards in the picture.
pub const CAMERA_TRACK: u16 = 2;

/// A pose in one frame. Before the first key of its track the pose is that of the first key, after the last key that of the last.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Key {
    /// Number of the frame. The keys of a track are in this order.
    pub frame: u32,
    /// Quaternion w, x, y, z, each a [`Rotation`]. Its squared length is within 1/256 of 1.
    pub rotation: [i32; 4],
    /// Position, each coordinate a [`Length`] of at most [`MAX_POSITION`] in size. For a camera the distance from the origin is limited so.
    pub position: [i32; 3],
    /// Scale, a [`Scale`] from 1/16 to 8. At 0 the object is hidden until its next key.
    pub scale: u32,
}

/// Largest coordinate of a position in the world: 16 units.
pub const MAX_POSITION: Length = Length::from_bits(16 << 14);

/// A vertex: position and unit normal.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Vertex {
    /// Position in object space, each coordinate a [`Unit`] in [-2, 2), rounded to the nearest. The error is at most 3.1e-5 along each axis.
    pub position: [i16; 3],
    /// Unit normal in object space, each component a [`Unit`], at most a little beyond [-1, 1]. It is rounded to the grid point nearby whose length
    /// is closest to 1. Writers keep the length within 3.1e-5 of 1; readers accept squared lengths within 1/256 of 1.
    pub normal: [i16; 3],
}

impl Vertex {
    /// A vertex whose position and normal are zero.
    pub const ZERO: Self = Self { position: [0; 3], normal: [0; 3] };
}

/// A triangle: three vertices, and constants that depend on neither camera nor light.
///
/// Seen from the front, the vertices run counter-clockwise in object space, which is right-handed. Edge `k` joins corner `k` and corner `k + 1`.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Triangle {
    /// Indices of the corners, relative to the mesh's first vertex.
    pub corners: [u16; 3],
    /// For each edge the reciprocal length of the sum of the normals at its ends, minus its smallest possible value: 1/|Ni+Nj| - 1/2, unsigned Q0.17
    /// in [0, 1/2), rounded to the nearest. It normalises the normal at the midpoint. It is 65535 where the normals are 120 degrees apart or more;
    /// the renderer computes it there.
    pub inverse_sum_length: [u16; 3],
    /// For each edge the haversine of the angle between the normals at its ends, (1 - Ni·Nj)/2 = 1 - |Ni+Nj|²/4, a [`Haversine`] in [0, 1], rounded
    /// to the nearest, at most 65535. The squared length of the interpolated normal at the midpoint is 1 minus this.
    pub haversine: [u16; 3],
    /// Smallest length of the interpolated normal on the triangle, a [`NormalLength`] in [0, 1], rounded down. It is the root of 1 minus the squared
    /// radius of the smallest circle around the tips of the three unit normals.
    pub min_normal_length: u16,
    /// Unit normal of the plane in object space, each component a [`Unit`], rounded as a vertex's normal is.
    pub normal: [i16; 3],
    /// Distance of the plane from the origin, a [`Unit`] in [-2, 2). It is rounded down, so that a camera at `p` with `normal · p` less than it
    /// surely sees the back.
    pub offset: i16,
    /// 1 over the smallest altitude of the triangle, which is the longest side over twice the area; an [`InverseAltitude`] per unit, rounded up, at
    /// least one step, at most 65535. It tells how far the triangle has to face away before rounding of corners cannot turn it to the front, see
    /// [`crate::geometry::cull`].
    pub inverse_altitude: u16,
}

impl Triangle {
    /// The vertices of the triangle among all `vertices` of its mesh, clockwise on the screen, which is against the order of the record; `None` if one is
    /// missing.
    #[inline]
    pub(crate) fn vertices<'a>(&self, vertices: &'a [Vertex]) -> Option<[&'a Vertex; 3]> {
        let [a, c, b] = self.corners.map(|corner| vertices.get(usize::from(corner)));
        Some([a?, b?, c?])
    }
}

/// A colour of a palette: the part of the ambient and of the diffuse light that a surface reflects, besides what its material does. Highlights do not
/// depend on it.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Colour {
    /// Red, green, blue, each 0 to 255, where 255 is all of the light.
    pub channels: [u8; 3],
    /// 1 if a texture has a hole where it has this colour, otherwise 0.
    pub hole: u8,
}

impl Colour {
    /// A colour without a hole.
    #[must_use]
    pub const fn new(channels: [u8; 3]) -> Self {
        Self { channels, hole: 0 }
    }
}

/// The colours at the corners of a triangle. Between them the colour is linear.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct CornerColours {
    /// The colour of each corner, as an index of the mesh's palette.
    pub colours: [u8; 3],
    /// The largest difference of a channel between two corners: 0 if the triangle has one colour.
    pub range: u8,
}

impl CornerColours {
    /// The colours of three corners, which are these in the palette.
    #[must_use]
    pub fn new(colours: [u8; 3], [a, b, c]: [Colour; 3]) -> Self {
        let range = (0..3).fold(0, |most, k| match (a.channels.get(k), b.channels.get(k), c.channels.get(k)) {
            (Some(&a), Some(&b), Some(&c)) => most.max(a.max(b).max(c) - a.min(b).min(c)),
            _ => most,
        });
        Self { colours, range }
    }
}

/// A texture: a picture whose colours take the place of those at corners. It is repeated without end to the right and downwards. A texel is a byte: the
/// index of a colour of the palette. The texels of all textures follow one another, row by row, each texture's first row first.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Texture {
    /// The binary logarithms of width and height, each at most [`LARGEST_TEXTURE`].
    pub size: [u8; 2],
    /// The first [`Colour`] of the palette, in units of [`PALETTE`] colours.
    pub palette: u8,
    /// 1 if the texture may have holes, otherwise 0: then no colour of its palette that it uses is a [`hole`](Colour::hole).
    pub has_holes: u8,
}

/// The binary logarithm of the largest width and height of a [`Texture`]: 256 texels.
pub const LARGEST_TEXTURE: u8 = 8;

/// Where the corners of a triangle lie in the mesh's [`Texture`].
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct TextureCorners(
    /// For each corner the distances from the left and from the upper side of the texture, in widths and in heights of it, each a
    /// [`TextureCoordinate`]. They are rounded to the nearest; the error is at most 1/32 of a texel.
    pub [[u16; 2]; 3],
);

/// The neighbours of a triangle, from which outlines are found. Entry `k` belongs to the edge that joins the corners `k` and `k + 1`.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct Neighbours(
    /// The index of the triangle on the other side of the edge, among those of the same mesh at the same level of detail, or [`OPEN`]. The highest
    /// bit is [`CREASE`].
    pub [u16; 3],
);

/// The edge has no neighbour in the mesh: the surface ends there, or another material begins.
pub const OPEN: u16 = 0x7FFF;

/// The shading of the two triangles at the edge differs, because their normals or the colours of their corners do.
pub const CREASE: u16 = 0x8000;

/// Two triangles of the stream that cut each other. `microphong convert --antialias` lists them, so that antialiasing finds the line between them.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Cut {
    /// Indices of the two triangles, among all triangles of the stream. Both belong to full meshes.
    pub triangles: [u32; 2],
    /// Indices of the objects that they belong to; 0 if the stream has no objects.
    pub objects: [u16; 2],
}

/// A text over the picture. In pictures of any size it lies at the same place of the scene.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Label {
    /// Distance of the text from the centre of the picture, to the right and downwards, each a [`Share`].
    pub position: [i16; 2],
    /// Height of a line, a [`Share`] of more than 0. The text is drawn by the largest of the program's fonts that is not higher. If all fonts are
    /// higher, it is not drawn.
    pub height: i16,
    /// Colour of the text: red, green, blue.
    pub colour: [u8; 3],
    /// The point of the text that lies at `position`: [`LEFT`], [`MIDDLE`] or [`RIGHT`].
    pub alignment: u8,
    /// Characters of ISO 8859-1, at least one, followed by zeros. None is a control character.
    pub text: [u8; LABEL_TEXT],
}

/// Height of a line of the smallest font, in pixels.
pub const LEAST_LINE: u32 = 6;

/// Largest number of characters in a [`Label`].
pub const LABEL_TEXT: usize = 30;

/// The label lies at its left end, in the middle of its height.
pub const LEFT: u8 = 0;
/// The label lies at its middle.
pub const MIDDLE: u8 = 1;
/// The label lies at its right end, in the middle of its height.
pub const RIGHT: u8 = 2;

impl Label {
    /// Distance of the text from the centre of the picture, to the right and downwards.
    #[must_use]
    pub fn position(&self) -> [Share; 2] {
        self.position.map(Share::from_bits)
    }

    /// Height of a line, as a fraction of the picture's smaller side.
    #[must_use]
    pub fn height(&self) -> Share {
        Share::from_bits(self.height)
    }

    /// The characters of the text.
    pub fn characters(&self) -> impl Iterator<Item = char> + '_ {
        self.text.iter().take_while(|&&character| character != 0).map(|&character| character.into())
    }
}
