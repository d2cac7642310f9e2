//! Operations that differ between processors. Each is as short as the processor allows, and has the same result on all.

pub(crate) mod product;
pub(crate) mod quotient;
pub(crate) mod zeros;

/// Whether one instruction shifts a word and clamps it to an unsigned range (`USAT` of Armv7-M).
pub(crate) const SATURATES: bool = cfg!(all(target_arch = "arm", target_has_atomic = "32"));
