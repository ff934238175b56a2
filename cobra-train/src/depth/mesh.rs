//! The exact mesh in the place of a template.

use crate::surface::{Mesh, RayCaster, sample_poisson};
use cobra_infer::depth::{Nearby, Surface};
use nalgebra::Point3;

/// How many points of the mesh the depth buffer is filled with: √(area/6000) apart or so, 2.3 % of the diameter on
/// a sphere.
const SAMPLES: usize = 6_000;

/// A mesh that answers what a template answers in the depth check: by the nearest point of its triangles.
#[derive(Clone)]
pub struct MeshSurface {
    caster: RayCaster,
    points: Vec<Point3<f32>>,
    centre: [f32; 3],
    radius: f32,
    diameter: f32,
    noise: f32,
}

impl MeshSurface {
    /// With σ_m = `noise`, in the mesh's unit, and with a seed for the points that show where it is.
    #[must_use]
    pub fn new(mesh: &Mesh, noise: f32, seed: u64) -> Self {
        let sphere = mesh.bounding_sphere();
        let points = sample_poisson(mesh, SAMPLES, seed);
        Self {
            caster: RayCaster::new(mesh),
            points: points.iter().map(|point| point.cast()).collect(),
            centre: sphere.centre.cast::<f32>().into(),
            radius: sphere.radius as f32,
            diameter: mesh.diameter() as f32,
            noise,
        }
    }
}

impl Surface for MeshSurface {
    fn centre(&self) -> [f32; 3] {
        self.centre
    }

    fn radius(&self) -> f32 {
        self.radius
    }

    fn diameter(&self) -> f32 {
        self.diameter
    }

    fn noise(&self) -> f32 {
        self.noise
    }

    /// The distance is that to the nearest point of a triangle, and the normal points away from it.
    fn nearby(&self, point: &Point3<f32>) -> Option<Nearby> {
        let nearest = self.caster.nearest(&point.cast())?;
        let distance = nearest.distance as f32;
        let scaled = distance / self.noise;
        Some(Nearby {
            distance,
            normal: nearest.away.cast::<f32>().into_inner().into(),
            likelihood: (-0.5 * scaled * scaled).exp(),
        })
    }

    /// Always the same 6,000 points, whatever the spacing: a caller that asks for closer ones does not get them.
    fn sample(&self, _: f32, take: &mut impl FnMut(Option<&Point3<f32>>)) {
        self.points.iter().map(Some).for_each(take);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_points_are_the_same_whatever_the_spacing() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]];
        let vertices = corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
        let mesh = Mesh::new(vertices, vec![[0, 1, 2]]).unwrap();
        let surface = MeshSurface::new(&mesh, 2.0, 0);
        let points = |spacing| {
            let mut points = Vec::new();
            surface.sample(spacing, &mut |point| points.extend(point.copied()));
            points
        };
        assert_eq!(points(1e-3).len(), SAMPLES);
        assert_eq!(points(1e-3), points(10.0));
    }

    #[test]
    fn a_point_beside_a_triangle_is_as_far_away_as_it_is_and_on_it_has_its_normal() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]];
        let vertices = corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
        let mesh = Mesh::new(vertices, vec![[0, 1, 2]]).unwrap();
        let surface = MeshSurface::new(&mesh, 2.0, 0);
        let nearby = surface.nearby(&Point3::new(1.0, 1.0, -2.0)).unwrap();
        assert_eq!((nearby.distance, nearby.normal), (2.0, [0.0, 0.0, -1.0]));
        assert!((nearby.likelihood - (-0.5_f32).exp()).abs() < 1e-6);
        let on = surface.nearby(&Point3::new(1.0, 1.0, 0.0)).unwrap();
        assert_eq!(on.distance, 0.0);
        assert_eq!(on.normal.map(f32::abs), [0.0, 0.0, 1.0]);
        assert_eq!(surface.nearby(&Point3::new(f32::NAN, 0.0, 0.0)), None);
    }
}
