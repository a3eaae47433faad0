//! Memory that is reused from map to map.

/// Empties a vector and makes room for `capacity` elements once and for all. Pages that are never written stay unmapped,
/// so the worst case costs address space, not memory.
pub(crate) fn reserve_to<T>(vec: &mut Vec<T>, capacity: usize) {
    vec.clear();
    vec.reserve(capacity);
}
