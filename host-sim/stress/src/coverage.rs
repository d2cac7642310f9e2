//! Coverage of single triangles against the exact rule.
//!
//! The oracle decides each pixel by itself with three edge functions in 64-bit integers; it shares no code with the rasterizer, which
//! walks edges.

use crate::{Family, Verdict, random::Random};
use embedded_graphics_core::{pixelcolor::Gray8, prelude::GrayColor};
use microphong::{
    geometry::{
        cull::Extent,
        projection::{ScreenVertex, State},
        viewport::Bounds,
    },
    interpolate::Constant,
    raster::{
        active::ActiveTriangles,
        band::Band,
        counts::Counts,
        pixel_shader::Solid,
        triangle::{ScreenTriangle, turned},
    },
    setup::gradients::Gradients,
};

/// Columns of the picture.
pub const WIDTH: usize = 96;
/// Rows of the picture.
pub const HEIGHT: usize = 80;

/// Corners in 1/16 pixel.
pub type Corners = [[i32; 2]; 3];

/// Triangles of the kinds that rasterizers get wrong.
pub struct Coverage;

impl Family for Coverage {
    fn name(&self) -> &'static str {
        "coverage"
    }

    fn about(&self) -> &'static str {
        "a triangle covers the pixels whose centres lie inside it, or on a top or left edge"
    }

    fn check(&self, random: &mut Random) -> Verdict {
        let mut corners = triangle(random);
        if side(corners[0], corners[1], corners[2]) < 0 {
            corners.swap(1, 2);
        }
        if side(corners[0], corners[1], corners[2]) == 0 {
            return Verdict::skipped();
        }
        let rows = random.among(&[HEIGHT, 1, 7, 16]);
        Verdict { failure: wrong(corners, rows), ..Verdict::default() }
    }
}

/// The fault in the pixels of a triangle that is drawn in bands of `rows` rows, if there is any.
#[must_use]
pub fn wrong(corners: Corners, rows: usize) -> Option<String> {
    let mut counts = vec![0u8; WIDTH * HEIGHT];
    let drawn = draw(corners, rows, &mut counts);
    judge(corners, rows, &counts, drawn)
}

/// The fault, if each pixel of the picture is drawn as often as `counts` says, and `drawn` pixels are counted.
#[must_use]
pub fn judge(corners: Corners, rows: usize, counts: &[u8], drawn: u32) -> Option<String> {
    let mut expected = 0;
    for (k, &count) in counts.iter().enumerate() {
        let inside = covers(corners, centre(k));
        expected += u32::from(inside);
        if count != u8::from(inside) {
            let [x, y] = [k % WIDTH, k / WIDTH];
            return Some(format!("{corners:?} in bands of {rows} rows: pixel {x},{y} is drawn {count} times"));
        }
    }
    (drawn != expected).then(|| format!("{corners:?} in bands of {rows} rows: {drawn} pixels are counted, {expected} are drawn"))
}

/// A triangle of one of the kinds that rasterizers get wrong.
#[must_use]
pub fn triangle(random: &mut Random) -> Corners {
    let (w, h) = (WIDTH as i32 * 16, HEIGHT as i32 * 16);
    let mut point = |x: [i32; 2], y: [i32; 2]| [x, y].map(|[from, to]| random.pick(from..to));
    let kind = point([0, 6], [0, 1])[0];
    match kind {
        // Within the viewport.
        0 => [(); 3].map(|()| point([0, w], [0, h])),
        // Tiny.
        1 => {
            let [x, y] = point([0, w], [0, h]);
            let mut near = || point([x - 40, x + 40], [y - 40, y + 40]);
            [[x, y], near(), near()]
        }
        // Across the viewport's border.
        2 => [(); 3].map(|()| point([-w, 2 * w], [-h, 2 * h])),
        // Huge, to the ends of the guard band.
        3 => [(); 3].map(|()| point([-65_536, 65_536], [-65_536, 65_536])),
        // Slivers: the third corner is close to the middle of the long side.
        4 => {
            let mut end = || point([-100, w + 100], [-100, h + 100]);
            let (a, b) = (end(), end());
            let [x, y] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
            [a, b, point([x - 9, x + 9], [y - 9, y + 9])]
        }
        // Corners on pixel centres.
        _ => [(); 3].map(|()| point([-4, WIDTH as i32 + 4], [-4, HEIGHT as i32 + 4]).map(|c| c * 16 + 8)),
    }
}

fn vertex([x, y]: [i32; 2]) -> ScreenVertex {
    ScreenVertex { x, y, depth: 1 << 27, light: [0; 4], state: State::READY }
}

/// Adds to `counts` the pixels that the core draws for a triangle, band by band; returns how many it says they are.
pub fn draw(corners: Corners, band_rows: usize, counts: &mut [u8]) -> u32 {
    let vertices = corners.map(vertex);
    let corners = [&vertices[0], &vertices[1], &vertices[2]];
    let mut drawn = 0;
    let (_, corners) = turned(corners);
    for top in (0..HEIGHT).step_by(band_rows) {
        let rows = band_rows.min(HEIGHT - top);
        let mut pixels = vec![Gray8::BLACK; rows * WIDTH];
        let mut depth = vec![0u16; rows * WIDTH];
        let mut band = Band {
            pixels: &mut pixels,
            depth: &mut depth,
            width: WIDTH,
            top: top as i32,
            rows: rows as i32,
            active: ActiveTriangles::default(),
            counts: Counts::default(),
            sheet: Default::default(),
        };
        let screen = ScreenTriangle::new(corners, [0, WIDTH as i32], [top, top + rows].map(|row| row as i32));
        let visible = Bounds::new(&Extent::new(screen.corners())).clipped(Bounds::whole(WIDTH as i32, HEIGHT as i32)).sides();
        let Some(gradients) = Gradients::new(screen.corners(), visible) else { return 0 };
        drawn += screen.draw(&gradients, Constant, Solid::<Gray8>::new([1; 2]), &mut band);
        for (count, pixel) in counts[top * WIDTH..].iter_mut().zip(&pixels) {
            *count += pixel.luma();
        }
    }
    drawn
}

/// The cross product of two sides; positive to the right of `a` to `b`, y running down.
#[must_use]
pub fn side(a: [i32; 2], b: [i32; 2], p: [i32; 2]) -> i64 {
    let d = |p: [i32; 2], k: usize| i64::from(p[k]) - i64::from(a[k]);
    d(b, 0) * d(p, 1) - d(b, 1) * d(p, 0)
}

/// Whether a point belongs to the triangle, clockwise with y running down: inside, or on a top or left edge.
#[must_use]
pub fn covers(corners: Corners, point: [i32; 2]) -> bool {
    (0..3).all(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        // A left edge goes up, a top edge goes right.
        let owned = b[1] < a[1] || (b[1] == a[1] && b[0] > a[0]);
        let side = side(a, b, point);
        side > 0 || (side == 0 && owned)
    })
}

/// The centre of pixel number `pixel`, in 1/16 pixel.
#[must_use]
pub fn centre(pixel: usize) -> [i32; 2] {
    [(pixel % WIDTH) as i32 * 16 + 8, (pixel / WIDTH) as i32 * 16 + 8]
}
