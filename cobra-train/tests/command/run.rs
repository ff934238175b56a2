//! Runs the binary and looks at what came out.

use serde_json::Value;
use std::ffi::OsStr;
use std::process::{Command, Output, Stdio};

/// The binary of this build, without a terminal and without the caller's colours.
pub(crate) fn command() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cobra"));
    command.stdin(Stdio::null());
    for variable in ["CLICOLOR", "CLICOLOR_FORCE", "FORCE_COLOR", "NO_COLOR"] {
        command.env_remove(variable);
    }
    command
}

/// What a run left on its streams.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl From<Output> for Outcome {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

pub(crate) fn run<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Outcome {
    let outcome: Outcome = command().args(arguments).output().unwrap().into();
    for stream in [&outcome.stdout, &outcome.stderr] {
        assert!(!stream.contains("panicked"), "{stream}");
        assert!(!stream.contains('\u{1b}'), "{stream:?}");
    }
    outcome
}

/// A run that must succeed.
pub(crate) fn succeed<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Outcome {
    let outcome = run(arguments);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    outcome
}

/// A run that must end with `code` and one line on standard error that says all of `said`.
pub(crate) fn refuse<S: AsRef<OsStr>>(
    arguments: impl IntoIterator<Item = S>,
    code: i32,
    said: &[&str],
) {
    let arguments: Vec<S> = arguments.into_iter().collect();
    let arguments = std::iter::once(OsStr::new("--quiet")).chain(arguments.iter().map(S::as_ref));
    let outcome = run(arguments);
    assert_eq!(outcome.code, Some(code), "{outcome:?}");
    assert_eq!(outcome.stdout, "", "{outcome:?}");
    assert_eq!(outcome.stderr.lines().count(), 1, "{outcome:?}");
    assert!(outcome.stderr.starts_with("error: "), "{outcome:?}");
    assert!(outcome.stderr.len() < 1000, "{outcome:?}");
    for words in said {
        assert!(outcome.stderr.contains(words), "{words:?} in {outcome:?}");
    }
}

/// The JSON on standard output: that, and nothing else.
pub(crate) fn json(outcome: &Outcome) -> Value {
    serde_json::from_str(&outcome.stdout)
        .unwrap_or_else(|error| panic!("{error}: {}", outcome.stdout))
}
