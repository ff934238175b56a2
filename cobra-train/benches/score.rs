//! What scoring costs on one core, next to the two usual ways of asking how far points lie from a
//! surface: the nearest of many surface points, and the distance to the mesh.

mod support;

use cobra_infer::{Assignment, Camera, Correspondence, Kernel, Pose, Settings, Template, score};
use cobra_train::demo::VIEW;
use cobra_train::pose::{ObservationNoise, disturb, observe};
use cobra_train::progress::Silent;
use cobra_train::random::{Purpose, stream};
use cobra_train::surface::{BoundingSphere, Mesh, RayCaster, sample_visible};
use cobra_train::train::{ReferencePoints, TrainOptions, train};
use criterion::Criterion;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use std::time::Duration;
use support::{Object, Size, Table, objects};

/// The most components that scorers here make room for.
const COMPONENTS: usize = 16;

/// So that 1,000 correspondences are scored against a template of 10,000 directions.
const POINTS_PER_CORRESPONDENCE: usize = 10;

/// The estimate's error and the noise of what it saw, as shares of the object's radius: of the
/// order that separates accepted from rejected poses.
const ERROR: f64 = 0.02;

fn main() {
    let size = Size::from_arguments();
    let mut criterion = Criterion::default()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .configure_from_args();
    for object in objects() {
        measure(&mut criterion, &object, &size);
    }
    criterion.final_summary();
}

fn measure(criterion: &mut Criterion, object: &Object, size: &Size) {
    let mesh = &object.mesh;
    let sphere = mesh.bounding_sphere();
    let caster = RayCaster::new(mesh);
    let surface = training_points(mesh, &sphere, size);
    let camera = Camera::new(
        VIEW.fx as f32,
        VIEW.fy as f32,
        VIEW.cx as f32,
        VIEW.cy as f32,
    )
    .expect("the demonstration's camera is a pinhole");
    let (pose, correspondences) = estimate(&caster, &surface, &camera, &sphere, size);
    let points: Vec<Point3<f32>> = correspondences
        .iter()
        .map(|c| camera.back_project(&pose, &c.pixel, &c.point).point)
        .collect();
    let templates = templates(mesh, size);
    let settings = Settings::with_delta((ERROR * sphere.radius) as f32);

    let mut group = criterion.benchmark_group(format!("score/{}", object.name));
    let mut table = Table::new(&mut group, 50);
    let mut bench = |name: &str, bytes: &[u8], assignment| {
        let template = Template::from_bytes(bytes).expect("what was trained can be read");
        let settings = Settings {
            assignment,
            ..settings
        };
        table.bench(name, || {
            score::<COMPONENTS>(&template, &camera, &pose, &settings, &correspondences)
                .expect("the template has no more components than there is room for")
        });
    };
    for (kernel, bytes) in Kernel::ALL.iter().zip(&templates) {
        bench(kernel.name(), bytes, Assignment::Nearest);
    }
    for (rule, assignment) in [("maximum", Assignment::Maximum), ("soft", Assignment::Soft)] {
        let name = format!("{}, {rule}", Kernel::ALL[0].name());
        bench(&name, &templates[0], assignment);
    }
    table.bench("loading the template", || {
        Template::from_bytes(&templates[0]).expect("what was trained can be read")
    });

    let cloud: Vec<[f32; 3]> = surface.iter().map(|p| p.cast::<f32>().into()).collect();
    let tree = ImmutableKdTree::<f32, 3>::new_from_slice(&cloud)
        .expect("a sampled surface has no more points than a tree takes");
    table.bench("nearest training point", || {
        let squared = points.iter().map(|point| {
            tree.query(&<[f32; 3]>::from(*point))
                .nearest_one::<SquaredEuclidean<f32>>()
                .execute()
                .distance
        });
        squared.sum::<f32>()
    });
    table.bench("distance to the mesh", || {
        let distances = points.iter().map(|point| caster.distance(&point.cast()));
        distances.sum::<f64>()
    });
    table.print(&format!(
        "{}, {} points, one core",
        object.name,
        points.len()
    ));
    group.finish();
}

/// The points that [`train`] fits a template to, in the mesh's frame.
fn training_points(mesh: &Mesh, sphere: &BoundingSphere, size: &Size) -> Vec<Point3<f64>> {
    let unit = mesh.normalised(sphere);
    let wanted = size.points + size.test_points;
    sample_visible(&unit, &RayCaster::new(&unit), wanted, 0, Purpose::Training)
        .expect("both objects show their surface")
        .iter()
        .take(size.points)
        .map(|point| sphere.denormalise(&point.position))
        .collect()
}

/// One template for each of [`Kernel::ALL`], all of them with the reference points of the first: a
/// point then costs the same number of terms under each.
fn templates(mesh: &Mesh, size: &Size) -> Vec<Vec<u8>> {
    let mut options = size.train_options();
    let mut templates = Vec::new();
    for kernel in Kernel::ALL {
        options.fit.model.kernel = kernel;
        let trained =
            train(&mesh.clone().into(), &options, &Silent).expect("both objects can be trained");
        if templates.is_empty() {
            options = with_reference_points_of(&trained.bytes, options);
        }
        templates.push(trained.bytes);
    }
    templates
}

fn with_reference_points_of(bytes: &[u8], options: TrainOptions) -> TrainOptions {
    let template = Template::from_bytes(bytes).expect("what was trained can be read");
    let centres = template
        .components()
        .map(|component| Point3::from(component.centre).cast())
        .collect();
    TrainOptions {
        reference_points: ReferencePoints::Given(centres),
        ..options
    }
}

/// A slightly wrong pose, and what its estimator saw.
fn estimate(
    caster: &RayCaster,
    surface: &[Point3<f64>],
    camera: &Camera,
    sphere: &BoundingSphere,
    size: &Size,
) -> (Pose, Vec<Correspondence>) {
    let mut rng = stream(0, Purpose::PoseErrors, 0);
    let turn = UnitQuaternion::from_euler_angles(2.5, 0.4, 0.3);
    let away = Vector3::new(0.0, 0.0, 5.0 * sphere.radius);
    let truth = Isometry3::from_parts((away - turn * sphere.centre.coords).into(), turn);
    let noise = ObservationNoise {
        pixel: 0.7,
        point: ERROR * sphere.radius,
        outliers: 0.05,
        outlier_pixel: 20.0,
    };
    let seen = observe(
        caster,
        surface,
        camera,
        &truth,
        &noise,
        size.points / POINTS_PER_CORRESPONDENCE,
        &mut rng,
    );
    let error = ERROR * sphere.radius;
    let pose = disturb(&truth, &sphere.centre, sphere.radius, error, &mut rng).cast::<f32>();
    let rotation = pose.rotation.to_rotation_matrix();
    // nalgebra stores columns; the transposed matrix's columns are the rows.
    let rows = rotation.matrix().transpose();
    let mut r = [0.0; 9];
    r.copy_from_slice(rows.as_slice());
    let pose = Pose::from_row_major(r, pose.translation.vector.into());
    (pose.expect("a unit quaternion is a rotation"), seen)
}
