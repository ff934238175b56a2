//! The texts of statuses, decisions and reasons: static, in English, zero-terminated.
#![allow(unsafe_code, reason = "exported symbols")]

use crate::status::CobraStatus;
use core::ffi::{CStr, c_char};

/// What a status says, as a phrase. Never NULL, also for a number that is no CobraStatus.
#[unsafe(no_mangle)]
pub extern "C" fn cobra_status_string(status: u32) -> *const c_char {
    CobraStatus::from_number(status)
        .map_or(c"unknown status", CobraStatus::text)
        .as_ptr()
}

/// `accept`, `reject` or `undecided`. Never NULL, also for a number that is no CobraDecision.
#[unsafe(no_mangle)]
pub extern "C" fn cobra_decision_string(decision: u32) -> *const c_char {
    decision_text(decision).as_ptr()
}

/// What a reason says, as a phrase. Never NULL, also for a number that is no CobraReason.
#[unsafe(no_mangle)]
pub extern "C" fn cobra_reason_string(reason: u32) -> *const c_char {
    reason_text(reason).as_ptr()
}

/// What a cause says, as a phrase; its number is in the report. Never NULL, also for a number that is
/// no CobraCause.
#[unsafe(no_mangle)]
pub extern "C" fn cobra_cause_string(cause: u32) -> *const c_char {
    cause_text(cause).as_ptr()
}

pub(crate) const fn cause_text(cause: u32) -> &'static CStr {
    match cause {
        0 => c"nothing was checked",
        1 => c"what was observed fits the pose",
        2 => c"the pose puts the object behind or around the camera",
        3 => c"wrong scale: measured depth and the pose have different units",
        4 => c"another object stands in front of it",
        5 => c"the camera sees past it: nothing is where the pose puts it",
        6 => c"offset along the ray",
        7 => c"offset across the ray",
        8 => c"turned",
        9 => c"the shape does not fit, and no small motion makes it fit",
        10 => c"most of it is hidden behind something else",
        11 => c"nothing was measured where it must be seen",
        _ => c"unknown cause",
    }
}

pub(crate) const fn decision_text(decision: u32) -> &'static CStr {
    match decision {
        0 => c"undecided",
        1 => c"reject",
        2 => c"accept",
        _ => c"unknown decision",
    }
}

pub(crate) const fn reason_text(reason: u32) -> &'static CStr {
    match reason {
        0 => c"nothing was scored",
        1 => c"confidence reaches the threshold",
        2 => c"confidence below the threshold",
        3 => c"no point lies on the surface",
        4 => c"every point lies behind the camera",
        5 => c"too few points",
        6 => c"the weights add up to zero or next to nothing",
        7 => c"a number in the input is not finite",
        8 => c"a weight is negative",
        9 => c"the threshold is zero: the tolerance is immense against sigma",
        10 => c"something in front hides the object",
        11 => c"no threshold is known: calibrate first",
        12 => c"confidence between the thresholds",
        _ => c"unknown reason",
    }
}
