//! `cobra demo`: the whole path on a part that code makes.

use super::args::DemoArguments;
use super::failure::Failure;
use super::report::table;
use super::terminal::Terminal;
use cobra_infer::{Decision, Report, Settings, Sigma, Template, score};
use cobra_train::demo::{
    MEASUREMENT_NOISE, ScoredPose, SimulatedEstimate, VIEW, draw, encode_png, mechanical_part,
    scorer_camera, simulate,
};
use cobra_train::output::write_whole;
use cobra_train::pose::single_pose;
use cobra_train::progress::Progress;
use cobra_train::train::{LARGEST_TEMPLATE, TrainOptions, train};

/// Rows of the table that is printed; all rows are in the CSV file.
const ROWS: usize = 20;

pub(super) fn run(arguments: &DemoArguments, terminal: &Terminal) -> Result<(), Failure> {
    let folder = &arguments.output;
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::Io(format!("cannot make {}: {error}", folder.display())))?;
    let [template_file, csv_file, png_file] =
        ["bracket.cobra", "poses.csv", "poses.png"].map(|name| folder.join(name));

    let mesh = mechanical_part();
    terminal.say(&format!(
        "a bracket made by code: {} triangles, diameter {:.1} mm",
        mesh.triangles().len(),
        mesh.diameter()
    ));
    let options = TrainOptions {
        seed: arguments.seed,
        ..TrainOptions::new("bracket")
    };
    let trained = train(&mesh.clone().into(), &options, terminal)?;
    write_whole(&template_file, &trained.bytes)?;
    let template = Template::from_bytes(&trained.bytes)
        .map_err(|error| Failure::template(&template_file, &error))?;

    terminal.start("simulating estimates", 1);
    let estimates = simulate(&mesh, arguments.poses as usize, arguments.seed)
        .map_err(|error| Failure::BadInput(error.to_string()))?;
    terminal.finish();
    terminal.start("scoring", 1);
    let scored: Vec<(SimulatedEstimate, Report)> = estimates
        .into_iter()
        .map(|estimate| judge(&template, estimate))
        .collect::<Result<_, _>>()?;
    terminal.finish();
    write_whole(&csv_file, csv(&scored).as_bytes())?;

    terminal.start("drawing", 1);
    let poses: Vec<ScoredPose> = scored
        .iter()
        .map(|(estimate, report)| ScoredPose {
            truth: estimate.truth,
            pose: estimate.pose,
            error_mm: estimate.error,
            confidence: f64::from(report.confidence),
            threshold: f64::from(report.threshold),
            verdict: report.decision.into(),
        })
        .collect();
    let title = format!(
        "COBRA on a machined bracket: which of {} pose estimates can be trusted?",
        poses.len()
    );
    let picture = draw(&mesh, &VIEW, &poses, &title)
        .and_then(|image| encode_png(&image))
        .map_err(|error| Failure::Io(error.to_string()))?;
    write_whole(&png_file, &picture)?;
    terminal.finish();

    terminal.print(&text(&scored))?;
    terminal.print(&format!(
        "template  {} ({} bytes)\ntable     {}\npicture   {}",
        template_file.display(),
        trained.bytes.len(),
        csv_file.display(),
        png_file.display()
    ))
}

fn judge(
    template: &Template<'_>,
    estimate: SimulatedEstimate,
) -> Result<(SimulatedEstimate, Report), Failure> {
    let pose = single_pose(&estimate.pose)
        .map_err(|error| Failure::BadInput(format!("simulated pose: {error}")))?;
    let settings = Settings {
        delta: 0.01 * template.diameter(),
        sigma: Sigma::Template {
            noise: MEASUREMENT_NOISE as f32,
        },
        ..Settings::for_template(template, 1.0)
    };
    let report = score::<LARGEST_TEMPLATE>(
        template,
        &scorer_camera(),
        &pose,
        &settings,
        &estimate.correspondences,
    )?;
    Ok((estimate, report))
}

fn csv(scored: &[(SimulatedEstimate, Report)]) -> String {
    let mut text = String::from("estimate,error_mm,points,confidence,threshold,decision,reason\n");
    for (index, (estimate, report)) in scored.iter().enumerate() {
        text += &format!(
            "{index},{:.4},{},{},{},{},{}\n",
            estimate.error,
            report.points,
            report.confidence,
            report.threshold,
            report.decision.name(),
            report.decision.reason()
        );
    }
    text
}

fn text(scored: &[(SimulatedEstimate, Report)]) -> String {
    let last = scored.len().saturating_sub(1);
    let shown = ROWS.min(scored.len());
    let rows: Vec<Vec<String>> = (0..shown)
        .map(|row| {
            let index = row * last / shown.saturating_sub(1).max(1);
            let (estimate, report) = &scored[index];
            vec![
                index.to_string(),
                format!("{:.2}", estimate.error),
                format!("{:.3}", report.confidence),
                format!("{:.3}", report.threshold),
                report.decision.name().to_owned(),
            ]
        })
        .collect();
    let header = [
        "estimate",
        "error (ADD, mm)",
        "confidence",
        "threshold",
        "decision",
    ];
    let count = |wanted: &str| {
        scored
            .iter()
            .filter(|(_, report)| report.decision.name() == wanted)
            .count()
    };
    let worst_accepted = scored
        .iter()
        .rfind(|(_, report)| report.decision == Decision::Accept)
        .map_or(0.0, |(estimate, _)| estimate.error);
    format!(
        "{}\n\n{shown} of {} estimates shown; {} accepted (largest error {worst_accepted:.2} mm), \
         {} rejected, {} undecided\n",
        table(&header, &["decision"], &rows),
        scored.len(),
        count("accept"),
        count("reject"),
        count("undecided"),
    )
}
