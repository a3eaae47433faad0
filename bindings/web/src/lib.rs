//! The library as WebAssembly, as the npm package `depthplanes` asks it; `js/index.ts` is the interface.
//!
//! JavaScript asks for room ([`request`]), writes a request there and calls [`respond`]. Both are messages of a head of JSON and
//! of numbers behind it (`depthplanes_io::page::Message`; a request has one array, of bytes). No pointer comes in, so there
//! is nothing that could point elsewhere. The module remembers the last map and detector to be faster, and nothing that
//! an answer depends on: a module that was started anew answers the same.

mod clock;
mod error;
mod finder;
mod map;
mod memory;
mod options;
mod reading;
mod request;
mod shown;
mod tables;

use request::Session;
use std::cell::RefCell;

thread_local! {
    static SESSION: RefCell<Session> = RefCell::default();
}

/// Room for a request of that many bytes, which is valid until the next call; null if there is no memory.
#[unsafe(no_mangle)]
pub extern "C" fn request(bytes: usize) -> *mut u8 {
    SESSION.with_borrow_mut(|session| session.room(bytes).map_or(std::ptr::null_mut(), <[u8]>::as_mut_ptr))
}

/// Answers the request that stands in the room; returns how many bytes the answer has.
#[unsafe(no_mangle)]
pub extern "C" fn respond() -> usize {
    SESSION.with_borrow_mut(Session::respond)
}

/// Where the last answer stands, which is valid until the next call.
#[unsafe(no_mangle)]
pub extern "C" fn response() -> *const u8 {
    SESSION.with_borrow(|session| session.response().as_ptr())
}
