//! The two thresholds for a target.

use super::rate::Rate;
use super::sweep::{Step, totals};
use super::{CalibrateError, Labelled, sweep};

/// What thresholds are asked to keep to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    /// The share of wrong estimates that may be accepted, above 0 and below 1.
    pub false_accepts: f64,
    /// The share of right estimates that may be rejected, above 0 and below 1.
    pub rejected_right: f64,
}

/// Two thresholds, and what they do to the estimates they were found on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// The least number that at most the share aimed at of the wrong estimates reach.
    pub accept: f32,
    /// The largest number below which at most the share aimed at of the right estimates lie, or `accept`
    /// where that is less.
    pub reject: f32,
    /// Wrong estimates that are accepted.
    pub false_accepts: Rate,
    /// Right ones that are.
    pub true_accepts: Rate,
    /// Wrong estimates that are rejected.
    pub rejected_wrong: Rate,
    /// Right ones that are.
    pub rejected_right: Rate,
}

/// The thresholds on the confidence that keep to `aim` on `labelled`.
///
/// The threshold to accept is a number of `f32`, not a confidence that occurs: it lies just above the
/// highest one that has to be left out. Estimates of equal confidence fall on the same side.
///
/// # Errors
/// [`CalibrateError`]: a share that is none, a confidence that is none, too few wrong or right estimates
/// to show what is aimed at, confidences that no threshold tells apart, and a target that only a threshold
/// keeps to that accepts nothing.
pub fn calibrate(labelled: &[Labelled], aim: Aim) -> Result<Thresholds, CalibrateError> {
    for (what, found) in [
        ("false-accept rate", aim.false_accepts),
        (
            "share of right estimates that may be rejected",
            aim.rejected_right,
        ),
    ] {
        if !(found > 0.0 && found < 1.0) {
            return Err(CalibrateError::Aim { what, found });
        }
    }
    for (index, estimate) in labelled.iter().enumerate() {
        let found = estimate.confidence;
        if !(0.0..=1.0).contains(&found) {
            return Err(CalibrateError::Confidence { index, found });
        }
    }
    let steps = sweep(labelled);
    let (wrong, right) = totals(&steps);
    enough("wrong", wrong, aim.false_accepts)?;
    enough("right", right, aim.rejected_right)?;
    if let [only] = steps[..] {
        return Err(CalibrateError::AllEqual {
            confidence: only.confidence,
            count: labelled.len(),
        });
    }
    let accept = accept(&steps, Rate::at_most(aim.false_accepts, wrong))?;
    let reject = reject(&steps, Rate::at_most(aim.rejected_right, right)).min(accept);
    let (accepted, kept) = (reached(&steps, accept), reached(&steps, reject));
    Ok(Thresholds {
        accept,
        reject,
        false_accepts: Rate {
            count: accepted.wrong,
            total: wrong,
        },
        true_accepts: Rate {
            count: accepted.right,
            total: right,
        },
        rejected_wrong: Rate {
            count: wrong - kept.wrong,
            total: wrong,
        },
        rejected_right: Rate {
            count: right - kept.right,
            total: right,
        },
    })
}

fn enough(kind: &'static str, found: usize, aim: f64) -> Result<(), CalibrateError> {
    let needed = Rate::least_total(aim);
    if found >= needed {
        return Ok(());
    }
    let none = Rate {
        count: 0,
        total: found,
    };
    Err(CalibrateError::TooFew {
        kind,
        found,
        provable: none.interval().high,
        aim,
        needed,
    })
}

/// The least threshold that at most `allowed` wrong estimates reach.
fn accept(steps: &[Step], allowed: usize) -> Result<f32, CalibrateError> {
    let Some(first_out) = steps.iter().position(|step| step.wrong > allowed) else {
        return Ok(0.0);
    };
    let Step {
        confidence, wrong, ..
    } = steps[first_out];
    if confidence >= 1.0 {
        return Err(CalibrateError::NoThreshold {
            count: wrong,
            allowed,
        });
    }
    // A zero of either sign is below the least positive number.
    let accept = (confidence + 0.0).next_up();
    if reached(steps, accept).right == 0 {
        let (wrong, _) = totals(steps);
        return Err(CalibrateError::AcceptsNothing {
            accept,
            allowed,
            wrong,
        });
    }
    Ok(accept)
}

/// The largest threshold below which at most `allowed` right estimates lie.
fn reject(steps: &[Step], allowed: usize) -> f32 {
    let (_, right) = totals(steps);
    let found = steps.iter().find(|step| right - step.right <= allowed);
    found.map_or(0.0, |step| step.confidence)
}

/// What a threshold accepts.
fn reached(steps: &[Step], threshold: f32) -> Step {
    let count = steps.partition_point(|step| step.confidence >= threshold);
    match count.checked_sub(1) {
        Some(last) => steps[last],
        None => Step {
            confidence: threshold,
            wrong: 0,
            right: 0,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AIM: Aim = Aim {
        false_accepts: 0.1,
        rejected_right: 0.1,
    };

    fn of(right: bool, confidences: impl IntoIterator<Item = f32>) -> Vec<Labelled> {
        confidences
            .into_iter()
            .map(|confidence| Labelled { confidence, right })
            .collect()
    }

    /// 100 wrong ones from 0 to 0.495, 50 right ones from 0.4 to 0.89.
    fn separated() -> Vec<Labelled> {
        let mut all = of(false, (0..100).map(|i| i as f32 / 200.0));
        all.extend(of(true, (0..50).map(|i| 0.4 + i as f32 / 100.0)));
        all
    }

    #[test]
    fn the_threshold_is_the_least_that_keeps_to_the_target() {
        let labelled = separated();
        let found = calibrate(&labelled, AIM).unwrap();
        let accepted = |threshold: f32| {
            let wrong = labelled.iter().filter(|estimate| !estimate.right);
            wrong
                .filter(|estimate| estimate.confidence >= threshold)
                .count()
        };
        assert_eq!(found.false_accepts.count, accepted(found.accept));
        assert_eq!(
            (accepted(found.accept), accepted(found.accept.next_down())),
            (10, 11)
        );
        assert_eq!(found.accept, (89.0_f32 / 200.0).next_up());
        assert_eq!(
            found.true_accepts,
            Rate {
                count: 45,
                total: 50
            }
        );
    }

    #[test]
    fn below_the_lower_threshold_lie_as_many_right_ones_as_may_and_no_more() {
        let found = calibrate(&separated(), AIM).unwrap();
        // Five of fifty lie below 0.45, which is more than the threshold to accept.
        assert_eq!(found.reject, found.accept);
        let strict = Aim {
            rejected_right: 0.08,
            ..AIM
        };
        let found = calibrate(&separated(), strict).unwrap();
        assert_eq!(
            found.rejected_right,
            Rate {
                count: 4,
                total: 50
            }
        );
        assert_eq!(found.reject, 0.4 + 4.0 / 100.0);
        assert_eq!(found.rejected_wrong.count, 88);
    }

    #[test]
    fn ties_fall_on_the_same_side() {
        let mut labelled = of(false, [0.2; 90]);
        labelled.extend(of(false, [0.6; 20]));
        labelled.extend(of(true, [0.6; 30]));
        labelled.extend(of(true, [0.9; 30]));
        let found = calibrate(&labelled, AIM).unwrap();
        // Eleven of the twenty may be accepted, but only all of them or none.
        assert_eq!(found.accept, 0.6_f32.next_up());
        assert_eq!(
            (found.false_accepts.count, found.true_accepts.count),
            (0, 30)
        );
        assert_eq!((found.reject, found.rejected_right.count), (0.6, 0));
    }

    #[test]
    fn too_few_estimates_are_told_what_they_show_and_how_many_it_takes() {
        let mut labelled = of(false, [0.1; 20]);
        labelled.extend(of(true, [0.9; 50]));
        let error = calibrate(&labelled, AIM).unwrap_err().to_string();
        assert_eq!(
            error,
            "20 wrong estimates show a share of at best 16.12 % (the upper bound of the 95 % interval \
             of none in 20): for 10 % there must be at least 35"
        );
        for (share, said) in [(0.07, "for 7 %"), (0.000_05, "for 0.005 %")] {
            let aim = Aim {
                false_accepts: share,
                ..AIM
            };
            let error = calibrate(&labelled, aim).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
        labelled.truncate(20);
        labelled.extend(of(false, [0.2; 20]));
        let error = calibrate(&labelled, AIM).unwrap_err().to_string();
        assert!(
            error.starts_with("0 right estimates show a share of at best 100 %"),
            "{error}"
        );
    }

    #[test]
    fn confidences_that_nothing_tells_apart_are_refused() {
        let mut labelled = of(false, [0.5; 50]);
        labelled.extend(of(true, [0.5; 50]));
        let error = calibrate(&labelled, AIM).unwrap_err();
        assert_eq!(
            error,
            CalibrateError::AllEqual {
                confidence: 0.5,
                count: 100
            }
        );

        let mut labelled = of(false, [1.0; 50]);
        labelled.extend(of(true, [0.5; 50]));
        let error = calibrate(&labelled, AIM).unwrap_err();
        assert_eq!(
            error,
            CalibrateError::NoThreshold {
                count: 50,
                allowed: 5
            }
        );

        let mut labelled = of(false, [0.5; 50]);
        labelled.extend(of(true, [0.25; 50]));
        let error = calibrate(&labelled, AIM).unwrap_err();
        let accept = 0.5_f32.next_up();
        assert_eq!(
            error,
            CalibrateError::AcceptsNothing {
                accept,
                allowed: 5,
                wrong: 50
            }
        );
    }

    #[test]
    fn what_is_no_confidence_or_no_share_is_refused() {
        for found in [f32::NAN, f32::INFINITY, -0.1, 1.1] {
            let mut labelled = separated();
            labelled[7].confidence = found;
            let error = calibrate(&labelled, AIM).unwrap_err();
            assert!(matches!(error, CalibrateError::Confidence { index: 7, .. }));
        }
        for found in [0.0, 1.0, -0.1, f64::NAN] {
            let aim = Aim {
                false_accepts: found,
                ..AIM
            };
            let error = calibrate(&separated(), aim).unwrap_err();
            assert!(matches!(error, CalibrateError::Aim { .. }));
        }
    }

    #[test]
    fn the_order_of_the_estimates_changes_nothing() {
        let mut labelled = separated();
        let found = calibrate(&labelled, AIM);
        labelled.reverse();
        assert_eq!(calibrate(&labelled, AIM), found);
    }

    #[test]
    fn zeros_of_either_sign_are_never_accepted() {
        for zero in [0.0, -0.0] {
            let mut labelled = of(false, [zero; 50]);
            labelled.extend(of(true, [0.5; 50]));
            let found = calibrate(&labelled, AIM).unwrap();
            assert!(found.accept > 0.0 && found.accept < 1e-40);
        }
    }
}
