//! Rotations spread evenly over all that there are.
//!
//! Reference: M. Alexa, Super-Fibonacci spirals: fast, low-discrepancy sampling of SO(3), CVPR 2022.

use nalgebra::{Quaternion, UnitQuaternion};
use std::f64::consts::{PI, SQRT_2, TAU};

/// The paper's ψ, a root of ψ⁴ = ψ + 4.
const PSI: f64 = 1.533_751_168_755_204_3;

/// `count` rotations along a super-Fibonacci spiral.
pub(super) fn super_fibonacci(count: usize) -> Vec<UnitQuaternion<f64>> {
    let n = count as f64;
    (0..count)
        .map(|index| {
            let s = index as f64 + 0.5;
            let (r, rest) = ((s / n).sqrt(), (1.0 - s / n).sqrt());
            // libm's, so that every platform turns by the same bits.
            let (sin_a, cos_a) = libm::sincos(TAU * s / SQRT_2);
            let (sin_b, cos_b) = libm::sincos(TAU * s / PSI);
            let [x, y, z, w] = [r * sin_a, r * cos_a, rest * sin_b, rest * cos_b];
            UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
        })
        .collect()
}

/// How far apart neighbours are, in radians: the edge of a cube of each one's share of the 8π² that all
/// rotations come to.
pub(super) fn spacing(count: usize) -> f64 {
    libm::cbrt(8.0 * PI * PI / count.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, normal, stream};

    #[test]
    fn psi_is_the_root_that_the_paper_names() {
        assert!((PSI.powi(4) - PSI - 4.0).abs() < 1e-12);
    }

    #[test]
    fn no_rotation_is_farther_than_the_spacing_from_one_of_them() {
        let count = super::super::CANDIDATES;
        let grid = super_fibonacci(count);
        let mut rng = stream(0, Purpose::Ambiguity, 0);
        let mut farthest = 0.0_f64;
        for _ in 0..500 {
            let mut draw = || normal(&mut rng);
            let random = Quaternion::new(draw(), draw(), draw(), draw());
            let random = UnitQuaternion::from_quaternion(random);
            let nearest = grid.iter().map(|rotation| rotation.angle_to(&random));
            farthest = farthest.max(nearest.fold(f64::INFINITY, f64::min));
        }
        assert!(farthest < spacing(count), "{}", farthest.to_degrees());
    }
}
