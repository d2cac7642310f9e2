//! A wooden drawing figure: round limbs of about 2,000 triangles in two materials.

use super::solid::Solid;
use crate::vector::V3;

const WOOD: u32 = 0xd9_a566;
const JOINT: u32 = 0x8a_5a33;

pub(super) fn model() -> Solid {
    let arms = arm([0.62, 0.45, 0.2]).with(arm([0.5, -0.6, 0.35]).mirrored());
    let legs = leg(0.16).with(leg(-0.22).mirrored());
    Solid::all([head(), trunk(), arms, legs, stand()])
}

/// An egg about a point.
fn egg(at: V3, size: V3, [sides, bands]: [usize; 2]) -> Solid {
    Solid::ball(sides, bands).bent(|[x, y, z]| [x * (1.0 - 0.18 * y), y, z * (1.0 - 0.18 * y)]).sized(size).at(at).smooth().of(WOOD)
}

fn joint(at: V3, radius: f64) -> Solid {
    Solid::ball(7, 4).sized([radius; 3]).at(at).smooth().of(JOINT)
}

/// A limb that is thickest at a third of its way.
fn limb(from: V3, to: V3, radius: f64) -> Solid {
    let profile = [(0.0, 0.55), (0.1, 0.8), (0.35, 1.0), (0.9, 0.66), (1.0, 0.45)];
    let path = profile.map(|(place, share)| ([0, 1, 2].map(|k| from[k] + place * (to[k] - from[k])), radius * share));
    Solid::tube(&path, 9).smooth().of(WOOD)
}

fn head() -> Solid {
    let skull = egg([0.0, 1.86, 0.03], [0.15, 0.21, 0.17], [13, 9]);
    skull.with(limb([0.0, 1.72, 0.0], [0.0, 1.56, 0.0], 0.07)).with(joint([0.0, 1.69, 0.0], 0.06))
}

fn trunk() -> Solid {
    let chest = egg([0.0, 1.36, 0.0], [0.24, 0.27, 0.15], [14, 8]);
    let waist = joint([0.0, 1.08, 0.0], 0.11);
    let hips = Solid::ball(13, 6).sized([0.22, 0.16, 0.15]).at([0.0, 0.93, 0.0]).smooth().of(WOOD);
    Solid::all([chest, waist, hips])
}

/// An arm whose hand is as far from the shoulder.
fn arm([x, y, z]: V3) -> Solid {
    let (shoulder, hand) = ([0.3, 1.5, 0.0], [0.3 + 0.7 * x, 1.5 + 0.7 * y, z]);
    let elbow = [shoulder[0] + 0.55 * x, shoulder[1] + 0.25 * y - 0.1, 0.3 * z];
    let palm = Solid::ball(8, 5).sized([0.05, 0.1, 0.04]).towards([x, y, z]).at(hand).smooth().of(WOOD);
    Solid::all([joint(shoulder, 0.085), limb(shoulder, elbow, 0.085), joint(elbow, 0.06), limb(elbow, hand, 0.065), palm])
}

/// A leg that steps so far forward.
fn leg(step: f64) -> Solid {
    let (hip, knee, ankle) = ([0.12, 0.86, 0.0], [0.14, 0.5, 0.6 * step + 0.06], [0.15, 0.1, step]);
    let foot = Solid::ball(9, 5).sized([0.07, 0.06, 0.15]).bent(|[x, y, z]| [x, y.max(-0.045), z]).at([0.15, 0.06, step + 0.07]);
    Solid::all([joint(hip, 0.09), limb(hip, knee, 0.105), joint(knee, 0.07), limb(knee, ankle, 0.08), foot.smooth().of(WOOD)])
}

fn stand() -> Solid {
    Solid::lathe(&[[0.0, -0.06], [0.52, -0.06], [0.55, -0.04], [0.55, -0.01], [0.52, 0.01], [0.0, 0.01]], 24).of(JOINT)
}
