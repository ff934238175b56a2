//! What is in a template: its facts, its components, its size by part.

use super::colours;
use crate::export::{counted, elements};
use cobra_infer::template::{Component, Quality, RECORD_LENGTH};
use cobra_infer::{Assignment, Settings, Template};
use serde::Serialize;

/// What is in a template.
#[derive(Clone, Debug, Serialize)]
pub struct Content {
    /// The object's name.
    pub name: String,
    /// Symbol of its unit.
    pub unit: &'static str,
    /// Millimetres in a unit.
    pub millimetres: f64,
    /// The largest distance between two points of the object.
    pub diameter: f64,
    /// The bounding sphere's radius.
    pub radius: f64,
    /// The covariance function.
    pub kernel: &'static str,
    /// What distance between directions it takes.
    pub metric: &'static str,
    /// How terms are stored: `exact`, `compact` or `map`.
    pub encoding: &'static str,
    /// What the components are made of: `terms` or `nodes`.
    pub elements: &'static str,
    /// What the cost counts.
    pub counted: &'static str,
    /// Whether components speak only where they were verified.
    pub validity: bool,
    /// Size by part.
    pub bytes: Bytes,
    /// How far compression or baking moved the mean, in σ̂: rms and at most.
    pub deviation: Option<[f64; 2]>,
    /// Worst cases of the cost of a point, of nearest and of maximum assignment.
    pub cost: [usize; 2],
    /// Whether the scorer asks all components, not the nearest alone.
    pub asks_all: bool,
    /// The components, in the template's order.
    pub components: Vec<ComponentData>,
}

/// A component of a template.
#[derive(Clone, Debug, Serialize)]
pub struct ComponentData {
    /// Its reference point.
    pub centre: [f64; 3],
    /// σ̂ in millimetres.
    pub sigma_hat_mm: f64,
    /// Its terms, or nodes.
    pub terms: usize,
    /// Bytes that these take.
    pub bytes: usize,
    /// Percent of the surface that it speaks for; where that was measured.
    pub spoken: Option<f64>,
    /// Percent of the training's test points in its care that it does not explain; where the template says so.
    pub unexplained: Option<f64>,
    /// Its colour on the page.
    pub colour: String,
}

/// The size of a template by part; together they are its size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Bytes {
    /// All of it.
    pub total: usize,
    /// Terms or nodes.
    pub terms: usize,
    /// The components' records.
    pub components: usize,
    /// Where components may speak.
    pub validity: usize,
    /// Header, name, precisions, quality, depth.
    pub other: usize,
}

impl Bytes {
    /// Of a template whose file has `total` bytes.
    #[must_use]
    pub fn of(template: &Template<'_>, total: usize) -> Self {
        let terms = template.terms_len();
        let components = template.component_count() * RECORD_LENGTH;
        let validity = template.validity_len();
        Self {
            total,
            terms,
            components,
            validity,
            other: total - terms - components - validity,
        }
    }
}

impl Content {
    /// Of a template whose file has `total` bytes, with the percent of the surface that each component speaks
    /// for.
    pub(super) fn new(template: &Template<'_>, total: usize, spoken: Option<&[f64]>) -> Self {
        let cost = template.cost();
        let millimetres = f64::from(template.unit().millimetres());
        let quality = template.quality();
        let mut unexplained = quality.iter().flat_map(Quality::unexplained);
        let exact = !template.has_maps() && !template.has_compact_terms();
        Self {
            name: template.name().to_owned(),
            unit: template.unit().symbol(),
            millimetres,
            diameter: f64::from(template.diameter()),
            radius: f64::from(template.radius()),
            kernel: template.kernel().name(),
            metric: template.metric().name(),
            encoding: match (template.has_maps(), exact) {
                (true, _) => "map",
                (_, true) => "exact",
                _ => "compact",
            },
            elements: elements(template),
            counted: counted(template),
            validity: template.has_validity(),
            bytes: Bytes::of(template, total),
            deviation: quality
                .filter(|_| !exact)
                .map(|quality| [quality.deviation_rms, quality.deviation_max].map(f64::from)),
            cost: [Assignment::Nearest, Assignment::Maximum].map(|rule| cost.of(rule)),
            asks_all: Settings::for_template(template, 1.0).assignment != Assignment::Nearest,
            components: template
                .components()
                .enumerate()
                .map(|(index, component)| ComponentData {
                    centre: component.centre.map(f64::from),
                    sigma_hat_mm: millimetres * f64::from(component.sigma_hat),
                    terms: component.terms.len(),
                    bytes: terms_len(&component),
                    spoken: spoken.and_then(|shares| shares.get(index).copied()),
                    unexplained: unexplained.next().map(|share| 100.0 * f64::from(share)),
                    colour: colours::hex(colours::component(index)),
                })
                .collect(),
        }
    }
}

/// Bytes of a component's terms or nodes (`docs/FORMAT.md`).
fn terms_len(component: &Component<'_>) -> usize {
    let count = component.terms.len();
    if component.terms.map().is_some() {
        20 + count
    } else if component.terms.compact_scale().is_some() {
        4 + 5 * count
    } else {
        16 * count
    }
}
