//! Cargo features: what a program can do without, to save flash.
//!
//! Most code asks the constants of this file in plain conditions. The compiler then checks it with every choice of features, and drops what a program
//! lacks. Functions that would have no effect are left out by `#[cfg]`.

/// The features that some mesh files need: the name of each in the code, and in `Cargo.toml`.
macro_rules! features {
    ($(#[$doc:meta] $feature:ident = $name:literal,)+) => {
        /// A cargo feature that some mesh files need.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Feature {
            $(#[$doc] $feature,)+
        }

        impl Feature {
            /// All features that a mesh file can need.
            pub const ALL: [Self; 11] = [$(Self::$feature),+];

            /// The name of the feature in `Cargo.toml`.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$feature => $name,)+
                }
            }

            /// Whether the program has the feature.
            #[inline]
            pub const fn is_on(self) -> bool {
                match self {
                    $(Self::$feature => cfg!(feature = $name),)+
                }
            }
        }
    };
}

features! {
    /// Movements of objects, lights and the camera that the mesh file contains. A camera that orbits needs no feature.
    Animation = "animation",
    /// Lines along outlines.
    Antialias = "antialias",
    /// Materials that reflect more than one colour, for example a white highlight on a red surface.
    Colours = "colours",
    /// More than one light.
    Lights = "lights",
    /// Point lights with a range or a cone, and light from the sky.
    LightShapes = "light-shapes",
    /// Point lights, and highlights as seen from a camera that is not infinitely far.
    NearLights = "near-lights",
    /// More than one object.
    Objects = "objects",
    /// Labels, which are texts over the picture.
    Text = "text",
    /// Textures.
    Textures = "textures",
    /// Surfaces that let through a part of what is behind them, and holes in textures.
    Transparency = "transparency",
    /// Meshes with colours at the corners of their triangles.
    VertexColours = "vertex-colours",
}

pub(crate) const ANIMATION: bool = Feature::Animation.is_on();
/// Whether edges can be smoothed, or drawn as lines.
pub(crate) const ANTIALIAS: bool = Feature::Antialias.is_on();
pub(crate) const COLOURS: bool = Feature::Colours.is_on();
pub(crate) const LIGHTS: bool = Feature::Lights.is_on();
pub(crate) const LIGHT_SHAPES: bool = Feature::LightShapes.is_on();
pub(crate) const NEAR_LIGHTS: bool = Feature::NearLights.is_on();
/// Loops that add lights to a sum: several lights, or near lights of any kind.
pub(crate) const SUMS_LIGHTS: bool = LIGHTS || NEAR_LIGHTS;
/// Loops that do so where all lights are constant: several of them, or one from the sky.
pub(crate) const SUMS_CONSTANT_LIGHTS: bool = LIGHTS || LIGHT_SHAPES;
pub(crate) const OBJECTS: bool = Feature::Objects.is_on();
/// Whether the corners of triangles may have colours.
pub(crate) const VERTEX_COLOURS: bool = Feature::VertexColours.is_on();
/// 1 in a program whose triangles may have colours at their corners, otherwise 0: the room for what only these need.
pub(crate) const COLOURED: usize = VERTEX_COLOURS as usize;
/// Whether meshes may have textures.
pub(crate) const TEXTURES: bool = Feature::Textures.is_on();
/// 1 in a program whose meshes may have textures, otherwise 0, as [`COLOURED`].
pub(crate) const TEXTURED: usize = TEXTURES as usize;
/// Whether surfaces may be transparent, and textures may have holes.
pub(crate) const TRANSPARENCY: bool = Feature::Transparency.is_on();
/// 1 in a program whose surfaces may be transparent, otherwise 0, as [`COLOURED`].
pub(crate) const TRANSPARENT: usize = TRANSPARENCY as usize;

/// Whether a frame can draw only what has changed.
pub(crate) const REDRAW: bool = cfg!(feature = "redraw");
/// Whether light can be interpolated in perspective.
pub(crate) const PERSPECTIVE: bool = cfg!(feature = "perspective");
/// Whether a program can switch off the skipping of invisible work, and count it.
pub(crate) const SKIPS: bool = cfg!(feature = "skips");

/// Whether the only light is directional, the viewer is infinitely far, and no mesh has colours at its corners: vertices hold N·L and N·H in all scenes.
pub(crate) const ALWAYS_CONSTANT: bool = !LIGHTS && !NEAR_LIGHTS && !VERTEX_COLOURS;
