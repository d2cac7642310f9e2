//! The smallest scene that still fails.

use crate::case::Case;
use microphong::stream::{self, record::Header, seal};
use microphong_models::bytes::StreamBytes;
use microphong_render::render::Format;
use zerocopy::IntoBytes;

/// Makes `case` smaller as long as it `fails`.
#[must_use]
pub fn smallest(mut case: Case, fails: &dyn Fn(&Case) -> bool) -> Case {
    let smaller = |other: Case, case: &mut Case| {
        let fails = other.stream.parse().is_ok() && fails(&other);
        if fails {
            *case = other;
        }
        fails
    };
    // Triangles: halves, quarters, and so on down to single ones are left out.
    let count = |case: &Case| case.stream.parse().map_or(0, |stream| stream.triangles.len());
    let mut part = count(&case);
    while part > 0 {
        let mut first = 0;
        while first < count(&case) {
            let without = triangles(&case.stream, |k| !(first..first + part).contains(&k));
            if !without.is_some_and(|stream| smaller(Case { stream, ..case.clone() }, &mut case)) {
                first += part;
            }
        }
        part /= 2;
    }
    let mut light = 0;
    while case.stream.parse().is_ok_and(|stream| light < stream.lights.len()) {
        let without = lights(&case.stream, light);
        if !without.is_some_and(|stream| smaller(Case { stream, ..case.clone() }, &mut case)) {
            light += 1;
        }
    }
    for simpler in [
        |case: &mut Case| case.frame = 0,
        |case: &mut Case| case.style.antialias = false,
        |case: &mut Case| case.style.outlines = None,
        |case: &mut Case| case.style.perspective_correct = false,
        |case: &mut Case| case.style.dither = false,
        |case: &mut Case| case.format = Format::Rgb888,
        |case: &mut Case| case.band_rows = case.size[1],
    ] {
        let mut other = case.clone();
        simpler(&mut other);
        smaller(other, &mut case);
    }
    for side in [0, 1] {
        while case.size[side] > 1 {
            let mut other = case.clone();
            other.size[side] /= 2;
            if !smaller(other, &mut case) {
                break;
            }
        }
    }
    case
}

/// Removes all triangles from a stream whose numbers are not `kept`. Vertices stay. `None` if no triangle is left.
fn triangles(bytes: &StreamBytes, kept: impl Fn(usize) -> bool) -> Option<StreamBytes> {
    let stream = bytes.parse().ok()?;
    let (mut meshes, mut triangles) = (Vec::new(), Vec::new());
    for mesh in stream.meshes {
        let first_triangle = triangles.len() as u32;
        for (k, triangle) in (mesh.first_triangle as usize..).zip(stream.triangles_of(mesh)?) {
            if kept(k) {
                triangles.push(*triangle);
            }
        }
        meshes.push(microphong::stream::record::Mesh { first_triangle, triangles: triangles.len() as u32 - first_triangle, ..*mesh });
    }
    if triangles.is_empty() {
        return None;
    }
    let header = Header { triangles: triangles.len() as u32, ..*stream.header };
    written(
        header,
        &[
            meshes.as_bytes(),
            stream.materials.as_bytes(),
            stream.lights.as_bytes(),
            stream.instances.as_bytes(),
            stream.tracks.as_bytes(),
            stream.keys.as_bytes(),
            stream.vertices.as_bytes(),
            triangles.as_bytes(),
            stream.labels.as_bytes(),
        ],
    )
}

/// The stream without light number `light`.
fn lights(bytes: &StreamBytes, light: usize) -> Option<StreamBytes> {
    let stream = bytes.parse().ok()?;
    let mut lights = stream.lights.to_vec();
    lights.remove(light);
    let header = Header { lights: lights.len() as u16, ..*stream.header };
    written(
        header,
        &[
            stream.meshes.as_bytes(),
            stream.materials.as_bytes(),
            lights.as_bytes(),
            stream.instances.as_bytes(),
            stream.tracks.as_bytes(),
            stream.keys.as_bytes(),
            stream.vertices.as_bytes(),
            stream.triangles.as_bytes(),
            stream.labels.as_bytes(),
        ],
    )
}

/// The stream of this header and these arrays, in their order; `None` if it is not valid.
pub(crate) fn written(mut header: Header, arrays: &[&[u8]]) -> Option<StreamBytes> {
    header.length = stream::length(&header)?;
    let mut bytes = header.as_bytes().to_vec();
    arrays.iter().for_each(|array| bytes.extend_from_slice(array));
    seal(&mut bytes);
    let stream = StreamBytes::from(&bytes[..]);
    stream.parse().is_ok().then_some(stream)
}
