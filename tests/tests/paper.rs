//! What the committed run of `cobra experiment all` found, against what the paper prints.
//!
//! Reads `docs/paper/*.csv` and computes nothing of what is in it; that the command gives these numbers is
//! `real_experiments`' business.

use cobra_tests::csv::{Row, read};
use cobra_train::experiment::paper;

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn our_configuration_beats_the_printed_means_of_every_class() {
    let rows = read("shape");
    for class in paper::CLASSES {
        let of = |name: &str| {
            let ours = |row: &&Row| row["class"] == class && row["configuration"] == "ours";
            let values = rows
                .iter()
                .filter(ours)
                .map(|row| row[name].parse().unwrap());
            values.collect::<Vec<f64>>()
        };
        let printed = paper::shape_of(class).unwrap();
        let (f, chamfer) = (of("F %"), of("chamfer x1000"));
        assert!(f.len() >= 3, "{class}");
        assert!(mean(&f) > printed.f_score, "{class}: {f:?}");
        assert!(mean(&chamfer) < printed.chamfer, "{class}: {chamfer:?}");
    }
}

#[test]
fn the_templates_correlation_is_the_exact_distances_to_two_hundredths_in_every_class() {
    let rows = read("correlation");
    for class in paper::CLASSES {
        let of = |name: &str| {
            let rows = rows.iter().filter(|row| row["class"] == class);
            mean(
                &rows
                    .map(|row| row[name].parse().unwrap())
                    .collect::<Vec<f64>>(),
            )
        };
        let apart = of("rho of confidence") - of("rho of exact distance");
        assert!(apart.abs() <= 0.02, "{class}: {apart}");
    }
}

#[test]
fn the_papers_configuration_ranks_kernels_as_the_paper_does() {
    let rows = read("kernels");
    let group = |row: &Row| match row["class"].as_str() {
        "planes" | "chairs" => row["class"].clone(),
        _ => row["object"].clone(),
    };
    let mean_f = |kernel: &str| {
        let groups = ["planes", "chairs", "screwdriver", "stanford-bunny"].map(|name| {
            let of = rows.iter().filter(|row| {
                row["kernel"] == kernel && row["metric"] == "angles" && group(row) == name
            });
            let values: Vec<f64> = of.map(|row| row["F %"].parse().unwrap()).collect();
            assert!(!values.is_empty(), "{kernel} {name}");
            mean(&values)
        });
        mean(&groups)
    };
    let ranking = [
        "rational quadratic",
        "Matérn 5/2",
        "RBF",
        "periodic",
        "polynomial",
        "linear",
    ];
    for pair in ranking.windows(2) {
        let [above, below] = [mean_f(pair[0]), mean_f(pair[1])];
        assert!(above > below, "{} {above}, {} {below}", pair[0], pair[1]);
    }
}

#[test]
fn few_input_points_are_worth_twice_as_much_as_in_a_k_d_tree() {
    let rows = read("kdtree");
    let few = rows
        .iter()
        .filter(|row| row["input points"].parse::<u32>().unwrap() <= 500);
    let ratios: Vec<f64> = few.map(|row| row["ratio"].parse().unwrap()).collect();
    assert_eq!(ratios.len(), 4 * 4);
    assert!(ratios.iter().all(|ratio| *ratio <= 0.5), "{ratios:?}");
}
