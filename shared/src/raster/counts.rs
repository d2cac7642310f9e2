//! Counts of triangles that are drawn.

/// How many triangles were drawn without something, and by what. Each counts once, in the band where it begins; slivers do not count, nor do
/// antialiased triangles. All are 0 unless the feature `skips` is on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counts {
    /// Without depth test.
    pub without_depth: u32,
    /// Without the highlight of a light, for each such light.
    pub without_highlight: u32,
    /// Without a light, for each such light.
    pub without_light: u32,
    /// Not at all in a band, because nearer objects hide theirs there, or because it has none of their pixels; for each such band.
    pub hidden: u32,
    /// By each choice of a method that chooses.
    pub choices: [u32; 5],
}

impl Counts {
    /// The sums of both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let [one, linear, quadratic, cosines, exact] = self.choices;
        let [a, b, c, d, e] = other.choices;
        Self {
            without_depth: self.without_depth.wrapping_add(other.without_depth),
            without_highlight: self.without_highlight.wrapping_add(other.without_highlight),
            without_light: self.without_light.wrapping_add(other.without_light),
            hidden: self.hidden.wrapping_add(other.hidden),
            choices: [
                one.wrapping_add(a),
                linear.wrapping_add(b),
                quadratic.wrapping_add(c),
                cosines.wrapping_add(d),
                exact.wrapping_add(e),
            ],
        }
    }
}
