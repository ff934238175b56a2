//! The arguments of `cobra calibrate`.

use crate::cli::choices::not_negative;
use clap::{ArgGroup, Args, ValueEnum};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(
    group(ArgGroup::new("evidence").args(["labelled", "simulate"]).required(true)),
    after_help = "The report is what cobra bop score --report writes, of the same templates and \
                  settings that will score on the robot: its estimates, their confidences, and which \
                  of them are right; its lengths are in millimetres. Wrong estimates reach the threshold to accept \
                  at most at the share given; the interval of that share, from low to high, is Wilson's at \
                  95 %. Estimates of all objects are taken together unless --object names one.\n\nWith \
                  --simulate there is no report: the object is put before a simulated camera, and estimates \
                  of it are off by 1 % to 100 % of its diameter.\n\n\
                  Examples:\n  cobra calibrate part.cobra --labelled report.json --false-accept \
                  0.01\n  cobra calibrate part.cobra --labelled report.json --false-accept 0.005 \
                  --object 5 --curves curves -o calibrated.cobra\n  cobra calibrate part.cobra --simulate 5000 \
                  --mesh part.ply --false-accept 0.01"
)]
pub(crate) struct CalibrateArguments {
    /// Template file that the thresholds are stored in
    #[arg(value_name = "FILE.cobra")]
    pub(crate) template: PathBuf,

    // What goes with --simulate conflicts with the other: a `requires` would not do,
    // which clap passes over where the option that is required conflicts with one that is there.
    /// Report of scored estimates with their truth
    #[arg(long, value_name = "REPORT.json", conflicts_with_all = ["mesh", "masks", "depth_noise", "symmetric", "seed"])]
    pub(crate) labelled: Option<PathBuf>,

    /// Simulate so many estimates of the object, and score them against simulated depth
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(100..=1_000_000))]
    pub(crate) simulate: Option<u32>,

    /// With --simulate: what the camera sees, in the template's unit [default: the template's own surface,
    /// which then has no error]
    #[arg(long, value_name = "MESH")]
    pub(crate) mesh: Option<PathBuf>,

    /// With --simulate: which pixels show the object: those that a mask says, or those in which the estimate
    /// itself says that it is seen
    #[arg(long, value_enum, default_value_t = MasksArgument::Silhouette)]
    pub(crate) masks: MasksArgument,

    /// With --simulate: standard deviation of the depth, in mm [default: 1.5]
    #[arg(long, value_name = "MM", value_parser = not_negative::<f64>)]
    pub(crate) depth_noise: Option<f64>,

    /// With --simulate: judge estimates by ADD-S, of an object that looks the same from several sides
    #[arg(long)]
    pub(crate) symmetric: bool,

    /// With --simulate: seed of all randomness
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,

    /// Share of the wrong estimates that may be accepted, above 0 and below 1
    #[arg(long, value_name = "SHARE", value_parser = share)]
    pub(crate) false_accept: f64,

    /// Share of the right estimates that may be rejected; between the thresholds the answer is undecided
    /// [default: that of --false-accept]
    #[arg(long, value_name = "SHARE", value_parser = share)]
    pub(crate) reject_right: Option<f64>,

    /// Take the estimates of this object alone
    #[arg(long, value_name = "ID")]
    pub(crate) object: Option<u64>,

    /// With fewer valid pixels an estimate is undecided; such estimates are left out
    #[arg(long, value_name = "N", default_value_t = cobra_infer::Settings::MINIMUM_POINTS)]
    pub(crate) min_points: u32,

    /// Where the thresholds come from, in words, at most 48 bytes [default: the dataset's name, else
    /// the report's]
    #[arg(long, value_name = "TEXT")]
    pub(crate) provenance: Option<String>,

    /// Folder for roc.svg, precision-recall.svg and reliability.svg; made if missing
    #[arg(long, value_name = "DIR")]
    pub(crate) curves: Option<PathBuf>,

    /// Template file to write [default: FILE.cobra itself]
    #[arg(short, long, value_name = "OUT.cobra")]
    pub(crate) output: Option<PathBuf>,

    /// Write what was found as JSON, `-` for standard output
    #[arg(long, value_name = "FILE|-")]
    pub(crate) json: Option<PathBuf>,
}

fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if share > 0.0 && share < 1.0 => Ok(share),
        _ => Err("expected a share above 0 and below 1, such as 0.01 for 1 %".to_owned()),
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MasksArgument {
    /// The pixels that show the object
    Simulated,
    /// The pixels in which the estimate says that it is seen
    Silhouette,
}
