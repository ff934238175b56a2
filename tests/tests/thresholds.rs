//! What the three thresholds promise, against simulated residuals scored through a camera.
//!
//! The object is a sphere seen from its own centre's side, so that a point moved along its ray of
//! the reference point has exactly the residual it was moved by.

use cobra_infer::gp::{Hyperparameters, UnitDirection};
use cobra_infer::template::{ComponentSource, TemplateSource, TermsSource, encode, encoded_len};
use cobra_infer::{
    Camera, Correspondence, Exponent, Kernel, Likelihood, Model, Pose, Report, Scorer, Settings,
    Sigma, Template, Threshold, Unit, bound,
};
use cobra_tests::tolerance::MONTE_CARLO;
use cobra_train::random::{Purpose, stream};
use nalgebra::{Point3, UnitVector3, Vector3};
use rand::RngExt;

const RADIUS: f32 = 40.0;
const SIGMA: f32 = 1.5;
const SAMPLES: u64 = 40_000;
const DELTAS: [f32; 4] = [0.5, 1.5, 2.4, 6.0];

fn sphere() -> Vec<u8> {
    let direction = [UnitDirection::new_unchecked(Vector3::x())];
    let component = ComponentSource {
        centre: [0.0; 3],
        sigma_hat: SIGMA,
        precision: None,
        hyperparameters: Hyperparameters {
            length_scale: 0.5,
            parameter: 1.0,
            prior_mean: RADIUS,
        },
        terms: TermsSource::Exact {
            directions: &direction,
            weights: &[0.0],
        },
        validity: None,
    };
    let source = TemplateSource {
        name: "sphere",
        unit: Unit::Millimetre,
        centre: [0.0; 3],
        radius: RADIUS,
        diameter: 2.0 * RADIUS,
        model: Model::chord(Kernel::RationalQuadratic(Exponent::One)),
        components: &[component],
        quality: None,
        depth: None,
    };
    let mut bytes = vec![0; encoded_len(&source)];
    let length = encode(&source, &mut bytes).unwrap();
    bytes.truncate(length);
    bytes
}

/// Scores points whose residuals are `residuals`, spread over the side that the camera sees; the
/// likelihood of each, and the report.
fn scored(
    likelihood: Likelihood,
    threshold: Threshold,
    delta: f32,
    residuals: &[f64],
) -> (Vec<f64>, Report) {
    let bytes = sphere();
    let template = Template::from_bytes(&bytes).unwrap();
    let camera = Camera::new(900.0, 900.0, 320.0, 240.0).unwrap();
    let rotation = [1., 0., 0., 0., 1., 0., 0., 0., 1.];
    let pose = Pose::from_row_major(rotation, [0.0, 0.0, 300.0]).unwrap();
    let settings = Settings {
        likelihood,
        threshold,
        sigma: Sigma::Template { noise: 0.0 },
        ..Settings::with_delta(delta)
    };
    let mut scorer = Scorer::<1>::new(&template, &camera, &pose, &settings).unwrap();
    let mut rng = stream(3, Purpose::Demonstration, 1);
    let likelihoods = residuals
        .iter()
        .map(|residual| {
            let side = Vector3::new(
                rng.random_range(-0.7..0.7),
                rng.random_range(-0.7..0.7),
                -1.0,
            );
            let u = UnitVector3::new_normalize(side);
            let point = Point3::from(u.into_inner() * (f64::from(RADIUS) + residual)).cast();
            let pixel = camera.project(&pose.to_camera(&point)).unwrap();
            f64::from(scorer.push(&Correspondence::new(pixel, point)).likelihood)
        })
        .collect();
    (likelihoods, scorer.finish())
}

/// Residuals spread evenly in ±`delta`.
fn spread(delta: f32) -> Vec<f64> {
    let mut rng = stream(1, Purpose::Demonstration, 0);
    let delta = f64::from(delta);
    (0..SAMPLES)
        .map(|_| rng.random_range(-delta..=delta))
        .collect()
}

/// Mean and its standard error.
fn average(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

const LIKELIHOODS: [Likelihood; 2] = [Likelihood::Peak, Likelihood::Density];

#[test]
fn the_mean_threshold_is_the_average_confidence_of_residuals_spread_evenly() {
    for likelihood in LIKELIHOODS {
        for delta in DELTAS {
            let (likelihoods, report) = scored(likelihood, Threshold::Mean, delta, &spread(delta));
            let (mean, error) = average(&likelihoods);
            let off = (mean - f64::from(report.threshold)).abs() / error;
            assert!(off < MONTE_CARLO, "{likelihood:?}, {delta}: {off}");
        }
    }
}

/// The paper's derivation replaces the average of q̂(e) by that of (|e|/δ)·q̂(e), which has an
/// integral in closed form and is smaller because |e| ≤ δ.
#[test]
fn equation_11_is_the_average_weighted_by_the_residual_and_bounds_the_plain_one() {
    for likelihood in LIKELIHOODS {
        for delta in DELTAS {
            let residuals = spread(delta);
            let (likelihoods, report) = scored(likelihood, Threshold::Paper, delta, &residuals);
            let weighted: Vec<f64> = likelihoods
                .iter()
                .zip(&residuals)
                .map(|(q, e)| q * e.abs() / f64::from(delta))
                .collect();
            let (mean, error) = average(&weighted);
            let threshold = f64::from(report.threshold);
            let off = (mean - threshold).abs() / error;
            assert!(off < MONTE_CARLO, "{likelihood:?}, {delta}: {off}");
            assert!(f64::from(report.confidence) > threshold);
        }
    }
}

#[test]
fn every_pose_within_delta_reaches_the_worst_threshold_and_none_beyond() {
    for likelihood in LIKELIHOODS {
        for delta in DELTAS {
            // Coordinates are rounded, by some 10⁻⁵ of the radius.
            let edge = f64::from(delta) - 1e-3;
            for residuals in [vec![edge; 50], vec![-edge; 50], spread(0.999 * delta)] {
                let (_, report) = scored(likelihood, Threshold::Worst, delta, &residuals);
                assert!(report.confidence >= report.threshold, "{delta}: {report:?}");
            }
            let beyond = vec![f64::from(delta) + 1e-3; 50];
            let (_, report) = scored(likelihood, Threshold::Worst, delta, &beyond);
            assert!(report.confidence < report.threshold, "{delta}: {report:?}");
        }
    }
}

#[test]
fn equation_11_rejects_a_pose_within_delta_where_delta_exceeds_1_585_sigma() {
    for (ratio, accepted) in [(1.0, true), (1.57, true), (1.6, false), (3.0, false)] {
        let delta = ratio * SIGMA;
        let edge = vec![f64::from(delta) - 1e-3; 50];
        let (_, report) = scored(Likelihood::Peak, Threshold::Paper, delta, &edge);
        assert_eq!(report.confidence >= report.threshold, accepted, "{ratio}");
    }
}

#[test]
fn a_contribution_is_what_the_scorer_reports_for_equal_sigmas() {
    for threshold in [Threshold::Paper, Threshold::Mean, Threshold::Worst] {
        let (_, report) = scored(Likelihood::Peak, threshold, 2.0, &[0.5; 10]);
        let one = bound::contribution(Likelihood::Peak, threshold, SIGMA, 2.0);
        assert!(
            (report.threshold - one).abs() <= f32::EPSILON,
            "{threshold:?}"
        );
    }
}
