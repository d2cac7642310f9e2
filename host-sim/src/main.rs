//! The `microphong` command.
fn main() {}
