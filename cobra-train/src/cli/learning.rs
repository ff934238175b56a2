//! What `cobra train` is told and tells of learning: its arguments, why searches stopped.

use super::args::TrainArguments;
use super::terminal::Terminal;
use clap::ValueEnum;
use cobra_train::gp::{
    AdamOptions, FitOptions, LARGEST_GP, NOISE_FLOOR, Optimiser, PAPER_NOISE_FLOOR, PriorMean,
    StopReason, Subset,
};
use cobra_train::train::{ReferencePoints, TrainOptions, TrainedComponent};
use std::collections::BTreeMap;

/// Learning on all of more points than this a component takes minutes each.
const PATIENT: usize = 2000;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum OptimiserArgument {
    Lbfgs,
    Adam,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SubsetArgument {
    Points(usize),
    All,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum PriorMeanArgument {
    Average,
    Zero,
}

impl From<PriorMeanArgument> for PriorMean {
    fn from(prior_mean: PriorMeanArgument) -> Self {
        match prior_mean {
            PriorMeanArgument::Average => PriorMean::Average,
            PriorMeanArgument::Zero => PriorMean::Zero,
        }
    }
}

/// What `--subset` takes.
pub(super) fn subset(text: &str) -> Result<SubsetArgument, String> {
    if text == "all" {
        return Ok(SubsetArgument::All);
    }
    match text.parse::<usize>() {
        Ok(count) if (1..=LARGEST_GP).contains(&count) => Ok(SubsetArgument::Points(count)),
        _ => Err(format!(
            "expected a number from 1 to {LARGEST_GP}, or `all`"
        )),
    }
}

/// Sets what the arguments say of learning.
pub(super) fn choose(arguments: &TrainArguments, fit: &mut FitOptions) {
    (fit.optimiser, fit.noise_floor) = match arguments.optimiser {
        OptimiserArgument::Lbfgs => (Optimiser::Lbfgs, NOISE_FLOOR),
        OptimiserArgument::Adam => (Optimiser::Adam(AdamOptions::paper()), PAPER_NOISE_FLOOR),
    };
    fit.subset = match (arguments.subset, arguments.optimiser) {
        (Some(SubsetArgument::Points(count)), _) => Subset::Points(count),
        (Some(SubsetArgument::All), _) | (None, OptimiserArgument::Adam) => Subset::All,
        (None, OptimiserArgument::Lbfgs) => fit.subset,
    };
    fit.prior_mean = arguments.prior_mean.into();
}

/// Says that learning will take long, where it will.
pub(super) fn warn_of_patience(options: &TrainOptions, terminal: &Terminal) {
    let components = match &options.reference_points {
        // As few as that are rare.
        ReferencePoints::Auto { .. } => 8,
        ReferencePoints::KMeans { components } | ReferencePoints::Em { components } => *components,
        ReferencePoints::Given(given) => given.len(),
    };
    let each = options.points / components.max(1);
    if options.fit.subset == Subset::All && each > PATIENT {
        terminal.say(&format!(
            "note: learning on all of some {each} points a component takes long, time growing with \
             the cube of their number; --subset {PATIENT} takes fewer"
        ));
    }
}

/// Tells each component's search to whoever asked for details, and everybody of early ends.
pub(super) fn tell(components: &[TrainedComponent], limit: u64, terminal: &Terminal) {
    for (index, component) in components.iter().enumerate() {
        let learned = &component.fitted.learned;
        terminal.detail(&format!(
            "component {index}: {} iterations, {:.4} per point, {}",
            learned.iterations, learned.likelihood_per_point, learned.stop
        ));
    }
    let stops = components.iter().map(|c| c.fitted.learned.stop);
    if let Some(note) = early_ends(stops, components.len(), limit) {
        terminal.say(&note);
    }
}

fn early_ends(
    stops: impl Iterator<Item = StopReason>,
    components: usize,
    limit: u64,
) -> Option<String> {
    let mut early = BTreeMap::<StopReason, usize>::new();
    for stop in stops.filter(|stop| stop.is_early()) {
        *early.entry(stop).or_default() += 1;
    }
    let total: usize = early.values().sum();
    if total == 0 {
        return None;
    }
    let alone = early.len() == 1;
    let reasons: Vec<String> = early
        .into_iter()
        .map(|(stop, count)| {
            let detail = match stop {
                StopReason::IterationLimit => format!("{stop} ({limit})"),
                _ => stop.to_string(),
            };
            if alone {
                detail
            } else {
                format!("{count} {detail}")
            }
        })
        .collect();
    Some(format!(
        "note: {total} of {components} components stopped early: {}",
        reasons.join(", ")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn converged_searches_are_not_noted() {
        let stops = [StopReason::GradientSmall, StopReason::RateExhausted];
        assert_eq!(early_ends(stops.into_iter(), 2, 250), None);
    }

    #[test]
    fn early_ends_are_counted_by_their_reason() {
        let limit = StopReason::IterationLimit;
        assert_eq!(
            early_ends([limit, limit].into_iter(), 16, 250).unwrap(),
            "note: 2 of 16 components stopped early: iteration limit (250)"
        );
        let stops = [StopReason::LineSearchStalled, limit, limit];
        assert_eq!(
            early_ends(stops.into_iter(), 16, 60).unwrap(),
            "note: 3 of 16 components stopped early: 2 iteration limit (60), 1 the line search \
             found no better point"
        );
    }
}
