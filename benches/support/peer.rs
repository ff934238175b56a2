//! The crates that fit Gaussian processes, each behind one function.
//!
//! They fit one process to all they are given: a component's points are what `cobra-train` gives
//! its own as well, so that everybody does the same work. Neither is made for 10,000 points at once:
//! their matrices of covariances would be factored a hundred times over.

use super::Component;
use egobox_gp::correlation_models::Matern52Corr;
use egobox_gp::mean_models::ConstantMean;
use egobox_gp::{GaussianProcess as Egobox, GpParams, ThetaTuning};
use friedrich::gaussian_process::GaussianProcess as Friedrich;
use friedrich::kernel::RationalQuadratic;
use linfa::Dataset;
use linfa::traits::Fit;
use ndarray::{Array1, Array2, arr1, arr2};

/// The posterior mean of distances in directions.
pub(crate) type PosteriorMean = Box<dyn Fn(&[[f64; 3]]) -> Vec<f64>>;

/// Fits a process to a component's points, with a length scale, or with the hyperparameters that
/// the library learns by default.
pub(crate) type FitProcess = fn(&Component, Option<f64>) -> PosteriorMean;

/// Their names and how they fit.
pub(crate) const PEERS: [(&str, FitProcess); 2] = [("friedrich", friedrich), ("egobox-gp", egobox)];

/// Where learning starts, of the order at which it ends.
const FIRST_LENGTH_SCALE: f64 = 0.5;

/// The noise's standard deviation where it is not learned, that of the least variance of
/// `cobra-train`'s.
const NOISE: f64 = 0.003;

fn friedrich(component: &Component, length_scale: Option<f64>) -> PosteriorMean {
    let (directions, distances) = component.directions_and_distances();
    let inputs: Vec<Vec<f64>> = directions.iter().map(|u| u.to_vec()).collect();
    let builder = Friedrich::builder(inputs, distances)
        .set_kernel(RationalQuadratic::new(
            1.0,
            length_scale.unwrap_or(FIRST_LENGTH_SCALE),
        ))
        .fit_prior();
    let builder = match length_scale {
        Some(_) => builder.set_noise(NOISE),
        None => builder.fit_kernel(),
    };
    let process = builder.train();
    Box::new(move |directions| {
        let inputs: Vec<Vec<f64>> = directions.iter().map(|u| u.to_vec()).collect();
        process.predict(&inputs)
    })
}

/// It has no rational quadratic: Matérn 5/2 is the nearest to one that it has.
fn egobox(component: &Component, length_scale: Option<f64>) -> PosteriorMean {
    let (directions, distances) = component.directions_and_distances();
    let data: Dataset<f64, f64, ndarray::Ix1> =
        Dataset::new(arr2(&directions), Array1::from_vec(distances));
    let parameters: GpParams<f64, ConstantMean, Matern52Corr> =
        Egobox::<f64, ConstantMean, Matern52Corr>::params(ConstantMean(), Matern52Corr())
            .nugget(NOISE * NOISE);
    let parameters = match length_scale {
        Some(scale) => parameters.theta_tuning(ThetaTuning::Fixed(arr1(&[1.0 / scale]))),
        None => parameters,
    };
    let process = parameters
        .fit(&data)
        .expect("distinct directions have a posterior");
    Box::new(move |directions| {
        let inputs: Array2<f64> = arr2(directions);
        process
            .predict(&inputs)
            .expect("a direction has as many coordinates as those of the fit")
            .to_vec()
    })
}
