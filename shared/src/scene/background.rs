//! The background of a scene.

/// What is seen where no triangle is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Background {
    /// One colour: red, green, blue. A pixel format of fewer bits a channel keeps the upper bits.
    Colour([u8; 3]),
    /// A vertical gradient: even steps from the colour of the first row to the colour of the last. It is dithered, so that the steps are not seen.
    Gradient {
        /// Colour of the first row: red, green, blue.
        top: [u8; 3],
        /// Colour of the last row: red, green, blue.
        bottom: [u8; 3],
    },
}

impl Background {
    /// The gradient between two colours, or one colour if they are equal.
    pub(crate) fn between(top: [u8; 3], bottom: [u8; 3]) -> Self {
        if top == bottom { Self::Colour(top) } else { Self::Gradient { top, bottom } }
    }
}

impl From<[u8; 3]> for Background {
    fn from(colour: [u8; 3]) -> Self {
        Self::Colour(colour)
    }
}
