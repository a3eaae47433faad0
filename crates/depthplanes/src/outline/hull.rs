//! The convex hull of a plane's pixels.
//!
//! In: the corners of its outer rings. Out: the corners of the hull, counter-clockwise on the
//! picture. The rows' first and last corners come in order, so that the monotone chain (Andrew 1979)
//! needs no sorting.

use super::corner::{Corner, turn};

/// Finds hulls; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Huller {
    /// For each row of corners from the top, the first and the last column.
    rows: Vec<Option<[u16; 2]>>,
}

impl Huller {
    /// Appends the hull.
    pub(super) fn hull<'a>(&mut self, corners: impl Iterator<Item = &'a Corner> + Clone, hull: &mut Vec<Corner>) {
        let rows = corners.clone().map(|corner| corner[1]);
        let top = rows.min().unwrap_or(0);
        self.rows.clear();
        for &[x, y] in corners {
            let row = usize::from(y - top);
            if row >= self.rows.len() {
                self.rows.resize(row + 1, None);
            }
            let [first, last] = self.rows[row].get_or_insert([x, x]);
            (*first, *last) = (x.min(*first), x.max(*last));
        }
        let rows = self.rows.iter().enumerate().filter_map(|(row, ends)| Some((top + row as u16, (*ends)?)));
        chain(rows.clone().map(|(y, [first, _])| [first, y]), hull);
        chain(rows.rev().map(|(y, [_, last])| [last, y]), hull);
    }
}

/// Appends those of the corners, which come row by row, that turn counter-clockwise.
fn chain(corners: impl Iterator<Item = Corner>, hull: &mut Vec<Corner>) {
    let start = hull.len();
    for corner in corners {
        while let [.., a, b] = hull[start..] {
            if turn(a, b, corner) < 0 {
                break;
            }
            hull.pop();
        }
        hull.push(corner);
    }
}
