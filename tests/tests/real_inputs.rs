//! Real files of the formats that come from elsewhere than CAD: scans, web assets, data sets.

use cobra_infer::{Camera, Unit};
use cobra_tests::data::{files_below, real_data};
use cobra_train::input::{CameraFile, ImageSize, read_camera};
use cobra_train::random::{Purpose, stream};
use cobra_train::surface::{Geometry, Mesh, ReadGeometry, read_geometry};
use nalgebra::Point3;
use rand::RngExt;
use std::collections::HashSet;
use std::path::Path;

fn read_mesh_and_unit(path: &Path) -> (Mesh, Option<Unit>) {
    let ReadGeometry { geometry, unit } = read_geometry(path).unwrap();
    match geometry {
        Geometry::Mesh(mesh) => (mesh, unit),
        Geometry::Cloud(_) => panic!("{}: no faces", path.display()),
    }
}

#[test]
fn every_cloud_is_read_and_divided_without_overlap() {
    let Some(data) = real_data("reading every point cloud") else {
        return;
    };
    let paths = files_below(&data.join("clouds"), &["ply"]);
    assert!(!paths.is_empty());
    let bits = |points: &[Point3<f64>]| -> HashSet<[u64; 3]> {
        let bits = points.iter().map(|p| [p.x, p.y, p.z].map(f64::to_bits));
        bits.collect()
    };
    for path in paths {
        let Geometry::Cloud(cloud) = read_geometry(&path).unwrap().geometry else {
            panic!("{}: faces", path.display());
        };
        let count = cloud.points().len();
        assert_eq!(count + cloud.dropped_duplicates(), 5000);
        let split = cloud.split(10_000, 30_000, 0);
        assert_eq!(split.training.len(), count * 3 / 4);
        let (training, test) = (bits(&split.training), bits(&split.test));
        assert!(training.is_disjoint(&test));
        assert_eq!(training.len() + test.len(), count);
        assert!(cloud.diameter() > 0.0);
    }
}

#[test]
fn a_binary_gltf_has_its_nodes_transform_and_its_unit() {
    let Some(data) = real_data("reading a binary glTF file") else {
        return;
    };
    let (mesh, unit) = read_mesh_and_unit(&data.join("meshes/chairs/habitat_chair.glb"));
    assert_eq!(unit, Some(Unit::Metre));
    assert_eq!(mesh.triangles().len() + mesh.dropped_triangles(), 1008);
    // The bounds that the file states, times the node's scale.
    let low = Point3::new(-33.471_931_457, -65.724_967_956, -21.049_194_335) * 0.01;
    let high = Point3::new(18.663_063_049, 24.323_333_740, 22.236_785_888) * 0.01;
    let vertices = mesh.vertices();
    let found_low = vertices.iter().fold(vertices[0], |low, v| low.inf(v));
    let found_high = vertices.iter().fold(vertices[0], |high, v| high.sup(v));
    assert!((found_low - low).norm() < 1e-7, "{found_low}");
    assert!((found_high - high).norm() < 1e-7, "{found_high}");
}

#[test]
fn off_files_have_as_many_vertices_and_faces_as_they_say() {
    let Some(data) = real_data("reading OFF files") else {
        return;
    };
    for (name, vertices, faces) in [
        ("chairs/modelnet_chair_0001.off", 2382, 2234),
        ("sofas/modelnet_sofa_0005.off", 546, 284),
    ] {
        let (mesh, unit) = read_mesh_and_unit(&data.join("meshes").join(name));
        assert_eq!(unit, None);
        assert_eq!(mesh.vertices().len(), vertices);
        assert_eq!(mesh.triangles().len() + mesh.dropped_triangles(), faces);
    }
}

#[test]
fn a_data_sets_camera_files_agree() {
    let Some(data) = real_data("BOP's camera files") else {
        return;
    };
    let CameraFile::One(one) = read_camera(&data.join("lmo/camera.json")).unwrap() else {
        panic!("camera.json is one camera");
    };
    let camera = Camera::new(572.4114, 573.57043, 325.2611, 242.049).unwrap();
    assert_eq!(one.camera, camera);
    let (width, height) = (640, 480);
    assert_eq!(one.size, Some(ImageSize { width, height }));
    let file = data.join("lmo/test/000002/scene_camera.json");
    let cameras = read_camera(&file).unwrap();
    assert!(matches!(cameras, CameraFile::PerImage(_)));
    let image = cameras.for_image("000003").unwrap();
    assert_eq!((image.camera, image.depth_scale), (camera, Some(1.0)));
    assert_eq!(cameras.for_image("999999"), None);
}

#[test]
fn damaged_files_never_panic() {
    let Some(data) = real_data("damaged files") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let mut rng = stream(7, Purpose::Demonstration, 0);
    for (name, copy) in [
        ("meshes/chairs/habitat_chair.glb", "damaged.glb"),
        ("meshes/sofas/modelnet_sofa_0005.off", "damaged.off"),
    ] {
        let whole = std::fs::read(data.join(name)).unwrap();
        let path = folder.path().join(copy);
        for round in 0..200 {
            let mut bytes = whole.clone();
            if round % 2 == 0 {
                bytes.truncate(rng.random_range(0..whole.len()));
            } else {
                // Most of what can go wrong stands at the beginning.
                for range in [2000, 2000, whole.len()] {
                    bytes[rng.random_range(0..range)] = rng.random();
                }
            }
            std::fs::write(&path, &bytes).unwrap();
            if let Err(error) = read_geometry(&path) {
                let line = error.to_string();
                assert_eq!(line.lines().count(), 1, "{line}");
                assert!(line.len() < 700, "{line}");
            }
        }
    }
}
