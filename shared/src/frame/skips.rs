//! Work that a frame leaves out because nobody can see the result.

/// Switches for skipping work that has no visible effect, for the method `set_skips` of a renderer. They exist to measure what each saves;
/// normally all are on.
///
/// The picture stays the same, bit for bit, with two exceptions. A triangle that faces away and is clipped (at the near plane, or far
/// outside of the picture) may be visible in parts, because of rounding, if [`Self::back_faces`] is off. With antialiasing and [`Self::lights`] off, a
/// light may brighten pixels on the edges of a triangle that it does not reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub struct Skips {
    /// Whether triangles that face away from the camera are left out before their vertices are transformed.
    pub back_faces: bool,
    /// Whether triangles are left out whose bounding box contains no pixel centre.
    pub between_centres: bool,
    /// Whether the depth test is left out for closed convex meshes, wherever no other object can overlap them. The visible triangles of such a mesh
    /// cannot hide each other.
    pub depth: bool,
    /// Whether highlights are left out on triangles where they are too weak to be visible. Some methods leave them out even if this is off.
    pub highlights: bool,
    /// Whether lights are left out on triangles that they do not reach.
    pub lights: bool,
    /// Whether objects are left out in bands (groups of rows drawn at once) where nearer objects hide them.
    pub hidden_objects: bool,
}

impl Skips {
    /// All switches on. A renderer begins with this value.
    pub const ALL: Self =
        Self { back_faces: true, between_centres: true, depth: true, highlights: true, lights: true, hidden_objects: true };
    /// All switches off: nothing is left out.
    pub const NONE: Self =
        Self { back_faces: false, between_centres: false, depth: false, highlights: false, lights: false, hidden_objects: false };
    /// One entry for each switch: its name, and a value in which only this switch is off.
    pub const ALL_BUT: [(&str, Self); 6] = [
        ("back-faces", Self { back_faces: false, ..Self::ALL }),
        ("between-centres", Self { between_centres: false, ..Self::ALL }),
        ("depth", Self { depth: false, ..Self::ALL }),
        ("highlights", Self { highlights: false, ..Self::ALL }),
        ("lights", Self { lights: false, ..Self::ALL }),
        ("hidden-objects", Self { hidden_objects: false, ..Self::ALL }),
    ];
}
