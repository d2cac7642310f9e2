//! The errors of the methods against per-pixel Phong shading, as prototypes measured them before there was a product.
//!
//! The oracle draws the same scenes from formulas, without a stream: a parallel projection, half diffuse and half
//! specular light, no ambient light. Each triangle is measured on all pixels it covers, hidden or not.

use microphong_sim::{
    mesh::Mesh,
    oracle::{Facet, Frame, Light, Material, Place, method, phong},
    shapes,
    vector::{V3, apply, product, rotation, unit},
};

/// What the prototypes measured: largest error and root mean square, in 1/255.
type Measured = (f64, f64);

/// The scenes, with their exponents.
const SCENES: [(&str, f64); 6] =
    [("sphere-168", 5.0), ("sphere-168", 50.0), ("sphere-374", 50.0), ("sphere-690", 50.0), ("torus", 50.0), ("dodecahedron", 20.0)];

/// The prototypes' table, one column per scene.
const EXPECTED: [(&str, [Measured; 6]); 16] = [
    ("flat", [(76.0, 17.0), (82.0, 14.0), (90.0, 10.0), (75.0, 7.7), (85.0, 5.7), (156.0, 38.0)]),
    ("gouraud", [(26.0, 7.3), (85.0, 10.6), (63.0, 7.2), (34.0, 4.2), (38.0, 3.2), (132.0, 25.0)]),
    ("gouraud4", [(8.9, 2.0), (42.0, 4.1), (27.0, 2.1), (15.0, 1.3), (13.0, 0.9), (72.0, 11.5)]),
    ("six-point", [(6.8, 0.9), (33.0, 3.6), (20.0, 1.6), (9.3, 0.8), (7.1, 0.6), (67.0, 13.0)]),
    ("six-point-centre", [(5.6, 0.8), (9.5, 1.0), (9.8, 0.8), (9.3, 0.7), (4.6, 0.3), (26.0, 2.6)]),
    ("six-point-adaptive", [(1.4, 0.2), (1.5, 0.2), (1.5, 0.2), (1.7, 0.1), (1.4, 0.1), (1.9, 0.3)]),
    ("cubic", [(3.8, 0.3), (12.0, 1.3), (6.1, 0.4), (2.1, 0.2), (1.7, 0.1), (36.0, 5.7)]),
    ("taylor-finite", [(7.1, 0.4), (12.0, 0.4), (6.1, 0.1), (1.5, 0.05), (2.3, 0.04), (163.0, 15.0)]),
    ("sqrt6", [(0.8, 0.2), (2.4, 0.24), (0.5, 0.07), (0.19, 0.03), (0.15, 0.02), (13.0, 3.4)]),
    ("renq", [(0.7, 0.08), (3.0, 0.20), (0.8, 0.04), (0.27, 0.01), (0.16, 0.01), (10.0, 1.5)]),
    ("renq-newton", [(0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (16.0, 2.6)]),
    ("duff", [(0.01, 0.0), (0.09, 0.0), (0.09, 0.0), (0.08, 0.0), (0.08, 0.0), (16.0, 2.6)]),
    ("hybrid", [(2.3, 0.7), (2.5, 0.35), (2.0, 0.3), (2.0, 0.3), (1.9, 0.2), (21.0, 3.8)]),
    ("environment", [(127.0, 17.0), (127.0, 7.0), (126.0, 4.7), (127.0, 3.7), (127.0, 2.7), (132.0, 20.0)]),
    ("blinn", [(17.0, 2.3), (16.0, 2.9), (12.0, 1.5), (8.7, 1.0), (7.6, 0.8), (34.0, 13.0)]),
    ("quadratic-blinn", [(2.0, 0.3), (1.2, 0.2), (0.9, 0.08), (0.4, 0.03), (0.25, 0.03), (16.0, 3.9)]),
];

/// A scene as the prototypes have it: `z` runs towards the eye.
fn scene(name: &str, exponent: f64) -> Frame {
    let (mesh, side, [tilt, turn]) = match name {
        "sphere-168" => (shapes::sphere(12, 8, 0.0), 256, [0.5, 0.35]),
        "sphere-374" => (shapes::sphere(17, 12, 0.0), 256, [0.5, 0.35]),
        "sphere-690" => (shapes::sphere(23, 16, 0.0), 256, [0.5, 0.35]),
        "torus" => (shapes::torus(75, 25), 320, [0.7, 0.4]),
        _ => (shapes::dodecahedron(), 256, [0.3, 0.2]),
    };
    let near = name == "dodecahedron";
    let light = if near { Place::Near([-0.9, 1.0, 2.0]) } else { Place::Far(unit([-0.4, 0.5, 0.77]).unwrap()) };
    let grey = |share: f64| [share; 3];
    Frame {
        size: (side, side),
        facets: facets(&mesh, &product(&rotation([1.0, 0.0, 0.0], tilt), &rotation([0.0, 1.0, 0.0], turn)), f64::from(side)),
        lights: vec![Light { place: light, colour: grey(1.0) }],
        viewer: if near { Place::Near([0.0, 0.0, 4.0]) } else { Place::Far([0.0, 0.0, 1.0]) },
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        materials: vec![Material { ambient: grey(0.0), diffuse: grey(0.5), specular: grey(0.5), exponent }],
    }
}

/// The front faces of a turned mesh.
fn facets(mesh: &Mesh, rows: &[V3; 3], side: f64) -> Vec<Facet> {
    let turned = |v: &[V3]| v.iter().map(|&v| apply(rows, v)).collect::<Vec<_>>();
    let (positions, normals) = (turned(&mesh.positions), turned(&mesh.normals));
    let place = |[x, y, _]: V3| [side / 2.0 + x * side * 0.46, side / 2.0 - y * side * 0.46];
    let facet = |&[a, b, c]: &[usize; 3]| {
        let vertices = [a, c, b];
        let [p, q, r] = vertices.map(|v| place(positions[v]));
        let area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        (area > 1e-6).then(|| Facet::new([p, q, r], vertices, vertices.map(|v| normals[v]), vertices.map(|v| positions[v])))
    };
    mesh.triangles.iter().filter_map(facet).collect()
}

/// Largest and root mean square difference to Phong.
fn errors(frame: &Frame, name: &str) -> Measured {
    let (mut worst, mut square, mut count) = (0f64, 0f64, 0u32);
    for facet in &frame.facets {
        let (shade, exact) = (method(name, frame, facet, 0.0).unwrap(), phong(frame, facet));
        for pixel in facet.pixels(frame.size) {
            let centre = pixel.map(|c| f64::from(c) + 0.5);
            let error = shade(centre)[0] - exact(centre)[0];
            assert!(error.is_finite(), "{name} at {centre:?}");
            worst = worst.max(error.abs());
            square += error * error;
            count += 1;
        }
    }
    (worst, (square / f64::from(count)).sqrt())
}

#[test]
fn errors_are_those_of_the_prototypes() {
    let close = |measured: f64, expected: f64, slack: f64| (measured - expected).abs() <= (0.15 * expected).max(slack);
    let mut deviations = Vec::new();
    for (k, (scene_name, exponent)) in SCENES.into_iter().enumerate() {
        let frame = scene(scene_name, exponent);
        for (name, expected) in EXPECTED {
            let (measured, expected) = (errors(&frame, name), expected[k]);
            let ok = close(measured.0, expected.0, 0.3) && close(measured.1, expected.1, 0.1);
            println!(
                "{scene_name:12} e {exponent:2} {name:20} {:7.2} /{:6.2}, prototype {:6.2} /{:5.2} {}",
                measured.0,
                measured.1,
                expected.0,
                expected.1,
                if ok { "" } else { "DEVIATES" }
            );
            if !ok {
                deviations.push(format!("{scene_name} {exponent} {name}: {measured:.2?}, not {expected:?}"));
            }
        }
    }
    assert!(deviations.is_empty(), "{deviations:#?}");
}
