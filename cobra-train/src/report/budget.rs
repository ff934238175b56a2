//! What a template takes on controllers.
//!
//! Owns how a template's cost and a board's figures become instructions; the figures are those of
//! `tests/run firmware`, which writes `assets/boards.csv` together with the top README's table.

use cobra_infer::{Assignment, Exponent, Kernel, Metric, Template};
use nalgebra::Point3;
use rayon::prelude::*;
use serde::Serialize;
use std::sync::LazyLock;

/// What a board takes: bytes, and instructions as QEMU executes them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Board {
    /// As rustc has it.
    pub target: &'static str,
    /// As QEMU has it.
    pub board: &'static str,
    /// Bytes of code and constants of scoring.
    pub code: u32,
    /// Bytes of stack.
    pub stack: u32,
    /// The same of a check against depth.
    pub depth_code: u32,
    /// The same.
    pub depth_stack: u32,
    /// Instructions of a point, without its components.
    pub point: f64,
    /// Of a component.
    pub component: f64,
    /// Of a component with a precision of its own.
    pub component_with_precisions: f64,
    /// Of a kernel evaluation with exponent 1 and with ½.
    pub evaluation: [f64; 2],
}

/// A board, and what a template takes on it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BoardBudget {
    /// The board.
    #[serde(flatten)]
    pub board: Board,
    /// A processor of this kind, and its clock in MHz.
    pub processor: (&'static str, f64),
    /// Instructions of a point; `None` where evaluations of this kernel, or of maps, were not measured.
    pub instructions: Option<Instructions>,
}

/// Instructions of a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Instructions {
    /// At most, by [`Template::cost`].
    pub most: f64,
    /// On the mean of points of the surface, at most: of the components that may speak in their directions.
    pub mean: Option<f64>,
}

const CSV: &str = include_str!("../../assets/boards.csv");

/// The boards that were measured.
#[must_use]
pub fn boards() -> &'static [Board] {
    static BOARDS: LazyLock<Vec<Board>> = LazyLock::new(|| {
        // The compiler, then the names of the columns. A test reads the file.
        CSV.lines().skip(2).filter_map(board).collect()
    });
    &BOARDS
}

fn board(line: &'static str) -> Option<Board> {
    let mut cells = line.split(',');
    let (target, board) = (cells.next()?, cells.next()?);
    let mut count = || cells.next()?.parse().ok();
    let [code, stack, depth_code, depth_stack] = [count()?, count()?, count()?, count()?];
    let mut number = || cells.next()?.parse().ok();
    Some(Board {
        target,
        board,
        code,
        stack,
        depth_code,
        depth_stack,
        point: number()?,
        component: number()?,
        component_with_precisions: number()?,
        evaluation: [number()?, number()?],
    })
}

/// The compiler that the boards were measured with.
#[must_use]
pub fn compiler() -> &'static str {
    CSV.lines()
        .next()
        .unwrap_or_default()
        .trim_start_matches("# ")
}

/// A processor of a target's kind that is widely used, and its clock: an example, which no figure depends on but
/// the milliseconds.
fn processor(target: &str, board: &str) -> (&'static str, f64) {
    match (target, board) {
        ("thumbv6m-none-eabi", _) => ("Cortex-M0+, 48 MHz", 48.0),
        ("thumbv7m-none-eabi", _) => ("Cortex-M3, 72 MHz", 72.0),
        ("thumbv7em-none-eabihf", _) => ("Cortex-M4F, 168 MHz", 168.0),
        (_, "mps3-an547") => ("Cortex-M55, 400 MHz", 400.0),
        ("thumbv8m.main-none-eabihf", _) => ("Cortex-M33F, 160 MHz", 160.0),
        ("riscv32imafc-unknown-none-elf", _) => ("RISC-V with F, 360 MHz", 360.0),
        ("riscv32imac-unknown-none-elf", _) => ("RISC-V, 160 MHz", 160.0),
        _ => ("100 MHz", 100.0),
    }
}

/// What a template takes on each board; means over `points`, which are of its surface.
pub(super) fn of(
    template: &Template<'_>,
    assignment: Assignment,
    points: Option<&[Point3<f64>]>,
) -> Vec<BoardBudget> {
    let exponent = exponent(template);
    let mean = points.map(|points| mean_evaluations(template, assignment, points));
    let components = template.component_count() as f64;
    boards()
        .iter()
        .map(|board| {
            let each = if template.has_precisions() {
                board.component_with_precisions
            } else {
                board.component
            };
            let of = |evaluations: f64, exponent: usize| {
                board.point + components * each + evaluations * board.evaluation[exponent]
            };
            BoardBudget {
                instructions: exponent.map(|exponent| Instructions {
                    most: of(template.cost().of(assignment) as f64, exponent),
                    mean: mean.map(|mean| of(mean, exponent)),
                }),
                processor: processor(board.target, board.board),
                board: board.clone(),
            }
        })
        .collect()
}

/// Which of the two measured kernels a template has, if one of them.
fn exponent(template: &Template<'_>) -> Option<usize> {
    if template.has_maps() || template.metric() != Metric::Chord {
        return None;
    }
    match template.kernel() {
        Kernel::RationalQuadratic(Exponent::One) => Some(0),
        Kernel::RationalQuadratic(Exponent::Half) => Some(1),
        _ => None,
    }
}

/// How many kernel evaluations a point of the surface takes on the mean, at most.
///
/// Asked are at most the components that may speak in the point's direction from them; the search leaves out
/// those that cannot be the most probable, which only the scorer knows.
fn mean_evaluations(
    template: &Template<'_>,
    assignment: Assignment,
    points: &[Point3<f64>],
) -> f64 {
    let components: Vec<_> = template.components().collect();
    let squared =
        |point: &Point3<f32>, centre: [f32; 3]| (point - Point3::from(centre)).norm_squared();
    let sum: usize = points
        .par_iter()
        .map(|point| {
            let point = point.cast::<f32>();
            let speaking = components.iter().filter(|component| {
                component.validity.is_none_or(|validity| {
                    let offset = point - Point3::from(component.centre);
                    validity.contains_direction(offset.into())
                })
            });
            match assignment {
                Assignment::Nearest => speaking
                    .min_by(|a, b| squared(&point, a.centre).total_cmp(&squared(&point, b.centre)))
                    .map_or(0, |component| component.terms.len()),
                Assignment::Maximum | Assignment::Soft => {
                    speaking.map(|component| component.terms.len()).sum()
                }
            }
        })
        .sum();
    sum as f64 / points.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_board_of_the_file_is_read_and_has_its_processor() {
        assert_eq!(boards().len(), CSV.lines().count() - 2);
        assert!(compiler().starts_with("rustc "), "{}", compiler());
        for board in boards() {
            assert_ne!(
                processor(board.target, board.board).0,
                "100 MHz",
                "{}",
                board.target
            );
            assert!(
                board.code > 10_000 && board.depth_stack > board.stack,
                "{board:?}"
            );
            assert!(board.evaluation[0] > 1.0, "{board:?}");
        }
    }
}
