//! What a template costs to ask, from its records alone.

use super::Template;
use crate::gp::map;
use crate::mixture::Assignment;

/// What scoring one point costs at most, in kernel evaluations: terms of which the posterior mean
/// is summed. Of maps, in nodes that are read: [`map::READS`] a component that is asked.
///
/// Each bound is reached by some point, and exceeded by none: not by one that is NaN, infinite, on
/// a reference point or far away. With validity it need not be reached: components are silent in
/// places, and those that cannot be the most probable are not asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Cost {
    /// With nearest assignment: the terms of the largest component.
    pub nearest: usize,
    /// With maximum assignment, which asks every component that the point has a direction from, and
    /// with soft assignment, which leaves out those of no weight: the terms of all components, or the
    /// nodes that one map reads times their number.
    pub maximum: usize,
}

impl Cost {
    /// The most that an assignment needs for one point.
    #[must_use]
    pub const fn of(self, assignment: Assignment) -> usize {
        match assignment {
            Assignment::Nearest => self.nearest,
            Assignment::Maximum | Assignment::Soft => self.maximum,
        }
    }
}

impl Template<'_> {
    /// The most kernel evaluations that one point costs, from the components' records: a table of
    /// worst-case times can be made before any point is seen.
    #[must_use]
    pub fn cost(&self) -> Cost {
        if self.has_maps() {
            return Cost {
                nearest: map::READS,
                maximum: map::READS.saturating_mul(self.component_count()),
            };
        }
        Cost {
            nearest: self
                .components()
                .map(|component| component.terms.len())
                .max()
                .unwrap_or(0),
            maximum: self.term_count(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gp::{Hyperparameters, UnitDirection, evaluations};
    use crate::kernel::{Kernel, Model};
    use crate::mixture::{Mixture, Settings};
    use crate::template::{
        ComponentSource, Precision, TemplateSource, TermsSource, encode, encoded_len,
    };
    use crate::unit::Unit;
    use nalgebra::{Point3, Vector3};
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;
    use std::vec;
    use std::vec::Vec;

    const ASSIGNMENTS: [Assignment; 3] =
        [Assignment::Nearest, Assignment::Maximum, Assignment::Soft];

    const MOST: usize = 6;

    /// Where a component lies, how many terms it has, and the diagonal of its precision's factor.
    type Part = ([f32; 3], usize, [f32; 3]);

    fn encoded(parts: &[Part], kernel: Kernel, precisions: bool) -> Vec<u8> {
        let direction = UnitDirection::new_normalize(Vector3::new(0.6, 0.0, 0.8));
        let (directions, weights) = (vec![direction; 40], vec![0.5; 40]);
        let components: Vec<ComponentSource<'_>> = parts
            .iter()
            .map(|&(centre, terms, [xx, yy, zz])| ComponentSource {
                centre,
                sigma_hat: 0.5,
                precision: Precision::from_factor([xx, 0.0, yy, 0.0, 0.0, zz])
                    .filter(|_| precisions),
                hyperparameters: Hyperparameters {
                    length_scale: kernel.fixed_length_scale().unwrap_or(0.4),
                    parameter: kernel.fixed_parameter().unwrap_or(0.8),
                    prior_mean: 10.0,
                },
                terms: TermsSource::Exact {
                    directions: &directions[..terms],
                    weights: &weights[..terms],
                },
                validity: None,
            })
            .collect();
        let source = TemplateSource {
            name: "cost",
            unit: Unit::Millimetre,
            centre: [0.0; 3],
            radius: 50.0,
            diameter: 100.0,
            model: Model::chord(kernel),
            components: &components,
            quality: None,
            depth: None,
        };
        let mut bytes = vec![0; encoded_len(&source)];
        let length = encode(&source, &mut bytes).unwrap();
        bytes.truncate(length);
        bytes
    }

    /// How many kernel evaluations one point makes.
    fn counted(template: &Template<'_>, assignment: Assignment, point: [f32; 3]) -> usize {
        let settings = Settings {
            assignment,
            ..Settings::with_delta(2.0)
        };
        let mixture = Mixture::<MOST>::new(template, &settings).unwrap();
        evaluations::during(|| mixture.evaluate(&Point3::from(point))).1
    }

    fn kernels() -> impl Strategy<Value = Kernel> {
        proptest::sample::select(Kernel::ALL.as_slice())
    }

    fn parts() -> impl Strategy<Value = Vec<Part>> {
        let part = (
            [-50.0_f32..50.0, -50.0..50.0, -50.0..50.0],
            1_usize..40,
            [0.001_f32..2.0, 0.001..2.0, 0.001..2.0],
        );
        proptest::collection::vec(part, 1..=MOST)
    }

    /// Inside, at the rim of `f32`, or no number at all.
    fn coordinate() -> impl Strategy<Value = f32> {
        prop_oneof![
            8 => -80.0_f32..80.0,
            1 => -1e6_f32..1e6,
            1 => proptest::sample::select(&[
                f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e19, -1e19, 0.0, -0.0,
                f32::MIN_POSITIVE,
            ][..]),
        ]
    }

    fn config() -> ProptestConfig {
        ProptestConfig {
            rng_seed: RngSeed::Fixed(1),
            failure_persistence: None,
            ..ProptestConfig::default()
        }
    }

    proptest! {
        #![proptest_config(config())]

        #[test]
        fn no_point_costs_more_than_the_records_say(
            parts in parts(),
            kernel in kernels(),
            precisions: bool,
            points in proptest::collection::vec([coordinate(), coordinate(), coordinate()], 1..20),
        ) {
            let bytes = encoded(&parts, kernel, precisions);
            let template = Template::from_bytes(&bytes).unwrap();
            let centres = parts.iter().map(|part| part.0);
            for point in points.into_iter().chain(centres) {
                for assignment in ASSIGNMENTS {
                    let bound = template.cost().of(assignment);
                    let found = counted(&template, assignment, point);
                    prop_assert!(found <= bound, "{assignment:?} {point:?}: {found} > {bound}");
                }
            }
        }

        #[test]
        fn some_point_costs_as_much_as_the_records_say(
            parts in parts(),
            kernel in kernels(),
            precisions: bool,
        ) {
            // Far enough apart that the point beside each reference point is its own, and so near
            // that the weight of none vanishes.
            let parts: Vec<Part> = parts
                .into_iter()
                .zip(0_u8..)
                .map(|((_, terms, _), k)| ([f32::from(k) * 8.0, 3.0, -2.0], terms, [0.1; 3]))
                .collect();
            let bytes = encoded(&parts, kernel, precisions);
            let template = Template::from_bytes(&bytes).unwrap();
            for assignment in ASSIGNMENTS {
                let most = parts
                    .iter()
                    .map(|&([x, y, z], ..)| counted(&template, assignment, [x + 0.5, y, z]))
                    .max();
                prop_assert_eq!(most, Some(template.cost().of(assignment)), "{:?}", assignment);
            }
        }
    }
}
