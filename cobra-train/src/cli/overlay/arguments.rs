//! The arguments of `cobra overlay`.

use super::super::choices::positive;
use clap::{Args, ValueEnum};
use cobra_train::bop::score::Masks;
use std::path::PathBuf;

/// Where depth comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DepthArgument {
    /// The data set's depth images
    Sensor,
    /// All annotated objects rendered at their true poses, with noise
    Simulated,
}

#[derive(Debug, Args)]
#[command(
    override_usage = "cobra overlay --dataset <DIR> --templates <DIR> (--results <FILE.csv> | --truth) -o <OUT.png> [OPTIONS]\n       \
                      cobra overlay <FILE.cobra> --depth-image <DEPTH.png> --camera <FILE> --pose <POSE.json> -o <OUT.png> [OPTIONS]",
    after_help = "Colours are residuals: blue where something was seen in front of where the pose puts \
                  the object, red where it was seen behind it, strongest from two standard deviations \
                  sigma_m on (of several objects, the least). Surface that something nearer hides, that \
                  the camera sees through and that was not measured has patterns of its own. One \
                  estimate is shown closely, several in one image.\n\nExamples:\n  cobra overlay --dataset \
                  lmo --scene 2 --image 3 --templates templates --results estimates.csv -o all.png\n  \
                  cobra overlay --dataset lmo --templates templates --results estimates.csv --row 5 -o \
                  row5.png\n  cobra overlay part.cobra --photo rgb.png --depth-image depth.png \
                  --depth-scale 0.1 --camera K.txt --pose pose.json -o part.png --residuals part.csv"
)]
pub(crate) struct OverlayArguments {
    /// Template file, where the image is not of a data set
    #[arg(
        value_name = "FILE.cobra",
        required_unless_present = "dataset",
        conflicts_with = "dataset"
    )]
    pub(crate) template: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) bop: BopArguments,

    #[command(flatten)]
    pub(crate) files: FileArguments,

    /// Residual in mm at which colours are strongest [default: 2 sigma_m]
    #[arg(long, value_name = "MM", value_parser = positive)]
    pub(crate) limit: Option<f32>,

    /// Write the residuals of the one estimate, pixel by pixel and point by point of its surface
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) residuals: Option<PathBuf>,

    /// Picture to write
    #[arg(short, long, value_name = "OUT.png")]
    pub(crate) output: PathBuf,
}

/// An image of a BOP data set.
#[derive(Debug, Args)]
#[command(next_help_heading = "An image of a BOP data set")]
pub(crate) struct BopArguments {
    /// Data set in BOP's layout
    #[arg(long, value_name = "DIR", requires = "templates")]
    pub(crate) dataset: Option<PathBuf>,

    /// Its split
    #[arg(
        long,
        value_name = "NAME",
        default_value = "test",
        requires = "dataset"
    )]
    pub(crate) split: String,

    /// Scene [default: that of --row]
    #[arg(long, value_name = "N", requires_all = ["dataset", "image"])]
    pub(crate) scene: Option<u32>,

    /// Image [default: that of --row]
    #[arg(long, value_name = "N", requires_all = ["dataset", "scene"])]
    pub(crate) image: Option<u32>,

    /// Folder of templates: obj_000001.cobra and so on
    #[arg(long, value_name = "DIR", requires = "dataset")]
    pub(crate) templates: Option<PathBuf>,

    /// Estimates: all of the image, unless --row or --object says which
    #[arg(
        long,
        value_name = "FILE.csv",
        requires = "dataset",
        conflicts_with = "truth"
    )]
    pub(crate) results: Option<PathBuf>,

    /// The estimate on this line of the results file, the header being line 1
    #[arg(
        long,
        value_name = "LINE",
        requires = "results",
        conflicts_with = "object"
    )]
    pub(crate) row: Option<u64>,

    /// The estimates of this object
    #[arg(long, value_name = "ID", requires = "dataset")]
    pub(crate) object: Option<u32>,

    /// The true poses instead of estimates
    #[arg(long, requires = "dataset")]
    pub(crate) truth: bool,

    /// Where depth comes from
    #[arg(long, value_enum, default_value_t = DepthArgument::Sensor, requires = "dataset")]
    pub(crate) depth: DepthArgument,

    /// Standard deviation of the noise of simulated depth in mm
    #[arg(long, value_name = "MM", default_value_t = 1.5, value_parser = not_negative, requires = "dataset")]
    pub(crate) depth_noise: f64,

    /// Seed of that noise
    #[arg(long, default_value_t = 0, requires = "dataset")]
    pub(crate) seed: u64,

    /// Which pixels show an object: masks in a folder, those of a rendering of the true poses, or the
    /// estimate's own silhouette [default: the split's masks where it has some, else silhouette]
    #[arg(long, value_name = "DIR|simulated|silhouette", value_parser = masks, requires = "dataset")]
    pub(crate) masks: Option<Masks>,
}

/// An image in files of their own.
#[derive(Debug, Args)]
#[command(next_help_heading = "An image in files of their own")]
pub(crate) struct FileArguments {
    /// What the depth camera measured: 16-bit grey PNG
    #[arg(
        long,
        value_name = "DEPTH.png",
        requires = "template",
        required_unless_present = "dataset"
    )]
    pub(crate) depth_image: Option<PathBuf>,

    /// What its values are multiplied with to become mm [default: the camera file's, else 1]
    #[arg(long, value_name = "S", value_parser = positive, requires = "template")]
    pub(crate) depth_scale: Option<f32>,

    /// Photograph of the same size as the depth image [default: the depth image in grey]
    #[arg(long, value_name = "RGB.png", requires = "template")]
    pub(crate) photo: Option<PathBuf>,

    /// Camera matrix K as text, or BOP's camera.json
    #[arg(
        long,
        value_name = "K.txt|CAMERA.json",
        requires = "template",
        required_unless_present = "dataset"
    )]
    pub(crate) camera: Option<PathBuf>,

    /// Poses, as of cobra score; all are drawn
    #[arg(
        long,
        value_name = "POSE.json",
        requires = "template",
        required_unless_present = "dataset"
    )]
    pub(crate) pose: Option<PathBuf>,

    /// The pixels that show the object are not 0: 8-bit grey PNG [default: each pose's own silhouette]
    #[arg(long, value_name = "MASK.png", requires = "template")]
    pub(crate) mask: Option<PathBuf>,
}

fn masks(text: &str) -> Result<Masks, String> {
    Ok(match text {
        "simulated" => Masks::Simulated,
        "silhouette" => Masks::Silhouette,
        folder => Masks::Folder(folder.into()),
    })
}

fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number >= 0.0 && number.is_finite() => Ok(number),
        _ => Err("expected a number of at least 0".to_owned()),
    }
}
