//! The object's surface: where it comes from and how points on it are drawn.

mod camera;
mod content;
mod diameter;
mod mesh;
mod obj;
mod ply;
mod poisson;
mod raycast;
mod read;
mod sample;
mod stl;
mod within;

pub use camera::{CAMERA_DISTANCE, CAMERAS, fibonacci_sphere};
pub use content::Place;
pub use mesh::{BoundingSphere, Mesh, MeshError};
pub use poisson::sample_poisson;
pub use raycast::{Hit, RayCaster};
pub use read::{ReadMeshError, read_mesh};
pub use sample::{SampleError, SurfacePoint, sample_visible};
pub use within::sample_from_within;
