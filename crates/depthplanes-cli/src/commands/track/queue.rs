//! Queues of a few elements between threads: one whose elements wait in turn, and one that puts them in turn again.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Condvar, Mutex, MutexGuard};
use std::time::Duration;

/// No thread panics while it holds a queue.
const WHOLE: &str = "no thread panics while it holds the queue";

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
    taken: u64,
}

/// An element of a queue.
#[derive(Debug, PartialEq)]
pub(super) struct Taken<T> {
    pub(super) element: T,
    /// How many were taken before.
    pub(super) turn: u64,
    /// How many were dropped before.
    pub(super) dropped: u64,
}

impl<T> Queue<T> {
    pub(super) fn new(most: usize, drops_oldest: bool) -> Self {
        let state = State { waiting: VecDeque::with_capacity(most), is_closed: false, dropped: 0, taken: 0 };
        Queue { state: Mutex::new(state), changed: Condvar::new(), most, drops_oldest }
    }

    /// Adds an element; `false` if nobody takes any more.
    pub(super) fn send(&self, element: T) -> bool {
        let mut state = self.lock();
        while state.waiting.len() >= self.most && !state.is_closed {
            if self.drops_oldest {
                state.waiting.pop_front();
                state.dropped += 1;
            } else {
                state = self.changed.wait(state).expect(WHOLE);
            }
        }
        if !state.is_closed {
            state.waiting.push_back(element);
            self.changed.notify_all();
        }
        !state.is_closed
    }

    /// The next element; `None` once the queue is closed and empty.
    pub(super) fn take(&self) -> Option<Taken<T>> {
        let open = |state: &mut State<T>| state.waiting.is_empty() && !state.is_closed;
        let mut state = self.changed.wait_while(self.lock(), open).expect(WHOLE);
        let element = state.waiting.pop_front()?;
        let turn = state.taken;
        state.taken += 1;
        self.changed.notify_all();
        Some(Taken { element, turn, dropped: state.dropped })
    }

    /// Ends the queue: what is in it can still be taken.
    pub(super) fn close(&self) {
        self.lock().is_closed = true;
        self.changed.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().expect(WHOLE)
    }
}

/// A bounded queue into which several threads send, each element with its turn, and out of which one takes them in turn.
pub(super) struct InTurn<T> {
    state: Mutex<Early<T>>,
    changed: Condvar,
    ahead: u64,
}

struct Early<T> {
    early: BTreeMap<u64, T>,
    next: u64,
    senders: usize,
    is_closed: bool,
}

/// What came within the time that was given.
#[derive(Debug, PartialEq)]
pub(super) enum Came<T> {
    Element(T),
    Nothing,
    End,
}

impl<T> InTurn<T> {
    /// A queue for so many threads; none runs further than `ahead` elements before the one that is next.
    pub(super) fn new(senders: usize, ahead: u64) -> Self {
        let state = Early { early: BTreeMap::new(), next: 0, senders, is_closed: false };
        InTurn { state: Mutex::new(state), changed: Condvar::new(), ahead }
    }

    /// Adds the element of a turn; `false` if nobody takes any more. The one that is next never waits.
    pub(super) fn send(&self, turn: u64, element: T) -> bool {
        let far = |state: &mut Early<T>| turn > state.next + self.ahead && !state.is_closed;
        let mut state = self.changed.wait_while(self.lock(), far).expect(WHOLE);
        if !state.is_closed {
            state.early.insert(turn, element);
            self.changed.notify_all();
        }
        !state.is_closed
    }

    /// The next element, if it comes within that time; the end once all senders have gone.
    pub(super) fn take_within(&self, time: Duration) -> Came<T> {
        let absent = |state: &mut Early<T>| !state.early.contains_key(&state.next) && state.senders > 0;
        let (mut state, _) = self.changed.wait_timeout_while(self.lock(), time, absent).expect(WHOLE);
        let next = state.next;
        match state.early.remove(&next) {
            Some(element) => {
                state.next += 1;
                self.changed.notify_all();
                Came::Element(element)
            }
            None if state.senders > 0 => Came::Nothing,
            None => Came::End,
        }
    }

    fn lock(&self) -> MutexGuard<'_, Early<T>> {
        self.state.lock().expect(WHOLE)
    }
}

/// An end of a queue.
pub(super) trait End {
    /// Tells the other end that nothing more comes from here, or is taken.
    fn end(&self);
}

/// Either end of a queue.
impl<T> End for Queue<T> {
    fn end(&self) {
        self.close();
    }
}

/// One of the senders.
impl<T> End for InTurn<T> {
    fn end(&self) {
        self.lock().senders -= 1;
        self.changed.notify_all();
    }
}

/// The end from which elements are taken.
pub(super) struct Taking<'a, T>(pub(super) &'a InTurn<T>);

impl<T> End for Taking<'_, T> {
    fn end(&self) {
        self.0.lock().is_closed = true;
        self.0.changed.notify_all();
    }
}

/// Ends its end of a queue when it goes, however its thread ends.
pub(super) struct Closing<'a, E: End>(pub(super) &'a E);

impl<E: End> Drop for Closing<'_, E> {
    fn drop(&mut self) {
        self.0.end();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_queue_makes_the_sender_wait_or_drops_the_oldest() {
        let live = Queue::new(2, true);
        (1..=5).for_each(|number| assert!(live.send(number)));
        live.close();
        let taken = |element, turn| Some(Taken { element, turn, dropped: 3 });
        assert_eq!((live.take(), live.take(), live.take()), (taken(4, 0), taken(5, 1), None));
        let patient = Queue::new(2, false);
        let all: Vec<i32> = std::thread::scope(|scope| {
            scope.spawn(|| {
                (1..=50).for_each(|number| assert!(patient.send(number)));
                patient.close();
            });
            std::iter::from_fn(|| patient.take()).map(|taken| taken.element + taken.dropped as i32).collect()
        });
        assert_eq!(all, (1..=50).collect::<Vec<_>>());
        assert!(!patient.send(1), "nobody takes any more");
    }

    #[test]
    fn what_several_threads_send_comes_in_turn() {
        const LONG: Duration = Duration::from_secs(60);
        let (numbers, done) = (Queue::new(2, false), InTurn::new(3, 4));
        let all: Vec<u64> = std::thread::scope(|scope| {
            scope.spawn(|| {
                let _closing = Closing(&numbers);
                (0..100u64).for_each(|number| assert!(numbers.send(number)));
            });
            for _ in 0..3 {
                scope.spawn(|| {
                    let _closing = Closing(&done);
                    while let Some(Taken { element, turn, .. }) = numbers.take() {
                        std::thread::sleep(Duration::from_micros(element % 3 * 300));
                        assert!(done.send(turn, element));
                    }
                });
            }
            let next = || match done.take_within(LONG) {
                Came::Element(element) => Some(element),
                Came::Nothing | Came::End => None,
            };
            std::iter::from_fn(next).collect()
        });
        assert_eq!(all, (0..100).collect::<Vec<_>>());
        assert_eq!(done.take_within(LONG), Came::End);
    }

    #[test]
    fn an_end_that_goes_is_told_to_the_other() {
        let done = InTurn::new(1, 0);
        assert_eq!(done.take_within(Duration::ZERO), Came::Nothing);
        drop(Closing(&Taking(&done)));
        assert!(!done.send(5, ()), "nobody takes any more, and nobody waits for turn 5");
        drop(Closing(&done));
        assert_eq!(done.take_within(Duration::from_secs(60)), Came::End);
    }
}
