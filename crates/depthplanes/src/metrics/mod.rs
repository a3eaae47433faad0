//! A label image against the truth: SegComp, EVOPS, and the partition measures of the PlaneNet
//! family; against a truth of some surfaces only ([`partial`]); planes' equations against known ones; and label images of
//! a sequence of frames against each other ([`Sequence`]).
//!
//! In: two label images of one size, 0 = no plane. They become one [`Contingency`] table, which
//! every measure reads. Labels are names only: which number a plane has changes nothing, and the
//! numbers of the two images need not correspond.
//!
//! ```
//! use depthplanes::metrics::{Contingency, Tolerance, evops, partition, segcomp};
//! let truth      = [1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 0, 0];
//! let prediction = [7, 7, 7, 7, 7, 3, 3, 4, 4, 4, 4, 0];
//! let table = Contingency::new(&truth, &prediction)?;
//! let found = segcomp(&table, Tolerance::default());
//! assert_eq!((found.correct.len(), found.missed, found.noise), (1, vec![2], vec![3, 4]));
//! assert_eq!(evops(&table).precision, 1.0 / 3.0);
//! assert!(partition(&table).unwrap().rand_index > 0.8);
//! # Ok::<(), depthplanes::Error>(())
//! ```
//!
//! `docs/metrics.md` has the formulas on one page.

mod contingency;
mod equations;
mod evops;
mod identity;
mod partial;
mod partition;
mod segcomp;
mod sequence;

pub use contingency::{Contingency, Match, Overlap, Region};
pub use equations::{PlaneError, adjacent, angle_errors, plane_error, plane_errors};
pub use evops::{Evops, IOU_FULL, IOU_PART, evops};
pub use identity::{Identity, IdentityFrame};
pub use partial::{Fate, NOT_PLANAR, Partial, Surface, SurfaceCounts, UNLABELLED, partial};
pub use partition::{Partition, partition};
pub use segcomp::{SegComp, Split, Tolerance, segcomp};
pub use sequence::{NextFrame, STEADY_PIXELS, Sequence, next_frame};
