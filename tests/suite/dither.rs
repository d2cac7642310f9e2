//! Greys of few bits, dithered by loops as by the general way: against the picture of 256 greys and thresholds in floating point. Colours of five
//! bits to seven, dithered by two thresholds in turn: against rounded ones, and against a picture of eight bits.

use embedded_graphics::{
    geometry::Size,
    pixelcolor::{Bgr565, BinaryColor, Gray2, Gray4, Gray8, Rgb565, Rgb666, Rgb888},
};
use microphong::{
    method::sqrt6::Sqrt6,
    pixel::{Pixel, Rgb565Be, dither::threshold},
};
use microphong_sim::{
    render::{self, Style},
    scene,
    shader::Shader,
};

const SIZE: Size = Size::new(120, 90);

fn channels<C: Pixel>(scene: &str, style: Style) -> Vec<[u8; 3]> {
    let scene = scene::load(scene).expect("built-in scene");
    let (pixels, _) = render::frame::<C>(scene.stream.parse().expect("a stream"), SIZE, style, 16, 3).expect("a picture");
    pixels.into_iter().map(Pixel::channels).collect()
}

fn picture<C: Pixel>(scene: &str, style: Style) -> Vec<u8> {
    channels::<C>(scene, style).into_iter().map(|[grey, ..]| grey).collect()
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

/// Few greys are dithered by methods' own loops, and under several lights by the general loop. There is no seam where one triangle is drawn by the
/// one and its neighbour by the other.
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

/// Chooses one of two thresholds for a pixel; `None` if it may have either.
type Turn = fn(usize, usize) -> Option<usize>;

const SQUARES: Turn = |x, y| Some((x + y) % 2);
const ROWS: Turn = |_, y| Some(y % 2);
const EITHER: Turn = |_, _| None;

/// Checks that no channel is above its rounded value where the threshold is lower than for rounding, that none is below elsewhere, and that none is
/// off by more than a step. Returns the number of channels that differ from rounded ones, and the mean distance, in steps, of two by two pixels from
/// pictures of eight bits a channel, dithered and rounded. Only squares count whose four pixels are rounded alike: within a step that could be seen.
fn turns<C: Pixel>(scene: &str, style: Style, turn: Turn) -> (usize, [f64; 2]) {
    let draw = |dither| channels::<C>(scene, Style { dither, ..style });
    let (dithered, rounded) = (draw(true), draw(false));
    let mut others = 0;
    for (pixel, (dithered, rounded)) in dithered.iter().zip(&rounded).enumerate() {
        let (x, y) = (pixel % SIZE.width as usize, pixel / SIZE.width as usize);
        for (&dithered, &rounded) in dithered.iter().zip(rounded) {
            let within = match turn(x, y) {
                Some(0) => i16::from(rounded) - 1..=i16::from(rounded),
                Some(_) => i16::from(rounded)..=i16::from(rounded) + 1,
                None => i16::from(rounded) - 1..=i16::from(rounded) + 1,
            };
            let name = style.shader.name();
            assert!(within.contains(&i16::from(dithered)), "{scene} by {name}, {x} {y}: {dithered}, and {rounded} if rounded");
            others += usize::from(dithered != rounded);
        }
    }
    let fine = channels::<Rgb888>(scene, Style { dither: false, ..style });
    let width = SIZE.width as usize;
    let mean = |pixels: &[[u8; 3]], first: usize, channel: usize| {
        [0, 1, width, width + 1].iter().map(|at| f64::from(pixels[first + at][channel])).sum::<f64>() / 4.0
    };
    let off = |pixels: &[[u8; 3]]| {
        let (mut sum, mut count) = (0.0, 0.0);
        let background = fine[0];
        for first in (0..SIZE.height as usize - 1).step_by(2).flat_map(|y| (0..width - 1).step_by(2).map(move |x| y * width + x)) {
            let square = [0, 1, width, width + 1].map(|at| first + at);
            // Red and blue, whose steps are the widest.
            for channel in [0, 2] {
                let is_one = square.iter().all(|&at| fine[at] != background && rounded[at][channel] == rounded[first][channel]);
                if is_one {
                    let steps = f64::from((1u32 << C::DEPTH[channel]) - 1);
                    sum += (mean(pixels, first, channel) - mean(&fine, first, channel) / 255.0 * steps).abs();
                    count += 1.0;
                }
            }
        }
        sum / count
    };
    (others, [off(&dithered), off(&rounded)])
}

/// Colours of five and six bits are dithered where light is one level: like the squares of a checkerboard where the level is walked, by rows where it
/// is computed at the pixel. The mean of neighbours comes closer to the exact level.
#[test]
fn colours_are_dithered_by_turns() {
    for scene in ["sphere-168", "teapot", "torus", "sphere-690"] {
        // Near its highlight the torus is walked in three channels.
        let walked = if scene == "torus" { EITHER } else { SQUARES };
        for (shader, turn) in [(Shader::GOURAUD, walked), (Shader::SIX_POINT, walked), (Shader::PHONG, ROWS), (Shader::AUTO, EITHER)] {
            let style = Style::from(shader);
            let (others, [dithered, rounded]) = turns::<Rgb565>(scene, style, turn);
            println!("{scene} by {}: {others} channels, {dithered:.3} of {rounded:.3} steps off", shader.name());
            assert!(others > 1000 && dithered < 0.75 * rounded, "{scene} by {}: {others}, {dithered}, {rounded}", shader.name());
            // Eight bits are too few to tell how far these are off.
            let (others, _) = turns::<Rgb666>(scene, style, turn);
            assert!(others > 1000, "{scene} by {}: {others}", shader.name());
            let all = channels::<Rgb565>(scene, Style { dither: true, ..style });
            assert!(channels::<Rgb565Be>(scene, Style { dither: true, ..style }) == all, "the order of bytes changes nothing");
            assert!(channels::<Bgr565>(scene, Style { dither: true, ..style }) == all, "nor does that of channels");
        }
    }
}

/// Three channels take turns by rows, walked or computed at the pixel, also in triangles that bands continue; and so do faces of one colour.
#[test]
fn three_channels_are_dithered_by_rows() {
    const ALL: [Shader; 6] = [Shader::FLAT, Shader::GOURAUD, Shader::SIX_POINT, Shader::new(&Sqrt6), Shader::PHONG, Shader::RENQ_NEWTON];
    for scene in ["bunny", "peer-sphere-lights", "peer-sphere-plastic"] {
        for shader in ALL {
            // Where there is no highlight under one light, levels are walked like the squares of a checkerboard.
            let walks = ["gouraud", "six-point", "sqrt6"].contains(&shader.name());
            let turn = if walks && scene == "peer-sphere-plastic" { EITHER } else { ROWS };
            let (others, [dithered, rounded]) = turns::<Rgb565>(scene, shader.into(), turn);
            println!("{scene} by {}: {others} channels, {dithered:.3} of {rounded:.3} steps off", shader.name());
            assert!(others > 1000 && dithered < 0.85 * rounded, "{scene} by {}: {others}, {dithered}, {rounded}", shader.name());
        }
    }
}

/// The general way takes turns by rows, in three channels as well, and in each pixel that a smooth edge blends.
#[test]
fn the_general_way_dithers_by_rows() {
    for scene in ["sphere-168", "torus", "peer-sphere-lights"] {
        let style = Style { perspective_correct: true, ..Shader::RENQ_NEWTON.into() };
        let (others, [dithered, rounded]) = turns::<Rgb565>(scene, style, ROWS);
        println!("{scene}: {others} channels, {dithered:.3} of {rounded:.3} steps off");
        assert!(others > 1000 && dithered < 0.75 * rounded, "{scene}: {others}, {dithered}, {rounded}");
        let (others, _) = turns::<Rgb565>(scene, Style { antialias: true, ..style }, ROWS);
        assert!(others > 1000);
    }
}

/// A face of one colour takes turns by rows.
#[test]
fn faces_of_one_colour_are_dithered_by_rows() {
    let (others, [dithered, rounded]) = turns::<Rgb565>("sphere-690", Shader::FLAT.into(), ROWS);
    assert!(others > 1000 && dithered < 0.75 * rounded, "{others}, {dithered}, {rounded}");
}

/// The curve of a display comes before dither, in one channel by tables, and in three the general way.
#[test]
fn the_curve_of_a_display_is_dithered() {
    for (scene, shader, turn) in
        [("sphere-168", Shader::GOURAUD, SQUARES), ("sphere-168", Shader::PHONG, ROWS), ("peer-sphere-lights", Shader::AUTO, ROWS)]
    {
        let (others, [dithered, rounded]) = turns::<Rgb565>(scene, Style { srgb: true, ..shader.into() }, turn);
        println!("{scene} by {}: {others} channels, {dithered:.3} of {rounded:.3} steps off", shader.name());
        assert!(others > 1000 && dithered < 0.75 * rounded, "{scene} by {}: {others}, {dithered}, {rounded}", shader.name());
    }
}
