//! The cubic through ten points (Vlasic 2002): lit at the corners, at the thirds of the edges and at the centroid.
//!
//! Cost: three additions of 64 bits a pixel and channel; ten points to light. Continuous: both neighbours light the
//! same thirds. A third to a half of the error of [`super::six_point`]. Domain: any lights.

use super::{Facet, RANGE, Shading};
use crate::{band::Band, pixel::Pixel};

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let [a, b, c] = facet.corners.map(|corner| corner.light);
    let thirds = [[2, 1, 0], [1, 2, 0], [0, 2, 1], [0, 1, 2], [1, 0, 2], [2, 0, 1], [1, 1, 1]];
    let [ab, ba, bc, cb, ca, ac, middle] = thirds.map(|weights| shading.levels(&facet.third(weights, 0)));
    shading.draw_levels::<10, RANGE>(facet, || [a, b, c, ab, ba, bc, cb, ca, ac, middle], band)
}
