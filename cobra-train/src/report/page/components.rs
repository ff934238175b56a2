//! σ̂ of each component.

use super::{ReportData, chip, table};
use crate::digits::{grouped, short};
use maud::{Markup, html};

pub(super) fn section(data: &ReportData) -> Markup {
    let content = &data.content;
    let most = content
        .components
        .iter()
        .map(|one| one.sigma_hat_mm)
        .fold(0.0, f64::max);
    let spoken = content.components.iter().any(|one| one.spoken.is_some());
    let unexplained = content
        .components
        .iter()
        .any(|one| one.unexplained.is_some());
    let heads = ["", "σ̂ (mm)"];
    let caption = format!("σ̂ of each component; reference points in {}", content.unit);
    html! {
        section aria-labelledby="components" {
            h2 #components { "Components" }
            p {
                "σ̂ is the rms residual of a component on points that training did not see"
                @if content.validity { ", those that it explains to within τ" }
                ": how well it knows its "
                "part of the surface. It does not know your camera; scoring adds that with "
                code.option { "--noise" } "."
            }
            (table(&caption,
                html! { tr {
                    @for head in heads { th scope="col" { (head) } }
                    @if spoken { th scope="col" { "share of the surface" } }
                    @if unexplained { th scope="col" { "not explained" } }
                    th scope="col" { (content.elements) }
                    th scope="col" { "bytes" }
                    th scope="col" { "reference point" }
                } },
                html! { @for (index, component) in content.components.iter().enumerate() { tr {
                    th.name scope="row" { (chip(&component.colour)) (index) }
                    td.sigma {
                        (short(component.sigma_hat_mm))
                        span.track { span style={ "width:" (format!("{:.2}", 100.0 * component.sigma_hat_mm / most)) "%" } {} }
                    }
                    @if spoken { td { @if let Some(spoken) = component.spoken { (format!("{spoken:.1} %")) } } }
                    @if unexplained { td { @if let Some(share) = component.unexplained { (format!("{share:.2} %")) } } }
                    td { (grouped(component.terms as u64)) }
                    td { (grouped(component.bytes as u64)) }
                    td.point { (component.centre.map(short).join(", ")) }
                } } }))
            @if unexplained {
                p.hint { "Not explained: of the points in a component's care, those that it is off by more than τ, as training found." }
            }
        }
    }
}
