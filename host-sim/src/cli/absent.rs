//! Commands that this build lacks. Help lists them, and calling one says which build has it.

use super::{Outcome, Usage};
use anyhow::Result;
use std::ffi::OsString;

/// Defines a command that needs the feature `boards`.
#[cfg(not(feature = "boards"))]
macro_rules! absent {
    ($($name:ident: $about:literal;)*) => {$(
        pub(super) mod $name {
            #[derive(clap::Args)]
            #[command(about = concat!($about, " (not in this build; run it to see how to build it)"), disable_help_flag = true)]
            pub(crate) struct Arguments {
                #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
                arguments: Vec<std::ffi::OsString>,
            }

            pub(crate) fn run(Arguments { arguments }: &Arguments) -> anyhow::Result<super::Outcome> {
                super::refuse(concat!("`", stringify!($name), "`"), stringify!($name), arguments)
            }
        }
    )*};
}

#[cfg(not(feature = "boards"))]
absent! {
    verify: "Draw scenes with the firmware of emulated boards, and compare every pixel with this computer";
    bench: "Count the instructions that a processor needs for one frame";
    growth: "Count the instructions of a frame for growing numbers of triangles, pixels, lights and bands";
    size: "Show flash, RAM and stack of whole programs, and whether they fit into chips";
}

/// The error that names the build with `what`, by the command to run.
pub(super) fn refuse(what: &str, name: &str, arguments: &[OsString]) -> Result<Outcome> {
    let mut command = format!("cargo run --release --features boards -- {name}");
    for argument in arguments.iter().map(|argument| argument.to_string_lossy()) {
        command.push(' ');
        if argument.contains(char::is_whitespace) {
            command.push_str(&format!("{argument:?}"));
        } else {
            command.push_str(&argument);
        }
    }
    Err(Usage(format!(
        "this build has no {what}, because it was compiled without emulated boards; in the folder of the sources, run\n  {command}"
    ))
    .into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_that_has_it_is_named() {
        let arguments = ["my mesh.tri", "--board", "pico"].map(OsString::from);
        let error = refuse("`verify`", "verify", &arguments).err().expect("an error");
        assert!(error.is::<Usage>());
        let command = "cargo run --release --features boards -- verify \"my mesh.tri\" --board pico";
        assert!(error.to_string().ends_with(command), "{error}");
    }
}
