//! The arguments of `cobra bop`.

use crate::cli::choices::{BudgetArgument, MeanArgument, budget};
use crate::cli::sources::SourceArguments;
use clap::{Args, Subcommand};
use cobra_train::bop::score::ScoreOptions;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct BopArguments {
    #[command(subcommand)]
    pub(crate) command: BopCommand,
}

#[derive(Debug, Subcommand)]
pub(crate) enum BopCommand {
    /// Train a template for every object of a data set
    Train(BopTrainArguments),
    /// Score a results file against depth, and write it again with these scores
    Score(BopScoreArguments),
}

#[derive(Debug, Args)]
#[command(
    after_help = "Reads obj_000001.ply, ... and, if there, models_info.json; writes obj_000001.cobra, ... . \
                  Models are in millimetres, as BOP has them.\n\nExample:\n  cobra bop train --models \
                  lmo/models -o templates"
)]
pub(crate) struct BopTrainArguments {
    /// Folder of models
    #[arg(long, value_name = "DIR")]
    pub(crate) models: PathBuf,

    /// Folder for the templates; made if missing
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,

    /// Train these objects alone
    #[arg(long, value_name = "ID,ID,...", value_delimiter = ',')]
    pub(crate) objects: Vec<u32>,

    /// What the templates say the mean by, as for `cobra train`
    #[arg(long, value_enum, default_value_t = MeanArgument::Gp)]
    pub(crate) mean: MeanArgument,

    /// Most bytes that a template may have, as for `cobra train` [default: 14336; 24576 with --mean map]
    #[arg(long, value_name = "BYTES|none", value_parser = budget)]
    pub(crate) budget: Option<BudgetArgument>,

    /// Seed of all randomness
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Results: scene_id,im_id,obj_id,score,R,t,time; R row-major, t in mm. The written file is the \
                  same with the score replaced by the confidence, from 0 to 1, so that bop_toolkit evaluates \
                  it as it is; -1 stands where an estimate could not be scored. Rows that are no estimates \
                  are left out.\n\nSimulated depth is rendered from all annotated objects of an image at their \
                  true poses; where no object is rendered the depth counts as measured and far.\n\nExit code 3 \
                  says that some rows could not be scored, or that the truth of some is there and cannot be \
                  used; the others were.\n\nExamples:\n  cobra bop score \
                  --dataset lmo --split test --results gdrnpp_lmo-test.csv --templates templates -o \
                  rescored.csv\n  cobra bop score --dataset lmo --split test --results gdrnpp_lmo-test.csv \
                  --templates templates --depth simulated --masks simulated -o rescored.csv --report \
                  report.json"
)]
pub(crate) struct BopScoreArguments {
    /// Folder of the data set
    #[arg(long, value_name = "DIR")]
    pub(crate) dataset: PathBuf,

    /// Which of its splits
    #[arg(long, default_value = "test")]
    pub(crate) split: String,

    /// Results file
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) results: PathBuf,

    /// Folder of templates, as cobra bop train writes them
    #[arg(long, value_name = "DIR")]
    pub(crate) templates: PathBuf,

    #[command(flatten)]
    pub(crate) sources: SourceArguments,

    /// Most pixels of a mask that are used, spread evenly
    #[arg(long, value_name = "N", default_value_t = ScoreOptions::PIXELS as u32, value_parser = clap::value_parser!(u32).range(10..=1_000_000))]
    pub(crate) pixels: u32,

    /// Results file to write
    #[arg(short, long, value_name = "RESCORED.csv")]
    pub(crate) output: PathBuf,

    /// Write what was found of every estimate as JSON, `-` for standard output
    #[arg(long, value_name = "FILE|-")]
    pub(crate) report: Option<PathBuf>,
}
