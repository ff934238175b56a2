//! The arguments of `cobra overlay`.

use super::super::choices::positive;
use super::super::sources::SourceArguments;
use clap::Args;
use std::path::PathBuf;

/// Options of an image of a data set, which conflict with the template of the other kind. A `requires` in each of
/// them would not do: clap passes over it where what is required conflicts with something that is there.
const OF_DATA_SET: [&str; 13] = [
    "dataset",
    "split",
    "scene",
    "image",
    "templates",
    "results",
    "row",
    "object",
    "truth",
    "masks",
    "depth",
    "depth_noise",
    "seed",
];

/// Options of an image in files of its own, which conflict with a data set.
const OF_FILES: [&str; 6] = [
    "depth_image",
    "depth_scale",
    "photo",
    "camera",
    "pose",
    "mask",
];

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
        conflicts_with_all = OF_DATA_SET
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
    #[arg(
        long,
        value_name = "DIR",
        requires = "templates",
        conflicts_with_all = OF_FILES
    )]
    pub(crate) dataset: Option<PathBuf>,

    /// Its split
    #[arg(long, value_name = "NAME", default_value = "test")]
    pub(crate) split: String,

    /// Scene [default: that of --row]
    #[arg(long, value_name = "N", requires = "image")]
    pub(crate) scene: Option<u32>,

    /// Image [default: that of --row]
    #[arg(long, value_name = "N", requires = "scene")]
    pub(crate) image: Option<u32>,

    /// Folder of templates: obj_000001.cobra and so on
    #[arg(long, value_name = "DIR")]
    pub(crate) templates: Option<PathBuf>,

    /// Estimates: all of the image, unless --row or --object says which
    #[arg(long, value_name = "FILE.csv", conflicts_with = "truth")]
    pub(crate) results: Option<PathBuf>,

    /// The estimate on this line of the results file, the header being line 1
    #[arg(
        long,
        value_name = "LINE",
        requires = "results",
        conflicts_with_all = ["object", "truth"]
    )]
    pub(crate) row: Option<u64>,

    /// The estimates of this object
    #[arg(long, value_name = "ID")]
    pub(crate) object: Option<u32>,

    /// The true poses instead of estimates
    #[arg(long)]
    pub(crate) truth: bool,

    #[command(flatten)]
    pub(crate) sources: SourceArguments,
}

/// An image in files of their own.
#[derive(Debug, Args)]
#[command(next_help_heading = "An image in files of their own")]
pub(crate) struct FileArguments {
    /// What the depth camera measured: 16-bit grey PNG
    #[arg(long, value_name = "DEPTH.png", required_unless_present = "dataset")]
    pub(crate) depth_image: Option<PathBuf>,

    /// What its values are multiplied with to become mm [default: the camera file's, else 1]
    #[arg(long, value_name = "S", value_parser = positive)]
    pub(crate) depth_scale: Option<f32>,

    /// Photograph of the same size as the depth image [default: the depth image in grey]
    #[arg(long, value_name = "RGB.png")]
    pub(crate) photo: Option<PathBuf>,

    /// Camera matrix K as text, or BOP's camera.json
    #[arg(
        long,
        value_name = "K.txt|CAMERA.json",
        required_unless_present = "dataset"
    )]
    pub(crate) camera: Option<PathBuf>,

    /// Poses, as of cobra score; all are drawn
    #[arg(long, value_name = "POSE.json", required_unless_present = "dataset")]
    pub(crate) pose: Option<PathBuf>,

    /// The pixels that show the object are not 0: 8-bit grey PNG [default: each pose's own silhouette]
    #[arg(long, value_name = "MASK.png")]
    pub(crate) mask: Option<PathBuf>,
}
