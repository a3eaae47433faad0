//! Runs of equal numbers in a row.

use super::bits::each_one;
use std::ops::Range;

/// The number of a place that belongs to nothing.
pub(crate) const NONE: u32 = u32::MAX;

/// Numbers that are compared together.
const LANES: usize = 16;

/// Calls `visit` for each run of a row's places that have one number, except [`NONE`], with the number and the columns.
#[inline(always)]
pub(crate) fn each_run(row: &[u32], first: usize, mut visit: impl FnMut(u32, Range<usize>)) {
    let mut start = 0;
    let mut end_at = |end: usize| {
        if row[start] != NONE {
            visit(row[start], first + start..first + end);
        }
        start = end;
    };
    let Some(last) = row.len().checked_sub(1) else { return };
    let (own, next) = (row[..last].as_chunks::<LANES>(), row[1..].as_chunks::<LANES>());
    for (at, (own, next)) in (1..).step_by(LANES).zip(own.0.iter().zip(next.0)) {
        each_one(std::array::from_fn(|i| u8::from(own[i] != next[i])), |place| end_at(at + place));
    }
    for (at, (own, next)) in (last - own.1.len() + 1..).zip(own.1.iter().zip(next.1)) {
        if own != next {
            end_at(at);
        }
    }
    end_at(row.len());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::util::random::Random;

    #[test]
    fn runs_of_a_row_are_what_a_look_at_each_cell_finds() {
        let mut random = Random::new(7);
        for length in 0..80 {
            let share = random.uniform();
            let mut id = 0;
            let mut next = |_| {
                if random.uniform() < share {
                    id = [NONE, 1, 2, 3][(random.uniform() * 4.0) as usize];
                }
                id
            };
            let row: Vec<u32> = (0..length).map(&mut next).collect();
            let (mut cells, mut runs) = (vec![NONE; length], 0);
            each_run(&row, 5, |id, columns| {
                runs += 1;
                columns.for_each(|column| cells[column - 5] = id);
            });
            let begins = (0..length).filter(|&at| row[at] != NONE && (at == 0 || row[at - 1] != row[at]));
            assert_eq!((cells, runs), (row.clone(), begins.count()), "{row:?}");
        }
    }
}
