//! Instructions of a frame: at most so many for each vertex, triangle, row and pixel that it has.
//!
//! A frame of L lights takes at most (1 + L) (a vertices + b triangles + c rows + d pixels) instructions of x86-64, with a, b, c and d of
//! [`BOUNDS`], and vertices, triangles, rows and pixels of [`Work`]. These follow from the scene alone, so whatever a renderer does more
//! often than once for each of them is seen. Scenes are those that cost most for what they show.

use crate::{
    Family, Verdict,
    case::Case,
    random::Random,
    scenes::{self, Wishes},
    shrink::written,
};
use anyhow::Result;
use microphong::{
    format::SUBPIXEL,
    geometry::{pose::Pose, projection::View},
    stream::record::{Header, Mesh as Record, Triangle},
};
use microphong_render::{
    bytes::StreamBytes,
    mesh::Mesh,
    render::{Format, Style},
    shapes,
    vector::{add, scale, unit},
};
use std::ops::Range;
use zerocopy::IntoBytes;

/// What counts the instructions of a frame.
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
        "a frame takes no more instructions than are documented"
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
    /// What a case takes, as a share of what is documented; `None` if it cannot be drawn.
    fn share(&self, case: &Case) -> Result<Option<f64>> {
        let Some(work) = Work::of(case) else { return Ok(None) };
        Ok(self.0.count(case)?.map(|instructions| instructions as f64 / work.instructions(bound(case.style))))
    }
}

/// What a vertex, a triangle, a row and a pixel take at most: of each method, without antialiasing and with it.
///
/// Four times what the worst of 250 scenes of up to 320x240 pixels takes. Of some ten thousand others a few come close, and one is known to
/// take more, by 15 %: case 21,948 of seed 1795396151, Phong shading in perspective under a near light, which no column tells apart.
/// `cargo test -p microphong-tests stress::costs_are_counted_anew -- --ignored --nocapture` counts anew and prints the table.
pub const BOUNDS: [(&str, [u32; 4], [u32; 4]); 26] = [
    ("flat", [440, 1100, 1400, 130], [88, 960, 19000, 520]),
    ("gouraud", [2600, 1500, 720, 120], [2000, 1400, 19000, 500]),
    ("six-point", [3000, 800, 4600, 120], [2400, 980, 24000, 500]),
    ("phong", [540, 1100, 7200, 130], [190, 960, 34000, 520]),
    ("phong-rv", [36, 1400, 9400, 130], [56, 1100, 42000, 520]),
    ("gouraud4", [2800, 1100, 7800, 120], [5000, 6, 54000, 540]),
    ("pseudo-phong", [3600, 600, 30000, 160], [3200, 600, 190000, 740]),
    ("highlight-test", [3200, 680, 6600, 120], [2600, 620, 32000, 500]),
    ("goldman", [200, 1100, 4600, 130], [280, 860, 48000, 740]),
    ("slerp", [190, 1100, 7600, 130], [190, 880, 42000, 540]),
    ("duff", [500, 1100, 7400, 130], [150, 1100, 32000, 520]),
    ("taylor", [2, 1600, 5800, 130], [2, 1200, 34000, 520]),
    ("taylor-finite", [400, 1300, 9600, 130], [2, 1200, 40000, 520]),
    ("six-point-adaptive", [16000, 13000, 48000, 120], [68000, 2, 260000, 2000]),
    ("six-point-centre", [1500, 19000, 12000, 110], [26000, 2, 120000, 1100]),
    ("cubic", [3200, 760, 18000, 120], [2800, 840, 50000, 500]),
    ("angular", [560, 1200, 28000, 140], [80, 1200, 110000, 560]),
    ("angular-original", [560, 1200, 28000, 140], [80, 1200, 110000, 560]),
    ("hybrid", [540, 1100, 12000, 130], [190, 980, 54000, 520]),
    ("hybrid-original", [540, 1100, 12000, 130], [190, 980, 54000, 520]),
    ("environment", [2, 1600, 5200, 130], [2, 1100, 32000, 520]),
    ("blinn", [440, 1100, 6200, 130], [2, 1200, 30000, 520]),
    ("quadratic-blinn", [500, 960, 15000, 130], [130, 980, 44000, 520]),
    ("sqrt6", [500, 1100, 7000, 130], [120, 1100, 30000, 520]),
    ("renq", [500, 1100, 7200, 130], [160, 1100, 30000, 520]),
    ("renq-newton", [500, 1100, 7800, 130], [170, 1000, 34000, 520]),
];

/// Those of a style.
#[must_use]
pub fn bound(style: Style) -> [u32; 4] {
    let row = BOUNDS.iter().find(|(name, ..)| *name == style.shader.name());
    row.map_or([0; 4], |&(_, plain, antialiased)| if style.antialias { antialiased } else { plain })
}

/// What the cost of a frame may be proportional to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Lights, and one more.
    pub lights: u64,
    /// Vertices of the stream.
    pub vertices: u64,
    /// Triangles and meshes of the stream, and triangles once more in each band that they reach into.
    pub triangles: u64,
    /// Rows of triangles.
    pub rows: u64,
    /// Pixels of the picture, those that triangles touch, and entries of the tables of colours.
    pub pixels: u64,
}

/// Entries of a material's table of colours. With its table of highlights it is most of what a small scene takes.
const TABLE: u64 = 512;
/// Triangles that a clipped triangle may become.
const FAN: u64 = 6;

impl Work {
    /// Of a case; `None` if its stream is not valid.
    #[must_use]
    pub fn of(case: &Case) -> Option<Self> {
        let stream = case.stream.parse().ok()?;
        let [width, height] = case.size.map(u64::from);
        let view = View::new(&stream.header.camera, &Pose::new(&stream.header.camera, case.frame), case.pixels());
        let mut work = Self {
            lights: 1 + stream.lights.len() as u64,
            vertices: stream.vertices.len() as u64,
            triangles: (stream.triangles.len() + stream.meshes.len()) as u64,
            rows: 0,
            pixels: width * height + TABLE * stream.materials.len() as u64,
        };
        let band = u64::from(case.band_rows);
        for mesh in stream.meshes {
            let vertices = stream.vertices_of(mesh)?;
            for triangle in stream.triangles_of(mesh)? {
                let places = triangle.corners.map(|corner| view.project(view.to_eye(vertices[usize::from(corner)].position)));
                let is_whole = places.iter().all(|&(_, within)| within);
                let (parts, rows, pixels) = if is_whole {
                    let (rows, pixels) = touched(places.map(|([x, y, _], _)| [x, y]), [width, height]);
                    (1, rows, pixels)
                } else {
                    (FAN, 0..height, width * height)
                };
                if !rows.is_empty() {
                    work.triangles += parts * ((rows.end - 1) / band - rows.start / band + 1);
                    work.rows += parts * (rows.end - rows.start);
                    work.pixels += pixels;
                }
            }
        }
        Some(work)
    }

    /// What it takes by this bound.
    #[must_use]
    pub fn instructions(&self, bound: [u32; 4]) -> f64 {
        self.parts().iter().zip(bound).map(|(part, bound)| part * f64::from(bound)).sum()
    }

    /// What each part of a bound is multiplied by.
    #[must_use]
    pub fn parts(&self) -> [f64; 4] {
        [self.vertices, self.triangles, self.rows, self.pixels].map(|part| (self.lights * part) as f64)
    }
}

/// The rows of a picture that a triangle reaches into, and how many pixels it touches at most; none if it shows its back. `corners` are in
/// 1/16 pixel.
fn touched(corners: [[i32; 2]; 3], size: [u64; 2]) -> (Range<u64>, u64) {
    let [a, b, c] = corners.map(|corner| corner.map(i64::from));
    // It runs against the order of the screen, whose y runs down.
    let area = (b[1] - a[1]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[1] - a[1]);
    let [columns, rows] = [0, 1].map(|k| {
        let (least, most) = (a[k].min(b[k]).min(c[k]) >> SUBPIXEL, (a[k].max(b[k]).max(c[k]) >> SUBPIXEL) + 1);
        least.clamp(0, size[k] as i64) as u64..most.clamp(0, size[k] as i64) as u64
    });
    let (width, height) = (columns.end - columns.start, rows.end - rows.start);
    if area <= 0 || width * height == 0 {
        return (0..0, 0);
    }
    // A convex figure touches as many pixels as its area and its boundary, at most.
    (rows, (width * height).min((area as u64 >> (2 * SUBPIXEL + 1)) + 2 * (width + height)))
}

/// A random case of a kind that costs a lot.
#[must_use]
pub fn case(random: &mut Random) -> Option<Case> {
    let wishes = Wishes { closed: false, unclipped: !random.once_in(4), triangles: 300 };
    let mesh = match random.pick(0..4) {
        // Any scene of the other families.
        0 => None,
        // Slivers across the picture: derivatives that cancel, edge pixels without inner ones.
        1 => Some(triangles(random, 0.0005)),
        // Large triangles: much is set up, or split, for each row if bands have one.
        2 => Some(triangles(random, 0.3)),
        // Triangles down to less than a pixel.
        _ => Some(sphere(random)),
    };
    let case = match &mesh {
        Some(mesh) => scenes::of(random, mesh, wishes),
        None => scenes::case(random, wishes),
    }?;
    // Every triangle in a mesh of its own: what is done for each mesh, or for each mesh in each band.
    let stream = if random.once_in(4) { meshes_of_one(&case.stream)? } else { case.stream };
    let size = [320.0, 240.0].map(|most| random.octaves(1.0, most) as u32);
    let band_rows = if random.once_in(2) { random.pick(1..4) } else { random.pick(1..120) } as u32;
    Some(Case { stream, size, band_rows: band_rows.min(size[1]), format: Format::Rgb565, ..case })
}

/// Large triangles, as high as `thin` times their length at least.
fn triangles(random: &mut Random, thin: f64) -> Mesh {
    let mut mesh = Mesh::default();
    for _ in 0..random.octaves(1.0, 40.0) as u32 {
        let (along, across) = (random.direction(), scale(random.direction(), random.octaves(thin, 1.0)));
        let centre = scale(random.direction(), random.between(0.0, 0.5));
        let (facing, spread) = (random.direction(), random.between(0.0, 2.0));
        let first = mesh.positions.len();
        for corner in [along, scale(along, -1.0), across] {
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

/// The same triangles, each with vertices of its own and in a mesh of its own.
fn meshes_of_one(bytes: &StreamBytes) -> Option<StreamBytes> {
    let stream = bytes.parse().ok()?;
    let (mut meshes, mut vertices, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for mesh in stream.meshes {
        let own = stream.vertices_of(mesh)?;
        for triangle in stream.triangles_of(mesh)? {
            let (first_vertex, first_triangle) = (vertices.len() as u32, triangles.len() as u32);
            meshes.push(Record { first_vertex, vertices: 3, first_triangle, triangles: 1, ..*mesh });
            vertices.extend(triangle.corners.map(|corner| own[usize::from(corner)]));
            triangles.push(Triangle { corners: [0, 1, 2], ..*triangle });
        }
    }
    let header =
        Header { meshes: meshes.len() as u16, vertices: vertices.len() as u32, triangles: triangles.len() as u32, ..*stream.header };
    written(header, &[meshes.as_bytes(), stream.materials.as_bytes(), stream.lights.as_bytes(), vertices.as_bytes(), triangles.as_bytes()])
}
