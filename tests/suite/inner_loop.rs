//! The inner loops stay at the limit of the machine: instructions counted in an emulated Cortex-M3.

use microphong_sim::{
    bench::{Bench, Processor},
    scene,
    shader::Shader,
};
use microphong_tests::named;

/// A depth-tested quadratic takes 13 instructions a pixel, as many as written by hand; a plane one fewer, a
/// constant 9. A root and two products make it 31 in a kernel, two quadratics and the highlight's table 26, but 28 and 20 on
/// average: there are triangles without a highlight.
#[test]
fn loops_are_as_short_as_by_hand() {
    let limits = [
        (Shader::FLAT, 9),
        (Shader::GOURAUD, 12),
        (Shader::SIX_POINT, 13),
        (Shader::PHONG, 28),
        (Shader::SQRT6, 20),
        // The general way: a plane and a quadratic in intensities that know no pixel format.
        (named("gouraud4"), 33),
        (named("six-point-centre"), 34),
    ];
    check("peer-sphere", &limits);
}

/// Three planes take 17 instructions a pixel that is seen, each of them one to step and one to shift and clamp. Three quadratics, for which there are
/// not enough registers, are evaluated at the columns of pixels: 31. Two cosines and up to two highlights become three channels by products:
/// `sqrt6` takes 63 on average and `phong`, by a kernel, 55.
#[test]
fn three_channels_are_clamped_by_one_instruction_each() {
    check(scene::LIGHTS, &[(Shader::GOURAUD, 17), (Shader::SIX_POINT, 31), (Shader::SQRT6, 63), (Shader::PHONG, 55)]);
}

/// One light without a highlight is one quantity also in three channels: most triangles are drawn by loops of one channel.
#[test]
fn light_without_a_highlight_is_one_channel() {
    check(scene::PLASTIC, &[(Shader::GOURAUD, 15), (Shader::SIX_POINT, 24), (Shader::SQRT6, 32), (Shader::PHONG, 36)]);
}

/// Without depth a quadratic takes 7 instructions a pixel, a plane 6, a constant 3. A tenth of the pixels lies in triangles
/// where it is tested all the same.
#[test]
fn convex_meshes_need_no_depth() {
    check(scene::CONVEX, &[(Shader::FLAT, 4), (Shader::GOURAUD, 7), (Shader::SIX_POINT, 8)]);
}

fn check(scene: &str, limits: &[(Shader, u32)]) {
    let wanted: Vec<_> = limits.iter().map(|&(shader, _)| (Processor::CortexM3, shader)).collect();
    let bench = Bench::new(&[Processor::CortexM3]).unwrap();
    let measured = bench.count(&scene::load(scene).unwrap(), &wanted, &|| ()).unwrap();
    for (found, &(_, limit)) in measured.iter().zip(limits) {
        // Spans end on a branch that is not taken, so a few instructions of the loop may be counted with the span.
        let per_pixel = found.by_stage.pixel as f64 / found.pixels as f64;
        println!("{}: {per_pixel:.2} instructions in the inner loop", found.shader);
        assert!(per_pixel > f64::from(limit) - 1.0 && per_pixel <= f64::from(limit), "{}: {per_pixel}", found.shader);
    }
}
