//! The cameras from which the object is seen while it is sampled.
//!
//! Owns where they stand, which part of each one's window can show the object at all, and the ray
//! through a point of the window. Who casts the rays, and how many, is `surface::sample`'s work.

use nalgebra::{Point3, UnitVector3, Vector3};

use super::mesh::Mesh;

/// How many cameras look at the object.
pub const CAMERAS: usize = 100;

/// Distance of each camera from the origin, in radii of the object's unit sphere.
pub const CAMERA_DISTANCE: f64 = 2.5;

/// `n` directions spread evenly over the sphere along a golden-angle spiral, from +z to −z.
#[must_use]
pub fn fibonacci_sphere(n: usize) -> Vec<UnitVector3<f64>> {
    let golden = std::f64::consts::PI * (1.0 + 5.0_f64.sqrt());
    (0..n)
        .map(|i| {
            let step = i as f64 + 0.5;
            let z = 1.0 - 2.0 * step / n as f64;
            let r = (1.0 - z * z).sqrt();
            // libm's, so that every platform places the cameras on the same bits.
            let (sin, cos) = libm::sincos(golden * step);
            UnitVector3::new_normalize(Vector3::new(r * cos, r * sin, z))
        })
        .collect()
}

/// A pinhole camera that looks at the origin through a rectangle at distance 1.
#[derive(Clone, Debug)]
pub(super) struct Camera {
    /// Where it stands.
    pub(super) origin: Point3<f64>,
    right: Vector3<f64>,
    up: Vector3<f64>,
    forward: Vector3<f64>,
    low: [f64; 2],
    high: [f64; 2],
}

impl Camera {
    /// The camera in direction `from`, its window cropped to the rectangle around the projected
    /// vertices: rays outside of it cannot hit. The vertices lie in the unit sphere, so the window
    /// that holds the sphere holds the rectangle too.
    pub(super) fn new(from: &UnitVector3<f64>, mesh: &Mesh) -> Self {
        let forward = -from.into_inner();
        let aside = if forward.z.abs() < 0.9 {
            Vector3::z()
        } else {
            Vector3::x()
        };
        let right = aside.cross(&forward).normalize();
        let mut camera = Self {
            origin: Point3::from(from.into_inner() * CAMERA_DISTANCE),
            right,
            up: forward.cross(&right),
            forward,
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
        };
        for vertex in mesh.used_vertices() {
            let seen = camera.project(vertex);
            for (axis, offset) in seen.into_iter().enumerate() {
                camera.low[axis] = camera.low[axis].min(offset);
                camera.high[axis] = camera.high[axis].max(offset);
            }
        }
        camera
    }

    /// Area of the window at distance 1: rays spread evenly over all cameras' windows fall into
    /// this one in proportion to it.
    pub(super) fn area(&self) -> f64 {
        (self.high[0] - self.low[0]) * (self.high[1] - self.low[1])
    }

    /// The direction through the window's point at these shares, in [0, 1], of its two sides.
    pub(super) fn ray(&self, [s, t]: [f64; 2]) -> Vector3<f64> {
        let u = self.low[0] + s * (self.high[0] - self.low[0]);
        let v = self.low[1] + t * (self.high[1] - self.low[1]);
        self.forward + self.right * u + self.up * v
    }

    fn project(&self, point: &Point3<f64>) -> [f64; 2] {
        let ray = point - self.origin;
        let depth = ray.dot(&self.forward);
        [ray.dot(&self.right) / depth, ray.dot(&self.up) / depth]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fibonacci_directions_are_unit_vectors_spread_evenly() {
        let directions = fibonacci_sphere(CAMERAS);
        assert_eq!(directions.len(), CAMERAS);
        let sum: Vector3<f64> = directions.iter().map(|d| d.into_inner()).sum();
        assert!(sum.norm() < 0.5, "{sum}");
        for (i, a) in directions.iter().enumerate() {
            assert!((a.norm() - 1.0).abs() < 1e-15);
            // An even spread leaves each of 100 directions a cap of about 0.2 radians.
            assert!(directions[..i].iter().all(|b| a.dot(b) < 0.97));
        }
        assert!(fibonacci_sphere(0).is_empty());
    }

    #[test]
    fn the_window_holds_every_vertex_and_nothing_more() {
        let vertices = vec![
            Point3::new(0.9, 0.0, 0.1),
            Point3::new(-0.9, 0.2, 0.0),
            Point3::new(0.0, -0.3, 0.5),
            Point3::new(0.0, 0.0, 70.0),
        ];
        let mesh = Mesh::new(vertices, vec![[0, 1, 2]]).unwrap();
        let half_width = 1.0 / (CAMERA_DISTANCE * CAMERA_DISTANCE - 1.0).sqrt();
        for from in fibonacci_sphere(CAMERAS) {
            let camera = Camera::new(&from, &mesh);
            let seen: Vec<_> = mesh.used_vertices().map(|v| camera.project(v)).collect();
            for axis in 0..2 {
                let sides = (camera.low[axis], camera.high[axis]);
                let low = seen.iter().map(|p| p[axis]).fold(f64::MAX, f64::min);
                let high = seen.iter().map(|p| p[axis]).fold(f64::MIN, f64::max);
                assert_eq!(sides, (low, high));
                assert!(-half_width <= low && high <= half_width);
            }
        }
    }

    #[test]
    fn the_ray_through_a_projected_point_meets_the_point() {
        let vertices = vec![
            Point3::origin(),
            Point3::new(0.5, 0.1, 0.2),
            Point3::new(0.1, 0.6, 0.0),
        ];
        let mesh = Mesh::new(vertices, vec![[0, 1, 2]]).unwrap();
        for from in fibonacci_sphere(CAMERAS) {
            let camera = Camera::new(&from, &mesh);
            let target = Point3::new(0.2, 0.2, 0.06);
            let seen = camera.project(&target);
            let share = |axis: usize| {
                (seen[axis] - camera.low[axis]) / (camera.high[axis] - camera.low[axis])
            };
            let ray = camera.ray([share(0), share(1)]);
            let offset = (target - camera.origin).cross(&ray).norm() / ray.norm();
            assert!(offset < 1e-12, "{offset}");
        }
    }
}
