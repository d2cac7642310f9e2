//! Points of a triangle where light is computed.

use crate::{
    arch::product::{by_fraction, product},
    features::{COLOURED, PERSPECTIVE, VERTEX_COLOURS},
    format::{COSINE, INVERSE_SUM_LENGTH, POSITION, UNIT},
    lighting::{
        albedo::{Albedo, IfColoured, Parts},
        lights::{InterpolatedNormal, MeanNormal, UnitNormal, cosine, over_length, point, vertex_cosine},
    },
    math::{
        rsqrt::{HalfRsqrt, LEAST, rsqrt_wide},
        vector::{add, dot, map, normalise, sub, wide, zip},
    },
    method::{IN_SPACE, Middles, Shading, TriangleSetup, perspective},
    stream::record::Vertex,
};

/// Fraction bits that the normal of a [`Node`] has beyond those of a vertex.
const FINER: u32 = 30 - UNIT;

/// A point of a triangle and the normal there.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Position in object space, Q7.25.
    pub position: [i32; 3],
    /// Unit normal, Q2.30.
    pub normal: [i32; 3],
    /// The colour of the surface, if the corners of the triangle have colours.
    pub albedo: IfColoured<Option<Albedo>>,
}

impl Node {
    /// The colour of a triangle whose corners have none.
    pub const NO_COLOUR: IfColoured<Option<Albedo>> = [None; COLOURED];
}

/// Whether highlights of this exponent are so steep that rounding of the stream's edge constants to 16 bits would show: an error of 2^-17 in a cosine
/// is 0.1 of 1/255 at the exponent 64, and grows with the exponent. The constants are then computed from the normals.
pub fn is_steep(exponent: u16) -> bool {
    exponent > 64
}

#[doc(hidden)]
impl Shading<'_> {
    /// Computes the light levels of red, green and blue at `node`, a point of the triangle with its unit normal. They are Q9.7 from 0 to
    /// 255.
    pub fn levels(&self, node: &Node) -> [i32; 3] {
        if let Some(albedo) = node.albedo.first().copied().flatten() {
            return albedo.lit(self.parts(node));
        }
        if let Some([towards, half]) = self.constant {
            return self.reflectance.one_light([cosine(node.normal, towards), cosine(node.normal, half)]);
        }
        self.reflectance.levels(self.lighting.incident(node.position, node.normal, None))
    }

    /// The parts of light at `node`.
    pub(crate) fn parts(&self, node: &Node) -> Parts {
        self.reflectance.parts(self.lighting.incident(node.position, node.normal, None))
    }

    /// The parts of light at the [`Middles`] of the edges 0-1, 1-2 and 2-0.
    #[inline(never)]
    pub(crate) fn middle_parts(&self, setup: &TriangleSetup<'_>) -> [Parts; 3] {
        let is_fast = self.lighting.is_constant() && !is_steep(self.exponent);
        if let Some(shares) = setup.middles() {
            if is_fast {
                let parts = |vector, half_reciprocal| {
                    self.reflectance.constant_parts(self.lighting.sources(), &InterpolatedNormal { vector, half_reciprocal })
                };
                return zip(seen_normals(setup.vertices(), shares), setup.half_reciprocals(shares), parts);
            }
            return map(seen_nodes(setup), |node| self.parts(&node));
        }
        if is_fast && let Some(normals) = &setup.middle_normals() {
            return map(normals.each_ref(), |normal| self.reflectance.constant_parts(self.lighting.sources(), normal));
        }
        let [.., ab, bc, ca] = setup.six_nodes(self.exponent);
        [self.parts(&ab), self.parts(&bc), self.parts(&ca)]
    }

    /// Computes the light levels of red, green and blue at the [`Middles`] of the edges 0-1, 1-2 and 2-0. They are Q9.7 from 0 to 255.
    #[inline(never)]
    pub(crate) fn middle_levels(&self, setup: &TriangleSetup<'_>) -> [[i32; 3]; 3] {
        if let Some(shares) = setup.middles() {
            return self.levels_at(setup, shares);
        }
        if self.lighting.is_constant()
            && !is_steep(self.exponent)
            && let Some([ab, bc, ca]) = &setup.middle_normals()
        {
            let [c_ab, c_bc, c_ca] = setup.middle_colours(IN_SPACE);
            let levels = |normal, colour| self.constant_levels(normal, colour);
            return [levels(ab, c_ab), levels(bc, c_bc), levels(ca, c_ca)];
        }
        let [.., ab, bc, ca] = setup.six_nodes(self.exponent);
        [self.levels(&ab), self.levels(&bc), self.levels(&ca)]
    }

    /// The levels of a unit normal under constant lights, on a surface of this colour.
    #[inline(always)]
    pub(crate) fn constant_levels<N: UnitNormal>(&self, normal: &N, colour: IfColoured<Option<Albedo>>) -> [i32; 3] {
        let (reflectance, sources) = (self.reflectance, self.lighting.sources());
        match colour.first().copied().flatten() {
            Some(albedo) => albedo.lit(reflectance.constant_parts(sources, normal)),
            None => reflectance.constant_levels(sources, normal),
        }
    }

    /// The light levels at these shares of the edges.
    #[inline(never)]
    fn levels_at(&self, setup: &TriangleSetup<'_>, shares: [u16; 3]) -> [[i32; 3]; 3] {
        if self.lighting.is_constant() && !is_steep(self.exponent) {
            let levels = |vector, half_reciprocal, colour| self.constant_levels(&InterpolatedNormal { vector, half_reciprocal }, colour);
            let ([ab, bc, ca], [rab, rbc, rca]) = (seen_normals(setup.vertices(), shares), setup.half_reciprocals(shares));
            let [c_ab, c_bc, c_ca] = setup.middle_colours(shares);
            return [levels(ab, rab, c_ab), levels(bc, rbc, c_bc), levels(ca, rca, c_ca)];
        }
        let [ab, bc, ca] = seen_nodes(setup);
        [self.levels(&ab), self.levels(&bc), self.levels(&ca)]
    }
}

#[doc(hidden)]
impl TriangleSetup<'_> {
    /// Returns position and unit normal of each corner in object space, for [`Shading::levels`].
    pub fn corner_nodes(&self) -> [Node; 3] {
        self.painted(self.vertices().map(|vertex| Node {
            position: point(vertex.position),
            normal: wide(vertex.normal).map(|c| c << FINER),
            albedo: Node::NO_COLOUR,
        }))
    }

    /// Returns position and unit normal, in object space, of the three corners and then of the midpoints of the edges 0-1, 1-2 and 2-0.
    /// `exponent` is the material's, which decides how exactly the normals are computed.
    pub fn six_nodes(&self, exponent: u16) -> [Node; 6] {
        let sums = sums(self.vertices());
        let [a, b, c] = self.corner_nodes();
        if is_steep(exponent) {
            let [ab, bc, ca] = sums.map(|(position, sum)| Node { position, normal: normalise(sum), albedo: Node::NO_COLOUR });
            return self.painted([a, b, c, ab, bc, ca]);
        }
        let inverses = self.inverse_sum_lengths();
        let middle = |k: usize| {
            let (position, sum) = sums[k];
            let inverse = inverses[k] as i32;
            // Q3.14 times Q1.17: one bit more than wanted.
            let normal = sum.map(|c| (product(c, inverse) >> (UNIT + INVERSE_SUM_LENGTH - 30)) as i32);
            Node { position, normal, albedo: Node::NO_COLOUR }
        };
        self.painted([a, b, c, middle(0), middle(1), middle(2)])
    }

    /// [`Self::six_nodes`] with the nodes `middles`.
    pub(crate) fn six_nodes_at(&self, middles: Middles, exponent: u16) -> [Node; 6] {
        if middles.is_none() {
            return self.six_nodes(exponent);
        }
        let ([a, b, c], [ab, bc, ca]) = (self.corner_nodes(), seen_nodes(self));
        [a, b, c, ab, bc, ca]
    }

    /// These nodes, which are the corners and then the middles of the edges, with the colours of the triangle.
    #[inline(always)]
    fn painted<const N: usize>(&self, mut nodes: [Node; N]) -> [Node; N] {
        if let Some(colours) = self.six_colours_at(IN_SPACE) {
            nodes.iter_mut().zip(colours).for_each(|(node, colour)| node.albedo = [Some(colour); COLOURED]);
        }
        nodes
    }

    /// The colours at these shares of the edges 0-1, 1-2 and 2-0, if the corners have any.
    pub(crate) fn middle_colours(&self, shares: [u16; 3]) -> [IfColoured<Option<Albedo>>; 3] {
        let colours = self.six_colours_at(shares);
        [3, 4, 5].map(|k| [colours.and_then(|colours| colours.get(k).copied()); COLOURED])
    }

    /// The colours at the corners and the [`Middles`], if the corners have any.
    pub(crate) fn six_colours(&self) -> Option<[Albedo; 6]> {
        self.six_colours_at(self.middles().unwrap_or(IN_SPACE))
    }

    /// The colours at the nodes of a quadratic, if the corners have any.
    pub(crate) fn colours_at_nodes(&self) -> Option<[Albedo; 6]> {
        self.six_colours_at(self.nodes_of_colours.first().copied().flatten().unwrap_or(IN_SPACE))
    }

    /// The colours at the corners and at these shares of the edges 0-1, 1-2 and 2-0, if the corners have any.
    fn six_colours_at(&self, [ab, bc, ca]: [u16; 3]) -> Option<[Albedo; 6]> {
        let [a, b, c] = *self.albedos()?;
        Some([a, b, c, a.towards(b, ab), b.towards(c, bc), c.towards(a, ca)])
    }

    /// The colour where the corners have these weights, if they have colours. The weights are not negative, and their sum is at most 65,536.
    pub fn colour_at(&self, weights: [i32; 3]) -> IfColoured<Option<Albedo>> {
        self.albedos.map(|albedos| Some(Albedo::mean(albedos?, map(weights, |weight| weight as u32))))
    }

    /// Returns for each edge 0-1, 1-2, 2-0 the reciprocal length of the sum of the unit normals at its ends, with 17 fraction bits.
    /// Multiplied by the sum, it gives the unit normal at the midpoint.
    #[inline]
    pub fn inverse_sum_lengths(&self) -> [u32; 3] {
        let [ab, bc, ca] = self.edges(self.triangle.inverse_sum_length);
        if ab.max(bc).max(ca) == u16::MAX {
            let [ab, bc, ca] = wide_inverse_sum_lengths(self.vertices(), [ab, bc, ca]);
            return [ab, bc, ca];
        }
        let inverse = |excess: u16| (1 << (INVERSE_SUM_LENGTH - 1)) + u32::from(excess);
        [inverse(ab), inverse(bc), inverse(ca)]
    }

    /// The cosine N·L (Q2.30) at the corners and the [`Middles`]. Domain: one constant light, and vertices that hold cosines
    /// ([`VertexLight::Cosines`](crate::method::VertexLight::Cosines)).
    #[inline(always)]
    pub(crate) fn six_diffuse(&self) -> [i32; 6] {
        let [a, b, c] = self.corners;
        self.six_at(self.middles(), [a.light[0], b.light[0], c.light[0]])
    }

    /// The cosine N·H (Q2.30) at the same points. `exponent` is the material's highlight exponent; for larger ones it is computed more exactly.
    #[inline(always)]
    pub(crate) fn six_half(&self, exponent: u16) -> [i32; 6] {
        let [a, b, c] = self.corners;
        self.six_half_at(self.middles(), [a.light[1], b.light[1], c.light[1]], exponent)
    }

    /// [`Self::six_from`] for N·H of a directional light and an infinitely distant viewer. `exponent` is the material's; for larger ones it is
    /// computed more exactly.
    #[inline(always)]
    pub(crate) fn six_half_from(&self, corners: [i32; 3], exponent: u16) -> [i32; 6] {
        if is_steep(exponent) { exact_six(self.vertices(), corners) } else { self.six_from(corners) }
    }

    /// Returns the cosine of the normal and a fixed direction (Q2.30) at the three corners and then at the midpoints of the edges 0-1, 1-2
    /// and 2-0, from its values at the corners.
    #[inline(always)]
    pub(crate) fn six_from(&self, [a, b, c]: [i32; 3]) -> [i32; 6] {
        let [ab, bc, ca] = self.edges(self.triangle.inverse_sum_length);
        if ab.max(bc).max(ca) == u16::MAX {
            let [ab, bc, ca] = wide_middles(self.vertices(), [ab, bc, ca], [a, b, c]);
            return [a, b, c, ab, bc, ca];
        }
        // The mean times twice the inverse length: the part above 1/2 adds its share of the mean.
        let middle = |a: i32, b: i32, excess: u16| {
            let mean = (a >> 1) + (b >> 1);
            mean + by_fraction(mean, excess)
        };
        [a, b, c, middle(a, b, ab), middle(b, c, bc), middle(c, a, ca)]
    }

    /// [`Self::six_from`] with the nodes `middles`.
    #[inline(always)]
    pub(crate) fn six_at(&self, middles: Middles, corners: [i32; 3]) -> [i32; 6] {
        match middles {
            Some(shares) if PERSPECTIVE => self.six_seen(shares, corners),
            _ => self.six_from(corners),
        }
    }

    /// [`Self::six_half_from`] with the nodes `middles`.
    #[inline(always)]
    pub(crate) fn six_half_at(&self, middles: Middles, corners: [i32; 3], exponent: u16) -> [i32; 6] {
        match middles {
            Some(_) if PERSPECTIVE && is_steep(exponent) => exact_six_seen(self, corners),
            Some(shares) if PERSPECTIVE => self.six_seen(shares, corners),
            _ => self.six_half_from(corners, exponent),
        }
    }

    /// [`Self::six_from`] with nodes at these shares of the edges.
    #[inline(never)]
    fn six_seen(&self, shares: [u16; 3], [a, b, c]: [i32; 3]) -> [i32; 6] {
        let ([at, bt, ct], [ab, bc, ca]) = (shares, self.half_reciprocals(shares));
        [a, b, c, over_length(mixed(a, b, at), ab), over_length(mixed(b, c, bt), bc), over_length(mixed(c, a, ct), ca)]
    }

    /// Half the reciprocal length of the interpolated normal at these shares of the edges, Q2.30. Domain: it is at least 1/2 long.
    #[inline(always)]
    fn half_reciprocals(&self, [at, bt, ct]: [u16; 3]) -> [i32; 3] {
        let ([ab, bc, ca], lengths) = (self.edges(self.triangle.haversine), HalfRsqrt::get());
        let half_reciprocal = |share: u16, haversine: u16| {
            // With the share s and the haversine h of the edge, the normal has the squared length 1 - 4 s (1 - s) h, Q0.32.
            let bend = (u32::from(share) * ((1 << 16) - u32::from(share))) >> 14;
            let square = 0u32.wrapping_sub(bend.wrapping_mul(haversine.into()));
            lengths.rsqrt(square.wrapping_sub(LEAST)) as i32
        };
        [half_reciprocal(at, ab), half_reciprocal(bt, bc), half_reciprocal(ct, ca)]
    }

    /// Returns the cosines (Q2.30) between the normals of the corners and `direction`, a unit vector in object space (Q2.30).
    #[inline]
    pub fn corner_cosines(&self, direction: [i32; 3]) -> [i32; 3] {
        let [a, b, c] = self.vertices();
        let cosine = |vertex: &Vertex| vertex_cosine(wide(vertex.normal), direction);
        [cosine(a), cosine(b), cosine(c)]
    }

    /// The normals at the midpoints of the edges 01, 12, 20; `None` if the record does not hold the factors of all.
    #[inline]
    fn middle_normals(&self) -> Option<[MeanNormal; 3]> {
        let [ab, bc, ca] = self.edges(self.triangle.inverse_sum_length);
        let [a, b, c] = self.vertices();
        let (a, b, c) = (wide(a.normal), wide(b.normal), wide(c.normal));
        (ab.max(bc).max(ca) != u16::MAX).then(|| [MeanNormal::new(a, b, ab), MeanNormal::new(b, c, bc), MeanNormal::new(c, a, ca)])
    }
}

/// The squared distance of the farthest of three vertices from `position` (Q7.25), Q14.48.
pub(crate) fn farthest(vertices: [&Vertex; 3], position: [i32; 3]) -> u64 {
    let [a, b, c] = map(vertices, |vertex| {
        let half = map(sub(position, point(vertex.position)), |c| c >> 1);
        dot(half, half) as u64
    });
    a.max(b).max(c)
}

/// Position, and sum of the ends' normals (Q3.14), at the middle of each edge between three vertices.
fn sums([a, b, c]: [&Vertex; 3]) -> [([i32; 3], [i32; 3]); 3] {
    [(a, b), (b, c), (c, a)].map(|(a, b)| {
        let position = add(wide(a.position), wide(b.position)).map(|c| c << (POSITION - UNIT - 1));
        (position, add(wide(a.normal), wide(b.normal)))
    })
}

/// The coefficients of the quadratic through six nodes, in the form of Bernstein: their least and their largest are bounds of its values.
pub(crate) fn coefficients([a, b, c, ab, bc, ca]: [i32; 6]) -> [i32; 6] {
    let middle = |a: i32, b: i32, ab: i32| ab + (ab - ((a >> 1) + (b >> 1)));
    [a, b, c, middle(a, b, ab), middle(b, c, bc), middle(c, a, ca)]
}

/// [`TriangleSetup::inverse_sum_lengths`] where the 16 bits of a record (`given`) do not hold all of them.
#[cold]
#[inline(never)]
fn wide_inverse_sum_lengths(vertices: [&Vertex; 3], given: [u16; 3]) -> [u32; 3] {
    zip(sums(vertices), given, |(_, sum), given| {
        if given < u16::MAX {
            return (1 << (INVERSE_SUM_LENGTH - 1)) + u32::from(given);
        }
        let (mantissa, exponent) = rsqrt_wide(dot(sum, sum).max(1) as u64);
        ((u64::from(mantissa) << (UNIT + INVERSE_SUM_LENGTH)) >> exponent).min(i32::MAX as u64) as u32
    })
}

/// Applies `f` to the values at six nodes. It is written out, because `map` is a loop through memory at opt-level "s".
#[inline(always)]
pub fn map_six<A, R>([a, b, c, d, e, g]: [A; 6], f: impl Fn(A) -> R) -> [R; 6] {
    [f(a), f(b), f(c), f(d), f(e), f(g)]
}

/// Cosines at the midpoints, where the 16 bits of a record (`given`) do not hold all constants of edges.
#[cold]
#[inline(never)]
fn wide_middles(vertices: [&Vertex; 3], given: [u16; 3], [a, b, c]: [i32; 3]) -> [i32; 3] {
    let middle = |(a, b): (i32, i32), inverse: u32| (product((a >> 1) + (b >> 1), inverse as i32) >> (INVERSE_SUM_LENGTH - 1)) as i32;
    zip([(a, b), (b, c), (c, a)], wide_inverse_sum_lengths(vertices, given), middle)
}

/// A cosine, Q2.30, at the six nodes, from those at corners, by the lengths of the sums of normals.
#[cold]
#[inline(never)]
fn exact_six(vertices: [&Vertex; 3], [a, b, c]: [i32; 3]) -> [i32; 6] {
    let [ab, bc, ca] = zip(sums(vertices), [(a, b), (b, c), (c, a)], |(_, sum), (a, b)| {
        // 1/|Ni+Nj| is 2^(14 - exponent) times the mantissa.
        let (mantissa, exponent) = rsqrt_wide(dot(sum, sum).max(1) as u64);
        (product((a >> 1) + (b >> 1), mantissa as i32) >> (exponent.max(UNIT + 1) - UNIT - 1)) as i32
    });
    [a, b, c, ab, bc, ca]
}

/// The value at a share of an edge, from those at its ends.
#[inline(always)]
pub(crate) fn mixed(from: i32, to: i32, share: u16) -> i32 {
    from - by_fraction(from, share) + by_fraction(to, share)
}

/// The value at a share, Q2.30, of an edge, from those at its ends.
fn mixed_finely(from: i32, to: i32, share: u32) -> i32 {
    // Rounded to nearest.
    let products = i64::from(from) * i64::from((1u32 << COSINE).wrapping_sub(share)) + i64::from(to) * i64::from(share);
    ((products + (1 << (COSINE - 1))) >> COSINE) as i32
}

/// The sum of the ends' normals of each edge, weighted by its share; Q2.30.
fn seen_normals([a, b, c]: [&Vertex; 3], [ab, bc, ca]: [u16; 3]) -> [[i32; 3]; 3] {
    let sum = |a: &Vertex, b: &Vertex, share: u16| {
        let (from, to) = ((1 << 16) - i32::from(share), i32::from(share));
        zip(wide(a.normal), wide(b.normal), |a, b| a * from + b * to)
    };
    [sum(a, b, ab), sum(b, c, bc), sum(c, a, ca)]
}

/// [`seen_normals`] at shares of Q2.30.
fn fine_normals([a, b, c]: [&Vertex; 3], [ab, bc, ca]: [u32; 3]) -> [[i32; 3]; 3] {
    let normal = |vertex: &Vertex| wide(vertex.normal).map(|c| c << (COSINE - UNIT));
    let sum = |a, b, share| zip(normal(a), normal(b), |a, b| mixed_finely(a, b, share));
    [sum(a, b, ab), sum(b, c, bc), sum(c, a, ca)]
}

/// The points of the edges that are seen at their middles on the screen, with their unit normals.
#[inline(never)]
fn seen_nodes(setup: &TriangleSetup<'_>) -> [Node; 3] {
    let (vertices, shares) = (setup.vertices(), setup.fine_middles());
    let [a, b, c] = vertices.map(|vertex| point(vertex.position));
    let between = |from, to, share| zip(from, to, |from, to| mixed_finely(from, to, share));
    let [ab, bc, ca] = shares;
    let positions = [between(a, b, ab), between(b, c, bc), between(c, a, ca)];
    let node = |position, normal| Node { position, normal: normalise(normal), albedo: Node::NO_COLOUR };
    let mut nodes = zip(positions, fine_normals(vertices, shares), node);
    if VERTEX_COLOURS {
        nodes.iter_mut().zip(setup.middle_colours(map(shares, perspective::rounded))).for_each(|(node, albedo)| node.albedo = albedo);
    }
    nodes
}

/// [`TriangleSetup::six_seen`] by the lengths of the sums of normals and by exact shares, for steep highlights.
#[cold]
#[inline(never)]
fn exact_six_seen(setup: &TriangleSetup<'_>, [a, b, c]: [i32; 3]) -> [i32; 6] {
    let shares = setup.fine_middles();
    let [at, bt, ct] = shares;
    let sums = [mixed_finely(a, b, at), mixed_finely(b, c, bt), mixed_finely(c, a, ct)];
    let [ab, bc, ca] = zip(sums, fine_normals(setup.vertices(), shares), |sum, normal| {
        // 1/|N| is 2^(30 - exponent) times the mantissa, because N has 30 fraction bits.
        let (mantissa, exponent) = rsqrt_wide(dot(normal, normal).max(1) as u64);
        (product(sum, mantissa as i32) >> (exponent.max(30) - 30)) as i32
    });
    [a, b, c, ab, bc, ca]
}

/// Fraction bits of the vectors of a [`field_product`].
pub(super) const FRACTION: u32 = 28;

/// Six nodes of the product of two linear vector fields ([`FRACTION`] fraction bits each), Q2.30.
#[inline(never)]
pub(super) fn field_product(a: &[[i32; 3]; 3], b: &[[i32; 3]; 3]) -> [i32; 6] {
    let ([a0, a1, a2], [b0, b1, b2]) = (*a, *b);
    let corner = |a, b| (dot(a, b) >> (2 * FRACTION - COSINE)) as i32;
    let middle = |a, c, b, d| (dot(add(a, c), add(b, d)) >> (2 * FRACTION + 2 - COSINE)) as i32;
    [corner(a0, b0), corner(a1, b1), corner(a2, b2), middle(a0, a1, b0, b1), middle(a1, a2, b1, b2), middle(a2, a0, b2, b0)]
}
