//! Numbers of operations in the formulas of each method, counted by hand. `microphong bench` counts instructions.
//!
//! The numbers are for one white directional light, an infinitely far viewer, and one channel. Gains of the material are part of walked values or
//! tables. A look-up in an interpolated table counts as one load, one multiplication and one addition (reciprocal roots), in a fine table as one load
//! (powers). Divisions and roots count as multiplications. Setting up a linear field takes 10 operations, a lit node 30, a quadratic 45.

/// Numbers of operations in a method's formulas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operations {
    /// Additions per pixel.
    pub adds: u32,
    /// Multiplications and divisions per pixel.
    pub multiplies: u32,
    /// Table look-ups per pixel.
    pub loads: u32,
    /// Operations to set up one triangle that is not split.
    pub setup: u32,
    /// Operations to set up one row of a triangle, beyond the forward differences of its edges.
    pub row: u32,
}

/// Each method with its additions, multiplications and look-ups per pixel, and its operations per triangle and per row.
const METHODS: [(&str, [u32; 5]); 28] = [
    ("flat", [0, 0, 0, 5, 0]),
    ("gouraud", [1, 0, 0, 10, 0]),
    ("six-point", [2, 0, 0, 135, 0]),
    ("phong", [11, 12, 2, 30, 0]),
    ("phong-rv", [12, 13, 2, 30, 0]),
    ("gouraud4", [1, 0, 0, 130, 0]),
    ("pseudo-phong", [1, 0, 0, 520, 0]),
    ("highlight-test", [11, 12, 2, 35, 0]),
    ("goldman", [7, 4, 1, 30, 70]),
    ("slerp", [5, 8, 1, 30, 100]),
    ("duff", [6, 3, 2, 60, 0]),
    ("taylor", [5, 0, 1, 180, 0]),
    ("taylor-finite", [5, 0, 1, 550, 0]),
    ("six-point-adaptive", [2, 0, 0, 355, 0]),
    ("six-point-centre", [2, 0, 0, 175, 0]),
    ("cubic", [3, 0, 0, 330, 0]),
    ("angular", [5, 0, 0, 200, 360]),
    ("angular-original", [5, 0, 0, 200, 360]),
    ("hybrid", [5, 0, 0, 290, 180]),
    ("hybrid-original", [5, 0, 0, 290, 180]),
    ("environment", [4, 0, 1, 20, 0]),
    ("blinn", [4, 2, 1, 25, 0]),
    ("quadratic-blinn", [7, 2, 1, 260, 0]),
    ("sqrt6", [5, 0, 1, 175, 0]),
    ("renq", [5, 2, 1, 60, 0]),
    ("renq-newton", [7, 8, 1, 85, 0]),
    // As Phong shading, which is what they do at worst.
    ("auto", [11, 12, 2, 30, 0]),
    ("auto-linear", [11, 12, 2, 30, 0]),
];

impl Operations {
    /// Operations of the method of this name; zeros for a method that is not listed.
    #[must_use]
    pub fn of(method: &str) -> Self {
        let [adds, multiplies, loads, setup, row] = METHODS.iter().find(|(name, _)| *name == method).map_or([0; 5], |(_, counts)| *counts);
        Self { adds, multiplies, loads, setup, row }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use microphong_render::shader::Shader;

    #[test]
    fn every_method_is_listed() {
        assert_eq!(METHODS.map(|(name, _)| name).to_vec(), Shader::ALL.map(|shader| shader.name()).to_vec());
    }
}
