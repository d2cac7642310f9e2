//! Dither. Greys of few bits and light become pixels of the display by a pass, which is compared with pictures of eight bits and thresholds in floating
//! point. Colours of five bits to seven that are drawn directly are dithered by two thresholds in turn, and compared with rounded ones.

use embedded_graphics::{
    geometry::Size,
    pixelcolor::{Bgr565, BinaryColor, Gray2, Gray4, Gray8, Rgb565, Rgb666, Rgb888},
};
use microphong::{
    Renderer,
    format::ErrorBudget,
    method::cosines::sqrt6::Sqrt6,
    pixel::{FromDrawn, Light, LightGray, Pixel, PixelFormat, Rgb332, Rgb565Be, dither::threshold},
};
use microphong_sim::{
    render::{self, Style},
    scene,
    shader::Shader,
};

const SIZE: Size = Size::new(120, 90);

/// Pictures in all formats have one error budget.
fn shown<C: Pixel, F: FromDrawn<C>>(scene: &str, style: Style) -> Vec<[u8; 3]> {
    let stream = scene::load(scene).expect("built-in scene").stream.with_budget(ErrorBudget::ONE);
    let stream = stream.parse().expect("a stream");
    let (pixels, _) = render::frame_by::<C, F>(stream, SIZE, style, style.shader.on(), 16, 3).expect("a picture");
    pixels.into_iter().map(F::channels).collect()
}

fn channels<C: Pixel>(scene: &str, style: Style) -> Vec<[u8; 3]> {
    shown::<C, C>(scene, style)
}

/// Every channel of a pixel that is not background is a level of eight bits plus its threshold, rounded down to the levels of the display; or,
/// without dither, the nearest. `off` is by how much the two pictures may differ, in 1/255.
fn check<C: Pixel, F: FromDrawn<C>>(levels: &[[u8; 3]], off: f64, scene: &str, style: Style) {
    let (drawn, background) = (shown::<C, F>(scene, style), levels[0]);
    let mut seen = [0; 256];
    for (pixel, (level, shown)) in levels.iter().zip(&drawn).enumerate() {
        let (x, y) = (pixel % SIZE.width as usize, pixel / SIZE.width as usize);
        if *level == background && *shown == drawn[0] {
            continue;
        }
        let share = if style.dither { f64::from(threshold(x, y)) / 128.0 } else { 0.5 };
        for (k, (&level, &shown)) in level.iter().zip(shown).enumerate() {
            let most = f64::from((1u32 << F::DEPTH[k]) - 1);
            // Thresholds are rounded to the steps of light.
            let step = most / if C::GRAY { 255.0 } else { 511.0 };
            let within = [-off, off].map(|off| (f64::from(level) + off).clamp(0.0, 255.0) / 255.0 * most + share);
            let within = [(within[0] - step).floor(), within[1].floor().min(most)];
            let name = style.shader.name();
            assert!(
                (within[0]..=within[1]).contains(&f64::from(shown)),
                "{scene} by {name}, {x} {y}, channel {k}: {shown} of {most} for {level}"
            );
            seen[usize::from(shown)] += 1;
        }
    }
    assert!(seen.iter().filter(|&&count| count > 50).count() > 1, "{seen:?}");
}

#[test]
fn greys_become_few_greys_by_a_pass() {
    for scene in ["sphere-168", "teapot", "bunny", "sphere-690"] {
        for shader in Shader::CORE {
            let levels = channels::<Gray8>(scene, Style::from(shader));
            for dither in [true, false] {
                let style = Style { dither, ..shader.into() };
                check::<LightGray<4>, Gray4>(&levels, 1.6, scene, style);
                check::<LightGray<2>, Gray2>(&levels, 1.6, scene, style);
                check::<LightGray<1>, BinaryColor>(&levels, 1.6, scene, style);
            }
        }
    }
}

/// Light is within 1 of 255 of what a picture of eight bits rounds, under one light and several, in one hue and in three channels, saturated highlights included.
#[test]
fn light_becomes_colours_by_a_pass() {
    for scene in ["sphere-168", "bunny", "peer-sphere-plastic", "peer-sphere-lights"] {
        for shader in Shader::CORE {
            let levels = channels::<Rgb888>(scene, Style::from(shader));
            for dither in [true, false] {
                let style = Style { dither, ..shader.into() };
                check::<Light<5, 6, 5>, Rgb565>(&levels, 1.5, scene, style);
                check::<Light<3, 3, 2>, Rgb332>(&levels, 1.5, scene, style);
            }
        }
    }
}

/// The pass corrects light by the curve of the display, as pictures of eight bits are corrected, and leaves the background as it is.
#[test]
fn the_pass_corrects_light_by_the_curve() {
    for scene in ["sphere-168", "bunny", "peer-sphere-lights"] {
        for dither in [true, false] {
            let style = Style { srgb: true, dither, ..Shader::PHONG.into() };
            let levels = channels::<Rgb888>(scene, Style { dither: false, ..style });
            // Light has nine bits. Where it is dark, a step of it is 6 of 255 after the curve.
            check::<Light<5, 6, 5>, Rgb565>(&levels, 7.0, scene, style);
        }
    }
}

/// Chooses one of two thresholds for a channel of a pixel; `None` if it may have either.
type Turn = fn([usize; 2], usize) -> Option<usize>;

const SQUARES: Turn = |[x, y], _| Some((x + y) % 2);
const ROWS: Turn = |[_, y], _| Some(y % 2);
/// By rows, in green against red and blue.
const FACES: Turn = |[_, y], channel| Some((y + channel) % 2);
const EITHER: Turn = |_, _| None;

/// Checks that no channel is above its rounded value where the threshold is lower than for rounding, that none is below elsewhere, and that none is
/// off by more than a step. Returns the number of channels that differ from rounded ones, and the mean distance, in steps, of two by two pixels from
/// pictures of eight bits a channel, dithered and rounded. Only squares count whose four pixels are rounded alike: within a step that could be seen.
fn turns<C: Pixel>(scene: &str, style: Style, turn: Turn) -> (usize, [f64; 2]) {
    let draw = |dither| channels::<C>(scene, Style { dither, ..style });
    let (dithered, rounded) = (draw(true), draw(false));
    let mut others = 0;
    for (pixel, (dithered, rounded)) in dithered.iter().zip(&rounded).enumerate() {
        let [x, y] = [pixel % SIZE.width as usize, pixel / SIZE.width as usize];
        for (channel, (&dithered, &rounded)) in dithered.iter().zip(rounded).enumerate() {
            let within = match turn([x, y], channel) {
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
    const ALL: [Shader; 5] = [Shader::FLAT, Shader::GOURAUD, Shader::SIX_POINT, Shader::new(&Sqrt6), Shader::PHONG];
    for scene in ["bunny", "peer-sphere-lights", "peer-sphere-plastic"] {
        for shader in ALL {
            // Where there is no highlight under one light, levels are walked like the squares of a checkerboard.
            let walks = ["gouraud", "six-point", "sqrt6"].contains(&shader.name());
            let turn = match shader.name() {
                "flat" => FACES,
                _ if walks && scene == "peer-sphere-plastic" => EITHER,
                _ => ROWS,
            };
            let (others, [dithered, rounded]) = turns::<Rgb565>(scene, shader.into(), turn);
            println!("{scene} by {}: {others} channels, {dithered:.3} of {rounded:.3} steps off", shader.name());
            assert!(others > 1000 && dithered < 0.85 * rounded, "{scene} by {}: {others}, {dithered}, {rounded}", shader.name());
        }
    }
}

/// The general way takes turns by rows, in three channels as well.
#[test]
fn the_general_way_dithers_by_rows() {
    for scene in ["sphere-168", "torus", "peer-sphere-lights"] {
        let style = Style { perspective_correct: true, ..Shader::RENQ_NEWTON.into() };
        let (others, [dithered, rounded]) = turns::<Rgb565>(scene, style, ROWS);
        println!("{scene}: {others} channels, {dithered:.3} of {rounded:.3} steps off");
        assert!(others > 1000 && dithered < 0.75 * rounded, "{scene}: {others}, {dithered}, {rounded}");
    }
}

/// A face of one colour takes turns by rows, in green against red and blue.
#[test]
fn faces_of_one_colour_are_dithered_by_rows() {
    let (others, [dithered, rounded]) = turns::<Rgb565>("sphere-690", Shader::FLAT.into(), FACES);
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

/// Highlights that are brighter than a display can show are full, and backgrounds show no dither.
#[test]
fn light_that_is_too_bright_is_full() {
    let scene = scene::load("peer-sphere-plastic").expect("built-in scene");
    let stream = scene.stream.parse().expect("a stream");
    let layout = render::layout(&stream, SIZE, SIZE.height);
    let mut memory = vec![0; layout.words::<Light<5, 6, 5>>()];
    for shader in Shader::CORE {
        let mut renderer = Renderer::with_shader(stream, SIZE, &layout, &mut memory, shader.on()).expect("a renderer");
        let mut material = stream.materials[0];
        (material.diffuse, material.specular) = ([1 << 14, 1 << 12, 1 << 14], [1 << 15; 3]);
        renderer.scene().set_material(0, material).expect("a material");
        let mut frame = renderer.draw();
        let mut band = vec![Light::BLACK; layout.band()];
        let area = frame.next_band(&mut band).expect("a band").expect("rows");
        let shown: Vec<_> = frame.output().pixels::<_, Rgb565>(&band, area).map(PixelFormat::channels).collect();
        let full = shown.iter().filter(|[r, g, b]| *r == 31 && *g >= 62 && *b == 31).count();
        // Green is never above red and blue, in which the material reflects more.
        assert!(shown.iter().all(|[r, g, _]| *g <= 2 * *r + 3), "{}: green", shader.name());
        assert!(full > 50, "{}: {full} pixels are full", shader.name());
        let background = shown[0];
        let mut edge = shown.iter().take(8);
        assert!(edge.all(|pixel| *pixel == background));
    }
}
