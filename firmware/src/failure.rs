//! Why there is no picture, or no other one, in words that fit a small display.

use core::fmt::Write;
use microphong::{RenderError, StreamError};

/// What kept the frame loop from starting, or ended it.
#[derive(Clone, Copy, Debug)]
pub enum Failure {
    /// The bytes in flash cannot be drawn.
    Stream(StreamError),
    /// The stream asks for more than this board has.
    Setup(RenderError),
    /// The display has not taken what it was sent.
    Transfer {
        /// How much that was.
        bytes: u32,
        /// Microseconds that it had, more than twice what it takes.
        limit: u32,
    },
    /// The program did not go on, and the watchdog has started it anew.
    Hang,
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
            Self::Transfer { bytes, limit } => {
                write!(text, "display: {bytes} bytes were not sent within {limit} us; switch the board off and on")
            }
            Self::Hang => write!(text, "watchdog: the program hung and was started anew; switch the board off and on"),
        };
        text
    }
}
