//! A triangle stream in floating point, as other renderers want it.

use alloc::vec::Vec;
use microphong::{
    Stream,
    format::{COSINE, ROTATION, UNIT},
    geometry::pose::Pose,
    lighting::lights::Lighting,
};

/// One grey mesh under one directional light, seen from infinity as far as highlights go: what all peers can draw.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Of the vertices, in object space.
    pub positions: Vec<[f32; 3]>,
    /// Of the vertices.
    pub normals: Vec<[f32; 3]>,
    /// Vertices, counter-clockwise where seen from outside.
    pub faces: Vec<[usize; 3]>,
    /// Of the faces.
    pub face_normals: Vec<[f32; 3]>,
    /// Object to eye space: x to the right, y up, z away from the eye.
    pub rotation: [[f32; 3]; 3],
    /// Added after rotation.
    pub translation: [f32; 3],
    /// Half of the picture's height is seen under the slope 1 / `focal`.
    pub focal: f32,
    /// Nearest distance drawn.
    pub near: f32,
    /// Unit vector to the light, in object space.
    pub towards: [f32; 3],
    /// Unit vector halfway between light and eye.
    pub half: [f32; 3],
    /// How the surface reflects.
    pub surface: Surface,
}

/// The exponent of highlights: a constant, as in a shader that is written for its scene, so that its power is a few products.
const EXPONENT: u16 = 50;

/// Shares of light, of full.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Always there.
    pub ambient: f32,
    /// Times N·L.
    pub diffuse: f32,
    /// Times the power of N·H.
    pub specular: f32,
}

/// From fixed point with `bits` fraction bits.
fn float<const N: usize>(v: [i32; N], bits: u32) -> [f32; N] {
    v.map(|c| c as f32 / (1u32 << bits) as f32)
}

impl Scene {
    /// Frame 0 of `stream`; `None` if it has more than one mesh or light, or another exponent than [`EXPONENT`].
    #[must_use]
    pub fn new(stream: &Stream<'_>) -> Option<Self> {
        let pose = Pose::new(&stream.header.camera, 0);
        let [towards, half] = Lighting::new(stream, &pose).constant()?;
        let ([_], [light], [material]) = (stream.meshes, stream.lights, stream.materials) else { return None };
        if material.exponent != EXPONENT {
            return None;
        }
        let share = |of: [u16; 3], light: [u16; 3]| float([of[1].into()], UNIT)[0] * float([light[1].into()], UNIT)[0];
        let wide = |v: [i16; 3]| float(v.map(i32::from), UNIT);
        Some(Self {
            positions: stream.vertices.iter().map(|vertex| wide(vertex.position)).collect(),
            normals: stream.vertices.iter().map(|vertex| wide(vertex.normal)).collect(),
            faces: stream.triangles.iter().map(|triangle| triangle.corners.map(usize::from)).collect(),
            face_normals: stream.triangles.iter().map(|triangle| wide(triangle.normal)).collect(),
            rotation: pose.rotation.map(|row| float(row, ROTATION)),
            translation: float(pose.translation, UNIT),
            focal: stream.header.camera.focal as f32 / 65536.0,
            near: float([stream.header.camera.near], UNIT)[0],
            towards: float(towards, COSINE),
            half: float(half, COSINE),
            surface: Surface {
                ambient: share(material.ambient, stream.header.ambient),
                diffuse: share(material.diffuse, light.colour),
                specular: share(material.specular, light.colour),
            },
        })
    }
}

impl Surface {
    /// What is seen of full light where these are N·L and N·H.
    #[must_use]
    #[inline]
    pub fn shade(&self, diffuse: f32, specular: f32) -> f32 {
        self.ambient + self.diffuse * diffuse.max(0.0) + self.specular * power(specular.max(0.0), EXPONENT)
    }
}

/// By squaring.
#[inline]
fn power(mut base: f32, mut exponent: u16) -> f32 {
    let mut result = 1.0;
    while exponent > 0 {
        if exponent & 1 != 0 {
            result *= base;
        }
        base *= base;
        exponent >>= 1;
    }
    result
}
