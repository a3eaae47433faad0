//! Rays of one pixel after the other, and places of one ray after the other.
//!
//! What is the same for all pixels of a lens is looked up once: within which radius its formula never folds back, so that
//! nobody has to look, and beyond which nothing is. From pixel to pixel the derivative hardly changes, so that the
//! neighbour's solves the formula in one or two steps.

use super::distortion::{Distortion, DistortionModel, WIDEST};

/// Directions from the axis, and steps along each, in which a formula is looked at: our choice. Tangential terms change
/// over whole turns.
const DIRECTIONS: u32 = 16;
const STEPS: u32 = 256;

/// How much further than to there a formula is trusted, and how much less: what may lie between the directions, our choice.
const MARGIN: f64 = 0.03;

/// Farther out from the axis than this a formula is not looked at: a little more than 75 degrees, the widest angle of a
/// picture that is made.
const FARTHEST: f64 = 3.8;

/// How well the formula has to give back what was looked for before the last step, normalised coordinates: that step takes
/// a thousandth of it away or less, far below a 32-bit float's digits.
const CLOSE: f64 = 1e-7;

/// After so many pixels the derivative is worked out anew.
const FRESH: u32 = 16;

/// Where a formula folds back.
#[derive(Clone, Copy, Debug)]
struct Folds {
    /// Radius in the formula's own coordinates within which it does not.
    safe: f64,
    /// Largest radius of what comes out before it does.
    reach: f64,
    /// Radius of the ray nearest to the axis at which it does.
    first_ray: Option<f64>,
}

impl Folds {
    fn of(lens: &Distortion) -> Folds {
        let mut found = Folds { safe: FARTHEST, reach: 0.0, first_ray: None };
        let is_inverse = lens.model() == DistortionModel::InverseBrownConrady;
        for direction in 0..DIRECTIONS {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(direction) / f64::from(DIRECTIONS)).sin_cos();
            let at = |r: f64| [r * cos, r * sin];
            let out = |r: f64| lens.forward(at(r)).into_iter().fold(0.0, f64::hypot);
            let radius = |step: u32| FARTHEST * f64::from(step) / f64::from(STEPS);
            let Some(step) = (1..=STEPS).find(|&step| lens.folds_at(at(radius(step)))) else {
                let reach = if is_inverse { f64::INFINITY } else { out(FARTHEST) };
                found.reach = found.reach.max(reach);
                continue;
            };
            let [mut before, mut behind] = [radius(step - 1), radius(step)];
            for _ in 0..20 {
                let middle = 0.5 * (before + behind);
                *(if lens.folds_at(at(middle)) { &mut behind } else { &mut before }) = middle;
            }
            let largest = (1..step).map(|step| out(radius(step))).fold(out(before), f64::max);
            found.reach = found.reach.max(largest);
            found.safe = found.safe.min(before);
            let ray = if is_inverse { out(before) } else { before };
            found.first_ray = Some(found.first_ray.map_or(ray, |first| first.min(ray)));
        }
        Folds { safe: found.safe * (1.0 - MARGIN), reach: found.reach * (1.0 + MARGIN), ..found }
    }
}

impl Distortion {
    /// The angle from the optical axis, degrees, beyond which the formula folds back, so that pixels farther out have no
    /// ray; `None` if it does not within some 75 degrees. Of a formula that is not the same in all directions it is the smallest.
    ///
    /// ```
    /// use depthplanes::{Distortion, DistortionModel};
    /// // r (1 - 0.3 r^2) is largest at r = 1.054.
    /// let lens = Distortion::new(DistortionModel::BrownConrady, &[-0.3])?;
    /// assert!((lens.folds_beyond_deg().unwrap() - 1.054f64.atan().to_degrees()).abs() < 0.1);
    /// let lens = Distortion::new(DistortionModel::BrownConrady, &[0.1])?;
    /// assert_eq!(lens.folds_beyond_deg(), None);
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn folds_beyond_deg(&self) -> Option<f64> {
        if self.model() == DistortionModel::KannalaBrandt {
            let angle = |step: u32| FARTHEST.atan() * f64::from(step) / f64::from(STEPS);
            return (1..=STEPS).map(angle).find(|&angle| self.radius(angle)[1] <= 0.0).map(f64::to_degrees);
        }
        Folds::of(self).first_ray.map(|radius| radius.atan().to_degrees())
    }
}

/// Whether a place is no further from the axis than that.
pub(super) fn is_within([x, y]: [f64; 2], radius: f64) -> bool {
    x * x + y * y <= radius * radius
}

/// What was solved last: the goal, what gives it, and the inverse of the derivative near there.
#[derive(Clone, Copy, Debug)]
struct Solved {
    goal: [f64; 2],
    at: [f64; 2],
    inverse: [[f64; 2]; 2],
    age: u32,
}

/// A lens for one place after the other; those that follow each other should lie close together.
#[derive(Debug)]
pub(super) struct Table<'a> {
    lens: &'a Distortion,
    folds: Option<Folds>,
    last: Option<Solved>,
}

impl<'a> Table<'a> {
    pub(super) fn of(lens: &'a Distortion) -> Self {
        let folds = (lens.model() != DistortionModel::KannalaBrandt).then(|| Folds::of(lens));
        Table { lens, folds, last: None }
    }

    /// As [`Distortion::undistort`], within 75 degrees of the axis.
    pub(super) fn undistort(&mut self, at: [f64; 2]) -> Option<[f64; 2]> {
        match self.lens.model() {
            DistortionModel::KannalaBrandt => self.lens.undistort(at),
            DistortionModel::InverseBrownConrady => Some(self.lens.forward(at)).filter(|&ray| self.shows(ray, at)),
            DistortionModel::BrownConrady | DistortionModel::ModifiedBrownConrady => {
                self.solve(at, |table, ray| table.shows(ray, at))
            }
        }
    }

    /// As [`Distortion::distort`], within 75 degrees of the axis; `None` where the lens does not show the ray.
    pub(super) fn distort(&mut self, ray: [f64; 2]) -> Option<[f64; 2]> {
        match self.lens.model() {
            DistortionModel::InverseBrownConrady => self.solve(ray, |table, at| table.shows(ray, at)),
            _ => Some(self.lens.distort(ray)).filter(|&at| self.shows(ray, at)),
        }
    }

    /// As [`Distortion::shows`].
    fn shows(&self, ray: [f64; 2], distorted: [f64; 2]) -> bool {
        match &self.folds {
            Some(folds) if is_within(self.lens.place_in_formula(ray, distorted), folds.safe) => is_within(ray, WIDEST),
            _ => self.lens.shows(ray, distorted),
        }
    }

    /// What the formula turns into `goal`, of that which is accepted.
    fn solve(&mut self, goal: [f64; 2], is_right: impl Fn(&Self, [f64; 2]) -> bool) -> Option<[f64; 2]> {
        if self.folds.is_some_and(|folds| !is_within(goal, folds.reach)) {
            return None;
        }
        let near = self.last.and_then(|last| self.step(goal, last)).filter(|near| is_right(self, near.at));
        let solved = near.or_else(|| {
            let at = self.lens.newton(goal, goal).filter(|&at| is_right(self, at))?;
            Some(Solved { goal, at, inverse: [[0.0; 2]; 2], age: FRESH })
        });
        // Where nothing is found the next place begins from the last one that was.
        let mut solved = solved?;
        if solved.age >= FRESH {
            let [[a, b], [c, d]] = self.lens.slope(solved.at);
            let det = a * d - b * c;
            (solved.inverse, solved.age) = ([[d / det, -b / det], [-c / det, a / det]], 0);
        }
        self.last = Some(solved);
        Some(solved.at)
    }

    /// From the neighbour's solution, with its derivative; none if that does not lead there quickly.
    fn step(&self, goal: [f64; 2], last: Solved) -> Option<Solved> {
        let [[a, b], [c, d]] = last.inverse;
        let mut at = last.at;
        let mut off = [last.goal[0] - goal[0], last.goal[1] - goal[1]];
        for steps in 0..6 {
            at = [at[0] - a * off[0] - b * off[1], at[1] - c * off[0] - d * off[1]];
            let given = self.lens.forward(at);
            off = [given[0] - goal[0], given[1] - goal[1]];
            if off[0].abs() + off[1].abs() < CLOSE {
                at = [at[0] - a * off[0] - b * off[1], at[1] - c * off[0] - d * off[1]];
                return Some(Solved { goal, at, age: if steps > 2 { FRESH } else { last.age + 1 }, ..last });
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use DistortionModel::{BrownConrady, InverseBrownConrady, KannalaBrandt, ModifiedBrownConrady};

    /// Lenses as they occur, and some that fold within the picture, with the focal length for a map of 640 x 480.
    const LENSES: &[(DistortionModel, &[f64], f64)] = &[
        (BrownConrady, &[0.2624, -0.9531, -0.0054, 0.0026, 1.1633], 525.0),
        (BrownConrady, &[-0.05], 500.0),
        (BrownConrady, &[-0.28, 0.07, 1e-4, -2e-4, 0.0], 400.0),
        (BrownConrady, &[6.084, 4.375, -5.5e-5, 6.5e-5, 0.236, 6.409, 6.418, 1.220], 504.0),
        (BrownConrady, &[0.1, 0.01, 1e-3, -1e-3, 0.0, 0.05, 0.0, 0.0, 1e-3, 2e-3, -1e-3, 1e-4], 500.0),
        (BrownConrady, &[-0.3], 380.0),
        (BrownConrady, &[-0.4, 0.0, 0.01, -0.02], 350.0),
        (KannalaBrandt, &[-0.0132, 0.0205, -0.0213, 0.0070], 340.0),
        (KannalaBrandt, &[-0.1], 300.0),
        (InverseBrownConrady, &[-0.0565, 0.0688, -7e-4, -2.5e-5, -0.0224], 600.0),
        (InverseBrownConrady, &[-0.4], 350.0),
        (ModifiedBrownConrady, &[0.14, -0.5, 1e-3, -2e-3, 0.45], 600.0),
        (ModifiedBrownConrady, &[-0.3], 380.0),
    ];

    #[test]
    fn the_table_of_a_lens_is_that_of_its_pixels_one_by_one() {
        for &(model, coefficients, focal) in LENSES {
            let lens = Distortion::new(model, coefficients).unwrap();
            let [mut rays, mut places] = [(); 2].map(|()| Table::of(&lens));
            let (mut apart, mut there) = (0, 0);
            for at in 0..640 * 480 {
                let place = [(f64::from(at % 640) - 319.5) / focal, (f64::from(at / 640) - 239.5) / focal];
                let right = lens.undistort(place).filter(|[x, y]| x.hypot(*y) < 3.732);
                let given = rays.undistort(place).filter(|[x, y]| x.hypot(*y) < 3.732);
                match (right, given) {
                    (Some(right), Some(given)) => {
                        let off = (right[0] - given[0]).hypot(right[1] - given[1]) * focal;
                        assert!(off < 0.01, "{lens:?} at {place:?}: {off} pixels");
                        there += 1;
                    }
                    (None, None) => (),
                    _ => apart += 1,
                }
                let right = Some(lens.distort(place)).filter(|&at| !at[0].is_nan() && lens.shows(place, at));
                match (right, places.distort(place)) {
                    (Some(right), Some(given)) => {
                        let off = (right[0] - given[0]).hypot(right[1] - given[1]) * focal;
                        assert!(off < 0.01, "{lens:?} at {place:?}: {off} pixels");
                    }
                    (None, None) => (),
                    _ => apart += 1,
                }
            }
            // Newton's method from afar does not find all that is near a fold.
            println!("{model:?} {coefficients:?}: {there} rays, {apart} apart, {:?}", lens.folds_beyond_deg());
            assert!(apart < 640 * 480 / 200, "{lens:?}: {apart}");
        }
    }
}
