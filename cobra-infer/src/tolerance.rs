//! Every tolerance that this crate applies to its input, in one table.
//!
//! `docs/TOLERANCES.md` quotes these values, and a test compares the two.

/// A direction u of a template is a unit vector when |‖u‖² − 1| is at most this: some fifty times
/// the rounding of an `f32` unit vector, far less than any fault worth finding.
pub const UNIT_DIRECTION: f32 = 1e-5;

/// R is a rotation when every entry of RᵀR − I is at most this in magnitude and det R > 0. Four
/// printed digits pass; the rotations of BOP's LM-O ground truth, scaled by 0.99985, do not.
pub const ROTATION: f32 = 1e-4;

/// A matrix can be orthonormalised when every entry of RᵀR − I is at most this: beyond it, it is
/// no damaged rotation but something else. Published pose files hold matrices that are off by 0.11.
pub const ORTHONORMALISABLE: f32 = 0.2;

/// A point closer to a reference point than this share of the bounding sphere's radius has no
/// direction from it, so that component says nothing about it.
pub const NO_DIRECTION: f32 = 1e-6;
