//! From a mesh to a template: sampling, reference points, one Gaussian process each, σ̂, bytes.
//!
//! Owns the order of the steps and the change of scale. Everything is learned in the unit sphere,
//! as the paper does, and written in the mesh's unit, so that the controller never scales anything.

mod assemble;
mod draw;
mod error;
mod fit;
mod membership;
mod options;
mod place;
mod sigma_hat;

pub use draw::SurfaceSampling;
pub use error::TrainError;
pub use membership::Overlap;
pub use options::TrainOptions;
pub use place::{PLACEMENTS, ReferencePoints};

use crate::gp::FittedGp;
use crate::progress::Progress;
use crate::reference::Cluster;
use crate::surface::Geometry;
use assemble::{Frame, ScaledComponent};
use cobra_infer::Template;
use draw::Surface;

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
    let clusters = place::place(&drawn.training, &sphere, options)?;
    let training = surface.redraw(drawn.training, &clusters, options)?;
    done();
    let fitted = fit::fit_all(&training, &clusters, options, progress)?;

    step("measuring sigma-hat");
    let scaled: Vec<ScaledComponent> = clusters
        .iter()
        .zip(&fitted)
        .enumerate()
        .map(|(component, (cluster, fitted))| {
            ScaledComponent::new(cluster, fitted, &sphere)
                .ok_or(TrainError::Precision { component })
        })
        .collect::<Result<_, _>>()?;
    let frame = Frame {
        options,
        sphere: &sphere,
        diameter: object.diameter(),
    };
    let provisional = frame.encode(&scaled, &vec![sphere.radius as f32; scaled.len()])?;
    let (sigma_hats, test_counts) = sigma_hat::measure(
        &Template::from_bytes(&provisional)?,
        &drawn
            .test
            .iter()
            .map(|point| sphere.denormalise(point))
            .collect::<Vec<_>>(),
    )?;
    let bytes = frame.encode(&scaled, &sigma_hats)?;
    done();
    Ok(Trained {
        bytes,
        points: training.len(),
        test_points: drawn.test.len(),
        components: clusters
            .into_iter()
            .zip(fitted)
            .zip(test_counts)
            .map(|((cluster, fitted), test_points)| TrainedComponent {
                cluster,
                fitted,
                test_points,
            })
            .collect(),
    })
}
