//! Checks that a scene has one picture, however it is drawn: by bands of any height, with little memory or much, twice by one renderer, and with all
//! that nobody can see.

use crate::{
    Family, Verdict,
    case::Case,
    random::Random,
    scenes::{self, Wishes},
    transparency,
};
use anyhow::{Result, ensure};
use embedded_graphics_core::pixelcolor::Rgb565;
use microphong::{Counts, Layout, Outlines, Renderer, Skips, Stats};
use microphong_render::render;

/// Random scenes in random styles.
pub struct Sameness;

impl Family for Sameness {
    fn name(&self) -> &'static str {
        "sameness"
    }

    fn about(&self) -> &'static str {
        "bands, memory, limits, earlier frames and skipped work change no pixel or count"
    }

    fn check(&self, random: &mut Random) -> Verdict {
        let Some(mut case) =
            scenes::case(random, Wishes { closed: false, unclipped: false, triangles: 600, hard: scenes::Hard::default() })
        else {
            return Verdict::skipped();
        };
        case.stream = transparency::sometimes(random, case.stream);
        if random.once_in(4) {
            case.style.outlines = Some(Outlines::new([random.bits() as u8, 128, 255]).alone(random.once_in(2)));
        }
        match differs(&case) {
            Ok(what) => Verdict { failure: what, case: Some(case), ..Verdict::default() },
            // The method cannot draw this scene in this style.
            Err(_) => Verdict::skipped(),
        }
    }

    fn fails(&self, case: &Case) -> bool {
        differs(case).is_ok_and(|what| what.is_some())
    }
}

/// The difference between ways of drawing a case, if there is any.
fn differs(case: &Case) -> Result<Option<String>> {
    let stream = case.stream.parse()?;
    let whole = render::frame::<Rgb565>(stream, case.pixels(), case.style, case.size[1], case.frame)?;
    let (vertices, triangles) = (stream.vertices.len(), stream.triangles.len());
    let room = |rows: u32, [vertices, triangles, active]: [usize; 3], edges: usize| {
        Layout::new(case.size[0] as usize, rows.clamp(1, case.size[1]) as usize)
            .vertices(vertices)
            .triangles(triangles)
            .materials(stream.materials.len())
            .active_triangles(active)
            .antialias(case.style.has_edges())
            .edges(edges)
    };
    let ways = [
        ("its bands", room(case.band_rows, [vertices, triangles, triangles], 3 * triangles)),
        ("bands of one row, and no triangle handed on", room(1, [vertices, triangles, 0], 3 * triangles)),
        ("little memory", room(case.band_rows, [vertices / 2, triangles / 3, 2], 2)),
        ("few edges", room(case.band_rows, [vertices, triangles, triangles], 1)),
    ];
    for (name, layout) in ways {
        for (pixels, stats) in twice(case, layout, Skips::ALL)? {
            let what = unequal((&pixels, &stats), (&whole.0, &whole.1));
            if let Some(what) = what {
                return Ok(Some(format!("{name}: {what}")));
            }
        }
    }
    // Where a triangle that faces away is clipped, its parts may turn over by rounding if they are drawn.
    let skips = Skips { back_faces: true, ..Skips::NONE };
    let all = twice(case, room(case.band_rows, [vertices, triangles, triangles], 3 * triangles), skips)?;
    let differs = all.iter().find_map(|(pixels, _)| unequal((pixels, &whole.1), (&whole.0, &whole.1)));
    Ok(differs.map(|what| format!("nothing left out: {what}")))
}

/// The difference between one picture with its counts and another, if there is any.
#[must_use]
pub fn unequal((pixels, stats): (&[Rgb565], &Stats), (whole, expected): (&[Rgb565], &Stats)) -> Option<String> {
    let differ = pixels.iter().zip(whole).filter(|(a, b)| a != b).count() + pixels.len().abs_diff(whole.len());
    if differ > 0 {
        return Some(format!("{differ} of {} pixels differ", whole.len()));
    }
    // With little memory, more triangles are drawn with depth.
    let counts = |stats: &Stats| (stats.pixels, Counts { without_depth: 0, ..stats.counts });
    // Whether an object is hidden in the rows of a band depends on how many there are.
    let hidden = stats.counts.hidden > 0 || expected.counts.hidden > 0;
    let differ = (stats.drawn, stats.culled) != (expected.drawn, expected.culled) || !hidden && counts(stats) != counts(expected);
    differ.then(|| format!("{stats:?} in place of {expected:?}"))
}

/// Draws a frame, another one, and the first again, in memory that is not clean.
fn twice(case: &Case, layout: Layout, skips: Skips) -> Result<[(Vec<Rgb565>, Stats); 2]> {
    let mut memory = vec![0x0123_4567_89AB_CDEF; layout.words::<Rgb565>()];
    let stream = case.stream.with_neighbours()?;
    let mut renderer = Renderer::with_shader(stream.parse()?, case.pixels(), &layout, &mut memory, case.style.shader.on())?;
    renderer.set_perspective_correct(case.style.perspective_correct)?;
    renderer.set_antialias(case.style.antialias)?;
    renderer.scene().set_outlines(case.style.outlines)?;
    renderer.set_dither(case.style.dither);
    renderer.set_skips(skips);
    let mut draw = |number| -> Result<(Vec<Rgb565>, Stats)> {
        let (mut pixels, mut band) = (Vec::new(), vec![Rgb565::default(); layout.band()]);
        let mut frame = renderer.frame(number);
        while let Some(area) = frame.next_band(&mut band)? {
            pixels.extend_from_slice(&band[..(area.size.width * area.size.height) as usize]);
        }
        ensure!(frame.is_complete(), "a frame ends before its last row");
        Ok((pixels, frame.stats()))
    };
    let first = draw(case.frame)?;
    draw(case.frame.wrapping_add(1))?;
    Ok([first, draw(case.frame)?])
}
