//! The depth check on the host.
//!
//! Owns what a host adds to [`cobra_infer::depth`], whose scoring it calls: the exact mesh as a surface, to
//! measure what a template loses.

mod mesh;

pub use mesh::MeshSurface;
