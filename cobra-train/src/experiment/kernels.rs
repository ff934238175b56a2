//! The supplement's ablation of kernels.

use super::bench::Bench;
use super::error::ExperimentError;
use super::findings::Findings;
use super::subject::Subject;
use super::table::{Table, mean};
use super::templates::{NAME, trained};
use super::{Experiment, paper, shape};
use crate::digits::grouped;
use crate::evaluate::{ShapeMetrics, evaluate};
use crate::gp::PriorMean;
use crate::plot::{Axis, Colour, Item, Look, Mark, Page, Panel};
use crate::progress::Silent;
use crate::random::Purpose;
use crate::surface::{Mesh, RayCaster};
use crate::train::{ReferencePoints, TrainOptions, train};
use cobra_infer::{Assignment, Exponent, Kernel, Metric, Model, Smoothness, Template};
use nalgebra::Point3;

/// In the order of the paper's table, what it leaves open in all forms.
const KERNELS: [(Kernel, &str); 10] = [
    (Kernel::Polynomial, "polynomial"),
    (Kernel::Periodic, "periodic"),
    (Kernel::Linear, "linear"),
    (Kernel::RadialBasis, "RBF"),
    (
        Kernel::RationalQuadratic(Exponent::Free),
        "rational quadratic",
    ),
    (
        Kernel::RationalQuadratic(Exponent::Half),
        "rational quadratic, α = ½",
    ),
    (
        Kernel::RationalQuadratic(Exponent::One),
        "rational quadratic, α = 1",
    ),
    (Kernel::Matern(Smoothness::FiveHalves), "Matérn 5/2"),
    (Kernel::Matern(Smoothness::ThreeHalves), "Matérn 3/2"),
    (Kernel::Matern(Smoothness::Half), "Matérn 1/2"),
];

/// What the paper says of mean F: each at least as good as the next. Its Matérn is taken for GPyTorch's
/// default, 5/2.
const RANKING: [usize; 6] = [4, 7, 3, 1, 0, 2];

/// The paper's reference points an object, and its models a class.
const COMPONENTS: usize = 8;
const MODELS: usize = 5;
const POINTS: usize = 30_000;

/// The two forms of distance: that of the paper, with prior mean 0, and this project's.
const FORMS: [(Metric, PriorMean, &str); 2] = [
    (Metric::Angles, PriorMean::Zero, "(φ, θ), prior mean 0"),
    (
        Metric::Chord,
        PriorMean::Average,
        "chord, average prior mean",
    ),
];

/// Chamfer distance × 10³, precision, recall and F of every kernel in both forms.
type Row = [[[f64; 4]; FORMS.len()]; KERNELS.len()];

/// What the paper averages over: its name, and the objects.
struct Group<'s> {
    name: String,
    subjects: Vec<&'s Subject>,
}

pub(super) fn run(bench: &Bench<'_>) -> Result<Findings, ExperimentError> {
    let mut groups = groups(bench);
    let mut subjects: Vec<&Subject> = Vec::new();
    for &subject in groups.iter().flat_map(|group| &group.subjects) {
        if !subjects.contains(&subject) {
            subjects.push(subject);
        }
    }
    let (rows, seconds) = bench.of_subjects(Experiment::Kernels, &subjects, |subject| {
        measure(bench, subject)
    })?;
    for group in &mut groups {
        let measured = |subject: &&Subject| rows.iter().any(|(done, _)| done == subject);
        group.subjects.retain(measured);
    }
    groups.retain(|group| !group.subjects.is_empty());

    let mut numbers = Table::new(
        "",
        &[
            "class",
            "object",
            "kernel",
            "metric",
            "prior mean",
            "chamfer x1000",
            "P %",
            "R %",
            "F %",
        ],
    );
    for (subject, row) in &rows {
        for ((_, kernel), forms) in KERNELS.iter().zip(row) {
            for ((metric, prior_mean, _), [chamfer, precision, recall, f]) in
                FORMS.iter().zip(forms)
            {
                numbers.push(vec![
                    subject.class.clone(),
                    subject.name.clone(),
                    (*kernel).to_owned(),
                    metric.name().to_owned(),
                    match prior_mean {
                        PriorMean::Zero => "zero",
                        PriorMean::Average => "average",
                    }
                    .to_owned(),
                    format!("{chamfer:.4}"),
                    format!("{precision:.2}"),
                    format!("{recall:.2}"),
                    format!("{f:.2}"),
                ]);
            }
        }
    }

    // The means of a group: of each kernel and form, Chamfer distance and F.
    let of_group = |group: &Group<'_>, kernel: usize, form: usize| -> (f64, f64) {
        let of: Vec<&Row> = rows
            .iter()
            .filter(|(subject, _)| group.subjects.contains(subject))
            .map(|(_, row)| row)
            .collect();
        let value = |index: usize| mean(of.iter().map(|row| row[kernel][form][index]));
        (value(0), value(3))
    };
    let names: Vec<String> = KERNELS.iter().map(|(_, name)| (*name).to_owned()).collect();
    let mut tables = Vec::new();
    let mut panels = Vec::new();
    for group in &groups {
        let printed = printed_at(&group.name);
        let mut table = Table::new(
            format!(
                "**{}** ({} object{}): d_C × 10³ and F in percent.",
                group.name,
                group.subjects.len(),
                if group.subjects.len() == 1 { "" } else { "s" }
            ),
            &[
                "kernel",
                "the paper prints: d_C",
                "F",
                "(φ, θ), mean 0: d_C",
                "F",
                "chord, average mean: d_C",
                "F",
            ],
        );
        let mut items = Vec::new();
        for (kernel, (_, name)) in KERNELS.iter().enumerate() {
            let place = Axis::place(kernel, KERNELS.len());
            let of_paper = printed.and_then(|group| printed_of(name).map(|row| row[group]));
            let mut cells = vec![(*name).to_owned()];
            match of_paper {
                Some((chamfer, f)) => {
                    cells.extend([format!("{chamfer:.2}"), format!("{f:.1}")]);
                    items.push(Item::Series(PRINTED, vec![(f, place)]));
                }
                None => cells.extend(["–".to_owned(), "–".to_owned()]),
            }
            for (form, look) in LOOKS.iter().enumerate() {
                let (chamfer, f) = of_group(group, kernel, form);
                cells.extend([format!("{chamfer:.3}"), format!("{f:.1}")]);
                // Beside each other, where they would hide each other.
                let aside = [0.17, -0.17][form];
                items.push(Item::Series(*look, vec![(f, place + aside)]));
            }
            table.push(cells);
        }
        tables.push(table);
        panels.push(Panel {
            heading: group.name.clone(),
            across: Axis::linear("F, %", &[0.0, 20.0, 40.0, 60.0, 80.0, 100.0], 0.02),
            up: Axis::names("", &names),
            room: 190,
            items,
        });
    }
    let of_paper = groups.iter().any(|group| printed_at(&group.name).is_some());
    let overall = |kernel: usize, form: usize| {
        mean(groups.iter().map(|group| of_group(group, kernel, form).1))
    };
    let mut table = Table::new(
        "Mean F over these groups.",
        &["kernel", "the paper prints", FORMS[0].2, FORMS[1].2],
    );
    for (kernel, (_, name)) in KERNELS.iter().enumerate() {
        table.push(vec![
            (*name).to_owned(),
            printed_of(name).filter(|_| of_paper).map_or_else(
                || "–".to_owned(),
                |row| {
                    let printed = groups.iter().filter_map(|group| printed_at(&group.name));
                    format!("{:.1}", mean(printed.map(|index| row[index].1)))
                },
            ),
            format!("{:.1}", overall(kernel, 0)),
            format!("{:.1}", overall(kernel, 1)),
        ]);
    }
    tables.insert(0, table);
    let mut remarks = vec![best(|kernel| overall(kernel, 0))];
    if of_paper {
        remarks.insert(0, ranking(|kernel| overall(kernel, 0)));
    }
    let figure = Page {
        title: "The ablation of kernels",
        subtitle: "F-score with eight fixed reference points",
        legend: &[
            (LOOKS[0], FORMS[0].2.to_owned()),
            (LOOKS[1], FORMS[1].2.to_owned()),
            (PRINTED, "the paper prints".to_owned()),
        ],
        columns: 2,
        panel: (560, 380),
    }
    .svg(&panels)?;
    Ok(Findings {
        experiment: Experiment::Kernels,
        title: "Kernels",
        protocol: format!(
            "{COMPONENTS} reference points an object, the same for all kernels, placed by k-means; 10,000 \
             training and {points} fresh test points; hyperparameters by L-BFGS-B on 300 points of a component. \
             At most {MODELS} objects of a class, as in the paper. It does not say which Matérn (GPyTorch's \
             default is 5/2), nor whether its rational quadratic's exponent was free.",
            points = grouped(POINTS as u64)
        ),
        elsewhere: String::new(),
        numbers,
        tables,
        remarks,
        figure,
        seconds,
    })
}

const LOOKS: [Look; 2] = [
    Look::marks(Colour::Ochre, Mark::Triangle),
    Look::marks(Colour::Teal, Mark::Disc),
];
const PRINTED: Look = Look::marks(Colour::Vermilion, Mark::Stroke);

/// Where the paper's table has a group.
fn printed_at(group: &str) -> Option<usize> {
    paper::KERNEL_GROUPS.iter().position(|name| *name == group)
}

/// The row of the paper's table that a kernel is compared with; its Matérn's with every one.
fn printed_of(kernel: &str) -> Option<[(f64, f64); 4]> {
    let found = paper::KERNELS
        .iter()
        .find(|(name, _)| kernel == *name || (*name == "Matérn" && kernel.starts_with("Matérn")));
    found.map(|(_, row)| *row)
}

/// Whether mean F ranks the kernels as the paper's table does, in words.
fn ranking(mean_f: impl Fn(usize) -> f64) -> String {
    let expected = "rational quadratic ≥ Matérn ≥ RBF > periodic > polynomial > linear";
    let found: Vec<String> = RANKING
        .iter()
        .map(|&kernel| format!("{} {:.1}", KERNELS[kernel].1, mean_f(kernel)))
        .collect();
    let out_of_order: Vec<String> = RANKING
        .windows(2)
        .filter(|pair| mean_f(pair[0]) < mean_f(pair[1]))
        .map(|pair| format!("{} and {}", KERNELS[pair[0]].1, KERNELS[pair[1]].1))
        .collect();
    if out_of_order.is_empty() {
        format!(
            "The paper's ranking in mean F, {expected}, is found under its own form: {}.",
            found.join(", ")
        )
    } else {
        format!(
            "The paper's ranking in mean F, {expected}, is not found under its own form: {}; out of order: {}.",
            found.join(", "),
            out_of_order.join("; ")
        )
    }
}

/// The kernel of the largest mean F in the paper's own form, in words.
fn best(mean_f: impl Fn(usize) -> f64) -> String {
    let order = |a: &usize, b: &usize| mean_f(*a).total_cmp(&mean_f(*b));
    let best = (0..KERNELS.len()).max_by(order).unwrap_or(0);
    let (name, f) = (KERNELS[best].1, mean_f(best));
    let quadratic = mean_f(RANKING[0]);
    if best == RANKING[0] {
        format!("No kernel is above the rational quadratic's {f:.1}.")
    } else {
        format!(
            "Best of all in that form is {name}: {f:.1} where the rational quadratic has {quadratic:.1}."
        )
    }
}

/// The paper's groups as far as they are there, else the classes that are.
fn groups<'s>(bench: &Bench<'s>) -> Vec<Group<'s>> {
    let mut groups = Vec::new();
    for class in ["planes", "chairs"] {
        let of = bench.data.of_classes(&[class], MODELS);
        if of.iter().all(|subject| subject.class == class) {
            groups.push(Group {
                name: class.to_owned(),
                subjects: of,
            });
        }
    }
    let alone = |name: &str, found: Option<&'s Subject>| {
        found.map(|subject| Group {
            name: name.to_owned(),
            subjects: vec![subject],
        })
    };
    let bunny = bench.data.all().iter().find(|s| s.name.contains("bunny"));
    groups.extend(alone("screwdriver", bench.data.named("screwdriver")));
    groups.extend(alone("bunny", bunny));
    if groups.is_empty() {
        let subjects = bench.data.of_classes(&[], MODELS);
        groups.extend(
            subjects
                .chunk_by(|a, b| a.class == b.class)
                .map(|group| Group {
                    name: group[0].class.clone(),
                    subjects: group.to_vec(),
                }),
        );
    }
    groups
}

fn measure(bench: &Bench<'_>, subject: &Subject) -> Result<Row, ExperimentError> {
    let mesh = subject.mesh()?;
    let caster = RayCaster::new(&mesh);
    let points = subject.sample(&mesh, &caster, POINTS, bench.seed, Purpose::Evaluation)?;
    let mut options = TrainOptions::clustered(NAME, COMPONENTS);
    options.seed = bench.seed;
    options.test_points = shape::SIGMA_POINTS;
    options.reference_points = ReferencePoints::Given(centres(subject, &mesh, &options)?);
    let mut row: Row = [[[0.0; 4]; FORMS.len()]; KERNELS.len()];
    for (found, (kernel, _)) in row.iter_mut().zip(KERNELS) {
        for (found, (metric, prior_mean, _)) in found.iter_mut().zip(FORMS) {
            options.fit.model = Model { metric, kernel };
            options.fit.prior_mean = prior_mean;
            let bytes = trained(subject, &mesh, &options)?;
            *found = numbers(&bytes, &points)?;
        }
    }
    Ok(row)
}

/// The reference points that k-means places, in the unit sphere, where the mesh is.
fn centres(
    subject: &Subject,
    mesh: &Mesh,
    options: &TrainOptions,
) -> Result<Vec<Point3<f64>>, ExperimentError> {
    let trained = train(&mesh.clone().into(), options, &Silent);
    let trained = trained.map_err(|source| ExperimentError::Train {
        object: subject.name.clone(),
        source,
    })?;
    Ok(trained
        .components
        .iter()
        .map(|c| c.cluster.centre())
        .collect())
}

fn numbers(bytes: &[u8], points: &[Point3<f64>]) -> Result<[f64; 4], ExperimentError> {
    let template = Template::from_bytes(bytes)?;
    let ShapeMetrics {
        chamfer,
        precision,
        recall,
        f_score,
    } = evaluate(&template, Assignment::Nearest, points)?.shape;
    Ok([chamfer, precision, recall, f_score])
}
