//! What the command's options choose among, and how their numbers are read.

use clap::ValueEnum;
use cobra_infer::{
    Assignment, Exponent, Kernel, Likelihood, Metric, Settings, Smoothness, Template, Threshold,
    Unit,
};
use cobra_train::export::Identifier;
use cobra_train::input::Weighting;
use cobra_train::train::{MeanForm, Overlap, SurfaceSampling, Validity};
use std::str::FromStr;

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum UnitArgument {
    Mm,
    Cm,
    M,
    Inch,
}

impl From<UnitArgument> for Unit {
    fn from(unit: UnitArgument) -> Self {
        match unit {
            UnitArgument::Mm => Unit::Millimetre,
            UnitArgument::Cm => Unit::Centimetre,
            UnitArgument::M => Unit::Metre,
            UnitArgument::Inch => Unit::Inch,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum KernelArgument {
    Rq,
    Rbf,
    Matern12,
    Matern32,
    Matern52,
    Linear,
    Polynomial,
    Periodic,
}

impl KernelArgument {
    pub(crate) fn with_exponent(self, exponent: Exponent) -> Kernel {
        match self {
            KernelArgument::Rq => Kernel::RationalQuadratic(exponent),
            KernelArgument::Rbf => Kernel::RadialBasis,
            KernelArgument::Matern12 => Kernel::Matern(Smoothness::Half),
            KernelArgument::Matern32 => Kernel::Matern(Smoothness::ThreeHalves),
            KernelArgument::Matern52 => Kernel::Matern(Smoothness::FiveHalves),
            KernelArgument::Linear => Kernel::Linear,
            KernelArgument::Polynomial => Kernel::Polynomial,
            KernelArgument::Periodic => Kernel::Periodic,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum MetricArgument {
    Chord,
    Angles,
}

impl From<MetricArgument> for Metric {
    fn from(metric: MetricArgument) -> Self {
        match metric {
            MetricArgument::Chord => Metric::Chord,
            MetricArgument::Angles => Metric::Angles,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum SamplingArgument {
    /// What cameras around the object see
    Cameras,
    /// Evenly spread on all faces, also on those that no camera sees
    Poisson,
    /// What rays from the reference points hit first
    ReferencePoints,
}

impl From<SamplingArgument> for SurfaceSampling {
    fn from(sampling: SamplingArgument) -> Self {
        match sampling {
            SamplingArgument::Cameras => SurfaceSampling::Cameras,
            SamplingArgument::Poisson => SurfaceSampling::Poisson,
            SamplingArgument::ReferencePoints => SurfaceSampling::ReferencePoints,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ValidityArgument {
    /// Where what they predict lies beside their own points
    Verified,
    /// Everywhere
    Everywhere,
}

impl From<ValidityArgument> for Validity {
    fn from(validity: ValidityArgument) -> Self {
        match validity {
            ValidityArgument::Verified => Validity::Verified,
            ValidityArgument::Everywhere => Validity::Everywhere,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum MeanArgument {
    /// The Gaussian process's terms
    Gp,
    /// A map over the directions: the same cost for every point
    Map,
}

impl From<MeanArgument> for MeanForm {
    fn from(mean: MeanArgument) -> Self {
        match mean {
            MeanArgument::Gp => MeanForm::Process,
            MeanArgument::Map => MeanForm::Map,
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum BudgetArgument {
    Bytes(usize),
    None,
}

pub(super) fn budget(text: &str) -> Result<BudgetArgument, String> {
    match text.parse::<usize>() {
        _ if text == "none" => Ok(BudgetArgument::None),
        Ok(bytes) if bytes > 0 => Ok(BudgetArgument::Bytes(bytes)),
        _ => Err("expected `none` or a number of bytes, such as 14336".to_owned()),
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ExponentArgument {
    #[value(name = "1")]
    One,
    #[value(name = "0.5")]
    Half,
    Free,
}

impl From<ExponentArgument> for Exponent {
    fn from(exponent: ExponentArgument) -> Self {
        match exponent {
            ExponentArgument::One => Exponent::One,
            ExponentArgument::Half => Exponent::Half,
            ExponentArgument::Free => Exponent::Free,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum WeightsArgument {
    Uniform,
    Conf,
}

impl From<WeightsArgument> for Weighting {
    fn from(weights: WeightsArgument) -> Self {
        match weights {
            WeightsArgument::Uniform => Weighting::Uniform,
            WeightsArgument::Conf => Weighting::Confidence,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum LikelihoodArgument {
    Peak,
    Density,
}

impl From<LikelihoodArgument> for Likelihood {
    fn from(likelihood: LikelihoodArgument) -> Self {
        match likelihood {
            LikelihoodArgument::Peak => Likelihood::Peak,
            LikelihoodArgument::Density => Likelihood::Density,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ThresholdArgument {
    Paper,
    Mean,
    Worst,
}

impl From<ThresholdArgument> for Threshold {
    fn from(threshold: ThresholdArgument) -> Self {
        match threshold {
            ThresholdArgument::Paper => Threshold::Paper,
            ThresholdArgument::Mean => Threshold::Mean,
            ThresholdArgument::Worst => Threshold::Worst,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum AssignmentArgument {
    Nearest,
    Max,
    Soft,
}

/// What the user asks for, or what suits the template ([`Settings::for_template`]).
pub(super) fn assignment(
    chosen: Option<AssignmentArgument>,
    template: &Template<'_>,
) -> Assignment {
    chosen.map_or_else(
        || Settings::for_template(template, 1.0).assignment,
        Assignment::from,
    )
}

impl From<AssignmentArgument> for Assignment {
    fn from(assignment: AssignmentArgument) -> Self {
        match assignment {
            AssignmentArgument::Nearest => Assignment::Nearest,
            AssignmentArgument::Max => Assignment::Maximum,
            AssignmentArgument::Soft => Assignment::Soft,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExportFormat {
    /// The template's bytes alone, checked
    Bin,
    /// A constant, `pub const PART_TEMPLATE: &[u8; N]`
    Rust,
    /// A header with an array, `static const uint8_t part_template[N]`, and `PART_TEMPLATE_SIZE`
    C,
}

pub(super) fn identifier(text: &str) -> Result<Identifier, String> {
    Identifier::new(text).map_err(|error| error.to_string())
}

pub(super) fn overlap(text: &str) -> Result<Overlap, String> {
    match text.parse::<f64>() {
        _ if text == "none" => Ok(Overlap::None),
        Ok(share) if share.is_finite() && share >= 0.0 => Ok(Overlap::Ball { share }),
        _ => Err("expected `none` or a number of at least 0, such as 0.05".to_owned()),
    }
}

pub(super) fn positive(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("expected a number greater than 0, in millimetres".to_owned()),
    }
}

pub(super) fn not_negative<T: FromStr + Copy + Into<f64>>(text: &str) -> Result<T, String> {
    match text.parse::<T>() {
        Ok(value) if value.into().is_finite() && value.into() >= 0.0 => Ok(value),
        _ => Err("expected a number of at least 0, in millimetres".to_owned()),
    }
}
