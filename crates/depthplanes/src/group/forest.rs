//! Union-find forests. A parent never has a larger index than its child, so the root of a tree is its
//! first element and one forward pass flattens everything.

use std::hint::select_unpredictable;

/// Root of `element`, halving the path on the way.
#[inline(always)]
fn root(parent: &mut [u32], mut element: u32) -> u32 {
    while parent[element as usize] != element {
        let grandparent = parent[parent[element as usize] as usize];
        parent[element as usize] = grandparent;
        element = grandparent;
    }
    element
}

/// Joins the trees of two elements.
#[inline(always)]
pub(super) fn unite(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parent, a), root(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}

/// Turns a forest into groups, in place: every element's entry becomes its group, counted in the order
/// of first elements, and `sizes`, one for each element, the sums over the groups.
///
/// A parent comes before its children, so its group is known when theirs is asked for; a group is
/// never above its elements, so no size is overwritten before it was read.
pub(super) fn flatten(forest: &mut [u32], sizes: &mut Vec<u32>) {
    assert_eq!(forest.len(), sizes.len());
    let mut groups = 0;
    for element in 0..forest.len() {
        let (parent, size) = (forest[element] as usize, sizes[element]);
        let (is_root, group_of_parent) = (parent == element, forest[parent]);
        let group = select_unpredictable(is_root, groups, group_of_parent);
        let size_before = select_unpredictable(is_root, 0, sizes[group as usize]);
        forest[element] = group;
        sizes[group as usize] = size_before + size;
        groups += u32::from(is_root);
    }
    sizes.truncate(groups as usize);
}
