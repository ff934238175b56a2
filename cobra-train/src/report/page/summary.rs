//! The head of the page, what is covered, and how the page was made.

use super::super::verdict::{share, verdict};
use super::{ReportData, table};
use crate::digits::{grouped, short};
use maud::{Markup, html};

pub(super) fn header(data: &ReportData) -> Markup {
    let content = &data.content;
    html! {
        header {
            p.kicker { "COBRA shape template" }
            h1 { (content.name) }
            p.facts {
                span { "diameter " (short(content.diameter)) " " (content.unit) }
                span { (content.components.len()) " components" }
                span { (grouped(content.bytes.total as u64)) " bytes, " (content.encoding) " " (content.elements) }
                span { (content.kernel) ", " (content.metric) " metric" }
                span { "lengths in " (content.unit) }
            }
        }
    }
}

pub(super) fn verdict_section(data: &ReportData) -> Markup {
    let verdict = verdict(data);
    let covered = data.coverage.covered;
    html! {
        section.verdict aria-labelledby="verdict" {
            h2 #verdict { (verdict.headline) }
            @if let Some(covered) = covered {
                div.bar role="img" aria-label={ (share(covered)) " covered" } {
                    span.covered style={ "width:" (format!("{covered:.3}")) "%" } {}
                }
            }
            ul { @for sentence in &verdict.sentences { li { (sentence) } } }
            (tiles(data))
        }
    }
}

/// The few numbers that are looked for first.
fn tiles(data: &ReportData) -> Markup {
    let mut tiles: Vec<(&str, String, String)> = Vec::new();
    if let Some(own) = &data.coverage.own {
        tiles.push((
            "residual, median",
            format!("{} mm", short(own.residual_mm.median)),
            format!("95 % within {} mm", short(own.residual_mm.p95)),
        ));
        tiles.push((
            "F-score",
            format!("{:.1} %", own.shape.f_score),
            format!("τ = {} mm", short(data.coverage.tau_mm)),
        ));
        tiles.push((
            "wrongly accepted",
            format!("{:.2} %", own.wrongly_accepted.percent),
            "of points off the surface".to_owned(),
        ));
    }
    let mut sigmas: Vec<f64> = data
        .content
        .components
        .iter()
        .map(|one| one.sigma_hat_mm)
        .collect();
    sigmas.sort_by(f64::total_cmp);
    if let (Some(least), Some(most)) = (sigmas.first(), sigmas.last()) {
        tiles.push((
            "σ̂ of components",
            format!("{} mm", short(sigmas[sigmas.len() / 2])),
            format!("{} to {} mm", short(*least), short(*most)),
        ));
    }
    tiles.push((
        "size",
        format!("{} B", grouped(data.content.bytes.total as u64)),
        format!("{} components", data.content.components.len()),
    ));
    html! {
        dl.tiles {
            @for (name, value, below) in &tiles {
                div { dt { (name) } dd { (value) } dd.below { (below) } }
            }
        }
    }
}

pub(super) fn coverage(data: &ReportData) -> Markup {
    let tau = short(data.coverage.tau_mm);
    let unit = data.content.unit;
    html! {
        section aria-labelledby="coverage" {
            h2 #coverage { "Coverage" }
            p {
                "A place is covered where the template's distance is right to within τ = " (tau) " mm, a hundredth "
                "of the bounding sphere's radius. τ is the measure of this page, not the tolerance that poses are "
                "accepted with. Scoring takes a point without a covering component for improbable."
            }
            @match &data.coverage.own {
                None => p.hint { "Given " code.option { "--mesh" } ", this page measures coverage on fresh points of the surface, and shows where it is missing." },
                Some(own) => {
                    @if own.regions.is_empty() {
                        p { "No place of a thousandth of the surface or more is left uncovered"
                            @if own.scattered > 0.0 { ", " (share(own.scattered)) " in smaller ones" } "." }
                    } @else {
                        (table("Places that are not covered, the largest first",
                            html! { tr { th scope="col" { "share of the surface" } th scope="col" { "middle (" (unit) ")" } th scope="col" { "reach (" (unit) ")" } th.screen { span.hidden { "in the view" } } } },
                            html! { @for region in own.regions.iter().take(MOST_REGIONS) {
                                tr {
                                    td { (share(region.percent)) }
                                    td { (region.centre.map(short).join(", ")) }
                                    td { (short(region.reach)) }
                                    td.screen { button.show type="button" hidden data-at=(region.centre.map(|c| c.to_string()).join(" ")) { "show" } }
                                }
                            } }))
                        @let more = own.regions.len().saturating_sub(MOST_REGIONS);
                        @if more > 0 || own.scattered > 0.0 {
                            p.hint {
                                @if more > 0 { (more) " more of a thousandth or more. " }
                                @if own.scattered > 0.0 { (share(own.scattered)) " in smaller places." }
                            }
                        }
                    }
                    (figures(data, own))
                }
            }
        }
    }
}

/// So many places are listed.
const MOST_REGIONS: usize = 8;

fn figures(data: &ReportData, own: &super::super::Own) -> Markup {
    let shape = &own.shape;
    let residual = &own.residual_mm;
    let mut rows = vec![
        (
            "covered",
            data.coverage
                .covered
                .map_or_else(String::new, |covered| format!("{covered:.2} %")),
            "points with a residual of at most τ".to_owned(),
        ),
        (
            "F-score",
            format!("{:.2} %", shape.f_score),
            format!(
                "of precision {:.2} % and recall {:.2} %",
                shape.precision, shape.recall
            ),
        ),
        (
            "Chamfer distance",
            format!("{:.4}", shape.chamfer),
            "times 1000, in the unit sphere".to_owned(),
        ),
        (
            "residual",
            format!("{} mm rms", short(residual.rms)),
            format!(
                "median {} mm, 95 % within {} mm",
                short(residual.median),
                short(residual.p95)
            ),
        ),
        (
            "wrongly accepted",
            format!("{:.2} %", own.wrongly_accepted.percent),
            format!(
                "of {} points that are 2 to 5 % of the radius off the surface",
                grouped(own.wrongly_accepted.points as u64)
            ),
        ),
    ];
    if let Some(cloud) = &own.own_cloud {
        rows.push(("self F", format!("{:.2} %", cloud.self_f_score), format!("of {} points that the template itself predicts: {:.2} % on the surface, which they cover to {:.2} %", grouped(cloud.points as u64), cloud.self_precision, cloud.self_recall)));
    }
    rows.push((
        "no component speaks",
        format!("{}", own.unmatched),
        format!("of {} points", grouped(own.points as u64)),
    ));
    table(
        "Measured on the object, as cobra eval does",
        html! { tr { th scope="col" { "figure" } th scope="col" { "value" } th.text scope="col" { "of what" } } },
        html! { @for (name, value, of) in &rows { tr { th scope="row" { (name) } td { (value) } td.text { (of) } } } },
    )
}

pub(super) fn made(data: &ReportData) -> Markup {
    let made = &data.made;
    html! {
        section aria-labelledby="made" {
            h2 #made { "How this page was made" }
            pre.command tabindex="0" aria-label="The command that made this page" { code { (made.command) } }
            dl.made {
                div { dt { "cobra" } dd { (made.version) } }
                div { dt { "CRC-32 of the template" } dd { code { (format!("{:08x}", made.checksum)) } } }
                div { dt { "seed" } dd { (made.seed) } }
            }
            p.hint { "The same template, mesh and options give the same page, byte by byte. What each number means and does not mean: docs/REPORT.md of the COBRA repository." }
        }
    }
}
