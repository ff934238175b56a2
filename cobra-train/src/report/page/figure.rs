//! The 3-D view with its choices and legends.

use super::super::verdict::share;
use super::{ReportData, chip};
use crate::digits::short;
use maud::{Markup, html};

pub(super) fn section(data: &ReportData) -> Markup {
    let view = &data.view;
    let choices = [
        ("residual", "Residual", view.measured),
        ("component", "Component", true),
        ("coverage", "Coverage", view.measured),
    ];
    let first = if view.measured {
        "residual"
    } else {
        "component"
    };
    let label = format!(
        "{} in three dimensions. Arrow keys turn it, plus and minus bring it nearer and farther, Home resets the view.",
        data.content.name
    );
    html! {
        section.view aria-labelledby="view" {
            h2.hidden #view { "The object, to turn" }
            figure {
                div.controls {
                    fieldset {
                        legend.hidden { "Colour the surface by" }
                        @for (value, name, possible) in choices {
                            label {
                                input type="radio" name="view" value=(value) checked[value == first] disabled[!possible];
                                span { (name) }
                            }
                        }
                    }
                }
                div #stage {
                    div.corner {
                        label { "up " select #up { @for axis in ["z", "y", "x"] { option { (axis) } } } }
                        button #reset type="button" { "Reset view" }
                    }
                    canvas #canvas tabindex="0" role="img" aria-label=(label) {}
                    p.fallback { "The picture that one can turn needs JavaScript and WebGL. Everything else on this page does not." }
                }
                @if view.measured {
                    div.legend data-legend="residual" { (residual_legend(data)) }
                    div.legend data-legend="coverage" hidden { (coverage_legend(data)) }
                }
                div.legend data-legend="component" hidden[view.measured] { (component_legend(data)) }
                p #readout {
                    "Point at the surface, or tap it, to read a place."
                }
                figcaption {
                    (view.remark)
                    span.screen { " Drag, or use the arrow keys, to turn; scroll to come nearer." }
                    @if !view.measured { " Residuals and coverage need " code.option { "--mesh" } "." }
                }
            }
        }
    }
}

/// The part of the ramp that a length in mm has, and beyond it.
fn residual_legend(data: &ReportData) -> Markup {
    let tau = data.coverage.tau_mm;
    let ramp = data.view.ramp().join(",");
    html! {
        div.ramp {
            span style={ "background:linear-gradient(to right," (ramp) ")" } {}
            div.ticks { @for part in 0..=4 { span { (short(tau * f64::from(part) / 4.0)) } } }
        }
        p { "distance from what the template says, in mm" }
        p { (chip(data.view.uncovered())) "more than " (short(tau)) " mm, or no component speaks: not covered" }
    }
}

fn coverage_legend(data: &ReportData) -> Markup {
    let covered = data.coverage.covered.unwrap_or_default();
    html! {
        p { (chip(data.view.covered())) "covered, " (share(covered)) }
        p { (chip(data.view.uncovered())) "not covered, " (share(100.0 - covered)) }
    }
}

fn component_legend(data: &ReportData) -> Markup {
    html! {
        p { "Each component in its colour; the balls are the reference points that it measures distances from, which may lie outside." }
        p.chips { @for (index, component) in data.content.components.iter().enumerate() {
            span { (chip(&component.colour)) (index) }
        } }
    }
}
