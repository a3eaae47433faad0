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

/// Every run's parent becomes its root, and every root's size the pixels of its group.
pub(super) fn flatten(parent: &mut [u32], size: &mut Vec<u32>, strips: &[Strip]) {
    size.clear();
    size.resize(parent.len(), 0);
    let mut run = 0;
    for strip in strips {
        for (first, last) in strip.first_column.iter().zip(&strip.last_column) {
            let root = parent[parent[run] as usize];
            parent[run] = root;
            size[root as usize] += u32::from(last - first) + 1;
            run += 1;
        }
    }
}
