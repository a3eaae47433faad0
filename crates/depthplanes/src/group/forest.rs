//! The union-find forest over runs. A parent never has a larger index than its child, so the root of
//! a tree is the first run of its group and one forward pass flattens everything.

use super::strip::Strip;

/// Root of `run`, halving the path on the way.
#[inline(always)]
fn root(parent: &mut [u32], mut run: u32) -> u32 {
    while parent[run as usize] != run {
        let grandparent = parent[parent[run as usize] as usize];
        parent[run as usize] = grandparent;
        run = grandparent;
    }
    run
}

/// Joins the groups of two runs.
#[inline(always)]
pub(super) fn unite(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parent, a), root(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}

/// Turns the forest into groups, in place: every run's entry becomes its group, groups being counted
/// in the order of their first runs, and `sizes` the pixels of each group.
///
/// A parent comes before its children, so its group is known when theirs is asked for.
pub(super) fn flatten(forest: &mut [u32], sizes: &mut Vec<u32>, strips: &[Strip]) {
    sizes.clear();
    sizes.resize(forest.len() + 1, 0);
    let (mut groups, mut run) = (0, 0);
    for strip in strips {
        for (first, last) in strip.first_column.iter().zip(&strip.last_column) {
            let parent = forest[run] as usize;
            let (is_root, group_of_parent) = (parent == run, forest[parent]);
            let group = if is_root { groups } else { group_of_parent };
            forest[run] = group;
            sizes[group as usize] += u32::from(last - first) + 1;
            groups += u32::from(is_root);
            run += 1;
        }
    }
    sizes.truncate(groups as usize);
}
