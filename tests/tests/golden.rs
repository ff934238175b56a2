//! Recorded templates still load, and still score the recorded bits.
//!
//! When this fails, a template in the field would score differently than it did when it was
//! accepted. Find the change that did it and take it back, or make it on purpose: bump the format's
//! version (`docs/FORMAT.md`), keep these files as what the new version must refuse, add new ones
//! under the new version's name to `make-golden`, and say so in the changelog. Never train these
//! templates again, and never record their scores again, to make this pass.

use cobra_agreement::golden::{GOLDEN, Golden, Mismatch, replay};
use cobra_infer::{Kernel, Metric, Template};

#[test]
fn recorded_templates_score_the_recorded_bits() {
    for golden in GOLDEN {
        let replayed = replay(golden.template, golden.vectors);
        assert_eq!(replayed, Ok(golden.cases), "{}", golden.name);
    }
}

#[test]
fn every_kernel_metric_kind_assignment_likelihood_and_threshold_is_recorded() {
    let templates: Vec<Template<'_>> = GOLDEN
        .iter()
        .map(|golden| Template::from_bytes(golden.template).unwrap())
        .collect();
    for kernel in Kernel::ALL {
        assert!(templates.iter().any(|template| template.kernel() == kernel));
    }
    for metric in Metric::ALL {
        assert!(templates.iter().any(|template| template.metric() == metric));
    }
    for kind in [
        Template::has_precisions,
        Template::has_validity,
        Template::has_compact_terms,
        Template::has_maps,
    ] {
        assert!(templates.iter().any(kind));
    }
    for golden in GOLDEN {
        let own = GOLDEN.iter().filter(|o| o.template == golden.template);
        let lines = own.flat_map(|golden| golden.vectors.lines());
        let cases: Vec<&str> = lines.filter(|line| line.starts_with("case")).collect();
        for assignment in ["nearest", "maximum", "soft"] {
            for likelihood in ["peak", "density"] {
                let words = format!("case {assignment} {likelihood} ");
                let of_both: Vec<_> = cases.iter().filter(|c| c.starts_with(&words)).collect();
                assert!(!of_both.is_empty(), "{words}");
                for threshold in [" mean", " worst"] {
                    assert!(
                        of_both.iter().any(|case| case.ends_with(threshold)),
                        "{words}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_records_hold_every_kind_of_decision_that_finite_weights_allow() {
    let lines = GOLDEN.iter().flat_map(|golden| golden.vectors.lines());
    let reports: Vec<&str> = lines.filter(|line| line.starts_with("report")).collect();
    for decision in [
        "accept",
        "below-threshold",
        "no-support",
        "behind-camera",
        "too-few-points",
        "non-finite-input",
    ] {
        let recorded = reports.iter().any(|report| report.ends_with(decision));
        assert!(recorded, "{decision}");
    }
}

#[test]
fn every_changed_digit_of_a_record_is_noticed() {
    let Golden {
        template, vectors, ..
    } = GOLDEN[0];
    let start = vectors.find("\nlikelihoods").unwrap() + 1;
    let end = start + vectors[start..].find("\ncase").unwrap();
    for (place, _) in vectors[start..end].match_indices(|c: char| c.is_ascii_digit()) {
        let mut changed = vectors.as_bytes().to_vec();
        let digit = &mut changed[start + place];
        *digit = if *digit == b'0' { b'1' } else { b'0' };
        let changed = String::from_utf8(changed).unwrap();
        assert!(matches!(
            replay(template, &changed),
            Err(Mismatch::Differs { .. })
        ));
    }
}

#[test]
fn a_golden_template_that_is_damaged_is_not_scored() {
    for golden in GOLDEN {
        let mut changed = golden.template.to_vec();
        let last = changed.len() - 4;
        changed[last] ^= 1;
        assert_eq!(
            replay(&changed, golden.vectors),
            Err(Mismatch::Unreadable { line: 0 })
        );
    }
}
