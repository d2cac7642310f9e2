//! A triangle of unit normals around the peak of a highlight, and what interpolation is off from its highlight.

use microphong::method::auto::highlight_error::{KINDS, USUAL_EXPONENT};
use microphong_stress::random::Random;
use std::array;

/// Corners by their angles from the half vector, along two axes, times the root of the exponent: highlights of all exponents are about
/// equally wide in them.
#[derive(Clone, Copy, Debug)]
pub struct Triangle(pub [[f64; 2]; 3]);

/// Barycentric coordinates of the points where errors are taken are multiples of one over this.
const GRID: u32 = 20;

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Triangle {
    /// Smallest length of interpolated normals for which there are bounds: 0.8165, for three normals that are 60 degrees apart.
    pub const LEAST_LENGTH: f64 = 0.816;

    /// A random one, with a size of about `size` and at about `depth` from the peak.
    pub fn random(random: &mut Random, size: f64, depth: f64) -> Self {
        let direction = |random: &mut Random| {
            let [x, y, _] = random.direction();
            let length = x.hypot(y).max(1e-9);
            [x / length, y / length]
        };
        // Of a circle around the normals with the squared radius 2 (1 - ρ), the diameter.
        let long = (8.0 * size).sqrt();
        let away = direction(random).map(|c| c * (2.0 * depth.max(0.0)).sqrt());
        let first = direction(random).map(|c| c * long);
        let second = direction(random).map(|c| c * random.between(0.0, long));
        // The first corner is the nearest one, or the triangle lies over the peak.
        let [u, v] = if random.once_in(3) { [random.between(0.0, 1.0), random.between(0.0, 1.0)] } else { [0.0; 2] };
        let middle = |k: usize| away[k] - u * first[k] - v * second[k];
        let (x, y) = (middle(0), middle(1));
        Self([[x, y], [x + first[0], y + first[1]], [x + second[0], y + second[1]]])
    }

    /// A copy of this triangle whose corners are moved by about `step`.
    pub fn moved(&self, random: &mut Random, step: f64) -> Self {
        let one = random.once_in(2).then(|| random.pick(0..3) as usize);
        let mut corners = self.0;
        for (k, corner) in corners.iter_mut().enumerate() {
            if one.is_none_or(|one| one == k) {
                *corner = corner.map(|c| c + step * (random.between(-1.0, 1.0) + random.between(-1.0, 1.0)));
            }
        }
        Self(corners)
    }

    /// A copy of this triangle, made smaller and moved away from the peak if necessary: its size n (1 - ρ) is at most `size`, and its depth at least
    /// `depth`, for an exponent.
    pub fn fitted(mut self, exponent: u16, size: f64, depth: f64) -> Option<Self> {
        let n = f64::from(exponent);
        for _ in 0..4 {
            let normals = self.normals(n);
            let (least, nearest, away) = (least_length(&normals), nearest(&normals), depth_of(n, &normals));
            if n * (1.0 - least) <= size && away >= depth {
                return (least >= Self::LEAST_LENGTH).then_some(self);
            }
            let smaller = (size / (n * (1.0 - least)).max(1e-12)).sqrt().min(1.0) * (1.0 - 1e-9);
            let [x, y] = self.0[nearest];
            let distance = x.hypot(y).max(1e-9);
            let farther = (distance * distance + 2.0 * (depth - away).max(0.0)).sqrt() * (1.0 + 1e-9) - distance;
            let shift = [x, y].map(|c| c / distance * farther);
            self.0 = self.0.map(|corner| [0, 1].map(|k| [x, y][k] + (corner[k] - [x, y][k]) * smaller + shift[k]));
        }
        None
    }

    /// The unit normals. The peak is along the third axis.
    fn normals(&self, n: f64) -> [[f64; 3]; 3] {
        self.0.map(|[x, y]| {
            let angle = x.hypot(y) / n.sqrt();
            let scale = if angle > 1e-12 { angle.sin() / (angle * n.sqrt()) } else { 1.0 / n.sqrt() };
            [x * scale, y * scale, angle.cos()]
        })
    }

    /// Largest errors of each kind for an exponent, over the whole highlight. The error of
    /// [`microphong::method::auto::highlight_error::Kind::Cosines`] is multiplied by the exponent over [`USUAL_EXPONENT`].
    #[must_use]
    pub fn errors(&self, exponent: u16) -> [f64; KINDS] {
        let n = f64::from(exponent);
        let normals = self.normals(n);
        let cosine = |[a, b, c]: [f64; 3]| {
            let normal = [0, 1, 2].map(|k| a * normals[0][k] + b * normals[1][k] + c * normals[2][k]);
            normal[2] / dot(normal, normal).sqrt()
        };
        let raised = |cosine: f64| cosine.max(0.0).powf(n);
        let half = 0.5;
        let nodes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [half, half, 0.0], [0.0, half, half], [half, 0.0, half]];
        let cosines = nodes.map(cosine);
        let levels = cosines.map(raised);
        let mut errors = [0f64; KINDS];
        for i in 0..=GRID {
            for j in 0..=GRID - i {
                let [u, v] = [i, j].map(|k| f64::from(k) / f64::from(GRID));
                let w = 1.0 - u - v;
                let exact = raised(cosine([u, v, w]));
                let linear = u * levels[0] + v * levels[1] + w * levels[2];
                let quadratic = |[a, b, c, ab, bc, ca]: [f64; 6]| {
                    let corners = u * (2.0 * u - 1.0) * a + v * (2.0 * v - 1.0) * b + w * (2.0 * w - 1.0) * c;
                    corners + 4.0 * (u * v * ab + v * w * bc + w * u * ca)
                };
                // The table of highlights ends at 1.
                let cosines = (raised(quadratic(cosines).min(1.0)) - exact).abs() * n / f64::from(USUAL_EXPONENT);
                let found = [exact - linear, linear - exact, (quadratic(levels) - exact).abs(), cosines];
                errors = array::from_fn(|kind| errors[kind].max(found[kind]));
            }
        }
        errors
    }
}

/// The least length of an interpolated normal, from the smallest circle around the ends of all three.
fn least_length(normals: &[[f64; 3]; 3]) -> f64 {
    let squared = |i: usize, j: usize| {
        let d = [0, 1, 2].map(|k| normals[i][k] - normals[j][k]);
        dot(d, d)
    };
    let mut squares = [squared(0, 1), squared(1, 2), squared(2, 0)];
    squares.sort_by(f64::total_cmp);
    let [a, b, c] = squares;
    let radius2 = if a + b <= c { c / 4.0 } else { a * b * c / (2.0 * (a * b + b * c + c * a) - a * a - b * b - c * c) };
    (1.0 - radius2).max(0.0).sqrt()
}

/// The normal that is nearest to the peak.
fn nearest(normals: &[[f64; 3]; 3]) -> usize {
    (0..3).max_by(|&a, &b| normals[a][2].total_cmp(&normals[b][2])).unwrap_or(0)
}

/// n (1 - w): w is the largest N·H of a corner over the least length of N.
fn depth_of(n: f64, normals: &[[f64; 3]; 3]) -> f64 {
    n * (1.0 - (normals[nearest(normals)][2] / least_length(normals).max(1e-9)).min(1.0))
}
