//! Errors of changes to a scene.

use core::fmt;
use fixed::traits::{Fixed, ToFixed};

/// The reason why a [`Scene`](crate::Scene), a [`Pose`](crate::Pose) or a [`Light`](crate::Light) cannot have the values that a program
/// asks for. A scene that returns this error stays unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SceneError {
    /// The numbers do not describe a rotation: a quaternion or an axis is zero, a matrix is not orthonormal or mirrors, or a viewing
    /// direction is zero or parallel to `up`.
    Rotation,
    /// The direction of a light is zero, not finite, or too long for the number format.
    Direction,
    /// A position is farther than 16 units from the origin along an axis, or not a number.
    Position,
    /// A scale is less than 1/16, more than 8, or not a number.
    Scale,
    /// The scene has no object with this index.
    Object {
        /// The index that was asked for.
        index: usize,
    },
    /// The stream (mesh file) has no meshes with these indices, or the range begins or ends between a mesh and its coarser levels of
    /// detail.
    Meshes,
    /// The stream (mesh file) has no material with this index.
    Material {
        /// The index that was asked for.
        index: usize,
    },
    /// The scene has as many objects as the layout has room for; set [`Layout::objects`](crate::Layout::objects).
    Objects {
        /// The number of objects that the layout has room for.
        room: usize,
    },
    /// A value of the camera, a light or a material is outside of its range.
    Range {
        /// The name of the value, for example `"light colour"`.
        name: &'static str,
    },
    /// The shading method supports only directional lights and an infinitely distant viewer; the change would add a point light or a local
    /// viewer.
    Light,
    /// The change would set a perspective camera while perspective-correct interpolation of light is on, and the shading method does not
    /// support both.
    Perspective,
    /// The change needs a cargo feature of this crate that is turned off.
    Feature {
        /// The name of the cargo feature.
        name: &'static str,
    },
    /// Lines along outlines were asked for, but the layout has no room for them; set [`Layout::antialias`](crate::Layout::antialias).
    AntialiasMemory,
    /// Lines along outlines were asked for, but the stream (mesh file) does not have the neighbours of its triangles; write it by
    /// `microphong convert --antialias`.
    Neighbours,
    /// The highlight exponent of a material is too small for the shading method.
    Exponent {
        /// The smallest exponent that the method can draw.
        least: u16,
    },
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rotation => f.write_str(
                "this is not a rotation; a quaternion or axis must not be zero, a matrix must be orthonormal, and `up` must not be parallel to the view",
            ),
            Self::Direction => f.write_str("this is not a direction; it must be three numbers that are not all zero"),
            Self::Position => f.write_str("the position is out of range; it must be within 16 units of the origin along each axis"),
            Self::Scale => f.write_str("the scale is out of range; it must be 1/16 to 8"),
            Self::Object { index } => write!(f, "there is no object number {index}; use an index that Scene::add returned"),
            Self::Meshes => f.write_str("the stream has no such meshes, or the range begins with a level of detail; use Stream::mesh"),
            Self::Material { index } => write!(f, "the stream has no material number {index}; use a smaller index"),
            Self::Objects { room } => write!(f, "the layout has room for only {room} objects; set Layout::objects to more"),
            Self::Range { name } => write!(f, "{name} is out of range; its documentation gives the limits"),
            Self::Light => {
                f.write_str("this method supports only directional lights and an infinitely far viewer; use another shading method")
            }
            Self::Perspective => f.write_str(
                "this method cannot interpolate light in perspective; call Renderer::set_perspective_correct(false) or use an orthographic camera",
            ),
            Self::Feature { name } => write!(f, "this program lacks the cargo feature {name}; enable it in Cargo.toml"),
            Self::AntialiasMemory => f.write_str(NO_EDGE_MEMORY),
            Self::Neighbours => f.write_str(NO_NEIGHBOURS),
            Self::Exponent { least } => write!(f, "this method supports only exponents of {least} or more; use a larger one"),
        }
    }
}

impl core::error::Error for SceneError {}

/// Numbers in the format `F`, or `error` if one does not fit or is not finite.
pub(crate) fn in_format<F: Fixed, N: ToFixed, const COUNT: usize>(
    numbers: [N; COUNT],
    error: SceneError,
) -> Result<[F; COUNT], SceneError> {
    let mut fixed = [F::ZERO; COUNT];
    for (fixed, number) in fixed.iter_mut().zip(numbers) {
        *fixed = number.checked_to_fixed().ok_or(error)?;
    }
    Ok(fixed)
}

/// What `AntialiasMemory` says.
pub(crate) const NO_EDGE_MEMORY: &str = "the layout has no memory for outlines; set Layout::antialias(true)";
/// What `Neighbours` says.
pub(crate) const NO_NEIGHBOURS: &str = "the stream has no neighbours of triangles; make it with `microphong convert --antialias`";
