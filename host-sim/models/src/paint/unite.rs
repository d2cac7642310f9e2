//! Colours of corners at one position become one colour, if they are nearly equal.

use super::fit::{Fit, distance};
use crate::{
    mesh::{Mesh, Rgb},
    vector::{V3, add, scale},
};

/// Colours become one if they differ by no more than this share of full.
const ALIKE: f64 = 4.0 / 255.0;

/// The colours of all corners, where colours at one position that are nearly equal have become one. Triangles of one colour keep theirs, as do those
/// that are to be exact.
pub(super) fn united(mesh: &Mesh, fits: &[Option<Fit>], is_exact: &[bool]) -> Vec<Option<[Rgb; 3]>> {
    let places = mesh.places();
    let mut colours: Vec<[V3; 3]> = fits.iter().map(|fit| fit.as_ref().map_or([[0.0; 3]; 3], |fit| fit.corners)).collect();
    // The corners of triangles of several colours, by their places. Other triangles matter only there.
    let count = places.iter().max().map_or(0, |last| last + 1);
    let mut starts = vec![0; count + 1];
    let coloured = || fits.iter().enumerate().filter_map(|(triangle, fit)| Some((triangle, fit.as_ref()?)));
    let corners = || coloured().flat_map(|(triangle, fit)| (0..3).map(move |k| (triangle, k, fit.is_flat || is_exact[triangle])));
    corners().for_each(|(triangle, k, _)| starts[places[mesh.triangles[triangle][k]] + 1] += 1);
    for place in 0..count {
        starts[place + 1] += starts[place];
    }
    let mut next = starts.clone();
    let mut sorted = vec![(0, 0, false); starts[count]];
    for corner @ (triangle, k, _) in corners() {
        let next = &mut next[places[mesh.triangles[triangle][k]]];
        sorted[*next] = corner;
        *next += 1;
    }
    let mut groups: Vec<Group> = Vec::new();
    for range in starts.windows(2) {
        let here = &sorted[range[0]..range[1]];
        if here.iter().all(|&(.., is_flat)| is_flat) {
            continue;
        }
        groups.clear();
        for flat_first in [true, false] {
            for &(triangle, k, _) in here.iter().filter(|&&(.., is_flat)| is_flat == flat_first) {
                let colour = colours[triangle][k];
                let near = groups.iter_mut().filter(|group| distance(group.first, colour) <= if flat_first { 0.0 } else { ALIKE });
                match near.min_by(|one, other| distance(one.first, colour).total_cmp(&distance(other.first, colour))) {
                    Some(group) => group.add(triangle, k, colour),
                    None => groups.push(Group { first: colour, is_flat: flat_first, sum: colour, corners: vec![(triangle, k)] }),
                }
            }
        }
        for group in &groups {
            let colour = if group.is_flat { group.first } else { scale(group.sum, 1.0 / group.corners.len() as f64) };
            group.corners.iter().for_each(|&(triangle, k)| colours[triangle][k] = colour);
        }
    }
    fits.iter().zip(colours).map(|(fit, corners)| fit.as_ref().map(|_| corners.map(rounded))).collect()
}

/// Nearly equal colours at one position.
struct Group {
    first: V3,
    /// Whether it has the colour of a triangle of one colour.
    is_flat: bool,
    sum: V3,
    corners: Vec<(usize, usize)>,
}

impl Group {
    fn add(&mut self, triangle: usize, corner: usize, colour: V3) {
        self.sum = add(self.sum, colour);
        self.corners.push((triangle, corner));
    }
}

fn rounded(colour: V3) -> Rgb {
    colour.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)
}
