//! Interpolation in perspective: right to the arithmetic, and no different where there is no perspective.

use embedded_graphics::{pixelcolor::Rgb888, prelude::Size};
use microphong::{Layout, RenderError, Renderer, renderer::check};
use microphong_sim::{
    level,
    look::{Lamp, Look, Surface},
    mesh::Mesh,
    oracle::{Frame, Levels, method},
    quantise::quantise,
    render::{self, Style},
    scene::{self, Scene},
    shader::Shader,
    shapes,
    vector::{V3, product, rotation, unit},
    view::View,
};
use std::{sync::Mutex, thread};

fn correct(shader: Shader) -> Style {
    Style { perspective_correct: true, ..shader.into() }
}

/// Largest difference allowed between integers and floating point, in 1/255.
const LIMIT: f64 = 0.5;
/// Frames of the orbit.
const FRAMES: u32 = 6;
/// One in this number of pixels is compared, others in each frame.
const SAMPLE: usize = 7;

/// A scene seen by an eye that is much closer than any built-in one.
fn close(name: &str, mesh: &Mesh, view: View, lamps: Vec<Lamp>, local_viewer: bool) -> Scene {
    let mut look = Look::new(Surface::plastic([0.9, 0.6, 0.3], [0.1, 0.5, 0.4], 20), view);
    look.local_viewer = local_viewer;
    look.lamps = lamps;
    Scene { name: name.to_owned(), stream: look.stream(&quantise(mesh).0).unwrap(), size: (320, 240) }
}

/// A square of two triangles that reaches from the eye's feet to the far, its normals bulged by `bulge`.
fn floor(bulge: f64) -> Mesh {
    let positions: Vec<V3> = vec![[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]];
    let normals = positions.iter().filter_map(|[x, _, z]| unit([bulge * x, 1.0, bulge * z])).collect();
    Mesh { positions, normals, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
}

fn upright(tilt: f64, distance: f64) -> View {
    let rows = product(&rotation([1.0, 0.0, 0.0], tilt), &rotation([0.0, 1.0, 0.0], 0.2));
    View::facing(rows, distance, [0.0, 1.0, 0.0], 120)
}

/// The eye close to a dodecahedron, to a floor and to a triangle lying down: depths of one triangle 1 to 4 and more.
fn close_scenes() -> Vec<Scene> {
    let distant = || vec![Lamp::distant([-0.2, 0.7, 0.3], [1.0; 3])];
    let near = || vec![Lamp::near([-1.2, 1.6, 0.4], [1.0, 0.9, 0.8]), Lamp::distant([0.6, 0.5, -0.6], [0.2, 0.3, 0.4])];
    let with = |view: View, near: f64, focal: f64| View { near, ..view.focal(focal) };
    let flat = with(upright(0.35, 1.8), 0.1, 1.1);
    // Turns about the line of sight of an upright one: it has no back to show.
    let lying = with(View { axis: [0.0, 0.0, 1.0], ..upright(-1.1, 1.5) }, 0.1, 1.0);
    let ball = with(upright(0.3, 1.15), 0.05, 0.9);
    let mut metal = close("floor, metal", &floor(0.5), flat, distant(), false);
    let mut look = Look::new(Surface::metal([1.0; 3], [0.08, 0.47, 0.45], 50), flat);
    look.lamps = distant();
    metal.stream = look.stream(&quantise(&floor(0.5)).0).unwrap();
    vec![
        metal,
        close("floor", &floor(0.5), flat, distant(), false),
        close("floor, near light", &floor(0.3), flat, near(), true),
        close("dodecahedron", &shapes::dodecahedron(), ball, distant(), false),
        close("dodecahedron, near light", &shapes::dodecahedron(), ball, near(), true),
        close("triangle", &shapes::bulged_triangle(), lying, near(), true),
    ]
}

fn size(scene: &Scene) -> Size {
    Size::new(scene.size.0, scene.size.1)
}

/// Largest difference of `levels` from `exact`. If all channels have one level, it is the brightest channel's.
fn difference(levels: [f64; 3], exact: Levels) -> f64 {
    let all = (0..3).map(|k| (levels[k] - exact[k]).abs()).fold(0.0, f64::max);
    let one = levels[0] == levels[1] && levels[1] == levels[2];
    if one { all.min((levels[0] - exact.into_iter().fold(0.0, f64::max)).abs()) } else { all }
}

/// Largest difference, and its mean square, of a picture to what the oracle's `name` makes of `frame`.
fn errors(scene: &Scene, frame: &Frame, picture: &[Option<[f64; 3]>], name: &str, every: usize, first: usize) -> (f64, f64) {
    let shades: Vec<_> = frame.facets.iter().map(|facet| method(name, frame, facet).unwrap()).collect();
    let (mut worst, mut squares, mut count) = (0f64, 0.0, 0);
    for (i, (levels, sights)) in picture.iter().zip(frame.visible()).enumerate().skip(first % every).step_by(every) {
        let Some(levels) = *levels else { continue };
        let centre = [i as u32 % scene.size.0, i as u32 / scene.size.0].map(|c| f64::from(c) + 0.5);
        let error = sights.iter().flatten().map(|&c| difference(levels, shades[c as usize](centre))).fold(f64::MAX, f64::min);
        // Clipped triangles have no candidates.
        if error < f64::MAX {
            (worst, squares, count) = (worst.max(error), squares + error * error, count + 1);
        }
    }
    (worst, squares / f64::from(count.max(1)))
}

fn number(scene: &Scene, k: u32) -> u32 {
    k * u32::from(scene.stream.parse().unwrap().header.camera.period.max(1)) / FRAMES
}

#[test]
fn integers_follow_the_perspective() {
    let built_in = scene::NAMES.iter().map(|name| scene::load(name).unwrap());
    let scenes: Vec<Scene> = close_scenes().into_iter().chain(built_in).collect();
    let jobs = Mutex::new(scenes.iter().flat_map(|scene| (0..FRAMES).map(move |k| (scene, number(scene, k)))));
    let worst = Mutex::new(vec![(0.0, String::new()); Shader::ALL.len()]);
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let job = jobs.lock().unwrap().next();
                    let Some((scene, number)) = job else { break };
                    let stream = scene.stream.parse().unwrap();
                    let frame = Frame::perspective_correct(stream, scene.size, number);
                    for (k, &shader) in Shader::ALL.iter().enumerate() {
                        // Where a picture without perspective is right, others compare it.
                        if check(&stream, shader.facts(), true).is_err() || !shader.facts().perspective || !stream.is_perspective() {
                            continue;
                        }
                        let picture = level::picture(stream, size(scene), correct(shader), number).unwrap();
                        let (error, _) = errors(scene, &frame, &picture, shader.name(), SAMPLE, number as usize);
                        let mut worst = worst.lock().unwrap();
                        if error > worst[k].0 {
                            worst[k] = (error, format!("{}, frame {number}", scene.name));
                        }
                    }
                }
            });
        }
    });
    let worst = worst.into_inner().unwrap();
    for (shader, (error, place)) in Shader::ALL.iter().zip(&worst).filter(|(shader, _)| shader.facts().perspective) {
        println!("{:20} {error:.3} LSB at most, on {place}", shader.name());
    }
    // The oracle's `auto` is Phong shading, from which it may be off by its budget.
    let limit = |shader: Shader| if shader.keeps_budget() { 1.0 + LIMIT } else { LIMIT };
    assert!(worst.iter().zip(Shader::ALL).all(|(&(error, _), shader)| error <= limit(shader)), "a method is more than {LIMIT} LSB off");
}

/// The triangles of the close scenes reach far enough for correction to matter: each method is compared with its value at the point that is seen.
#[test]
fn correction_comes_closer_to_the_truth() {
    for scene in close_scenes() {
        let stream = scene.stream.parse().unwrap();
        let frame = Frame::perspective_correct(stream, scene.size, 0);
        let ratio = frame.facets.iter().map(|f| {
            let (least, most) = f.inv_depth.iter().fold((f64::MAX, 0.0f64), |(l, m), &n| (l.min(n), m.max(n)));
            most / least
        });
        let ratio = ratio.fold(0.0, f64::max);
        assert!(ratio > 3.0, "{}: depths 1 to {ratio}", scene.name);
        println!("{}: depths 1 to {ratio:.1}", scene.name);
        for shader in Shader::ALL.into_iter().filter(|&shader| check(&stream, shader.facts(), true).is_ok() && shader != Shader::FLAT) {
            let [affine, correct] = [shader.into(), correct(shader)].map(|method| {
                let picture = level::picture(stream, size(&scene), method, 0).unwrap();
                errors(&scene, &frame, &picture, shader.name(), 1, 0)
            });
            let [without, with] = [affine.1, correct.1].map(f64::sqrt);
            println!("    {:16} without {:.2} at most, {without:.2} rms; with {:.2}, {with:.2}", shader.name(), affine.0, correct.0);
            assert!(with < 0.1 && without > 1.0, "{}, {}", scene.name, shader.name());
        }
    }
}

/// Where triangles reach far, six points on the screen are nearer to Phong shading than six points in space that are interpolated as if there were no
/// perspective.
#[test]
fn six_points_on_the_screen_are_better() {
    for scene in close_scenes() {
        let stream = scene.stream.parse().unwrap();
        let [plain, seen] = [Frame::new(stream, scene.size, 0), Frame::perspective_correct(stream, scene.size, 0)];
        let exact: Vec<_> = seen.facets.iter().map(|facet| method("phong", &seen, facet).unwrap()).collect();
        let rms = |frame: &Frame| {
            let shades: Vec<_> = frame.facets.iter().map(|facet| method("six-point", frame, facet).unwrap()).collect();
            let pixels = seen.visible().into_iter().enumerate().filter_map(|(i, sights)| {
                let (facet, i) = (*sights.iter().flatten().next()? as usize, i as u32);
                let centre = [i % scene.size.0, i / scene.size.0].map(|c| f64::from(c) + 0.5);
                let (a, b) = (exact[facet](centre), shades[facet](centre));
                Some((0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max).powi(2))
            });
            let squares: Vec<f64> = pixels.collect();
            (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
        };
        let [plain, seen] = [rms(&plain), rms(&seen)];
        println!("{:28} {plain:.2} -> {seen:.2} of 255", scene.name);
        assert!(seen < 0.85 * plain, "{}: {seen}, in place of {plain}", scene.name);
    }
}

#[test]
fn parallel_rays_make_no_difference() {
    for name in ["sphere-168", "torus"] {
        let scene = scene::load(name).unwrap();
        let stream = scene.stream.parse().unwrap();
        assert!(!stream.is_perspective());
        for shader in Shader::ALL.into_iter().filter(|&shader| check(&stream, shader.facts(), false).is_ok()) {
            let size = Size::new(100, 80);
            let (plain, stats) = render::frame::<Rgb888>(stream, size, shader, 16, 7).unwrap();
            let correct = render::frame::<Rgb888>(stream, size, correct(shader), 16, 7).unwrap();
            assert!((plain, stats) == correct, "{name}, {}", shader.name());
        }
    }
}

#[test]
fn bands_change_nothing() {
    for scene in close_scenes() {
        let stream = scene.stream.parse().unwrap();
        for shader in Shader::ALL.into_iter().filter(|&shader| check(&stream, shader.facts(), true).is_ok()) {
            for dither in [false, true] {
                let frame = |rows| {
                    let style = Style { dither, ..correct(shader) };
                    render::frame::<Rgb888>(stream, Size::new(120, 90), style, rows, 3).unwrap().0
                };
                let whole = frame(90);
                for rows in [1, 7, 32] {
                    assert!(frame(rows) == whole, "{}, {}: bands of {rows} rows", scene.name, shader.name());
                }
            }
        }
    }
}

/// One colour per triangle is the same from everywhere.
#[test]
fn flat_stays_flat() {
    for scene in close_scenes() {
        let stream = scene.stream.parse().unwrap();
        for dither in [false, true] {
            let draw = |style: Style| render::frame::<Rgb888>(stream, size(&scene), Style { dither, ..style }, 16, 5).unwrap();
            assert!(draw(Shader::FLAT.into()) == draw(correct(Shader::FLAT)), "{}", scene.name);
        }
    }
}

#[test]
fn what_cannot_be_corrected_is_refused() {
    let scene = scene::load("teapot").unwrap();
    let stream = scene.stream.parse().unwrap();
    let layout = Layout::new(64, 1).vertices(1).triangles(1).active_triangles(0);
    let mut memory = vec![0; layout.words::<Rgb888>()];
    let mut renderer = Renderer::<Rgb888>::new(stream, Size::new(64, 64), &layout, &mut memory, &Shader::ALL.map(Shader::on)).unwrap();
    let mut refused = Vec::new();
    for shader in Shader::ALL {
        renderer.set_perspective_correct(false).unwrap();
        renderer.set_shader(shader.on()).unwrap();
        let result = renderer.set_perspective_correct(true);
        assert_eq!(result.is_ok(), shader.facts().perspective, "{}", shader.name());
        if let Err(error) = result {
            assert_eq!(error, RenderError::Perspective { shader: shader.name() });
            assert_eq!(error.to_string(), format!("{} cannot interpolate light in perspective; use another shading method", shader.name()));
            // The other way round: the method in use stays.
            renderer.set_shader(Shader::PHONG.on()).unwrap();
            renderer.set_perspective_correct(true).unwrap();
            assert_eq!(renderer.set_shader(shader.on()), Err(error));
            assert_eq!(renderer.shader().facts(), Shader::PHONG.facts());
            refused.push(shader);
        }
    }
    assert_eq!(refused.len(), 10);
}
