//! What is checked of validities, so that no direction and no box leads outside of them.

use super::error::TemplateError;
use super::validity::{Row, Validities, Validity};
use super::wire::{LEAF_LENGTH, MOST_BLOCKS, ROW_LENGTH};
use crate::validity::{BOX_STEPS, Pole};

pub(super) fn check(validities: &Validities<'_>, components: usize) -> Result<(), TemplateError> {
    let (expected, found) = (components, validities.records.len());
    if expected != found {
        return Err(TemplateError::ValidityCount { expected, found });
    }
    let mut next = 0_usize;
    for component in 0..components {
        let Some(validity) = validities.get(component) else {
            break;
        };
        check_record(component, validity)?;
        let range = TemplateError::ValidityRange { component };
        if usize::try_from(validity.first()) != Ok(next) {
            return Err(range);
        }
        let (rows, leaves) = validity.run().ok_or(range)?;
        if let Some(row) = first_fault(validity.blocks(), rows, leaves) {
            return Err(TemplateError::ValidityCells { component, row });
        }
        next = next
            .saturating_add(rows.as_flattened().len())
            .saturating_add(leaves.as_flattened().len());
    }
    if next != validities.cells.len() {
        return Err(TemplateError::UnusedCells {
            expected: next,
            found: validities.cells.len(),
        });
    }
    Ok(())
}

fn check_record(component: usize, validity: Validity<'_>) -> Result<(), TemplateError> {
    let (low, high) = (validity.low(), validity.high());
    let mut axes = low.iter().zip(high);
    if !axes.all(|(low, high)| *low <= high && high < BOX_STEPS) {
        return Err(TemplateError::ValidityBox {
            component,
            low,
            high,
        });
    }
    let (pole, blocks) = (validity.pole_number(), validity.blocks());
    let (first, rows) = validity.rows();
    let inside = u16::from(first) + u16::from(rows) <= u16::from(blocks);
    let holds = Pole::from_number(pole).is_some() && (1..=MOST_BLOCKS).contains(&blocks) && inside;
    if !holds {
        return Err(TemplateError::ValidityGrid {
            component,
            pole,
            blocks,
            first,
            rows,
        });
    }
    Ok(())
}

/// The first row that is not as it must be, or as many as there are where all are and yet none has a
/// valid cell or there are more mixed blocks than they say.
fn first_fault(
    blocks: u8,
    rows: &[[u8; ROW_LENGTH]],
    leaves: &[[u8; LEAF_LENGTH]],
) -> Option<usize> {
    let mut rest = leaves;
    let mut valid = false;
    for (index, row) in rows.iter().enumerate() {
        let Row { full, mixed, rank } = Row::from_bytes(*row);
        let some = u32::from(full | mixed);
        let before = leaves.len().saturating_sub(rest.len());
        let Some((own, behind)) = rest.split_at_checked(mixed.count_ones() as usize) else {
            return Some(index);
        };
        let spelled_out = own
            .iter()
            .all(|leaf| !matches!(u16::from_le_bytes(*leaf), 0 | u16::MAX));
        let holds = full & mixed == 0
            && some.checked_shr(u32::from(blocks)) == Some(0)
            && usize::from(rank) == before
            && spelled_out;
        if !holds {
            return Some(index);
        }
        valid |= some != 0;
        rest = behind;
    }
    let holds = valid && rest.is_empty();
    (!holds).then_some(rows.len())
}
