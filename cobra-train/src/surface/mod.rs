//! The object's surface: where it comes from and how points on it are drawn.

mod content;
mod diameter;
mod mesh;
mod obj;
mod ply;
mod raycast;
mod read;
mod stl;

pub use content::Place;
pub use mesh::{BoundingSphere, Mesh, MeshError};
pub use raycast::{Hit, RayCaster};
pub use read::{ReadMeshError, read_mesh};
