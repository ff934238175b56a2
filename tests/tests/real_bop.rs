//! LineMOD-Occlusion as it is published: results, true poses, models, and rendered depth against what
//! the data set says of its images.

use cobra_tests::data::real_data;
use cobra_train::bop::dataset::{Dataset, Models, Scene};
use cobra_train::bop::render::{PlacedModel, RenderModel, SimulatedFrame, render};
use cobra_train::bop::results::read_results;
use cobra_train::input::ImageSize;
use cobra_train::surface::Geometry;
use std::collections::BTreeMap;
use std::path::Path;

const OBJECTS: [u32; 8] = [1, 5, 6, 8, 9, 10, 11, 12];
const SIZE: ImageSize = ImageSize {
    width: 640,
    height: 480,
};

#[test]
fn the_data_set_is_read_whole() {
    let Some(data) = real_data("LM-O's files") else {
        return;
    };
    let dataset = Dataset::open(&data.join("lmo"), "test").unwrap();
    let scene = dataset.scene(2).unwrap();
    let images = scene.images();
    let mut annotations = 0;
    for image in &images {
        assert_eq!(dataset.image_size(&scene, *image).unwrap(), SIZE);
        assert_eq!(scene.camera(*image).unwrap().depth_scale, Some(1.0));
        annotations += scene.truth(*image).unwrap().len();
    }
    assert_eq!((images.len(), annotations), (200, 1517));
    let models = dataset.models("models").unwrap();
    assert_eq!(models.objects().unwrap(), OBJECTS);
    for object in OBJECTS {
        let info = models.info(object).unwrap();
        let diameter = models.geometry(object).unwrap().diameter();
        assert!(
            (diameter - info.diameter).abs() < 1e-3,
            "{diameter} {}",
            info.diameter
        );
        let symmetric = [10, 11].contains(&object);
        assert_eq!(info.symmetries.is_none(), !symmetric);
    }
}

#[test]
fn results_are_read_and_written_back_with_every_other_field_as_it_was() {
    let Some(data) = real_data("BOP results") else {
        return;
    };
    for (name, count) in [
        ("estimates/epos_lmo-test.csv", 1444),
        ("estimates/gdrnpp_lmo-test.csv", 1514),
        ("estimates/zebrapose_lmo-test.csv", 1432),
        ("megapose_lmo-test.csv", 1645),
        ("gt-pbrreal-rgb-mmodel_lmo-test_lmo.csv", 1445),
    ] {
        let path = data.join("lmo").join(name);
        let results = read_results(&path).unwrap();
        assert_eq!(results.rows.len(), count, "{name}");
        for row in &results.rows {
            let estimate = row.estimate.as_ref().unwrap();
            assert!(estimate.pose().is_ok() && estimate.isometry().is_ok());
        }
        let text = results.rescored(|index, _| Some(index as f64 / 4096.0));
        let original = std::fs::read_to_string(&path).unwrap();
        let rows = original.lines().zip(text.lines());
        assert_eq!(original.lines().count(), text.lines().count());
        for (index, (before, after)) in rows.skip(1).enumerate() {
            let mut fields: Vec<&str> = before.split(',').collect();
            let score = (index as f64 / 4096.0).to_string();
            fields[3] = &score;
            assert_eq!(after, fields.join(","));
        }
    }
}

#[test]
fn true_poses_are_those_of_the_published_results_of_the_truth() {
    let Some(data) = real_data("true poses") else {
        return;
    };
    let folder = data.join("lmo");
    let scene = Dataset::open(&folder, "test").unwrap().scene(2).unwrap();
    let published = read_results(&folder.join("gt-pbrreal-rgb-mmodel_lmo-test_lmo.csv")).unwrap();
    for row in &published.rows {
        let estimate = row.estimate.as_ref().unwrap();
        let pose = estimate.isometry().unwrap();
        let annotations = scene.truth(estimate.im_id).unwrap();
        let mut same = annotations.iter().filter(|a| a.obj_id == estimate.obj_id);
        assert_eq!(same.next().unwrap().pose, pose, "line {}", row.line);
    }
}

struct Rendered {
    models: BTreeMap<u32, RenderModel>,
    scene: Scene,
}

impl Rendered {
    fn of(folder: &Path) -> Self {
        let dataset = Dataset::open(folder, "test").unwrap();
        let models: Models = dataset.models("models").unwrap();
        let model = |object| match models.geometry(object).unwrap() {
            Geometry::Mesh(mesh) => RenderModel::new(&mesh),
            Geometry::Cloud(_) => panic!("a model without faces"),
        };
        Self {
            models: OBJECTS.map(|object| (object, model(object))).into(),
            scene: dataset.scene(2).unwrap(),
        }
    }

    /// The objects of an image, all together, or one alone.
    fn frame(&self, image: u32, only: Option<usize>) -> SimulatedFrame {
        let camera = self.scene.camera(image).unwrap().camera;
        let truth = self.scene.truth(image).unwrap();
        let placed: Vec<PlacedModel<'_>> = truth
            .iter()
            .enumerate()
            .filter(|(index, _)| only.is_none_or(|only| only == *index))
            .map(|(_, annotation)| PlacedModel {
                model: &self.models[&annotation.obj_id],
                pose: annotation.pose,
            })
            .collect();
        render(&camera, SIZE, &placed)
    }
}

#[test]
fn a_rendered_object_covers_the_pixels_that_the_data_set_says() {
    let Some(data) = real_data("rendered silhouettes") else {
        return;
    };
    let folder = data.join("lmo");
    let rendered = Rendered::of(&folder);
    let info = std::fs::read_to_string(folder.join("test/000002/scene_gt_info.json")).unwrap();
    let info: serde_json::Value = serde_json::from_str(&info).unwrap();
    for image in [3, 96, 1180] {
        let stated = info[image.to_string()].as_array().unwrap();
        assert_eq!(stated.len(), rendered.scene.truth(image).unwrap().len());
        for (index, stated) in stated.iter().enumerate() {
            let silhouette = rendered.frame(image, Some(index)).visible(0);
            let count = silhouette.count() as f64;
            let pixels = stated["px_count_all"].as_f64().unwrap();
            // A hundredth is some pixels of an outline.
            assert!(
                (count / pixels - 1.0).abs() < 0.01,
                "{image} {index}: {count} {pixels}"
            );
            let left = silhouette.pixels().map(|(column, _)| column).min().unwrap();
            let top = silhouette.pixels().map(|(_, row)| row).min().unwrap();
            let rectangle = stated["bbox_obj"].as_array().unwrap();
            let corner = [0, 1].map(|i| rectangle[i].as_f64().unwrap());
            for (found, stated) in [left, top].into_iter().zip(corner) {
                assert!((f64::from(found) - stated).abs() <= 1.0, "{image} {index}");
            }
        }
    }
}

#[test]
fn rendered_depth_lies_on_the_measured_one() {
    let Some(data) = real_data("rendered and measured depth") else {
        return;
    };
    let rendered = Rendered::of(&data.join("lmo"));
    let frame = rendered.frame(3, None);
    let measured = rendered.scene.depth(3, SIZE).unwrap();
    for index in 0..rendered.scene.truth(3).unwrap().len() {
        // Where nothing that has no annotation stands in front, by BOP's 15 mm.
        let visible = frame.visible(index);
        let behind = visible.pixels().filter_map(|(column, row)| {
            Some(measured.at(column, row)? - frame.depth().at(column, row)?)
        });
        let mut off: Vec<f32> = behind.filter(|off| *off > -15.0).map(f32::abs).collect();
        off.sort_unstable_by(f32::total_cmp);
        assert!(3 * off.len() >= visible.count(), "{index}: {}", off.len());
        let median = off[off.len() / 2];
        assert!(median < 8.0, "{index}: {median} mm");
    }
}
