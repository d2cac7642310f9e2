//! Work that a frame leaves out because nobody can see the result.

/// Switches for work that a frame leaves out because nobody can see the result. Turning one off shows what it saves.
///
/// The picture stays the same, bit for bit, with two exceptions. A clipped triangle that faces away may turn to the front in parts, by rounding, if
/// it is drawn. Antialiasing shades up to a pixel beyond the edges of a triangle, where a light may shine that reaches no point of the triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub struct Skips {
    /// Leave out triangles that face away, by their planes, before their vertices are transformed.
    pub back_faces: bool,
    /// Leave out triangles whose bounding box contains no pixel centre.
    pub between_centres: bool,
    /// Leave out the depth test for the front faces of a closed convex mesh, because none can hide another.
    pub depth: bool,
    /// Leave out highlights on triangles where they are too weak to be seen. If a method draws such triangles by another loop, it always does.
    pub highlights: bool,
    /// Leave out lights on triangles that they do not reach.
    pub lights: bool,
    /// Leave out objects in bands where nearer objects hide them.
    pub hidden_objects: bool,
}

impl Skips {
    /// Leaves out all that can be left out. A renderer begins with this value.
    pub const ALL: Self =
        Self { back_faces: true, between_centres: true, depth: true, highlights: true, lights: true, hidden_objects: true };
    /// Leaves out nothing.
    pub const NONE: Self =
        Self { back_faces: false, between_centres: false, depth: false, highlights: false, lights: false, hidden_objects: false };
    /// For each switch, its name and all others turned on.
    pub const ALL_BUT: [(&str, Self); 6] = [
        ("back-faces", Self { back_faces: false, ..Self::ALL }),
        ("between-centres", Self { between_centres: false, ..Self::ALL }),
        ("depth", Self { depth: false, ..Self::ALL }),
        ("highlights", Self { highlights: false, ..Self::ALL }),
        ("lights", Self { lights: false, ..Self::ALL }),
        ("hidden-objects", Self { hidden_objects: false, ..Self::ALL }),
    ];
}
