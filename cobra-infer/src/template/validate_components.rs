//! What is checked of each component before a template is used: its record, its terms or its map, its
//! precision.

use super::error::TemplateError;
use super::number::{Number, Range};
use super::{Precision, Stored, Template, Validity};
use crate::gp::Hyperparameters;
use crate::gp::compact::{self, GRID};
use crate::gp::map::Map;
use crate::kernel::{Kernel, Metric};
use crate::math;
use crate::tolerance;
use core::f32::consts::PI;

pub(super) fn check_components(template: &Template<'_>) -> Result<(), TemplateError> {
    for (component, stored) in template.stored().enumerate() {
        check_record(template.kernel(), component, stored)?;
        let terms = stored.terms();
        for (term, (direction, weight)) in terms.exact().enumerate() {
            if !weight.is_finite() {
                return Err(TemplateError::Weight { component, term });
            }
            check_direction(template.metric(), component, term, direction)?;
        }
        if let Some(found) = terms.compact_scale()
            && !normal(found)
        {
            return Err(TemplateError::ComponentNumber {
                component,
                number: Number::WeightScale,
                expected: Range::Normal,
                found,
            });
        }
        if let Some(map) = terms.map() {
            let validity = template.validities.and_then(|all| all.get(component));
            check_map(component, &map, validity)?;
        }
        for (term, direction) in terms.grid_directions().enumerate() {
            if !compact::is_unit(direction) {
                return Err(TemplateError::Direction {
                    component,
                    term,
                    squared_norm: compact::squared_norm(direction) as f32 / (GRID * GRID),
                });
            }
        }
    }
    Ok(())
}

fn check_map(
    component: usize,
    map: &Map<'_>,
    validity: Option<Validity<'_>>,
) -> Result<(), TemplateError> {
    let [x, y] = map.origin();
    for (number, expected, found) in [
        (Number::MapScale, Range::Normal, map.scale()),
        (Number::MapSpacing, Range::Normal, map.spacing()),
        (Number::MapOrigin, Range::Finite, x),
        (Number::MapOrigin, Range::Finite, y),
    ] {
        let holds = match expected {
            Range::Finite => found.is_finite(),
            _ => normal(found),
        };
        if !holds {
            return Err(TemplateError::ComponentNumber {
                component,
                number,
                expected,
                found,
            });
        }
    }
    let pole = map.pole_number();
    // That it is a pole's number, validity is asked.
    let same_pole = validity.is_some_and(|validity| validity.pole_number() == pole);
    if map.is_whole() && same_pole {
        return Ok(());
    }
    Err(TemplateError::MapGrid {
        component,
        columns: map.columns(),
        rows: map.rows(),
        pole,
        found: map.nodes().len(),
    })
}

fn check_record(kernel: Kernel, component: usize, stored: Stored<'_>) -> Result<(), TemplateError> {
    let [x, y, z] = stored.centre();
    let Hyperparameters {
        length_scale: l,
        parameter: p,
        prior_mean,
    } = stored.hyperparameters();
    for (number, expected, found) in [
        (Number::ReferencePoint, Range::Finite, x),
        (Number::ReferencePoint, Range::Finite, y),
        (Number::ReferencePoint, Range::Finite, z),
        (Number::SigmaHat, Range::Normal, stored.sigma_hat()),
        (Number::LengthScale, Range::of_length_scale(kernel), l),
        (Number::parameter(kernel), Range::of_parameter(kernel), p),
        (Number::PriorMean, Range::Finite, prior_mean),
    ] {
        let holds = match expected {
            Range::Finite => found.is_finite(),
            Range::Normal => normal(found),
            Range::NormalSquare => found > 0.0 && normal(found * found),
            Range::NormalProduct => normal(found) && normal(2.0 * found * l * l),
            Range::One => found == 1.0,
            Range::Fixed => kernel.fixed_parameter() == Some(found),
        };
        if !holds {
            return Err(TemplateError::ComponentNumber {
                component,
                number,
                expected,
                found,
            });
        }
    }
    Ok(())
}

fn check_direction(
    metric: Metric,
    component: usize,
    term: usize,
    direction: [f32; 3],
) -> Result<(), TemplateError> {
    match metric {
        Metric::Chord => {
            let squared_norm = math::dot(direction, direction);
            let unit = math::abs(squared_norm - 1.0) <= tolerance::UNIT_DIRECTION;
            if unit {
                Ok(())
            } else {
                Err(TemplateError::Direction {
                    component,
                    term,
                    squared_norm,
                })
            }
        }
        // Loading has refused it.
        Metric::Angles if !metric.is_compiled_in() => Ok(()),
        Metric::Angles => {
            // The f32 nearest to π, which an arctangent in f32 may return, lies above π.
            let [phi, theta, rest] = direction;
            let inside = (0.0..=PI).contains(&phi) && (-PI..=PI).contains(&theta);
            if inside && rest == 0.0 {
                Ok(())
            } else {
                Err(TemplateError::Angles { component, term })
            }
        }
    }
}

pub(super) fn check_precisions(template: &Template<'_>) -> Result<(), TemplateError> {
    let Some(factors) = template.precisions else {
        return Ok(());
    };
    let (expected, found) = (template.component_count(), factors.len());
    if expected != found {
        return Err(TemplateError::PrecisionCount { expected, found });
    }
    for (component, factor) in factors.iter().enumerate() {
        if !Precision::from_record(factor).is_valid() {
            return Err(TemplateError::Precision { component });
        }
    }
    Ok(())
}

/// Finite, positive, and with a finite inverse.
pub(super) fn normal(value: f32) -> bool {
    value.is_finite() && value >= f32::MIN_POSITIVE
}
