//! No setting of a scene makes a frame several times as dear as its neighbours do: loops draw steep highlights and near lights, too.

use microphong::{
    format::{ErrorBudget, Gain, Length},
    stream::record::{DIRECTIONAL, Light, POINT},
};
use microphong_sim::{
    bench::{Bench, Processor, board_styles::Program},
    scene::{self, Scene},
    shader::Shader,
    stress::records::Records,
};

const PROCESSOR: Processor = Processor::CortexM3;

/// A built-in scene with a budget of 4, in which `change` changes the records.
fn scene(name: &str, change: impl FnOnce(&mut Records)) -> Scene {
    let scene = scene::load(name).unwrap();
    let mut records = Records::of(&scene.stream.parse().unwrap());
    change(&mut records);
    Scene { stream: records.written().unwrap().with_budget(ErrorBudget::from_num(4)), ..scene }
}

fn exponent(records: &mut Records, exponent: u16) {
    records.materials.iter_mut().for_each(|material| material.exponent = exponent);
}

/// One light, near the scene and in front of it.
fn near(records: &mut Records) {
    let [light, ..] = records.lights[..] else { unreachable!("the scenes have lights") };
    records.lights = vec![Light::new(POINT, 0, [1, 2, 2].map(Length::from_num), light.colour())];
}

/// Instructions of a frame by each of these methods.
fn counts(program: Program, scene: &Scene, shaders: &[Shader]) -> Vec<f64> {
    let wanted: Vec<_> = shaders.iter().map(|&shader| (PROCESSOR, shader)).collect();
    let bench = Bench::of_program(&[PROCESSOR], program).unwrap();
    bench.count(scene, &wanted, &|| ()).unwrap().iter().map(|found| found.instructions as f64).collect()
}

/// Once a highlight of the exponent 65 took three quarters more than one of 64.
#[test]
fn steep_highlights_take_few_instructions_more() {
    for name in ["teapot", "bunny"] {
        let count = |n| counts(Program::PLAIN, &scene(name, |records| exponent(records, n)), &[Shader::PHONG, Shader::AUTO]);
        let [usual, steep, steepest] = [64, 96, 256].map(count);
        for k in 0..2 {
            println!("{name} at exponents 64, 96 and 256: {:.0} {:.0} {:.0}", usual[k], steep[k], steepest[k]);
            assert!(steep[k] < 1.1 * usual[k] && steepest[k] < 1.7 * usual[k], "{name}");
        }
    }
}

/// Under a near light `auto` interpolates where that is exact enough. Once it took 19 times as many instructions on a low-poly building as `gouraud`.
#[test]
fn near_lights_leave_auto_a_choice() {
    for (name, most) in [("cottage", 0.7), ("lighthouse", 0.8), ("sailboat", 0.8)] {
        let scene = scene(name, near);
        let [phong, auto, gouraud] = counts(Program::VERTEX_COLOURS, &scene, &[Shader::PHONG, Shader::AUTO, Shader::GOURAUD])[..] else {
            unreachable!("three are wanted")
        };
        println!("{name} under a near light: phong {phong:.0}, auto {auto:.0}, gouraud {gouraud:.0}");
        assert!(auto < most * phong, "{name}: {auto} of {phong}");
    }
}

/// Near lights are added one by one. Once two of them, or one beside another light, took almost five times as many instructions as one.
#[test]
fn a_near_light_more_costs_about_as_much_as_the_first() {
    let more = |light: Light| {
        move |records: &mut Records| {
            near(records);
            records.lights.push(light);
        }
    };
    let grey = [Gain::from_num(0.3); 3];
    let count = |change: &dyn Fn(&mut Records)| counts(Program::PLAIN, &scene("teapot", change), &[Shader::PHONG])[0];
    let one = count(&near);
    let directional = count(&more(Light::new(DIRECTIONAL, 0, [-0.6, 0.0, 0.8].map(Length::from_num), grey)));
    let two = count(&more(Light::new(POINT, 0, [-1, 2, 2].map(Length::from_num), grey)));
    let local = count(&|records| {
        near(records);
        records.header.camera = records.header.camera.with_local_viewer();
    });
    println!("one near light {one:.0}, and a directional one {directional:.0}, and a near one {two:.0}, and a local viewer {local:.0}");
    assert!(directional < 2.0 * one && two < 2.7 * one && local < 2.5 * one);
}
