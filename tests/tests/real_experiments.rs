//! The quick ones of the experiments on the real data give the committed numbers.

use cobra_tests::csv::read;
use cobra_tests::data::real_data;
use cobra_tests::tolerance;
use cobra_train::experiment::{Bench, Data, Experiment};
use cobra_train::progress::Silent;

#[test]
fn the_quick_experiments_give_the_committed_numbers_again() {
    let Some(data) = real_data("the experiments' committed numbers") else {
        return;
    };
    let data = Data::read(&data).unwrap();
    let out = tempfile::tempdir().unwrap();
    let bench = Bench::new(&data, out.path().to_owned(), 0, false, &Silent);
    for experiment in [Experiment::Scatter, Experiment::Kdtree] {
        let found = experiment.run(&bench).unwrap().numbers;
        let committed = read(experiment.name());
        assert_eq!(found.rows.len(), committed.len(), "{}", experiment.name());
        for (row, committed) in found.rows.iter().zip(&committed) {
            for (name, cell) in found.header.iter().zip(row) {
                let (Ok(found), Ok(expected)) =
                    (cell.parse::<f64>(), committed[name].parse::<f64>())
                else {
                    assert_eq!(cell, &committed[name], "{}: {name}", experiment.name());
                    continue;
                };
                let off = (found - expected).abs() / expected.abs().max(1.0);
                assert!(
                    off < tolerance::SAME_EXPERIMENT,
                    "{}: {name}: {found}, committed {expected}",
                    experiment.name()
                );
            }
        }
    }
    assert!(bench.failures().is_empty());
}
