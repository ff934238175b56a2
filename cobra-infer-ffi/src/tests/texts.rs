//! The texts, and that the header and `docs/C.md` list what there is.

use crate::status::CobraStatus;
use crate::strings::{
    cobra_decision_string, cobra_reason_string, cobra_status_string, decision_text, reason_text,
};
use crate::types::{CobraReason, decision};
use cobra_infer::{Decision, Doubt, Rejection};
use core::ffi::CStr;
use std::collections::HashSet;

const HEADER: &str = include_str!("../../include/cobra_infer.h");
const PAGE: &str = include_str!("../../../docs/C.md");

/// As the header writes it.
fn name(status: CobraStatus) -> String {
    let mut name = String::from("COBRA_STATUS");
    for letter in format!("{status:?}").chars() {
        if letter.is_ascii_uppercase() {
            name.push('_');
        }
        name.push(letter.to_ascii_uppercase());
    }
    name
}

#[test]
fn every_status_has_a_text_of_its_own() {
    let mut texts = HashSet::new();
    for status in CobraStatus::ALL {
        let text = unsafe { CStr::from_ptr(cobra_status_string(status as u32)) };
        assert_eq!(text, status.text());
        assert!(!text.is_empty() && texts.insert(text), "{status:?}");
        assert_eq!(CobraStatus::from_number(status as u32), Some(status));
    }
    for number in [8, 99, 138, 410, 506, u32::MAX] {
        let text = unsafe { CStr::from_ptr(cobra_status_string(number)) };
        assert!(texts.insert(text) || text == c"unknown status");
    }
}

#[test]
fn the_header_and_the_page_list_every_status_and_no_other() {
    let listed = |text: &str, start: &str| text.lines().filter(|l| l.contains(start)).count();
    for status in CobraStatus::ALL {
        let line = format!("  {} = {},", name(status), status as u32);
        assert!(HEADER.contains(&line), "{line}");
        let text = status.text().to_str().unwrap();
        let row = format!("| {} | `{}` | {text} |", status as u32, name(status));
        assert!(PAGE.contains(&row), "{row}");
    }
    assert_eq!(listed(HEADER, "  COBRA_STATUS_"), CobraStatus::ALL.len());
    assert_eq!(listed(PAGE, " | `COBRA_STATUS_"), CobraStatus::ALL.len());
}

#[test]
fn decisions_and_reasons_have_the_texts_of_rust() {
    let decisions = [
        Decision::Accept,
        Decision::Reject(Rejection::BelowThreshold),
        Decision::Reject(Rejection::NoSupport),
        Decision::Reject(Rejection::BehindCamera),
        Decision::Undecided(Doubt::TooFewPoints),
        Decision::Undecided(Doubt::NoWeight),
        Decision::Undecided(Doubt::NonFiniteInput),
        Decision::Undecided(Doubt::NegativeWeight),
        Decision::Undecided(Doubt::NoThreshold),
        Decision::Undecided(Doubt::Hidden),
        Decision::Undecided(Doubt::NotCalibrated),
        Decision::Undecided(Doubt::BetweenThresholds),
    ];
    // In the order of the numbers behind `NotScored`.
    for (number, rust) in (1..).zip(decisions) {
        let (decision, reason) = decision(rust);
        assert_eq!(reason as u32, number);
        assert_eq!(decision_text(decision as u32).to_str(), Ok(rust.name()));
        assert_eq!(reason_text(number).to_str(), Ok(rust.reason()));
    }
    assert_eq!(decisions.len(), CobraReason::BetweenThresholds as usize);
    for number in [13, u32::MAX] {
        assert!(!cobra_decision_string(number).is_null());
        assert_eq!(reason_text(number), c"unknown reason");
        assert!(!cobra_reason_string(number).is_null());
    }
}
