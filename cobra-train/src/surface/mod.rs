//! The object's surface: where it comes from and how points on it are drawn.

mod bounds;
mod camera;
mod cloud;
mod content;
mod diameter;
mod geometry;
mod gltf;
mod mesh;
mod near;
mod normals;
mod obj;
mod off;
mod ply;
mod poisson;
mod raycast;
mod read;
mod sample;
mod stl;
mod triangulate;
mod within;
mod xyz;

pub use bounds::{BoundingSphere, CoordinateError};
pub use camera::{CAMERA_DISTANCE, CAMERAS, fibonacci_sphere};
pub use cloud::{CloudError, PointCloud, SplitCloud};
pub use content::Place;
pub use geometry::Geometry;
pub use mesh::{Mesh, MeshError};
pub(crate) use near::NearestPoints;
pub use normals::with_estimated_normals;
pub use poisson::{sample_poisson, thin};
pub use raycast::{Hit, Nearest, RayCaster};
pub use read::{ReadGeometry, ReadMeshError, read_geometry, read_mesh};
pub use sample::{SampleError, SurfacePoint, sample_visible};
pub use within::sample_from_within;
