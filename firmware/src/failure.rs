//! Why there is no picture, in words that fit a small display.

use core::fmt::Write;
use microphong::{RenderError, StreamError};

/// What kept the frame loop from starting.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Failure {
    /// The bytes in flash cannot be drawn.
    Stream(StreamError),
    /// The stream asks for more than this board has.
    Setup(RenderError),
}

impl From<StreamError> for Failure {
    fn from(error: StreamError) -> Self {
        Self::Stream(error)
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        Self::Setup(error)
    }
}

impl Failure {
    /// The whole message; what does not fit is cut off.
    #[must_use]
    pub(crate) fn message(&self) -> heapless::String<160> {
        let mut text = heapless::String::new();
        // A full string ends the writing, which is all that can go wrong.
        let _ = match self {
            Self::Stream(error) => write!(text, "stream: {error}"),
            Self::Setup(error) => write!(text, "setup: {error}"),
        };
        text
    }
}
