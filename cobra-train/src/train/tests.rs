//! What training promises of charts, validity and budgets, on a box.

use super::*;
use crate::gp::Subset;
use crate::progress::Silent;
use crate::surface::Mesh;
use cobra_infer::Metric;

fn object() -> Geometry {
    let vertices = (0..8)
        .map(|i| {
            let corner = [(i & 1, 40.0), (i >> 1 & 1, 60.0), (i >> 2 & 1, 80.0)];
            Point3::from(corner.map(|(side, length)| f64::from(side) * length))
        })
        .collect();
    let faces: [[u32; 4]; 6] = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = faces
        .iter()
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
        .collect();
    Mesh::new(vertices, triangles).unwrap().into()
}

fn few(options: TrainOptions) -> TrainOptions {
    let mut options = TrainOptions {
        points: 1000,
        test_points: 1500,
        ..options
    };
    options.fit.subset = Subset::Points(60);
    options
}

fn trained(options: &TrainOptions) -> Result<Trained, TrainError> {
    train(&object(), options, &Silent)
}

#[test]
fn a_template_has_no_more_bytes_than_its_budget() {
    let terms = [BUDGET, 5000, 2500].map(|budget| {
        let options = TrainOptions {
            budget: Some(budget),
            ..few(TrainOptions::new("box"))
        };
        let bytes = trained(&options).unwrap().bytes;
        assert!(bytes.len() <= budget, "{} of {budget}", bytes.len());
        let template = Template::from_bytes(&bytes).unwrap();
        assert!(template.has_compact_terms() && template.has_validity());
        template.term_count()
    });
    assert!(terms.is_sorted_by(|a, b| a >= b), "{terms:?}");
}

#[test]
fn clusters_are_squeezed_too_and_speak_everywhere_where_asked() {
    for validity in [Validity::Verified, Validity::Everywhere] {
        let options = TrainOptions {
            budget: Some(3000),
            validity,
            ..few(TrainOptions::clustered("box", 4))
        };
        let bytes = trained(&options).unwrap().bytes;
        assert!(bytes.len() <= 3000, "{}", bytes.len());
        let template = Template::from_bytes(&bytes).unwrap();
        assert_eq!(template.component_count(), 4);
        assert!(template.has_compact_terms());
        assert_eq!(template.has_validity(), validity == Validity::Verified);
        assert_eq!(template.quality().is_some(), template.has_validity());
    }
}

#[test]
fn a_budget_that_holds_nothing_says_what_is_needed() {
    let with = |budget| {
        trained(&TrainOptions {
            budget: Some(budget),
            ..few(TrainOptions::new("box"))
        })
    };
    for budget in [0, 10, 200] {
        let error = with(budget).unwrap_err();
        let TrainError::Budget {
            budget: said,
            least,
        } = error
        else {
            panic!("{error}");
        };
        assert_eq!(said, budget);
        assert!(least > budget, "{least}");
        // It is an estimate: cells are verified anew once terms are compressed.
        let enough = 2 * least;
        assert!(with(enough).unwrap().bytes.len() <= enough, "{least}");
    }
}

#[test]
fn without_a_budget_there_is_the_exact_process() {
    let options = TrainOptions {
        budget: None,
        ..few(TrainOptions::new("box"))
    };
    let trained = trained(&options).unwrap();
    assert_eq!(trained.deviation, None);
    let template = Template::from_bytes(&trained.bytes).unwrap();
    assert!(!template.has_compact_terms() && template.has_validity());
    for (component, trained) in template.components().zip(&trained.components) {
        assert_eq!(component.terms.len(), trained.fitted.weights.len());
    }
    let quality = template.quality().unwrap();
    assert_eq!((quality.deviation_max, quality.deviation_rms), (0.0, 0.0));
}

#[test]
fn the_template_says_what_was_measured() {
    let trained = trained(&few(TrainOptions::new("box"))).unwrap();
    let template = Template::from_bytes(&trained.bytes).unwrap();
    let quality = template.quality().unwrap();
    assert_eq!(quality.covered, trained.covered as f32);
    assert!(trained.covered > 0.6, "{}", trained.covered);
    let left: f64 = trained.uncovered.iter().map(|region| region.share).sum();
    assert!((trained.covered + left - 1.0).abs() < 1e-9, "{left}");
    let deviation = trained.deviation.unwrap();
    assert_eq!(quality.deviation_max, deviation.max as f32);
    assert!(0.0 < deviation.rms && deviation.rms <= deviation.max);
    for (share, component) in quality.unexplained().zip(&trained.components) {
        let expected = component.unexplained as f32 / component.test_points.max(1) as f32;
        assert!((share - expected).abs() < 1e-4, "{share} {expected}");
    }
    let spoken: usize = trained.components.iter().map(|c| c.test_points).sum();
    assert!(spoken <= trained.test_points);
}

#[test]
fn what_cannot_be_is_refused() {
    let mut angles = few(TrainOptions::new("box"));
    angles.fit.model.metric = Metric::Angles;
    assert!(matches!(
        trained(&angles).unwrap_err(),
        TrainError::BudgetNeedsChord
    ));
    let from_within = TrainOptions {
        sampling: SurfaceSampling::ReferencePoints,
        ..few(TrainOptions::new("box"))
    };
    assert!(matches!(
        trained(&from_within).unwrap_err(),
        TrainError::NeedsReferencePoints
    ));
    let handful = TrainOptions {
        points: 5,
        ..few(TrainOptions::new("box"))
    };
    assert!(matches!(
        trained(&handful).unwrap_err(),
        TrainError::NoCharts
    ));
    for most in [0, LARGEST_TEMPLATE + 1] {
        let options = TrainOptions {
            reference_points: ReferencePoints::Auto { most },
            ..few(TrainOptions::new("box"))
        };
        assert!(trained(&options).is_err());
    }
}
