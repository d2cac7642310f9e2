//! Why a renderer cannot draw.

use crate::setup::edge::COLUMNS;
use core::fmt;

/// Largest width and height of a viewport.
pub const MAX_SIDE: u32 = COLUMNS - 1;

/// Why a renderer cannot draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RenderError {
    /// The viewport is empty or larger than [`MAX_SIDE`] on a side.
    Size {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
    },
    /// The layout is for pictures of another width, or for bands without a row.
    Layout {
        /// Width asked for.
        width: u32,
    },
    /// The memory is smaller than its layout says.
    Memory {
        /// Words of 64 bits needed.
        need: usize,
    },
    /// The layout has room for fewer materials than the stream has.
    Materials {
        /// Materials of the stream.
        need: usize,
    },
    /// The layout has room for fewer objects than the stream has.
    Objects {
        /// Objects of the stream.
        need: usize,
    },
    /// The layout has no room for antialiasing.
    NoSamples,
    /// A slice of pixels does not hold one row of the picture.
    Band {
        /// Pixels needed at least.
        need: usize,
    },
    /// A picture would not lie on the display.
    Corner,
    /// The stream has something, or the program asks for something, that is not part of this build.
    Feature {
        /// The feature that it takes.
        name: &'static str,
    },
    /// None of the program's methods is the one that the stream asks for.
    UnknownMethod {
        /// The number of the missing method, see [`crate::method::Facts::id`].
        method: u16,
    },
    /// The method cannot shade under near lights or for a near viewer.
    Light {
        /// The method's name.
        shader: &'static str,
    },
    /// The error budget is none of those from [`crate::format::LEAST_BUDGET`] to [`crate::format::LARGEST_BUDGET`].
    Budget,
    /// The method raises a root of its own to a share of the exponent, which is less than 1 here.
    Exponent {
        /// The method's name.
        shader: &'static str,
        /// Smallest exponent of a material that it can shade.
        least: u16,
    },
    /// The method cannot interpolate in perspective.
    Perspective {
        /// The method's name.
        shader: &'static str,
    },
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { width, height } => write!(f, "a picture of {width}x{height} pixels; each side must be 1 to {MAX_SIDE}"),
            Self::Layout { width } => write!(f, "the layout of the memory is not for pictures of {width} columns, or has no row"),
            Self::Memory { need } => write!(f, "the memory needs {need} words of 64 bits, as Layout::words says"),
            Self::Materials { need } => write!(f, "the stream has {need} materials; give the layout of the memory room for as many"),
            Self::Objects { need } => write!(f, "the scene has objects: {need}; give the layout of the memory room for as many"),
            Self::NoSamples => f.write_str("antialiasing needs memory of its own; ask for it by Layout::antialias"),
            Self::Band { need } => write!(f, "a band of pixels must hold a row of the picture, {need} pixels"),
            Self::Corner => f.write_str("the picture would reach beyond the display; move it or make it smaller"),
            Self::Feature { name } => write!(f, "this needs the feature {name}; build the program with it"),
            Self::Budget => f.write_str("an error budget must be 1/2 to 16"),
            Self::UnknownMethod { method } => {
                write!(f, "this program has no shading method number {method}, for which the stream asks; convert it with another --shader")
            }
            Self::Light { shader } => {
                write!(f, "{shader} shading needs directional lights and an infinitely far viewer; this scene has near ones")
            }
            Self::Exponent { shader, least } => {
                write!(f, "{shader} shading needs materials whose exponent is {least} or more; give the material a larger one")
            }
            Self::Perspective { shader } => write!(f, "{shader} shading has no perspective-correct form"),
        }
    }
}

impl core::error::Error for RenderError {}
