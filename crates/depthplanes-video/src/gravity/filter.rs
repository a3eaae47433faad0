//! What is up, as an accelerometer says it while it moves.
//!
//! In: readings of an accelerometer and, if there is one, a gyroscope. Out: the direction that is up in the sensor's axes.
//!
//! At rest the specific force points up. A robot that speeds up, and a hand that trembles, turn it by many degrees for a
//! moment, so that it is averaged. The gyroscope turns the average along with the sensor (a complementary filter, as
//! Mahony et al. 2008 for one direction, without their estimate of the bias), so that it can be long; without one it lags
//! behind a sensor that turns, and has to be short.

use crate::messages::Imu;

/// Standard gravity, m/s2 (CGPM 1901).
const GRAVITY: f64 = 9.806_65;
/// m/s2 by which the length of a reading may differ from gravity: that of places on Earth does by 0.04, and an accelerometer that
/// nobody calibrated by 50 mg. A sensor that accelerates along gravity by more, or across it by a third of gravity, is not
/// averaged.
const TOLERANCE: f64 = 0.5;
/// Angular velocity, rad/s, above which there is no gyroscope: small ones measure up to 70.
const FASTEST: f64 = 100.0;
/// Seconds of the average with a gyroscope. One that nobody calibrated drifts by 1 degree a second, thus 2 degrees in that time;
/// a floor may lean by 10 against up.
const WITH_GYROSCOPE_S: f64 = 2.0;
/// Seconds of the average without: it is 5 degrees behind a sensor that turns by 20 degrees a second, and makes of a hand's
/// tremor (8 Hz, 20 degrees) less than 2 degrees.
const ALONE_S: f64 = 0.25;
/// Seconds in which nothing is gravity before that is said: one bump is shorter.
const PATIENCE_S: f64 = 1.0;

/// The direction that is up, from one reading to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Filter {
    /// The average, m/s2, in the sensor's axes now.
    mean: [f64; 3],
    /// Readings in it.
    count: f64,
    /// When the latest reading came, and the latest that was averaged; seconds.
    read_s: Option<f64>,
    averaged_s: Option<f64>,
    /// Seconds of the average, and for which it holds without a further reading.
    window_s: f64,
    /// When the first reading came, and its length, as long as none was gravity.
    odd: Option<(f64, f64)>,
}

impl Filter {
    /// Takes the next reading. Readings come by their time; where they do not, or where they paused, it begins anew.
    pub(super) fn add(&mut self, time_s: f64, reading: &Imu) {
        let step_s = self.read_s.map_or(0.0, |before| time_s - before);
        if step_s < 0.0 || step_s > self.window_s {
            *self = Filter { odd: self.odd, ..Filter::default() };
        }
        self.read_s = Some(time_s);
        let turn_rate = reading.turn_rate.filter(|rate| dot(*rate, *rate) <= FASTEST * FASTEST);
        self.window_s = if turn_rate.is_some() { WITH_GYROSCOPE_S } else { ALONE_S };
        if let Some(rate) = turn_rate {
            self.mean = turned(self.mean, rate.map(|rate| rate * step_s));
        }
        if let Some(force) = reading.acceleration {
            self.average(time_s, force);
        }
    }

    fn average(&mut self, time_s: f64, force: [f64; 3]) {
        let length = dot(force, force).sqrt();
        if (length - GRAVITY).abs() > TOLERANCE {
            if self.averaged_s.is_none() {
                self.odd.get_or_insert((time_s, length));
            }
            return;
        }
        let since_s = self.averaged_s.map_or(0.0, |before| time_s - before);
        self.odd = None;
        self.averaged_s = Some(time_s);
        self.count += 1.0;
        // The plain mean until it is as long as the window, and a low-pass of first order from there on.
        let weight = self.count.recip().max(1.0 - (-since_s / self.window_s).exp());
        self.mean = std::array::from_fn(|k| self.mean[k] + weight * (force[k] - self.mean[k]));
    }

    /// Up at that time, not of length 1, in the sensor's axes; none where no reading is recent enough.
    pub(super) fn up(&self, time_s: f64) -> Option<[f64; 3]> {
        let age_s = time_s - self.averaged_s?;
        (age_s <= self.window_s).then_some(self.mean)
    }

    /// The length of the first reading, m/s2, where for a while none was gravity.
    pub(super) fn odd(&self) -> Option<f64> {
        let (since_s, length) = self.odd?;
        (self.read_s? - since_s >= PATIENCE_S).then_some(length)
    }
}

/// A direction that stays in the world, in the axes of a sensor that turned by a small vector (axis times angle, radians).
fn turned(v: [f64; 3], by: [f64; 3]) -> [f64; 3] {
    let angle = dot(by, by).sqrt();
    if angle == 0.0 {
        return v;
    }
    // Rodrigues' formula, the other way round.
    let axis = by.map(|x| x / angle);
    let (sine, cosine) = angle.sin_cos();
    let along = (1.0 - cosine) * dot(axis, v);
    let crossed = [axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2], axis[0] * v[1] - axis[1] * v[0]];
    std::array::from_fn(|k| cosine * v[k] - sine * crossed[k] + along * axis[k])
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Degrees between two directions.
    fn degrees(a: [f64; 3], b: [f64; 3]) -> f64 {
        (dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()).clamp(-1.0, 1.0).acos().to_degrees()
    }

    /// What a sensor measures that pitches by the sine of its time, with an acceleration of the world's x axis; 200 Hz.
    fn run(seconds: f64, pitch: impl Fn(f64) -> f64, push: impl Fn(f64) -> f64, has_gyroscope: bool) -> (Filter, f64) {
        let mut filter = Filter::default();
        let step = 1.0 / 200.0;
        let mut worst: f64 = 0.0;
        for index in 0..(seconds / step) as usize {
            let time = index as f64 * step;
            let [angle, before] = [pitch(time), pitch(time - step)];
            // Pitch turns about x: what is up (0, 1, 0) in the world is (0, cos, -sin) for the sensor.
            let up = [0.0, angle.cos(), -angle.sin()];
            let push = [0.0, push(time) * angle.sin(), push(time) * angle.cos()];
            let acceleration = Some(std::array::from_fn(|k| GRAVITY * up[k] + push[k]));
            let turn_rate = has_gyroscope.then_some([(angle - before) / step + 1e-9, 0.0, 0.0]);
            filter.add(time, &Imu { acceleration, turn_rate });
            worst = worst.max(degrees(filter.up(time).unwrap_or(up), up));
        }
        (filter, worst)
    }

    #[test]
    fn a_sensor_at_rest_says_what_is_up() {
        let (filter, worst) = run(1.0, |_| 0.3, |_| 0.0, false);
        assert!(worst < 1e-6, "{worst}");
        assert_eq!(filter.odd(), None);
        // What it said holds for as long as its average.
        let last = 1.0 - 1.0 / 200.0;
        assert!(filter.up(last + 0.2).is_some() && filter.up(last + 0.3).is_none());
    }

    #[test]
    fn a_gyroscope_keeps_it_exact_while_the_sensor_turns() {
        let swing = |time: f64| 0.5 * (3.0 * time).sin();
        let (_, with) = run(10.0, swing, |_| 0.0, true);
        let (_, without) = run(10.0, swing, |_| 0.0, false);
        // 0.5 rad at 3 rad/s turn by 86 degrees a second at most, which the short average is behind by.
        assert!(with < 0.01 && (10.0..25.0).contains(&without), "{with} {without}");
    }

    #[test]
    fn a_push_turns_it_little() {
        // A robot that speeds up by 1 m/s2 for half a second: a single reading is off by 5.8 degrees.
        let push = |time: f64| if (4.0..4.5).contains(&time) { 1.0 } else { 0.0 };
        let (_, worst) = run(6.0, |_| 0.2, push, true);
        assert!((0.5..1.5).contains(&worst), "{worst}");
        // A tremor of 8 Hz by 20 degrees.
        let (_, worst) = run(6.0, |_| 0.2, |time| 3.5 * (50.0 * time).sin(), false);
        assert!(worst < 20.0, "{worst}");
    }

    #[test]
    fn what_is_not_gravity_is_left_out_and_said_after_a_while() {
        // In units of gravity instead of m/s2.
        let mut filter = Filter::default();
        for index in 0..300 {
            let time = f64::from(index) / 200.0;
            filter.add(time, &Imu { acceleration: Some([0.0, 1.0, 0.0]), turn_rate: None });
            assert_eq!(filter.odd(), (index >= 200).then_some(1.0), "{index}");
        }
        assert_eq!(filter.up(1.5), None);
        // One reading that is gravity ends that.
        filter.add(1.5, &Imu { acceleration: Some([0.0, 9.8, 0.0]), turn_rate: None });
        assert_eq!((filter.odd(), filter.up(1.5)), (None, Some([0.0, 9.8, 0.0])));
        // Numbers that no sensor measures change nothing.
        let mad = Imu { acceleration: Some([1e300; 3]), turn_rate: Some([1e300, 0.0, 0.0]) };
        filter.add(1.51, &mad);
        assert_eq!(filter.up(1.51), Some([0.0, 9.8, 0.0]));
        // It begins anew where time goes back.
        filter.add(0.5, &Imu { acceleration: Some([9.8, 0.0, 0.0]), turn_rate: None });
        assert_eq!(filter.up(0.5), Some([9.8, 0.0, 0.0]));
    }
}
