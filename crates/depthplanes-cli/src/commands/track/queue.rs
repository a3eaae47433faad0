//! A queue of a few elements between two threads.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex};

/// A bounded queue; the sender waits while it is full, or drops the oldest element.
pub(super) struct Queue<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
    most: usize,
    drops_oldest: bool,
}

struct State<T> {
    waiting: VecDeque<T>,
    is_closed: bool,
    dropped: u64,
}

impl<T> Queue<T> {
    pub(super) fn new(most: usize, drops_oldest: bool) -> Self {
        let state = Mutex::new(State { waiting: VecDeque::with_capacity(most), is_closed: false, dropped: 0 });
        Queue { state, changed: Condvar::new(), most, drops_oldest }
    }

    /// Adds an element; `false` if nobody takes any more.
    pub(super) fn send(&self, element: T) -> bool {
        let mut state = self.state.lock().expect("no thread panics while it holds the queue");
        while state.waiting.len() >= self.most && !state.is_closed {
            if self.drops_oldest {
                state.waiting.pop_front();
                state.dropped += 1;
            } else {
                state = self.changed.wait(state).expect("no thread panics while it holds the queue");
            }
        }
        if !state.is_closed {
            state.waiting.push_back(element);
            self.changed.notify_all();
        }
        !state.is_closed
    }

    /// The next element and how many were dropped so far; `None` once the queue is closed and empty.
    pub(super) fn take(&self) -> Option<(T, u64)> {
        let mut state = self.state.lock().expect("no thread panics while it holds the queue");
        loop {
            if let Some(element) = state.waiting.pop_front() {
                self.changed.notify_all();
                return Some((element, state.dropped));
            }
            if state.is_closed {
                return None;
            }
            state = self.changed.wait(state).expect("no thread panics while it holds the queue");
        }
    }

    /// Ends the queue: what is in it can still be taken.
    pub(super) fn close(&self) {
        self.state.lock().expect("no thread panics while it holds the queue").is_closed = true;
        self.changed.notify_all();
    }
}

/// Closes a queue when it goes, however its thread ends.
pub(super) struct Closing<'a, T>(pub(super) &'a Queue<T>);

impl<T> Drop for Closing<'_, T> {
    fn drop(&mut self) {
        self.0.close();
    }
}

#[cfg(test)]
mod tests {
    use super::Queue;

    #[test]
    fn a_full_queue_makes_the_sender_wait_or_drops_the_oldest() {
        let live = Queue::new(2, true);
        (1..=5).for_each(|number| assert!(live.send(number)));
        live.close();
        assert_eq!((live.take(), live.take(), live.take()), (Some((4, 3)), Some((5, 3)), None));
        let patient = Queue::new(2, false);
        let all: Vec<i32> = std::thread::scope(|scope| {
            scope.spawn(|| {
                (1..=50).for_each(|number| assert!(patient.send(number)));
                patient.close();
            });
            std::iter::from_fn(|| patient.take()).map(|(number, dropped)| number + dropped as i32).collect()
        });
        assert_eq!(all, (1..=50).collect::<Vec<_>>());
        assert!(!patient.send(1), "nobody takes any more");
    }
}
