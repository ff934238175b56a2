//! The depth check on the host.
//!
//! Owns what a host adds to [`cobra_infer::depth`], whose scoring it calls: the exact mesh as a surface, to
//! measure what a template loses, and points of a surface kept for many checks.

mod mesh;
mod sampled;

pub use mesh::MeshSurface;
pub use sampled::SampledSurface;
