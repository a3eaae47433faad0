//! Work on parts of a whole, in parallel.
//!
//! In: something that can be split between its rows. Out: the results of the parts, put together. Only for work whose
//! answer does not depend on where it is split.

use super::memory::parts_of;
use std::ops::Range;

/// Something made of rows.
pub(crate) trait Rows: Sized + Send {
    /// How many.
    fn rows(&self) -> usize;
    /// The first `rows`, and the others.
    fn split_rows(self, rows: usize) -> (Self, Self);
}

/// Parts for each thread, so that a thread with little to do can take some from the others.
const PARTS: usize = 4;

/// Does the work on about `threads` times [`PARTS`] parts of a whole, or on the whole if there is one thread (or no
/// feature `parallel`); `unite` puts the results of neighbouring parts together.
pub(crate) fn map_reduce<W: Rows, A: Send>(
    threads: usize,
    whole: W,
    work: impl Fn(W) -> A + Sync,
    unite: impl Fn(A, A) -> A + Sync,
) -> A {
    let parts = if cfg!(feature = "parallel") && threads > 1 { threads * PARTS } else { 1 };
    split(parts, whole, &work, &unite)
}

/// Does the work inside the thread pool, if there is more than one thread, so that all its calls of [`map_reduce`]
/// share the pool's threads: threads that go to sleep between stages take longer to wake than some stages take.
pub(crate) fn install<A: Send>(threads: usize, work: impl FnOnce() -> A + Send) -> A {
    join(threads, work, || ()).0
}

/// Does two things, in parallel if there is more than one thread.
pub(crate) fn join<A: Send, B: Send>(
    threads: usize,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if threads > 1 { both(a, b) } else { (a(), b()) }
}

fn split<W: Rows, A: Send>(
    parts: usize,
    whole: W,
    work: &(impl Fn(W) -> A + Sync),
    unite: &(impl Fn(A, A) -> A + Sync),
) -> A {
    if parts.min(whole.rows()) <= 1 {
        return work(whole);
    }
    let half = parts / 2;
    let rows = (whole.rows() * half / parts).max(1);
    let (first, second) = whole.split_rows(rows);
    let (a, b) = both(|| split(half, first, work, unite), || split(parts - half, second, work, unite));
    unite(a, b)
}

/// Does both, in parallel if a thread is free.
#[cfg(feature = "parallel")]
fn both<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    rayon::join(a, b)
}

#[cfg(not(feature = "parallel"))]
fn both<A, B>(a: impl FnOnce() -> A, b: impl FnOnce() -> B) -> (A, B) {
    (a(), b())
}

impl<T: Send> Rows for &mut [T] {
    fn rows(&self) -> usize {
        self.len()
    }

    fn split_rows(self, rows: usize) -> (Self, Self) {
        self.split_at_mut(rows)
    }
}

/// Things and the number of the first.
pub(crate) struct Numbered<'a, T> {
    pub(crate) first: usize,
    pub(crate) all: &'a mut [T],
}

impl<T: Send> Rows for Numbered<'_, T> {
    fn rows(&self) -> usize {
        self.all.len()
    }

    fn split_rows(self, rows: usize) -> (Self, Self) {
        let Numbered { first, all } = self;
        let (above, below) = all.split_at_mut(rows);
        (Numbered { first, all: above }, Numbered { first: first + rows, all: below })
    }
}

/// Rows of things, and the number of the first row.
pub(crate) struct NumberedRows<'a, T> {
    pub(crate) first: usize,
    /// Things of a row.
    pub(crate) per_row: usize,
    pub(crate) all: &'a mut [T],
}

impl<'a, T> NumberedRows<'a, T> {
    /// The rows with their numbers.
    pub(crate) fn each(self) -> impl Iterator<Item = (usize, &'a mut [T])> {
        (self.first..).zip(self.all.chunks_exact_mut(self.per_row))
    }
}

impl<T: Send> Rows for NumberedRows<'_, T> {
    fn rows(&self) -> usize {
        self.all.len() / self.per_row
    }

    fn split_rows(self, rows: usize) -> (Self, Self) {
        let NumberedRows { first, per_row, all } = self;
        let (above, below) = all.split_at_mut(rows * per_row);
        (NumberedRows { first, per_row, all: above }, NumberedRows { first: first + rows, per_row, all: below })
    }
}

/// Does the work on `per_part` rows at a time, on `threads` threads; each of these parts has memory of its own. Returns the
/// parts that were worked on.
pub(crate) fn for_row_blocks<P: Default + Send>(
    threads: usize,
    rows: usize,
    per_part: usize,
    parts: &mut Vec<P>,
    work: impl Fn(&mut P, Range<usize>) + Sync,
) -> &mut [P] {
    let parts = parts_of(parts, rows.div_ceil(per_part));
    let work_on = |some: Numbered<'_, P>| {
        for (number, part) in (some.first..).zip(some.all) {
            work(part, number * per_part..((number + 1) * per_part).min(rows));
        }
    };
    map_reduce(threads, Numbered { first: 0, all: &mut *parts }, work_on, |(), ()| ());
    parts
}

#[cfg(test)]
mod tests {
    use super::map_reduce;

    #[test]
    fn every_row_is_worked_on_once_and_in_order() {
        for rows in [0, 1, 2, 3, 7, 64] {
            for threads in [1, 2, 3, 8] {
                let mut all: Vec<usize> = (0..rows).collect();
                let work = |part: &mut [usize]| {
                    part.iter_mut().for_each(|row| *row += 1);
                    part.to_vec()
                };
                let seen = map_reduce(threads, &mut all[..], work, |mut a, b| {
                    a.extend(b);
                    a
                });
                assert_eq!(seen, (1..=rows).collect::<Vec<_>>(), "{rows} rows on {threads} threads");
                assert_eq!(seen, all);
            }
        }
    }
}
