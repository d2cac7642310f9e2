//! Operations that processors do differently: each is as short as the processor at hand allows, with the same result on all.

pub(crate) mod product;
pub(crate) mod quotient;
pub(crate) mod zeros;
