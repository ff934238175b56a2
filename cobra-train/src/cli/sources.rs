//! Where depth and masks of a data set's images come from: what `cobra bop score` and `cobra overlay` are told
//! alike.

use super::choices::not_negative;
use super::failure::Failure;
use clap::{Args, ValueEnum};
use cobra_train::bop::dataset::Dataset;
use cobra_train::bop::render::DepthNoise;
use cobra_train::bop::score::{DepthSource, Masks};

#[derive(Debug, Args)]
pub(crate) struct SourceArguments {
    /// Which pixels show the object: masks in a folder (SSSSSS/mask_visib/IIIIII_GGGGGG.png), those of
    /// the rendering of the true poses, or those in which the estimate itself says that it is seen
    /// [default: the data set's mask_visib where there is one, else silhouette]
    #[arg(long, value_name = "DIR|simulated|silhouette", value_parser = masks)]
    masks: Option<Masks>,

    /// Where depth comes from
    #[arg(long, value_enum, default_value_t = DepthArgument::Sensor)]
    depth: DepthArgument,

    /// Standard deviation of the noise on simulated depth, in mm [default: 1.5]
    #[arg(long, value_name = "MM", value_parser = not_negative::<f64>)]
    depth_noise: Option<f64>,

    /// Seed of that noise
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum DepthArgument {
    /// The data set's depth images
    Sensor,
    /// Rendered from the true poses of all annotated objects, with noise
    Simulated,
}

impl SourceArguments {
    /// Where depth comes from. Measured depth has its own noise, and none is added.
    pub(super) fn depth(&self) -> Result<DepthSource, Failure> {
        match (self.depth, self.depth_noise) {
            (DepthArgument::Sensor, Some(_)) => Err(Failure::Usage(
                "--depth-noise goes with --depth simulated: measured depth has its own".to_owned(),
            )),
            (DepthArgument::Sensor, None) => Ok(DepthSource::Sensor),
            (DepthArgument::Simulated, noise) => Ok(DepthSource::Simulated {
                noise: noise.unwrap_or(DepthNoise::MILLIMETRES),
            }),
        }
    }

    /// Refuses a folder of masks that is none.
    pub(super) fn check_masks(&self) -> Result<(), Failure> {
        match &self.masks {
            Some(Masks::Folder(folder)) if !folder.is_dir() => Err(Failure::Usage(format!(
                "--masks: expected simulated, silhouette or a folder, found {}, which is none",
                folder.display()
            ))),
            _ => Ok(()),
        }
    }

    /// The masks that were asked for, else the data set's own where this scene has some.
    pub(super) fn masks(&self, dataset: &Dataset, scene: Option<u32>) -> Masks {
        match &self.masks {
            Some(masks) => masks.clone(),
            None if scene.is_some_and(|scene| dataset.has_masks(scene)) => {
                Masks::Folder(dataset.split().to_owned())
            }
            None => Masks::Silhouette,
        }
    }
}

fn masks(text: &str) -> Result<Masks, String> {
    Ok(match text {
        "simulated" => Masks::Simulated,
        "silhouette" => Masks::Silhouette,
        folder => Masks::Folder(folder.into()),
    })
}
