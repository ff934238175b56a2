//! What training promises of any object: σ̂ is what fresh points show, and neither the unit nor the
//! frame of the file changes what is learned.

use cobra_infer::{Assignment, Template, Unit};
use cobra_tests::tolerance::{HELD_OUT, SAME_SHAPE};
use cobra_train::demo::mechanical_part;
use cobra_train::evaluate::{Evaluation, evaluate, evaluation_points};
use cobra_train::progress::Silent;
use cobra_train::surface::{Geometry, Mesh};
use cobra_train::train::{TrainOptions, train};
use nalgebra::{Isometry3, Point3, Vector3};

fn options() -> TrainOptions {
    let mut options = TrainOptions::clustered("part", 10);
    options.points = 4000;
    options.test_points = 8000;
    options
}

fn trained(object: &Geometry) -> Vec<u8> {
    train(object, &options(), &Silent).unwrap().bytes
}

fn moved(change: impl Fn(&Point3<f64>) -> Point3<f64>) -> Geometry {
    let part = mechanical_part();
    let vertices = part.vertices().iter().map(change).collect();
    Mesh::new(vertices, part.triangles().to_vec())
        .unwrap()
        .into()
}

fn measured(template: &Template<'_>, object: &Geometry) -> Evaluation {
    let points = evaluation_points(object, 20_000, 5).unwrap();
    evaluate(template, Assignment::Nearest, &points).unwrap()
}

#[test]
fn sigma_hat_is_the_rms_residual_of_points_that_training_did_not_see() {
    let object = mechanical_part().into();
    let bytes = trained(&object);
    let template = Template::from_bytes(&bytes).unwrap();
    let evaluation = measured(&template, &object);
    let mut squares = 0.0;
    for predicted in &evaluation.predicted {
        let component = template.components().nth(predicted.component).unwrap();
        squares += f64::from(component.sigma_hat).powi(2);
    }
    let promised = (squares / evaluation.predicted.len() as f64).sqrt();
    let ratio = evaluation.residual.rms / promised;
    assert!((ratio - 1.0).abs() < HELD_OUT, "{ratio}");
}

#[test]
fn a_mesh_in_another_unit_gives_the_same_template_in_that_unit() {
    let original = trained(&mechanical_part().into());
    let scaled = trained(&moved(|p| p * 8.0));
    let original = Template::from_bytes(&original).unwrap();
    let scaled = Template::from_bytes(&scaled).unwrap();
    assert_eq!(scaled.radius(), 8.0 * original.radius());
    assert_eq!(scaled.diameter(), 8.0 * original.diameter());
    for (a, b) in original.components().zip(scaled.components()) {
        assert_eq!(a.centre.map(|x| 8.0 * x), b.centre);
        assert_eq!(8.0 * a.sigma_hat, b.sigma_hat);
        let (h, other) = (a.hyperparameters, b.hyperparameters);
        assert_eq!(h.length_scale, other.length_scale);
        assert_eq!(8.0 * h.prior_mean, other.prior_mean);
        for ((u, w), (v, x)) in a.terms.iter().zip(b.terms.iter()) {
            assert_eq!((u, 8.0 * w), (v, x));
        }
    }
    assert_eq!(
        (original.unit(), scaled.unit()),
        (Unit::Millimetre, Unit::Millimetre)
    );
}

/// The cameras stand elsewhere on a moved object, so the points differ; the shape does not.
#[test]
fn a_mesh_in_another_frame_comes_out_as_well() {
    let motion = Isometry3::new(
        Vector3::new(300.0, -40.0, 7.0),
        Vector3::new(0.5, 1.1, -0.4),
    );
    let [before, after] = [mechanical_part().into(), moved(|p| motion * p)].map(|object| {
        let bytes = trained(&object);
        let template = Template::from_bytes(&bytes).unwrap();
        measured(&template, &object).shape.f_score
    });
    assert!((before - after).abs() < SAME_SHAPE, "{before} {after}");
}
