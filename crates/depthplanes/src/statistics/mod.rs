//! Running sums, least squares, and plane records from labelled pixels.

mod covariance;
mod distances;
pub mod least_squares;
mod parts;
mod plane_statistics;
mod plane_sums;
pub(crate) mod quadratic;

pub use distances::Seen;
pub use plane_statistics::PlaneStatistics;
pub use plane_sums::PlaneSums;
