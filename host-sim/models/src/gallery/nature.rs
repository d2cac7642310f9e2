//! What grows, and what it grows on.

use super::solid::{At, Solid, chance, ramp};
use crate::vector::{V3, add, scale};

/// A round piece of meadow with earth below it, whose top is at the height 0 but for what `height` adds.
pub(super) fn meadow(radius: f64, sides: usize, grass: [u32; 2], height: impl Fn(V3) -> f64) -> Solid {
    let rings = [[0.0, -0.5], [0.55, -0.42], [0.86, -0.24], [1.0, -0.07], [1.0, 0.0], [0.72, 0.0], [0.38, 0.0], [0.0, 0.0]];
    let colour = |At { point, middle, normal }: At| {
        let earth = ramp(&[0x5b_4034, 0x7d_5a41, 0xa8_7b51], point[1] / 0.42 + 1.0);
        if normal[1] > 0.6 && middle[1] > -0.03 { ramp(&grass, chance(middle)) } else { earth }
    };
    let jagged = |p: V3| scale(p, if p[1] < -0.01 { 1.0 + 0.16 * (chance(p) - 0.5) } else { 1.0 });
    let risen = |p: V3| if p[1] > -0.01 { add(p, [0.0, height(p), 0.0]) } else { p };
    Solid::lathe(&rings, sides).bent(jagged).sized([radius; 3]).bent(risen).faceted().painted(colour)
}

/// A tree with needles: three cones above each other, lighter towards their tips.
pub(super) fn conifer(height: f64) -> Solid {
    let cone = |k: usize| {
        let k = k as f64;
        let (low, radius) = (0.22 + 0.22 * k, 0.30 - 0.07 * k);
        Solid::lathe(&[[0.0, low + 0.07], [radius, low], [0.0, low + 0.34]], 5).turned(1, 25.0 * k)
    };
    let trunk = Solid::lathe(&[[0.075, 0.0], [0.055, 0.4]], 3).graded(1, &[0x5a_3a28, 0x7a_5235]);
    let needles = Solid::all((0..3).map(|k| cone(k).graded(1, &[0x1f_5a45, 0x3f_8f58, 0x7d_b866]))).faceted();
    trunk.with(needles).sized([height; 3])
}

/// A crown or bush: a rough ball, lighter on top.
pub(super) fn foliage(size: V3, seed: f64, colours: &[u32]) -> Solid {
    Solid::ball(6, 4).at([seed, 0.0, 0.0]).ruffled(0.13).at([-seed, 0.0, 0.0]).sized(size).faceted().graded(1, colours)
}

/// A stone, whose facets are of different greys.
pub(super) fn stone(size: V3, seed: f64) -> Solid {
    Solid::ball(5, 4).at([seed, 0.0, 0.0]).ruffled(0.2).at([-seed, 0.0, 0.0]).sized(size).faceted().mottled([0x77_7c86, 0xa7_a9a8])
}

/// A flower on its stalk, or a mushroom, by its colours and proportions.
pub(super) fn sprout(height: f64, cap: [f64; 2], colours: [u32; 2]) -> Solid {
    let [width, thick] = cap;
    let stalk = Solid::lathe(&[[0.22 * width, 0.0], [0.16 * width, height]], 3).of(colours[0]);
    let head = Solid::lathe(&[[0.0, height - 0.1 * thick], [width, height], [0.6 * width, height + 0.7 * thick], [0.0, height + thick]], 5);
    stalk.with(head.of(colours[1]).faceted())
}
