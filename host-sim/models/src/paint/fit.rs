//! The colours of corners that come nearest to those of a triangle.

use super::facet::{Facet, mixed};
use crate::vector::{V3, add, cross, dot, scale, sub};

/// Points along each side of a triangle at which its texture is read: the middles of equal triangles, and so not its rim.
const SIDE: usize = 7;
/// Points of a triangle at which its texture is read.
pub(super) const POINTS: usize = SIDE * (SIDE + 1) / 2;
/// A triangle takes one colour if its corners differ by no more than this share of full.
const FLAT: f64 = 3.0 / 255.0;
/// A colour that differs from that of the file by more than this share of full is said to be far.
pub(super) const FAR: f64 = 12.0 / 255.0;
/// Colours that differ from that of the file by more than this share of full, with what rounding may add, give no idea of a texture.
const LOST: f64 = 24.0 / 255.0 + 1e-9;
/// The distance that colours of corners should have at most before they are rounded to 8 bits.
const AIM: f64 = 11.5 / 255.0;
/// The largest distance, in units of [`AIM`], from which other colours of corners are sought that are not far.
const REACH: f64 = 2.0;
/// How often points are weighted anew in this search.
const ROUNDS: usize = 8;

/// Colours for the corners of a triangle.
pub(super) struct Fit {
    pub(super) corners: [V3; 3],
    /// The corners have one colour.
    pub(super) is_flat: bool,
    /// All points of the file's triangle have that colour.
    is_uniform: bool,
    /// A point has another colour in the file, which is far.
    pub(super) is_far: bool,
}

/// The distance of two colourings of a triangle.
pub(super) struct Apart {
    /// The largest difference of a channel.
    pub(super) largest: f64,
    /// The mean of the squared differences of all channels.
    pub(super) squares: f64,
    /// The share of points at which a channel differs by more than 24 of 255. Linear colours are all of them, or none.
    pub(super) lost: f64,
}

/// The points at which colours are compared, and what finds the colours of least squares.
pub(super) struct Fitting {
    /// Shares of the three corners.
    points: [[f64; 3]; POINTS],
    /// What a corner has of the colours times its own shares, and of the colours times those of all corners.
    inverse: [f64; 2],
}

impl Fitting {
    pub(super) fn new() -> Self {
        let share = |k: usize| (k as f64 + 1.0 / 3.0) / SIDE as f64;
        let mut points = [[0.0; 3]; POINTS];
        let all = (0..SIDE).flat_map(|i| (0..SIDE - i).map(move |j| [share(i), share(j), 1.0 - share(i) - share(j)]));
        points.iter_mut().zip(all).for_each(|(point, shares)| *point = shares);
        // The corners are alike: the matrix of the normal equations has one number in its diagonal, and another one in all other places.
        let product = |one: usize, other: usize| points.iter().map(|shares| shares[one] * shares[other]).sum::<f64>();
        let (same, other) = (product(0, 0), product(0, 1));
        let difference = same - other;
        Self { points, inverse: [1.0 / difference, -other / (difference * (same + 2.0 * other))] }
    }

    /// Whether a triangle has a hole.
    pub(super) fn has_hole(&self, facet: &Facet<'_>) -> bool {
        self.points.iter().any(|&shares| facet.is_hole_at(shares))
    }

    /// The colours of corners that are nearest to those of a triangle.
    pub(super) fn fit(&self, facet: &Facet<'_>) -> Fit {
        if facet.texture.is_none() {
            return Fit::new(facet.corners, false);
        }
        let seen = self.seen(facet);
        if seen.iter().all(|colour| *colour == seen[0]) {
            return Fit { corners: [seen[0]; 3], is_flat: true, is_uniform: true, is_far: false };
        }
        let (mut sum, mut sums) = ([0.0; 3], [[0.0; 3]; 3]);
        for (shares, colour) in self.points.iter().zip(&seen) {
            for channel in 0..3 {
                sum[channel] += colour[channel];
                for corner in 0..3 {
                    sums[corner][channel] += colour[channel] * shares[corner];
                }
            }
        }
        let [own, all] = self.inverse;
        let fitted = sums.map(|own_sum| add(scale(own_sum, own), scale(sum, all)).map(|c| c.clamp(0.0, 1.0)));
        let sampled = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|corner| facet.at(corner));
        let [by_squares, by_sample] = [fitted, sampled].map(|corners| self.apart_at(&seen, |shares| mixed(&corners, shares)));
        let sample_is_better = (by_sample.largest > AIM, by_sample.squares) < (by_squares.largest > AIM, by_squares.squares);
        let (corners, apart) = if sample_is_better { (sampled, by_sample) } else { (fitted, by_squares) };
        let is_far = apart.largest > AIM;
        let nearest = if is_far && apart.largest <= REACH * AIM { self.nearest(&seen) } else { None };
        match nearest {
            Some(corners) => Fit::new(corners, false),
            None => Fit::new(corners, is_far),
        }
    }

    /// Colours of corners that are far at no point, if some are found: points count the more the farther they are (Lawson 1961).
    fn nearest(&self, seen: &[V3; POINTS]) -> Option<[V3; 3]> {
        let mut weights = [1.0; POINTS];
        for _ in 0..ROUNDS {
            let (mut matrix, mut right) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
            for ((shares, &colour), weight) in self.points.iter().zip(seen).zip(weights) {
                for k in 0..3 {
                    matrix[k] = add(matrix[k], scale(*shares, weight * shares[k]));
                    right[k] = add(right[k], scale(colour, weight * shares[k]));
                }
            }
            let corners = solved(&matrix, &right)?.map(|corner| corner.map(|c| c.clamp(0.0, 1.0)));
            let mut largest = 0.0f64;
            for ((&shares, &colour), weight) in self.points.iter().zip(seen).zip(&mut weights) {
                let distance = distance(colour, mixed(&corners, shares));
                largest = largest.max(distance);
                *weight *= distance / AIM;
            }
            if largest <= AIM {
                return Some(corners);
            }
        }
        None
    }

    /// How far colours of corners are from those of a triangle, of which this is the fit.
    pub(super) fn apart(&self, facet: &Facet<'_>, fit: &Fit, corners: &[V3; 3]) -> Apart {
        if facet.texture.is_none() {
            Apart::linear(&facet.corners, corners)
        } else if fit.is_uniform {
            Apart::linear(&fit.corners, corners)
        } else {
            self.apart_by(facet, |shares| mixed(corners, shares))
        }
    }

    /// How far other colours, by the shares of corners, are from those of a triangle.
    pub(super) fn apart_by(&self, facet: &Facet<'_>, other: impl Fn([f64; 3]) -> V3) -> Apart {
        self.apart_at(&self.seen(facet), other)
    }

    /// The colours of a triangle at all points.
    pub(super) fn seen(&self, facet: &Facet<'_>) -> [V3; POINTS] {
        let mut seen = [[0.0; 3]; POINTS];
        seen.iter_mut().zip(&self.points).for_each(|(colour, &shares)| *colour = facet.at(shares));
        seen
    }

    fn apart_at(&self, seen: &[V3; POINTS], other: impl Fn([f64; 3]) -> V3) -> Apart {
        let (mut largest, mut squares, mut lost) = (0.0f64, 0.0, 0);
        for (&shares, &colour) in self.points.iter().zip(seen) {
            let difference = sub(colour, other(shares));
            let here = difference.into_iter().fold(0.0f64, |most, difference| most.max(difference.abs()));
            largest = largest.max(here);
            lost += usize::from(here > LOST);
            difference.into_iter().for_each(|difference| squares += difference * difference);
        }
        Apart { largest, squares: squares / (3 * POINTS) as f64, lost: lost as f64 / POINTS as f64 }
    }
}

impl Apart {
    /// The distance of colours that are both linear: it is largest at a corner, and the integral of its square is known.
    fn linear(one: &[V3; 3], other: &[V3; 3]) -> Self {
        let differences = [sub(one[0], other[0]), sub(one[1], other[1]), sub(one[2], other[2])];
        let [a, b, c] = differences;
        let largest = differences.as_flattened().iter().fold(0.0f64, |most, difference| difference.abs().max(most));
        let square = |k: usize| (a[k] * (a[k] + b[k] + c[k]) + b[k] * (b[k] + c[k]) + c[k] * c[k]) / 6.0;
        Self { largest, squares: (square(0) + square(1) + square(2)) / 3.0, lost: if largest > LOST { 1.0 } else { 0.0 } }
    }
}

impl Fit {
    /// Corners that hardly differ take one colour, because a triangle of one colour is drawn faster.
    fn new(corners: [V3; 3], is_far: bool) -> Self {
        let [a, b, c] = corners;
        let is_flat = distance(a, b) <= FLAT && distance(b, c) <= FLAT && distance(c, a) <= FLAT;
        let corners = if is_flat { [scale(add(add(a, b), c), 1.0 / 3.0); 3] } else { corners };
        Self { corners, is_flat, is_uniform: false, is_far }
    }
}

/// The solution of three equations for the colours of three corners, by Cramer's rule; `None` if there is none.
fn solved(matrix: &[V3; 3], right: &[V3; 3]) -> Option<[V3; 3]> {
    let [a, b, c] = *matrix;
    let columns = [cross(b, c), cross(c, a), cross(a, b)];
    let determinant = dot(a, columns[0]);
    let corner = |k: usize| (0..3).fold([0.0; 3], |sum, row| add(sum, scale(right[row], columns[row][k] / determinant)));
    (determinant.abs() > 1e-30).then(|| [0, 1, 2].map(corner))
}

/// The largest difference of a channel.
pub(super) fn distance(a: V3, b: V3) -> f64 {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs()).max((a[2] - b[2]).abs())
}
