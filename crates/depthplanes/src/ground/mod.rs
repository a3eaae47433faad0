//! The ground of a robot or a person: the floor, how the camera stands above it, and what every other plane is.
//!
//! In: a map, its [`Detection`](crate::Detection), its [`Sensor`](crate::Sensor) and what is known of up. Out: a [`Ground`].
//!
//! ```
//! use depthplanes::ground::{GroundFinder, PlaneClass};
//! use depthplanes::{Detector, scene::Spec};
//! let frame = "corridor:sensor=kinect,size=320x240".parse::<Spec>()?.frame()?;
//! let mut detector = Detector::default().sensor(frame.sensor);
//! let mut finder = GroundFinder::default(); // keep it: later frames allocate nothing
//! let found = detector.detect(frame.view())?;
//! let ground = finder.find(frame.view(), found, &frame.sensor)?;
//! let floor = ground.floor.as_ref().expect("a corridor has a floor");
//! // The camera stands at 1.45 m and looks down by 5 degrees; the sensor errs, and says by how much.
//! assert!((floor.height_m - 1.45).abs() < 3.0 * floor.height_sd_m && floor.height_sd_m < 0.03);
//! assert!((floor.tilt_deg - 5.0).abs() < 3.0 * floor.tilt_sd_deg);
//! assert_eq!(ground.planes[usize::from(floor.label) - 1].class, PlaneClass::Floor);
//! assert!(ground.planes.iter().any(|plane| plane.class == PlaneClass::Ceiling));
//! # Ok::<(), depthplanes::Error>(())
//! ```
//!
//! The floor need not be the largest plane, nor in one piece. A frame without one, such as that of a wall alone, has no
//! floor; that is no error.

mod cells;
mod class;
mod finder;
mod floor;
mod grid;
pub mod marks;
mod obstacles;
mod sectors;
mod space;
mod standing;
mod steps;
mod up;

pub use class::{ClassifiedPlane, PlaneClass};
pub use finder::{Ground, GroundFinder};
pub use floor::Floor;
pub use grid::{GridMapper, Occupancy, OccupancyGrid, RESOLUTION_M};
pub use obstacles::Obstacle;
pub use sectors::Sector;
pub use steps::Step;
pub use up::Up;
