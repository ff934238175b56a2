//! Poses on the host: simulated errors, and how large an error is.
//!
//! Owns what needs the truth. What judges a pose without it is `cobra-infer`.

mod error;
mod model_points;
mod nearest;
mod pnp;
mod simulate;
mod single;

pub use error::{RIGHT, add, add_s, mspd, mssd};
pub use model_points::ModelPoints;
pub use nearest::nearest_pose;
pub use pnp::{solve_pnp, solve_pnp_in_space};
pub use simulate::{ObservationNoise, disturb, observe};
pub use single::single_pose;
