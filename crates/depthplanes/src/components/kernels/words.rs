//! The walk over a row in words of 64 pixels, for instruction sets that compare 64 pixels at a time.

use crate::components::isa::RowMasks;
use crate::map::Pixel;

/// Fills `out` by two operations on 64 consecutive pixels each, bit i for pixel i: which are valid,
/// and which are within theta of their counterparts.
///
/// # Safety
/// `valid(a)` reads 64 pixels at `a`, `close(a, b)` 64 pixels at each; nothing else.
#[inline(always)]
pub(super) unsafe fn words<T: Pixel>(
    row: &[T],
    up: &[T],
    out: RowMasks<'_>,
    valid: impl Fn(*const T) -> u64,
    close: impl Fn(*const T, *const T) -> u64,
) {
    let width = row.len();
    assert!(up.len() == width && out.valid.len() == width.div_ceil(64));
    assert!(out.close_left.len() == out.valid.len() && out.close_up.len() == out.valid.len());
    if width <= 64 {
        // A narrow row is copied to where 64 pixels can be read, with missing ones after it.
        let (mut here, mut above) = ([T::ZERO; 65], [T::ZERO; 64]);
        here[1..][..width].copy_from_slice(row);
        above[..width].copy_from_slice(up);
        let pixels = here[1..].as_ptr();
        out.valid[0] = valid(pixels);
        out.close_left[0] = close(pixels, here.as_ptr()) & !1; // column 0 has no left neighbour
        out.close_up[0] = close(pixels, above.as_ptr());
        return;
    }
    let (here, above) = (row.as_ptr(), up.as_ptr());
    // SAFETY: all words but the last lie within the row; so do the 64 pixels from column 1 on (column 0 has no left
    // neighbour), and the row's last 64 pixels, of which the last word takes the highest bits.
    unsafe {
        out.valid[0] = valid(here);
        out.close_left[0] = close(here.add(1), here) << 1;
        out.close_up[0] = close(here, above);
        let last = out.valid.len() - 1;
        for w in 1..last {
            let at = w * 64;
            out.valid[w] = valid(here.add(at));
            out.close_left[w] = close(here.add(at), here.add(at - 1));
            out.close_up[w] = close(here.add(at), above.add(at));
        }
        let (at, excess) = (width - 64, (last + 1) * 64 - width);
        out.valid[last] = valid(here.add(at)) >> excess;
        out.close_left[last] = close(here.add(at), here.add(at - 1)) >> excess;
        out.close_up[last] = close(here.add(at), above.add(at)) >> excess;
    }
}
