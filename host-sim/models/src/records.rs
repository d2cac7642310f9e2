//! Records of a stream, made from numbers and read as numbers.

use microphong::{
    format::{Focal, Length, Rotation, Share, Unit},
    stream::record::{Camera, LABEL_TEXT, Label, VIEWER_INFINITE, Vertex},
};

/// A vertex at `position` with a unit normal.
#[must_use]
pub fn vertex(position: [Unit; 3], normal: [Unit; 3]) -> Vertex {
    Vertex { position: position.map(Unit::to_bits), normal: normal.map(Unit::to_bits) }
}

/// Position of a vertex in object space.
#[must_use]
pub fn position(vertex: &Vertex) -> [Unit; 3] {
    vertex.position.map(Unit::from_bits)
}

/// Unit normal of a vertex in object space.
#[must_use]
pub fn normal(vertex: &Vertex) -> [Unit; 3] {
    vertex.normal.map(Unit::from_bits)
}

/// A camera that stands still, with an infinitely distant viewer for highlights.
///
/// - `projection` is 0 for perspective, 1 for orthographic.
/// - `rotation` has the rows of the rotation matrix from object space to eye space, in which z points away from the viewer.
/// - `translation` is the position of the origin of object space in eye space.
/// - `focal` is the focal length, from 1/16 to 16; see [`Camera::focal`].
/// - `near` and `far` are the distances of the near and the far plane. A perspective camera ignores `far`.
#[must_use]
pub fn camera(projection: u8, rotation: [[Rotation; 3]; 3], translation: [Length; 3], focal: Focal, [near, far]: [Length; 2]) -> Camera {
    Camera {
        rotation: rotation.map(|row| row.map(Rotation::to_bits)),
        translation: translation.map(Length::to_bits),
        axis: [Rotation::ZERO, Rotation::ONE, Rotation::ZERO].map(Rotation::to_bits),
        period: 0,
        projection,
        viewer: VIEWER_INFINITE,
        focal: focal.to_bits(),
        near: near.to_bits(),
        far: far.to_bits(),
    }
}

/// A label. If `text` is longer than [`LABEL_TEXT`] characters, the rest is cut off.
#[must_use]
pub fn label(position: [Share; 2], height: Share, colour: [u8; 3], alignment: u8, text: &[u8]) -> Label {
    let mut room = [0; LABEL_TEXT];
    room.iter_mut().zip(text).for_each(|(room, character)| *room = *character);
    Label { position: position.map(Share::to_bits), height: height.to_bits(), colour, alignment, text: room }
}
