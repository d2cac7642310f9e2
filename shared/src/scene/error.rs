//! Errors of changes to a scene.

use core::fmt;

/// The reason why a scene cannot be changed as a program asks. The scene stays unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SceneError {
    /// This is not a rotation: a quaternion or an axis is zero, a matrix is not orthonormal or mirrors, or a viewing direction is zero or parallel to
    /// `up`.
    Rotation,
    /// A direction is zero, or not a number.
    Direction,
    /// A position is farther than 16 units from the origin along an axis.
    Position,
    /// A scale is less than 1/16 or more than 8.
    Scale,
    /// There is no object with this index.
    Object {
        /// Index of the object.
        index: usize,
    },
    /// The stream has no meshes with these indices, or the first of them is a coarser level of another mesh.
    Meshes,
    /// The stream has no material with this index.
    Material {
        /// Index of the material.
        index: usize,
    },
    /// The layout has room for no more objects.
    Objects {
        /// Number of objects that the layout has room for.
        room: usize,
    },
    /// A value of the camera, a light or a material is out of its range.
    Range {
        /// Name of the value.
        name: &'static str,
    },
    /// The shading method needs directional lights and an infinitely far viewer, and the scene would have others.
    Light,
    /// The shading method cannot interpolate light in perspective, so it needs an orthographic camera while this is on.
    Perspective,
    /// The exponent of a material is too small for the shading method.
    Exponent {
        /// The smallest exponent that the method can draw.
        least: u16,
    },
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rotation => {
                f.write_str("a rotation must be a quaternion other than zero, an axis other than zero, or an orthonormal matrix")
            }
            Self::Direction => f.write_str("a direction must be three numbers that are not all zero"),
            Self::Position => f.write_str("a position must be within 16 units of the origin along each axis"),
            Self::Scale => f.write_str("a scale must be 1/16 to 8"),
            Self::Object { index } => write!(f, "there is no object number {index}"),
            Self::Meshes => f.write_str("the stream has no such meshes, or the first is a coarser level of another"),
            Self::Material { index } => write!(f, "the stream has no material number {index}"),
            Self::Objects { room } => write!(f, "there is room for {room} objects; ask for more by Layout::objects"),
            Self::Range { name } => write!(f, "{name} is out of range"),
            Self::Light => f.write_str("the shading method needs directional lights and an infinitely far viewer"),
            Self::Perspective => f.write_str(
                "the shading method cannot interpolate light in perspective; turn that off by Renderer::set_perspective_correct, or keep an orthographic camera",
            ),
            Self::Exponent { least } => write!(f, "the shading method needs materials whose exponent is {least} or more"),
        }
    }
}

impl core::error::Error for SceneError {}
