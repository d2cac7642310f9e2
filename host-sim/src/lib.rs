//! The simulator as a library: what the `microphong` command is made of.

