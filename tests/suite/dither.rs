//! Greys of few bits, dithered by loops as by the general way: against the picture of 256 greys and thresholds in floating point.

use embedded_graphics::{
    geometry::Size,
    pixelcolor::{BinaryColor, Gray2, Gray4, Gray8},
};
use microphong::pixel::{Pixel, dither::threshold};
use microphong_sim::{
    render::{self, Style},
    scene,
    shader::Shader,
};

const SIZE: Size = Size::new(120, 90);

fn picture<C: Pixel>(scene: &str, style: Style) -> Vec<u8> {
    let scene = scene::load(scene).expect("built-in scene");
    let (pixels, _) = render::frame::<C>(scene.stream.parse().expect("a stream"), SIZE, style, 16, 3).expect("a picture");
    pixels.into_iter().map(|pixel| pixel.channels()[0]).collect()
}

/// Every pixel is the level of 256 greys plus its threshold, rounded down to the greys that there are; or, without dither, the nearest grey.
fn check<C: Pixel>(scene: &str, style: Style) {
    let most = f64::from((1u32 << C::DEPTH[0]) - 1);
    let levels = picture::<Gray8>(scene, Style { dither: false, ..style });
    let drawn = picture::<C>(scene, style);
    let mut greys = [0; 256];
    let background = levels[0];
    for (pixel, (&level, &grey)) in levels.iter().zip(&drawn).enumerate().filter(|(_, (level, _))| **level != background) {
        let (x, y) = (pixel % SIZE.width as usize, pixel / SIZE.width as usize);
        let share = if style.dither { f64::from(threshold(x, y)) / 128.0 } else { 0.5 };
        // Tables hold eight bits, of which the last is worth two of 256 greys where a pixel has one bit; both pictures are rounded to theirs.
        let within = [-1.6, 1.6].map(|off| ((f64::from(level) + off).clamp(0.0, 255.0) / 255.0 * most + share).floor().min(most));
        let name = style.shader.name();
        assert!((within[0]..=within[1]).contains(&f64::from(grey)), "{scene} by {name}, {x} {y}: {grey} of {most} for {level}");
        greys[usize::from(grey)] += 1;
    }
    assert!(greys.iter().filter(|&&count| count > 50).count() > 1, "{greys:?}");
}

/// By loops, and by the general way under several lights: there is no seam where one triangle is drawn so and its neighbour otherwise.
#[test]
fn few_greys_are_dithered_by_their_tables() {
    for scene in ["sphere-168", "teapot", "bunny", "sphere-690"] {
        for shader in Shader::CORE {
            for dither in [true, false] {
                let style = Style { dither, ..shader.into() };
                check::<Gray4>(scene, style);
                check::<Gray2>(scene, style);
                check::<BinaryColor>(scene, style);
            }
        }
    }
}
