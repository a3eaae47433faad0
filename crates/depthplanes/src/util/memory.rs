//! Memory that is reused from map to map.

/// Empties a vector and makes room for `capacity` elements once and for all. Pages that are never written stay unmapped,
/// so the worst case costs address space, not memory.
pub(crate) fn reserve_to<T>(vec: &mut Vec<T>, capacity: usize) {
    vec.clear();
    vec.reserve(capacity);
}

/// So many parts of a vector that keeps those beyond them, with their memory, for a larger map.
pub(crate) fn parts_of<P: Default>(parts: &mut Vec<P>, count: usize) -> &mut [P] {
    if parts.len() < count {
        parts.resize_with(count, P::default);
    }
    &mut parts[..count]
}
