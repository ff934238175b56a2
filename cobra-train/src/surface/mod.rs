//! The object's surface: where it comes from and how points on it are drawn.

mod mesh;
mod raycast;

pub use mesh::{BoundingSphere, Mesh, MeshError};
pub use raycast::{Hit, RayCaster};
