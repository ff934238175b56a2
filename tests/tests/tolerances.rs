//! The documented tolerances are the constants.

#[path = "../../cobra-infer/tests/promises/tolerance.rs"]
mod promised;

use cobra_infer::tolerance as applied;
use cobra_tests::tolerance as asserted;

#[test]
fn the_table_of_tolerances_quotes_the_constants() {
    let page = include_str!("../../docs/TOLERANCES.md");
    let constants = [
        ("UNIT_DIRECTION", f64::from(applied::UNIT_DIRECTION)),
        ("ROTATION", f64::from(applied::ROTATION)),
        ("ORTHONORMALISABLE", f64::from(applied::ORTHONORMALISABLE)),
        ("NO_DIRECTION", f64::from(applied::NO_DIRECTION)),
        ("DENSE_MEAN", asserted::DENSE_MEAN),
        ("DENSE_LIKELIHOOD", asserted::DENSE_LIKELIHOOD),
        ("DENSE_VARIANCE", asserted::DENSE_VARIANCE),
        ("FINITE_DIFFERENCE", asserted::FINITE_DIFFERENCE),
        ("SINGLE_PRECISION_MEAN", asserted::SINGLE_PRECISION_MEAN),
        ("LEARNED", asserted::LEARNED),
        ("OPTIMISERS_AGREE", asserted::OPTIMISERS_AGREE),
        ("OPTIMISERS_APART", asserted::OPTIMISERS_APART),
        ("ON_SURFACE", asserted::ON_SURFACE),
        ("REAL_CONFIDENCE", asserted::REAL_CONFIDENCE),
        ("MONTE_CARLO", asserted::MONTE_CARLO),
        ("HELD_OUT", asserted::HELD_OUT),
        ("SAME_SHAPE", asserted::SAME_SHAPE),
        ("EXACT_CONFIDENCE", asserted::EXACT_CONFIDENCE),
        ("PUBLISHED_ERROR", asserted::PUBLISHED_ERROR),
        ("SAME_EXPERIMENT", asserted::SAME_EXPERIMENT),
        ("ROUNDOFF", promised::ROUNDOFF),
        ("POSTERIOR_MEAN", promised::POSTERIOR_MEAN),
        ("CONFIDENCE", promised::CONFIDENCE),
        ("MAXIMUM_LIKELIHOOD", promised::MAXIMUM_LIKELIHOOD),
        ("DENSITY", promised::DENSITY),
        ("BY_HAND", promised::BY_HAND),
        ("QUADRATURE", promised::QUADRATURE),
        ("ORTHONORMAL", promised::ORTHONORMAL),
        ("BACK_PROJECTION", promised::BACK_PROJECTION),
        ("DISTANCE", promised::DISTANCE),
        ("TINY_NOISE", promised::TINY_NOISE),
        ("SOFT", promised::SOFT),
        ("MOVED", promised::MOVED),
        ("REORDERED", promised::REORDERED),
    ];
    let rows: Vec<(&str, f64)> = page
        .lines()
        .filter_map(|line| {
            let mut cells = line.strip_prefix("| `")?.split('|').map(str::trim);
            let name = cells.next()?.trim_end_matches('`');
            Some((name, cells.next()?.parse().ok()?))
        })
        .collect();
    assert_eq!(rows.len(), constants.len(), "{rows:?}");
    for ((name, value), (row_name, row_value)) in constants.iter().zip(&rows) {
        assert_eq!(name, row_name);
        assert!((row_value - value).abs() < 1e-6 * value, "{name}");
    }
}
