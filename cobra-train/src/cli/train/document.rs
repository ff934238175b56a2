//! What `cobra train --json` says.

use super::{AUTO, EM, KMEANS};
use crate::cli::covered::{DeviationDocument, RegionDocument};
use cobra_infer::Template;
use cobra_train::coverage::Coverage;
use cobra_train::gp::{Optimiser, PriorMean, Subset};
use cobra_train::surface::BoundingSphere;
use cobra_train::train::{MeanForm, Overlap, ReferencePoints, TrainOptions, Trained, Validity};
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct Document<'a> {
    schema: u32,
    name: &'a str,
    unit: &'static str,
    diameter: f32,
    radius: f32,
    bytes: usize,
    sampling: &'static str,
    points: usize,
    test_points: usize,
    reference_points: &'static str,
    /// `null` without overlap.
    overlap: Option<f64>,
    seed: u64,
    metric: &'static str,
    kernel: &'static str,
    /// With `--unit-sphere`: a point P of the file is at scale * (P - centre).
    unit_sphere: Option<UnitSphereDocument>,
    optimiser: &'static str,
    /// Points of each component that hyperparameters are learned on; null for all.
    subset: Option<usize>,
    prior_mean: &'static str,
    /// Of the unit sphere.
    noise_floor: f64,
    validity: &'static str,
    /// `gp`, or `map`.
    mean: &'static str,
    /// `null` for the exact Gaussian process.
    budget: Option<usize>,
    /// `null` for the exact Gaussian process.
    deviation: Option<DeviationDocument>,
    /// Percent of the test points that the template predicts within tau.
    covered: f64,
    /// Where the others are, the largest region first.
    uncovered: Vec<RegionDocument>,
    /// Components that were placed and did not fit.
    left_out: usize,
    components: Vec<ComponentDocument>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) coverage: Option<&'a Coverage>,
}

#[derive(Serialize)]
struct UnitSphereDocument {
    centre: [f64; 3],
    scale: f64,
}

#[derive(Serialize)]
struct ComponentDocument {
    centre: [f32; 3],
    sigma_hat: f32,
    /// With `--mean map`, nodes.
    terms: usize,
    test_points: usize,
    /// Those of them that it does not predict within tau.
    unexplained: usize,
    length_scale: f64,
    /// The kernel's parameter besides, such as the exponent; 1 where it has none.
    parameter: f64,
    prior_mean: f32,
    /// Of the unit sphere.
    signal_variance: f64,
    /// Of the unit sphere.
    noise_variance: f64,
    /// Negative log marginal likelihood per point of the subset that it was learned on.
    likelihood_per_point: f64,
    iterations: u64,
    stop: &'static str,
}

pub(super) fn document<'a>(
    template: &'a Template<'_>,
    trained: &Trained,
    options: &TrainOptions,
    moved_from: Option<&BoundingSphere>,
) -> Document<'a> {
    Document {
        schema: 2,
        name: template.name(),
        unit: template.unit().symbol(),
        diameter: template.diameter(),
        radius: template.radius(),
        bytes: trained.bytes.len(),
        sampling: options.sampling.name(),
        points: trained.points,
        test_points: trained.test_points,
        reference_points: match options.reference_points {
            ReferencePoints::Auto { .. } => AUTO,
            ReferencePoints::KMeans { .. } => KMEANS,
            ReferencePoints::Em { .. } => EM,
            ReferencePoints::Given(_) => "given",
        },
        overlap: match options.overlap {
            Overlap::None => None,
            Overlap::Ball { share } => Some(share),
        },
        seed: options.seed,
        metric: template.metric().name(),
        kernel: template.kernel().name(),
        unit_sphere: moved_from.map(|sphere| UnitSphereDocument {
            centre: sphere.centre.into(),
            scale: 1.0 / sphere.radius,
        }),
        optimiser: match options.fit.optimiser {
            Optimiser::Lbfgs => "lbfgs",
            Optimiser::Adam(_) => "adam",
        },
        subset: match options.fit.subset {
            Subset::Points(count) => Some(count),
            Subset::All => None,
        },
        prior_mean: match options.fit.prior_mean {
            PriorMean::Average => "average",
            PriorMean::Zero => "zero",
        },
        noise_floor: options.fit.noise_floor,
        validity: match options.validity {
            Validity::Verified => "verified",
            Validity::Everywhere => "everywhere",
        },
        mean: match options.mean {
            MeanForm::Process => "gp",
            MeanForm::Map => "map",
        },
        budget: options.budget,
        deviation: trained.deviation.map(DeviationDocument::from),
        covered: 100.0 * trained.covered,
        left_out: trained.left_out,
        uncovered: trained.uncovered.iter().map(RegionDocument::from).collect(),
        coverage: None,
        components: template
            .components()
            .zip(&trained.components)
            .map(|(component, trained)| {
                let learned = &trained.fitted.learned;
                let h = &learned.hyperparameters;
                ComponentDocument {
                    centre: component.centre,
                    sigma_hat: component.sigma_hat,
                    terms: component.terms.len(),
                    test_points: trained.test_points,
                    unexplained: trained.unexplained,
                    length_scale: h.length_scale,
                    parameter: h.parameter,
                    prior_mean: component.hyperparameters.prior_mean,
                    signal_variance: h.signal_variance,
                    noise_variance: h.noise_variance,
                    likelihood_per_point: learned.likelihood_per_point,
                    iterations: learned.iterations,
                    stop: learned.stop.name(),
                }
            })
            .collect(),
    }
}
