//! Closed solids of coloured polygons. All of them are made of rings of points that are joined one after the other, and are then bent, placed and
//! painted.

use crate::{
    mesh::{Corner, Face, Smoothing, Soup, Submesh},
    polygon::newell,
    vector::{V3, add, apply, cross, dot, length, rotation, scale, sub, unit},
};
use std::f64::consts::TAU;

/// Some closed surfaces, of which the front is outside. y points up, and the front of a model is towards +z.
#[derive(Clone, Debug, Default)]
pub(super) struct Solid(Vec<Polygon>);

#[derive(Clone, Debug)]
struct Polygon {
    corners: Vec<V3>,
    colours: Vec<V3>,
    material: usize,
    smoothing: Smoothing,
}

/// A corner that is to be painted.
#[derive(Clone, Copy, Debug)]
pub(super) struct At {
    pub(super) point: V3,
    /// The middle of the polygon. What depends on it alone is one colour for all corners.
    pub(super) middle: V3,
    /// The direction of the polygon.
    pub(super) normal: V3,
}

/// A point of an outline.
pub(super) type Point = [f64; 2];

/// The numbers of the materials: without highlights, with highlights, and with light of its own.
pub(super) const MATT: usize = 0;
pub(super) const GLOSSY: usize = 1;
pub(super) const GLOWING: usize = 2;

impl Solid {
    /// Joins rings of equally many points, and closes the first and the last one. Points run counter-clockwise seen from the last ring, and those
    /// of a pole are all the same.
    pub(super) fn loft(rings: &[Vec<V3>]) -> Self {
        let mut faces = Vec::new();
        for pair in rings.windows(2) {
            let count = pair[0].len();
            faces.extend((0..count).map(|j| vec![pair[0][j], pair[0][(j + 1) % count], pair[1][(j + 1) % count], pair[1][j]]));
        }
        faces.extend(rings.first().map(|ring| ring.iter().rev().copied().collect()));
        faces.extend(rings.last().cloned());
        let polygon = |mut corners: Vec<V3>| {
            corners.dedup();
            if corners.first() == corners.last() {
                corners.pop();
            }
            let colours = vec![[1.0; 3]; corners.len()];
            (corners.len() > 2).then_some(Polygon { corners, colours, material: MATT, smoothing: Smoothing::ByAngle })
        };
        Self(faces.into_iter().filter_map(polygon).collect())
    }

    /// Joins rings as [`Self::loft`] does, and the last one to the first: a body with a hole through it.
    pub(super) fn closed_loft(rings: &[Vec<V3>]) -> Self {
        let around: Vec<_> = rings.iter().chain(rings.first()).cloned().collect();
        let mut solid = Self::loft(&around);
        // The ends meet.
        solid.0.truncate(solid.0.len() - 2);
        solid
    }

    /// Turns a profile of radii and heights, from the bottom to the top, about the y axis.
    pub(super) fn lathe(profile: &[Point], sides: usize) -> Self {
        let ring = |&[radius, height]: &Point| circle(sides).map(|[x, z]| [radius * x, height, radius * z]).collect();
        Self::loft(&profile.iter().map(ring).collect::<Vec<_>>())
    }

    /// A ball of radius 1.
    pub(super) fn ball(sides: usize, bands: usize) -> Self {
        let point = |band: usize| {
            let (sin, cos) = libm::sincos(TAU / 2.0 * band as f64 / bands as f64);
            // The poles are exact, for all points of a pole are to be the same.
            if band.is_multiple_of(bands) { [0.0, -cos] } else { [sin, -cos] }
        };
        Self::lathe(&(0..=bands).map(point).collect::<Vec<_>>(), sides)
    }

    /// Gives a depth to a counter-clockwise outline in the plane of x and y. Bevels run along the edges of its front and its back.
    pub(super) fn prism(outline: &[Point], depth: f64, bevel: f64) -> Self {
        let ring = |by: f64, z: f64| inset(outline, by).into_iter().map(|[x, y]| [x, y, z]).collect::<Vec<_>>();
        let (half, inner) = (depth / 2.0, depth / 2.0 - bevel);
        let rings = [ring(bevel, -half), ring(0.0, -inner), ring(0.0, inner), ring(bevel, half)];
        Self::loft(if bevel > 0.0 { &rings } else { &rings[1..3] })
    }

    /// A block that stands on the middle of its bottom.
    pub(super) fn block([x, y, z]: V3) -> Self {
        let x = x / 2.0;
        Self::prism(&[[-x, 0.0], [x, 0.0], [x, y], [-x, y]], z, 0.0)
    }

    /// A tube along a path, with a radius at each of its points.
    pub(super) fn tube(path: &[(V3, f64)], sides: usize) -> Self {
        let mut rings = Vec::new();
        let mut side = [0.0; 3];
        for (k, &(centre, radius)) in path.iter().enumerate() {
            let (before, after) = (path[k.saturating_sub(1)].0, path[(k + 1).min(path.len() - 1)].0);
            let along = unit(sub(after, before)).unwrap_or([0.0, 1.0, 0.0]);
            let across = if k > 0 { side } else { [along[1], along[2], along[0]] };
            side = unit(sub(across, scale(along, dot(across, along)))).unwrap_or([1.0, 0.0, 0.0]);
            let other = cross(along, side);
            let point = |[x, y]: Point| add(centre, scale(add(scale(side, y), scale(other, x)), radius));
            rings.push(circle(sides).map(point).collect());
        }
        Self::loft(&rings)
    }

    /// All of both.
    pub(super) fn with(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    /// All of several.
    pub(super) fn all(solids: impl IntoIterator<Item = Self>) -> Self {
        solids.into_iter().fold(Self::default(), Self::with)
    }

    /// Moves each point. The map must not make a mirror image.
    pub(super) fn bent(mut self, to: impl Fn(V3) -> V3) -> Self {
        self.0.iter_mut().flat_map(|polygon| &mut polygon.corners).for_each(|point| *point = to(*point));
        self
    }

    /// Moves it.
    pub(super) fn at(self, by: V3) -> Self {
        self.bent(|point| add(point, by))
    }

    /// Stretches it.
    pub(super) fn sized(self, by: V3) -> Self {
        self.bent(|point| [0, 1, 2].map(|k| point[k] * by[k]))
    }

    /// Turns it about an axis of space, by degrees.
    pub(super) fn turned(self, axis: usize, degrees: f64) -> Self {
        let rows = rotation([0, 1, 2].map(|k| f64::from(u8::from(k == axis))), degrees.to_radians());
        self.bent(|point| apply(&rows, point))
    }

    /// Lets its y axis point into a direction.
    pub(super) fn towards(self, direction: V3) -> Self {
        let y = unit(direction).unwrap_or([0.0, 1.0, 0.0]);
        let x = unit(cross(y, [0.0, 0.0, 1.0])).unwrap_or([1.0, 0.0, 0.0]);
        let z = cross(x, y);
        self.bent(|p| add(add(scale(x, p[0]), scale(y, p[1])), scale(z, p[2])))
    }

    /// Its mirror image on the other side of the plane x = 0.
    pub(super) fn mirrored(self) -> Self {
        let mut image = self.sized([-1.0, 1.0, 1.0]);
        for polygon in &mut image.0 {
            polygon.corners.reverse();
            polygon.colours.reverse();
        }
        image
    }

    /// Adds its mirror image on the other side of the plane x = 0.
    pub(super) fn paired(self) -> Self {
        let image = self.clone().mirrored();
        self.with(image)
    }

    /// Moves each point at random, equal points alike.
    pub(super) fn ruffled(self, by: f64) -> Self {
        self.bent(|point| add(point, [0.0, 1.0, 2.0].map(|k| by * (2.0 * chance(add(point, [17.0 * k; 3])) - 1.0))))
    }

    /// Shows all of its facets.
    pub(super) fn faceted(self) -> Self {
        self.smoothed_by(Smoothing::Flat)
    }

    /// Hides all of its edges.
    pub(super) fn smooth(self) -> Self {
        self.smoothed_by(Smoothing::Group(1))
    }

    fn smoothed_by(mut self, smoothing: Smoothing) -> Self {
        self.0.iter_mut().for_each(|polygon| polygon.smoothing = smoothing);
        self
    }

    /// Gives it highlights.
    pub(super) fn glossy(self) -> Self {
        self.made_of(GLOSSY)
    }

    /// Gives it light of its own.
    pub(super) fn glowing(self) -> Self {
        self.made_of(GLOWING)
    }

    fn made_of(mut self, material: usize) -> Self {
        self.0.iter_mut().for_each(|polygon| polygon.material = material);
        self
    }

    /// Paints each corner.
    pub(super) fn painted(mut self, colour: impl Fn(At) -> V3) -> Self {
        for Polygon { corners, colours, .. } in &mut self.0 {
            let middle = scale(corners.iter().copied().fold([0.0; 3], add), 1.0 / corners.len() as f64);
            let normal = unit(newell(corners)).unwrap_or_default();
            let at = |&point| colour(At { point, middle, normal });
            *colours = corners.iter().map(at).collect();
        }
        self
    }

    /// Paints all of it in one colour.
    pub(super) fn of(self, colour: u32) -> Self {
        self.painted(|_| hex(colour))
    }

    /// Paints each of its polygons in one colour between two, at random.
    pub(super) fn mottled(self, colours: [u32; 2]) -> Self {
        self.painted(|at| ramp(&colours, chance(at.middle)))
    }

    /// Paints its corners in the colours of a ramp from its lowest points along an axis to its highest ones.
    pub(super) fn graded(self, axis: usize, colours: &[u32]) -> Self {
        let all = || self.0.iter().flat_map(|polygon| &polygon.corners).map(|point| point[axis]);
        let (low, high) = (all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max));
        self.painted(|at| ramp(colours, (at.point[axis] - low) / (high - low)))
    }

    /// The polygons as a file has them that gives each colour a material in place of its corners; and the colours of the materials.
    pub(super) fn soup_of_materials(mut self) -> (Soup, Vec<V3>) {
        let mut materials = Vec::new();
        for Polygon { colours, material, .. } in &mut self.0 {
            *material = materials.iter().position(|colour| *colour == colours[0]).unwrap_or_else(|| {
                materials.push(colours[0]);
                materials.len() - 1
            });
        }
        let mut soup = self.soup();
        soup.colours.clear();
        soup.faces.iter_mut().flat_map(|face| &mut face.corners).for_each(|corner| corner.colour = None);
        (soup, materials)
    }

    /// The polygons as a file would have them.
    pub(super) fn soup(self) -> Soup {
        let mut soup = Soup::default();
        for Polygon { corners, colours, material, smoothing } in self.0 {
            let first = soup.positions.len();
            let corner = |position| Corner { position, colour: Some(position), ..Corner::default() };
            soup.positions.extend(&corners);
            soup.colours.extend(&colours);
            let corners = (first..soup.positions.len()).map(corner).collect();
            soup.faces.push(Face { corners, submesh: Submesh { material, ..Submesh::default() }, smoothing });
        }
        soup
    }
}

/// Points of a circle of radius 1.
pub(super) fn circle(sides: usize) -> impl Iterator<Item = Point> {
    (0..sides).map(move |side| libm::sincos(TAU * side as f64 / sides as f64).into())
}

/// A rectangle about the origin with these halves of its sides and round corners, counter-clockwise.
pub(super) fn rounded([x, y]: Point, round: f64) -> Vec<Point> {
    let corner = |(k, [right, up]): (f64, Point)| {
        [0.0, 0.5, 1.0].map(|step| {
            let (sin, cos) = libm::sincos((90.0 * (k - 1.0 + step)).to_radians());
            [right * (x - round) + round * cos, up * (y - round) + round * sin]
        })
    };
    let corners = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
    [0.0, 1.0, 2.0, 3.0].into_iter().zip(corners).flat_map(corner).collect()
}

/// A counter-clockwise outline whose sides have moved to the inside.
fn inset(outline: &[Point], by: f64) -> Vec<Point> {
    let count = outline.len();
    let side = |k: usize| {
        let ([x, y], [u, v]) = (outline[k % count], outline[(k + 1) % count]);
        unit([u - x, v - y, 0.0]).unwrap_or_default()
    };
    let corner = |k: usize| {
        let (before, after) = (side(k + count - 1), side(k));
        let reach = by / (1.0 + dot(before, after)).max(0.1);
        [outline[k][0] - reach * (before[1] + after[1]), outline[k][1] + reach * (before[0] + after[0])]
    };
    (0..count).map(corner).collect()
}

/// A number from 0 to 1 that looks random, and is always the same for a point.
pub(super) fn chance(point: V3) -> f64 {
    let mix = |hash: u64, c: f64| (hash ^ (c * 4096.0).round() as i64 as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29);
    let hash = point.into_iter().fold(1, mix).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    (hash >> 40) as f64 / f64::from((1 << 24) - 1)
}

/// The distance from the y axis.
pub(super) fn reach([x, _, z]: V3) -> f64 {
    length([x, 0.0, z])
}

/// A colour that is written as in a file of style.
pub(super) fn hex(colour: u32) -> V3 {
    let [_, channels @ ..] = colour.to_be_bytes();
    channels.map(|c| f64::from(c) / 255.0)
}

/// The colour at a place from 0 to 1 of a ramp through these colours.
pub(super) fn ramp(colours: &[u32], place: f64) -> V3 {
    let last = colours.len() - 1;
    let place = place.clamp(0.0, 1.0) * last as f64;
    let (first, part) = (place.floor().min(last as f64), place.fract());
    let [from, to] = [first as usize, last.min(first as usize + 1)].map(|k| hex(colours[k]));
    add(scale(from, 1.0 - part), scale(to, part))
}
