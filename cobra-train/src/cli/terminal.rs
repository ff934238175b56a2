//! What the user sees: results on standard output, everything else on standard error.

use super::failure::Failure;
use cobra_train::progress::Progress;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::sync::Mutex;
use std::time::Instant;

/// Prints results, progress and warnings as loudly as was asked.
///
/// Progress is a bar where standard error is a terminal, and a line per stage elsewhere.
pub(crate) struct Terminal {
    quiet: bool,
    verbose: bool,
    stage: Mutex<Option<Stage>>,
}

struct Stage {
    name: String,
    started: Instant,
    bar: Option<ProgressBar>,
}

impl Terminal {
    pub(crate) fn new(quiet: bool, verbose: bool) -> Self {
        Self {
            quiet,
            verbose,
            stage: Mutex::new(None),
        }
    }

    /// A result, on standard output; a newline is added where the text has none.
    pub(crate) fn print(&self, text: &str) -> Result<(), Failure> {
        let end = if text.ends_with('\n') { "" } else { "\n" };
        self.write(format!("{text}{end}").as_bytes())
    }

    /// A result that need not be text, on standard output.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        let mut out = std::io::stdout().lock();
        out.write_all(bytes)
            .and_then(|()| out.flush())
            .map_err(|error| match error.kind() {
                std::io::ErrorKind::BrokenPipe => Failure::OutputClosed,
                _ => Failure::Io(format!("cannot write to standard output: {error}")),
            })
    }

    /// Whether somebody sees results as they are printed, rather than a file or a program.
    pub(crate) fn is_shown(&self) -> bool {
        std::io::stdout().is_terminal()
    }

    /// A remark, unless quiet.
    pub(crate) fn say(&self, text: &str) {
        if !self.quiet {
            self.line(text);
        }
    }

    /// A remark for whoever asked for many.
    pub(crate) fn detail(&self, text: &str) {
        if self.verbose {
            self.line(text);
        }
    }

    /// Why the command ends.
    pub(crate) fn fail(&self, failure: &Failure) {
        if let Some(message) = failure.message() {
            self.line(&format!("error: {}", one_line(&message)));
        }
    }

    fn line(&self, text: &str) {
        // Standard error may be closed; there is nobody left to tell.
        let _ = writeln!(std::io::stderr(), "{text}");
    }

    fn with_stage(&self, act: impl FnOnce(&mut Option<Stage>)) {
        if let Ok(mut stage) = self.stage.lock() {
            act(&mut stage);
        }
    }
}

impl Progress for Terminal {
    fn start(&self, name: &str, steps: u64) {
        if self.quiet {
            return;
        }
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(steps);
            let style = ProgressStyle::with_template("{msg:<26} {bar:24} {pos}/{len}");
            if let Ok(style) = style {
                bar.set_style(style);
            }
            bar.set_message(name.to_owned());
            bar
        });
        self.with_stage(|stage| {
            *stage = Some(Stage {
                name: name.to_owned(),
                started: Instant::now(),
                bar,
            });
        });
    }

    fn step(&self) {
        self.with_stage(|stage| {
            if let Some(bar) = stage.as_ref().and_then(|stage| stage.bar.as_ref()) {
                bar.inc(1);
            }
        });
    }

    fn finish(&self) {
        self.with_stage(|stage| {
            if let Some(stage) = stage.take() {
                if let Some(bar) = stage.bar {
                    bar.finish_and_clear();
                }
                let seconds = stage.started.elapsed().as_secs_f64();
                self.say(&format!("{:<26} {seconds:.2} s", stage.name));
            }
        });
    }

    fn warn(&self, message: &str) {
        let text = format!("warning: {}", one_line(message));
        self.with_stage(|stage| {
            match stage.as_ref().and_then(|stage| stage.bar.as_ref()) {
                Some(bar) => bar.suspend(|| self.line(&text)),
                None => self.line(&text),
            };
        });
    }
}

/// Text from files and file names without what would steer the terminal.
pub(crate) fn one_line(text: &str) -> String {
    text.split(|c: char| c.is_whitespace() || c.is_control())
        .filter(|word| !word.is_empty())
        .collect::<Vec<_>>()
        .join(" ")
}

/// The command as a shell would take it again.
pub(super) fn command_line(words: impl Iterator<Item = std::ffi::OsString>) -> String {
    let quoted = words.map(|word| {
        let word = word.to_string_lossy().into_owned();
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+@%".contains(c);
        if !word.is_empty() && word.chars().all(plain) {
            word
        } else {
            format!("'{}'", word.replace('\'', r"'\''"))
        }
    });
    std::iter::once("cobra".to_owned())
        .chain(quoted)
        .collect::<Vec<_>>()
        .join(" ")
}

#[cfg(test)]
mod tests {
    use super::command_line;

    #[test]
    fn the_command_is_one_that_a_shell_takes_again() {
        let words = [
            "report",
            "my part.cobra",
            "--mesh=a'b.ply",
            "",
            "-o",
            "x.html",
        ];
        assert_eq!(
            command_line(words.into_iter().map(Into::into)),
            r"cobra report 'my part.cobra' '--mesh=a'\''b.ply' '' -o x.html"
        );
    }
}
