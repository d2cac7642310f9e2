//! What is seen where no triangle is.

/// What is seen where no triangle is; red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Background {
    /// One colour. Formats of fewer bits a channel keep the upper ones.
    Colour([u8; 3]),
    /// A colour for each row: that of the first row, that of the last one, and even steps between them, dithered so that they are not seen.
    Gradient {
        /// Colour of the first row: red, green, blue.
        top: [u8; 3],
        /// Colour of the last row: red, green, blue.
        bottom: [u8; 3],
    },
}

impl Background {
    /// Between two colours; one if they are the same.
    pub(crate) fn between(top: [u8; 3], bottom: [u8; 3]) -> Self {
        if top == bottom { Self::Colour(top) } else { Self::Gradient { top, bottom } }
    }
}

impl From<[u8; 3]> for Background {
    fn from(colour: [u8; 3]) -> Self {
        Self::Colour(colour)
    }
}
