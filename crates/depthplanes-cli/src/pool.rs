//! Work on many inputs at once with results in the order of the inputs.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

/// Works on items `0..count` on up to `jobs` threads; each thread makes its own worker. `sink` gets
/// the results in order, on the calling thread, as early as the order allows.
///
/// # Errors
/// The first error of `sink`; no item is begun after it.
pub(crate) fn in_order<R: Send, W: FnMut(usize) -> R, E>(
    count: usize,
    jobs: usize,
    worker: impl Fn() -> W + Sync,
    mut sink: impl FnMut(usize, R) -> Result<(), E>,
) -> Result<(), E> {
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..jobs.min(count) {
            let (sender, next, worker) = (sender.clone(), &next, &worker);
            scope.spawn(move || {
                let mut work = worker();
                loop {
                    let item = next.fetch_add(1, Ordering::Relaxed);
                    if item >= count || sender.send((item, work(item))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let outcome = deliver(receiver, &mut sink);
        next.store(count, Ordering::Relaxed);
        outcome
    })
}

fn deliver<R, E>(
    receiver: mpsc::Receiver<(usize, R)>,
    sink: &mut impl FnMut(usize, R) -> Result<(), E>,
) -> Result<(), E> {
    let mut early = BTreeMap::new();
    let mut due = 0;
    for (item, result) in receiver {
        early.insert(item, result);
        while let Some(result) = early.remove(&due) {
            sink(due, result)?;
            due += 1;
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
    fn a_sink_that_fails_ends_the_work() {
        let begun = std::sync::atomic::AtomicUsize::new(0);
        let count = |_| begun.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let failed = in_order(1_000_000, 2, || count, |item, _| if item < 3 { Ok(()) } else { Err("full") });
        assert_eq!(failed, Err("full"));
        assert!(begun.into_inner() < 1_000_000);
    }
}
