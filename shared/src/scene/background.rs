//! The background of a scene.

/// The background of a scene: the colour of pixels that no triangle covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Background {
    /// A single colour: red, green, blue, each 0 to 255. A pixel format of fewer bits keeps the upper bits of each.
    Colour([u8; 3]),
    /// A vertical gradient from the first row of the picture to the last. It is dithered, so that the steps between colours are not
    /// visible.
    Gradient {
        /// The colour of the first row: red, green, blue, each 0 to 255.
        top: [u8; 3],
        /// The colour of the last row: red, green, blue, each 0 to 255.
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
