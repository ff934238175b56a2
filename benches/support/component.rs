//! What one Gaussian process is fitted to, for everybody who fits one.

use super::{Object, Size};
use cobra_train::random::Purpose;
use cobra_train::reference::{Cluster, kmeans, members, most_explanatory};
use cobra_train::surface::{RayCaster, sample_visible};
use cobra_train::train::PLACEMENTS;
use nalgebra::Point3;

/// The seed of all randomness, that of training.
const SEED: u64 = 0;

/// A reference point and the points around it, in the unit sphere.
pub(crate) struct Component {
    /// The reference point.
    pub(crate) centre: Point3<f64>,
    /// Its points.
    pub(crate) points: Vec<Point3<f64>>,
}

impl Component {
    /// The points of each of `clusters`.
    pub(crate) fn of(clusters: &[Cluster], points: &[Point3<f64>]) -> Vec<Self> {
        let centres = clusters.iter().map(Cluster::centre);
        centres
            .zip(members(points, clusters))
            .map(|(centre, points)| Self { centre, points })
            .collect()
    }

    /// Direction and distance of each point from the reference point (Eq. 1); no point of a surface
    /// lies on the mean of many.
    pub(crate) fn directions_and_distances(&self) -> (Vec<[f64; 3]>, Vec<f64>) {
        self.points
            .iter()
            .map(|point| {
                let offset = point - self.centre;
                let distance = offset.norm();
                (<[f64; 3]>::from(offset / distance), distance)
            })
            .unzip()
    }
}

/// The points that training fits a template to, in the unit sphere.
pub(crate) fn training_points(object: &Object, size: &Size) -> Vec<Point3<f64>> {
    let unit = object.mesh.normalised(&object.mesh.bounding_sphere());
    let wanted = size.points + size.test_points;
    sample_visible(
        &unit,
        &RayCaster::new(&unit),
        wanted,
        SEED,
        Purpose::Training,
    )
    .expect("both objects show their surface")
    .iter()
    .take(size.points)
    .map(|point| point.position)
    .collect()
}

/// The k-means components that training makes of `points`.
pub(crate) fn components(points: &[Point3<f64>], size: &Size) -> Vec<Component> {
    let placements = kmeans(points, size.components, PLACEMENTS, SEED)
        .expect("there are more points than components")
        .into_iter()
        .map(|centres| centres.into_iter().map(Cluster::round).collect())
        .collect();
    let clusters =
        most_explanatory(points, placements, SEED).expect("there are several placements");
    Component::of(&clusters, points)
}
