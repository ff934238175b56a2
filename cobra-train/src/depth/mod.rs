//! The depth check on the host.
//!
//! Owns what a host adds to [`cobra_infer::depth`], whose scoring it calls: the exact mesh as a surface, to
//! measure what a template loses, points of a surface kept for many checks, and the residuals of a pose one by
//! one, to look at.

mod mesh;
mod pixels;
mod residual;
mod sampled;
mod template;

pub use mesh::MeshSurface;
pub use pixels::{observed, spread, valid_pixels};
pub use residual::ResidualMap;
pub use sampled::SampledSurface;
pub use template::template_surface;
