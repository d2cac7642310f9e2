//! Lines along outlines.

use crate::stream::record::{Header, NO_OUTLINES, OUTLINES_ALONE};

/// Lines along the outlines of surfaces, for [`Scene::set_outlines`](crate::Scene::set_outlines): line drawings, for example for displays of one bit,
/// and pictures of products.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Outlines {
    /// The colour of the lines: red, green, blue, each 0 to 255.
    pub colour: [u8; 3],
    /// Whether the lines are drawn on the background, without the surfaces. The surfaces still hide what is behind them.
    pub alone: bool,
}

impl Outlines {
    /// Creates lines of a colour over the shaded surfaces.
    #[must_use]
    pub const fn new(colour: [u8; 3]) -> Self {
        Self { colour, alone: false }
    }

    /// Sets whether the lines are drawn on the background, without the surfaces. Choose [`Shader::FLAT`](crate::Shader::FLAT) then: it is the fastest
    /// method, and no colour of the surfaces is visible.
    #[must_use]
    pub const fn alone(self, alone: bool) -> Self {
        Self { alone, ..self }
    }

    /// Returns the lines that the header of a stream states.
    #[doc(hidden)]
    #[must_use]
    pub fn of(header: &Header) -> Option<Self> {
        (header.outlines != NO_OUTLINES).then_some(Self { colour: header.outline_colour, alone: header.outlines == OUTLINES_ALONE })
    }
}
