//! The points that a template is trained and tested on.
//!
//! Owns which of the ways to draw points is used for which of them, and nothing of how it is done:
//! that is `surface`'s work. All points are in the unit sphere.

use super::membership::{Patch, patches};
use super::{ReferencePoints, TrainError, TrainOptions};
use crate::random::Purpose;
use crate::reference::Cluster;
use crate::surface::{
    BoundingSphere, Geometry, Mesh, PointCloud, RayCaster, SplitCloud, SurfacePoint,
    sample_from_within, sample_poisson, sample_visible, thin, with_estimated_normals,
};
use nalgebra::Point3;

/// How many points cameras draw for each that charts are placed on, which are those that lie evenly:
/// of a deep cavity cameras see little, and a chart can be verified only where points are.
const SPREAD: usize = 4;

/// How training points are drawn on faces. Test points are always what cameras see: that is what
/// will be scored. A point cloud is not drawn on: its own points are split.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SurfaceSampling {
    /// First hits of rays from cameras around the object, as the paper. The only one that a point
    /// cloud can be trained with.
    #[default]
    Cameras,
    /// Poisson-disk points: evenly spread on all faces, also on those that no camera sees.
    Poisson,
    /// First hits of evenly spread rays from each reference point; these are placed on points that
    /// cameras see.
    ReferencePoints,
}

impl SurfaceSampling {
    /// Its name on the command line and in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cameras => "cameras",
            Self::Poisson => "poisson",
            Self::ReferencePoints => "reference-points",
        }
    }
}

/// An object that points can be drawn on, in the unit sphere.
pub(super) enum Surface {
    Faces(Box<Faces>),
    Points(PointCloud),
}

pub(super) struct Faces {
    mesh: Mesh,
    caster: RayCaster,
}

pub(super) struct Drawn {
    /// What reference points are placed on.
    pub(super) training: Vec<SurfacePoint>,
    /// Points that cameras see, like those that it will be asked about, and none of `training`; none
    /// where there are no more than these.
    pub(super) others: Vec<SurfacePoint>,
    /// What σ̂ is measured on.
    pub(super) test: Vec<Point3<f64>>,
}

impl Surface {
    pub(super) fn new(
        object: &Geometry,
        sphere: &BoundingSphere,
        sampling: SurfaceSampling,
    ) -> Result<Self, TrainError> {
        match object {
            Geometry::Mesh(mesh) => {
                let mesh = mesh.normalised(sphere).rounded();
                let caster = RayCaster::new(&mesh);
                Ok(Self::Faces(Box::new(Faces { mesh, caster })))
            }
            Geometry::Cloud(cloud) if sampling == SurfaceSampling::Cameras => {
                Ok(Self::Points(cloud.normalised(sphere)))
            }
            Geometry::Cloud(_) => Err(TrainError::NeedsFaces { sampling }),
        }
    }

    /// Training and test points, before there are reference points.
    pub(super) fn draw(&self, options: &TrainOptions) -> Result<Drawn, TrainError> {
        let (points, test_points) = (options.points, options.test_points);
        let Faces { mesh, caster } = match self {
            Self::Faces(faces) => &**faces,
            Self::Points(cloud) => {
                let SplitCloud { training, test } = cloud.split(points, test_points, options.seed);
                let training = with_estimated_normals(&training);
                return Ok(Drawn {
                    training,
                    others: Vec::new(),
                    test,
                });
            }
        };
        let spread = matches!(options.reference_points, ReferencePoints::Auto { .. });
        let drawn = if spread { SPREAD * points } else { points };
        let count = drawn + test_points;
        let mut training = sample_visible(mesh, caster, count, options.seed, Purpose::Training)?;
        let test = training.split_off(drawn);
        let test = test.into_iter().map(|point| point.position).collect();
        let mut others = Vec::new();
        if spread {
            (training, others) = thin(training, points);
        }
        if options.sampling == SurfaceSampling::Poisson {
            training = with_estimated_normals(&sample_poisson(mesh, points, options.seed));
        }
        Ok(Drawn {
            training,
            others,
            test,
        })
    }

    /// The training points and whose they are, once there are reference points: as they are unless
    /// they are to be seen from these.
    pub(super) fn redraw(
        &self,
        drawn: Vec<SurfacePoint>,
        placed: Vec<Patch>,
        options: &TrainOptions,
    ) -> Result<(Vec<SurfacePoint>, Vec<Patch>), TrainError> {
        match (self, options.sampling) {
            (Self::Faces(faces), SurfaceSampling::ReferencePoints) => {
                let clusters: Vec<Cluster> = placed.iter().map(|patch| patch.cluster).collect();
                let centres: Vec<_> = clusters.iter().map(Cluster::centre).collect();
                let points =
                    sample_from_within(&faces.caster, &centres, options.points, options.seed)?;
                let placed = patches(&points, &clusters, options.overlap);
                Ok((with_estimated_normals(&points), placed))
            }
            _ => Ok((drawn, placed)),
        }
    }
}
