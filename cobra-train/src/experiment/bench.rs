//! What an experiment works with, and how its units are run.

use super::error::ExperimentError;
use super::journal::{Heading, Journal};
use super::subject::{Data, Subject};
use super::{Experiment, PROTOCOL};
use crate::progress::Progress;
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Mutex;

/// What an experiment works with.
pub struct Bench<'a> {
    /// The objects.
    pub data: &'a Data,
    /// The folder for journals, templates and results; it exists.
    pub out: PathBuf,
    /// The seed of all randomness.
    pub seed: u64,
    /// Whether what earlier runs left is passed over.
    pub fresh: bool,
    progress: &'a dyn Progress,
    failures: Mutex<Vec<String>>,
    /// The templates that this bench has written.
    pub(super) written: Mutex<BTreeSet<PathBuf>>,
}

/// The rows of objects, and the seconds that they took.
type OfSubjects<'s, R> = (Vec<(&'s Subject, R)>, f64);

/// Whether units run beside each other.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    /// As many at a time as there are cores.
    Parallel,
    /// One after the other: their times are results.
    Single,
}

impl<'a> Bench<'a> {
    /// A bench on which nothing has been done.
    #[must_use]
    pub fn new(
        data: &'a Data,
        out: PathBuf,
        seed: u64,
        fresh: bool,
        progress: &'a dyn Progress,
    ) -> Self {
        Self {
            data,
            out,
            seed,
            fresh,
            progress,
            failures: Mutex::default(),
            written: Mutex::default(),
        }
    }

    /// What failed, an object of an experiment a line; the results are of the others.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        self.failures
            .lock()
            .map_or_else(|_| Vec::new(), |list| list.clone())
    }

    pub(super) fn journal(&self, experiment: Experiment) -> Result<Journal, ExperimentError> {
        let path = self.out.join(format!("{}.jsonl", experiment.name()));
        let heading = Heading {
            experiment: experiment.name().to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            protocol: PROTOCOL,
            seed: self.seed,
        };
        Journal::open(&path, &heading, self.fresh)
    }

    /// The rows of all units, in their order: what the journal has of them, and the others computed. A unit
    /// that fails is told of, kept in [`Bench::failures`], and left out.
    pub(super) fn rows<U, R>(
        &self,
        journal: &Journal,
        stage: &str,
        units: &[U],
        order: Order,
        key: impl Fn(&U) -> String + Sync,
        compute: impl Fn(&U) -> Result<R, ExperimentError> + Sync,
    ) -> Result<Vec<(usize, R)>, ExperimentError>
    where
        U: Sync,
        R: Serialize + DeserializeOwned + Send,
    {
        self.progress.start(stage, units.len() as u64);
        let one = |(index, unit): (usize, &U)| {
            let key = key(unit);
            let row = match journal.row(&key) {
                Some(row) => Ok(Some((index, row))),
                None => match compute(unit) {
                    Ok(row) => journal.keep(&key, &row).map(|()| Some((index, row))),
                    Err(error) if !error.is_of_object() => Err(error),
                    Err(error) => {
                        self.fail(format!("{stage}: {error}"));
                        Ok(None)
                    }
                },
            };
            self.progress.step();
            row
        };
        let rows: Result<Vec<_>, _> = match order {
            // One by one and not in halves, since units take unlike times.
            Order::Parallel => units
                .par_iter()
                .enumerate()
                .with_max_len(1)
                .map(one)
                .collect(),
            Order::Single => units.iter().enumerate().map(one).collect(),
        };
        self.progress.finish();
        let rows: Vec<(usize, R)> = rows?.into_iter().flatten().collect();
        if rows.is_empty() {
            return Err(ExperimentError::NothingLeft);
        }
        Ok(rows)
    }

    /// The object that single results are of: the one that the data names for that, or the first of the others whose
    /// mesh can be read.
    pub(super) fn shown(&self, experiment: Experiment) -> Result<&'a Subject, ExperimentError> {
        let first = self.data.shown();
        let others = self
            .data
            .all()
            .iter()
            .filter(|one| one.key() != first.key());
        for subject in std::iter::once(first).chain(others) {
            match subject.mesh() {
                Ok(_) => return Ok(subject),
                Err(error) if error.is_of_object() => {
                    self.fail(format!("{}: {error}", experiment.name()));
                }
                Err(error) => return Err(error),
            }
        }
        Err(ExperimentError::NothingLeft)
    }

    fn fail(&self, line: String) {
        self.progress.warn(&line);
        if let Ok(mut failures) = self.failures.lock() {
            failures.push(line);
        }
    }

    /// As [`Bench::rows`], with an object a unit.
    pub(super) fn of_subjects<'s, R>(
        &self,
        experiment: Experiment,
        subjects: &[&'s Subject],
        compute: impl Fn(&Subject) -> Result<R, ExperimentError> + Sync,
    ) -> Result<OfSubjects<'s, R>, ExperimentError>
    where
        R: Serialize + DeserializeOwned + Send,
    {
        let journal = self.journal(experiment)?;
        let rows = self.rows(
            &journal,
            experiment.name(),
            subjects,
            Order::Parallel,
            |subject| subject.key(),
            |subject| compute(subject),
        )?;
        let rows = rows.into_iter().map(|(index, row)| (subjects[index], row));
        Ok((rows.collect(), journal.seconds()))
    }
}
