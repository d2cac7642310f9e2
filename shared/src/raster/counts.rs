//! Counts of triangles that are drawn.

/// Counts of triangles by the way in which they were drawn; part of [`Stats`](crate::Stats). Except in `hidden`, each triangle counts only
/// in the band (group of rows drawn at once) where it begins. Extremely thin triangles do not count. All counts are 0
/// unless this crate is built with the feature `skips`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counts {
    /// The number of triangles drawn without depth test, because no other triangle can overlap them.
    pub without_depth: u32,
    /// The number of highlights that were left out because they are too weak to be visible, counted for each triangle and light.
    pub without_highlight: u32,
    /// The number of lights that were left out because they do not reach the triangle, counted for each triangle.
    pub without_light: u32,
    /// The number of triangles that were left out in a band (group of rows drawn at once), because nearer objects hide their object there
    /// or it has no pixels there. A triangle counts once for each band in which it is left out.
    pub hidden: u32,
    /// The number of triangles that [`Shader::AUTO`](crate::Shader::AUTO) drew in each of its five ways: one colour, linear interpolation,
    /// quadratic interpolation of light levels, quadratic interpolation of cosines, and Phong shading. Other methods leave all five at 0.
    pub choices: [u32; 5],
}

impl Counts {
    /// Adds two counts, for example of two parts of a picture. A sum beyond the largest `u32` wraps around.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let mut choices = self.choices;
        choices.iter_mut().zip(other.choices).for_each(|(sum, count)| *sum = sum.wrapping_add(count));
        Self {
            without_depth: self.without_depth.wrapping_add(other.without_depth),
            without_highlight: self.without_highlight.wrapping_add(other.without_highlight),
            without_light: self.without_light.wrapping_add(other.without_light),
            hidden: self.hidden.wrapping_add(other.hidden),
            choices,
        }
    }
}
