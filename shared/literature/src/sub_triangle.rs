//! Sub-triangles, for methods that shade a triangle piece by piece.
//!
//! A triangle that is split at the midpoints of its edges becomes four copies of half its size. The middle one is turned by 180 degrees. The copies
//! can be split again. Corners of sub-triangles are exact in the finer coordinates used here, so their edges lie exactly on the triangle's edges and
//! on each other. The top-left rule gives every pixel of the triangle to one sub-triangle, without cracks and overlaps.

use microphong::{
    format::{FINE, SPLITS},
    math::vector::zip,
    method::{
        Area, Canvas, Field, Gradients, IfTextured, IntensityShader, NEAR, OnTexture, Patch, PlacePatch, Placed, Plane, ScreenTriangle,
        Shaded, SpanShader, TriangleSetup,
    },
};

/// Distance from a pixel's border to its centre.
const CENTRE: i32 = 1 << (FINE - 1);

/// The place of a sub-triangle. Its corner `k` has the barycentric coordinates `origin`, plus or minus 1 at coordinate `k`, all over 2^`level`.
#[derive(Clone, Copy, Debug)]
pub struct SubTriangle {
    level: u32,
    origin: [i32; 3],
    turned: bool,
}

impl SubTriangle {
    /// The whole triangle.
    pub const WHOLE: Self = Self { level: 0, origin: [0; 3], turned: false };

    /// How often the triangle was split. Barycentric coordinates are over 2 to this power.
    #[inline]
    #[must_use]
    pub fn level(&self) -> u32 {
        self.level
    }

    fn sign(&self) -> i32 {
        if self.turned { -1 } else { 1 }
    }

    /// Barycentric coordinates of the corners.
    #[inline]
    #[must_use]
    pub fn corners(&self) -> [[i32; 3]; 3] {
        let ([a, b, c], sign) = (self.origin, self.sign());
        [[a + sign, b, c], [a, b + sign, c], [a, b, c + sign]]
    }

    /// The four sub-triangles between corners and edge midpoints. Sub-triangle `k` < 3 keeps corner `k` in its place. Corner `k` of the last one is
    /// the midpoint of the opposite edge.
    #[inline]
    #[must_use]
    pub fn split(&self) -> [Self; 4] {
        let ([a, b, c], sign) = (self.origin.map(|c| c * 2), self.sign());
        let sub_triangle = |origin, turned| Self { level: self.level + 1, origin, turned };
        [
            sub_triangle([a + sign, b, c], self.turned),
            sub_triangle([a, b + sign, c], self.turned),
            sub_triangle([a, b, c + sign], self.turned),
            sub_triangle([a + sign, b + sign, c + sign], !self.turned),
        ]
    }
}

/// A triangle that is drawn in parts, with what is needed to fit fields to them.
pub struct Parts<'f> {
    screen: &'f ScreenTriangle<'f>,
    gradients: Gradients,
    depth: Plane<1>,
    texture: IfTextured<Option<Placed<'f, PlacePatch>>>,
}

impl<'f> Parts<'f> {
    /// The parts of the triangle `setup`, each interpolated on its own.
    #[must_use]
    pub fn new(setup: &'f TriangleSetup<'f>) -> Self {
        let TriangleSetup { screen, gradients, .. } = *setup;
        Self { screen, gradients: gradients.parted(), depth: screen.plane(gradients, 0), texture: setup.texture_patch() }
    }
}

impl Parts<'_> {
    /// Whether `canvas` has a pixel of the box around `sub_triangle`.
    #[must_use]
    pub fn meets(&self, sub_triangle: &SubTriangle, canvas: &dyn Canvas) -> bool {
        ScreenSubTriangle::new(self.screen, sub_triangle).meets(canvas)
    }

    /// The area of `sub_triangle`, to draw on.
    #[inline]
    #[must_use]
    pub fn part<'p>(&'p self, sub_triangle: &'p SubTriangle) -> Part<'p> {
        Part { whole: self, sub_triangle }
    }
}

/// A part of a triangle, over which fields are interpolated by nodes of its own. Nothing is fitted if no pixel of it is in the canvas.
pub struct Part<'p> {
    whole: &'p Parts<'p>,
    sub_triangle: &'p SubTriangle,
}

impl Area for Part<'_> {
    fn draw<F: Field, S: IntensityShader<F::Value>>(&self, field: &F, shader: S, canvas: &mut dyn Canvas) -> u32 {
        let Parts { screen, gradients, depth, texture } = self.whole;
        let place = ScreenSubTriangle::new(screen, self.sub_triangle);
        if !place.meets(canvas) {
            return 0;
        }
        if let Some(Some(texture)) = texture.first() {
            return self.draw_textured(&place, *texture, field, shader, canvas);
        }
        let gradients = place.gradients(gradients);
        place.draw(gradients.row(), *depth, &mut Shaded::new(field.fit(&gradients), shader), canvas)
    }
}

impl Part<'_> {
    /// [`Area::draw`] on a texture, whose place stands on the first row of the whole triangle.
    #[inline(never)]
    fn draw_textured<F: Field, S: IntensityShader<F::Value>>(
        &self,
        place: &ScreenSubTriangle,
        mut texture: Placed<'_, PlacePatch>,
        field: &F,
        shader: S,
        canvas: &mut dyn Canvas,
    ) -> u32 {
        let Parts { gradients: whole, depth, .. } = self.whole;
        let gradients = place.gradients(whole);
        texture.jump(gradients.row().wrapping_sub(whole.row()));
        let (patch, sampler) = ((field.fit(&gradients), texture), texture.sampler);
        place.draw(gradients.row(), *depth, &mut Shaded::new(patch, OnTexture { sampler, shader }), canvas)
    }
}

/// A sub-triangle on the screen.
#[derive(Clone, Copy, Debug)]
pub struct ScreenSubTriangle {
    sub_triangle: SubTriangle,
    /// Corners, clockwise, with [`FINE`] fraction bits.
    corners: [[i32; 2]; 3],
    /// First row, and one past the last, on the grid of the corners.
    rows: [i32; 2],
    /// First column, and one past the last, on the grid of the corners.
    columns: [i32; 2],
}

/// First row whose centre is not above `c`, or column whose centre is not left of it.
fn first_centre(c: i32) -> i32 {
    c.wrapping_add(CENTRE - 1) >> FINE
}

/// The half-open range of centres between the least and the largest of three coordinates.
fn range([a, b, c]: [i32; 3]) -> [i32; 2] {
    [first_centre(a.min(b).min(c)), first_centre(a.max(b).max(c))]
}

impl ScreenSubTriangle {
    /// Where `sub_triangle` lies.
    #[inline(never)]
    #[must_use]
    pub fn new(screen: &ScreenTriangle<'_>, sub_triangle: &SubTriangle) -> Self {
        let finer = SPLITS.saturating_sub(sub_triangle.level);
        let (sign, [u, v, w]) = (sub_triangle.sign(), sub_triangle.origin);
        // One coordinate of the corners, which lie around the point of the barycentric coordinates `origin`.
        let along = |[a, b, c]: [i32; 3]| {
            let around = a.wrapping_mul(u).wrapping_add(b.wrapping_mul(v)).wrapping_add(c.wrapping_mul(w));
            let place = |corner: i32| around.wrapping_add(corner.wrapping_mul(sign)) << finer;
            [place(a), place(b), place(c)]
        };
        let [[ax, ay], [bx, by], [cx, cy]] = screen.corners();
        let (columns, rows) = (along([ax, bx, cx]), along([ay, by, cy]));
        Self { sub_triangle: *sub_triangle, corners: zip(columns, rows, |x, y| [x, y]), rows: range(rows), columns: range(columns) }
    }
}

impl ScreenSubTriangle {
    /// Whether the box around the sub-triangle has a pixel in `canvas`.
    #[inline]
    #[must_use]
    pub fn meets(&self, canvas: &dyn Canvas) -> bool {
        let ([top, bottom], [left, right]) = (self.rows, self.columns);
        let [width, first, end] = canvas.bounds();
        top.max(first) < bottom.min(end) && left.max(0) < right.min(width)
    }

    /// Gradients of the sub-triangle, computed from the triangle's.
    #[must_use]
    pub fn gradients(&self, triangle: &Gradients) -> Gradients {
        let extent = |[from, to]: [i32; 2]| to.wrapping_sub(from);
        let near = extent(self.rows).max(extent(self.columns)) < NEAR / 2;
        triangle.part(self.corners[0], self.sub_triangle.level, self.sub_triangle.turned, near)
    }

    /// Draws the rows that lie in `canvas` and returns how many pixels they have. `shader` stands on row `anchor`, `depth` is the
    /// triangle's on row 0.
    pub fn draw(&self, anchor: i32, mut depth: Plane<1>, shader: &mut dyn SpanShader, canvas: &mut dyn Canvas) -> u32 {
        let [a, b, c] = self.corners;
        let [width, top, bottom] = canvas.bounds();
        let (first, end) = (self.rows[0].max(top), self.rows[1].min(bottom));
        depth.jump(first);
        shader.jump(first.wrapping_sub(anchor));
        let mut lines = [Line::new(a, b, first), Line::new(b, c, first), Line::new(c, a, first)];
        let mut pixels = 0u32;
        for row in first..end {
            let (mut left, mut right) = (0, i64::from(width));
            for line in &mut lines {
                match line.side {
                    Side::Left => left = left.max(line.column),
                    Side::Right => right = right.min(line.column),
                    Side::None => {}
                }
                line.step_row();
            }
            if left < right {
                let count = right.saturating_sub(left) as usize;
                canvas.draw_row(row, right as i32, count, depth.enter(right as i32), shader);
                pixels = pixels.wrapping_add(count as u32);
            }
            depth.step_row();
            shader.step_row();
        }
        pixels
    }
}

/// The side of an edge that is outside of the triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    /// Left of an edge that runs up.
    Left,
    /// Right of an edge that runs down.
    Right,
    /// The edge is level and bounds rows, not columns.
    None,
}

/// The straight line through an edge, walked down exactly, quotient and remainder apart.
#[derive(Clone, Copy, Debug)]
struct Line {
    side: Side,
    /// First column whose centre is not left of the line.
    column: i64,
    /// The remainder of rounding up, as a numerator over `whole`.
    rest: i64,
    column_step: i64,
    rest_step: i64,
    whole: i64,
}

impl Line {
    /// The line through the edge from `a` to `b`, on row `row`.
    #[inline]
    fn new(a: [i32; 2], b: [i32; 2], row: i32) -> Self {
        let (side, [x, y], lower) = match b[1].cmp(&a[1]) {
            core::cmp::Ordering::Less => (Side::Left, b, a),
            core::cmp::Ordering::Greater => (Side::Right, a, b),
            core::cmp::Ordering::Equal => (Side::None, a, b),
        };
        let (dx, dy) = (lower[0].wrapping_sub(x), lower[1].wrapping_sub(y).max(1));
        let whole = i64::from(dy) << FINE;
        let down = (row << FINE).wrapping_add(CENTRE).wrapping_sub(y);
        let column = i64::from(x.wrapping_sub(CENTRE)) * i64::from(dy) + i64::from(dx) * i64::from(down) + whole - 1;
        Self {
            side,
            column: column.div_euclid(whole),
            rest: column.rem_euclid(whole),
            column_step: dx.div_euclid(dy).into(),
            rest_step: i64::from(dx.rem_euclid(dy)) << FINE,
            whole,
        }
    }

    #[inline(always)]
    fn step_row(&mut self) {
        self.column += self.column_step;
        self.rest += self.rest_step;
        if self.rest >= self.whole {
            self.rest -= self.whole;
            self.column += 1;
        }
    }
}
