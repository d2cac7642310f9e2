//! The oracle by itself: closed forms, symmetries, continuity.

use microphong_sim::{
    oracle::{Facet, Frame, Levels, Light, Material, NAMES, Place, Unsupported, decides, method, outcomes, phong},
    scene,
    vector::{V3, add, dot, unit},
};

/// Methods that work on rows of the picture.
const ROWS: [&str; 6] = ["goldman", "slerp", "angular", "hybrid", "angular-original", "hybrid-original"];
/// Methods whose highlight is R·V, which only approximates N·H.
const REFLECTED: [&str; 3] = ["phong-rv", "environment", "goldman"];

fn frame(name: &str, number: u32) -> Frame {
    let scene = scene::load(name).unwrap();
    Frame::new(scene.stream.parse().unwrap(), scene.size, number)
}

/// One triangle under one light, seen along -z.
fn single(facet: Facet, light: Place, viewer: Place, exponent: f64) -> Frame {
    let material = Material { ambient: [0.05; 3], diffuse: [0.5, 0.4, 0.3], specular: [0.4; 3], exponent };
    Frame {
        size: (100, 100),
        facets: vec![facet],
        lights: vec![Light::even(light, [1.0, 0.9, 0.8])],
        viewer,
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        materials: vec![material],
        background: [[0.0; 3]; 2],
        is_gray: false,
    }
}

const SCREEN: [[f64; 2]; 3] = [[10.0, 20.0], [90.0, 30.0], [40.0, 95.0]];
/// Positions of the triangle's corners in space.
const POSITIONS: [V3; 3] = [[-0.8, 0.6, 0.0], [0.8, 0.4, 0.0], [-0.2, -0.9, 0.0]];
const TOWARDS_EYE: Place = Place::Far([0.0, 0.0, 1.0]);

/// Points of a triangle: inside, and on its edges.
fn points(facet: &Facet) -> impl Iterator<Item = [f64; 2]> {
    let [a, b, c] = facet.screen;
    let weights = (0..=6).flat_map(|i| (0..=6 - i).map(move |j| [f64::from(i), f64::from(j), f64::from(6 - i - j)].map(|w| w / 6.0)));
    weights.map(move |[u, v, w]| [0, 1].map(|k| u * a[k] + v * b[k] + w * c[k]))
}

fn distance(a: Levels, b: Levels) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// If normals are parallel, every method is exact: `ka + kd cos a + ks cos^e b`.
#[test]
fn parallel_normals_have_a_closed_form() {
    for degrees in [0.0f64, 30.0, 60.0, 80.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let facet = Facet::new(SCREEN, [0, 1, 2], [[0.0, 0.0, 1.0]; 3], POSITIONS);
        for exponent in [1.0, 5.0, 50.0] {
            let frame = single(facet.clone(), Place::Far([0.6 * sin, 0.8 * sin, cos]), TOWARDS_EYE, exponent);
            // The half vector halves the angle; the reflected light is as far from the eye as the light.
            let half = (degrees / 2.0).to_radians().cos().powf(exponent);
            let reflected = cos.powf(exponent / 4.0);
            for name in NAMES {
                let shade = method(name, &frame, &frame.facets[0]).unwrap();
                let highlight = if REFLECTED.contains(&name) { reflected } else { half };
                let material = &frame.materials[0];
                let exact = [0, 1, 2].map(|k| {
                    let sum =
                        material.ambient[k] + frame.lights[0].colour[k] * (material.diffuse[k] * cos + material.specular[k] * highlight);
                    (255.0 * sum).clamp(0.0, 255.0)
                });
                for p in points(&facet) {
                    assert!(distance(shade(p), exact) < 1e-6, "{name}, {degrees}°, e {exponent}: {:?}, not {exact:?}", shade(p));
                }
            }
        }
    }
}

/// A facet whose picture is moved: its corners are the same in space, and at other places on the screen.
fn moved(facet: &Facet, order: [usize; 3], place: impl Fn([f64; 2]) -> [f64; 2]) -> Facet {
    Facet {
        screen: order.map(|k| place(facet.screen[k])),
        inv_depth: order.map(|k| facet.inv_depth[k]),
        vertices: order.map(|k| facet.vertices[k]),
        normals: order.map(|k| facet.normals[k]),
        positions: order.map(|k| facet.positions[k]),
        albedos: facet.albedos.map(|albedos| order.map(|k| albedos[k])),
        ..facet.clone()
    }
}

/// Every method on every third facet of two scenes: the same as on its `change`d picture.
fn unchanged(order: [usize; 3], place: impl Fn([f64; 2]) -> [f64; 2], except: &[&str]) {
    for scene in ["sphere-168", "sphere-40", "triangle"] {
        let frame = frame(scene, 5);
        for facet in frame.facets.iter().step_by(3) {
            let changed = moved(facet, order, &place);
            for name in NAMES.into_iter().filter(|name| !except.contains(name)) {
                let (Ok(one), Ok(other)) = (method(name, &frame, facet), method(name, &frame, &changed)) else { continue };
                // Not on the edges: an end of a row may be above or below a corner by its last digit.
                let [x, y] = [0, 1].map(|k| facet.screen.iter().map(|corner| corner[k]).sum::<f64>() / 3.0);
                for p in points(facet).map(|[px, py]| [x + (px - x) * 0.98, y + (py - y) * 0.98]) {
                    let (a, b) = (one(p), other(place(p)));
                    assert!(distance(a, b) < 1e-6, "{name} on {scene}, triangle {}, {p:?}: {a:?} and {b:?}", facet.id);
                }
            }
        }
    }
}

#[test]
fn no_corner_is_special() {
    unchanged([1, 2, 0], |p| p, &[]);
    unchanged([2, 0, 1], |p| p, &[]);
}

/// Goldman's iteration runs from right to left.
#[test]
fn left_and_right_are_alike() {
    unchanged([0, 2, 1], |[x, y]| [256.0 - x, y], &["goldman"]);
}

#[test]
fn only_methods_on_rows_know_where_up_is() {
    let (sin, cos) = 0.7f64.sin_cos();
    unchanged([0, 1, 2], |[x, y]| [x * cos - y * sin, x * sin + y * cos], &ROWS);
}

/// Methods that are exact for parallel rays and unit normals; a stream's normals are of unit length but for 3e-5.
#[test]
fn newton_and_roots_give_phong() {
    for normalised in [true, false] {
        let mut frame = frame("sphere-374", 0);
        if normalised {
            frame.facets.iter_mut().for_each(|facet| facet.normals = facet.normals.map(|n| unit(n).unwrap()));
        }
        for name in ["renq-newton", "duff"] {
            let worst = frame.facets.iter().map(|facet| {
                let (shade, exact) = (method(name, &frame, facet).unwrap(), phong(&frame, facet));
                facet.pixels(frame.size).map(|p| p.map(|c| f64::from(c) + 0.5)).map(|p| distance(shade(p), exact(p))).fold(0.0, f64::max)
            });
            let worst = worst.fold(0.0, f64::max);
            println!("{name}, normalised {normalised}: {worst:.4}");
            assert!(worst < if normalised { 0.01 } else { 0.1 }, "{name}: {worst}");
        }
    }
}

#[test]
fn both_expansions_agree_under_constant_light() {
    let frame = frame("sphere-168", 3);
    for facet in &frame.facets {
        let [one, other] = ["taylor", "taylor-finite"].map(|name| method(name, &frame, facet).unwrap());
        points(facet).for_each(|p| assert!(distance(one(p), other(p)) < 1e-6));
    }
}

/// Neighbours meet at their edge.
#[test]
fn edges_do_not_show() {
    let jumps = |name: &str| !["flat", "pseudo-phong", "highlight-test", "six-point-centre", "taylor", "taylor-finite"].contains(&name);
    for scene in ["sphere-374", "dodecahedron"] {
        let frame = frame(scene, 0);
        let mut edges = 0;
        for (i, one) in frame.facets.iter().enumerate() {
            for other in &frame.facets[i + 1..] {
                let shared: Vec<_> = (0..3).filter(|&k| other.vertices.contains(&one.vertices[k])).map(|k| one.screen[k]).collect();
                let [a, b] = shared[..] else { continue };
                edges += 1;
                for name in NAMES.into_iter().filter(|name| jumps(name) && (*name == "slerp" || !ROWS.contains(name))) {
                    let (Ok(left), Ok(right)) = (method(name, &frame, one), method(name, &frame, other)) else { continue };
                    for k in 1..12 {
                        let p = [0, 1].map(|c| a[c] + (b[c] - a[c]) * f64::from(k) / 12.0);
                        let (l, r) = (left(p), right(p));
                        assert!(distance(l, r) < 1e-4, "{name} on {scene}, triangles {} and {}: {l:?} and {r:?}", one.id, other.id);
                    }
                }
            }
        }
        assert!(edges > 10);
    }
}

/// Normals that differ as much as they can, light from behind, eyes within the surface: numbers stay numbers.
#[test]
fn nothing_is_not_a_number() {
    let turns = [[[0.0, 0.0, 1.0]; 3], [[0.0, 0.0, -1.0]; 3], [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]]];
    let wide = [[1.0, 0.0, 0.0], [-0.5, 0.75f64.sqrt(), 0.0], [-0.5, -(0.75f64.sqrt()), 0.0]];
    let far = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]].map(Place::Far);
    let near = [POSITIONS[0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]].map(Place::Near);
    let flat = [[10.5, 20.5], [90.5, 20.5], [40.5, 20.5625]];
    for normals in turns.into_iter().chain([wide]) {
        for (light, viewer) in far.into_iter().chain(near).flat_map(|light| far.into_iter().chain(near).map(move |viewer| (light, viewer)))
        {
            for screen in [SCREEN, flat] {
                let frame = single(Facet::new(screen, [0, 1, 2], normals, POSITIONS), light, viewer, 50.0);
                for name in NAMES {
                    let Ok(shade) = method(name, &frame, &frame.facets[0]) else { continue };
                    for p in points(&frame.facets[0]).map(|p| [p[0] + 0.25, p[1] - 0.25]) {
                        let levels = shade(p);
                        assert!(
                            levels.iter().all(|level| (0.0..=255.0).contains(level)),
                            "{name}: {levels:?} {normals:?} {light:?} {viewer:?}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn close_decisions_have_several_outcomes() {
    let frame = frame("sphere-168", 0);
    for name in NAMES {
        let mut several = false;
        for facet in &frame.facets {
            let shade = method(name, &frame, facet).unwrap();
            for p in points(facet) {
                assert_eq!(outcomes(name, &frame, facet, p, 0.0).unwrap(), [shade(p)], "{name}");
                // One such place is enough.
                if !several {
                    // Rows of hardly any angle are rare: with a large margin, all of these decisions are close.
                    let margin = if ["angular", "hybrid"].iter().any(|rare| name.starts_with(rare)) { 1e9 } else { 0.5 };
                    let outcomes = outcomes(name, &frame, facet, p, margin).unwrap();
                    assert_eq!(outcomes[0], shade(p), "{name}");
                    several = outcomes.iter().any(|&outcome| outcome != outcomes[0]);
                }
            }
        }
        assert_eq!(several, decides(name), "{name}");
    }
    assert!(!decides("no such method"));
}

#[test]
fn near_lights_are_refused_by_name() {
    let frame = frame("sphere-40", 0);
    assert!(!frame.is_constant());
    let refused: Vec<_> = NAMES.into_iter().filter(|name| method(name, &frame, &frame.facets[0]).is_err()).collect();
    assert_eq!(refused, ["taylor", "goldman", "slerp"]);
    let reason = method("taylor", &frame, &frame.facets[0]).err().unwrap();
    assert!(reason.to_string().starts_with("taylor cannot draw point lights"), "{reason}");
    let unknown = method("tylor", &frame, &frame.facets[0]).err().unwrap();
    assert_eq!(unknown, Unsupported::Unknown("tylor".to_owned()));
}

/// One of Newton's steps per pixel is enough: rows of 8 pixels and more, normals up to 60 degrees apart.
#[test]
fn a_length_is_known_from_its_neighbour() {
    let normals = [-30.0f64, 30.0, 30.0].map(|degrees| [degrees.to_radians().sin(), 0.0, degrees.to_radians().cos()]);
    for (width, error) in [(8.0, 2e-3), (32.0, 2e-4)] {
        // The left edge has one normal, the right edge the other: all rows are alike but for their lengths.
        let facet = Facet::new([[0.0, 0.0], [width, -20.0], [width, 20.0]], [0, 1, 2], normals, POSITIONS);
        let mut frame = single(facet, TOWARDS_EYE, TOWARDS_EYE, 50.0);
        frame.materials[0] = Material { ambient: [0.0; 3], diffuse: [1.0; 3], specular: [0.0; 3], exponent: 50.0 };
        let facet = &frame.facets[0];
        let (found, exact) = (method("goldman", &frame, facet).unwrap(), phong(&frame, facet));
        let errors = (0..width as u32).map(|x| [f64::from(x) + 0.5, 0.0]).map(|p| distance(found(p), exact(p)) / 255.0);
        let worst = errors.fold(0.0, f64::max);
        assert!((error / 20.0..error).contains(&worst), "{width}: {worst}");
    }
}

/// Triangles of 8, 16, 32 ... pixels are split 0, 1, 2 ... times.
#[test]
fn pseudo_phong_counts_pixels() {
    let normals = [[-0.4, 0.3, 1.0], [0.5, 0.2, 1.0], [0.0, -0.6, 1.0]].map(|n| unit(n).unwrap());
    let levels = |name: &str, longest: f64| {
        // A right-angled triangle of the sides 3, 4, 5.
        let facet = Facet::new([[0.0, 0.0], [0.8 * longest, 0.0], [0.0, 0.6 * longest]], [0, 1, 2], normals, POSITIONS);
        let frame = single(facet, Place::Far(unit([-0.4, 0.5, 0.77]).unwrap()), TOWARDS_EYE, 50.0);
        let shade = method(name, &frame, &frame.facets[0]).unwrap();
        [[0.3, 0.3], [0.1, 0.2], [0.21, 0.09], [0.5, 0.05]].map(|p| shade(p.map(|c| c * longest)))
    };
    for (longest, name) in [(7.999, "gouraud"), (8.001, "gouraud4"), (15.999, "gouraud4")] {
        let (one, other) = (levels("pseudo-phong", longest), levels(name, longest));
        assert!(one.iter().zip(other).all(|(&a, b)| distance(a, b) < 1e-9), "{longest} {name}: {one:?} {other:?}");
    }
    // Finer and finer, until 6 splits are reached.
    let error = |longest: f64| {
        let pairs = levels("pseudo-phong", longest).into_iter().zip(levels("phong", longest));
        pairs.map(|(a, b)| distance(a, b)).fold(0.0, f64::max)
    };
    let errors = [6.0, 12.0, 24.0, 48.0, 96.0, 192.0, 384.0, 768.0].map(error);
    assert!(errors[1..7].windows(2).all(|e| e[1] < e[0]) && errors[6] == errors[7] && errors[6] < 0.1, "{errors:?}");
}

/// No highlight is missed: light that counts as dark is dark, and most of a sphere counts as dark.
#[test]
fn no_highlight_is_missed() {
    let mut frame = frame("sphere-690", 0);
    frame.materials[0].exponent = 50.0;
    let mut shiny = frame.clone();
    shiny.materials[0] = Material { ambient: [0.0; 3], diffuse: [0.0; 3], specular: [1.0; 3], exponent: 50.0 };
    let mut dark = 0;
    for (facet, bare) in frame.facets.iter().zip(&shiny.facets) {
        let [tested, gouraud, exact] = ["highlight-test", "gouraud", "phong"].map(|name| method(name, &frame, facet).unwrap());
        if points(facet).all(|p| tested(p) == gouraud(p)) {
            dark += 1;
            points(facet).for_each(|p| assert!(phong(&shiny, bare)(p)[0] < 255.0 * (-8.0f64).exp(), "triangle {}", facet.id));
        } else {
            points(facet).for_each(|p| assert_eq!(tested(p), exact(p)));
        }
    }
    let share = f64::from(dark) / frame.facets.len() as f64;
    assert!((0.6..0.9).contains(&share), "{share}");
}

/// The highlight stays where it is, whichever of both formulas draws it, if light, eye and normal lie in a plane.
#[test]
fn reflection_and_half_vector_agree_on_the_mirror_direction() {
    let light = unit([-0.4, 0.5, 0.77]).unwrap();
    let half = unit(add(light, [0.0, 0.0, 1.0])).unwrap();
    let frame = single(Facet::new(SCREEN, [0, 1, 2], [half; 3], POSITIONS), Place::Far(light), TOWARDS_EYE, 50.0);
    let [blinn, reflected] = ["phong", "phong-rv"].map(|name| method(name, &frame, &frame.facets[0]).unwrap()([50.0, 50.0]));
    assert!(distance(blinn, reflected) < 1e-9 && dot(half, light) < 1.0);
}
