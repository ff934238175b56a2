//! The check against depth on LineMOD-Occlusion: a third of its images with simulated depth, and the one real
//! frame. All images, and the mesh in the templates' place: the example `lmo-table`, `docs/DEPTH.md`.

use cobra_tests::data::real_data;
use cobra_train::bop::dataset::Dataset;
use cobra_train::bop::results::{Results, Row, read_results};
use cobra_train::bop::score::{DepthSource, Masks, ScoreOptions, Scored, Summary, score_results};
use cobra_train::bop::templates::{TemplateFolder, template_path};
use cobra_train::progress::Silent;
use cobra_train::train::{TrainOptions, train};
use std::path::Path;
use std::sync::OnceLock;

const OBJECTS: [u32; 8] = [1, 5, 6, 8, 9, 10, 11, 12];
const ESTIMATORS: [&str; 3] = ["epos", "gdrnpp", "zebrapose"];

/// The image with real depth.
const REAL: u32 = 3;

/// Templates as they are trained unless told otherwise, in a folder.
fn templates(data: &Path) -> TemplateFolder {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::open(data, "test").unwrap();
        let models = dataset.models("models").unwrap();
        for object in OBJECTS {
            let options = TrainOptions::new(format!("obj_{object:06}"));
            let trained = train(&models.geometry(object).unwrap(), &options, &Silent).unwrap();
            assert!(trained.bytes.len() <= 14_336);
            std::fs::write(template_path(folder.path(), object), trained.bytes).unwrap();
        }
        folder
    });
    TemplateFolder::read(folder.path(), OBJECTS)
}

/// Those rows of a results file that are of some images.
fn rows(data: &Path, file: &str, of: impl Fn(u32) -> bool) -> Vec<Row> {
    let results = read_results(&data.join(file)).unwrap();
    let wanted = |row: &Row| row.estimate.as_ref().is_ok_and(|e| of(e.im_id));
    results.rows.into_iter().filter(wanted).collect()
}

fn score(data: &Path, rows: Vec<Row>, masks: Masks, depth: DepthSource) -> Vec<Scored> {
    let dataset = Dataset::open(data, "test").unwrap();
    let options = ScoreOptions {
        masks,
        depth,
        seed: 0,
        pixels: ScoreOptions::PIXELS,
    };
    templates(data).with_surfaces(|surfaces| {
        score_results(&dataset, &Results { rows }, surfaces, &options, &Silent)
    })
}

#[test]
fn confidences_of_real_estimates_tell_right_from_wrong() {
    let Some(data) = real_data("LM-O's estimates against depth") else {
        return;
    };
    let data = data.join("lmo");
    for (masks, least_area, largest_correlation) in [
        (Masks::Simulated, 0.955, -0.92),
        (Masks::Silhouette, 0.95, -0.91),
    ] {
        let mut all = Vec::new();
        let mut ends = Vec::new();
        for name in ESTIMATORS {
            let file = format!("estimates/{name}_lmo-test.csv");
            all.extend(rows(&data, &file, |image| image % 3 == 0));
            ends.push(all.len());
        }
        let depth = DepthSource::Simulated { noise: 1.5 };
        let scored = score(&data, all, masks.clone(), depth);
        let whole = Summary::of(&scored);
        assert!(whole.scored == scored.len() && scored.len() > 1300);
        let message = format!("{masks:?}: {whole:?}");
        assert!(whole.area.unwrap() >= least_area, "{message}");
        assert!(
            whole.correlation.unwrap() <= largest_correlation,
            "{message}"
        );
        assert!(whole.error_correlation.unwrap() >= 0.9, "{message}");
        assert!(
            (0.5..=2.0).contains(&whole.error_ratio.unwrap()),
            "{message}"
        );
        let mut start = 0;
        for (name, end) in ESTIMATORS.into_iter().zip(ends) {
            let one = Summary::of(&scored[start..end]);
            start = end;
            assert!(one.area.unwrap() >= 0.93, "{masks:?}, {name}: {one:?}");
            assert!(one.own_area.is_none_or(|own| own < 0.7), "{name}: {one:?}");
        }
    }
}

#[test]
fn on_the_real_frame_the_truth_scores_above_every_wrong_estimate() {
    let Some(data) = real_data("LM-O's real depth") else {
        return;
    };
    let data = data.join("lmo");
    let real = |image| image == REAL;
    let mut all = rows(&data, "gt-pbrreal-rgb-mmodel_lmo-test_lmo.csv", real);
    let truths = all.len();
    for name in ESTIMATORS {
        all.extend(rows(&data, &format!("estimates/{name}_lmo-test.csv"), real));
    }
    all.extend(rows(&data, "megapose_lmo-test.csv", real));
    let scored = score(&data, all, Masks::Silhouette, DepthSource::Sensor);
    let confidence = |row: &Scored| row.outcome.as_ref().unwrap().report.confidence;
    let (truths, estimates) = scored.split_at(truths);
    assert_eq!(truths.len(), OBJECTS.len());
    let mut wrong = 0;
    for truth in truths {
        let object = truth.estimate.unwrap().obj_id;
        for estimate in estimates
            .iter()
            .filter(|e| e.estimate.unwrap().obj_id == object)
        {
            let errors = *estimate.known_truth().unwrap().errors().unwrap();
            if errors.add_s > 0.1 * errors.diameter {
                wrong += 1;
                let (right, wrong) = (confidence(truth), confidence(estimate));
                assert!(wrong < right, "object {object}: {wrong} {right} {errors:?}");
            }
        }
    }
    assert!(wrong >= 10, "{wrong}");
}
