//! What to draw in one frame, in object space.

/// Lights in one scene.
pub const MAX_LIGHTS: usize = 8;
