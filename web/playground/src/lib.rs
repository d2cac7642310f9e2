//! The playground without its page: it takes requests, and answers them with pictures, figures and files.
//!
//! A request and an answer are a [`message`]: a JSON object, and bytes. The page only shows controls and answers, so all decisions are made here, and
//! natively tested.

mod boards;
mod catalogue;
mod choices;
mod command;
mod edit;
mod estimate;
mod measure;
pub mod message;
mod panel;
mod pixels;
mod program;
mod session;

pub use session::Session;
