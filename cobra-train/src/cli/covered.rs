//! How `cobra train` tells what a template covers, what it leaves open and where.

use super::report::plural;
use cobra_infer::Template;
use cobra_train::digits::short;
use cobra_train::evaluate::TAU;
use cobra_train::train::{Deviation, Trained, UncoveredRegion};
use serde::Serialize;

/// Regions that are told of in the text; JSON has all.
const REGIONS: usize = 3;

/// Smaller shares are not worth a line.
const SMALLEST_SHARE: f64 = 0.001;

/// How far the compressed mean is from the exact one, in units of sigma-hat.
#[derive(Serialize)]
pub(super) struct DeviationDocument {
    max: f64,
    rms: f64,
}

impl From<Deviation> for DeviationDocument {
    fn from(Deviation { max, rms }: Deviation) -> Self {
        Self { max, rms }
    }
}

/// A part of the surface that no component reproduces, in the object's frame and unit.
#[derive(Serialize)]
pub(super) struct RegionDocument {
    centre: [f64; 3],
    reach: f64,
    percent: f64,
}

impl From<&UncoveredRegion> for RegionDocument {
    fn from(region: &UncoveredRegion) -> Self {
        Self {
            centre: region.centre.into(),
            reach: region.reach,
            percent: 100.0 * region.share,
        }
    }
}

/// With less of the surface covered, somebody may want to know what covers more.
const LITTLE: f64 = 0.99;

/// The lines below the template's.
pub(super) fn text(trained: &Trained, template: &Template<'_>) -> String {
    let unit = template.unit().symbol();
    let tau = TAU * f64::from(template.radius());
    let mut lines = vec![format!(
        "covered: {:.2} % of the surface, to within {} {unit}",
        100.0 * trained.covered,
        short(tau)
    )];
    let open = trained.uncovered.iter();
    for region in open
        .filter(|region| region.share >= SMALLEST_SHARE)
        .take(REGIONS)
    {
        let [x, y, z]: [f64; 3] = region.centre.into();
        lines.push(format!(
            "not covered: {:.1} % within {} {unit} of ({}, {}, {})",
            100.0 * region.share,
            short(region.reach),
            short(x),
            short(y),
            short(z)
        ));
    }
    if trained.left_out > 0 {
        lines.push(format!(
            "left out: {}, to fit the budget",
            plural(trained.left_out, "component")
        ));
    }
    if trained.covered < LITTLE && template.has_compact_terms() {
        lines.push("more may be covered with --budget none".to_owned());
    }
    if let Some(deviation) = &trained.deviation {
        let how = if template.has_maps() {
            "baked"
        } else {
            "compressed"
        };
        lines.push(format!(
            "{how}: {:.2} sigma-hat rms from the exact Gaussian process, {:.1} at most",
            deviation.rms, deviation.max
        ));
    }
    lines.join("\n")
}
