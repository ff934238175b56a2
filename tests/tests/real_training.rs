//! Meshes and clouds from many hands: each becomes a template, or one line says why not.

use cobra_infer::Template;
use cobra_tests::data::{files_below, real_data};
use cobra_train::gp::Subset;
use cobra_train::progress::Silent;
use cobra_train::surface::read_geometry;
use cobra_train::train::{TrainOptions, train};
use std::path::Path;

fn outcome(path: &Path) -> Result<usize, String> {
    let read = read_geometry(path).map_err(|error| error.to_string())?;
    let mut options = TrainOptions {
        points: 1000,
        test_points: 2000,
        ..TrainOptions::clustered("mesh", 8)
    };
    // Whether it trains is asked, not how well.
    options.fit.subset = Subset::Points(50);
    let trained = train(&read.geometry, &options, &Silent).map_err(|error| error.to_string())?;
    let template = Template::from_bytes(&trained.bytes).map_err(|error| error.to_string())?;
    Ok(template.component_count())
}

#[test]
fn every_mesh_and_cloud_trains_or_ends_in_one_clear_line() {
    let Some(data) = real_data("training every mesh and cloud") else {
        return;
    };
    let formats = ["glb", "obj", "off", "ply", "stl"];
    let paths: Vec<_> = [
        "meshes",
        "clouds",
        "screwdriver",
        "lmo/models",
        "lmo/models_eval",
    ]
    .iter()
    .flat_map(|folder| files_below(&data.join(folder), &formats))
    .collect();
    assert!(!paths.is_empty());
    let page = include_str!("../../docs/INPUTS.md");
    for path in &paths {
        let name = path.strip_prefix(&data).unwrap_or(path).display();
        assert!(page.contains(&format!("| `{name}` |")), "{name} has no row");
    }
    let mut refused = 0;
    for path in &paths {
        match outcome(path) {
            Ok(components) => assert_eq!(components, 8, "{}", path.display()),
            Err(line) => {
                println!("{}: {line}", path.display());
                refused += 1;
                assert_eq!(line.lines().count(), 1, "{line}");
                assert!(line.len() < 500, "{line}");
            }
        }
    }
    assert_eq!(refused, 0, "files that were trained before");
}
