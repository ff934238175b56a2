//! Motions in words, for tables.

use super::{Path, Range, What};
use nalgebra::UnitVector3;

impl Range {
    /// The least and the largest amount; `None` where any will do.
    #[must_use]
    pub fn ends(&self) -> Option<[f64; 2]> {
        match *self {
            Self::Any => None,
            Self::Between { low, high } => Some([low, high]),
        }
    }
}

impl What {
    /// The motion in a line, with `millimetres` in a unit of the mesh.
    #[must_use]
    pub fn words(&self, millimetres: f64) -> String {
        match self {
            Self::Path {
                path: Path::Turn(axis),
                range,
            } => {
                let about = direction(&axis.direction);
                match range.ends() {
                    None => format!("turns about {about} by any angle"),
                    Some(ends) => {
                        let [low, high] = ends.map(f64::to_degrees);
                        format!("turns about {about} by {low:.0} to {high:.0} degrees")
                    }
                }
            }
            Self::Path {
                path: Path::Slide(along),
                range,
            } => {
                let [low, high] = range
                    .ends()
                    .unwrap_or_default()
                    .map(|end| millimetres * end);
                let along = direction(along);
                format!("slides along {along} by {low:.1} to {high:.1} mm")
            }
            Self::Motion { screw, .. } => format!(
                "turn by {:.0} degrees about {}",
                screw.angle.to_degrees(),
                direction(&screw.axis.direction)
            ),
        }
    }
}

/// With two digits, none of them a negative zero.
fn direction(direction: &UnitVector3<f64>) -> String {
    let [x, y, z] = direction
        .into_inner()
        .map(|c| (100.0 * c).round() / 100.0 + 0.0)
        .into();
    format!("({x:.2}, {y:.2}, {z:.2})")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bop::symmetry::Axis;
    use nalgebra::{Point3, Vector3};

    #[test]
    fn a_motion_is_told_with_its_direction_and_its_amounts() {
        let leaning = UnitVector3::new_normalize(Vector3::new(-0.001, 0.6, 0.8));
        let turn = Path::Turn(Axis {
            direction: leaning,
            offset: Point3::origin(),
        });
        let words = |path, range| What::Path { path, range }.words(10.0);
        let some = Range::Between {
            low: -0.5,
            high: 2.0,
        };
        assert_eq!(
            words(turn, Range::Any),
            "turns about (0.00, 0.60, 0.80) by any angle"
        );
        assert_eq!(
            words(turn, some),
            "turns about (0.00, 0.60, 0.80) by -29 to 115 degrees"
        );
        assert_eq!(
            words(Path::Slide(leaning), some),
            "slides along (0.00, 0.60, 0.80) by -5.0 to 20.0 mm"
        );
    }
}
