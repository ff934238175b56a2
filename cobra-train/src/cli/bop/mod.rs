//! `cobra bop`: templates of a data set's objects, and scores for its results files.

mod arguments;
mod score;
mod summary;
mod train;

pub(crate) use arguments::{BopArguments, BopCommand};

use super::failure::Failure;
use super::terminal::Terminal;

pub(super) fn run(arguments: &BopArguments, terminal: &Terminal) -> Result<(), Failure> {
    match &arguments.command {
        BopCommand::Train(arguments) => train::run(arguments, terminal),
        BopCommand::Score(arguments) => score::run(arguments, terminal),
    }
}
