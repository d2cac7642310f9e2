//! Why there is no picture, or no other one, in words that fit a small display.

use core::fmt::Write;
use microphong::{RenderError, StreamError};

/// The reason why the frame loop has not started, or has ended.
#[derive(Clone, Copy, Debug)]
pub enum Failure {
    /// The bytes in flash cannot be drawn.
    Stream(StreamError),
    /// The stream asks for more than this board has.
    Setup(RenderError),
    /// The display has not accepted bytes in time.
    Transfer {
        /// Number of bytes that were sent.
        bytes: u32,
        /// Time limit in microseconds, more than twice the time that the bytes take.
        limit: u32,
    },
    /// The program hung, and the watchdog has restarted it.
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
