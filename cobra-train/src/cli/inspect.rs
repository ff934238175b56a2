//! `cobra inspect`: what is in a template.

mod depth;

use super::args::InspectArguments;
use super::failure::Failure;
use super::outputs;
use super::report::{JsonTarget, table};
use super::template_file;
use super::terminal::Terminal;
use cobra_infer::template::{Quality, VERSION};
use cobra_infer::{Assignment, Template};
use cobra_train::export::{counted, elements, features};
use cobra_train::report::Bytes;
use depth::DepthDocument;
use serde::Serialize;

pub(super) fn run(arguments: &InspectArguments, terminal: &Terminal) -> Result<(), Failure> {
    let bytes = template_file::read(&arguments.template)?;
    let template = Template::from_bytes(&bytes)
        .map_err(|error| Failure::template(&arguments.template, &error))?;
    if let Some(path) = outputs::named_file(arguments.json.as_ref()) {
        outputs::check(&[&arguments.template], &[path])?;
    }
    let document = Document::new(&template, bytes.len());
    let json = JsonTarget(arguments.json.as_ref());
    json.write(&document, terminal)?;
    if json.replaces_the_table() {
        return Ok(());
    }
    terminal.print(&text(&document, elements(&template), counted(&template)))
}

#[derive(Serialize)]
struct Document {
    schema: u32,
    name: String,
    format_version: u16,
    unit: &'static str,
    centre: [f32; 3],
    radius: f32,
    diameter: f32,
    metric: &'static str,
    kernel: &'static str,
    /// What the components' `parameter` is, where the kernel has one.
    parameter: Option<&'static str>,
    /// The features of `cobra-infer` that a controller needs to read it.
    features: Vec<&'static str>,
    /// Whether components carry a precision Q_k of their own.
    precisions: bool,
    /// Whether components speak only where they were verified.
    validity: bool,
    /// How terms are stored: `exact`, 16 bytes each, or `compact`, 5 bytes each and 4 a component; or
    /// `map`, with nodes in their place, a byte each and 20 a component.
    encoding: &'static str,
    terms: usize,
    bytes: Bytes,
    /// Of maps, nodes that are read.
    kernel_evaluations_per_point: Evaluations,
    /// What training measured on points that it did not learn from; `null` where the template does
    /// not say.
    quality: Option<QualityDocument>,
    /// What it knows for depth mode; `null` where it knows nothing.
    depth: Option<DepthDocument>,
    components: Vec<ComponentDocument>,
}

#[derive(Serialize)]
struct QualityDocument {
    /// Percent of the points that some component explains.
    covered: f32,
    /// How far compression or baking moved the mean, in units of sigma-hat; `null` for exact terms.
    deviation: Option<Deviation>,
}

#[derive(Serialize)]
struct Deviation {
    max: f32,
    rms: f32,
}

#[derive(Serialize)]
struct Evaluations {
    nearest_most: usize,
    maximum: usize,
}

#[derive(Serialize)]
struct ComponentDocument {
    centre: [f32; 3],
    sigma_hat: f32,
    length_scale: f32,
    parameter: f32,
    prior_mean: f32,
    terms: usize,
    /// Percent of the points in its care that it does not explain; `null` where the template does not
    /// say.
    unexplained: Option<f32>,
}

impl Document {
    fn new(template: &Template<'_>, total: usize) -> Self {
        let cost = template.cost();
        let quality = template.quality();
        let encoding = if template.has_maps() {
            "map"
        } else if template.has_compact_terms() {
            "compact"
        } else {
            "exact"
        };
        let mut unexplained = quality.iter().flat_map(Quality::unexplained);
        Self {
            schema: 2,
            name: template.name().to_owned(),
            format_version: VERSION,
            unit: template.unit().symbol(),
            centre: template.centre(),
            radius: template.radius(),
            diameter: template.diameter(),
            metric: template.metric().name(),
            kernel: template.kernel().name(),
            parameter: template.kernel().parameter_name(),
            features: features(template),
            precisions: template.has_precisions(),
            validity: template.has_validity(),
            encoding,
            terms: template.term_count(),
            bytes: Bytes::of(template, total),
            kernel_evaluations_per_point: Evaluations {
                nearest_most: cost.of(Assignment::Nearest),
                maximum: cost.of(Assignment::Maximum),
            },
            quality: quality.map(|quality| QualityDocument {
                covered: 100.0 * quality.covered,
                deviation: (encoding != "exact").then_some(Deviation {
                    max: quality.deviation_max,
                    rms: quality.deviation_rms,
                }),
            }),
            depth: template.depth().map(|depth| DepthDocument::new(&depth)),
            components: template
                .components()
                .map(|component| ComponentDocument {
                    centre: component.centre,
                    sigma_hat: component.sigma_hat,
                    length_scale: component.hyperparameters.length_scale,
                    parameter: component.hyperparameters.parameter,
                    prior_mean: component.hyperparameters.prior_mean,
                    terms: component.terms.len(),
                    unexplained: unexplained.next().map(|share| 100.0 * share),
                })
                .collect(),
        }
    }
}

fn text(document: &Document, terms: &str, counted: &str) -> String {
    let unit = document.unit;
    let bytes = &document.bytes;
    let evaluations = &document.kernel_evaluations_per_point;
    let [x, y, z] = document.centre;
    let rows: Vec<Vec<String>> = document
        .components
        .iter()
        .enumerate()
        .map(|(index, component)| {
            let [x, y, z] = component.centre;
            let mut row = vec![
                index.to_string(),
                format!("{x:.3}"),
                format!("{y:.3}"),
                format!("{z:.3}"),
                format!("{:.4}", component.sigma_hat),
                component.terms.to_string(),
                format!("{:.4}", component.length_scale),
            ];
            row.extend(component.unexplained.map(|share| format!("{share:.2}")));
            row
        })
        .collect();
    let (x_header, sigma_hat_header) = (format!("x ({unit})"), format!("sigma-hat ({unit})"));
    let mut header = vec![
        "component",
        &x_header,
        "y",
        "z",
        &sigma_hat_header,
        terms,
        "length scale",
    ];
    if document.quality.is_some() {
        header.push("unexplained %");
    }
    let depth = document
        .depth
        .as_ref()
        .map_or_else(String::new, DepthDocument::text);
    format!(
        "object      {}\n\
         unit        {unit}\n\
         sphere      radius {:.3} around ({x:.3}, {y:.3}, {z:.3})\n\
         diameter    {:.3}\n\
         kernel      {}, {} metric\n\
         features    {} of cobra-infer, on the controller\n\
         components  {}, {}; they speak {}\n\
         {terms}       {}, {}\n\
         quality     {}\n\
         {depth}size        {} bytes: {} {terms}, {} component records, {} validity, {} the rest\n\
         cost        {counted} a point: at most {} (nearest), {} (max, soft)\n\n{}",
        document.name,
        document.radius,
        document.diameter,
        document.kernel,
        document.metric,
        if document.features.is_empty() {
            "none".to_owned()
        } else {
            document.features.join(" and ")
        },
        document.components.len(),
        if document.precisions {
            "with precisions: near and far by each one's own Q"
        } else {
            "near and far by Euclidean distance"
        },
        if document.validity {
            "where they were verified"
        } else {
            "everywhere"
        },
        document.terms,
        document.encoding,
        document
            .quality
            .as_ref()
            .map_or_else(|| "not told".to_owned(), quality_text),
        bytes.total,
        bytes.terms,
        bytes.components,
        bytes.validity,
        bytes.other,
        evaluations.nearest_most,
        evaluations.maximum,
        table(&header, &[], &rows)
    )
}

fn quality_text(quality: &QualityDocument) -> String {
    let covered = format!(
        "{:.2} % of the points that training left out are explained",
        quality.covered
    );
    match &quality.deviation {
        Some(deviation) => format!(
            "{covered}; compression moved the mean by {:.3} sigma-hat rms, {:.3} at most",
            deviation.rms, deviation.max
        ),
        None => covered,
    }
}
