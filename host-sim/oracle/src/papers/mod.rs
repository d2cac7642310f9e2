//! Claims of the papers, computed again.
//!
//! Only the papers' figures are stored. Ours are computed from the oracle and the printed formulas when they are asked for, in 64-bit floating point.
//! Random examples start from fixed seeds.

mod bishop_weimer;
mod disselkoen;
mod goldman;
mod szirmay_kalos;
mod vlasic;

use crate::{Facet, Frame, Light, Material, Place};
use anyhow::Result;
use microphong_models::{
    mesh::Mesh,
    vector::{V3, apply, product, rotation, unit},
};
use serde::{Serialize, Serializer};
use std::{borrow::Cow, f64::consts::TAU, fmt};

/// A claim and its verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// Whose claim it is.
    pub topic: Topic,
    /// Author, year and place.
    pub source: String,
    /// The claim, or the name of the figures.
    pub what: String,
    /// Unit of both figures; empty for plain numbers.
    pub unit: &'static str,
    /// The paper's figure; of an erratum, what the printed formula comes to.
    pub paper: Value,
    /// Ours; of an erratum, what the corrected formula comes to.
    pub ours: Value,
    /// Whether the claim stands.
    pub verdict: Verdict,
    /// Why, in one sentence.
    pub note: String,
}

/// A paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topic {
    /// Vlasic 2002.
    Vlasic,
    /// Szirmay-Kalos and others 2000.
    SzirmayKalos,
    /// Bishop and Weimer 1986.
    BishopWeimer,
    /// Disselkoen 1991, and Kuijk and Blake 1989, whom he improves.
    Disselkoen,
    /// Goldman's lecture.
    Goldman,
}

impl Topic {
    /// All papers.
    pub const ALL: [Self; 5] = [Self::Vlasic, Self::SzirmayKalos, Self::BishopWeimer, Self::Disselkoen, Self::Goldman];

    /// Name of the paper on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Vlasic => "vlasic",
            Self::SzirmayKalos => "szirmay-kalos",
            Self::BishopWeimer => "bishop-weimer",
            Self::Disselkoen => "disselkoen",
            Self::Goldman => "goldman",
        }
    }

    /// Author and year.
    #[must_use]
    pub fn author(self) -> &'static str {
        match self {
            Self::Vlasic => "Vlasic 2002",
            Self::SzirmayKalos => "Szirmay-Kalos et al. 2000",
            Self::BishopWeimer => "Bishop & Weimer 1986",
            Self::Disselkoen => "Disselkoen 1991",
            Self::Goldman => "Goldman, lecture",
        }
    }
}

impl Serialize for Topic {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// Verdict on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The claim holds.
    Confirmed,
    /// The claim almost holds.
    Close,
    /// The claim does not hold.
    Refuted,
    /// The paper does not give what is needed to decide.
    NotReproducible,
}

impl Verdict {
    /// All verdicts.
    pub const ALL: [Self; 4] = [Self::Confirmed, Self::Close, Self::Refuted, Self::NotReproducible];

    /// The verdict in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Confirmed => "confirmed",
            Self::Close => "close",
            Self::Refuted => "refuted",
            Self::NotReproducible => "cannot be reproduced",
        }
    }

    /// The verdict on an error: confirmed up to `good`, close up to `fair`, refuted beyond.
    fn at_most(value: f64, good: f64, fair: f64) -> Self {
        if value <= good {
            Self::Confirmed
        } else if value <= fair {
            Self::Close
        } else {
            Self::Refuted
        }
    }
}

/// A figure, or what a paper says instead of one.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A figure.
    Number(f64),
    /// Words.
    Text(Cow<'static, str>),
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<&'static str> for Value {
    fn from(text: &'static str) -> Self {
        Self::Text(text.into())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text.into())
    }
}

impl fmt::Display for Value {
    /// Four digits that count.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) => f.pad(text),
            Self::Number(number) => {
                let size = number.abs();
                let text = if size.fract() == 0.0 && size < 1e6 {
                    format!("{number}")
                } else if (1e-3..1e6).contains(&size) {
                    format!("{number:.*}", (3.0 - size.log10().floor()).clamp(0.0, 6.0) as usize)
                } else {
                    format!("{number:.1e}")
                };
                f.pad(&text)
            }
        }
    }
}

/// All claims of a paper.
///
/// # Errors
/// When a built-in scene cannot be drawn.
pub fn claims(topic: Topic) -> Result<Vec<Claim>> {
    let mut claims = match topic {
        Topic::Vlasic => vlasic::claims()?,
        Topic::SzirmayKalos => szirmay_kalos::claims()?,
        Topic::BishopWeimer => bishop_weimer::claims()?,
        Topic::Disselkoen => disselkoen::claims(),
        Topic::Goldman => goldman::claims(),
    };
    // Claims of one place stand together, places as they first come.
    let mut places: Vec<String> = Vec::new();
    for claim in &claims {
        if !places.contains(&claim.source) {
            places.push(claim.source.clone());
        }
    }
    claims.sort_by_key(|claim| places.iter().position(|place| *place == claim.source));
    Ok(claims)
}

/// A place in a paper.
#[derive(Clone, Copy, Debug)]
struct Source(Topic, &'static str);

impl Source {
    /// A claim made there.
    fn claim(
        self,
        what: impl Into<String>,
        unit: &'static str,
        paper: impl Into<Value>,
        ours: impl Into<Value>,
        (verdict, note): (Verdict, impl Into<String>),
    ) -> Claim {
        let source = format!("{}, {}", self.0.author(), self.1);
        Claim { topic: self.0, source, what: what.into(), unit, paper: paper.into(), ours: ours.into(), verdict, note: note.into() }
    }

    /// A formula on an example: as printed, as it should read, and by direct evaluation.
    fn formula(self, what: &str, [printed, corrected, truth]: [f64; 3], correction: &str) -> Claim {
        let meets = |value: f64| (value - truth).abs() <= SAME * (1.0 + truth.abs());
        let direct = Value::from(truth);
        let judged = match (meets(printed), meets(corrected)) {
            (true, _) => (Verdict::Confirmed, format!("{correction}; direct evaluation gives {direct}.")),
            (false, true) => (Verdict::Refuted, format!("{correction}; direct evaluation gives {direct}.")),
            (false, false) => (Verdict::NotReproducible, format!("Neither it nor the correction gives the direct evaluation's {direct}.")),
        };
        self.claim(what, "", printed, corrected, judged)
    }

    /// A formula that is right as printed: its largest difference to direct evaluation.
    fn identity(self, what: &str, difference: f64, note: &str) -> Claim {
        let verdict = if difference <= SAME { Verdict::Confirmed } else { Verdict::Refuted };
        self.claim(what, "", "exact", difference, (verdict, note))
    }
}

/// Largest difference, relative to the result plus one, of formulas that count as equal.
const SAME: f64 = 1e-7;

/// Numbers that look random: the generator SplitMix64 (Steele, Lea, Flood 2014).
#[derive(Clone, Debug)]
struct Random(u64);

impl Random {
    /// A random number in [0, 1).
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ z >> 31) >> 11) as f64 / 53f64.exp2()
    }

    /// Evenly between two numbers.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// Normally distributed about zero (Box and Muller 1958).
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.share()).ln()).sqrt();
        radius * (TAU * self.share()).cos()
    }

    /// Three of them.
    fn normals(&mut self) -> V3 {
        [self.normal(), self.normal(), self.normal()]
    }

    /// Any direction is as likely as any other.
    fn direction(&mut self) -> V3 {
        direction(self.normals())
    }
}

/// The unit vector along `v`; zero for zero.
fn direction(v: V3) -> V3 {
    unit(v).unwrap_or_default()
}

/// The largest of some numbers.
fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::MIN, f64::max)
}

/// Affine coordinates of the points of a grid with `steps` steps along each edge.
fn grid(steps: usize) -> impl Iterator<Item = V3> {
    (0..=steps).flat_map(move |i| (0..=steps - i).map(move |j| [i, j, steps - i - j].map(|k| k as f64 / steps as f64)))
}

/// The points at which the row of height `y` enters and leaves a triangle.
fn row(screen: &[[f64; 2]; 3], y: f64) -> Option<[f64; 2]> {
    let crossings = (0..3).filter_map(|k| {
        let ([x0, y0], [x1, y1]) = (screen[k], screen[(k + 1) % 3]);
        (y0.min(y1) <= y && y <= y0.max(y1) && y0 != y1).then(|| x0 + (y - y0) / (y1 - y0) * (x1 - x0))
    });
    let [low, high] = crossings.fold([f64::MAX, f64::MIN], |[low, high], x| [low.min(x), high.max(x)]);
    (low <= high).then_some([low, high])
}

/// Value, gradient by x and y, and half the second derivatives by xx, xy and yy, as a polynomial's coefficients
/// `[t0, t1, t2, t3, t4, t5]` of 1, y, x, y², xy and x²: Taylor's, by differences.
fn taylor(f: impl Fn(f64, f64) -> f64) -> [f64; 6] {
    let differences = |h: f64| {
        let at = |i: f64, j: f64| f(i * h, j * h);
        [
            at(0.0, 0.0),
            (at(0.0, 1.0) - at(0.0, -1.0)) / (2.0 * h),
            (at(1.0, 0.0) - at(-1.0, 0.0)) / (2.0 * h),
            (at(0.0, 1.0) - 2.0 * at(0.0, 0.0) + at(0.0, -1.0)) / (2.0 * h * h),
            (at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)) / (4.0 * h * h),
            (at(1.0, 0.0) - 2.0 * at(0.0, 0.0) + at(-1.0, 0.0)) / (2.0 * h * h),
        ]
    };
    // Richardson's step cancels the error of second order.
    let (coarse, fine) = (differences(4e-3), differences(2e-3));
    std::array::from_fn(|k| (4.0 * fine[k] - coarse[k]) / 3.0)
}

/// `t0 + t1 y + t2 x + t3 y² + t4 xy + t5 x²`.
fn polynomial(t: [f64; 6], x: f64, y: f64) -> f64 {
    t[0] + t[1] * y + t[2] * x + t[3] * y * y + t[4] * x * y + t[5] * x * x
}

/// A colourless material.
fn grey(diffuse: f64, specular: f64, exponent: f64) -> Material {
    Material { ambient: [0.0; 3], diffuse: [diffuse; 3], specular: [specular; 3], exponent }
}

/// A frame in the eye's own axes, z towards the eye, with one white light.
fn frame(side: u32, facets: Vec<Facet>, light: Place, viewer: Place, material: Material) -> Frame {
    Frame {
        size: (side, side),
        facets,
        lights: vec![Light::even(light, [1.0; 3])],
        viewer,
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        materials: vec![material],
        background: [[0.0; 3]; 2],
        is_gray: false,
    }
}

/// A mesh in parallel projection, half diffuse and half specular, a far light over the viewer's left shoulder.
fn distant(mesh: &Mesh, exponent: f64) -> Frame {
    const SIDE: u32 = 256;
    let rows = product(&rotation([1.0, 0.0, 0.0], 0.5), &rotation([0.0, 1.0, 0.0], 0.35));
    let place = |[x, y, _]: V3| [x, -y].map(|c| f64::from(SIDE) * (0.5 + 0.46 * c));
    let facets = mesh.triangles.iter().filter_map(|&[a, b, c]| {
        let vertices = [a, c, b];
        let [positions, normals] = [&mesh.positions, &mesh.normals].map(|v| vertices.map(|k| apply(&rows, v[k])));
        let screen @ [p, q, r] = positions.map(place);
        let area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        (area > 1e-6).then(|| Facet::new(screen, vertices, normals, positions))
    });
    let light = Place::Far(direction([-0.4, 0.5, 0.77]));
    frame(SIDE, facets.collect(), light, Place::Far([0.0, 0.0, 1.0]), grey(0.5, 0.5, exponent))
}

/// The centre of a pixel.
fn centre(pixel: [u32; 2]) -> [f64; 2] {
    pixel.map(|c| f64::from(c) + 0.5)
}
