//! From fitted components to the bytes of a template: the change of scale and of precision.

use super::TrainOptions;
use crate::gp::{Baked, Compressed, FittedGp};
use crate::reference::Cluster;
use crate::surface::BoundingSphere;
use crate::validity::ValidCells;
use cobra_infer::gp::compact::GRID;
use cobra_infer::gp::{Hyperparameters, UnitDirection};
use cobra_infer::template::{
    ComponentSource, DepthRecord, DepthSource, Precision, QualitySource, TemplateSource,
    TermsSource, ValiditySource, encode, encoded_len,
};
use cobra_infer::validity::Pole;
use cobra_infer::{EncodeError, Kernel};
use nalgebra::{Cholesky, Matrix3};

/// A component in the mesh's unit and in the template's precision.
#[derive(Clone)]
pub(super) struct ScaledComponent {
    centre: [f32; 3],
    precision: Option<Precision>,
    hyperparameters: Hyperparameters,
    terms: ScaledTerms,
    validity: Option<ScaledValidity>,
}

#[derive(Clone)]
enum ScaledTerms {
    Exact {
        directions: Vec<UnitDirection>,
        weights: Vec<f32>,
    },
    Compact {
        directions: Vec<[i8; 3]>,
        weights: Vec<i16>,
        scale: f32,
    },
    Map {
        pole: Pole,
        map: Baked,
        /// In the mesh's unit.
        scale: f32,
    },
}

/// Where a component may speak.
#[derive(Clone)]
pub(super) struct ScaledValidity {
    pub(super) cells: ValidCells,
    pub(super) low: [u8; 3],
    pub(super) high: [u8; 3],
}

impl ScaledComponent {
    /// The exact Gaussian process. `None` where the cluster's precision leaves the range of `f32` in
    /// the mesh's unit.
    pub(super) fn exact(
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
            terms: ScaledTerms::Exact {
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
            },
            validity: None,
        })
    }

    /// The same component with compressed terms.
    pub(super) fn compact(
        &self,
        kernel: Kernel,
        compressed: &Compressed,
        sphere: &BoundingSphere,
    ) -> Self {
        let Hyperparameters {
            length_scale,
            parameter,
            prior_mean,
        } = self.hyperparameters;
        // What the kernel makes of coordinates that are 127 times as large.
        let (length_scale, parameter, shrink) = match kernel {
            Kernel::Linear => (length_scale, parameter, GRID.powi(-2)),
            Kernel::Polynomial => (length_scale, parameter * GRID.powi(2), GRID.powi(-6)),
            Kernel::Periodic => (length_scale, parameter * GRID, 1.0),
            _ => (length_scale * GRID, parameter, 1.0),
        };
        Self {
            hyperparameters: Hyperparameters {
                length_scale,
                parameter,
                prior_mean,
            },
            terms: ScaledTerms::Compact {
                directions: compressed.directions.clone(),
                weights: compressed.weights.clone(),
                scale: (sphere.radius * compressed.scale * f64::from(shrink)) as f32,
            },
            validity: None,
            ..*self
        }
    }

    /// The same component with a map, which was fitted where it is valid.
    pub(super) fn baked(&self, map: &Baked, sphere: &BoundingSphere) -> Self {
        Self {
            hyperparameters: Hyperparameters {
                prior_mean: (sphere.radius * map.prior_mean) as f32,
                ..self.hyperparameters
            },
            terms: ScaledTerms::Map {
                pole: self.cells().map_or(Pole::PlusZ, |cells| cells.pole),
                map: map.clone(),
                scale: (sphere.radius * map.scale) as f32,
            },
            ..self.clone()
        }
    }

    /// The directions in which it may speak.
    pub(super) fn cells(&self) -> Option<&ValidCells> {
        self.validity.as_ref().map(|validity| &validity.cells)
    }

    /// The same component, silent in the cells that are not among these of the same grid. `None` where
    /// no valid cell is left.
    pub(super) fn valid_within(&self, cells: &ValidCells) -> Option<Self> {
        let mut restricted = self.clone();
        let own = &mut restricted.validity.as_mut()?.cells;
        if (own.pole, own.side) == (cells.pole, cells.side) {
            for (valid, other) in own.cells.iter_mut().zip(&cells.cells) {
                *valid &= *other;
            }
        }
        (own.count() > 0).then_some(restricted)
    }

    pub(super) fn with_validity(self, validity: ScaledValidity) -> Self {
        Self {
            validity: Some(validity),
            ..self
        }
    }

    pub(super) fn term_count(&self) -> usize {
        match &self.terms {
            ScaledTerms::Exact { weights, .. } => weights.len(),
            ScaledTerms::Compact { weights, .. } => weights.len(),
            ScaledTerms::Map { map, .. } => map.nodes.len(),
        }
    }

    fn source(&self, sigma_hat: f32) -> ComponentSource<'_> {
        ComponentSource {
            centre: self.centre,
            sigma_hat,
            precision: self.precision,
            hyperparameters: self.hyperparameters,
            terms: match &self.terms {
                ScaledTerms::Exact {
                    directions,
                    weights,
                } => TermsSource::Exact {
                    directions,
                    weights,
                },
                ScaledTerms::Compact {
                    directions,
                    weights,
                    scale,
                } => TermsSource::Compact {
                    directions,
                    weights,
                    scale: *scale,
                },
                ScaledTerms::Map { pole, map, scale } => TermsSource::Map {
                    pole: *pole,
                    size: map.size,
                    spacing: map.spacing as f32,
                    origin: map.origin.map(|place| place as f32),
                    scale: *scale,
                    nodes: &map.nodes,
                },
            },
            validity: self.validity.as_ref().map(|validity| ValiditySource {
                pole: validity.cells.pole,
                side: validity.cells.side,
                cells: &validity.cells.cells,
                low: validity.low,
                high: validity.high,
            }),
        }
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
        quality: Option<QualitySource<'_>>,
    ) -> Result<Vec<u8>, EncodeError> {
        let components: Vec<ComponentSource<'_>> = components
            .iter()
            .zip(sigma_hats)
            .map(|(component, sigma_hat)| component.source(*sigma_hat))
            .collect();
        let source = TemplateSource {
            name: &self.options.name,
            unit: self.options.unit,
            centre: self.sphere.centre.cast::<f32>().coords.into(),
            radius: self.sphere.radius as f32,
            diameter: self.diameter as f32,
            model: self.options.fit.model,
            components: &components,
            quality,
            // Where it is known which surface there is, a pose can be checked against depth.
            depth: quality.map(|_| DepthSource {
                noise_share: DepthRecord::NOISE_SHARE,
                calibration: None,
                provenance: "",
            }),
        };
        let mut bytes = vec![0; encoded_len(&source)];
        let length = encode(&source, &mut bytes)?;
        bytes.truncate(length);
        Ok(bytes)
    }

    /// The template before anything is measured of it: every σ̂ the radius.
    pub(super) fn provisional(
        &self,
        components: &[ScaledComponent],
    ) -> Result<Vec<u8>, EncodeError> {
        let sigma_hats = vec![self.sphere.radius as f32; components.len()];
        self.encode(components, &sigma_hats, None)
    }
}
