//! The shading methods of the literature, each in integers and in a file of its own, for [`microphong`].
//!
//! Each is a [`microphong::method::Method`], as any program can bring: they use nothing of microphong but its interface. A program takes a
//! method by naming it, `Shader::new(&microphong_literature::Cubic)`, and has the code of no other.
#![no_std]
#![forbid(unsafe_code)]

pub mod angle;
pub mod angular;
pub mod arc;
pub mod blinn;
pub mod cubic;
pub mod divisor;
pub mod duff;
pub mod environment;
pub mod fields;
pub mod goldman;
pub mod gouraud4;
pub mod highlight_test;
pub mod hybrid;
pub mod nodes;
pub mod parabola;
pub mod phong_rv;
pub mod pseudo_phong;
pub mod quadratic_blinn;
pub mod renq;
pub mod renq_newton;
pub mod scanline;
pub mod six_point_adaptive;
pub mod six_point_centre;
pub mod slerp;
pub mod split;
pub mod sub_triangle;
pub mod taylor;
pub mod taylor_finite;

pub use angular::{Angular, AngularOriginal};
pub use blinn::Blinn;
pub use cubic::Cubic;
pub use duff::Duff;
pub use environment::Environment;
pub use goldman::Goldman;
pub use gouraud4::Gouraud4;
pub use highlight_test::HighlightTest;
pub use hybrid::{Hybrid, HybridOriginal};
use microphong::method::Method;
pub use phong_rv::PhongRv;
pub use pseudo_phong::PseudoPhong;
pub use quadratic_blinn::QuadraticBlinn;
pub use renq::Renq;
pub use renq_newton::RenqNewton;
pub use six_point_adaptive::SixPointAdaptive;
pub use six_point_centre::SixPointCentre;
pub use slerp::Slerp;
pub use taylor::Taylor;
pub use taylor_finite::TaylorFinite;

/// Every method of this crate, in the order of their numbers.
pub const ALL: [&dyn Method; 21] = [
    &PhongRv,
    &Gouraud4,
    &PseudoPhong,
    &HighlightTest,
    &Goldman,
    &Slerp,
    &Duff,
    &Taylor,
    &TaylorFinite,
    &SixPointAdaptive,
    &SixPointCentre,
    &Cubic,
    &Angular,
    &AngularOriginal,
    &Hybrid,
    &HybridOriginal,
    &Environment,
    &Blinn,
    &QuadraticBlinn,
    &Renq,
    &RenqNewton,
];
