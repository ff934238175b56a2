//! `cobra train --coverage`: the table of how many residuals lie within z standard deviations.

use super::report::table;
use cobra_train::coverage::{Calibration, Coverage, half_width};

/// Points that coverage is measured on.
pub(super) const POINTS: usize = 30_000;

/// The table, lengths in `unit`; `points` says what points these are.
pub(super) fn text(coverage: &Coverage, points: &str, unit: &str) -> String {
    let columns = [&coverage.latent, &coverage.observed, &coverage.sigma_hat];
    let row = |name: String, z: String, cell: &dyn Fn(&Calibration) -> String| {
        let mut row = vec![name, z];
        row.extend(columns.iter().map(|calibration| cell(calibration)));
        row
    };
    let mut rows: Vec<Vec<String>> = coverage
        .nominal
        .iter()
        .enumerate()
        .map(|(index, nominal)| {
            let z = half_width(nominal / 100.0);
            row(format!("{nominal} %"), format!("{z:.3}"), &|calibration| {
                format!("{:.1} %", calibration.within[index])
            })
        })
        .collect();
    rows.push(row(
        format!("mean sigma, {unit}"),
        String::new(),
        &|calibration| format!("{:.4}", calibration.mean_sigma),
    ));
    rows.push(row(
        "mean sigma / rms residual".to_owned(),
        String::new(),
        &|calibration| format!("{:.3}", calibration.sigma_over_residual),
    ));
    let header = ["nominal", "z", "GP", "GP with noise", "sigma-hat"];
    format!(
        "share of residuals within z sigma: {} {points}, rms residual {:.4} {unit}\n\n{}",
        coverage.points,
        coverage.rms_residual,
        table(&header, &["nominal"], &rows)
    )
}
