//! Errors of a renderer.

use crate::{
    scene::{NO_EDGE_MEMORY, NO_NEIGHBOURS},
    setup::edge::COLUMNS,
};
use core::fmt;

/// The largest width and height of a picture: 2,047 pixels.
pub const MAX_SIDE: u32 = COLUMNS - 1;

/// The reason why a renderer cannot be created, cannot use a setting or cannot draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RenderError {
    /// The picture has no pixels, or is wider or higher than [`MAX_SIDE`].
    Size {
        /// The width of the picture that was asked for, in pixels.
        width: u32,
        /// The height of the picture that was asked for, in pixels.
        height: u32,
    },
    /// The [`Layout`](crate::Layout) is for pictures of another width, or it has 0 rows or 0 processors.
    Layout {
        /// The width of the picture that was asked for, in pixels.
        width: u32,
    },
    /// The memory that was passed to the renderer is smaller than [`Layout::words`](crate::Layout::words).
    Memory {
        /// The number of 64-bit words that are needed.
        need: usize,
    },
    /// The stream (mesh file) has more materials than the layout has room for; set [`Layout::materials`](crate::Layout::materials).
    Materials {
        /// The number of materials in the stream (mesh file).
        need: usize,
    },
    /// The stream (mesh file) has more objects than the layout has room for; set [`Layout::objects`](crate::Layout::objects).
    Objects {
        /// The number of objects in the stream (mesh file).
        need: usize,
    },
    /// The shading method looks up highlights in tables, and the layout has no memory for them. See
    /// [`Layout::without_highlight_tables`](crate::Layout::without_highlight_tables).
    HighlightTables {
        /// The name of the shading method.
        shader: &'static str,
    },
    /// The materials have more different highlights than the layout has tables for; set
    /// [`Layout::highlight_tables`](crate::Layout::highlight_tables).
    TooFewHighlightTables {
        /// The number of tables that are needed.
        need: usize,
    },
    /// Antialiasing was turned on, or the stream (mesh file) states lines along outlines, but the layout has no room for them; set
    /// [`Layout::antialias`](crate::Layout::antialias).
    AntialiasMemory,
    /// Antialiasing was turned on, but the stream (mesh file) does not have the neighbours of its triangles; write it by
    /// `microphong convert --antialias`.
    Neighbours,
    /// The pixel buffer for a band (group of rows drawn at once) is shorter than one row of the picture.
    Band {
        /// The smallest number of pixels that the buffer may have: one row of the picture.
        need: usize,
    },
    /// A part of the picture would lie outside of the display; see [`Picture::at`](crate::Picture::at).
    Corner,
    /// The stream (mesh file) or a setting needs a cargo feature of this crate that is turned off.
    Feature {
        /// The name of the cargo feature.
        name: &'static str,
    },
    /// The stream (mesh file) asks for a shading method that is not in the list of shaders that was passed to
    /// [`Renderer::new`](crate::Renderer::new).
    UnknownMethod {
        /// The number of the missing method, as in [`Facts::id`](crate::method::Facts::id).
        method: u16,
    },
    /// The shading method supports only directional lights and an infinitely distant viewer, and the scene has a point light or a local
    /// viewer.
    Light {
        /// The name of the shading method.
        shader: &'static str,
    },
    /// The error budget, which is the largest difference of a pixel from Phong shading, is less than 1/2 or more than 16, in units of 1/255 of full
    /// intensity. See [`Renderer::set_budget`](crate::Renderer::set_budget).
    Budget,
    /// A material's highlight exponent is too small for the shading method.
    Exponent {
        /// The name of the shading method.
        shader: &'static str,
        /// The smallest exponent that the method can draw.
        least: u16,
    },
    /// Perspective-correct interpolation of light is on, and the shading method does not support it for a perspective camera.
    Perspective {
        /// The name of the shading method.
        shader: &'static str,
    },
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { width, height } => {
                write!(f, "a picture of {width}x{height} pixels cannot be drawn; each side must be 1 to {MAX_SIDE}")
            }
            Self::Layout { width } => {
                write!(
                    f,
                    "the layout is not for a picture of {width} columns, or has no row; use Layout::new({width}, rows) with one row or more"
                )
            }
            Self::Memory { need } => write!(f, "the memory is too small; it must have {need} words of 64 bits (Layout::words)"),
            Self::Materials { need } => write!(f, "the layout has too little room for materials; set Layout::materials({need})"),
            Self::Objects { need } => write!(f, "the layout has too little room for objects; set Layout::objects({need})"),
            Self::HighlightTables { shader } => {
                write!(f, "{shader} needs tables of highlights; make the layout without Layout::without_highlight_tables")
            }
            Self::TooFewHighlightTables { need } => {
                write!(f, "the layout has too few tables of highlights; set Layout::highlight_tables({need})")
            }
            Self::AntialiasMemory => f.write_str(NO_EDGE_MEMORY),
            Self::Neighbours => f.write_str(NO_NEIGHBOURS),
            Self::Band { need } => write!(f, "the band is too short; it must hold at least one row of {need} pixels"),
            Self::Corner => f.write_str("the picture would reach beyond the display; move it or make it smaller"),
            Self::Feature { name } => write!(f, "this program lacks the cargo feature {name}; enable it in Cargo.toml"),
            Self::Budget => f.write_str("the error budget is out of range; it must be 0.5 to 16"),
            Self::UnknownMethod { method } => {
                write!(
                    f,
                    "this program lacks shading method number {method}, which the stream names; list it, or convert with another --shader"
                )
            }
            Self::Light { shader } => {
                write!(f, "{shader} supports only directional lights and an infinitely far viewer; use another shading method")
            }
            Self::Exponent { shader, least } => {
                write!(f, "{shader} supports only exponents of {least} or more; use a larger exponent or another shading method")
            }
            Self::Perspective { shader } => write!(f, "{shader} cannot interpolate light in perspective; use another shading method"),
        }
    }
}

impl core::error::Error for RenderError {}
