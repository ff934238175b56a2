//! What follows from the numbers, in words: the head of the page.
//!
//! Owns what is promised and what is not. A share that was measured is told with what it was measured on, and
//! what nobody looked for is said to be unknown.

use super::ReportData;
use super::coverage::{Coverage, Own};
use crate::digits::{grouped, short};

/// The head of the page: the first sentence, and those below it.
pub(super) struct Verdict {
    pub(super) headline: String,
    pub(super) sentences: Vec<String>,
}

/// Of what the page says.
pub(super) fn verdict(data: &ReportData) -> Verdict {
    let coverage = &data.coverage;
    let tau = short(coverage.tau_mm);
    let headline = match coverage.covered {
        // What was asked were points: another one may be open.
        Some(100.0) => format!("Covers the surface to within {tau} mm wherever it was measured."),
        Some(covered) => format!(
            "Covers {} of the surface to within {tau} mm.",
            share(covered)
        ),
        None => "What it covers of the surface is not known.".to_owned(),
    };
    let sentences = [
        other_object(coverage),
        open(data),
        coverage.own.as_ref().map(|own| off_surface(coverage, own)),
        Some(thresholds(data)),
        Some(ambiguities(data)),
    ];
    Verdict {
        headline,
        sentences: sentences.into_iter().flatten().collect(),
    }
}

/// More percentage points than this between training and a page are not chance.
const OTHER_OBJECT: f64 = 5.0;

/// A doubt whether the mesh is the template's.
fn other_object(coverage: &Coverage) -> Option<String> {
    let (covered, trained) = (coverage.covered?, coverage.trained?);
    (trained - covered > OTHER_OBJECT).then(|| {
        format!(
            "Training found {} covered: is this the mesh that the template was trained from, in its unit and frame?",
            share(trained)
        )
    })
}

/// Percent, never rounded to all or to nothing.
pub(super) fn share(percent: f64) -> String {
    match percent {
        100.0 => "100 %".to_owned(),
        _ if percent > 99.95 => "more than 99.9 %".to_owned(),
        0.0 => "0 %".to_owned(),
        _ if percent < 0.05 => "less than 0.1 %".to_owned(),
        _ => format!("{percent:.1} %"),
    }
}

fn open(data: &ReportData) -> Option<String> {
    let coverage = &data.coverage;
    let open = 100.0 - coverage.covered?;
    let measured = match &coverage.own {
        Some(own) => format!(
            "Measured on {} points that training did not see.",
            grouped(own.points as u64)
        ),
        None => "Measured when it was trained; --mesh measures it anew and shows where.".to_owned(),
    };
    if open <= 0.0 {
        return Some(measured);
    }
    let place = coverage.own.as_ref().and_then(|own| own.regions.first());
    let place = place.map_or_else(String::new, |region| {
        format!(
            ", the largest place, {}, within {} {} of ({})",
            share(region.percent),
            short(region.reach),
            data.content.unit,
            region.centre.map(short).join(", ")
        )
    });
    Some(format!(
        "{}{place}: a pose that shows mainly such places cannot be checked. {measured}",
        match share(open).as_str() {
            text if text.starts_with("less") => "Less than 0.1 % is not covered".to_owned(),
            text => format!("{text} is not covered"),
        },
    ))
}

fn off_surface(coverage: &Coverage, own: &Own) -> String {
    let [near, far] = [2.0, 5.0].map(|taus| short(taus * coverage.tau_mm));
    format!(
        "Of points truly {near} to {far} mm off the surface it takes {} for points on it.",
        match own.wrongly_accepted.percent {
            0.0 => "none".to_owned(),
            percent => format!("{percent:.2} %"),
        }
    )
}

fn thresholds(data: &ReportData) -> String {
    let calibration = data
        .depth
        .as_ref()
        .and_then(|depth| depth.calibration.as_ref());
    match calibration {
        Some(calibration) => {
            let [found, low, high] = calibration.false_accepts;
            format!(
                "Its threshold for depth let {found:.2} % of {} {} wrong poses pass (interval {low:.2} to {high:.2} %).",
                grouped(u64::from(calibration.wrong)),
                calibration.source
            )
        }
        None => "It stores no thresholds for depth: how many wrong poses would pass is not known."
            .to_owned(),
    }
}

fn ambiguities(data: &ReportData) -> String {
    match &data.ambiguities {
        None => "Whether poses of this object look alike was not looked at here.".to_owned(),
        Some(report) if report.found.is_empty() => format!(
            "No wrong pose was found that {}, in {} views.",
            if report.calibrated {
                "the template's threshold accepts"
            } else {
                "scores nearly as well as the right one"
            },
            report.views
        ),
        Some(report) => {
            let worst = report
                .found
                .iter()
                .map(|found| found.add_mm)
                .fold(0.0, f64::max);
            let everywhere = report
                .found
                .iter()
                .filter(|found| found.views == report.views);
            let everywhere = match everywhere.count() {
                0 => String::new(),
                count => format!(", {count} of them in every view"),
            };
            let count = report.found.len();
            let (kinds, verb) = match count {
                1 => ("One kind of wrong pose".to_owned(), ["is", "scores"]),
                _ => (format!("{count} kinds of wrong poses"), ["are", "score"]),
            };
            let [is, scores] = verb;
            let what = if report.calibrated {
                format!("{is} accepted by the template's threshold")
            } else {
                format!("{scores} nearly as well as the right one")
            };
            format!("{kinds} {what}{everywhere}; up to {worst:.1} mm of ADD away.")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::share;

    #[test]
    fn a_share_is_never_rounded_to_all_or_to_nothing() {
        let said = [100.0, 99.97, 98.94, 0.02, 0.0].map(share);
        let expected = [
            "100 %",
            "more than 99.9 %",
            "98.9 %",
            "less than 0.1 %",
            "0 %",
        ];
        assert_eq!(said, expected);
    }
}
