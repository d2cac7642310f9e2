//! What the methods cost, counted by hand from their formulas.
//!
//! One white directional light and an infinitely far viewer, one channel. Material gains are folded into what is
//! walked or looked up. A table that is interpolated counts as one load, one multiplication and one addition if its index
//! spreads (reciprocal roots), as a load alone if its entries are that fine (powers). Divisions and roots count as
//! multiplications. These are the operations of the formulas, not the instructions that a compiler makes of them:
//! `microphong bench` counts those.

use serde::Serialize;

/// Operations of one method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Costs {
    /// Additions per pixel.
    pub adds: u32,
    /// Multiplications and divisions per pixel.
    pub multiplies: u32,
    /// Table look-ups per pixel.
    pub loads: u32,
    /// Operations to set up one triangle; where it depends on the triangle, one that is not split further.
    pub setup: u32,
    /// Operations to set up one row of a triangle, beyond the forward differences of its edges.
    pub row: u32,
}

const fn costs(adds: u32, multiplies: u32, loads: u32, setup: u32) -> Costs {
    Costs { adds, multiplies, loads, setup, row: 0 }
}

/// A linear field takes 10 operations, a lit node 30, a quadratic 45.
const TABLE: [(&str, Costs); 26] = [
    ("flat", costs(0, 0, 0, 5)),
    ("gouraud", costs(1, 0, 0, 10)),
    // Three nodes, four linear fields.
    ("gouraud4", costs(1, 0, 0, 130)),
    // Split twice: twelve nodes, sixteen linear fields.
    ("pseudo-phong", costs(1, 0, 0, 520)),
    // Where a highlight is; one addition per pixel elsewhere.
    ("highlight-test", costs(11, 12, 2, 35)),
    ("six-point", costs(2, 0, 0, 135)),
    // One more node and its comparison.
    ("six-point-centre", costs(2, 0, 0, 175)),
    // Two more nodes on each edge besides.
    ("six-point-adaptive", costs(2, 0, 0, 355)),
    // Seven nodes, the change of basis.
    ("cubic", costs(3, 0, 0, 330)),
    ("sqrt6", costs(5, 0, 1, 175)),
    ("renq", costs(5, 2, 1, 60)),
    ("renq-newton", costs(7, 5, 1, 85)),
    ("duff", costs(6, 3, 2, 60)),
    ("taylor", costs(5, 0, 1, 180)),
    // Twenty-one scalar products, two sets of six coefficients.
    ("taylor-finite", costs(5, 0, 1, 550)),
    // Step N (3 adds), |N|² (2, 3), its root (1, 1), N·L and N·H (4, 6), times the root (2), sum (1).
    ("phong", costs(11, 12, 2, 30)),
    // The same with N·V for N·H, then 2 (N·L)(N·V) - L·V (1, 1).
    ("phong-rv", costs(12, 13, 2, 30)),
    ("environment", costs(4, 0, 1, 20)),
    ("blinn", costs(4, 2, 1, 25)),
    ("quadratic-blinn", costs(7, 2, 1, 260)),
    // L·N, V·N (2), D (2), Newton (1, 1), N·L (1), R·V (1, 2), sum (1).
    ("goldman", Costs { row: 70, ..costs(7, 4, 1, 30) }),
    // Turn sine and cosine (2, 4), two combinations (2, 4), sum (1).
    ("slerp", Costs { row: 100, ..costs(5, 8, 1, 30) }),
    ("angular", Costs { row: 360, ..costs(5, 0, 0, 200) }),
    ("hybrid", Costs { row: 180, ..costs(5, 0, 0, 290) }),
    ("angular-original", Costs { row: 360, ..costs(5, 0, 0, 200) }),
    ("hybrid-original", Costs { row: 180, ..costs(5, 0, 0, 290) }),
];

/// What the method of this name costs.
#[must_use]
pub fn of(method: &str) -> Option<Costs> {
    TABLE.iter().find(|(name, _)| *name == method).map(|(_, costs)| *costs)
}

#[cfg(test)]
mod tests {
    use microphong_oracle::NAMES;

    #[test]
    fn every_method_has_its_costs() {
        for name in NAMES {
            assert!(super::of(name).is_some(), "{name}");
        }
    }
}
