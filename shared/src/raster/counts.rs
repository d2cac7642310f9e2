//! Counts of triangles that are drawn.

/// Counts of triangles that were drawn with less work, by what was left out. Each triangle counts once, in the band where it begins. Slivers and
/// antialiased triangles do not count. All counts are 0 unless the feature `skips` is on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counts {
    /// Triangles drawn without depth test.
    pub without_depth: u32,
    /// Highlights of single lights that were left out on triangles.
    pub without_highlight: u32,
    /// Lights that were left out on triangles.
    pub without_light: u32,
    /// Triangles that were left out in a band, because nearer objects hide their object there, or because they have no pixels in it.
    pub hidden: u32,
    /// Triangles by each choice of a method such as `auto`: one colour, linear, quadratic levels, quadratic cosines, Phong shading.
    pub choices: [u32; 5],
}

impl Counts {
    /// Adds the counts of two parts.
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
