//! Operations that processors do differently: each is as short as the processor at hand allows, with the same result on all.

pub mod product;
pub mod quotient;
pub mod zeros;
