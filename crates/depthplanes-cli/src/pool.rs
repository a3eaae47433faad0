//! Work on many inputs at once with results in the order of the inputs.

use crate::failure::note;
use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError, mpsc};

/// A job begins no item that is further than so many items for each job from the one that is due, so that a slow item does
/// not let the results of all later ones pile up.
const AHEAD: usize = 16;

/// How many threads a map can have: what was wanted, or one if the machine makes no more, and a note says so.
pub(crate) fn threads(wanted: usize) -> usize {
    static POOL: OnceLock<bool> = OnceLock::new();
    let make = || {
        let made = rayon::ThreadPoolBuilder::new().build_global();
        let tell = |error| note(&format!("threads cannot be made ({error}); each map is worked on by one"));
        made.map_err(tell).is_ok()
    };
    if wanted > 1 && *POOL.get_or_init(make) { wanted } else { 1 }
}

/// Works on items `0..count` on up to `jobs` threads, fewer if the machine makes no more; each thread makes its own
/// worker. `sink` gets the results in order, on the calling thread, as early as the order allows.
///
/// # Errors
/// The first error of `sink`; no item is begun after it.
pub(crate) fn in_order<R: Send, W: FnMut(usize) -> R, E>(
    count: usize,
    jobs: usize,
    worker: impl Fn() -> W + Sync,
    mut sink: impl FnMut(usize, R) -> Result<(), E>,
) -> Result<(), E> {
    let jobs = jobs.min(count);
    if jobs < 2 {
        return one_by_one(count, worker, sink);
    }
    let next = AtomicUsize::new(0);
    let due = Due { item: Mutex::new(0), moved: Condvar::new(), ahead: AHEAD * jobs };
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for made in 0..jobs {
            let (sender, next, due, worker) = (sender.clone(), &next, &due, &worker);
            let started = std::thread::Builder::new().spawn_scoped(scope, move || {
                let _panics = Panics(due);
                let mut work = worker();
                loop {
                    let item = next.fetch_add(1, Ordering::Relaxed);
                    due.wait_for(item);
                    if item >= count || sender.send((item, work(item))).is_err() {
                        return;
                    }
                }
            });
            if let Err(error) = started {
                note(&format!("only {made} of {jobs} threads can be made ({error}); it takes longer"));
                if made == 0 {
                    return one_by_one(count, worker, sink);
                }
                break;
            }
        }
        drop(sender);
        let outcome = deliver(receiver, &due, &mut sink);
        next.store(count, Ordering::Relaxed);
        due.set(count);
        outcome
    })
}

/// Does all of it on the calling thread.
fn one_by_one<R, W: FnMut(usize) -> R, E>(
    count: usize,
    worker: impl Fn() -> W,
    mut sink: impl FnMut(usize, R) -> Result<(), E>,
) -> Result<(), E> {
    let mut work = worker();
    (0..count).try_for_each(|item| sink(item, work(item)))
}

/// Lets all others go on where a job panics, since the item that is due may then never come.
struct Panics<'a>(&'a Due);

impl Drop for Panics<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.set(usize::MAX - self.0.ahead);
        }
    }
}

/// The item whose result is delivered next.
struct Due {
    item: Mutex<usize>,
    moved: Condvar,
    ahead: usize,
}

impl Due {
    fn set(&self, item: usize) {
        let mut due = self.item.lock().unwrap_or_else(PoisonError::into_inner);
        *due = item.max(*due);
        self.moved.notify_all();
    }

    /// Waits until an item is near enough. The due item itself never waits.
    fn wait_for(&self, item: usize) {
        let due = self.item.lock().unwrap_or_else(PoisonError::into_inner);
        let far = |due: &mut usize| item > *due + self.ahead;
        drop(self.moved.wait_while(due, far).unwrap_or_else(PoisonError::into_inner));
    }
}

fn deliver<R, E>(
    receiver: mpsc::Receiver<(usize, R)>,
    due_item: &Due,
    sink: &mut impl FnMut(usize, R) -> Result<(), E>,
) -> Result<(), E> {
    let mut early = BTreeMap::new();
    let mut due = 0;
    for (item, result) in receiver {
        early.insert(item, result);
        while let Some(result) = early.remove(&due) {
            sink(due, result)?;
            due += 1;
            due_item.set(due);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::in_order;

    #[test]
    fn results_come_in_order_whatever_finishes_first() {
        let slow_first = |item: usize| {
            std::thread::sleep(std::time::Duration::from_millis([4, 0, 0, 0][item % 4]));
            item * 2
        };
        let mut seen = Vec::new();
        in_order(
            33,
            4,
            || slow_first,
            |item, result| {
                assert_eq!(result, item * 2);
                seen.push(item);
                Ok::<(), ()>(())
            },
        )
        .unwrap();
        assert_eq!(seen, (0..33).collect::<Vec<_>>());
    }

    #[test]
    fn a_slow_item_does_not_let_the_results_of_all_later_ones_pile_up() {
        use std::sync::atomic::{AtomicUsize, Ordering};
        let (begun, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let work = |item: usize| {
            let ahead = begun.fetch_add(1, Ordering::Relaxed);
            if item == 0 {
                std::thread::sleep(std::time::Duration::from_millis(100));
                most.store(begun.load(Ordering::Relaxed), Ordering::Relaxed);
            }
            ahead
        };
        in_order(10_000, 2, || work, |_, _| Ok::<(), ()>(())).unwrap();
        assert_eq!(begun.into_inner(), 10_000);
        assert!(most.load(Ordering::Relaxed) <= 2 * super::AHEAD + 3, "{most:?}");
    }

    #[test]
    #[should_panic(expected = "a scoped thread panicked")]
    fn a_job_that_panics_ends_in_a_panic_and_not_in_waiting() {
        let work = |item: usize| assert!(item != 5);
        let _ = in_order(10_000, 3, || work, |_, ()| Ok::<(), ()>(()));
    }

    #[test]
    fn a_sink_that_fails_ends_the_work() {
        let begun = std::sync::atomic::AtomicUsize::new(0);
        let count = |_| begun.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let failed = in_order(1_000_000, 2, || count, |item, _| if item < 3 { Ok(()) } else { Err("full") });
        assert_eq!(failed, Err("full"));
        assert!(begun.into_inner() < 1_000_000);
    }
}
