//! Size by part, and what a template takes on controllers.

use super::super::budget::compiler;
use super::{ReportData, table};
use crate::digits::grouped;
use maud::{Markup, html};

/// As many correspondences as milliseconds are told of.
const CORRESPONDENCES: f64 = 500.0;

/// The components that the measured scorers have room for.
const ROOM: usize = 16;

pub(super) fn size(data: &ReportData) -> Markup {
    let content = &data.content;
    let bytes = &content.bytes;
    let parts = [
        (content.elements, bytes.terms),
        ("components' records", bytes.components),
        ("where components may speak", bytes.validity),
        ("the rest", bytes.other),
    ];
    let percent = |part: usize| 100.0 * part as f64 / bytes.total.max(1) as f64;
    let [nearest, all] = content.cost.map(|cost| grouped(cost as u64));
    html! {
        section aria-labelledby="size" {
            h2 #size { "Size and cost" }
            (table("Bytes of the template by part",
                html! { tr { th scope="col" { "part" } th scope="col" { "bytes" } th scope="col" { "share" } } },
                html! {
                    @for (name, part) in parts { tr {
                        th scope="row" { (name) }
                        td { (grouped(part as u64)) }
                        td.sigma { (format!("{:.1} %", percent(part))) span.track { span style={ "width:" (format!("{:.2}", percent(part))) "%" } {} } }
                    } }
                    tr.sum { th scope="row" { "all" } td { (grouped(bytes.total as u64)) } td {} }
                }))
            p {
                "A point costs at most " (if content.asks_all { &all } else { &nearest }) " " (content.counted)
                @if content.asks_all { " (" (nearest) " where the nearest component alone is asked)" } "."
                @if let Some([rms, most]) = content.deviation {
                    " Compression moved the mean by " (format!("{rms:.2}")) " σ̂ rms, " (format!("{most:.1}")) " at most."
                }
            }
        }
    }
}

pub(super) fn budget(data: &ReportData) -> Markup {
    let count = |number: f64| grouped(number.round().max(0.0) as u64);
    let milliseconds = |instructions: f64, megahertz: f64| {
        let time = CORRESPONDENCES * instructions / (1e3 * megahertz);
        if time < 10.0 {
            format!("{time:.1}")
        } else {
            grouped(time.round() as u64)
        }
    };
    let known = data.budget.iter().any(|one| one.instructions.is_some());
    let mean = data
        .budget
        .iter()
        .any(|one| one.instructions.is_some_and(|of| of.mean.is_some()));
    let caption = format!(
        "Scoring with this template on controllers; built by {}, opt-level s",
        compiler()
    );
    html! {
        section aria-labelledby="budget" {
            h2 #budget { "On a controller" }
            (table(&caption,
                html! {
                    tr {
                        th scope="col" rowspan="2" { "target" }
                        th scope="colgroup" colspan="2" { "scoring (bytes)" }
                        th scope="colgroup" colspan="2" { "with depth (bytes)" }
                        @if known {
                            th scope="colgroup" colspan=(1 + usize::from(mean)) { "instructions a point" }
                            th scope="colgroup" colspan=(1 + usize::from(mean)) { "ms for 500 points" }
                        }
                    }
                    tr {
                        th scope="col" { "code" } th scope="col" { "stack" }
                        th scope="col" { "code" } th scope="col" { "stack" }
                        @if known {
                            @if mean { th scope="col" { "mean" } }
                            th scope="col" { "most" }
                            @if mean { th scope="col" { "mean" } }
                            th scope="col" { "most" }
                        }
                    }
                },
                html! { @for row in &data.budget { @let board = &row.board; tr {
                    th.target scope="row" { code { (board.target) } br; span.hint { (row.processor.0) } }
                    @for bytes in [board.code, board.stack, board.depth_code, board.depth_stack] { td { (grouped(u64::from(bytes))) } }
                    @if let Some(of) = row.instructions { @let clock = row.processor.1;
                        @if let Some(mean) = of.mean { td { (count(mean)) } }
                        td { (count(of.most)) }
                        @if let Some(mean) = of.mean { td { (milliseconds(mean, clock)) } }
                        td { (milliseconds(of.most, clock)) }
                    }
                } } }))
            p.hint {
                "Code and stack are of this library on that board, with room for " (ROOM) " components"
                @let components = data.content.components.len();
                @if components > ROOM { ": for this template's " (components) " a scorer needs more room, and more stack, than is told here" }
                "; the template's "
                (grouped(data.content.bytes.total as u64)) " bytes of flash come on top, and it is read where it lies. "
                @if known {
                    "Instructions are as QEMU executes them, not cycles: the milliseconds take one a cycle at a clock "
                    "that is common for such a processor, and flash that makes it wait adds to them. "
                    "Most is what " code { "Template::cost()" } " promises of any point"
                    @if mean { "; mean is over points of the surface, with every component that may speak in their "
                        "directions, of which the scorer leaves some out" }
                    "."
                    @if data.content.encoding == "compact" { " Compact terms take some instructions more, four each on the Cortex-M4F." }
                } @else {
                    "Instructions of a point were measured for the rational quadratic's terms with exponents 1 and ½ alone; "
                    "this template has others, or maps, which take less: docs/BENCHMARKS.md of the repository."
                }
            }
        }
    }
}
