//! Phong shading of one point in 64-bit floating point, from a stream's records and nothing of the core's arithmetic.

use microphong::{
    Stream,
    stream::record::{DIRECTIONAL, EYE_SPACE, PERSPECTIVE, VIEWER_LOCAL},
};

/// A vector of three components.
pub type V3 = [f64; 3];

/// The scalar product.
#[must_use]
pub fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `v` with length one.
#[must_use]
pub fn unit(v: V3) -> V3 {
    let length = dot(v, v).sqrt();
    v.map(|c| c / length)
}

/// Converts fixed-point numbers of a stream.
#[must_use]
pub fn real<const N: usize>(v: [i32; N], bits: i32) -> [f64; N] {
    v.map(|c| f64::from(c) / 2f64.powi(bits))
}

/// Light of a point with a unit normal, per channel, 1 is full. `rotation` turns object to eye space.
#[must_use]
pub fn light(stream: &Stream<'_>, rotation: [V3; 3], material: usize, position: V3, normal: V3) -> V3 {
    let to_object = |v: V3| [0, 1, 2].map(|c| rotation[0][c] * v[0] + rotation[1][c] * v[1] + rotation[2][c] * v[2]);
    let translation = real(stream.header.camera.translation, 14);
    let eye = to_object(translation.map(|c| -c));
    let local = stream.header.camera.viewer == VIEWER_LOCAL && stream.header.camera.projection == PERSPECTIVE;
    let view = if local { unit([0, 1, 2].map(|k| eye[k] - position[k])) } else { to_object([0.0, 0.0, -1.0]) };
    let gain = |c: [u16; 3]| c.map(|c| f64::from(c) / 16_384.0);
    let material = &stream.materials[material];
    let (ambient, diffuse, specular) = (gain(material.ambient), gain(material.diffuse), gain(material.specular));
    let around = gain(stream.header.ambient);
    let mut sum = [0, 1, 2].map(|k| ambient[k] * around[k]);
    for source in stream.lights {
        let mut vector = real(source.vector, 14);
        if source.space == EYE_SPACE {
            let shift = if source.kind == DIRECTIONAL { [0.0; 3] } else { translation };
            vector = to_object([0, 1, 2].map(|k| vector[k] - shift[k]));
        }
        let towards = if source.kind == DIRECTIONAL { unit(vector) } else { unit([0, 1, 2].map(|k| vector[k] - position[k])) };
        let half = unit([0, 1, 2].map(|k| towards[k] + view[k]));
        let colour = gain(source.colour);
        let (d, s) = (dot(normal, towards).max(0.0), dot(normal, half).max(0.0).powi(material.exponent.into()));
        for k in 0..3 {
            sum[k] += colour[k] * (diffuse[k] * d + specular[k] * s);
        }
    }
    sum
}
