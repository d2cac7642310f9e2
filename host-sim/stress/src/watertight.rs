//! Whole scenes, culling included: a pixel is drawn if its centre lies in a triangle that shows its front on the screen, and else it is
//! not.
//!
//! Corners are where the core rounds them to. Which pixels a triangle covers is decided by three edge functions in 64-bit integers, and
//! nothing is culled before.

use crate::{
    Family, Verdict,
    case::Case,
    coverage::{Corners, covers, side},
    random::Random,
    scenes::{self, Wishes},
};
use embedded_graphics_core::{
    geometry::Size,
    pixelcolor::{Rgb888, RgbColor},
};
use microphong::{
    Stream,
    geometry::{lens::Lens, model_view::ModelView, projection::View},
    stream::{
        record::{Header, Material, Mesh},
        seal,
    },
};
use microphong_models::{bytes::StreamBytes, levels};
use microphong_render::{render, shader::Shader};
use zerocopy::FromBytes;

/// A colour that no scene shows. Surfaces are black, so pixels that are not drawn can be recognised.
const BACKGROUND: Rgb888 = Rgb888::MAGENTA;

/// Scenes that are wholly seen.
pub struct Watertight;

impl Family for Watertight {
    fn name(&self) -> &'static str {
        "watertight"
    }

    fn about(&self) -> &'static str {
        "a pixel is drawn if and only if its centre lies in a triangle that faces the viewer"
    }

    fn limit(&self) -> Option<(f64, &'static str)> {
        Some((0.0, "pixels missing or too many"))
    }

    fn counts(&self) -> &'static [&'static str] {
        &["covered pixels"]
    }

    fn check(&self, random: &mut Random) -> Verdict {
        let Some(case) = scenes::case(random, Wishes { closed: false, unclipped: true, triangles: 800, hard: scenes::Hard::default() })
        else {
            return Verdict::skipped();
        };
        let case = Case { stream: on_background(&case.stream), style: Shader::FLAT.into(), ..case };
        match judge(&case) {
            Some(found) => Verdict { counts: vec![found.covered], ..Verdict::of((found.missing + found.extra) as f64, 0.0, Some(case)) },
            None => Verdict::skipped(),
        }
    }

    fn fails(&self, case: &Case) -> bool {
        judge(case).is_some_and(|found| found.missing + found.extra > 0)
    }
}

/// A stream with black surfaces on a background of another colour, so that pixels that are not drawn can be recognised.
#[must_use]
pub fn on_background(stream: &StreamBytes) -> StreamBytes {
    let mut bytes = stream.as_bytes().to_vec();
    blacken(&mut bytes);
    seal(&mut bytes);
    StreamBytes::from(&bytes[..])
}

/// Makes all materials black; `None` if the stream is shorter than its header says.
fn blacken(bytes: &mut [u8]) -> Option<()> {
    let (header, rest) = Header::mut_from_prefix(bytes).ok()?;
    header.background = [BACKGROUND.r(), BACKGROUND.g(), BACKGROUND.b()];
    header.background_bottom = header.background;
    let materials = rest.get_mut(size_of::<Mesh>() * usize::from(header.meshes)..)?;
    let (materials, _) = <[Material]>::mut_from_prefix_with_elems(materials, header.materials.into()).ok()?;
    for material in materials {
        *material = Material { ambient: [0; 3], diffuse: [0; 3], specular: [0; 3], ..*material };
    }
    Some(())
}

/// The result of a case, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Found {
    /// Covered.
    pub covered: u64,
    /// Covered and not drawn.
    pub missing: u64,
    /// Drawn and not covered; not counted with antialiasing.
    pub extra: u64,
}

/// Compares which pixels are drawn with which are covered; `None` if a vertex is clipped.
#[must_use]
pub fn judge(case: &Case) -> Option<Found> {
    let stream = case.stream.parse().ok()?;
    let counts = covered(&stream, case.size, case.frame)?;
    let (pixels, _) = render::frame::<Rgb888>(stream, case.pixels(), case.style, case.band_rows, case.frame).ok()?;
    let count = |wanted: [bool; 2]| {
        pixels.iter().zip(&counts).filter(|&(&pixel, &count)| [count > 0, pixel != BACKGROUND] == wanted).count() as u64
    };
    let (missing, extra) = (count([true, false]), if case.style.antialias { 0 } else { count([false, true]) });
    Some(Found { covered: count([true, true]) + missing, missing, extra })
}

/// For each pixel, the number of front faces that cover its centre; `None` if a vertex is clipped.
#[must_use]
pub fn covered(stream: &Stream<'_>, size: [u32; 2], number: u32) -> Option<Vec<u8>> {
    let camera = &stream.header.camera;
    let view = View::new(&Lens::new(camera, Size::new(size[0], size[1])), &ModelView::new(camera, number));
    let mut counts = vec![0u8; (size[0] * size[1]) as usize];
    for mesh in levels::drawn(stream, Size::new(size[0], size[1])) {
        let place = |position| {
            let ([x, y, _], inside) = view.lens.project(view.to_eye(position));
            inside.then_some([x, y])
        };
        let places: Option<Vec<[i32; 2]>> = stream.vertices_of(mesh)?.iter().map(|vertex| place(vertex.position)).collect();
        let places = places?;
        for triangle in stream.triangles_of(mesh)? {
            // Clockwise with y down, against the stream's order.
            let [a, c, b] = triangle.corners.map(|corner| places[usize::from(corner)]);
            cover([a, b, c], size, &mut counts);
        }
    }
    Some(counts)
}

fn cover(corners: Corners, size: [u32; 2], counts: &mut [u8]) {
    let [a, b, c] = corners;
    if side(a, b, c) <= 0 {
        return;
    }
    // Pixels whose centres, at 8/16, lie in the box.
    let range = |k: usize| {
        let (low, high) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
        (low + 7).div_euclid(16).max(0)..((high - 8).div_euclid(16) + 1).min(size[k] as i32)
    };
    for y in range(1) {
        for x in range(0) {
            let count = &mut counts[y as usize * size[0] as usize + x as usize];
            *count = count.saturating_add(u8::from(covers(corners, [x, y].map(|c| 16 * c + 8))));
        }
    }
}
