//! The arguments of `cobra report`.

use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(
    after_help = "The page is one file that loads nothing from elsewhere: the object to turn, coloured by \
                  residual in mm, by component and by what is covered; coverage, sigma-hat of each component, \
                  size, what controllers take, thresholds, ambiguities, and the command that made it. Without \
                  --mesh it shows the surface that the template itself describes, and residuals and coverage are \
                  not measured.\n\n\
                  Examples:\n  cobra report part.cobra --mesh part.ply\n  cobra report part.cobra --mesh part.ply \
                  --curves curves --ambiguity ambiguity.json -o part.html"
)]
pub(crate) struct ReportArguments {
    /// Template file
    #[arg(value_name = "FILE.cobra")]
    pub(crate) template: PathBuf,

    /// The mesh or point cloud it was trained from, in the template's unit
    #[arg(long, value_name = "MESH")]
    pub(crate) mesh: Option<PathBuf>,

    /// Move and scale the mesh into the unit sphere first, as for a template that was trained so
    #[arg(long, requires = "mesh")]
    pub(crate) unit_sphere: bool,

    /// Points of the mesh that are measured on, drawn independently of the training's
    #[arg(long, value_name = "N", default_value_t = 30_000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) points: u32,

    /// Folder with the curves of the template's calibration, as cobra calibrate --curves writes them
    #[arg(long, value_name = "DIR")]
    pub(crate) curves: Option<PathBuf>,

    /// Poses that shape cannot tell apart, as cobra ambiguity --json writes them
    #[arg(long, value_name = "FILE.json")]
    pub(crate) ambiguity: Option<PathBuf>,

    /// Seed of the points
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,

    /// Page to write, `-` for standard output [default: the template's name with .html]
    #[arg(short, long, value_name = "FILE.html|-")]
    pub(crate) output: Option<PathBuf>,
}
