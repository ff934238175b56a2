//! Pinhole intrinsics, correspondences, and back-projection.
//!
//! Owns the step from a pixel to a point in the object's frame. Lens distortion is not modelled:
//! a camera that has it is refused, because undistorting points is the vision library's work.
//!
//! Pixel centres are at integers: the pixel in column 3 and row 5 is the point (3, 5), the
//! convention of OpenCV and BOP.

use crate::error::CameraError;
use crate::math::{self, Real};
use crate::pose::Pose;
use nalgebra::{Point2, Point3, Vector3};

/// Intrinsics of a pinhole camera: (x, y) ↦ (fx·x + s·y + cx, fy·y + cy), in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Camera {
    fx: f32,
    fy: f32,
    cx: f32,
    cy: f32,
    skew: f32,
}

/// One observed pixel, the object point that the estimator assigns to it, and its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correspondence {
    /// The observed pixel, pixel centres at integers.
    pub pixel: Point2<f32>,
    /// The point on the object, in the object's frame and the template's unit.
    pub point: Point3<f32>,
    /// The weight wᵢ ≥ 0 of Eq. 10 before normalisation; 1 for every point is the paper's 1/N.
    pub weight: f32,
}

impl Correspondence {
    /// A correspondence of weight 1.
    #[must_use]
    pub fn new(pixel: Point2<f32>, point: Point3<f32>) -> Self {
        Self {
            pixel,
            point,
            weight: 1.0,
        }
    }

    /// Whether every number in it is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.pixel.x.is_finite()
            && self.pixel.y.is_finite()
            && self.point.x.is_finite()
            && self.point.y.is_finite()
            && self.point.z.is_finite()
            && self.weight.is_finite()
    }
}

/// A point put back into the object's frame through a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BackProjection {
    /// P̂, in the object's frame.
    pub point: Point3<f32>,
    /// λ, its depth along the camera's axis, in the template's unit.
    pub depth: f32,
}

impl Camera {
    /// Focal lengths and principal point, in pixels, without skew.
    ///
    /// # Errors
    /// [`CameraError::NotFinite`]; [`CameraError::FocalLength`] when a focal length is not positive.
    pub fn new(fx: f32, fy: f32, cx: f32, cy: f32) -> Result<Self, CameraError> {
        for (value, row, column) in [(fx, 0, 0), (cx, 0, 2), (fy, 1, 1), (cy, 1, 2)] {
            if !value.is_finite() {
                return Err(CameraError::NotFinite { row, column });
            }
        }
        Self::finite(fx, fy, cx, cy, 0.0)
    }

    /// The row-major matrix K = (fx s cx; 0 fy cy; 0 0 1).
    ///
    /// # Errors
    /// [`CameraError::NotFinite`]; [`CameraError::FocalLength`] when a focal length is not positive;
    /// [`CameraError::Shape`] when an entry below the diagonal is not 0 or the last is not 1.
    pub fn from_matrix(k: [f32; 9]) -> Result<Self, CameraError> {
        for (index, entry) in k.iter().enumerate() {
            if !entry.is_finite() {
                return Err(CameraError::NotFinite {
                    row: index / 3,
                    column: index % 3,
                });
            }
        }
        let [fx, skew, cx, k10, fy, cy, k20, k21, k22] = k;
        if k10 != 0.0 || k20 != 0.0 || k21 != 0.0 || k22 != 1.0 {
            return Err(CameraError::Shape {
                below: [k10, k20, k21],
                last: k22,
            });
        }
        Self::finite(fx, fy, cx, cy, skew)
    }

    fn finite(fx: f32, fy: f32, cx: f32, cy: f32, skew: f32) -> Result<Self, CameraError> {
        for (name, value) in [("fx", fx), ("fy", fy)] {
            // A focal length so small that its inverse overflows is no focal length either.
            if value < f32::MIN_POSITIVE {
                return Err(CameraError::FocalLength { name, value });
            }
        }
        Ok(Self {
            fx,
            fy,
            cx,
            cy,
            skew,
        })
    }

    /// Accepts a distortion model only when it distorts nothing.
    ///
    /// # Errors
    /// [`CameraError::Distorted`] when a coefficient is not 0 (NaN included).
    pub fn with_distortion(self, coefficients: &[f32]) -> Result<Self, CameraError> {
        match coefficients.iter().enumerate().find(|(_, c)| **c != 0.0) {
            Some((index, value)) => Err(CameraError::Distorted {
                index,
                value: *value,
            }),
            None => Ok(self),
        }
    }

    /// K, row-major: what [`Camera::from_matrix`] takes.
    #[must_use]
    pub fn to_matrix(&self) -> [f32; 9] {
        [
            self.fx, self.skew, self.cx, 0.0, self.fy, self.cy, 0.0, 0.0, 1.0,
        ]
    }

    /// K⁻¹p: the ray through a pixel, scaled to z = 1.
    #[must_use]
    #[inline(always)]
    pub fn ray(&self, pixel: &Point2<f32>) -> Vector3<f32> {
        let y = (pixel.y - self.cy) / self.fy;
        let x = ((pixel.x - self.cx) - self.skew * y) / self.fx;
        Vector3::new(x, y, 1.0)
    }

    /// The pixel that a point of the camera's frame falls on; `None` when it does not lie in front
    /// of the camera.
    #[must_use]
    pub fn project(&self, point: &Point3<f32>) -> Option<Point2<f32>> {
        if point.z.is_nan() || point.z <= 0.0 {
            return None;
        }
        let (x, y) = (point.x / point.z, point.y / point.z);
        Some(Point2::new(
            self.fx * x + self.skew * y + self.cx,
            self.fy * y + self.cy,
        ))
    }

    /// The square of the image that a sphere in front of the camera, z > R, falls into: its middle and half
    /// its side. The rays that touch the sphere in the plane of x and z have
    /// x/z = (xz ± R√(x² + z² − R²))/(z² − R²), and those of y and z alike.
    pub(crate) fn square_around(&self, middle: &Point3<f32>, radius: f32) -> (Point2<f32>, f32) {
        let below = (middle.z - radius) * (middle.z + radius);
        let span = |across: f32| {
            (
                across * middle.z / below,
                radius * (across * across + below).square_root() / below,
            )
        };
        let ((x, wide), (y, high)) = (span(middle.x), span(middle.y));
        let across = self.fx * wide + math::abs(self.skew) * high;
        let up = self.fy * high;
        (
            Point2::new(self.fx * x + self.skew * y + self.cx, self.fy * y + self.cy),
            if across > up { across } else { up },
        )
    }

    /// Puts a pixel with a measured depth back into the object's frame: P̂ = Rᵀ(λK⁻¹p − t).
    ///
    /// `depth` is λ, the measurement along the camera's axis (z-depth, as depth images hold it, not
    /// the distance from the camera's centre), in the template's unit. `None` where it is no finite
    /// number above 0, as depth images say that nothing was measured, or where the arithmetic
    /// overflows.
    #[must_use]
    pub fn back_project_depth(
        &self,
        pose: &Pose,
        pixel: &Point2<f32>,
        depth: f32,
    ) -> Option<Point3<f32>> {
        if !(depth.is_finite() && depth > 0.0) {
            return None;
        }
        let ray = self.ray(pixel);
        let seen = Point3::new(depth * ray.x, depth * ray.y, depth * ray.z);
        let point = pose.to_object(&seen);
        point.iter().all(|c| c.is_finite()).then_some(point)
    }

    /// Puts a pixel back into the object's frame: the point on the pixel's ray that is closest to
    /// RP + t.
    ///
    /// λ = ((K⁻¹p)ᵀ(RP + t)) / ‖K⁻¹p‖², P̂ = Rᵀ(λK⁻¹p − t), λ being the depth. Where λ ≤ 0 the
    /// point lies behind the camera; the result is still returned, and it is not finite where
    /// the arithmetic overflows.
    #[must_use]
    #[inline(always)]
    pub fn back_project(
        &self,
        pose: &Pose,
        pixel: &Point2<f32>,
        point: &Point3<f32>,
    ) -> BackProjection {
        let ray = self.ray(pixel);
        let ray = [ray.x, ray.y, ray.z];
        let seen = pose.to_camera(point);
        let depth = math::dot(ray, [seen.x, seen.y, seen.z]) / math::dot(ray, ray);
        let [x, y, z] = ray;
        BackProjection {
            point: pose.to_object(&Point3::new(depth * x, depth * y, depth * z)),
            depth,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_matrix_is_the_one_that_was_given() {
        let k = [420., 0.7, 310., 0., 430., 250., 0., 0., 1.];
        assert_eq!(Camera::from_matrix(k).unwrap().to_matrix(), k);
    }

    #[test]
    fn the_square_around_a_sphere_holds_it_and_no_more() {
        let camera = Camera::from_matrix([420., 0.7, 310., 0., 430., 250., 0., 0., 1.]).unwrap();
        for middle in [[0., 0., 500.], [400., -90., 500.], [-30., 600., 300.]] {
            let middle = Point3::from(middle);
            let (centre, half) = camera.square_around(&middle, 40.0);
            let mut reach = 0.0_f32;
            for step in 0..40_000 {
                let (turn, z) = (step as f32 * 2.399_963, 1.0 - step as f32 / 20_000.0);
                let ring = (1.0 - z * z).square_root();
                let outward = Vector3::new(
                    ring * (turn + core::f32::consts::FRAC_PI_2).sine(),
                    ring * turn.sine(),
                    z,
                );
                let pixel = camera.project(&(middle + 40.0 * outward)).unwrap();
                let away = pixel - centre;
                reach = reach.max(away.x.abs()).max(away.y.abs());
            }
            assert!(
                reach <= half * 1.0001 && half < reach * 1.01,
                "{half} {reach}"
            );
        }
    }

    #[test]
    fn a_projected_point_comes_back_to_where_it_was() {
        let camera = Camera::from_matrix([420., 0.7, 310., 0., 430., 250., 0., 0., 1.]).unwrap();
        let pose =
            Pose::from_row_major([0., -1., 0., 1., 0., 0., 0., 0., 1.], [10., -20., 400.]).unwrap();
        let point = Point3::new(31., -7., 22.);
        let pixel = camera.project(&pose.to_camera(&point)).unwrap();
        let back = camera.back_project(&pose, &pixel, &point);
        assert!((back.point - point).norm() < 1e-3);
        assert!((back.depth - 422.).abs() < 1e-2);
    }

    #[test]
    fn a_focal_length_of_zero_is_refused_by_name() {
        assert_eq!(
            Camera::new(400., 0., 320., 240.),
            Err(CameraError::FocalLength {
                name: "fy",
                value: 0.
            })
        );
    }

    #[test]
    fn a_distorted_camera_is_told_to_undistort_first() {
        let camera = Camera::new(400., 400., 320., 240.).unwrap();
        assert!(camera.with_distortion(&[0.0; 5]).is_ok());
        let error = camera.with_distortion(&[0.0, -0.12]).unwrap_err();
        assert!(std::format!("{error}").contains("undistort"));
        assert!(camera.with_distortion(&[f32::NAN]).is_err());
    }

    #[test]
    fn a_matrix_that_is_no_intrinsic_matrix_is_refused() {
        assert!(matches!(
            Camera::from_matrix([400., 0., 320., 0., 400., 240., 0., 0., 2.]),
            Err(CameraError::Shape { .. })
        ));
        assert!(matches!(
            Camera::from_matrix([400., 0., f32::NAN, 0., 400., 240., 0., 0., 1.]),
            Err(CameraError::NotFinite { row: 0, column: 2 })
        ));
    }
}
