//! Bounds for the instructions of a frame: a number for each vertex, triangle, row and pixel.
//!
//! A frame of L lights, at least one, takes at most (1 + L) (a vertices + b triangles + c rows + d pixels) instructions of x86-64, with the factors
//! of [`BOUNDS`] and the counts of [`Work`]. A near light counts as several, and perspective as a factor. The counts follow from the scene alone, so
//! repeated work of a renderer is noticed. The scenes are of the kinds that cost most for what they show.

use crate::{
    Family, Verdict,
    case::Case,
    random::Random,
    records::Records,
    scenes::{self, Wishes},
};
use anyhow::Result;
use microphong::{
    format::{GeometricError, Length, SUBPIXEL},
    geometry::{lens::Lens, model_view::ModelView, projection::View},
    stream::record::{DIRECTIONAL, Light, Mesh as Record, POINT, Triangle, VIEWER_INFINITE, VIEWER_LOCAL},
};
use microphong_models::{
    bytes::StreamBytes,
    levels,
    mesh::Mesh,
    shapes,
    vector::{add, scale, unit},
};
use microphong_render::render::{Format, Style};
use std::ops::Range;

/// Counts the instructions of a frame.
pub trait Count: Sync {
    /// Draws a case and counts; `None` if the method cannot draw it in this style.
    ///
    /// # Errors
    /// When nothing can be counted.
    fn count(&self, case: &Case) -> Result<Option<u64>>;
}

/// Random frames, whose instructions `C` counts.
#[derive(Debug)]
pub struct Cost<C>(pub C);

impl<C: Count> Family for Cost<C> {
    fn name(&self) -> &'static str {
        "cost"
    }

    fn about(&self) -> &'static str {
        "a frame needs no more instructions than documented"
    }

    fn limit(&self) -> Option<(f64, &'static str)> {
        Some((1.0, "of the documented instructions"))
    }

    fn check(&self, random: &mut Random) -> Verdict {
        let Some(case) = case(random) else { return Verdict::skipped() };
        match self.share(&case) {
            Ok(Some(share)) => Verdict::of(share, 1.0, Some(case)),
            Ok(None) => Verdict::skipped(),
            Err(error) => {
                Verdict { failure: Some(format!("instructions cannot be counted: {error:#}")), case: Some(case), ..Verdict::default() }
            }
        }
    }

    fn fails(&self, case: &Case) -> bool {
        self.share(case).is_ok_and(|share| share.is_some_and(|share| share > 1.0))
    }
}

impl<C: Count> Cost<C> {
    /// The cost of a case as a fraction of the documented bound; `None` if it cannot be drawn.
    fn share(&self, case: &Case) -> Result<Option<f64>> {
        let Some(work) = Work::of(case) else { return Ok(None) };
        Ok(self.0.count(case)?.map(|instructions| instructions as f64 / work.instructions(bound(case.style))))
    }
}

/// Counts of [`Work`] that the cost of a frame is a sum of.
pub const PARTS: usize = 4;

/// Upper bound for the instructions of a frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bound {
    /// Instructions of a vertex, a triangle, a row and a pixel.
    pub parts: [u32; PARTS],
    /// Factor of perspective, in hundredths.
    pub perspective: u32,
    /// Lights whose direction, or that of the viewer, differs from pixel to pixel count as this number of ordinary lights.
    pub near: u32,
}

/// A bound as a row of the table.
const fn at_most(parts: [u32; PARTS], perspective: u32, near: u32) -> Bound {
    Bound { parts, perspective, near }
}

/// The bounds of each method, without antialiasing and with it.
///
/// They are six times the worst of 250 scenes of up to 320x240 pixels, first under far lights and a far viewer, then in perspective and under near
/// ones. A row of a triangle costs next to nothing of its own, because the pixels of its ends are counted among the touched ones. `cargo test -p
/// microphong-tests stress::costs_are_counted_anew -- --ignored --nocapture` counts again and prints the table.
pub const BOUNDS: [(&str, Bound, Bound); 28] = [
    ("flat", at_most([4000, 2900, 34, 60], 100, 2), at_most([5200, 12000, 2100, 1900], 100, 2)),
    ("gouraud", at_most([8100, 2700, 1, 71], 534, 2), at_most([12000, 15000, 1, 2000], 113, 1)),
    ("six-point", at_most([23000, 1500, 1, 140], 331, 3), at_most([22000, 22000, 1, 2100], 102, 2)),
    ("phong", at_most([7200, 4100, 1, 220], 367, 8), at_most([15000, 18000, 10, 2200], 125, 4)),
    ("phong-rv", at_most([1, 36000, 1, 700], 165, 1), at_most([45000, 44000, 1, 2600], 100, 1)),
    ("gouraud4", at_most([16000, 15000, 1, 140], 100, 2), at_most([140000, 40000, 1, 2600], 100, 2)),
    ("pseudo-phong", at_most([1, 38000, 1, 3500], 100, 3), at_most([390, 1, 1, 27000], 100, 2)),
    ("highlight-test", at_most([5000, 4900, 1, 220], 305, 8), at_most([16000, 18000, 1, 2100], 122, 4)),
    ("goldman", at_most([1, 7500, 1, 440], 100, 1), at_most([1, 35000, 1, 5200], 100, 1)),
    ("slerp", at_most([16000, 12000, 1, 440], 100, 1), at_most([19000, 29000, 1, 4500], 100, 1)),
    ("duff", at_most([770, 5800, 1, 360], 229, 4), at_most([15000, 18000, 10, 2200], 125, 3)),
    ("taylor", at_most([6600, 11000, 1, 350], 208, 1), at_most([44000, 27000, 1, 2200], 100, 1)),
    ("taylor-finite", at_most([8700, 13000, 1, 360], 203, 2), at_most([46000, 33000, 1, 2300], 100, 2)),
    ("six-point-adaptive", at_most([120000, 70000, 1, 230], 100, 3), at_most([370000, 190000, 1, 3100], 100, 4)),
    ("six-point-centre", at_most([61000, 20000, 1, 320], 100, 4), at_most([360000, 11000, 1, 3100], 100, 5)),
    ("cubic", at_most([47000, 30000, 1, 240], 256, 2), at_most([47000, 79000, 1, 2000], 100, 2)),
    ("angular", at_most([26000, 7300, 1, 760], 100, 3), at_most([78000, 23000, 200, 5400], 100, 2)),
    ("angular-original", at_most([26000, 7200, 1, 760], 100, 3), at_most([78000, 23000, 220, 5400], 100, 2)),
    ("hybrid", at_most([24000, 6100, 1, 540], 100, 3), at_most([76000, 20000, 10, 4100], 100, 2)),
    ("hybrid-original", at_most([24000, 6000, 1, 540], 100, 3), at_most([76000, 19000, 13, 4100], 100, 2)),
    ("environment", at_most([1, 12000, 1, 230], 226, 2), at_most([570, 32000, 1, 1800], 101, 2)),
    ("blinn", at_most([4600, 7400, 1, 190], 281, 2), at_most([18000, 22000, 1, 2100], 109, 2)),
    ("quadratic-blinn", at_most([12000, 9900, 1, 460], 183, 3), at_most([59000, 31000, 1, 2100], 100, 2)),
    ("sqrt6", at_most([6100, 5700, 1, 260], 252, 3), at_most([25000, 20000, 170, 2200], 100, 2)),
    ("renq", at_most([2200, 5900, 1, 270], 267, 4), at_most([16000, 18000, 77, 2200], 119, 3)),
    ("renq-newton", at_most([1900, 7400, 1, 290], 279, 4), at_most([25000, 20000, 500, 2300], 113, 2)),
    ("auto", at_most([5900, 4700, 1, 220], 364, 8), at_most([14000, 18000, 10, 2200], 118, 4)),
    ("auto-linear", at_most([5900, 4700, 1, 220], 364, 8), at_most([14000, 18000, 10, 2200], 118, 4)),
];

/// The bound of a style.
#[must_use]
pub fn bound(style: Style) -> Bound {
    let row = BOUNDS.iter().find(|(name, ..)| *name == style.shader.name());
    row.map_or(Bound::default(), |&(_, plain, antialiased)| if style.antialias { antialiased } else { plain })
}

/// Counts to which the cost of a frame may be proportional.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Lights, at least one, and one more, but for near ones.
    pub lights: u64,
    /// Number of lights whose direction, or whose viewer's, differs from pixel to pixel.
    pub near: u64,
    /// Whether pixels are drawn in perspective.
    pub perspective: bool,
    /// Vertices of the stream.
    pub vertices: u64,
    /// Triangles and meshes of the stream, and triangles once more in each band that they reach into, or in each band of each of their tiles.
    pub triangles: u64,
    /// Rows of triangles.
    pub rows: u64,
    /// Number of pixels of the picture, pixels that triangles touch, and entries of the tables of colours.
    pub pixels: u64,
}

/// Entries of a material's table of colours. With its table of highlights it is most of what a small scene takes.
const TABLE: u64 = 512;
/// Triangles that a clipped triangle may become.
const FAN: u64 = 6;
/// Methods that interpolate levels. All others draw large triangles under sharp highlights in square tiles.
const OF_LEVELS: [&str; 8] = ["flat", "gouraud", "gouraud4", "six-point", "six-point-adaptive", "six-point-centre", "cubic", "environment"];
/// Columns and rows of a triangle beyond which there are tiles, at an exponent of 1. They shrink with the root of the exponent.
const UNTILED: f64 = 768.0;
/// The side of the smallest tiles, in pixels.
const SMALLEST_TILE: u64 = 8;

impl Work {
    /// The work of a case; `None` if its stream is not valid.
    #[must_use]
    pub fn of(case: &Case) -> Option<Self> {
        let stream = case.stream.parse().ok()?;
        let [width, height] = case.size.map(u64::from);
        let camera = &stream.header.camera;
        let view = View::new(&Lens::new(camera, case.pixels()), &ModelView::new(camera, case.frame));
        let is_local = stream.header.camera.viewer == VIEWER_LOCAL;
        let near = stream.lights.iter().filter(|light| is_local || light.kind == POINT).count();
        let mut work = Self {
            // Without light there is as much to do as under one, for there are still materials and splits.
            lights: 1 + (stream.lights.len() - near).max(usize::from(near == 0)) as u64,
            near: near as u64,
            perspective: case.style.perspective_correct,
            vertices: stream.vertices.len() as u64,
            triangles: (stream.triangles.len() + stream.meshes.len()) as u64,
            rows: 0,
            pixels: width * height + TABLE * stream.materials.len() as u64,
        };
        let band = u64::from(case.band_rows);
        let is_tiled = !case.style.antialias && !OF_LEVELS.contains(&case.style.shader.name());
        for mesh in levels::drawn(&stream, case.pixels()) {
            let vertices = stream.vertices_of(mesh)?;
            let exponent = stream.materials.get(usize::from(mesh.material))?.exponent;
            for triangle in stream.triangles_of(mesh)? {
                let places = triangle.corners.map(|corner| view.lens.project(view.to_eye(vertices[usize::from(corner)].position)));
                let is_whole = places.iter().all(|&(_, within)| within);
                let corners = places.map(|([x, y, _], _)| [x, y]);
                let (parts, span, seen, rows, pixels) = if is_whole {
                    let (seen, rows, pixels) = touched(corners, [width, height]);
                    (1, span(corners), seen, rows, pixels)
                } else {
                    (FAN, f64::INFINITY, [width, height], 0..height, width * height)
                };
                if !rows.is_empty() {
                    let bands = (rows.end - 1) / band - rows.start / band + 1;
                    let [columns, lines] = if is_tiled { tiles(seen, span, exponent) } else { [1, 1] };
                    work.triangles += parts * columns * (bands + lines - 1);
                    work.rows += parts * (rows.end - rows.start);
                    work.pixels += pixels;
                }
            }
        }
        Some(work)
    }

    /// Instructions of this work by a bound.
    #[must_use]
    pub fn instructions(&self, bound: Bound) -> f64 {
        let sum: f64 = self.parts().iter().zip(bound.parts).map(|(part, bound)| part * f64::from(bound)).sum();
        let lights = self.lights + self.near * u64::from(bound.near);
        let perspective = if self.perspective { f64::from(bound.perspective) / 100.0 } else { 1.0 };
        lights as f64 * sum * perspective
    }

    /// Factors of the parts of a bound, for each light.
    #[must_use]
    pub fn parts(&self) -> [f64; PARTS] {
        [self.vertices, self.triangles, self.rows, self.pixels].map(|part| part as f64)
    }
}

/// The numbers of columns and rows that a triangle reaches into, its rows, and the largest number of pixels that it touches; none if it shows its
/// back. `corners` are in 1/16 pixel.
fn touched(corners: [[i32; 2]; 3], size: [u64; 2]) -> ([u64; 2], Range<u64>, u64) {
    let [a, b, c] = corners.map(|corner| corner.map(i64::from));
    // It runs against the order of the screen, whose y runs down.
    let area = (b[1] - a[1]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[1] - a[1]);
    let [columns, rows] = [0, 1].map(|k| {
        let (least, most) = (a[k].min(b[k]).min(c[k]) >> SUBPIXEL, (a[k].max(b[k]).max(c[k]) >> SUBPIXEL) + 1);
        least.clamp(0, size[k] as i64) as u64..most.clamp(0, size[k] as i64) as u64
    });
    let [width, height] = [columns.end - columns.start, rows.end - rows.start];
    if area <= 0 || width * height == 0 {
        return ([0, 0], 0..0, 0);
    }
    // A convex figure touches as many pixels as its area and its boundary, at most.
    ([width, height], rows, (width * height).min((area as u64 >> (2 * SUBPIXEL + 1)) + 2 * (width + height)))
}

/// The columns and rows of a triangle together, in pixels. `corners` are in 1/16 pixel.
fn span(corners: [[i32; 2]; 3]) -> f64 {
    let extent = |k: usize| {
        let places = corners.map(|corner| i64::from(corner[k]));
        places.iter().max().zip(places.iter().min()).map_or(0, |(most, least)| most - least)
    };
    (extent(0) + extent(1)) as f64 / f64::from(1 << SUBPIXEL)
}

/// Largest number of tiles of a triangle, side by side and one above the other, if this number of its columns and rows is seen under a highlight of
/// this exponent.
fn tiles(seen: [u64; 2], span: f64, exponent: u16) -> [u64; 2] {
    // A root of N·H has twice the exponent.
    let reach = UNTILED / (2.0 * f64::from(exponent)).sqrt();
    if span + 1.0 < reach {
        return [1, 1];
    }
    // A tile reaches as far from its middle in columns and rows as its side, and its side is a power of two.
    let side = SMALLEST_TILE.max(1 << ((reach / 2.0) as u64).max(1).ilog2());
    seen.map(|pixels| pixels / side + 2)
}

/// A random case of a kind that costs a lot.
#[must_use]
pub fn case(random: &mut Random) -> Option<Case> {
    let wishes = Wishes { closed: false, unclipped: !random.once_in(4), triangles: 300, hard: scenes::Hard::default() };
    let mesh = match random.pick(0..4) {
        // That of any scene of the other families.
        0 => scenes::mesh(random, wishes),
        // Slivers across the picture: derivatives that cancel, edge pixels without inner ones.
        1 => triangles(random, 0.0005),
        // Large triangles: much is set up, or split, for each row if bands have one.
        2 => triangles(random, 0.3),
        // Triangles down to less than a pixel.
        _ => sphere(random),
    };
    let width = random.octaves(1.0, 320.0);
    let size = scenes::size(random, width);
    let case = scenes::of(random, &mesh, size, wishes)?;
    // Bounds are those of scenes without colours.
    let case = Case { stream: Records::of(&case.stream.parse().ok()?).without_colours().written()?, ..case };
    // Every triangle in a mesh of its own: what is done for each mesh, or for each mesh in each band.
    let stream = if random.once_in(4) { meshes_of_one(&case.stream)? } else { case.stream };
    let band_rows = if random.once_in(2) { random.pick(1..4) } else { random.pick(1..120) } as u32;
    Some(Case { stream, band_rows: band_rows.min(size[1]), format: Format::Rgb565, ..case })
}

/// Large triangles, as high as `thin` times their length at least.
fn triangles(random: &mut Random, thin: f64) -> Mesh {
    let mut mesh = Mesh::default();
    for _ in 0..random.octaves(1.0, 40.0) as u32 {
        let (along, across) = (random.direction(), scale(random.direction(), random.octaves(thin, 1.0)));
        let centre = scale(random.direction(), random.between(0.0, 0.5));
        let (facing, spread) = (random.direction(), random.between(0.0, 2.0));
        let first = mesh.positions.len();
        for corner in scenes::shown(random, [along, scale(along, -1.0), across]) {
            mesh.positions.push(add(centre, corner).map(|c| c.clamp(-1.0, 1.0)));
            mesh.normals.push(unit(add(facing, scale(random.direction(), spread))).unwrap_or(facing));
        }
        mesh.triangles.push([first, first + 1, first + 2]);
    }
    mesh
}

/// A sphere of many triangles, as small as a twentieth of the picture.
fn sphere(random: &mut Random) -> Mesh {
    let mut mesh = shapes::sphere(random.pick(3..60) as usize, random.pick(2..30) as usize, 0.1);
    let radius = random.octaves(0.05, 1.0);
    mesh.positions.iter_mut().for_each(|position| *position = scale(*position, radius));
    // A vertex of no triangle, by which the camera keeps its distance.
    mesh.positions.push([1.0, 0.0, 0.0]);
    mesh.normals.push([1.0, 0.0, 0.0]);
    mesh
}

/// Gives each triangle vertices of its own and a mesh of its own.
fn meshes_of_one(bytes: &StreamBytes) -> Option<StreamBytes> {
    let stream = bytes.parse().ok()?;
    let (mut meshes, mut vertices, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for mesh in stream.meshes_within(GeometricError::ZERO) {
        let own = stream.vertices_of(mesh)?;
        for triangle in stream.triangles_of(mesh)? {
            let (first_vertex, first_triangle) = (vertices.len() as u32, triangles.len() as u32);
            meshes.push(Record { first_vertex, vertices: 3, first_triangle, triangles: 1, ..*mesh });
            vertices.extend(triangle.corners.map(|corner| own[usize::from(corner)]));
            triangles.push(Triangle { corners: [0, 1, 2], ..*triangle });
        }
    }
    // These scenes are one object.
    Records { meshes, vertices, triangles, ..Records::of(&stream) }.written()
}

/// Makes the lights and the viewer of a scene all near, or all far away.
#[must_use]
pub fn lit(bytes: &StreamBytes, near: bool) -> Option<StreamBytes> {
    let stream = bytes.parse().ok()?;
    let (kind, viewer) = if near { (POINT, VIEWER_LOCAL) } else { (DIRECTIONAL, VIEWER_INFINITE) };
    let vector = if near { [3, -2, 1] } else { [1, 2, -2] }.map(|c| Length::from_num(c).to_bits() / 3);
    let mut records = Records::of(&stream);
    records.lights.iter_mut().for_each(|light| *light = Light { kind, vector, ..*light });
    records.header.camera.viewer = viewer;
    records.written()
}
