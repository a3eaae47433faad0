//! How fast frames pass: frames a second, and the latency from when a frame has come to when its results are written.

use std::time::{Duration, Instant};

/// Bounds of the buckets of latency grow by 2 %: percentiles are known to that.
const GROWTH: f64 = 1.02;
/// The first bucket ends at so many milliseconds.
const LEAST_MS: f64 = 0.01;
/// Buckets up to half an hour.
const BUCKETS: usize = 960;

/// Counts frames and their latencies in memory that does not grow.
pub(super) struct Pace {
    start: Instant,
    buckets: Vec<u32>,
    pub(super) frames: u64,
}

impl Pace {
    pub(super) fn new() -> Self {
        Pace { start: Instant::now(), buckets: vec![0; BUCKETS], frames: 0 }
    }

    pub(super) fn add(&mut self, latency: Duration) {
        let ms = latency.as_secs_f64() * 1e3;
        let bucket = ((ms / LEAST_MS).max(1.0).ln() / GROWTH.ln()).ceil() as usize;
        self.buckets[bucket.min(BUCKETS - 1)] += 1;
        self.frames += 1;
    }

    pub(super) fn frames_per_second(&self) -> f64 {
        self.frames as f64 / self.start.elapsed().as_secs_f64().max(1e-9)
    }

    /// The latency that a share (0..=1) of the frames does not exceed, milliseconds.
    pub(super) fn percentile_ms(&self, share: f64) -> f64 {
        let wanted = (share * self.frames as f64).ceil().max(1.0) as u64;
        let mut below = 0;
        let at = self.buckets.iter().position(|&count| {
            below += u64::from(count);
            below >= wanted
        });
        LEAST_MS * GROWTH.powi(at.unwrap_or(0) as i32)
    }

    /// One line for people.
    pub(super) fn line(&self) -> String {
        let [median, p99] = [0.5, 0.99].map(|share| self.percentile_ms(share));
        format!("{:.0} frames/s, latency {median:.1} ms (99 %: {p99:.1} ms)", self.frames_per_second())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_right_to_two_percent() {
        let mut pace = Pace::new();
        (1..=1000).for_each(|ms| pace.add(Duration::from_millis(ms)));
        for (share, ms) in [(0.5, 500.0), (0.99, 990.0), (1.0, 1000.0)] {
            let found = pace.percentile_ms(share);
            assert!((1.0..=GROWTH * 1.001).contains(&(found / ms)), "{share}: {found}");
        }
        pace.add(Duration::from_secs(1_000_000));
        assert_eq!(pace.frames, 1001);
    }
}
