//! What can be done about a camera or a pose before scoring: refuse lens distortion, repair a
//! rotation that is slightly off.
#![allow(
    unsafe_code,
    reason = "raw pointers come from C, and symbols are exported"
)]

use crate::pointer;
use crate::status::CobraStatus;
use crate::types::CobraPose;
use cobra_infer::{Camera, Pose};

/// Refuses lens distortion: `COBRA_STATUS_CAMERA_DISTORTED` unless all `count` coefficients are 0.
/// Distortion is not modelled, so undistort the image points first. `coefficients` may be NULL
/// where `count` is 0.
///
/// # Safety
/// `coefficients` points to `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_check_distortion(
    coefficients: *const f32,
    count: usize,
) -> CobraStatus {
    if count == 0 {
        return CobraStatus::Ok;
    }
    // SAFETY: the caller's promise; any bits are an `f32`.
    let coefficients = unsafe { pointer::slice(coefficients, count) };
    pointer::status(coefficients.and_then(|coefficients| {
        let camera = Camera::new(1.0, 1.0, 0.0, 0.0)?;
        camera.with_distortion(coefficients)?;
        Ok(())
    }))
}

/// Replaces R by the nearest rotation, for a pose that comes with few digits or from a file whose
/// matrix is off: the scorer itself refuses what is no rotation. A matrix that is too far off is
/// refused here too, and then the pose is left as it was.
///
/// # Safety
/// `pose` points to a CobraPose.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_pose_orthonormalise(pose: *mut CobraPose) -> CobraStatus {
    // SAFETY: the caller's promise; any bits are a CobraPose.
    let repaired = unsafe { pointer::read(pose.cast_const()) }.and_then(|given| {
        let repaired = Pose::from_row_major_orthonormalised(given.rotation, given.translation)?;
        let r = repaired.rotation().matrix();
        Ok(CobraPose {
            rotation: [
                r.m11, r.m12, r.m13, r.m21, r.m22, r.m23, r.m31, r.m32, r.m33,
            ],
            translation: given.translation,
        })
    });
    // SAFETY: the caller's promise.
    pointer::status(repaired.and_then(|repaired| unsafe { pointer::write(pose, repaired) }))
}
