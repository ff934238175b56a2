//! Where the reference points lie.
//!
//! Owns their placement and the assignment of points to them; fitting is `gp`'s work.

mod charts;
mod cluster;
mod em;
mod given;
mod kmeans;
mod membership;
mod select;

pub use charts::{Aim, Chart, charts, split};
pub use cluster::{Cluster, NotAPrecision};
pub use em::{COVARIANCE_FLOOR, GaussianMixture, em};
pub use given::{ReadReferencePointsError, read_reference_points};
pub use kmeans::{ClusterError, kmeans};
pub use membership::{assign, members};
pub use select::most_explanatory;
