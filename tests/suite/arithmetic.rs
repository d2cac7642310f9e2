//! Integers against the same method in 64-bit floating point: every method, every pixel of every scene, all around.

use microphong::stream::{
    record::{Header, Light, Material, OBJECT_SPACE, POINT},
    seal,
};
use microphong_sim::{
    bytes::StreamBytes,
    oracle::{Frame, Sight, decides},
    scene::{self, Scene},
    shader::Shader,
    stress::{arithmetic, case::Case},
};
use std::{sync::Mutex, thread};
use zerocopy::IntoBytes;

/// Largest difference of a method without decisions, in 1/255: the table of highlights, above all.
const ERROR: f64 = 0.30;
/// Largest difference of a method that decides by a threshold, in 1/255.
const DECIDING_ERROR: f64 = 0.48;
/// Largest difference of any method on materials that are lifted above white, in 1/255.
const BRIGHT_ERROR: f64 = 0.30;
/// Largest difference of Phong shading under a near light or for a near viewer, in 1/255: at the exponent 1024, by what rounds at the nodes of the
/// general way.
const LOCAL_ERROR: f64 = 0.40;
/// Frames of the orbit. Errors differ more from pixel to pixel than from frame to frame, so all pixels of few frames are compared; `stress`
/// looks at other scenes for a minute.
const FRAMES: u32 = 9;
/// Frames of the orbit if `MICROPHONG_ALL=1`.
const ALL_FRAMES: u32 = 36;
/// Largest difference in one frame of each method, before the output format rounds.
fn errors(scene: &Scene, number: u32) -> Vec<f64> {
    let stream = scene.stream.parse().unwrap();
    let frame = Frame::new(stream, scene.size, number);
    let visible = frame.visible();
    Shader::ALL.iter().map(|&shader| error(scene, &frame, &visible, shader, number)).collect()
}

fn error(scene: &Scene, frame: &Frame, visible: &[Vec<Sight>], shader: Shader, number: u32) -> f64 {
    let case = Case { size: [scene.size.0, scene.size.1], frame: number, style: shader.into(), ..Case::new(scene.stream.clone()) };
    // A method that cannot draw the scene makes no error.
    arithmetic::of(&case, frame, visible).unwrap_or(0.0)
}

#[test]
fn integers_follow_their_method() {
    let frames = if std::env::var_os("MICROPHONG_ALL").is_some_and(|v| v == "1") { ALL_FRAMES } else { FRAMES };
    let scenes: Vec<Scene> = scene::NAMES.iter().map(|name| scene::load(name).unwrap()).collect();
    let jobs = Mutex::new(scenes.iter().flat_map(|scene| (0..frames).map(move |k| (scene, k))));
    let worst = Mutex::new(vec![(0.0, ""); Shader::ALL.len()]);
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let job = jobs.lock().unwrap().next();
                    let Some((scene, k)) = job else { break };
                    let period = scene.stream.parse().unwrap().header.camera.period.max(1);
                    let errors = errors(scene, k * u32::from(period) / frames);
                    for (worst, error) in worst.lock().unwrap().iter_mut().zip(errors) {
                        if error > worst.0 {
                            *worst = (error, &scene.name);
                        }
                    }
                }
            });
        }
    });
    let worst = worst.into_inner().unwrap();
    for (shader, (error, place)) in Shader::ALL.iter().zip(&worst) {
        println!("{:20} {error:.3} LSB at most, on {place}", shader.name());
    }
    for (shader, (error, place)) in Shader::ALL.iter().zip(&worst) {
        let limit = if decides(shader.name()) { DECIDING_ERROR } else { ERROR };
        assert!(*error <= limit, "{}: {error} LSB on {place}, at most {limit} are allowed", shader.name());
    }
}

/// A light brighter than full, on a material that it lifts above white.
#[test]
fn bright_lights_are_clamped_at_the_end() {
    let mut scene = scene::load("sphere-168").unwrap();
    let mut bytes = scene.stream.as_bytes().to_vec();
    let stream = scene.stream.parse().unwrap();
    let place = |record: *const u8| record as usize - scene.stream.as_bytes().as_ptr() as usize;
    for light in stream.lights {
        let bright = Light { colour: light.colour.map(|c| (u32::from(c) * 8 / 5) as u16), ..*light };
        bytes[place((&raw const *light).cast())..][..size_of::<Light>()].copy_from_slice(bright.as_bytes());
    }
    for material in stream.materials {
        let matte = Material {
            diffuse: material.diffuse.map(|c| (u32::from(c) * 8 / 5) as u16),
            specular: material.specular.map(|c| c / 10),
            ..*material
        };
        bytes[place((&raw const *material).cast())..][..size_of::<Material>()].copy_from_slice(matte.as_bytes());
    }
    seal(&mut bytes);
    scene.stream = StreamBytes::from(&bytes[..]);
    for (shader, error) in Shader::ALL.iter().zip(errors(&scene, 7)) {
        println!("{:20} {error:.3} LSB at most", shader.name());
        assert!(error <= BRIGHT_ERROR, "{}: {error} LSB", shader.name());
    }
}

/// A near viewer of directional light, a near light under an infinitely far viewer, for which methods may have loops, and both near, with highlights of
/// all widths. If both are near, they may be opposite at a pixel, where rounding decides: such pixels are judged by their sensitivity.
#[test]
fn near_lights_and_viewers_are_as_exact() {
    let cases = ["teapot", "peer-sphere-plastic", "bunny"]
        .into_iter()
        .flat_map(|name| [[true, false], [false, true], [true; 2]].map(|near| (name, near)));
    for (name, [near_light, near_viewer]) in cases {
        for exponent in [1, 8, 9, 30, 64, 65, 300, 1024] {
            let mut scene = scene::load(name).unwrap();
            let mut bytes = scene.stream.as_bytes().to_vec();
            let stream = scene.stream.parse().unwrap();
            let place = |record: *const u8| record as usize - scene.stream.as_bytes().as_ptr() as usize;
            let camera = if near_viewer { stream.header.camera.with_local_viewer() } else { stream.header.camera };
            let header = Header { camera, ..*stream.header };
            bytes[place((&raw const *stream.header).cast())..][..size_of::<Header>()].copy_from_slice(header.as_bytes());
            for material in stream.materials {
                let material_of = Material { exponent, ..*material };
                bytes[place((&raw const *material).cast())..][..size_of::<Material>()].copy_from_slice(material_of.as_bytes());
            }
            if near_light {
                for light in stream.lights {
                    // In the direction of the directional light.
                    let near = Light { kind: POINT, space: OBJECT_SPACE, vector: light.vector.map(|c| c * 5 / 2), ..*light };
                    bytes[place((&raw const *light).cast())..][..size_of::<Light>()].copy_from_slice(near.as_bytes());
                }
            }
            seal(&mut bytes);
            scene.stream = StreamBytes::from(&bytes[..]);
            let stream = scene.stream.parse().unwrap();
            for number in [0, 40] {
                let frame = Frame::new(stream, scene.size, number);
                let visible = frame.visible();
                for shader in [Shader::PHONG, Shader::AUTO] {
                    let error = if near_light && near_viewer {
                        let size = [scene.size.0, scene.size.1];
                        let case = Case { size, frame: number, style: shader.into(), ..Case::new(scene.stream.clone()) };
                        let found = arithmetic::judge(&case).unwrap();
                        assert!(found.strictly > 3 * (found.leniently + found.not_judged), "{name}: {found:?}");
                        found.error
                    } else {
                        error(&scene, &frame, &visible, shader, number)
                    };
                    println!("{name:20} {near_light:5} {near_viewer:5} {exponent:5} {number:3} {:5} {error:.3} LSB", shader.name());
                    assert!(error <= LOCAL_ERROR, "{name}, exponent {exponent}, frame {number}: {error} LSB");
                }
            }
        }
    }
}
