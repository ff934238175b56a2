//! What scoring costs on one core, next to the two usual ways of asking how far points lie from a
//! surface, the nearest of many surface points and the distance to the mesh, and next to the
//! posterior means of other crates; then under each kernel and each rule of assignment.

mod support;

use cobra_infer::template::DecodedTerm;
use cobra_infer::{
    Assignment, Camera, Correspondence, Kernel, Mixture, Pose, Settings, Template, score,
};
use cobra_train::demo::VIEW;
use cobra_train::evaluate::evaluation_points;
use cobra_train::pose::{ObservationNoise, disturb, observe};
use cobra_train::progress::Silent;
use cobra_train::random::{Purpose, stream};
use cobra_train::reference::Cluster;
use cobra_train::surface::{BoundingSphere, Geometry, Mesh, RayCaster};
use cobra_train::train::{
    LARGEST_TEMPLATE, MAP_BUDGET, MeanForm, ReferencePoints, TrainOptions, train,
};
use criterion::Criterion;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use std::time::Duration;
use support::{Component, Object, PEERS, Size, Table, components, objects, training_points};

/// The most components that scorers here make room for.
const COMPONENTS: usize = 16;

/// So that 1,000 correspondences are scored against a template of 10,000 directions.
const POINTS_PER_CORRESPONDENCE: usize = 10;

/// The estimate's error and the noise of what it saw, as shares of the object's radius: of the
/// order that separates accepted from rejected poses.
const ERROR: f64 = 0.02;

/// Of peers' processes, of the order that is learned: what a prediction costs does not depend on
/// it.
const LENGTH_SCALE: f64 = 0.5;

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
    let training = training_points(object, size);
    measure_peers(criterion, object, &training, size);
    measure_kernels(criterion, object, &training, size);
}

/// The default template, and everybody else, on the same points of the surface.
fn measure_peers(
    criterion: &mut Criterion,
    object: &Object,
    training: &[Point3<f64>],
    size: &Size,
) {
    let sphere = object.mesh.bounding_sphere();
    let geometry = Geometry::from(object.mesh.clone());
    let baked = TrainOptions {
        mean: MeanForm::Map,
        budget: Some(MAP_BUDGET),
        ..size.default_options()
    };
    let forms = [
        ("cobra-infer", size.default_options()),
        ("cobra-infer, map", baked),
    ];
    let count = size.points / POINTS_PER_CORRESPONDENCE;
    let points = evaluation_points(&geometry, count, 0).expect("both objects show their surface");
    let single: Vec<Point3<f32>> = points.iter().map(|point| point.cast()).collect();

    let mut group = criterion.benchmark_group(format!("score/{}", object.name));
    let mut table = Table::new(&mut group, 50);
    for (name, options) in forms {
        let trained = train(&geometry, &options, &Silent).expect("both objects can be trained");
        let template = Template::from_bytes(&trained.bytes).expect("what was trained can be read");
        let mut room = vec![DecodedTerm::default(); template.decoded_len()];
        let template = template.decoded(&mut room).expect("there is room");
        let settings = Settings {
            delta: (ERROR * sphere.radius) as f32,
            ..Settings::for_template(&template, 1.0)
        };
        table.bench(name, || {
            let mixture = Mixture::<LARGEST_TEMPLATE>::new(&template, &settings)
                .expect("the host has room for every template");
            let found = single.iter().filter_map(|point| mixture.evaluate(point));
            found.map(|found| found.likelihood).sum::<f32>()
        });
    }

    let cloud: Vec<[f32; 3]> = training
        .iter()
        .map(|point| sphere.denormalise(point).cast::<f32>().into())
        .collect();
    let tree = ImmutableKdTree::<f32, 3>::new_from_slice(&cloud)
        .expect("a sampled surface has no more points than a tree takes");
    table.bench("kiddo: nearest training point", || {
        let squared = single.iter().map(|point| {
            tree.query(&<[f32; 3]>::from(*point))
                .nearest_one::<SquaredEuclidean<f32>>()
                .execute()
                .distance
        });
        squared.sum::<f32>()
    });
    let caster = RayCaster::new(&object.mesh);
    table.bench("parry3d: distance to the mesh", || {
        let distances = points.iter().map(|point| caster.distance(point));
        distances.sum::<f64>()
    });

    let unit: Vec<Point3<f64>> = points.iter().map(|p| sphere.normalise(p)).collect();
    let components = components(training, size);
    let queries: Vec<Vec<[f64; 3]>> = with_points(&components, &unit)
        .iter()
        .map(|component| component.directions_and_distances().0)
        .collect();
    for (name, fit) in PEERS {
        let processes: Vec<_> = components
            .iter()
            .map(|component| fit(component, Some(LENGTH_SCALE)))
            .collect();
        table.bench(&format!("{name}: posterior mean"), || {
            let asked = processes.iter().zip(&queries);
            asked
                .filter(|(_, directions)| !directions.is_empty())
                .map(|(process, directions)| process(directions).iter().sum::<f64>())
                .sum::<f64>()
        });
    }
    table.print(&format!("{}, {count} surface points", object.name));
    group.finish();
}

/// The same reference points with other points: each has those that are nearest to it.
fn with_points(components: &[Component], points: &[Point3<f64>]) -> Vec<Component> {
    let clusters: Vec<Cluster> = components
        .iter()
        .map(|component| Cluster::round(component.centre))
        .collect();
    Component::of(&clusters, points)
}

/// k-means components under each kernel and each rule of assignment, from correspondences on.
fn measure_kernels(
    criterion: &mut Criterion,
    object: &Object,
    training: &[Point3<f64>],
    size: &Size,
) {
    let sphere = object.mesh.bounding_sphere();
    let caster = RayCaster::new(&object.mesh);
    let surface: Vec<Point3<f64>> = training.iter().map(|p| sphere.denormalise(p)).collect();
    let camera = Camera::new(
        VIEW.fx as f32,
        VIEW.fy as f32,
        VIEW.cx as f32,
        VIEW.cy as f32,
    )
    .expect("the demonstration's camera is a pinhole");
    let (pose, correspondences) = estimate(&caster, &surface, &camera, &sphere, size);
    let templates = templates(&object.mesh, size);
    let settings = Settings::with_delta((ERROR * sphere.radius) as f32);

    let mut group = criterion.benchmark_group(format!("kernels/{}", object.name));
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

    table.print(&format!(
        "{}, {} correspondences",
        object.name,
        correspondences.len()
    ));
    group.finish();
}

/// One template for each of [`Kernel::ALL`], all of them with the reference points of the first: a
/// point then costs the same number of terms under each.
fn templates(mesh: &Mesh, size: &Size) -> Vec<Vec<u8>> {
    let mut options = size.kmeans_options();
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
