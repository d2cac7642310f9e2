//! The cargo features of the core that a program needs to draw a stream.

use microphong::{Stream, features::Feature};
use microphong_sim::{program, render::Format};

/// Their names, for a program with this pixel format.
pub(super) fn names(stream: &Stream<'_>, format: Format) -> Vec<&'static str> {
    program::needs(stream, format).into_iter().map(Feature::name).collect()
}

/// The dependency of a program that has these features and no others, as in its `Cargo.toml`.
pub(super) fn text(names: &[&str]) -> String {
    let quoted: Vec<_> = names.iter().map(|name| format!("\"{name}\"")).collect();
    let list = if quoted.is_empty() { String::new() } else { format!(", features = [{}]", quoted.join(", ")) };
    format!("the least flash: microphong = {{ ..., default-features = false{list} }}")
}
