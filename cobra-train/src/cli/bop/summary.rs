//! What scores are worth, as a table.

use crate::cli::report::table;
use cobra_train::bop::score::{Scored, Summary};
use std::collections::BTreeSet;

const HEADER: [&str; 11] = [
    "object",
    "rows",
    "scored",
    "accept",
    "reject",
    "undecided",
    "right",
    "AUC",
    "own AUC",
    "rho",
    "error rho",
];

pub(super) fn text(scored: &[Scored]) -> String {
    let objects: BTreeSet<u32> = scored
        .iter()
        .filter_map(|row| row.estimate.as_ref())
        .map(|estimate| estimate.obj_id)
        .collect();
    let of_object = |object: u32| {
        Summary::of(scored.iter().filter(|row| {
            let estimate = row.estimate.as_ref();
            estimate.is_some_and(|estimate| estimate.obj_id == object)
        }))
    };
    let mut rows: Vec<Vec<String>> = objects
        .into_iter()
        .map(|object| line(&object.to_string(), &of_object(object)))
        .collect();
    let all = Summary::of(scored);
    rows.push(line("all", &all));
    let mut text = table(&HEADER, &[], &rows);
    if all.known > 0 {
        text.push_str(
            "\n\nright: ADD (ADD-S where models_info.json states a symmetry) below 0.1 of the diameter; \
             AUC: of the\nconfidence, and of the file's own score, in telling right from wrong; rho: rank \
             correlation with the error\nas a share of the diameter, of the confidence and of the estimated \
             error",
        );
    }
    if let Some(ratio) = all.error_ratio {
        text.push_str(&format!(
            "\nestimated over true error, median of wrong estimates within half a diameter: {ratio:.2}"
        ));
    }
    text
}

fn line(name: &str, summary: &Summary) -> Vec<String> {
    let [accept, reject, undecided] = summary.decisions;
    let counts = [summary.rows, summary.scored, accept, reject, undecided];
    let measure = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.4}"));
    let mut cells = vec![name.to_owned()];
    cells.extend(counts.map(|count| count.to_string()));
    cells.push(match summary.known {
        0 => "-".to_owned(),
        known => format!("{}/{known}", summary.right),
    });
    cells.extend(
        [
            summary.area,
            summary.own_area,
            summary.correlation,
            summary.error_correlation,
        ]
        .map(measure),
    );
    cells
}
