//! Union-find forests. A parent never has a larger index than its child, so the root of a tree is its
//! first element and one forward pass flattens everything.

use std::hint::select_unpredictable;

/// The number of an element.
pub(crate) trait Element: Copy + Ord {
    /// Where its parent stands.
    fn at(self) -> usize;
}

macro_rules! element {
    ($t:ty) => {
        impl Element for $t {
            #[inline(always)]
            fn at(self) -> usize {
                self as usize
            }
        }
    };
}
element!(u16);
element!(u32);
element!(usize);

/// Root of an element.
#[inline(always)]
pub(crate) fn find<E: Element>(parents: &[E], mut element: E) -> E {
    while parents[element.at()] != element {
        element = parents[element.at()];
    }
    element
}

/// As [`find`], halving the path on the way.
#[inline(always)]
fn find_halving<E: Element>(parents: &mut [E], mut element: E) -> E {
    while parents[element.at()] != element {
        let grandparent = parents[parents[element.at()].at()];
        parents[element.at()] = grandparent;
        element = grandparent;
    }
    element
}

/// Joins the trees of two elements.
#[inline(always)]
pub(crate) fn unite<E: Element>(parents: &mut [E], a: E, b: E) {
    let (a, b) = (find_halving(parents, a), find_halving(parents, b));
    parents[a.max(b).at()] = a.min(b);
}

/// Turns a forest into groups, in place: every element's entry becomes its group, numbered in the order of first
/// elements; `sizes`, which has one number for each element, becomes the sums over the groups.
///
/// A parent comes before its children, so its group is known when theirs is asked for; a group is
/// never above its elements, so no size is overwritten before it was read.
pub(crate) fn flatten(forest: &mut [u32], sizes: &mut Vec<u32>) {
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
