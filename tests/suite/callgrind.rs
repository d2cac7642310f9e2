//! Counts of x86-64 by callgrind: the same in every run, in any company, and of the whole frame.

use microphong_sim::{
    bench::callgrind::{Frame, build, count},
    scene,
    shader::Shader,
};
use microphong_tests::named;

const SIZE: (u32, u32) = (320, 240);

fn frame(shader: Shader) -> Frame {
    Frame { size: SIZE, band_rows: SIZE.1, shader }
}

#[test]
fn two_runs_count_the_same() {
    let program = build().expect("the program that draws");
    let scene = scene::load("teapot").expect("a scene");
    let stream = scene.stream.as_bytes();
    let frames = [Shader::FLAT, Shader::SIX_POINT, Shader::PHONG].map(frame);
    let first = count(&program, stream, &frames).expect("counts");
    // Elsewhere in the process, too.
    let mut reversed = count(&program, stream, &[frames[2], frames[1], frames[0]]).expect("counts");
    reversed.reverse();
    assert_eq!(first, reversed);

    for count in &first {
        let stages = count.stages;
        for stage in [stages.frame, stages.vertex, stages.cull, stages.setup, stages.span, stages.pixel, stages.clear] {
            assert!(stage > 0, "{count:?}");
        }
        assert!(count.spans > count.triangles && count.pixels > count.spans, "{count:?}");
    }
    let [flat, six, phong] = first.iter().map(|count| count.stages.pixel).collect::<Vec<_>>()[..] else { panic!("three frames") };
    assert!(flat < six && six < phong, "inner loops of {flat}, {six} and {phong} instructions");
}

#[test]
fn what_cannot_be_drawn_is_named() {
    let program = build().expect("the program that draws");
    let near = scene::load("sphere-40").expect("a scene");
    let error = count(&program, near.stream.as_bytes(), &[frame(named("slerp"))]).expect_err("it needs distant lights");
    assert!(format!("{error:#}").contains("directional lights"), "{error:#}");
}
