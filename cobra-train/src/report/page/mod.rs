//! The page as HTML.
//!
//! Owns the order of the sections and what every page has: style, script, data, and the rule that nothing is
//! loaded from elsewhere, which the page states to the browser too. Text is escaped by `maud`.

mod calibration;
mod components;
mod figure;
mod size;
mod summary;

use super::ReportData;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("../../../assets/report.css");
const VIEWER: &str = include_str!("../../../assets/viewer/viewer.min.js");

/// Scripts and styles of the page itself, images that it contains, and nothing else.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; \
                      img-src data:; base-uri 'none'; form-action 'none'";

/// The page, whole: one file that needs no other. The same data gives the same bytes.
///
/// # Errors
/// A number that JSON cannot hold.
pub fn html(data: &ReportData) -> Result<String, serde_json::Error> {
    let content = &data.content;
    let json = json(data)?;
    let buffers = &data.view.buffers;
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (content.name) " · COBRA template" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                (summary::header(data))
                main {
                    (summary::verdict_section(data))
                    (figure::section(data))
                    (summary::coverage(data))
                    (components::section(data))
                    (size::size(data))
                    (size::budget(data))
                    (calibration::section(data))
                    (calibration::ambiguities(data))
                    (summary::made(data))
                }
                script type="application/json" id="report-data" { (PreEscaped(json)) }
                @for (id, base64) in [
                    ("view-positions", &buffers.positions),
                    ("view-residuals", &buffers.residuals),
                    ("view-components", &buffers.components),
                    ("view-indices", &buffers.indices),
                ] {
                    script type="text/plain" id=(id) { (PreEscaped(base64)) }
                }
                script { (PreEscaped(VIEWER)) }
            }
        }
    };
    Ok(page.into_string() + "\n")
}

/// JSON that ends no element, whatever names are in it.
fn json(data: &ReportData) -> Result<String, serde_json::Error> {
    Ok(serde_json::to_string(data)?.replace('<', "\\u003c"))
}

/// A table in a box of its own, which scrolls where the page is narrow.
fn table(caption: &str, head: Markup, rows: Markup) -> Markup {
    html! {
        div.table tabindex="0" role="region" aria-label=(caption) {
            table {
                caption { (caption) }
                thead { (head) }
                tbody { (rows) }
            }
        }
    }
}

/// A square of a colour, for a legend.
fn chip(colour: &str) -> Markup {
    html! { span.chip style={ "background:" (colour) } {} }
}
