//! Finds the triangles that each pixel shows.

use super::frame::{Facet, Frame};
use std::ops::Range;

/// Inverse depth that 16 bits, truncated, cannot be relied on to tell apart.
const SLACK: f64 = 2.0 / 65_536.0;

/// Steps per pixel in which edges are compared. Corners on multiples of 1/16 are exact, and so is all that follows.
const STEPS: f64 = 65_536.0;

/// The facets that are seen in a pixel, in the order of drawing: at most one opaque one, and then those through which it is seen. If none of them is
/// opaque, the background is seen.
pub type Sight = Vec<u32>;

/// Largest number of sights in front of one opaque facet. Six close decisions have as many, and all others are taken exactly.
const MOST_SIGHTS: usize = 1 << 6;

/// Whether something is true. That several things are true is as certain as the least certain of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Certainty {
    /// False, however numbers are rounded.
    Never,
    /// False exactly, but perhaps true if numbers are rounded.
    Hardly,
    /// True exactly, but perhaps false if numbers are rounded.
    Nearly,
    /// True, however numbers are rounded.
    Always,
}

impl Certainty {
    /// The certainty of something that is true or false exactly, and the opposite if it is close and numbers are rounded.
    pub(super) fn of(exactly: bool, is_close: bool) -> Self {
        match (exactly, is_close) {
            (false, false) => Self::Never,
            (false, true) => Self::Hardly,
            (true, true) => Self::Nearly,
            (true, false) => Self::Always,
        }
    }

    /// Whether it is exactly so.
    fn is_exact(self) -> bool {
        self >= Self::Nearly
    }

    /// Whether it depends on rounding.
    fn is_close(self) -> bool {
        matches!(self, Self::Hardly | Self::Nearly)
    }
}

/// A facet within whose edges the centre of a pixel lies.
#[derive(Clone, Copy, Debug)]
struct Layer {
    facet: u32,
    inv_depth: f64,
    /// Whether it covers the centre, or has a hole there.
    covers: Certainty,
}

impl Frame {
    /// Per pixel, row by row, what may be seen there. What is seen exactly comes first, then all else that is seen if inverse depths are off by 2 in
    /// 65,536 and places in textures are off by their rounding.
    #[must_use]
    pub fn visible(&self) -> Vec<Vec<Sight>> {
        let (width, height) = self.size;
        let mut layers: Vec<Vec<Layer>> = vec![Vec::new(); width as usize * height as usize];
        for (index, facet) in (0..).zip(&self.facets) {
            for [x, y] in facet.pixels(self.size) {
                let centre = [x, y].map(|c| f64::from(c) + 0.5);
                let layer = Layer { facet: index, inv_depth: facet.inv_depth_at(centre), covers: facet.covers(centre) };
                layers[y as usize * width as usize + x as usize].push(layer);
            }
        }
        layers.into_iter().map(|layers| self.sights(layers)).collect()
    }

    /// What may be seen in a pixel that has these layers, in the order of drawing.
    fn sights(&self, mut layers: Vec<Layer>) -> Vec<Sight> {
        layers.retain(|layer| layer.covers > Certainty::Never);
        let (opaque, clear): (Vec<_>, Vec<_>) = layers.into_iter().partition(|layer| self.facets[layer.facet as usize].transparency == 0.0);
        grounds(opaque).into_iter().flat_map(|ground| through(&clear, ground)).collect()
    }
}

/// What may be seen behind all transparent layers, what is exactly seen first: one of the opaque layers, or the background. Of equally near layers
/// the first drawn comes first.
fn grounds(mut opaque: Vec<Layer>) -> Vec<Option<Layer>> {
    opaque.sort_by(|a, b| b.inv_depth.total_cmp(&a.inv_depth));
    let certain = opaque.iter().find(|layer| layer.covers == Certainty::Always).map(|layer| layer.inv_depth);
    let mut grounds: Vec<_> =
        opaque.into_iter().take_while(|layer| certain.is_none_or(|certain| certain - layer.inv_depth <= SLACK)).map(Some).collect();
    grounds.extend(certain.is_none().then_some(None));
    let exact = grounds.iter().position(|ground| ground.is_none_or(|layer| layer.covers.is_exact())).unwrap_or(0);
    grounds[..=exact].rotate_right(1);
    grounds
}

/// What may be seen of the `ground` through transparent layers in front of it, what is exactly seen first.
fn through(clear: &[Layer], ground: Option<Layer>) -> Vec<Sight> {
    let is_in_front = |layer: &Layer| {
        let distance = ground.map_or(f64::INFINITY, |ground| layer.inv_depth - ground.inv_depth);
        Certainty::of(distance > 0.0, distance.abs() <= SLACK)
    };
    let mut sights = vec![ground.iter().map(|ground| ground.facet).collect::<Sight>()];
    for layer in clear {
        let is_seen = layer.covers.min(is_in_front(layer));
        let mut others = if is_seen.is_close() && sights.len() < MOST_SIGHTS { sights.clone() } else { Vec::new() };
        let with_layer = if is_seen.is_exact() { &mut sights } else { &mut others };
        with_layer.iter_mut().for_each(|sight| sight.push(layer.facet));
        sights.extend(others);
    }
    sights
}

impl Facet {
    /// Inverse depth at a point of the screen.
    #[must_use]
    pub fn inv_depth_at(&self, p: [f64; 2]) -> f64 {
        self.flat_weights(p).iter().zip(self.inv_depth).map(|(w, n)| w * n).sum()
    }

    /// The pixels whose centres lie inside, or on a left or top edge.
    pub fn pixels(&self, size: (u32, u32)) -> impl Iterator<Item = [u32; 2]> + use<> {
        self.samples(1, [0..size.0, 0..size.1])
    }

    /// The samples that lie inside, or on a left or top edge, within a range of columns and of rows, if each side of a pixel is divided into `parts`, which
    /// is a power of two, and each of these parts has a sample in its middle.
    pub fn samples(&self, parts: u32, [columns, rows]: [Range<u32>; 2]) -> impl Iterator<Item = [u32; 2]> + use<> {
        let corners = self.screen.map(|corner| corner.map(|c| (c * STEPS).round() as i64));
        let range = |k: usize, limits: Range<u32>| {
            let (low, high) = self.screen.iter().fold((f64::MAX, f64::MIN), |(low, high), c| (low.min(c[k]), high.max(c[k])));
            // A cast saturates: what lies outside is cut off.
            let place = |c: f64| (c * f64::from(parts)) as u32;
            place(low - 1.0).max(limits.start)..place(high + 1.0).min(limits.end)
        };
        let (columns, rows) = (range(0, columns), range(1, rows));
        rows.flat_map(move |y| columns.clone().map(move |x| [x, y])).filter(move |sample| covers(&corners, parts, *sample))
    }

    /// Whether a point of the screen within the edges lies in a hole of the texture.
    #[must_use]
    pub fn has_hole(&self, p: [f64; 2]) -> bool {
        !self.covers(p).is_exact()
    }
}

/// Whether a sample lies on the right of all three edges, or on one that takes it.
fn covers(corners: &[[i64; 2]; 3], parts: u32, sample: [u32; 2]) -> bool {
    let [x, y] = sample.map(|c| ((f64::from(c) + 0.5) * STEPS / f64::from(parts)) as i64);
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
    use crate::{Levels, Material, Place, phong};

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

    /// A frame of 8 x 8 pixels without lights. Facet `k` has material `k`, which shines by itself.
    fn frame(facets: Vec<Facet>, light: &[Levels]) -> Frame {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let shining =
            |light: &Levels| Material { ambient: light.map(|level| level / 255.0), diffuse: [0.0; 3], specular: [0.0; 3], exponent: 1.0 };
        Frame {
            size: (8, 8),
            facets: facets.into_iter().enumerate().map(|(material, facet)| Facet { material, ..facet }).collect(),
            lights: Vec::new(),
            viewer: Place::Far(axes[2]),
            axes,
            materials: light.iter().map(shining).collect(),
            background: [[16.0, 32.0, 64.0], [86.0, 32.0, 64.0]],
            is_gray: false,
        }
    }

    /// The upper left half of the picture.
    const HALF: [[f64; 2]; 3] = [[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]];
    /// All of it.
    const WHOLE: [[f64; 2]; 3] = [[0.0, 0.0], [16.0, 0.0], [0.0, 16.0]];
    const STEP: f64 = 1.0 / 65_536.0;

    #[test]
    fn the_nearest_comes_first_and_equals_stay() {
        let facets = [0.25, 0.5, 0.5 + STEP, 0.5, 0.5 - 4.0 * STEP].map(|inv_depth| facet(HALF, inv_depth));
        let visible = frame(facets.to_vec(), &[]).visible();
        assert_eq!(visible[0], [[2], [1], [3]]);
        assert_eq!(visible[63], [[]; 1] as [[u32; 0]; 1]);
    }

    fn glass(screen: [[f64; 2]; 3], inv_depth: f64, sixteenths: f64) -> Facet {
        Facet { transparency: sixteenths / 16.0, ..facet(screen, inv_depth) }
    }

    /// Two sheets, the nearer one drawn first, and a plate between them in one half of the picture. The light of each pixel is computed by hand.
    #[test]
    fn sheets_are_mixed_with_what_is_behind_them() {
        let facets = vec![glass(WHOLE, 0.5, 4.0), facet(HALF, 0.4), glass(WHOLE, 0.3, 8.0)];
        let frame = frame(facets, &[[200.0, 40.0, 0.0], [100.0; 3], [0.0, 80.0, 160.0]]);
        let visible = frame.visible();
        let light = |x: u32, y: u32| {
            let (centre, sights) = ([x, y].map(|c| f64::from(c) + 0.5), &visible[(y * 8 + x) as usize]);
            let light = |&facet: &u32| (facet, phong(&frame, &frame.facets[facet as usize])(centre));
            (sights.concat(), frame.mixed(y, sights[0].iter().map(light)))
        };
        let assert_shown = |(sight, light): (Vec<u32>, Levels), facets: &[u32], expected: Levels| {
            assert!(sight == facets && (0..3).all(|k| (light[k] - expected[k]).abs() < 1e-9), "{sight:?} {light:?}");
        };
        // The near sheet over the plate: (12 200 + 4 100) / 16 and so on.
        assert_shown(light(1, 1), &[1, 0], [175.0, 55.0, 25.0]);
        // Over the background of the last row, the near sheet, and then the far one over (12 200 + 4 86) / 16, 38 and 16.
        assert_shown(light(7, 7), &[0, 2], [85.75, 59.0, 88.0]);
        // Four rows above, the background has 40 less red.
        assert_shown(light(7, 3), &[0, 2], [80.75, 59.0, 88.0]);
    }

    /// A sheet is seen in front of a plate, or not, or rounding decides. It does not hide a sheet that is drawn later.
    #[test]
    fn sheets_are_seen_in_front_of_plates() {
        let seen = |depths: &[f64]| {
            let sheets = depths.iter().map(|steps| glass(WHOLE, 0.5 + steps * STEP, 8.0));
            frame([facet(WHOLE, 0.5)].into_iter().chain(sheets).collect(), &[]).visible()[0].clone()
        };
        assert_eq!(seen(&[3.0]), [[0, 1]]);
        assert_eq!(seen(&[-3.0]), [[0]]);
        assert_eq!(seen(&[1.0]), [vec![0, 1], vec![0]]);
        assert_eq!(seen(&[0.0]), [vec![0], vec![0, 1]]);
        assert_eq!(seen(&[9.0, 3.0, -3.0, 5.0]), [[0, 1, 2, 4]]);
        assert_eq!(seen(&[1.0, 3.0, -1.0]), [vec![0, 1, 2], vec![0, 2], vec![0, 1, 2, 3], vec![0, 2, 3]]);
        assert_eq!(seen(&[1.0; 20]).len(), MOST_SIGHTS);
    }
}
