//! From fitted components to the bytes of a template: the change of scale and of precision.

use super::TrainOptions;
use crate::gp::FittedGp;
use crate::reference::Cluster;
use crate::surface::BoundingSphere;
use cobra_infer::EncodeError;
use cobra_infer::gp::{Hyperparameters, UnitDirection};
use cobra_infer::template::{
    ComponentSource, Precision, TemplateSource, TermsSource, encode, encoded_len,
};
use nalgebra::{Cholesky, Matrix3};

/// A fitted component in the mesh's unit and in the template's precision.
pub(super) struct ScaledComponent {
    centre: [f32; 3],
    precision: Option<Precision>,
    hyperparameters: Hyperparameters,
    directions: Vec<UnitDirection>,
    weights: Vec<f32>,
}

impl ScaledComponent {
    /// `None` where the cluster's precision leaves the range of `f32` in the mesh's unit.
    pub(super) fn new(
        cluster: &Cluster,
        fitted: &FittedGp,
        sphere: &BoundingSphere,
    ) -> Option<Self> {
        let h = &fitted.learned.hyperparameters;
        let precision = match cluster.precision() {
            Some(precision) => Some(scaled_precision(precision, sphere.radius)?),
            None => None,
        };
        Some(Self {
            centre: sphere
                .denormalise(&cluster.centre())
                .cast::<f32>()
                .coords
                .into(),
            precision,
            hyperparameters: Hyperparameters {
                length_scale: h.length_scale as f32,
                parameter: h.parameter as f32,
                prior_mean: (sphere.radius * fitted.prior_mean) as f32,
            },
            directions: fitted
                .directions
                .iter()
                .map(|u| UnitDirection::new_unchecked(u.cast::<f32>().into_inner()))
                .collect(),
            weights: fitted
                .weights
                .iter()
                .map(|w| (sphere.radius * w) as f32)
                .collect(),
        })
    }
}

/// Q = LLᵀ of the unit sphere in the mesh's unit: L/radius.
fn scaled_precision(precision: &Matrix3<f64>, radius: f64) -> Option<Precision> {
    let lower = Cholesky::new(*precision)?.l() / radius;
    let entries = [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)];
    Precision::from_factor(entries.map(|entry| lower[entry] as f32))
}

/// What the template says of the object as a whole.
pub(super) struct Frame<'a> {
    pub(super) options: &'a TrainOptions,
    pub(super) sphere: &'a BoundingSphere,
    pub(super) diameter: f64,
}

impl Frame<'_> {
    pub(super) fn encode(
        &self,
        components: &[ScaledComponent],
        sigma_hats: &[f32],
    ) -> Result<Vec<u8>, EncodeError> {
        let components: Vec<ComponentSource<'_>> = components
            .iter()
            .zip(sigma_hats)
            .map(|(component, sigma_hat)| ComponentSource {
                centre: component.centre,
                sigma_hat: *sigma_hat,
                precision: component.precision,
                hyperparameters: component.hyperparameters,
                terms: TermsSource::Exact {
                    directions: &component.directions,
                    weights: &component.weights,
                },
                validity: None,
            })
            .collect();
        let source = TemplateSource {
            name: &self.options.name,
            unit: self.options.unit,
            centre: self.sphere.centre.cast::<f32>().coords.into(),
            radius: self.sphere.radius as f32,
            diameter: self.diameter as f32,
            model: self.options.fit.model,
            components: &components,
            quality: None,
        };
        let mut bytes = vec![0; encoded_len(&source)];
        let length = encode(&source, &mut bytes)?;
        bytes.truncate(length);
        Ok(bytes)
    }
}
