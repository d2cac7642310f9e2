//! The WebAssembly module of the playground. It imports nothing, so it can only compute.
//!
//! The page asks for a place with [`place`], writes a message there, and calls [`answer`], which returns the place of another message. A place is an
//! address, and four bytes before an answer are its length. After a panic the page reads what has happened at [`fault`], and starts the module anew.

use microphong_playground::{Session, message};
use std::{
    cell::RefCell,
    panic,
    sync::{Mutex, PoisonError},
};

thread_local! {
    /// The message from the page.
    static REQUEST: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    /// The message to the page.
    static ANSWER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    /// The session.
    static SESSION: RefCell<Session> = RefCell::default();
}

/// The panic that has ended the module. It is kept outside of the session, which nobody can use then.
static FAULT: Mutex<Vec<u8>> = Mutex::new(Vec::new());

/// A place for a message of this length.
#[unsafe(no_mangle)]
pub extern "C" fn place(length: usize) -> usize {
    REQUEST.with_borrow_mut(|request| {
        request.clear();
        request.resize(length, 0);
        request.as_mut_ptr().expose_provenance()
    })
}

/// The place of the answer to the message.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> usize {
    panic::set_hook(Box::new(|panic| {
        *FAULT.lock().unwrap_or_else(PoisonError::into_inner) = with_length(&message::failed(&panic.to_string()));
    }));
    let answer = REQUEST.with_borrow(|request| SESSION.with_borrow_mut(|session| session.answer(request)));
    ANSWER.with_borrow_mut(|place| {
        *place = with_length(&answer);
        place.as_ptr().expose_provenance()
    })
}

/// The place of a message that says why the module has ended.
#[unsafe(no_mangle)]
pub extern "C" fn fault() -> usize {
    let mut fault = FAULT.lock().unwrap_or_else(PoisonError::into_inner);
    if fault.is_empty() {
        // Memory and stack end without a panic.
        *fault = with_length(&message::failed("there is not enough memory for this; open a smaller mesh, or simplify it"));
    }
    fault.as_ptr().expose_provenance()
}

/// The length of a message, and the message.
fn with_length(message: &[u8]) -> Vec<u8> {
    [&(message.len() as u32).to_le_bytes(), message].concat()
}
