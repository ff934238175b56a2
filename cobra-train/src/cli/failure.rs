//! What ends the command early, and the exit code that says so.

use cobra_infer::{ScoreError, TemplateError};
use cobra_train::bop::dataset::DatasetError;
use cobra_train::bop::results::ReadResultsError;
use cobra_train::experiment::ExperimentError;
use cobra_train::input::{
    ReadCameraError, ReadCorrespondencesError, ReadEstimatesError, ReadReportError,
};
use cobra_train::output::WriteError;
use cobra_train::reference::ReadReferencePointsError;
use cobra_train::report::{ReadAmbiguityError, ReadCurvesError};
use cobra_train::surface::ReadMeshError;
use cobra_train::train::TrainError;
use std::path::Path;
use std::process::ExitCode;

/// Why the command ends without success.
#[derive(Debug)]
pub(crate) enum Failure {
    /// A pose was not accepted and `--fail-on-reject` was given; the table has said which.
    NotAccepted {
        /// How many.
        count: usize,
    },
    /// The arguments do not fit together.
    Usage(String),
    /// A file does not hold what it should.
    BadInput(String),
    /// Reading or writing failed.
    Io(String),
    /// Whoever read the output has gone: nothing to complain of.
    OutputClosed,
}

impl Failure {
    pub(crate) fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Failure::OutputClosed => 0,
            Failure::NotAccepted { .. } => 1,
            Failure::Usage(_) => 2,
            Failure::BadInput(_) => 3,
            Failure::Io(_) => 4,
        })
    }

    pub(crate) fn message(&self) -> Option<String> {
        match self {
            Failure::OutputClosed => None,
            Failure::NotAccepted { count: 1 } => Some("1 pose was not accepted".to_owned()),
            Failure::NotAccepted { count } => Some(format!("{count} poses were not accepted")),
            Failure::Usage(text) | Failure::BadInput(text) | Failure::Io(text) => {
                Some(text.clone())
            }
        }
    }

    /// A template file that is none.
    pub(crate) fn template(path: &Path, error: &TemplateError) -> Self {
        Failure::BadInput(format!("{}: {error}", path.display()))
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Failure::Io(error.to_string())
    }
}

impl From<DatasetError> for Failure {
    fn from(error: DatasetError) -> Self {
        Self::from(&error)
    }
}

impl From<ReadResultsError> for Failure {
    fn from(error: ReadResultsError) -> Self {
        classify(error.is_io(), &error)
    }
}

impl From<ReadMeshError> for Failure {
    fn from(error: ReadMeshError) -> Self {
        classify(error.is_io(), &error)
    }
}

impl From<ReadAmbiguityError> for Failure {
    fn from(error: ReadAmbiguityError) -> Self {
        classify(error.is_io(), &error)
    }
}

impl From<ReadCurvesError> for Failure {
    fn from(error: ReadCurvesError) -> Self {
        classify(error.is_io(), &error)
    }
}

impl From<ReadReferencePointsError> for Failure {
    fn from(error: ReadReferencePointsError) -> Self {
        let io =
            matches!(&error, ReadReferencePointsError::Io { source, .. } if !is_content(source));
        classify(io, &error)
    }
}

impl From<ReadCameraError> for Failure {
    fn from(error: ReadCameraError) -> Self {
        let io = matches!(&error, ReadCameraError::Io { source, .. } if !is_content(source));
        classify(io, &error)
    }
}

impl From<ReadEstimatesError> for Failure {
    fn from(error: ReadEstimatesError) -> Self {
        let io = matches!(&error, ReadEstimatesError::Io { source, .. } if !is_content(source));
        classify(io, &error)
    }
}

impl From<ReadCorrespondencesError> for Failure {
    fn from(error: ReadCorrespondencesError) -> Self {
        let io =
            matches!(&error, ReadCorrespondencesError::Io { source, .. } if !is_content(source));
        classify(io, &error)
    }
}

impl From<ReadReportError> for Failure {
    fn from(error: ReadReportError) -> Self {
        let io = matches!(&error, ReadReportError::Io { source, .. } if !is_content(source));
        classify(io, &error)
    }
}

impl From<ExperimentError> for Failure {
    fn from(error: ExperimentError) -> Self {
        classify(error.is_io(), &error)
    }
}

impl From<&DatasetError> for Failure {
    fn from(error: &DatasetError) -> Self {
        classify(error.is_io(), error)
    }
}

impl From<TrainError> for Failure {
    fn from(error: TrainError) -> Self {
        Failure::BadInput(error.to_string())
    }
}

impl From<ScoreError> for Failure {
    fn from(error: ScoreError) -> Self {
        Failure::BadInput(error.to_string())
    }
}

/// Bytes that are no text are the file's fault, although the reader calls them an I/O error.
fn is_content(error: &std::io::Error) -> bool {
    error.kind() == std::io::ErrorKind::InvalidData
}

fn classify(io: bool, error: &dyn std::error::Error) -> Failure {
    let text = error.to_string();
    if io {
        Failure::Io(text)
    } else {
        Failure::BadInput(text)
    }
}
