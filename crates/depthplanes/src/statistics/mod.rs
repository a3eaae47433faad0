//! Running sums, least squares, and from labelled pixels to plane records.

mod covariance;
mod describer;
mod distances;
pub mod least_squares;
mod parts;
pub(crate) mod quadratic;
mod tally;

pub use describer::Describer;
pub use distances::Seen;
pub use tally::Tally;
