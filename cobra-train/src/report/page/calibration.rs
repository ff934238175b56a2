//! Thresholds with what they were measured on, and poses that shape cannot tell apart.

use super::{ReportData, table};
use crate::digits::{grouped, short};
use maud::{Markup, html};

pub(super) fn section(data: &ReportData) -> Markup {
    let calibration = data
        .depth
        .as_ref()
        .and_then(|depth| depth.calibration.as_ref());
    html! {
        section aria-labelledby="calibration" {
            h2 #calibration { "Thresholds" }
            @if let Some(depth) = &data.depth {
                p { "Against depth the template takes measurements for good to " (short(depth.noise_mm)) " mm (σ_m)." }
            }
            @match calibration {
                None => p.hint { "It stores no thresholds with a false-accept rate. " code { "cobra calibrate" } " finds and stores them, from labelled or simulated estimates." },
                Some(calibration) => {
                    @let [found, low, high] = calibration.false_accepts;
                    (table("Thresholds on the confidence against depth",
                        html! { tr { th scope="col" { "figure" } th scope="col" { "value" } th.text scope="col" { "of what" } } },
                        html! {
                            tr { th scope="row" { "accepted" } td { "≥ " (format!("{:.4}", calibration.accept)) } td.text { "the least confidence that is accepted" } }
                            tr { th scope="row" { "rejected" } td { "< " (format!("{:.4}", calibration.reject)) } td.text { @if calibration.reject < calibration.accept { "between both the answer is undecided, as with fewer than " } @else { "the answer is undecided with fewer than " } (calibration.minimum_points) " pixels" } }
                            tr { th scope="row" { "wrong, accepted" } td { (format!("{found:.2} %")) } td.text { "interval " (format!("{low:.2} to {high:.2} %")) " (Wilson, 95 %); aimed at " (format!("{:.2} %", calibration.target)) } }
                            tr { th scope="row" { "measured on" } td { (grouped(u64::from(calibration.wrong) + u64::from(calibration.right))) } td.text { (grouped(u64::from(calibration.wrong))) " wrong and " (grouped(u64::from(calibration.right))) " right " (calibration.source) " estimates" @if !calibration.provenance.is_empty() { ": " (calibration.provenance) } } }
                        }))
                    @if calibration.source == "simulated" {
                        p.hint { "Simulated estimates have the errors that somebody chose; another estimator makes others." }
                    }
                    @if data.curves.is_empty() {
                        p.hint { "Its curves are shown where the folder that " code { "cobra calibrate --curves DIR" } " wrote is given with " code.option { "--curves DIR" } "." }
                    } @else {
                        div.curves { @for curve in &data.curves {
                            figure { img src=(curve.address) alt=(curve.title); figcaption { (curve.title) "." } }
                        } }
                    }
                }
            }
        }
    }
}

/// So many are listed.
const MOST: usize = 12;

pub(super) fn ambiguities(data: &ReportData) -> Markup {
    html! {
        section aria-labelledby="ambiguities" {
            h2 #ambiguities { "Poses that look alike" }
            @match &data.ambiguities {
                None => p.hint { "Wrong poses that are accepted like the right one are found by " code { "cobra ambiguity FILE.cobra --mesh MESH --json FILE.json" } "; given with " code.option { "--ambiguity FILE.json" } ", this page shows them." },
                Some(report) => {
                    @if !report.found.is_empty() {
                        @let stated = report.found.iter().any(|found| found.stated.is_some());
                        (table("Motions after which the object is accepted",
                            html! { tr { th.text scope="col" { "motion" } th scope="col" { "views" } th scope="col" { "confidence" } th scope="col" { "ADD (mm)" } th scope="col" { "ADD-S (mm)" } th scope="col" { "MSSD (mm)" } @if stated { th scope="col" { "stated" } } } },
                            html! { @for found in report.found.iter().take(MOST) { tr {
                                th.text scope="row" { (found.motion) }
                                td { (found.views) " of " (report.views) }
                                td { (format!("{:.3}", found.confidence)) }
                                @for length in [found.add_mm, found.add_s_mm, found.mssd_mm] { td { (format!("{length:.1}")) } }
                                @if stated { td { @match found.stated { Some(true) => "yes", Some(false) => "no", None => "" } } }
                            } } }))
                        @let more = report.found.len().saturating_sub(MOST);
                        @if more > 0 { p.hint { "And " (more) " more, in as many views or fewer." } }
                    }
                    @for line in report.conclusion.lines() { p { (line) } }
                    p.hint {
                        "Looked for in " (report.views) " views with " (grouped(report.candidates as u64)) " rotations each; wrong from an ADD of "
                        (format!("{:.1} mm", report.limit_mm)) " on. The right poses have a confidence of "
                        (format!("{:.3}", report.true_confidence)) " on the mean; accepted was from "
                        (format!("{:.3}", report.accepted_from)) " on, "
                        @if report.calibrated { "the template's threshold." } @else { "a share of the right pose's confidence." }
                    }
                }
            }
        }
    }
}
