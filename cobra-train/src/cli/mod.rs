//! The command `cobra`: arguments in, library calls, text and files out.
//!
//! Owns what is particular to a terminal: arguments, progress, tables, exit codes. Everything that
//! another program could want is in the library.

mod ambiguity;
mod args;
mod bop;
mod calibrate;
mod choices;
mod coverage;
mod covered;
mod demo;
mod eval;
mod experiment;
mod export;
mod failure;
mod inspect;
mod learning;
mod object;
mod outputs;
mod overlay;
mod page;
mod report;
mod score;
mod sources;
mod template_file;
mod terminal;
mod train;

use args::{Arguments, Command};
use clap::{CommandFactory, Parser};
use std::process::ExitCode;
use terminal::Terminal;

/// Runs the command and returns its exit code: 0, 1 with `score --fail-on-reject` only, 2 usage, 3
/// bad input, 4 input or output failed.
pub(crate) fn run() -> ExitCode {
    let arguments = Arguments::parse();
    let terminal = Terminal::new(arguments.quiet, arguments.verbose);
    let result = match &arguments.command {
        Command::Demo(arguments) => demo::run(arguments, &terminal),
        Command::Train(arguments) => train::run(arguments, &terminal),
        Command::Score(arguments) => score::run(arguments, &terminal),
        Command::Eval(arguments) => eval::run(arguments, &terminal),
        Command::Experiment(arguments) => experiment::run(arguments, &terminal),
        Command::Bop(arguments) => bop::run(arguments, &terminal),
        Command::Ambiguity(arguments) => ambiguity::run(arguments, &terminal),
        Command::Calibrate(arguments) => calibrate::run(arguments, &terminal),
        Command::Overlay(arguments) => overlay::run(arguments, &terminal),
        Command::Report(arguments) => page::run(arguments, &terminal),
        Command::Inspect(arguments) => inspect::run(arguments, &terminal),
        Command::Export(arguments) => export::run(arguments, &terminal),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Arguments::command(), "cobra", &mut script);
            terminal.print(&String::from_utf8_lossy(&script))
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            terminal.fail(&failure);
            failure.exit_code()
        }
    }
}
