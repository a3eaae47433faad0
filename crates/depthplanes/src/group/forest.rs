//! Union-find forests. A parent never has a larger index than its child, so the root of a tree is its
//! first element and one forward pass flattens everything.

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
/// of first elements, and `sizes` the sum of each group's `weights`.
///
/// A parent comes before its children, so its group is known when theirs is asked for.
pub(super) fn flatten(forest: &mut [u32], weights: impl Iterator<Item = u32>, sizes: &mut Vec<u32>) {
    let mut groups = 0;
    sizes.clear();
    sizes.resize(forest.len(), 0);
    for (element, weight) in (0..forest.len()).zip(weights) {
        let parent = forest[element] as usize;
        let (is_root, group_of_parent) = (parent == element, forest[parent]);
        let group = if is_root { groups } else { group_of_parent };
        forest[element] = group;
        sizes[group as usize] += weight;
        groups += u32::from(is_root);
    }
    sizes.truncate(groups as usize);
}
