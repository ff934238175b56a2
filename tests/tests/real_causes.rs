//! The reasons that the depth check gives for poses that are wrong in known ways: all eight objects of one image
//! of LineMOD-Occlusion, depth rendered with 1.5 mm noise, templates as `cobra train` makes them.
//!
//! The tables that these promises come from are in `docs/OVERLAY.md`.

use cobra_infer::depth::{
    Cause, Cell, Correction, DepthCheck, DepthPixel, DepthSettings, Observed, Surface,
    TemplateSurface,
};
use cobra_infer::{Camera, Template};
use cobra_tests::data::real_data;
use cobra_train::bop::dataset::{Annotation, Dataset};
use cobra_train::bop::render::{DepthNoise, PlacedModel, RenderModel, SimulatedFrame, render};
use cobra_train::depth::{observed, spread};
use cobra_train::depth_image::DepthImage;
use cobra_train::input::ImageSize;
use cobra_train::pose::single_pose;
use cobra_train::progress::Silent;
use cobra_train::surface::Geometry;
use cobra_train::train::{LARGEST_TEMPLATE, TrainOptions, train};
use nalgebra::{Isometry3, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

const SIZE: ImageSize = ImageSize {
    width: 640,
    height: 480,
};
const IMAGE: u32 = 3;

/// The image, its objects, and what checks their poses.
struct Scene {
    camera: Camera,
    truth: Vec<Annotation>,
    models: BTreeMap<u32, RenderModel>,
    templates: BTreeMap<u32, Vec<u8>>,
}

/// One object, seen from the camera.
#[derive(Clone, Copy)]
struct Place {
    pose: Isometry3<f64>,
    middle: Point3<f64>,
    ray: Vector3<f64>,
    across: Vector3<f64>,
    diameter: f64,
}

impl Scene {
    fn open(data: &Path) -> Self {
        let dataset = Dataset::open(&data.join("lmo"), "test").unwrap();
        let scene = dataset.scene(2).unwrap();
        let models = dataset.models("models").unwrap();
        let objects = models.objects().unwrap();
        let prepared: Vec<_> = objects
            .par_iter()
            .map(|object| {
                let geometry = models.geometry(*object).unwrap();
                let bytes = train(&geometry, &TrainOptions::new("object"), &Silent).unwrap();
                let Geometry::Mesh(mesh) = geometry else {
                    panic!("object {object} has faces");
                };
                (*object, RenderModel::new(&mesh), bytes.bytes)
            })
            .collect();
        let mut opened = Self {
            camera: scene.camera(IMAGE).unwrap().camera,
            truth: scene.truth(IMAGE).unwrap(),
            models: BTreeMap::new(),
            templates: BTreeMap::new(),
        };
        for (object, model, bytes) in prepared {
            opened.models.insert(object, model);
            opened.templates.insert(object, bytes);
        }
        opened
    }

    /// The depth of all objects at their true poses, and of one more in front of them.
    fn frame(&self, more: Option<PlacedModel<'_>>) -> SimulatedFrame {
        let placed = self.truth.iter().map(|annotation| PlacedModel {
            model: &self.models[&annotation.obj_id],
            pose: annotation.pose,
        });
        let placed: Vec<_> = placed.chain(more).collect();
        render(&self.camera, SIZE, &placed).with_noise(&DepthNoise {
            standard_deviation: 1.5,
            seed: 0,
            scene: 2,
            image: IMAGE,
        })
    }

    fn place(&self, index: usize) -> Place {
        let annotation = &self.truth[index];
        let template = Template::from_bytes(&self.templates[&annotation.obj_id]).unwrap();
        let middle = annotation.pose * Point3::from(template.centre()).cast::<f64>();
        let ray = middle.coords.normalize();
        Place {
            pose: annotation.pose,
            middle,
            ray,
            across: ray.cross(&Vector3::y()).normalize(),
            diameter: f64::from(template.diameter()),
        }
    }

    /// The driller nearer to the camera, its middle `aside` millimetres beside the ray to an object.
    fn in_front(&self, place: &Place, share: f64, aside: f64) -> SimulatedFrame {
        let at = place.middle.coords * share + place.across * aside;
        self.frame(Some(PlacedModel {
            model: &self.models[&8],
            pose: Isometry3::from_parts(Translation3::from(at), place.pose.rotation),
        }))
    }

    /// The reason given for a pose of an object; with a mask, of its visible pixels.
    fn cause(
        &self,
        index: usize,
        pose: &Isometry3<f64>,
        frame: &SimulatedFrame,
        depth: &DepthImage,
        masked: bool,
    ) -> Cause {
        let bytes = &self.templates[&self.truth[index].obj_id];
        let template = Template::from_bytes(bytes).unwrap();
        let settings = DepthSettings::for_template(&template);
        let noise = settings.noise.at(template.diameter(), 0.0).unwrap();
        let surface = TemplateSurface::<LARGEST_TEMPLATE>::new(&template, noise).unwrap();
        let pixels = spread(&observed(&frame.visible(index), depth), 500);
        let seen: Observed<'_> = if masked && !pixels.is_empty() {
            Observed::Pixels(&pixels as &[DepthPixel])
        } else {
            Observed::Silhouette
        };
        let check = DepthCheck::new(&surface, &self.camera, &settings).unwrap();
        let mut cells = vec![Cell::EMPTY; settings.cells()];
        let pose = single_pose(pose).unwrap();
        let report = check
            .run(&pose, seen, depth, &mut cells, &mut || {})
            .unwrap();
        report.cause(&Correction::between(
            &pose,
            &report.refined,
            surface.centre(),
        ))
    }
}

impl Place {
    fn moved(&self, by: Vector3<f64>) -> Isometry3<f64> {
        Translation3::from(by) * self.pose
    }

    fn turned(&self, axis: Vector3<f64>, degrees: f64) -> Isometry3<f64> {
        let turn =
            UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis), degrees.to_radians());
        let middle = self.middle.coords;
        Translation3::from(middle) * turn * Translation3::from(-middle) * self.pose
    }

    fn scaled(&self, scale: f64) -> Isometry3<f64> {
        let translation = Translation3::from(self.pose.translation.vector * scale);
        Isometry3::from_parts(translation, self.pose.rotation)
    }
}

fn name(cause: &Cause) -> &'static str {
    match cause {
        Cause::Fits => "fits",
        Cause::BehindCamera => "behind",
        Cause::Scale { .. } => "scale",
        Cause::InFront => "in front",
        Cause::SeenThrough => "seen through",
        Cause::AlongRay { .. } => "along",
        Cause::Sideways { .. } => "sideways",
        Cause::Turned { .. } => "turned",
        Cause::Elsewhere => "elsewhere",
        Cause::Hidden => "hidden",
        Cause::Unmeasured => "unmeasured",
    }
}

/// A kind of error: what it is called, the reasons that are right, and of how many objects at least one of them
/// is named with a mask and without.
struct Kind {
    name: &'static str,
    right: &'static [&'static str],
    least: [usize; 2],
}

const fn kind(
    name: &'static str,
    right: &'static [&'static str],
    with_mask: usize,
    without: usize,
) -> Kind {
    Kind {
        name,
        right,
        least: [with_mask, without],
    }
}

const KINDS: [Kind; 16] = [
    kind("right", &["fits", "hidden"], 8, 8),
    kind("half hidden", &["fits", "hidden", "in front"], 8, 7),
    kind("covered", &["in front", "hidden"], 8, 8),
    kind("40 mm too far", &["along"], 7, 6),
    kind("40 mm too near", &["along"], 6, 6),
    kind("30 mm sideways", &["sideways"], 7, 0),
    kind("60 degrees about the ray", &["turned"], 7, 1),
    kind("60 degrees across it", &["turned"], 3, 0),
    kind("behind the camera", &["behind"], 8, 8),
    kind("pose in metres", &["scale"], 8, 0),
    kind("pose in metres, no mask", &["scale", "behind"], 8, 8),
    kind("pose in centimetres", &["scale"], 8, 0),
    kind("depth in metres", &["scale"], 8, 8),
    kind("three diameters too near", &["seen through"], 8, 8),
    kind(
        "in free space beside",
        &["seen through", "unmeasured", "sideways"],
        7,
        7,
    ),
    kind(
        "at another object's place",
        &["sideways", "seen through", "elsewhere"],
        7,
        4,
    ),
];

#[test]
fn a_pose_that_is_wrong_in_a_known_way_gets_its_reason() {
    let Some(data) = real_data("reasons on LM-O") else {
        return;
    };
    let scene = Scene::open(&data);
    let plain = scene.frame(None);
    let metres = plain.depth().millimetres().iter().map(|z| z / 1000.0);
    let metres = DepthImage::new(SIZE, metres.collect());
    let mut table = vec![[const { Vec::new() }; 2]; KINDS.len()];
    for index in 0..scene.truth.len() {
        let place = scene.place(index);
        let mut behind = place.pose;
        behind.translation.vector.z *= -1.0;
        let next = scene.truth[(index + 1) % scene.truth.len()].pose;
        let other = next.translation.vector - place.pose.translation.vector;
        let half = scene.in_front(&place, 0.45, 45.0);
        let covered = scene.in_front(&place, 0.3, 0.0);
        let cases = [
            (place.pose, &plain, plain.depth()),
            (place.pose, &half, half.depth()),
            (place.pose, &covered, covered.depth()),
            (place.moved(place.ray * 40.0), &plain, plain.depth()),
            (place.moved(place.ray * -40.0), &plain, plain.depth()),
            (place.moved(place.across * 30.0), &plain, plain.depth()),
            (place.turned(place.ray, 60.0), &plain, plain.depth()),
            (place.turned(place.across, 60.0), &plain, plain.depth()),
            (behind, &plain, plain.depth()),
            (place.scaled(1e-3), &plain, plain.depth()),
            (place.scaled(1e-3), &plain, plain.depth()),
            (place.scaled(0.1), &plain, plain.depth()),
            (place.pose, &plain, &metres),
            (
                place.moved(place.ray * (-3.0 * place.diameter)),
                &plain,
                plain.depth(),
            ),
            (
                place.moved(Vector3::new(0.0, -400.0, 0.0)),
                &plain,
                plain.depth(),
            ),
            (place.moved(other), &plain, plain.depth()),
        ];
        for (row, (pose, frame, depth)) in table.iter_mut().zip(cases) {
            for (found, masked) in row.iter_mut().zip([true, false]) {
                found.push(scene.cause(index, &pose, frame, depth, masked));
            }
        }
    }
    let mut wrong = Vec::new();
    for (kind, row) in KINDS.iter().zip(&table) {
        for (found, (least, pixels)) in row
            .iter()
            .zip(kind.least.into_iter().zip(["mask", "silhouette"]))
        {
            let names: Vec<_> = found.iter().map(name).collect();
            let right = names.iter().filter(|n| kind.right.contains(n)).count();
            println!(
                "{:26} {pixels:10} {right} of {}: {names:?}",
                kind.name,
                names.len()
            );
            if right < least {
                wrong.push(format!(
                    "{}, {pixels}: {right} of at least {least}",
                    kind.name
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    // What is named is also about as large as it is.
    for (cause, expected) in table[3][0].iter().chain(&table[3][1]).map(|c| (c, -40.0)) {
        if let Cause::AlongRay { distance } = cause {
            assert!((distance - expected).abs() < 12.0, "{distance}");
        }
    }
    for cause in &table[5][0] {
        if let Cause::Sideways { distance } = cause {
            assert!((distance - 30.0).abs() < 10.0, "{distance}");
        }
    }
}
