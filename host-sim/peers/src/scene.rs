//! A triangle stream in floating point, as other renderers want it.

use alloc::vec::Vec;
use core::array;
use microphong::{
    Stream,
    format::{COSINE, ROTATION, UNIT},
    geometry::model_view::ModelView,
    lighting::lights::Lighting,
    stream::record::{Camera, PERSPECTIVE},
};

/// One mesh under directional lights. Highlights are seen from infinity. The mesh is rotated to the camera's axes: x to the right, y up, z towards
/// the eye.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Positions of the vertices.
    pub positions: Vec<[f32; 3]>,
    /// Normals of the vertices.
    pub normals: Vec<[f32; 3]>,
    /// Vertices, counter-clockwise where seen from outside.
    pub faces: Vec<[usize; 3]>,
    /// Normals of the faces.
    pub face_normals: Vec<[f32; 3]>,
    /// Radius of the ball about the origin that holds all vertices.
    pub radius: f32,
    /// Position of the eye, which looks along -z.
    pub eye: [f32; 3],
    /// Half of the picture's height is seen under the slope 1 / `focal`.
    pub focal: f32,
    /// Nearest distance drawn.
    pub near: f32,
    /// Light that is always reflected; 1 is full intensity.
    pub ambient: [f32; 3],
    /// The lights, the brightest usually first.
    pub lights: Vec<Light>,
    /// The exponent of highlights.
    pub exponent: u16,
}

/// A directional light, and how much of it the surface reflects.
#[derive(Clone, Debug)]
pub struct Light {
    /// Unit vector to the light.
    pub towards: [f32; 3],
    /// Unit vector halfway between light and eye.
    pub half: [f32; 3],
    /// Times N·L.
    pub diffuse: [f32; 3],
    /// Times the power of N·H.
    pub specular: [f32; 3],
}

/// Distance of an eye that sees nearly parallel rays: no corner moves by a quarter of a pixel of these pictures. With exactly parallel rays 1 / z, by
/// which peers test depth, would be the same everywhere.
const AFAR: f32 = 500.0;

/// Converts fixed-point numbers with `bits` fraction bits.
fn float<const N: usize>(v: [i32; N], bits: u32) -> [f32; N] {
    v.map(|c| c as f32 / (1u32 << bits) as f32)
}

/// Converts lengths, unit vectors and gains of a stream.
fn wide<const N: usize, T: Into<i32>>(v: [T; N]) -> [f32; N] {
    float(v.map(Into::into), UNIT)
}

fn product(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    array::from_fn(|channel| a[channel] * b[channel])
}

impl Scene {
    /// Frame 0 of `stream`; `None` if it has more than one mesh or material, or light that is not the same everywhere.
    #[must_use]
    pub fn new(stream: &Stream<'_>) -> Option<Self> {
        let ([_], [material]) = (stream.meshes, stream.materials) else { return None };
        let camera = &stream.header.camera;
        let pose = ModelView::new(camera, 0);
        let [right, up, away] = pose.rotation.map(|row| float(row, ROTATION));
        let axes = [right, up, away.map(|c| -c)];
        let turned = |v: [f32; 3]| axes.map(|axis| product(axis, v).into_iter().sum());
        let lighting = Lighting::new(camera, stream.lights, &pose);
        let sources = lighting.is_constant().then_some(lighting.sources())?;
        let lights = stream.lights.iter().zip(sources).filter_map(|(light, source)| {
            let &[towards, half] = source.directional()?;
            let reflected = |share| product(wide(share), wide(light.colour));
            Some(Light {
                towards: turned(float(towards, COSINE)),
                half: turned(float(half, COSINE)),
                diffuse: reflected(material.diffuse),
                specular: reflected(material.specular),
            })
        });
        let (eye, focal) = eye(camera, wide(pose.translation));
        Some(Self {
            positions: stream.vertices.iter().map(|vertex| turned(wide(vertex.position))).collect(),
            normals: stream.vertices.iter().map(|vertex| turned(wide(vertex.normal))).collect(),
            faces: stream.triangles.iter().map(|triangle| triangle.corners.map(usize::from)).collect(),
            face_normals: stream.triangles.iter().map(|triangle| turned(wide(triangle.normal))).collect(),
            radius: wide([stream.header.radius])[0],
            eye,
            focal,
            near: wide([camera.near])[0],
            ambient: product(wide(material.ambient), wide(stream.header.ambient)),
            lights: lights.collect(),
            exponent: material.exponent,
        })
    }

    /// Number of channels that differ: one if everything is grey.
    #[must_use]
    pub fn channels(&self) -> usize {
        let grey = |[r, g, b]: [f32; 3]| r == g && g == b;
        if grey(self.ambient) && self.lights.iter().all(|light| grey(light.diffuse) && grey(light.specular)) { 1 } else { 3 }
    }
}

/// The position of the eye and the focal length, for a camera whose rays meet in the eye. The object is at `translation` in eye space.
fn eye(camera: &Camera, [x, y, z]: [f32; 3]) -> ([f32; 3], f32) {
    let focal = camera.focal as f32 / 65536.0;
    if camera.projection == PERSPECTIVE { ([-x, -y, z], focal) } else { ([-x, -y, AFAR], focal * AFAR) }
}
