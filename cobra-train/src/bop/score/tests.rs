use super::*;
use crate::depth::MeshSurface;
use crate::depth_image::DepthImage;
use crate::input::ImageSize;
use crate::surface::Mesh;
use cobra_infer::{Camera, Pose};
use nalgebra::Point3;

/// A square card 200 mm in front of the camera, where it is seen.
fn outcome() -> Outcome {
    let corners = [[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]];
    let vertices = corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
    let mesh = Mesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    let surface = MeshSurface::new(&mesh, 4.0, 0);
    let camera = Camera::new(160.0, 160.0, 31.5, 23.5).unwrap();
    let identity = [1., 0., 0., 0., 1., 0., 0., 0., 1.];
    let pose = Pose::from_row_major(identity, [0.0, 0.0, 200.0]).unwrap();
    let (width, height) = (64, 48);
    let depth = DepthImage::new(ImageSize { width, height }, vec![200.0; 64 * 48]);
    let settings = DepthSettings::DEFAULT;
    let check = DepthCheck::new(&surface, &camera, &settings).unwrap();
    let mut cells = vec![Cell::EMPTY; settings.cells()];
    let report = check.run(&pose, Observed::Silhouette, &depth, &mut cells, &mut || {});
    let report = report.unwrap();
    let correction = Correction::between(&pose, &report.refined, surface.centre());
    Outcome {
        report,
        correction,
        cause: report.cause(&correction),
        minimum_points: settings.minimum_points,
        masked: false,
    }
}

#[test]
fn a_threshold_decides_what_has_enough_pixels_and_a_truth_and_nothing_else() {
    let outcome = outcome();
    let decided = |minimum_points, truth| {
        Scored {
            row: 0,
            line: 2,
            estimate: None,
            outcome: Ok(Outcome {
                minimum_points,
                ..outcome
            }),
            truth,
        }
        .decided()
    };
    let valid = outcome.valid_pixels();
    let wrong = Labelled {
        confidence: outcome.report.confidence,
        right: false,
    };
    assert!(valid > 10 && wrong.confidence > 0.5);
    // An object that is not there makes an estimate wrong.
    assert_eq!(decided(valid, Ok(Some(Truth::Absent))), Some(wrong));
    assert_eq!(decided(valid + 1, Ok(Some(Truth::Absent))), None);
    assert_eq!(decided(valid, Ok(None)), None);
}
