//! Simulated estimates with everything that could tell right from wrong.

use super::bench::Bench;
use super::error::ExperimentError;
use super::estimates::{Estimate, Protocol, camera, simulate_estimates};
use super::subject::Subject;
use super::templates::template;
use crate::pose::single_pose;
use crate::random::Purpose;
use crate::surface::RayCaster;
use crate::train::LARGEST_TEMPLATE;
use cobra_infer::template::DecodedTerm;
use cobra_infer::{Settings, Sigma, Template, score};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Surface points that the observed ones are the first of, and that ADD is taken over.
const SURFACE_POINTS: usize = 2000;

/// The measurement's standard deviation σ_m: 1 % of the largest diameter in the unit sphere. A pixel is
/// 0.006 to 0.009 radii there.
pub(super) const NOISE: f64 = 0.02;

/// A reprojection error below so many pixels makes a correspondence an inlier of the estimate.
pub(super) const INLIER: f64 = 5.0;

/// What counts as the reprojection error of a point behind the camera: the image's diagonal, in pixels.
const BEHIND: f64 = 800.0;

/// An estimate, and everything that could tell whether it is right.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Judged {
    pub(super) outliers: f64,
    pub(super) outlier_noise: f64,
    /// ADD, in radii.
    pub(super) add: f64,
    /// The template's.
    pub(super) confidence: f64,
    /// The same with the exact distance to the mesh in place of the template's residual.
    pub(super) oracle: f64,
    /// The share of correspondences that the pose explains to within [`INLIER`] pixels.
    pub(super) inliers: f64,
    /// The mean reprojection error, in pixels.
    pub(super) reprojection: f64,
}

/// The object's estimates, judged by its template under this project's defaults.
pub(super) fn judge_all(
    bench: &Bench<'_>,
    subject: &Subject,
    protocol: &Protocol,
) -> Result<Vec<Judged>, ExperimentError> {
    of_estimates(bench, subject, protocol, judge)
}

/// What `compute` makes of each of the object's estimates.
pub(super) fn of_estimates<R: Send>(
    bench: &Bench<'_>,
    subject: &Subject,
    protocol: &Protocol,
    compute: impl Fn(&Template<'_>, &RayCaster, &Estimate) -> Result<R, ExperimentError> + Sync,
) -> Result<Vec<R>, ExperimentError> {
    let mesh = subject.mesh()?;
    let bytes = template(bench, subject, &mesh)?;
    let template = Template::from_bytes(&bytes)?;
    let mut room = vec![DecodedTerm::default(); template.decoded_len()];
    let template = template.decoded(&mut room).unwrap_or(template);
    let caster = RayCaster::new(&mesh);
    let purpose = Purpose::Evaluation;
    let surface = subject.sample(&mesh, &caster, SURFACE_POINTS, bench.seed, purpose)?;
    simulate_estimates(&surface, protocol, bench.seed)
        .par_iter()
        .map(|estimate| compute(&template, &caster, estimate))
        .collect()
}

/// How the template is asked: as by default, with [`NOISE`] for the measurement's.
pub(super) fn settings(template: &Template<'_>) -> Settings {
    Settings {
        delta: NOISE as f32,
        sigma: Sigma::Template {
            noise: NOISE as f32,
        },
        ..Settings::for_template(template, 1.0)
    }
}

fn judge(
    template: &Template<'_>,
    caster: &RayCaster,
    estimate: &Estimate,
) -> Result<Judged, ExperimentError> {
    let (camera, pose) = (camera(), single_pose(&estimate.pose)?);
    let seen = &estimate.correspondences;
    let report = score::<LARGEST_TEMPLATE>(template, &camera, &pose, &settings(template), seen)?;
    let (mut oracle, mut inliers, mut reprojection) = (0.0, 0.0, 0.0);
    for correspondence in seen {
        let found = camera.back_project(&pose, &correspondence.pixel, &correspondence.point);
        let distance = caster.distance(&found.point.cast());
        if found.depth > 0.0 && distance.is_finite() {
            oracle += (-0.5 * (distance / NOISE).powi(2)).exp();
        }
        let again = camera.project(&pose.to_camera(&correspondence.point));
        let error = again.map_or(BEHIND, |pixel| {
            f64::from((pixel - correspondence.pixel).norm())
        });
        inliers += f64::from(u8::from(error < INLIER));
        reprojection += error;
    }
    let count = seen.len() as f64;
    Ok(Judged {
        outliers: estimate.outliers,
        outlier_noise: estimate.outlier_noise,
        add: estimate.add,
        confidence: f64::from(report.confidence),
        oracle: oracle / count,
        inliers: inliers / count,
        reprojection: reprojection / count,
    })
}
