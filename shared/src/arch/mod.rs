//! What processors do differently: each operation is written as short as the processor at hand can do it, with the same result on all.

pub mod product;
pub mod quotient;
pub mod zeros;
