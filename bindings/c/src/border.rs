//! The border between C and Rust: texts become strings, panics errors, errors codes.

use crate::error::{Error, Result};
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::mem::MaybeUninit;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::null;

/// Does something and makes an error of a panic, which must not reach C.
pub(crate) fn guarded<T>(act: impl FnOnce() -> Result<T>) -> Result<T> {
    catch_unwind(AssertUnwindSafe(act)).unwrap_or_else(|panic| Err(Error::of_panic(&*panic)))
}

/// What an argument points to.
///
/// # Errors
/// A null pointer.
pub(crate) fn required<T>(argument: &str, pointer: Option<T>) -> Result<T> {
    pointer.ok_or_else(|| Error::null(argument))
}

/// The text that an argument points to.
///
/// # Safety
/// The pointer is null, or a text that ends with a zero byte and lives for `'a`.
///
/// # Errors
/// A null pointer, a text that is no UTF-8.
pub(crate) unsafe fn text<'a>(argument: &str, pointer: *const c_char) -> Result<&'a str> {
    if pointer.is_null() {
        return Err(Error::null(argument));
    }
    // SAFETY: as the caller says, and it is not null.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| Error::invalid(format!("`{argument}` is no text in UTF-8: {}", text.to_string_lossy())))
}

/// A text for C; it ends where it has a zero byte.
pub(crate) fn for_c(text: &str) -> CString {
    CString::new(text.split('\0').next().unwrap_or_default()).expect("there is no zero byte in it")
}

/// Hands out values and, if that is wanted, their number; null if there are none.
pub(crate) fn lent<T>(values: Option<&Vec<T>>, count: Option<&mut MaybeUninit<usize>>) -> *const T {
    let values = values.filter(|values| !values.is_empty());
    if let Some(count) = count {
        count.write(values.map_or(0, Vec::len));
    }
    values.map_or(null(), |values| values.as_ptr())
}

thread_local! {
    /// The text of the last error of this thread that no detector keeps.
    static LAST: RefCell<CString> = RefCell::default();
}

/// Keeps the text of an error where there is no detector to do so.
pub(crate) fn keep_last(error: &Error) {
    LAST.with(|last| *last.borrow_mut() = for_c(&error.text));
}

/// The text that was kept; it stays where it is until the next one.
pub(crate) fn last() -> *const c_char {
    LAST.with(|last| last.borrow().as_ptr())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::dp_status;

    #[test]
    fn a_panic_becomes_an_error_that_says_what_it_said() {
        let acts: [fn() -> Result<()>; 2] = [|| panic!("out of reach"), || panic!("{} of 3", 1)];
        for (act, said) in acts.into_iter().zip(["out of reach", "1 of 3"]) {
            let error = guarded(act).unwrap_err();
            assert_eq!(error.status, dp_status::DP_INTERNAL);
            assert!(error.text.contains(said), "{}", error.text);
        }
        assert_eq!(guarded(|| Ok(7)).unwrap(), 7);
    }

    #[test]
    fn what_is_no_text_is_refused() {
        // SAFETY: null, and two texts that end with a zero byte.
        let given =
            [std::ptr::null(), c"mm".as_ptr(), c"\xff".as_ptr()].map(|text_at| unsafe { text("name", text_at) });
        let codes = given.map(|text| text.map_err(|error| error.status));
        assert_eq!(codes, [Err(dp_status::DP_NULL_POINTER), Ok("mm"), Err(dp_status::DP_INVALID_ARGUMENT)]);
    }
}
