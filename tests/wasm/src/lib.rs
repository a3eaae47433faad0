//! The library behind a plain C interface, built for `wasm32-unknown-unknown`: labels and the number of planes for the
//! pixels of one map.
//!
//! It is what `tests/oracles/test_wasm.py` runs under node, and a pattern to copy for your own module: take the exports,
//! add what your page needs. [`labels.mjs`](../labels.mjs) is the side of JavaScript.
//!
//! A caller asks for memory with [`allocate`], writes the method's name and the pixels there, calls [`detect_u16`] or
//! [`detect_f32`], reads the labels and gives the memory back with [`free`]. Only 32-bit numbers cross the border.

use depthplanes::{AnyView, DepthView, Detector, Sensor, ValueKind, methods};
use std::alloc::Layout;
use std::slice::{from_raw_parts, from_raw_parts_mut};

/// Returned for a method whose name is not known.
pub const UNKNOWN_METHOD: i32 = -1;
/// Returned for pointers that cannot be: null or not aligned.
pub const WRONG_POINTER: i32 = -2;
/// Returned for a size that no map has.
pub const WRONG_SIZE: i32 = -3;
/// Returned if the method refuses the map, for instance since it has more planes than there are labels.
pub const REFUSED: i32 = -4;

/// Enough for any type of pixel.
const ALIGNMENT: usize = 8;

/// Memory of that many bytes, all 0, for any type of pixel; null for 0 bytes and if there is no more.
#[unsafe(no_mangle)]
pub extern "C" fn allocate(bytes: usize) -> *mut u8 {
    match Layout::from_size_align(bytes, ALIGNMENT) {
        // SAFETY: the layout is not of size 0.
        Ok(layout) if bytes > 0 => unsafe { std::alloc::alloc_zeroed(layout) },
        _ => std::ptr::null_mut(),
    }
}

/// Gives back memory of [`allocate`]; nothing for null.
///
/// # Safety
/// `memory` is null, or came from `allocate(bytes)` and was not given back yet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn free(memory: *mut u8, bytes: usize) {
    if let (false, Ok(layout)) = (memory.is_null(), Layout::from_size_align(bytes, ALIGNMENT)) {
        // SAFETY: by the contract it was allocated with this layout, which `allocate` made of the same number.
        unsafe { std::alloc::dealloc(memory, layout) }
    }
}

/// Finds planes in a map of 16-bit millimetres, 0 missing, with a method at its defaults. Returns the number of planes, 0
/// and up, and writes `width * height` labels, 0 for no plane; or returns a number below 0 and writes nothing.
///
/// # Safety
/// `name` points to `name_bytes` bytes, `pixels` and `labels` to `width * height` numbers each, row by row, which live and
/// are nobody else's until this returns. `labels` lies apart from the others and was written before, as by [`allocate`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn detect_u16(
    name: *const u8,
    name_bytes: usize,
    pixels: *const u16,
    width: usize,
    height: usize,
    labels: *mut u16,
) -> i32 {
    // SAFETY: the contract is this function's.
    let given = unsafe { given(name, name_bytes, pixels, width, height, labels) };
    answer(given.and_then(|(name, pixels, labels)| {
        let map = DepthView::new(pixels, width, height).or(Err(WRONG_SIZE))?;
        detect(name, map.into(), 0.001, labels)
    }))
}

/// As [`detect_u16`], of floating-point metres; 0, what is negative and what is not finite are missing.
///
/// # Safety
/// As of [`detect_u16`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn detect_f32(
    name: *const u8,
    name_bytes: usize,
    pixels: *const f32,
    width: usize,
    height: usize,
    labels: *mut u16,
) -> i32 {
    // SAFETY: the contract is this function's.
    let given = unsafe { given(name, name_bytes, pixels, width, height, labels) };
    answer(given.and_then(|(name, pixels, labels)| {
        let map = DepthView::new(pixels, width, height).and_then(|map| map.valid_range(0.0, f32::MAX));
        detect(name, map.or(Err(WRONG_SIZE))?.into(), 1.0, labels)
    }))
}

/// A method's name, pixels and the place of labels.
type Given<'a, T> = (&'a str, &'a [T], &'a mut [u16]);

/// What a caller gave, checked as far as pointers and numbers can be.
///
/// # Safety
/// As of [`detect_u16`].
unsafe fn given<'a, T>(
    name: *const u8,
    name_bytes: usize,
    pixels: *const T,
    width: usize,
    height: usize,
    labels: *mut u16,
) -> Result<Given<'a, T>, i32> {
    if name.is_null() || pixels.is_null() || labels.is_null() || !pixels.is_aligned() || !labels.is_aligned() {
        return Err(WRONG_POINTER);
    }
    let fits = |area: &usize| area.checked_mul(size_of::<T>()).is_some_and(|bytes| bytes <= isize::MAX as usize);
    let area = width.checked_mul(height).filter(fits).ok_or(WRONG_SIZE)?;
    // SAFETY: the pointers are aligned and not null, the slices are no longer than memory can be, and by the contract all
    // of them is there, unchanged by others, with `labels` apart.
    let (name, pixels, labels) =
        unsafe { (from_raw_parts(name, name_bytes), from_raw_parts(pixels, area), from_raw_parts_mut(labels, area)) };
    Ok((std::str::from_utf8(name).or(Err(UNKNOWN_METHOD))?, pixels, labels))
}

/// The part without pointers. A program for frame after frame keeps the detector, which then allocates nothing.
fn detect(name: &str, map: AnyView<'_>, metres: f64, labels: &mut [u16]) -> Result<usize, i32> {
    let method = methods::find(name).and_then(|method| method.with(&[])).or(Err(UNKNOWN_METHOD))?;
    let sensor = Sensor::default().value_kind(ValueKind::depth(metres).or(Err(REFUSED))?);
    let mut detector = Detector::new(method).or(Err(REFUSED))?.sensor(sensor);
    let found = detector.detect(map).or(Err(REFUSED))?;
    labels.copy_from_slice(&found.labels);
    Ok(found.planes.len())
}

/// The number of planes, of which there are fewer than 2^16, or the error.
fn answer(found: Result<usize, i32>) -> i32 {
    found.map_or_else(|error| error, |planes| planes as i32)
}
