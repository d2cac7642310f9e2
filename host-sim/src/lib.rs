//! The simulator as a library: what the `microphong` command is made of, each part a package of its own.

#[cfg(feature = "boards")]
pub use microphong_bench as bench;
#[cfg(feature = "boards")]
pub use microphong_boards::{self as board, verify};
pub use microphong_bounds as bounds;
pub use microphong_compare::{self as compare, level};
pub use microphong_models::{
    backs, bytes, coat, convert, convex, distance, gallery, import, levels, look, mesh, number, obj, paint, polygon, quantise, records,
    scene, script, shapes, vector, view,
};
pub use microphong_oracle::{self as oracle, papers};
pub use microphong_render::{chip, choices, image, legend, output, program, render, shader};
pub use microphong_stress as stress;

/// All families of random cases. With a `budget`, the family of this name keeps to it.
#[must_use]
pub fn families(budget: Option<microphong::format::ErrorBudget>) -> Vec<Box<dyn stress::Family>> {
    let mut families = stress::families(budget);
    families.extend(costs());
    families
}

/// Costs are counted by a build with boards.
#[cfg(feature = "boards")]
fn costs() -> Option<Box<dyn stress::Family>> {
    Some(Box::new(stress::cost::Cost(bench::callgrind::Counters::default())))
}

#[cfg(not(feature = "boards"))]
const fn costs() -> Option<Box<dyn stress::Family>> {
    None
}
