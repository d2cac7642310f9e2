//! Rotations as the texts of scenes say them, and the ways between them.
//!
//! A player goes the shorter way from key to key, along the chord between two quaternions. A text that says angles says more: how often
//! something turns, and which way round. Where the chord leads elsewhere, keys are put in between.

use crate::{
    number::nearest,
    vector::{V3, add, length, scale, sub, unit},
};
use microphong::{
    format::{Length, Rotation, Scale},
    stream::record::Key,
};

/// A rotation.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Turn {
    /// About a unit axis, in degrees.
    About(V3, f64),
    /// About y, then x, then z of the object, in degrees.
    Euler(V3),
    /// A unit quaternion w, x, y, z.
    Quaternion([f64; 4]),
}

/// A pose in a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    pub(crate) key: Key,
    pub(crate) turn: Turn,
}

/// Degrees by which a chord may be off before keys are put in between. Ways of up to a quarter of a turn about one axis need none.
const COARSE: f64 = 1.0;
/// Degrees by which it may be off between these keys.
const FINE: f64 = 0.1;

impl Turn {
    /// No rotation.
    pub(crate) const NONE: Self = Self::Euler([0.0; 3]);

    /// A unit quaternion w, x, y, z.
    fn quaternion(self) -> [f64; 4] {
        match self {
            Self::About(axis, degrees) => about(axis, degrees),
            Self::Euler([yaw, pitch, roll]) => {
                let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
                times(times(about(y, yaw), about(x, pitch)), about(z, roll))
            }
            Self::Quaternion(quaternion) => quaternion,
        }
    }

    /// The quaternion as a key has it.
    fn bits(self) -> [i32; 4] {
        self.quaternion().map(|c| nearest::<Rotation>(c).to_bits())
    }

    /// The axis, as many degrees long as it turns; no rotation has any axis.
    fn vector(self) -> Option<V3> {
        match self {
            Self::About(axis, degrees) => Some(scale(axis, degrees)),
            Self::Euler([0.0, 0.0, 0.0]) => Some([0.0; 3]),
            _ => None,
        }
    }

    fn euler(self) -> Option<V3> {
        match self {
            Self::About(_, 0.0) => Some([0.0; 3]),
            Self::Euler(euler) => Some(euler),
            _ => None,
        }
    }

    /// A share of the way to another rotation, at even speed; `None` where the two do not both say angles, of one kind.
    fn towards(self, to: Self, share: f64) -> Option<Self> {
        let mean = |(from, to): (V3, V3)| add(from, scale(sub(to, from), share));
        let vector = self.vector().zip(to.vector()).map(mean);
        let vector = vector.map(|vector| unit(vector).map_or(Self::NONE, |axis| Self::About(axis, length(vector))));
        vector.or_else(|| self.euler().zip(to.euler()).map(mean).map(Self::Euler))
    }
}

impl Stop {
    /// A pose at the position `at`, at the size of the mesh.
    pub(crate) fn new(frame: u32, at: V3, turn: Turn) -> Self {
        let position = at.map(|c| nearest::<Length>(c).to_bits());
        Self { key: Key { frame, rotation: turn.bits(), position, scale: Scale::ONE.to_bits() }, turn }
    }

    /// The pose in a frame on the way to another stop; `None` where the way is the chord between their keys.
    fn towards(&self, to: &Self, frame: u32) -> Option<Key> {
        let share = f64::from(frame - self.key.frame) / f64::from(to.key.frame - self.key.frame);
        let mean = |from: f64, to: f64| (from + (to - from) * share).round();
        let rotation = self.turn.towards(to.turn, share)?.bits();
        let position = [0, 1, 2].map(|k| mean(self.key.position[k].into(), to.key.position[k].into()) as i32);
        Some(Key { frame, rotation, position, scale: mean(self.key.scale.into(), to.key.scale.into()) as u32 })
    }
}

/// The keys of a way from stop to stop.
pub(crate) fn along(stops: &[Stop]) -> Vec<Key> {
    let mut keys = Vec::new();
    for (i, stop) in stops.iter().enumerate() {
        keys.push(stop.key);
        // Nothing moves that is hidden, nor before it is hidden.
        if let Some(next) = stops.get(i + 1).filter(|next| stop.key.scale.min(next.key.scale) > 0) {
            divide(&mut keys, &|frame| stop.towards(next, frame), [stop.key, next.key], COARSE);
        }
    }
    keys
}

/// Adds keys between two of a way, if the chord is off by more than `allowed` degrees in one of the frames between them.
fn divide(keys: &mut Vec<Key>, way: &impl Fn(u32) -> Option<Key>, [from, to]: [Key; 2], allowed: f64) {
    let is_off = |frame| way(frame).is_some_and(|key| off(&from, &to, &key) > allowed);
    if !(from.frame + 1..to.frame).any(is_off) {
        return;
    }
    if let Some(middle) = way(from.frame.midpoint(to.frame)) {
        divide(keys, way, [from, middle], FINE);
        keys.push(middle);
        divide(keys, way, [middle, to], FINE);
    }
}

/// The angle, in degrees, between the chord from one key to another and a third key.
fn off(from: &Key, to: &Key, key: &Key) -> f64 {
    let [from_rotation, to_rotation, wanted] = [from, to, key].map(|key| key.rotation.map(|c| f64::from(c) / f64::from(1 << 30)));
    let product = |a: [f64; 4], b: [f64; 4]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let cosine = product(from_rotation, to_rotation);
    // About half a turn, the last bit decides which way is the shorter one.
    if cosine.abs() < 0.1 {
        return f64::INFINITY;
    }
    let share = f64::from(key.frame - from.frame) / f64::from(to.frame - from.frame);
    let chord: [f64; 4] = [0, 1, 2, 3].map(|k| from_rotation[k] * (1.0 - share) + to_rotation[k] * share * cosine.signum());
    let cosine = product(chord, wanted).abs() / product(chord, chord).sqrt();
    2.0 * libm::acos(cosine.min(1.0)).to_degrees()
}

/// The quaternion of a rotation about a unit axis.
fn about([x, y, z]: V3, degrees: f64) -> [f64; 4] {
    let (sin, cos) = libm::sincos(degrees.to_radians() / 2.0);
    [cos, x * sin, y * sin, z * sin]
}

/// The product of two quaternions.
fn times([a, b, c, d]: [f64; 4], [w, x, y, z]: [f64; 4]) -> [f64; 4] {
    [a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w]
}
