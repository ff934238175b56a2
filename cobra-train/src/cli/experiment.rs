//! `cobra experiment`: the paper's tables and figures, computed anew.

use super::failure::Failure;
use super::report::{plural, table};
use super::terminal::{Terminal, command_line};
use clap::{Args, ValueEnum};
use cobra_train::experiment::{
    Bench, Data, Experiment, ExperimentError, Findings, Machine, document,
};
use cobra_train::output::{check_writable, write_whole};
use cobra_train::progress::Progress;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(
    after_help = "Writes NAME.csv (every number), NAME.svg (the figure) and NAME.md (what there is to read, \
                  beside what the paper prints) into the folder, and of `all` paper.md. What is done is kept in \
                  NAME.jsonl and templates/, so that a run that was interrupted goes on where it was; \
                  --fresh begins anew.\n\nData: meshes in DIR/meshes/CLASS, in DIR/CLASS (there also in folders of objects, as in ShapeNetCore), or in \
                  DIR itself. \
                  Classes of the paper are planes, chairs, sofas and screwdrivers; DIR/screwdriver beside \
                  DIR/meshes holds the paper's own screwdriver. \
                  Each object is scaled into a sphere of unit radius first: the unit of every length.\n\nExamples:\n  cobra experiment shape --data \
                  data --out results\n  cobra experiment all --data data --out results\n  cobra experiment \
                  scatter"
)]
pub(crate) struct ExperimentArguments {
    /// Which table or figure
    #[arg(value_enum)]
    name: Name,

    /// Folder of meshes [default: the demonstration's part alone]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,

    /// Folder for results; made if missing
    #[arg(long, value_name = "DIR", default_value = "experiments")]
    out: PathBuf,

    /// Seed of all randomness
    #[arg(long, default_value_t = 0)]
    seed: u64,

    /// Do everything anew, whatever earlier runs left in the folder
    #[arg(long)]
    fresh: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Name {
    /// Table 1: Chamfer distance, precision, recall, F-score
    Shape,
    /// Table 2: Spearman's rho between ADD and confidence of simulated estimates
    Correlation,
    /// Confidence over outlier share and outlier noise
    Noise,
    /// Thresholds of Eq. 11 over delta, beside the confidences of estimates
    Delta,
    /// Confidence against ADD, estimate by estimate
    Scatter,
    /// The ablation of kernels
    Kernels,
    /// Chamfer distance over the number of reference points
    ReferencePoints,
    /// Gaussian processes against a k-d tree of their input points
    Kdtree,
    /// Adam against L-BFGS-B, and how many points hyperparameters are learned on
    Learning,
    /// All of them, and paper.md
    All,
}

impl Name {
    fn experiments(self) -> Vec<Experiment> {
        vec![match self {
            Self::Shape => Experiment::Shape,
            Self::Correlation => Experiment::Correlation,
            Self::Noise => Experiment::Noise,
            Self::Delta => Experiment::Delta,
            Self::Scatter => Experiment::Scatter,
            Self::Kernels => Experiment::Kernels,
            Self::ReferencePoints => Experiment::ReferencePoints,
            Self::Kdtree => Experiment::Kdtree,
            Self::Learning => Experiment::Learning,
            Self::All => return Experiment::ALL.to_vec(),
        }]
    }
}

pub(super) fn run(arguments: &ExperimentArguments, terminal: &Terminal) -> Result<(), Failure> {
    let data = match &arguments.data {
        Some(folder) => {
            let data = Data::read(folder)?;
            terminal.say(&format!("objects: {}", data.words()));
            data
        }
        None => {
            terminal
                .say("note: without --data the demonstration's part is all there is to measure");
            Data::part()
        }
    };
    let out = &arguments.out;
    std::fs::create_dir_all(out)
        .map_err(|error| Failure::Io(format!("cannot make {}: {error}", out.display())))?;
    let bench = Bench::new(
        &data,
        out.clone(),
        arguments.seed,
        arguments.fresh,
        terminal,
    );
    for experiment in arguments.name.experiments() {
        for extension in ["csv", "svg", "md"] {
            check_writable(&out.join(format!("{}.{extension}", experiment.name())))?;
        }
    }
    check_writable(&out.join("paper.md"))?;
    let mut findings = Vec::new();
    for experiment in arguments.name.experiments() {
        match experiment.run(&bench) {
            Ok(found) => {
                let files = found.write(out, arguments.seed, &data.words())?;
                terminal.print(&text(&found))?;
                let names: Vec<String> = files.iter().map(|f| f.display().to_string()).collect();
                terminal.print(&format!("written: {}\n", names.join(", ")))?;
                findings.push(found);
            }
            Err(ExperimentError::NothingLeft) => {
                terminal.warn(&format!("{}: every object failed", experiment.name()));
            }
            Err(error) => return Err(error.into()),
        }
    }
    if matches!(arguments.name, Name::All) && !findings.is_empty() {
        let path = out.join("paper.md");
        let command = command_line(std::env::args_os().skip(1));
        let text = document(&findings, &Machine::this(), arguments.seed, &command);
        write_whole(&path, text.as_bytes())?;
        terminal.print(&format!("written: {}", path.display()))?;
    }
    match bench.failures().len() {
        0 => Ok(()),
        count => Err(Failure::BadInput(format!(
            "{} failed{}",
            plural(count, "result"),
            if findings.is_empty() {
                ""
            } else {
                "; the results are of the others"
            }
        ))),
    }
}

/// What there is to read, for a terminal.
fn text(found: &Findings) -> String {
    let mut text = format!("{}\n", found.title);
    for part in &found.tables {
        let header: Vec<&str> = part.header.iter().map(String::as_str).collect();
        text += &format!("\n{}\n", part.caption.replace("**", ""));
        text += &format!("{}\n", table(&header, &header[..part.text], &part.rows));
    }
    for remark in &found.remarks {
        text += &format!("\n{remark}\n");
    }
    text
}
