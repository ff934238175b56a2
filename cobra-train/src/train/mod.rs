//! From a mesh to a template: sampling, reference points, one Gaussian process each, σ̂, bytes.
//!
//! Owns the order of the steps and the change of scale. Everything is learned in the unit sphere,
//! as the paper does, and written in the mesh's unit, so that the controller never scales anything.

mod assemble;
mod bake;
mod draw;
mod error;
mod fit;
mod measure;
mod membership;
mod options;
mod place;
mod squeeze;
mod uncovered;
mod verify;

pub use draw::SurfaceSampling;
pub use error::TrainError;
pub use fit::FITTING;
pub use membership::Overlap;
pub use options::{BUDGET, MAP_BUDGET, MOST_CHARTS, MeanForm, TrainOptions, Validity};
pub use place::{PLACEMENTS, ReferencePoints};
pub use uncovered::UncoveredRegion;
pub(crate) use uncovered::regions;

use crate::gp::FittedGp;
use crate::progress::Progress;
use crate::reference::Cluster;
use crate::surface::{BoundingSphere, Geometry, SurfacePoint};
use crate::validity::FINE_CELLS;
use assemble::{Frame, ScaledComponent};
use cobra_infer::Template;
use cobra_infer::gp::UnitDirection;
use cobra_infer::template::QualitySource;
use draw::Surface;
use measure::Measured;
use membership::Patch;
use nalgebra::Point3;

/// The most components the host scores with.
pub const LARGEST_TEMPLATE: usize = 1024;

/// A trained template.
#[derive(Clone, Debug)]
pub struct Trained {
    /// The template file.
    pub bytes: Vec<u8>,
    /// Training points that were used.
    pub points: usize,
    /// Test points that were used.
    pub test_points: usize,
    /// What training found, one entry a component.
    pub components: Vec<TrainedComponent>,
    /// The share of the test points that some component that may speak predicts within τ; without
    /// validity, the nearest.
    pub covered: f64,
    /// Where the others are, the largest region first.
    pub uncovered: Vec<UncoveredRegion>,
    /// Components that were placed and are not in the template: they would not fit the budget, or may
    /// speak nowhere.
    pub left_out: usize,
    /// How far the compressed mean is from the exact one; `None` where it is the exact one.
    pub deviation: Option<Deviation>,
}

/// What training found for a component.
#[derive(Clone, Debug)]
pub struct TrainedComponent {
    /// The reference point and the shape of its cluster, in the unit sphere.
    pub cluster: Cluster,
    /// The fit, in the unit sphere.
    pub fitted: FittedGp,
    /// Test points that it speaks for.
    pub test_points: usize,
    /// Those of them that it predicts by more than τ wrong.
    pub unexplained: usize,
}

/// How far the mean of a template is from that of the exact Gaussian process, in units of σ̂ of the
/// component that speaks, over the test points that it explains; of maps, the largest over all directions
/// in which components are valid too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// The largest.
    pub max: f64,
    /// Root mean square.
    pub rms: f64,
}

/// A component on its way into the template.
#[derive(Clone)]
struct Part {
    patch: Patch,
    fitted: FittedGp,
    scaled: ScaledComponent,
}

/// Trains a template of `object`, a mesh or a point cloud; of a cloud, at most ¾ of the points are
/// for training and the rest for σ̂.
///
/// The same object, options and build give the same bytes, whatever the number of threads.
///
/// # Errors
/// [`TrainError`].
pub fn train(
    object: &Geometry,
    options: &TrainOptions,
    progress: &dyn Progress,
) -> Result<Trained, TrainError> {
    if options.points == 0 || options.test_points == 0 {
        return Err(TrainError::NoPoints);
    }
    options.overlap.check()?;
    let sphere = object.bounding_sphere();
    let step = |name| progress.start(name, 1);
    let done = || {
        progress.step();
        progress.finish();
    };

    step("sampling the surface");
    let surface = Surface::new(object, &sphere, options.sampling)?;
    let drawn = surface.draw(options)?;
    done();
    step("placing reference points");
    let patches = place::place(&drawn.training, &drawn.others, &sphere, options)?;
    let (training, patches) = surface.redraw(drawn.training, patches, options)?;
    done();
    let positions: Vec<Point3<f64>> = training.iter().map(|point| point.position).collect();
    let fitted = fit::fit_all(&positions, &patches, options, progress)?;
    let frame = Frame {
        options,
        sphere: &sphere,
        diameter: object.diameter(),
    };
    let exact = exact_parts(patches, fitted, &sphere)?;

    step("compressing and verifying");
    let placed = exact.len();
    let parts = finished_parts(&frame, exact, &training)?;
    done();
    step("measuring sigma-hat");
    let test: Vec<Point3<f64>> = drawn
        .test
        .iter()
        .map(|point| sphere.denormalise(point))
        .collect();
    let scaled: Vec<ScaledComponent> = parts.iter().map(|part| part.scaled.clone()).collect();
    let provisional = frame.provisional(&scaled)?;
    let template = Template::from_bytes(&provisional)?;
    let measured = measure::measure(&template, &test)?;
    let deviation = match (options.mean, options.budget) {
        (MeanForm::Process, None) => None,
        (MeanForm::Process, Some(_)) => Some(deviation(&frame, &parts, &measured, &test)?),
        (MeanForm::Map, _) => {
            let on_points = deviation(&frame, &parts, &measured, &test)?;
            let sigma_hats = &measured.sigma_hats;
            Some(bake::bounded(on_points, &template, &parts, sigma_hats))
        }
    };
    let unexplained: Vec<f32> = measured
        .unexplained
        .iter()
        .zip(&measured.test_points)
        .map(|(some, all)| *some as f32 / (*all).max(1) as f32)
        .collect();
    let quality = template.has_validity().then_some(QualitySource {
        covered: measured.covered as f32,
        deviation_max: deviation.map_or(0.0, |deviation| deviation.max as f32),
        deviation_rms: deviation.map_or(0.0, |deviation| deviation.rms as f32),
        unexplained: &unexplained,
    });
    let bytes = frame.encode(&scaled, &measured.sigma_hats, quality)?;
    done();
    Ok(Trained {
        bytes,
        points: training.len(),
        test_points: drawn.test.len(),
        covered: measured.covered,
        uncovered: uncovered::regions(&measured.uncovered, test.len(), sphere.radius),
        left_out: placed - parts.len(),
        deviation,
        components: parts
            .into_iter()
            .zip(measured.test_points)
            .zip(measured.unexplained)
            .map(|((part, test_points), unexplained)| TrainedComponent {
                cluster: part.patch.cluster,
                fitted: part.fitted,
                test_points,
                unexplained,
            })
            .collect(),
    })
}

fn exact_parts(
    patches: Vec<Patch>,
    fitted: Vec<FittedGp>,
    sphere: &BoundingSphere,
) -> Result<Vec<Part>, TrainError> {
    patches
        .into_iter()
        .zip(fitted)
        .enumerate()
        .map(|(component, (patch, fitted))| {
            let scaled = ScaledComponent::exact(&patch.cluster, &fitted, sphere)
                .ok_or(TrainError::Precision { component })?;
            Ok(Part {
                patch,
                fitted,
                scaled,
            })
        })
        .collect()
}

/// Verified and compressed, as the options ask for.
fn finished_parts(
    frame: &Frame<'_>,
    exact: Vec<Part>,
    training: &[SurfacePoint],
) -> Result<Vec<Part>, TrainError> {
    let verified = frame.options.validity == Validity::Verified;
    let exact = if verified {
        squeeze::verify_parts(frame, exact, training, FINE_CELLS)?
    } else {
        exact
    };
    if frame.options.mean == MeanForm::Map {
        if !verified {
            return Err(TrainError::MapNeedsValidity);
        }
        let budget = frame.options.budget.unwrap_or(usize::MAX);
        return bake::bake_parts(frame, exact, training, budget);
    }
    match frame.options.budget {
        Some(budget) => squeeze::squeeze(frame, exact, training, verified, budget),
        None => Ok(exact),
    }
}

/// How far what the template predicts for the test points that it explains is from the exact mean.
fn deviation(
    frame: &Frame<'_>,
    parts: &[Part],
    measured: &Measured,
    test: &[Point3<f64>],
) -> Result<Deviation, TrainError> {
    let exact = parts
        .iter()
        .enumerate()
        .map(|(component, part)| {
            ScaledComponent::exact(&part.patch.cluster, &part.fitted, frame.sphere)
                .ok_or(TrainError::Precision { component })
        })
        .collect::<Result<Vec<_>, _>>()?;
    let bytes = frame.provisional(&exact)?;
    let template = Template::from_bytes(&bytes)?;
    let components: Vec<_> = template.components().collect();
    let tau = crate::evaluate::TAU * frame.sphere.radius;
    let (mut max, mut squares, mut count) = (0.0_f64, 0.0, 0_usize);
    for (found, point) in measured.matches.iter().zip(test) {
        let Some(found) = found else { continue };
        if f64::from(found.residual()).abs() > tau {
            continue;
        }
        let component = &components[found.component];
        let offset = point.cast::<f32>() - Point3::from(component.centre);
        let u = UnitDirection::new_normalize(offset);
        let mean = component.posterior_mean(template.model(), &u);
        let sigma_hat = f64::from(measured.sigma_hats[found.component]);
        let off = f64::from(found.predicted - mean).abs() / sigma_hat;
        max = max.max(off);
        squares += off * off;
        count += 1;
    }
    Ok(Deviation {
        max,
        rms: (squares / count.max(1) as f64).sqrt(),
    })
}

#[cfg(test)]
mod tests;
