//! Templates with all that is optional: compact terms, validity, quality.

use crate::content::{Compact, Content, Measured, Part, Valid, content};
use cobra_infer::Metric;
use cobra_infer::gp::compact::GRID;
use cobra_infer::validity::Pole;
use proptest::prelude::*;

/// A part's terms on the grid, and its length scale in its steps.
pub(crate) fn compacted(part: &Part) -> Part {
    let most = part
        .weights
        .iter()
        .fold(1e-3_f32, |most, w| most.max(w.abs()));
    let scale = most / 32767.0;
    let round = |x: f32| (x + 0.5 * x.signum()) as i32;
    let mut compact = part.clone();
    compact.compact = Some(Compact {
        directions: part
            .directions
            .iter()
            .map(|u| [u.x, u.y, u.z].map(|x| round(GRID * x) as i8))
            .collect(),
        weights: part
            .weights
            .iter()
            .map(|w| round(w / scale) as i16)
            .collect(),
        scale,
    });
    compact
}

impl Valid {
    /// Every direction, and all of space.
    pub(crate) fn everywhere() -> Self {
        Self {
            pole: Pole::PlusZ,
            side: 8,
            cells: vec![true; 64],
            low: [0; 3],
            high: [127; 3],
        }
    }
}

/// The small template with all that is optional. Every fifth cell is not valid, so that all blocks are
/// mixed but one that is full and one that is empty.
pub(crate) fn small() -> Content {
    let mut content = Content::small();
    for part in &mut content.parts {
        let cell = |place: usize| match (place / 8 / 4, place % 8 / 4) {
            (0, 0) => true,
            (1, 1) => false,
            _ => !place.is_multiple_of(5),
        };
        *part = compacted(part);
        part.hyperparameters.length_scale *= GRID;
        part.validity = Some(Valid {
            pole: Pole::MinusX,
            cells: (0..64).map(cell).collect(),
            low: [1, 0, 3],
            high: [120, 127, 110],
            ..Valid::everywhere()
        });
    }
    content.quality = Some(Measured {
        covered: 0.75,
        deviations: [0.5, 0.125],
        unexplained: vec![0.0, 1.0],
    });
    content
}

fn valid() -> impl Strategy<Value = Valid> {
    let axis = (0_u8..128, 0_u8..128).prop_map(|(a, b)| (a.min(b), a.max(b)));
    let cells = (
        1_u8..=16,
        prop::sample::select(&[0.0, 0.02, 0.5, 0.98, 1.0][..]),
    )
        .prop_flat_map(|(blocks, share)| {
            let side = 4 * blocks;
            let count = usize::from(side).pow(2);
            let cell = prop::bool::weighted(share);
            (Just(side), prop::collection::vec(cell, count), 0..count)
        });
    (
        prop::sample::select(Pole::ALL.as_slice()),
        cells,
        [axis.clone(), axis.clone(), axis],
    )
        .prop_map(|(pole, (side, mut cells, one), axes)| {
            cells[one] = true;
            Valid {
                pole,
                side,
                cells,
                low: axes.map(|(low, _)| low),
                high: axes.map(|(_, high)| high),
            }
        })
}

/// Any template, with validity, and with compact terms where the metric has them.
pub(crate) fn charts() -> impl Strategy<Value = Content> {
    (
        content(),
        prop::collection::vec(valid(), 5),
        any::<bool>(),
        0.0_f32..=1.0,
    )
        .prop_map(|(mut content, valids, compact, share)| {
            for (part, valid) in content.parts.iter_mut().zip(valids) {
                if compact && content.model.metric == Metric::Chord {
                    *part = compacted(part);
                }
                part.validity = Some(valid);
            }
            content.quality = Some(Measured {
                covered: share,
                deviations: [share, 0.5 * share],
                unexplained: vec![share; content.parts.len()],
            });
            content
        })
}
