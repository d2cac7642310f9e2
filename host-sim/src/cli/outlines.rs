//! Options about lines along outlines, which several commands have.

use super::parse;
use microphong::Outlines;

/// The lines that are wanted.
#[derive(clap::Args)]
pub(crate) struct OutlineOptions {
    /// Lines of this colour along outlines: where a surface ends, its shading jumps, or two surfaces cut each other. They take the place of those
    /// that the scene states.
    #[arg(long, value_name = "RRGGBB", value_parser = parse::bytes)]
    outlines: Option<[u8; 3]>,
    /// Lines of --outlines on the background, without the surfaces.
    #[arg(long, requires = "outlines")]
    outlines_alone: bool,
}

impl OutlineOptions {
    /// The lines; `None` if none are asked for.
    pub(crate) fn wanted(&self) -> Option<Outlines> {
        self.outlines.map(|colour| Outlines::new(colour).alone(self.outlines_alone))
    }
}
