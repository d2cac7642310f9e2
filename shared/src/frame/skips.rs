//! What a frame leaves out because nobody can see it.

/// What a frame leaves out because nobody can see it: switches that show what each spares.
///
/// The picture is the same without, bit for bit, with two exceptions. Of a triangle that is clipped, because it is near or far off the
/// screen, and faces away, parts may turn over by rounding if it is not left out. And antialiasing shades up to a pixel beyond the edges of a
/// triangle, where there may be light that reaches none of its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub struct Skips {
    /// Triangles that face away are known by their planes, before their vertices are transformed.
    pub back_faces: bool,
    /// Triangles whose bounding box contains no pixel centre are not set up.
    pub between_centres: bool,
    /// Front faces of a closed convex mesh are drawn without depth test, as none can hide another.
    pub depth: bool,
    /// Highlights are not computed on triangles where they are too weak to be seen. A method that draws such triangles in another way, as by
    /// a table of colours, does so in any case.
    pub highlights: bool,
    /// Lights are not computed on triangles that they do not reach.
    pub lights: bool,
    /// Objects are not drawn in the rows of a band where others hide them: objects are drawn from the nearest to the farthest, and no pixel of
    /// the box around one is nearer than what is there already.
    pub hidden_objects: bool,
}

impl Skips {
    /// Everything is left out that can be: how a renderer begins.
    pub const ALL: Self =
        Self { back_faces: true, between_centres: true, depth: true, highlights: true, lights: true, hidden_objects: true };
    /// Nothing is left out.
    pub const NONE: Self =
        Self { back_faces: false, between_centres: false, depth: false, highlights: false, lights: false, hidden_objects: false };
    /// For each by its name: all but this one.
    pub const ALL_BUT: [(&str, Self); 6] = [
        ("back-faces", Self { back_faces: false, ..Self::ALL }),
        ("between-centres", Self { between_centres: false, ..Self::ALL }),
        ("depth", Self { depth: false, ..Self::ALL }),
        ("highlights", Self { highlights: false, ..Self::ALL }),
        ("lights", Self { lights: false, ..Self::ALL }),
        ("hidden-objects", Self { hidden_objects: false, ..Self::ALL }),
    ];
}
