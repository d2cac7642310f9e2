//! Which pixels a triangle covers, and the loops that fill them.

pub mod edge;
pub mod fill;
pub mod triangle;
