//! `cobra eval`: how well a template reproduces a mesh or a cloud.

use super::args::EvalArguments;
use super::choices::assignment;
use super::failure::Failure;
use super::object;
use super::outputs;
use super::report::{JsonTarget, plural, table};
use super::template_file;
use super::terminal::Terminal;
use cobra_infer::{Assignment, Template};
use cobra_train::evaluate::{
    Evaluation, OwnCloud, ResidualSummary, ShapeMetrics, TrueSurface, WronglyAccepted, evaluate,
    evaluation_points, own_cloud, write_points, wrongly_accepted,
};
use cobra_train::progress::Progress;
use cobra_train::surface::Geometry;
use nalgebra::Point3;
use serde::Serialize;
use std::path::Path;

/// A mesh whose bounding sphere's radius differs by more than this share is not the template's.
const SAME_OBJECT: f64 = 0.01;

pub(super) fn run(arguments: &EvalArguments, terminal: &Terminal) -> Result<(), Failure> {
    let bytes = template_file::read(&arguments.template)?;
    let template = Template::from_bytes(&bytes)
        .map_err(|error| Failure::template(&arguments.template, &error))?;
    let written: Vec<&Path> = outputs::named_file(arguments.json.as_ref())
        .into_iter()
        .chain(arguments.points_out.as_deref())
        .collect();
    outputs::check(&[&arguments.template, &arguments.mesh], &written)?;
    let object = object::read(&arguments.mesh, arguments.unit_sphere, terminal)?.geometry;
    warn_of_another_object(&template, &object, terminal);
    let points = test_points(&object, arguments, terminal)?;
    let chosen = assignment(arguments.assignment, &template);
    let evaluation = evaluate(&template, chosen, &points)?;
    let mut beside = Vec::new();
    for other in [Assignment::Nearest, Assignment::Maximum, Assignment::Soft] {
        if other != chosen {
            beside.push((other, evaluate(&template, other, &points)?));
        }
    }
    let surface = TrueSurface::new(&object);
    let strict = Strict {
        wrongly_accepted: wrongly_accepted(&template, chosen, &surface, &points, arguments.seed)?,
        own_cloud: own_cloud(&template, &surface, &points),
    };
    if let Some(path) = &arguments.points_out {
        write_points(path, &evaluation.predicted)?;
    }
    let json = JsonTarget(arguments.json.as_ref());
    json.write(
        &Document {
            schema: 2,
            name: template.name(),
            points: points.len(),
            tau: cobra_train::evaluate::TAU,
            figures: Figures::new(chosen, &evaluation, &template),
            strict: &strict,
            other_rules: beside
                .iter()
                .map(|(rule, evaluation)| Figures::new(*rule, evaluation, &template))
                .collect(),
        },
        terminal,
    )?;
    if json.replaces_the_table() {
        return Ok(());
    }
    let mut rows = vec![(chosen, &evaluation)];
    rows.extend(beside.iter().map(|(rule, evaluation)| (*rule, evaluation)));
    terminal.print(&text(&template, &rows, points.len()))?;
    terminal.print(&strict.text())
}

fn test_points(
    object: &Geometry,
    arguments: &EvalArguments,
    terminal: &Terminal,
) -> Result<Vec<Point3<f64>>, Failure> {
    let points = evaluation_points(object, arguments.points as usize, arguments.seed)
        .map_err(|error| Failure::BadInput(format!("{}: {error}", arguments.mesh.display())))?;
    if let Geometry::Cloud(_) = object {
        terminal.say(&format!(
            "cloud: {} that training with --seed {} leaves out",
            plural(points.len(), "point"),
            arguments.seed
        ));
    }
    Ok(points)
}

fn warn_of_another_object(template: &Template<'_>, object: &Geometry, terminal: &Terminal) {
    let radius = object.bounding_sphere().radius;
    let expected = f64::from(template.radius());
    if (radius / expected - 1.0).abs() > SAME_OBJECT {
        terminal.warn(&format!(
            "the object's radius is {radius:.4}, the template's {expected:.4} {}: another object, or \
             another unit",
            template.unit().symbol()
        ));
    }
}

#[derive(Serialize)]
struct Document<'a> {
    schema: u32,
    name: &'a str,
    points: usize,
    tau: f64,
    #[serde(flatten)]
    figures: Figures,
    #[serde(flatten)]
    strict: &'a Strict,
    other_rules: Vec<Figures>,
}

/// Of the rule that was chosen.
#[derive(Serialize)]
struct Strict {
    wrongly_accepted: WronglyAccepted,
    /// `null` for a template without validity.
    own_cloud: Option<OwnCloud>,
}

impl Strict {
    fn text(&self) -> String {
        let mut text = format!(
            "\nwrongly accepted: {:.2} % of {} points 0.02 to 0.05 off the surface",
            self.wrongly_accepted.percent, self.wrongly_accepted.points
        );
        if let Some(own) = &self.own_cloud {
            text += &format!(
                "\nself F: {:.2} % (P {:.2}, R {:.2}) of {} points that the template predicts",
                own.self_f_score, own.self_precision, own.self_recall, own.points
            );
        }
        text
    }
}

/// Chamfer, shares and `residual` in the unit sphere; `residual_mm` in millimetres.
#[derive(Serialize)]
struct Figures {
    assignment: &'static str,
    #[serde(flatten)]
    shape: ShapeMetrics,
    residual: ResidualSummary,
    residual_mm: ResidualSummary,
    unmatched: usize,
    /// Percent of the test points with a residual of at most tau.
    covered: f64,
}

impl Figures {
    fn new(assignment: Assignment, evaluation: &Evaluation, template: &Template<'_>) -> Self {
        let unit_sphere = 1.0 / f64::from(template.radius());
        let millimetres = f64::from(template.unit().millimetres());
        Self {
            assignment: name(assignment),
            shape: evaluation.shape,
            residual: evaluation.residual.scaled(unit_sphere),
            residual_mm: evaluation.residual.scaled(millimetres),
            unmatched: evaluation.unmatched,
            covered: evaluation.covered,
        }
    }
}

fn name(assignment: Assignment) -> &'static str {
    match assignment {
        Assignment::Nearest => "nearest",
        Assignment::Maximum => "max",
        Assignment::Soft => "soft",
    }
}

fn text(
    template: &Template<'_>,
    evaluations: &[(Assignment, &Evaluation)],
    points: usize,
) -> String {
    let millimetres = f64::from(template.unit().millimetres());
    let rows: Vec<Vec<String>> = evaluations
        .iter()
        .map(|(assignment, evaluation)| {
            let shape = &evaluation.shape;
            let residual = evaluation.residual.scaled(millimetres);
            vec![
                name(*assignment).to_owned(),
                format!("{:.4}", shape.chamfer),
                format!("{:.2}", shape.precision),
                format!("{:.2}", shape.recall),
                format!("{:.2}", shape.f_score),
                format!("{:.2}", evaluation.covered),
                format!("{:.3}", residual.rms),
                format!("{:.3}", residual.median),
                format!("{:.3}", residual.p95),
            ]
        })
        .collect();
    let header = [
        "component",
        "chamfer x1000",
        "P %",
        "R %",
        "F %",
        "covered %",
        "rms mm",
        "median mm",
        "p95 mm",
    ];
    format!(
        "{}: {points} test points, tau 0.01 of the unit sphere\n\n{}",
        template.name(),
        table(&header, &["component"], &rows)
    )
}
