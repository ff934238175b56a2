//! How costs grow: training over the number of points, scoring over that of pixels, both over that
//! of components. Markdown tables on standard output, for `docs/BENCHMARKS.md`.
//!
//! Not criterion's: its ten samples of the longest training would take an hour.

#[path = "support/object.rs"]
mod object;
#[path = "support/size.rs"]
mod size;

use cobra_infer::{Camera, Correspondence, Pose, Settings, Template, score};
use cobra_train::demo::VIEW;
use cobra_train::evaluate::{evaluate, evaluation_points};
use cobra_train::progress::Silent;
use cobra_train::surface::Geometry;
use cobra_train::train::{LARGEST_TEMPLATE, TrainOptions, Trained, train};
use nalgebra::Point3;
use object::{Object, objects};
use size::Size;
use std::hint::black_box;
use std::time::Instant;

/// What a measurement may take, in seconds, unless one run takes longer.
const BUDGET: f64 = 3.0;

/// The most runs of a measurement.
const RUNS: usize = 100;

/// The seed of the points that are scored.
const SEED: u64 = 1;

/// At most so many points are what F is measured on, as `cobra eval` does: it rises with them.
const F_SCORE_POINTS: usize = 30_000;

/// The tolerance and the distance of the camera, as shares of the object's radius.
const TOLERANCE: f64 = 0.02;
const CAMERA_DISTANCE: f64 = 5.0;

fn main() {
    let size = Size::from_arguments();
    let curves = if size.points < TrainOptions::new("").points {
        Curves {
            points: &[100, 200],
            pixels: &[10, 100],
            components: &[2, 3],
        }
    } else {
        Curves {
            points: &[1_000, 3_000, 10_000, 30_000, 100_000],
            pixels: &[10, 100, 1_000, 10_000, 100_000],
            components: &[4, 8, 16, 32, 64],
        }
    };
    // The screwdriver, where it is.
    if let Some(object) = objects().pop() {
        let views = Views::new(&object, &curves);
        curves.over_points(&object, &size);
        curves.over_pixels(&object, &size, &views);
        curves.over_components(&object, &size, &views);
    }
}

/// What is varied.
struct Curves {
    points: &'static [usize],
    pixels: &'static [usize],
    components: &'static [usize],
}

impl Curves {
    fn over_points(&self, object: &Object, size: &Size) {
        println!("Training, {}, default options:\n", object.name);
        println!("| points | s | s / points, first = 1 |\n|--:|--:|--:|");
        let mut first = None;
        for &points in self.points {
            let size = Size { points, ..*size };
            let options = size.default_options();
            let seconds = median(|| trained(object, &options));
            let each = seconds / points as f64;
            let share = each / *first.get_or_insert(each);
            println!("| {points} | {seconds:.3} | {share:.2} |");
        }
    }

    fn over_pixels(&self, object: &Object, size: &Size, views: &Views) {
        println!(
            "\nScoring on one core, {}, default template:\n",
            object.name
        );
        println!("| pixels | ms | µs / pixel |\n|--:|--:|--:|");
        let trained = trained(object, &size.default_options());
        for &pixels in self.pixels {
            let seconds = views.scoring(&trained, pixels);
            let (all, each) = (1e3 * seconds, 1e6 * seconds / pixels as f64);
            println!("| {pixels} | {all:.4} | {each:.3} |");
        }
    }

    fn over_components(&self, object: &Object, size: &Size, views: &Views) {
        println!(
            "\nk-means components, {}, {} points:\n",
            object.name, size.points
        );
        println!("| components | training, s | µs / pixel | kB | F |\n|--:|--:|--:|--:|--:|");
        let pixels = self.pixels[self.pixels.len() / 2];
        for &components in self.components {
            let options = Size {
                components,
                ..*size
            }
            .kmeans_options();
            let training = median(|| trained(object, &options));
            let trained = trained(object, &options);
            let each = 1e6 * views.scoring(&trained, pixels) / pixels as f64;
            let size = trained.bytes.len() as f64 / 1e3;
            let f_score = views.f_score(&trained);
            println!("| {components} | {training:.3} | {each:.3} | {size:.0} | {f_score:.1} |");
        }
    }
}

/// Surface points, and how a camera sees them.
struct Views {
    points: Vec<Point3<f64>>,
    camera: Camera,
    pose: Pose,
    correspondences: Vec<Correspondence>,
    delta: f32,
}

impl Views {
    fn new(object: &Object, curves: &Curves) -> Self {
        let sphere = object.mesh.bounding_sphere();
        let count = curves.pixels.iter().max().copied().unwrap_or_default();
        let geometry = Geometry::from(object.mesh.clone());
        let points =
            evaluation_points(&geometry, count, SEED).expect("both objects show their surface");
        let camera = Camera::new(
            VIEW.fx as f32,
            VIEW.fy as f32,
            VIEW.cx as f32,
            VIEW.cy as f32,
        )
        .expect("the demonstration's camera is a pinhole");
        let [x, y, z] = (-sphere.centre.coords).into();
        let away = [x, y, z + CAMERA_DISTANCE * sphere.radius].map(|t| t as f32);
        let pose = Pose::from_row_major([1., 0., 0., 0., 1., 0., 0., 0., 1.], away)
            .expect("the identity is a rotation");
        let correspondences = points
            .iter()
            .filter_map(|point| {
                let point = point.cast();
                let pixel = camera.project(&pose.to_camera(&point))?;
                Some(Correspondence::new(pixel, point))
            })
            .collect();
        Self {
            points,
            camera,
            pose,
            correspondences,
            delta: (TOLERANCE * sphere.radius) as f32,
        }
    }

    /// Seconds to score the first so many pixels.
    fn scoring(&self, trained: &Trained, pixels: usize) -> f64 {
        let template = Template::from_bytes(&trained.bytes).expect("what was trained can be read");
        let settings = self.settings(&template);
        let seen = &self.correspondences[..pixels];
        median(|| {
            score::<LARGEST_TEMPLATE>(&template, &self.camera, &self.pose, &settings, seen)
                .expect("the host has room for every template")
        })
    }

    fn settings(&self, template: &Template<'_>) -> Settings {
        Settings {
            delta: self.delta,
            ..Settings::for_template(template, 1.0)
        }
    }

    fn f_score(&self, trained: &Trained) -> f64 {
        let template = Template::from_bytes(&trained.bytes).expect("what was trained can be read");
        let points = &self.points[..self.points.len().min(F_SCORE_POINTS)];
        evaluate(&template, self.settings(&template).assignment, points)
            .expect("the host has room for every template")
            .shape
            .f_score
    }
}

fn trained(object: &Object, options: &TrainOptions) -> Trained {
    train(&object.mesh.clone().into(), options, &Silent).expect("both objects can be trained")
}

/// The median of the seconds that `routine` takes.
fn median<T>(mut routine: impl FnMut() -> T) -> f64 {
    let start = Instant::now();
    let mut seconds = Vec::new();
    while seconds.is_empty() || (start.elapsed().as_secs_f64() < BUDGET && seconds.len() < RUNS) {
        let start = Instant::now();
        black_box(routine());
        seconds.push(start.elapsed().as_secs_f64());
    }
    seconds.sort_by(f64::total_cmp);
    let middle = seconds.len() / 2;
    (seconds[(seconds.len() - 1) / 2] + seconds[middle]) / 2.0
}
