//! The arguments of `cobra`, with the help that goes with them.

use super::ambiguity::AmbiguityArguments;
use super::bop::BopArguments;
use super::calibrate::CalibrateArguments;
use super::choices::{
    AssignmentArgument, BudgetArgument, ExponentArgument, ExportFormat, KernelArgument,
    LikelihoodArgument, MeanArgument, MetricArgument, SamplingArgument, ThresholdArgument,
    UnitArgument, ValidityArgument, WeightsArgument, budget, identifier, not_negative, overlap,
    positive,
};
use super::experiment::ExperimentArguments;
use super::learning::{OptimiserArgument, PriorMeanArgument, SubsetArgument, subset};
use super::overlay::OverlayArguments;
use super::page::ReportArguments;
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use cobra_train::export::Identifier;
use cobra_train::train::Overlap;
use std::path::PathBuf;

/// Global options come after a command's own.
const LAST: usize = 900;

/// Trains shape templates and scores 6D object poses against them.
#[derive(Debug, Parser)]
#[command(
    name = "cobra",
    version,
    max_term_width = 100,
    after_help = "Exit codes: 0 success (also when poses are rejected), 1 a pose was not accepted \
                  and --fail-on-reject was given, 2 wrong usage, 3 bad input, 4 reading or \
                  writing failed.\n\nFirst steps:\n  cobra demo\n  cobra train part.ply -o \
                  part.cobra --unit mm\n  cobra score part.cobra --camera K.txt --poses \
                  poses.json --correspondences DIR"
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,

    /// Print results, warnings and errors only
    #[arg(short, long, global = true, conflicts_with = "verbose", display_order = LAST)]
    pub(crate) quiet: bool,

    /// Print details of what is done
    #[arg(short, long, global = true, display_order = LAST)]
    pub(crate) verbose: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Show the whole path on a part made by code: train, simulate, score, picture
    Demo(DemoArguments),
    /// Train a template from a mesh or a point cloud
    Train(TrainArguments),
    /// Score estimated poses: accept, reject or undecided
    Score(ScoreArguments),
    /// Measure how well a template reproduces a mesh or a point cloud
    Eval(EvalArguments),
    /// Compute the paper's tables and figures anew: CSV, SVG, and its own numbers beside
    Experiment(ExperimentArguments),
    /// Work with data sets and results files of the BOP benchmark
    Bop(BopArguments),
    /// Find wrong poses that score as well as the true one: symmetries, and what is nearly one
    Ambiguity(AmbiguityArguments),
    /// Find the thresholds for a false-accept rate on labelled estimates, and store them in a template
    Calibrate(CalibrateArguments),
    /// Draw estimated poses over their image: residuals, box, decision and reason, as a PNG
    Overlay(OverlayArguments),
    /// Make a page that says whether a template can be trusted: 3-D view, coverage, cost
    Report(ReportArguments),
    /// Show what is in a template, its size and its cost
    Inspect(InspectArguments),
    /// Write a template as a file, as Rust or as C, for firmware that keeps it in flash
    Export(ExportArguments),
    /// Print a completion script for a shell
    Completions {
        /// The shell
        shell: Shell,
    },
}

#[derive(Debug, Args)]
#[command(
    after_help = "Writes bracket.cobra, poses.csv and poses.png into the folder; lengths are in mm.\n\n\
                        Example:\n  cobra demo -o demo-output"
)]
pub(crate) struct DemoArguments {
    /// Folder for the template, the table and the picture; made if missing
    #[arg(short, long, value_name = "DIR", default_value = "demo-output")]
    pub(crate) output: PathBuf,

    /// How many pose estimates to simulate
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(10..=10_000))]
    pub(crate) poses: u32,

    /// Seed of all randomness
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,
}

#[derive(Debug, Args)]
#[command(
    after_help = "By default the mesh is sampled as cameras see it from outside; it need not be \
                  closed.\n\n\
                  Examples:\n  cobra train part.ply -o part.cobra\n  cobra train chair.glb -o \
                  chair.cobra\n  cobra train part.stl -o \
                  part.cobra --unit m --budget 8704 --json -\n  cobra train part.obj -o \
                  part.cobra --reference-points centres.txt\n  cobra train part.ply -o part.cobra \
                  --reference-points em --components 24 --sampling poisson"
)]
pub(crate) struct TrainArguments {
    /// Mesh or point cloud: .ply, .obj, .stl, .off, .glb, .gltf or .xyz
    pub(crate) mesh: PathBuf,

    /// Template file to write
    #[arg(short, long, value_name = "FILE.cobra")]
    pub(crate) output: PathBuf,

    /// Training points
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) points: u32,

    /// Test points, which sigma-hat is measured on
    #[arg(long, value_name = "N", default_value_t = 30_000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) test_points: u32,

    /// How training points are drawn; test points are always what cameras see
    #[arg(long, value_enum, default_value_t = SamplingArgument::Cameras)]
    pub(crate) sampling: SamplingArgument,

    /// `auto` (as many as the surface asks for, inside and outside of it), `kmeans`, `em` (a mixture
    /// of Gaussians), or a text file with x y z a line in the mesh's frame and unit
    #[arg(long, value_name = "auto|kmeans|em|FILE", default_value = "auto")]
    pub(crate) reference_points: PathBuf,

    /// Most components that `auto` may choose [default: 64]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub(crate) max_components: Option<u32>,

    /// What the template says the mean by: the Gaussian process's terms, or a map over the directions
    /// that is baked from it
    #[arg(long, value_enum, default_value_t = MeanArgument::Gp)]
    pub(crate) mean: MeanArgument,

    /// Most bytes that the template may have: its terms are compressed into them, or its maps are as
    /// fine as they allow. none: the exact Gaussian process, or the finest maps [default: 14336; none
    /// with --metric angles; 24576 with --mean map]
    #[arg(long, value_name = "BYTES|none", value_parser = budget)]
    pub(crate) budget: Option<BudgetArgument>,

    /// Where components may speak: where what they predict lies beside their own points, or
    /// everywhere, as in the paper
    #[arg(long, value_enum, default_value_t = ValidityArgument::Verified)]
    pub(crate) validity: ValidityArgument,

    /// Components (reference points) of kmeans and em; with a file, the number of its lines
    /// [default: 16]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub(crate) components: Option<u32>,

    /// Train each component on all points within (1 + SHARE) times its own points' largest distance
    /// from its reference point, as the authors do; none: on its own points
    #[arg(long, value_name = "none|SHARE", default_value = "none", value_parser = overlap, allow_hyphen_values = true)]
    pub(crate) overlap: Overlap,

    /// Covariance function: rational quadratic, radial basis function, Matern of smoothness 1/2,
    /// 3/2 or 5/2, linear, polynomial of degree 3, periodic
    #[arg(long, value_enum, default_value_t = KernelArgument::Rq)]
    pub(crate) kernel: KernelArgument,

    /// Exponent of the rational quadratic [default: 0.5]; scoring with 0.5 takes about 1.6 times
    /// as long as with 1, with a free exponent about 80 times
    #[arg(long, value_name = "ALPHA", value_enum)]
    pub(crate) exponent: Option<ExponentArgument>,

    /// Distance between directions: the chord between unit vectors, or that of the angles (phi,
    /// theta) as the paper prints it, which has a seam and poles
    #[arg(long, value_enum, default_value_t = MetricArgument::Chord)]
    pub(crate) metric: MetricArgument,

    /// How hyperparameters are learned: L-BFGS-B, or the paper's Adam (rate 0.1, 250 iterations, on
    /// all points, noise variance at least 1e-4)
    #[arg(long, value_enum, default_value_t = OptimiserArgument::Lbfgs)]
    pub(crate) optimiser: OptimiserArgument,

    /// Points of a component that hyperparameters are learned on [default: 300; all with adam]
    #[arg(long, value_name = "N|all", value_parser = subset)]
    pub(crate) subset: Option<SubsetArgument>,

    /// Distance far from all points: the component's average, or the paper's 0
    #[arg(long, value_enum, default_value_t = PriorMeanArgument::Average)]
    pub(crate) prior_mean: PriorMeanArgument,

    /// Unit that the file's numbers are in [default: mm, for glTF m]
    #[arg(long, value_enum)]
    pub(crate) unit: Option<UnitArgument>,

    /// Move and scale the object into the unit sphere before training, and print centre and scale;
    /// --unit and reference points are then those of the scaled object
    #[arg(long)]
    pub(crate) unit_sphere: bool,

    /// Object's name in the template, at most 32 bytes [default: the mesh file's name]
    #[arg(long)]
    pub(crate) name: Option<String>,

    /// Seed of all randomness
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,

    /// Measure on fresh points how many residuals lie within z sigma, for the Gaussian process's
    /// own sigma and for sigma-hat
    #[arg(long)]
    pub(crate) coverage: bool,

    /// Write what training found as JSON, `-` for standard output
    #[arg(long, value_name = "FILE|-")]
    pub(crate) json: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(
    override_usage = "cobra score <FILE.cobra> --camera <FILE> --poses <POSES.json> \
                      --correspondences <DIR|FILE>... [OPTIONS]",
    after_help = "Poses: {\"ID\": [{\"cam_R_m2c\": [9], \"cam_t_m2c\": [3]}], ...}, R row-major, \
                  object to camera.\nCorrespondences: CSV with columns x,y (pixels, pixel centres \
                  at integers), X,Y,Z (object frame), and inlier and conf where asked for; a \
                  folder holds ID_corr.txt or ID.csv for each pose.\nCamera: a 3x3 matrix as text, or \
                  BOP's camera.json or scene_camera.json; lens distortion must be removed \
                  first.\nPoses and points are in the template's \
                  unit; --sigma-hat, --noise and --delta are in millimetres.\n\nExamples:\n  cobra \
                  score part.cobra --camera K.txt --poses est_poses.json --correspondences \
                  correspondences\n  cobra score part.cobra --camera K.txt --poses est_poses.json \
                  --correspondences 61_corr.txt --noise 1.5 --delta 3 --json -"
)]
pub(crate) struct ScoreArguments {
    /// Template file
    #[arg(value_name = "FILE.cobra")]
    pub(crate) template: PathBuf,

    /// Camera matrix K: three rows of three numbers, pixels; or BOP's camera.json or
    /// scene_camera.json
    #[arg(long, value_name = "K.txt|CAMERA.json")]
    pub(crate) camera: PathBuf,

    /// Estimated poses
    #[arg(long, value_name = "POSES.json")]
    pub(crate) poses: PathBuf,

    /// A folder, or files named after their pose
    #[arg(long, value_name = "DIR|FILE", num_args = 1.., required = true)]
    pub(crate) correspondences: Vec<PathBuf>,

    /// Standard deviation of the residuals in mm, in place of the template's and of --noise
    #[arg(long, value_name = "MM", value_parser = positive)]
    pub(crate) sigma_hat: Option<f32>,

    /// Standard deviation of the measurement in mm, added to the template's in quadrature
    #[arg(long, value_name = "MM", value_parser = not_negative::<f32>, default_value_t = 0.0)]
    pub(crate) noise: f32,

    /// Tolerance in mm that the threshold stands for [default: 1 % of the object's diameter]
    #[arg(long, value_name = "MM", value_parser = positive)]
    pub(crate) delta: Option<f32>,

    /// What the threshold promises: the paper's Eq. 11, a lower bound of mean; the average
    /// confidence of poses whose residuals spread evenly in +-delta; or the least of a pose all of
    /// whose residuals are within delta
    #[arg(long, value_enum, default_value_t = ThresholdArgument::Paper)]
    pub(crate) threshold: ThresholdArgument,

    /// What a correspondence weighs: all the same, or the column conf
    #[arg(long, value_enum, default_value_t = WeightsArgument::Uniform)]
    pub(crate) weights: WeightsArgument,

    /// Use only rows whose column inlier is not 0
    #[arg(long)]
    pub(crate) inliers_only: bool,

    /// peak: exp(-e²/2σ²), between 0 and 1; density: the Gaussian density, in 1/length
    #[arg(long, value_enum, default_value_t = LikelihoodArgument::Peak)]
    pub(crate) likelihood: LikelihoodArgument,

    /// Which component speaks for a point: the nearest; the one that finds it most probable (max);
    /// or all of them, mixed as in the paper's Eqs. 6 to 8 (soft). Of those that may speak for it
    /// [default: max; nearest where the template lets all speak everywhere]
    #[arg(long, value_enum)]
    pub(crate) assignment: Option<AssignmentArgument>,

    /// Undecided with fewer correspondences than this
    #[arg(long, value_name = "N", default_value_t = cobra_infer::Settings::MINIMUM_POINTS)]
    pub(crate) min_points: u32,

    /// Exit with code 1 when a pose is not accepted
    #[arg(long)]
    pub(crate) fail_on_reject: bool,

    /// Write the scores as JSON, `-` for standard output
    #[arg(long, value_name = "FILE|-")]
    pub(crate) json: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Chamfer distance (times 1000), precision, recall and F-score (percent, tau = \
                  0.01) are the paper's, in the unit sphere. The component is the one that the \
                  scorer would use on the test point, which it chooses by the point's distance: read \
                  F together with wrongly accepted, the percent of points truly 0.02 to 0.05 off the \
                  surface whose residual is below tau, and with self F, the F-score of the \
                  template's own points. In JSON, residual is in the unit sphere and residual_mm in \
                  millimetres.\n\nExample:\n  cobra eval part.cobra --mesh \
                  part.ply --points-out predicted.ply"
)]
pub(crate) struct EvalArguments {
    /// Template file
    #[arg(value_name = "FILE.cobra")]
    pub(crate) template: PathBuf,

    /// The mesh or point cloud it was trained from
    #[arg(long, value_name = "MESH")]
    pub(crate) mesh: PathBuf,

    /// Move and scale the mesh into the unit sphere first, as for a template that was trained so
    #[arg(long)]
    pub(crate) unit_sphere: bool,

    /// Test points, drawn independently of the training's
    #[arg(long, value_name = "N", default_value_t = 30_000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) points: u32,

    /// Which component speaks for a point; the other rules' figures are given beside [default: the
    /// scorer's, as of cobra score]
    #[arg(long, value_enum)]
    pub(crate) assignment: Option<AssignmentArgument>,

    /// Seed of the test points
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,

    /// Write the predicted points with their residuals and components as a PLY file
    #[arg(long, value_name = "FILE.ply")]
    pub(crate) points_out: Option<PathBuf>,

    /// Write the figures as JSON, `-` for standard output
    #[arg(long, value_name = "FILE|-")]
    pub(crate) json: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Lengths are in the template's unit.\n\nExample:\n  cobra inspect part.cobra"
)]
pub(crate) struct InspectArguments {
    /// Template file
    #[arg(value_name = "FILE.cobra")]
    pub(crate) template: PathBuf,

    /// Write the content as JSON, `-` for standard output
    #[arg(long, value_name = "FILE|-")]
    pub(crate) json: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(
    after_help = "The template is checked first. Bytes behind it are left out, whatever the format: \
                  the file may be a dump of flash that starts with the template. Numbers stay in \
                  the template's unit.\n\n\
                  The Rust file is a module or goes into include!, and needs no std. The C header \
                  goes into one source file, as C99, C11 or C++. Both are aligned to four \
                  bytes.\n\n\
                  Examples:\n  cobra export part.cobra --format rust -o part.rs\n  cobra export \
                  part.cobra --format c --name part -o part.h\n  cobra export flash.bin --format \
                  bin -o part.cobra"
)]
pub(crate) struct ExportArguments {
    /// Template file, or a file that starts with a template
    #[arg(value_name = "FILE.cobra")]
    pub(crate) template: PathBuf,

    /// What to write
    #[arg(long, value_enum)]
    pub(crate) format: ExportFormat,

    /// File to write, `-` for standard output [default: standard output; for bin not a terminal]
    #[arg(short, long, value_name = "FILE|-")]
    pub(crate) output: Option<PathBuf>,

    /// Name in the source, in capitals where the language has them so [default: the object's name
    /// with _template behind]
    #[arg(long, value_parser = identifier)]
    pub(crate) name: Option<Identifier>,
}
