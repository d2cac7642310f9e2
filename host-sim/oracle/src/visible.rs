//! Finds the triangle that each pixel shows.

use super::frame::{Facet, Frame};

/// Inverse depth that 16 bits, truncated, cannot be relied on to tell apart.
const SLACK: f64 = 2.0 / 65_536.0;

/// Steps per pixel in which edges are compared. Corners on multiples of 1/16 are exact, and so is all that follows.
const STEPS: f64 = 65_536.0;

impl Frame {
    /// Per pixel, row by row, the indices of the facets that may be seen there: the nearest first, then all others that
    /// are as near but for 2 in 65,536. None: background.
    #[must_use]
    pub fn visible(&self) -> Vec<Vec<u32>> {
        let (width, height) = self.size;
        let mut near: Vec<Vec<(f64, u32)>> = vec![Vec::new(); width as usize * height as usize];
        for (index, facet) in (0..).zip(&self.facets) {
            for [x, y] in facet.pixels(self.size) {
                let at = &mut near[y as usize * width as usize + x as usize];
                at.push((facet.inv_depth_at([f64::from(x) + 0.5, f64::from(y) + 0.5]), index));
            }
        }
        near.into_iter().map(contenders).collect()
    }
}

/// Triangles that may be the nearest at a pixel. Of equally near ones the first drawn comes first.
fn contenders(mut at: Vec<(f64, u32)>) -> Vec<u32> {
    at.sort_by(|a, b| b.0.total_cmp(&a.0));
    let nearest = at.first().map_or(0.0, |first| first.0);
    at.into_iter().take_while(|&(inv_depth, _)| nearest - inv_depth <= SLACK).map(|(_, index)| index).collect()
}

impl Facet {
    /// Inverse depth at a point of the screen.
    #[must_use]
    pub fn inv_depth_at(&self, p: [f64; 2]) -> f64 {
        self.flat_weights(p).iter().zip(self.inv_depth).map(|(w, n)| w * n).sum()
    }

    /// The pixels whose centres lie inside, or on a left or top edge.
    pub fn pixels(&self, size: (u32, u32)) -> impl Iterator<Item = [u32; 2]> + use<> {
        let corners = self.screen.map(|corner| corner.map(|c| (c * STEPS).round() as i64));
        let range = |k: usize, end: u32| {
            let (low, high) = self.screen.iter().fold((f64::MAX, f64::MIN), |(low, high), c| (low.min(c[k]), high.max(c[k])));
            // A cast saturates: what lies outside the picture is cut off.
            (low - 1.0) as u32..((high + 1.0) as u32).min(end)
        };
        let (columns, rows) = (range(0, size.0), range(1, size.1));
        rows.flat_map(move |y| columns.clone().map(move |x| [x, y])).filter(move |pixel| covers(&corners, *pixel))
    }
}

/// Whether the centre of `pixel` lies on the right of all three edges, or on one that takes it.
fn covers(corners: &[[i64; 2]; 3], pixel: [u32; 2]) -> bool {
    let [x, y] = pixel.map(|c| (f64::from(c) * STEPS + STEPS / 2.0) as i64);
    (0..3).all(|k| {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let side = dx * (y - a[1]) - dy * (x - a[0]);
        // Clockwise with y down: left edges run upwards, top edges to the right.
        side > 0 || side == 0 && (dy < 0 || dy == 0 && dx > 0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facet(screen: [[f64; 2]; 3], inv_depth: f64) -> Facet {
        Facet { inv_depth: [inv_depth; 3], ..Facet::new(screen, [0, 1, 2], [[0.0, 0.0, 1.0]; 3], [[0.0; 3]; 3]) }
    }

    /// A fan around a pixel centre, spokes through other centres: every pixel of the square belongs to exactly one part.
    #[test]
    fn neighbours_share_no_pixel_and_leave_none() {
        let hub = [4.5, 3.5];
        let rim = [[0.5, 0.5], [8.5, 0.5], [8.5, 3.5], [8.5, 8.5], [4.5, 8.5], [0.5, 8.5], [0.5, 5.5]];
        let mut count = [[0; 10]; 10];
        for k in 0..rim.len() {
            for [x, y] in facet([hub, rim[k], rim[(k + 1) % rim.len()]], 0.5).pixels((10, 10)) {
                count[y as usize][x as usize] += 1;
            }
        }
        for (y, row) in count.iter().enumerate() {
            for (x, &n) in row.iter().enumerate() {
                // Top and left edges take their pixels, bottom and right ones do not.
                assert_eq!(n, i32::from(x < 8 && y < 8), "{x} {y}");
            }
        }
    }

    #[test]
    fn pixels_outside_the_picture_are_cut_off() {
        let wide = facet([[-50.0, -50.0], [100.0, -50.0], [-50.0, 100.0]], 0.5);
        assert_eq!(wide.pixels((7, 5)).count(), 35);
        assert_eq!(facet([[-50.0, -50.0], [-40.0, -50.0], [-50.0, -40.0]], 0.5).pixels((7, 5)).count(), 0);
    }

    #[test]
    fn the_nearest_comes_first_and_equals_stay() {
        let square = [[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]];
        let step = 1.0 / 65_536.0;
        let facets = [0.25, 0.5, 0.5 + step, 0.5, 0.5 - 4.0 * step].map(|inv_depth| facet(square, inv_depth));
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let viewer = crate::Place::Far(axes[2]);
        let frame =
            Frame { size: (8, 8), facets: facets.to_vec(), lights: Vec::new(), viewer, axes, materials: Vec::new(), is_gray: false };
        let visible = frame.visible();
        assert_eq!(visible[0], [2, 1, 3]);
        assert!(visible[63].is_empty());
    }
}
