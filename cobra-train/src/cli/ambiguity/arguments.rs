//! The arguments of `cobra ambiguity`.

use crate::cli::choices::not_negative;
use clap::{Args, ValueEnum};
use cobra_train::ambiguity::{CANDIDATES, Masks};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(
    after_help = "The object is rendered alone in views from all around; in each, rotations spread over all \
                  that there are follow the pose that the depth check suggests until they rest. Told is what \
                  rests at an ADD of at least a tenth of the diameter with a confidence that the template's \
                  calibration accepts, or without one with eight tenths of the true pose's.\n\n\
                  Examples:\n  cobra ambiguity part.cobra --mesh part.ply\n  cobra ambiguity \
                  obj_000011.cobra --mesh models/obj_000011.ply --models-info models/models_info.json \
                  --object 11 --json -"
)]
pub(crate) struct AmbiguityArguments {
    /// Template file
    #[arg(value_name = "FILE.cobra")]
    pub(crate) template: PathBuf,

    /// The mesh it was trained from, in the template's unit
    #[arg(long, value_name = "MESH")]
    pub(crate) mesh: PathBuf,

    /// BOP's models_info.json, whose symmetries are recognised among what is found
    #[arg(long, value_name = "FILE.json", requires = "object")]
    pub(crate) models_info: Option<PathBuf>,

    /// Which object of --models-info it is
    #[arg(long, value_name = "ID", requires = "models_info")]
    pub(crate) object: Option<u32>,

    /// Views of the object, spread evenly around it
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=1_000))]
    pub(crate) views: u32,

    /// Rotations that are tried in each view; 1152 are 23 degrees apart
    #[arg(long, value_name = "N", default_value_t = CANDIDATES as u32, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) candidates: u32,

    /// Which pixels show the object: all in which it is seen, or those in which the tried pose says so
    #[arg(long, value_enum, default_value_t = MasksArgument::Simulated)]
    pub(crate) masks: MasksArgument,

    /// Standard deviation of the simulated depth in mm
    #[arg(long, value_name = "MM", value_parser = not_negative::<f32>, default_value_t = 0.0)]
    pub(crate) depth_noise: f32,

    /// Seed of all randomness
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,

    /// Write what was found as JSON, `-` for standard output
    #[arg(long, value_name = "FILE|-")]
    pub(crate) json: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum MasksArgument {
    Simulated,
    Silhouette,
}

impl From<MasksArgument> for Masks {
    fn from(masks: MasksArgument) -> Self {
        match masks {
            MasksArgument::Simulated => Self::Visible,
            MasksArgument::Silhouette => Self::Silhouette,
        }
    }
}
