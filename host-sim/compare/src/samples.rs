//! Points of the screen, each on a facet, and what a method in f64 makes of them.

use microphong_oracle::{Facet, Frame, Levels, Shade, Unsupported};
use rayon::prelude::*;

/// A point of the screen, and its place in the result.
type Point = (usize, [f64; 2]);

/// A function by which a method shades the facet of an index.
pub(super) type Method<'f, 'm> = dyn Fn(usize, &'f Facet) -> Result<Shade<'f>, Unsupported> + Sync + 'm;

/// Points on facets. A method is set up once per facet, whatever the order of its points.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    /// Per facet that has any: its index, and the points.
    by_facet: Vec<(usize, Vec<Point>)>,
    count: usize,
}

impl Samples {
    /// Points, each on the facet of that index.
    #[must_use]
    pub(super) fn new(frame: &Frame, points: impl IntoIterator<Item = (usize, [f64; 2])>) -> Self {
        let mut by_facet: Vec<_> = (0..frame.facets.len()).map(|facet| (facet, Vec::new())).collect();
        let mut count = 0;
        for (place, (facet, point)) in points.into_iter().enumerate() {
            count = place + 1;
            if let Some((_, points)) = by_facet.get_mut(facet) {
                points.push((place, point));
            }
        }
        by_facet.retain(|(_, points)| !points.is_empty());
        Self { by_facet, count }
    }

    /// The levels at all points, in the order in which the points were added, by a method that shades facets.
    ///
    /// # Errors
    /// Errors of the method.
    pub(super) fn shade<'f>(&self, frame: &'f Frame, method: &Method<'f, '_>) -> Result<Vec<Levels>, Unsupported> {
        let shaded: Vec<Vec<Levels>> = self
            .by_facet
            .par_iter()
            .map(|(facet, points)| {
                let shade = method(*facet, &frame.facets[*facet])?;
                Ok(points.iter().map(|&(_, point)| shade(point)).collect())
            })
            .collect::<Result<_, _>>()?;
        let mut levels = vec![[0.0; 3]; self.count];
        for ((_, points), shaded) in self.by_facet.iter().zip(shaded) {
            for (&(place, _), at) in points.iter().zip(shaded) {
                levels[place] = at;
            }
        }
        Ok(levels)
    }
}
