//! The object's surface: where it comes from and how points on it are drawn.

mod diameter;
mod mesh;

pub use mesh::{BoundingSphere, Mesh, MeshError};
