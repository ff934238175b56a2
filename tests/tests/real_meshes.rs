//! Real meshes from many sources: all of them are read, and sampled on their surface.

use std::path::Path;

use cobra_tests::data::{files_below, real_data};
use cobra_tests::tolerance;
use cobra_train::random::Purpose;
use cobra_train::surface::{RayCaster, read_mesh, sample_visible};

#[test]
fn every_mesh_is_read_and_sampled_on_its_surface() {
    let Some(data) = real_data("reading and sampling every mesh") else {
        return;
    };
    let mut paths = files_below(&data.join("meshes"), &["glb", "obj", "off", "ply", "stl"]);
    paths.extend(files_below(&data.join("screwdriver"), &["ply"]));
    assert!(!paths.is_empty());
    let mut failures = Vec::new();
    for path in &paths {
        match farthest_sample(path) {
            Ok(farthest) if farthest < tolerance::ON_SURFACE => {}
            Ok(farthest) => failures.push(format!("{}: {farthest} off", path.display())),
            Err(error) => failures.push(format!("{}: {error}", path.display())),
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// The largest distance from the mesh of 2,000 points sampled on it.
fn farthest_sample(path: &Path) -> Result<f64, Box<dyn std::error::Error>> {
    let mesh = read_mesh(path)?;
    let mesh = mesh.normalised(&mesh.bounding_sphere());
    let caster = RayCaster::new(&mesh);
    let points = sample_visible(&mesh, &caster, 2000, 1, Purpose::Training)?;
    assert_eq!(points.len(), 2000);
    let distances = points.iter().map(|p| caster.distance(&p.position));
    Ok(distances.fold(0.0, f64::max))
}
