//! Without depth where it cannot matter, a closed convex mesh looks the same, pixel by pixel.

use embedded_graphics::{pixelcolor::Rgb565, prelude::Size};
use microphong::{Shader, Stats, stream::record::CLOSED_CONVEX};
use microphong_sim::{
    bytes::StreamBytes,
    look::{Look, Surface},
    mesh,
    quantise::quantise,
    render, scene, shapes,
    vector::{V3, product, rotation, unit},
    view::{Up, View},
};
use microphong_tests::unmarked;
use proptest::prelude::*;

fn picture(stream: &StreamBytes, size: Size, shader: Shader, number: u32) -> (Vec<Rgb565>, Stats) {
    render::frame(stream.parse().unwrap(), size, shader, 16, number).unwrap()
}

/// How many pixels differ with and without the mark.
fn difference(stream: &StreamBytes, size: Size, shader: Shader, frames: impl Iterator<Item = u32>) -> usize {
    let plain = unmarked(stream);
    let differing = frames.map(|number| {
        let ((a, stats), (b, expected)) = (picture(stream, size, shader, number), picture(&plain, size, shader, number));
        assert_eq!(stats, expected, "frame {number}");
        a.iter().zip(&b).filter(|(a, b)| a != b).count()
    });
    differing.sum()
}

#[test]
fn convex_scenes_look_the_same() {
    for name in scene::NAMES.into_iter().filter(|name| name.contains("sphere") || *name == "dodecahedron") {
        let stream = scene::load(name).unwrap().stream;
        assert_ne!(stream.parse().unwrap().meshes[0].flags & CLOSED_CONVEX, 0, "{name}");
        for (width, height) in [(320, 240), (47, 61), (16, 16), (640, 480), (1001, 200)] {
            // Flat shading shows best which triangle a pixel has.
            assert_eq!(difference(&stream, Size::new(width, height), Shader::Flat, (0..120).step_by(7)), 0, "{name} at {width}x{height}");
        }
        assert_eq!(difference(&stream, Size::new(200, 150), Shader::SixPoint, 0..20), 0, "{name}");
    }
}

/// A body with `sides` corners around in `bands`, squeezed along the axes and turned: round, flat, or a needle.
fn body(sides: usize, bands: usize, squeeze: V3, turn: V3) -> mesh::Mesh {
    let round = shapes::sphere(sides, bands, turn[2]);
    let mut squeezed = round.clone();
    for (position, normal) in squeezed.positions.iter_mut().zip(&mut squeezed.normals) {
        *position = [0, 1, 2].map(|k| position[k] * squeeze[k]);
        *normal = unit([0, 1, 2].map(|k| normal[k] / squeeze[k])).unwrap();
    }
    shapes::turned(squeezed, &product(&rotation([1.0, 0.0, 0.0], turn[0]), &rotation([0.0, 1.0, 0.0], turn[1])))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1_000))]
    #[test]
    fn convex_bodies_look_the_same(
        (sides, bands) in (3usize..40, 2usize..40),
        squeeze in [0.01f64..1.0, 0.1..1.0, 0.3..1.0],
        turn in [0.0f64..7.0, 0.0..7.0, 0.0..7.0],
        // From inside the body to far away.
        (distance, focal, parallel) in (0.3f64..5.0, 0.5f64..6.0, any::<bool>()),
        (width, height) in (8u32..400, 8u32..400),
    ) {
        let (parts, _) = quantise(&body(sides, bands, squeeze, turn));
        let view = View::orbit(Up::Y, 0.3, 0.2, distance, 50).focal(focal);
        let view = if parallel { view.parallel() } else { view };
        let stream = Look::new(Surface::metal([1.0; 3], [0.1, 0.5, 0.4], 20), view).stream(&parts).unwrap();
        prop_assert_eq!(difference(&stream, Size::new(width, height), Shader::Flat, (0..50).step_by(9)), 0);
    }
}
