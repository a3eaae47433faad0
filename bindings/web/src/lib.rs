//! The library as WebAssembly, as the npm package `depthplanes` asks it; `js/index.ts` is the interface.
//!
//! JavaScript asks for room ([`request`]), writes a question there and calls [`answer`]. Both are messages of a head of JSON and
//! of numbers behind it (`depthplanes_io::page::Message`; a question has one array, of bytes). No pointer comes in, so there
//! is nothing that could point elsewhere. The module remembers the last map and detector to be faster, and nothing that
//! an answer depends on: a module that was started anew answers the same.

mod clock;
mod finder;
mod map;
mod question;
mod reading;
mod refusal;
mod shown;
mod tables;

use question::Desk;
use std::cell::RefCell;

thread_local! {
    static DESK: RefCell<Desk> = RefCell::default();
}

/// Room for a question of that many bytes, which is valid until the next call; null if there is no memory.
#[unsafe(no_mangle)]
pub extern "C" fn request(bytes: usize) -> *mut u8 {
    DESK.with_borrow_mut(|desk| desk.room(bytes).map_or(std::ptr::null_mut(), <[u8]>::as_mut_ptr))
}

/// Answers the question that stands in the room; returns how many bytes the answer has.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> usize {
    DESK.with_borrow_mut(Desk::answer)
}

/// Where the last answer stands, which is valid until the next call.
#[unsafe(no_mangle)]
pub extern "C" fn answered() -> *const u8 {
    DESK.with_borrow(|desk| desk.answered().as_ptr())
}
