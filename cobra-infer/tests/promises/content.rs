//! The content of a template, owned, and its encoding: what tests build templates from.

use cobra_infer::gp::{Hyperparameters, UnitDirection};
use cobra_infer::template::{
    ComponentSource, DepthSource, Precision, QualitySource, TemplateSource, TermsSource,
    ValiditySource, encode, encoded_len,
};
use cobra_infer::validity::Pole;
use cobra_infer::{EncodeError, Exponent, Kernel, Metric, Model, Unit};
use nalgebra::Vector3;
use proptest::collection::vec;
use proptest::prelude::*;

#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub(crate) centre: [f32; 3],
    pub(crate) sigma_hat: f32,
    pub(crate) precision: Option<Precision>,
    pub(crate) hyperparameters: Hyperparameters,
    pub(crate) directions: Vec<UnitDirection>,
    pub(crate) weights: Vec<f32>,
    /// In the place of directions and weights.
    pub(crate) compact: Option<Compact>,
    /// In the place of either.
    pub(crate) map: Option<Map>,
    pub(crate) validity: Option<Valid>,
}

/// Compact terms.
#[derive(Clone, Debug)]
pub(crate) struct Compact {
    pub(crate) directions: Vec<[i8; 3]>,
    pub(crate) weights: Vec<i16>,
    pub(crate) scale: f32,
}

/// A map over the directions.
#[derive(Clone, Debug)]
pub(crate) struct Map {
    pub(crate) pole: Pole,
    pub(crate) size: [u8; 2],
    pub(crate) spacing: f32,
    pub(crate) origin: [f32; 2],
    pub(crate) scale: f32,
    pub(crate) nodes: Vec<i8>,
}

/// Where a component may speak.
#[derive(Clone, Debug)]
pub(crate) struct Valid {
    pub(crate) pole: Pole,
    pub(crate) side: u8,
    pub(crate) cells: Vec<bool>,
    pub(crate) low: [u8; 3],
    pub(crate) high: [u8; 3],
}

/// What was measured.
#[derive(Clone, Debug)]
pub(crate) struct Measured {
    pub(crate) covered: f32,
    pub(crate) deviations: [f32; 2],
    pub(crate) unexplained: Vec<f32>,
}

#[derive(Clone, Debug)]
pub(crate) struct Content {
    pub(crate) name: String,
    pub(crate) unit: Unit,
    pub(crate) centre: [f32; 3],
    pub(crate) radius: f32,
    pub(crate) diameter: f32,
    pub(crate) model: Model,
    pub(crate) parts: Vec<Part>,
    pub(crate) quality: Option<Measured>,
    pub(crate) depth: Option<DepthSource<'static>>,
}

impl Content {
    pub(crate) fn try_encode(&self) -> Result<Vec<u8>, EncodeError> {
        let components: Vec<ComponentSource<'_>> = self
            .parts
            .iter()
            .map(|part| ComponentSource {
                centre: part.centre,
                sigma_hat: part.sigma_hat,
                precision: part.precision,
                hyperparameters: part.hyperparameters,
                terms: match (&part.compact, &part.map) {
                    (_, Some(map)) => TermsSource::Map {
                        pole: map.pole,
                        size: map.size,
                        spacing: map.spacing,
                        origin: map.origin,
                        scale: map.scale,
                        nodes: &map.nodes,
                    },
                    (None, None) => TermsSource::Exact {
                        directions: &part.directions,
                        weights: &part.weights,
                    },
                    (Some(compact), None) => TermsSource::Compact {
                        directions: &compact.directions,
                        weights: &compact.weights,
                        scale: compact.scale,
                    },
                },
                validity: part.validity.as_ref().map(|valid| ValiditySource {
                    pole: valid.pole,
                    side: valid.side,
                    cells: &valid.cells,
                    low: valid.low,
                    high: valid.high,
                }),
            })
            .collect();
        let source = TemplateSource {
            name: &self.name,
            unit: self.unit,
            centre: self.centre,
            radius: self.radius,
            diameter: self.diameter,
            model: self.model,
            components: &components,
            quality: self.quality.as_ref().map(|measured| QualitySource {
                covered: measured.covered,
                deviation_max: measured.deviations[0],
                deviation_rms: measured.deviations[1],
                unexplained: &measured.unexplained,
            }),
            depth: self.depth,
        };
        let mut bytes = vec![0; encoded_len(&source)];
        let length = encode(&source, &mut bytes)?;
        bytes.truncate(length);
        Ok(bytes)
    }

    pub(crate) fn encode(&self) -> Vec<u8> {
        self.try_encode().unwrap()
    }

    /// Two components of three and two terms: small enough to try every bit.
    pub(crate) fn small() -> Self {
        let part = |x: f32, count: usize| Part {
            centre: [x, 0.5, -0.25],
            sigma_hat: 0.125,
            precision: None,
            hyperparameters: Hyperparameters {
                length_scale: 0.5,
                parameter: 1.0,
                prior_mean: 10.0,
            },
            directions: [
                UnitDirection::new_unchecked(Vector3::x()),
                UnitDirection::new_unchecked(-Vector3::y()),
                UnitDirection::new_unchecked(Vector3::z()),
            ][..count]
                .to_vec(),
            weights: [0.5, -0.25, 0.75][..count].to_vec(),
            compact: None,
            map: None,
            validity: None,
        };
        Self {
            name: "nut".into(),
            unit: Unit::Millimetre,
            centre: [0.0; 3],
            radius: 12.0,
            diameter: 24.0,
            model: Model::chord(Kernel::RationalQuadratic(Exponent::One)),
            parts: vec![part(-2.0, 3), part(2.0, 2)],
            quality: None,
            depth: None,
        }
    }

    /// A sphere around the origin: no weights, the prior mean says it all, so predictions are exact.
    pub(crate) fn sphere(radius: f32, sigma_hat: f32) -> Self {
        let mut content = Self::small();
        content.radius = radius;
        content.diameter = 2.0 * radius;
        content.parts.truncate(1);
        content.parts[0].centre = [0.0; 3];
        content.parts[0].sigma_hat = sigma_hat;
        content.parts[0].hyperparameters.prior_mean = radius;
        content.parts[0].weights.fill(0.0);
        content
    }
}

pub(crate) fn direction() -> impl Strategy<Value = UnitDirection> {
    [-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0]
        .prop_filter("too short to normalise", |v| {
            v.iter().map(|c| c * c).sum::<f32>() > 1e-3
        })
        .prop_map(|[x, y, z]| UnitDirection::new_normalize(Vector3::new(x, y, z)))
}

pub(crate) fn model() -> impl Strategy<Value = Model> {
    let kernel = prop::sample::select(&Kernel::ALL[..]);
    let metric = prop::sample::select(&Metric::ALL[..]);
    (metric, kernel).prop_map(|(metric, kernel)| Model { metric, kernel })
}

fn precision() -> impl Strategy<Value = Precision> {
    let entry = -2.0_f32..2.0;
    (
        [0.01_f32..3.0, 0.01_f32..3.0, 0.01_f32..3.0],
        [entry.clone(), entry.clone(), entry],
    )
        .prop_map(|([xx, yy, zz], [yx, zx, zy])| {
            Precision::from_factor([xx, yx, yy, zx, zy, zz]).unwrap()
        })
}

pub(crate) fn part(kernel: Kernel, terms: usize) -> impl Strategy<Value = Part> {
    (
        [-5.0_f32..5.0, -5.0_f32..5.0, -5.0_f32..5.0],
        0.01_f32..2.0,
        (0.05_f32..3.0, 0.1_f32..4.0, -1.0_f32..20.0),
        vec(direction(), terms),
        vec(-3.0_f32..3.0, terms),
    )
        .prop_map(
            move |(centre, sigma_hat, (l, free, m), directions, weights)| Part {
                centre,
                sigma_hat,
                precision: None,
                hyperparameters: Hyperparameters {
                    length_scale: kernel.fixed_length_scale().unwrap_or(l),
                    parameter: kernel.fixed_parameter().unwrap_or(free),
                    prior_mean: m,
                },
                directions,
                weights,
                compact: None,
                map: None,
                validity: None,
            },
        )
}

/// Any template of up to five components of up to forty terms.
pub(crate) fn content() -> impl Strategy<Value = Content> {
    let parts = (model(), any::<bool>()).prop_flat_map(|(model, precise)| {
        let part = (1_usize..41, precision()).prop_flat_map(move |(terms, precision)| {
            part(model.kernel, terms).prop_map(move |part| Part {
                precision: precise.then_some(precision),
                ..part
            })
        });
        (Just(model), vec(part, 1..6))
    });
    (
        vec(any::<char>(), 0..9),
        prop::sample::select(&Unit::ALL[..]),
        [-5.0_f32..5.0, -5.0_f32..5.0, -5.0_f32..5.0],
        (5.0_f32..20.0, 1.0_f32..40.0),
        parts,
    )
        .prop_map(
            |(name, unit, centre, (radius, diameter), (model, parts))| Content {
                name: name.into_iter().collect(),
                unit,
                centre,
                radius,
                diameter,
                model,
                parts,
                quality: None,
                depth: None,
            },
        )
}
