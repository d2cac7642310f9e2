//! The scanline methods where they are hard: normals far apart, hardly apart, and sharp highlights on wide rows.

use embedded_graphics::geometry::Size;
use microphong::stream::{
    record::{Material, Vertex},
    seal,
};
use microphong_sim::{
    bytes::StreamBytes,
    level,
    oracle::{Frame, method},
    scene,
    shader::Shader,
};
use microphong_tests::named;
use zerocopy::{FromBytes, Immutable, IntoBytes};

/// Changes `count` records that start at byte `start`.
fn each<T: FromBytes + IntoBytes + Immutable>(bytes: &mut [u8], start: usize, count: usize, change: impl Fn(usize, &mut T)) {
    for (i, bytes) in bytes[start..].chunks_mut(size_of::<T>()).take(count).enumerate() {
        let mut record = T::read_from_bytes(bytes).unwrap();
        change(i, &mut record);
        bytes.copy_from_slice(record.as_bytes());
    }
}

/// A built-in scene with another exponent and other normals. Edge constants stay: only for methods without them.
fn changed(name: &str, exponent: u16, normal: impl Fn(usize, [i16; 3]) -> [i16; 3]) -> StreamBytes {
    let stream = scene::load(name).unwrap().stream;
    let (mut bytes, parsed) = (stream.as_bytes().to_vec(), stream.parse().unwrap());
    let start = |address: usize| address - stream.as_bytes().as_ptr().addr();
    let materials = start(parsed.materials.as_ptr().addr());
    let vertices = start(parsed.vertices.as_ptr().addr());
    each(&mut bytes, materials, parsed.materials.len(), |_, material: &mut Material| material.exponent = exponent);
    each(&mut bytes, vertices, parsed.vertices.len(), |i, vertex: &mut Vertex| vertex.normal = normal(i, vertex.normal));
    seal(&mut bytes);
    StreamBytes::from(bytes.as_slice())
}

/// Pixels that differ from the method in 64-bit floating point by more than 0.3/255.
fn wrong(stream: &StreamBytes, side: u32, shader: Shader) -> usize {
    let stream = stream.parse().unwrap();
    let Ok(drawn) = level::picture(stream, Size::new(side, side), shader, 7) else { return 0 };
    let frame = Frame::new(stream, (side, side), 7);
    let shades: Vec<_> = frame.facets.iter().map(|facet| method(shader.name(), &frame, facet).unwrap()).collect();
    let right = |i: usize, level: f64, facet: u32| {
        let exact = shades[facet as usize]([(i as u32 % side) as f64 + 0.5, (i as u32 / side) as f64 + 0.5]);
        // One level for all channels is that of the brightest.
        (level - exact.into_iter().fold(0.0, f64::max)).abs() <= 0.3
    };
    let pixels = drawn.into_iter().zip(frame.visible()).enumerate();
    let wrong =
        pixels.filter(|(i, (levels, near))| levels.is_some_and(|levels| !near.iter().flatten().any(|&facet| right(*i, levels[0], facet))));
    wrong.count()
}

#[test]
fn rows_keep_to_their_method_where_they_are_hard() {
    let swapped = |i: usize, [x, y, z]: [i16; 3]| if i.is_multiple_of(3) { [y, z, x] } else { [x, y, z] };
    let close = |i: usize, _| [0, 1, 2].map(|k| 9_458 + ((((i * 7_919 + k * 104_729) * 40_503) >> 7) & 3) as i16);
    let scenes = [
        ("far apart", changed("sphere-168", 20, swapped), 240),
        ("hardly apart", changed("sphere-690", 20, close), 300),
        ("the same", changed("sphere-690", 20, |_, _| [9_459; 3]), 100),
        ("sharp", changed("sphere-168", 1_024, |_, normal| normal), 900),
        ("sharp, near light", changed("sphere-40", 1_024, |_, normal| normal), 600),
        ("dull", changed("sphere-168", 4, |_, normal| normal), 200),
    ];
    for (what, stream, side) in &scenes {
        for shader in ["goldman", "slerp", "angular", "angular-original"].map(named) {
            assert_eq!(wrong(stream, *side, shader), 0, "{what}, {}", shader.name());
        }
    }
}
