//! The surface that a template describes, as points.

use crate::evaluate::own_points;
use crate::surface::fibonacci_sphere;
use cobra_infer::Template;
use cobra_infer::gp::UnitDirection;
use nalgebra::{Point3, distance_squared};

/// Directions from each reference point, where components speak everywhere.
const DIRECTIONS: usize = 4_000;

/// Points, each with its component: those that the components predict where they may speak; of a template whose
/// components speak everywhere, those that they predict in what is nearest to themselves.
pub(super) fn surface(template: &Template<'_>) -> Vec<(usize, Point3<f64>)> {
    if template.has_validity() {
        return own_points(template);
    }
    let components: Vec<_> = template.components().collect();
    let directions = fibonacci_sphere(DIRECTIONS);
    let mut points = Vec::new();
    for (index, component) in components.iter().enumerate() {
        let centre: Point3<f32> = component.centre.into();
        for direction in &directions {
            let u = UnitDirection::new_normalize(direction.cast::<f32>().into_inner());
            let mean = component.posterior_mean(template.model(), &u);
            let point = centre + u.into_inner() * mean;
            let own = distance_squared(&point, &centre);
            let nearer = |other: &cobra_infer::template::Component<'_>| {
                distance_squared(&point, &other.centre.into()) < own
            };
            if mean > 0.0 && mean.is_finite() && !components.iter().any(nearer) {
                points.push((index, point.cast()));
            }
        }
    }
    points
}
