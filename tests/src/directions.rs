//! Directions that a component knows something of, however its template says what it knows.

use cobra_infer::template::Component;
use cobra_infer::validity;

/// Those of its terms, in the metric's coordinates; of a component with validity, the middles of its
/// valid cells: terms may lie where it is silent, and a map has none.
#[must_use]
pub fn known_directions(component: &Component<'_>) -> Vec<[f32; 3]> {
    match component.validity {
        None => component.terms.iter().map(|(u, _)| u).collect(),
        Some(valid) => valid
            .cells()
            .map(|cell| validity::direction(valid.pole(), valid.side(), cell, [0.5; 2]))
            .collect(),
    }
}
