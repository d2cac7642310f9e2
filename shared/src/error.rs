//! Errors of a renderer.

use crate::setup::edge::COLUMNS;
use core::fmt;

/// Largest width and height of a picture, in pixels.
pub const MAX_SIDE: u32 = COLUMNS - 1;

/// The reason why a renderer cannot draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RenderError {
    /// The picture is empty, or a side is longer than [`MAX_SIDE`].
    Size {
        /// Width of the picture, in pixels.
        width: u32,
        /// Height of the picture, in pixels.
        height: u32,
    },
    /// The layout is for pictures of another width, or its bands have no row.
    Layout {
        /// Width of the picture, in pixels.
        width: u32,
    },
    /// The memory is smaller than [`crate::Layout::words`] says.
    Memory {
        /// Number of 64-bit words that are needed.
        need: usize,
    },
    /// The layout has room for fewer materials than the stream has; see [`crate::Layout::materials`].
    Materials {
        /// Number of materials in the stream.
        need: usize,
    },
    /// The layout has room for fewer objects than the stream has; see [`crate::Layout::objects`].
    Objects {
        /// Number of objects in the stream.
        need: usize,
    },
    /// The method looks up highlights in tables, and the layout has none; see [`crate::Layout::without_highlight_tables`].
    HighlightTables {
        /// Name of the method.
        shader: &'static str,
    },
    /// The layout has no room for antialiasing; see [`crate::Layout::antialias`].
    NoSamples,
    /// The memory for a band is shorter than one row of the picture.
    Band {
        /// Number of pixels that are needed at least.
        need: usize,
    },
    /// A part of the picture would lie outside of the display.
    Corner,
    /// The stream or the program needs a cargo feature that this build lacks.
    Feature {
        /// Name of the cargo feature.
        name: &'static str,
    },
    /// The stream asks for a method that is not in the program's list of methods.
    UnknownMethod {
        /// The number of the missing method, see [`crate::method::Facts::id`].
        method: u16,
    },
    /// The method cannot draw point lights or a local viewer, and the scene has one of them.
    Light {
        /// Name of the method.
        shader: &'static str,
    },
    /// The error budget is less than [`crate::format::LEAST_BUDGET`] or more than [`crate::format::LARGEST_BUDGET`].
    Budget,
    /// A material's exponent is too small for the method.
    Exponent {
        /// Name of the method.
        shader: &'static str,
        /// The smallest exponent that the method can draw.
        least: u16,
    },
    /// The method cannot interpolate in perspective.
    Perspective {
        /// Name of the method.
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
            Self::HighlightTables { shader } => {
                write!(f, "{shader} shading needs tables of highlights; build the layout without Layout::without_highlight_tables")
            }
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
