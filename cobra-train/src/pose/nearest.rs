//! Nine numbers that are nearly a rotation, and the rotation that is meant.
//!
//! Owns it in `f64`, for errors whose truth is known; the scorer's own, in `f32`, is
//! `cobra_infer::Pose`.

use cobra_infer::{PoseError, tolerance};
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion};

/// The pose (R, t), R row-major and replaced by the nearest rotation in the Frobenius norm: UVᵀ of
/// its singular value decomposition R = UΣVᵀ (N. Higham, Functions of Matrices, SIAM 2008, Ch. 8).
///
/// BOP's LM-O has rotations scaled by about 0.99985; errors of poses are of rotations.
///
/// # Errors
/// As `cobra_infer::Pose::from_row_major_orthonormalised`, with the same tolerance:
/// [`PoseError::NotFinite`], [`PoseError::NotARotation`], [`PoseError::Reflection`].
pub fn nearest_pose(r: [f64; 9], t: [f64; 3]) -> Result<Isometry3<f64>, PoseError> {
    if !r.iter().chain(&t).all(|entry| entry.is_finite()) {
        return Err(PoseError::NotFinite);
    }
    let matrix = Matrix3::from_row_slice(&r);
    let deviation = (matrix.transpose() * matrix - Matrix3::identity()).abs();
    let allowed = tolerance::ORTHONORMALISABLE;
    // Written so that a NaN from an overflow is refused too.
    if !deviation.iter().all(|size| *size <= f64::from(allowed)) {
        return Err(PoseError::NotARotation {
            deviation: deviation.max() as f32,
            tolerance: allowed,
        });
    }
    let determinant = matrix.determinant();
    if determinant <= 0.0 {
        return Err(PoseError::Reflection {
            determinant: determinant as f32,
        });
    }
    let svd = matrix.svd(true, true);
    let nearest = match (svd.u, svd.v_t) {
        (Some(u), Some(v_t)) => u * v_t,
        _ => unreachable!("both were asked for"),
    };
    let rotation = Rotation3::from_matrix_unchecked(nearest);
    Ok(Isometry3::from_parts(
        Translation3::from(t),
        UnitQuaternion::from_rotation_matrix(&rotation),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn row_major(matrix: &Matrix3<f64>) -> [f64; 9] {
        std::array::from_fn(|i| matrix[(i / 3, i % 3)])
    }

    #[test]
    fn a_scaled_rotation_is_the_rotation() {
        let rotation = Rotation3::new(Vector3::new(0.3, -1.2, 2.0));
        let scaled = row_major(&(rotation.matrix() * 0.99985));
        let pose = nearest_pose(scaled, [1.0, 2.0, 3.0]).unwrap();
        let found = pose.rotation.to_rotation_matrix();
        assert!((found.matrix() - rotation.matrix()).norm() < 1e-14);
        assert_eq!(pose.translation.vector, Vector3::new(1.0, 2.0, 3.0));
    }

    #[test]
    fn the_result_is_nearer_than_its_neighbours() {
        let mut bent = *Rotation3::new(Vector3::new(0.3, -1.2, 2.0)).matrix();
        bent[(0, 1)] += 0.02;
        bent[(2, 2)] -= 0.01;
        let pose = nearest_pose(row_major(&bent), [0.0; 3]).unwrap();
        let nearest = pose.rotation.to_rotation_matrix();
        let off = |rotation: &Rotation3<f64>| (rotation.matrix() - bent).norm();
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            for step in [1e-3, -1e-3] {
                assert!(off(&(Rotation3::new(axis * step) * nearest)) > off(&nearest));
            }
        }
    }

    #[test]
    fn what_is_no_rotation_is_refused_as_the_scorer_refuses_it() {
        let identity = [1., 0., 0., 0., 1., 0., 0., 0., 1.];
        for (entry, value) in [(0, f64::NAN), (4, 1.2), (8, -1.0), (2, 1e30), (0, 0.0)] {
            let mut r = identity;
            r[entry] = value;
            let host = nearest_pose(r, [0.0; 3]).unwrap_err();
            let scorer =
                cobra_infer::Pose::from_row_major_orthonormalised(r.map(|x| x as f32), [0.0; 3])
                    .unwrap_err();
            assert_eq!(
                std::mem::discriminant(&host),
                std::mem::discriminant(&scorer),
                "{host} {scorer}"
            );
        }
        assert_eq!(
            nearest_pose(identity, [0.0, f64::INFINITY, 0.0]),
            Err(PoseError::NotFinite)
        );
    }
}
