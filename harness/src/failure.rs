//! Failures: reasons for which a run ends without a result, and the exit codes.

use serde_json::Value;
use std::fmt;
use std::path::Path;

/// Exit code 0: done, nothing unsound.
pub const DONE: i32 = 0;
/// Exit code 1: a law failed; the results are still written.
pub const UNSOUND: i32 = 1;
/// Exit code 2: refused, nothing written.
pub const REFUSED: i32 = 2;
/// Exit code 3: the output could not be written.
pub const NOT_WRITTEN: i32 = 3;

/// Exit code 130: ended by a signal, as a shell says it of SIGINT.
pub const INTERRUPTED: i32 = 130;

/// An end without a result: one line for a person, and an exit code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// Bad input, or found in the run: a NaN in a medium, a majorant that is none.
    Refused(String),
    /// The output could not be written.
    NotWritten(String),
    /// A signal asked to stop.
    Interrupted,
}

impl Failure {
    /// A refusal.
    pub fn refused(reason: impl fmt::Display) -> Self {
        Self::Refused(one_line(&reason.to_string()))
    }

    /// An output that could not be written to `path`.
    pub fn not_written(path: &Path, reason: impl fmt::Display) -> Self {
        Self::NotWritten(one_line(&format!("cannot write {}: {reason}", path.display())))
    }

    /// The same failure, with where it happened in front.
    #[must_use]
    pub fn within(self, place: impl fmt::Display) -> Self {
        match self {
            Self::Refused(reason) => Self::refused(format!("{place}: {reason}")),
            Self::NotWritten(reason) => Self::NotWritten(format!("{place}: {reason}")),
            Self::Interrupted => Self::Interrupted,
        }
    }

    /// The same failure, at a value of the swept key, if there is one.
    #[must_use]
    pub fn at(self, value: Option<&Value>) -> Self {
        match value {
            Some(value) => self.within(format!("sweep value {value}")),
            None => self,
        }
    }

    /// The exit code.
    #[must_use]
    pub fn code(&self) -> i32 {
        match self {
            Self::Refused(_) => REFUSED,
            Self::NotWritten(_) => NOT_WRITTEN,
            Self::Interrupted => INTERRUPTED,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(reason) => write!(f, "refused: {reason}"),
            Self::NotWritten(reason) => write!(f, "{reason}"),
            Self::Interrupted => f.write_str("interrupted"),
        }
    }
}

/// Messages of libraries may span lines; a person gets one. What a file wrote may hold controls that a terminal obeys; a person sees them.
fn one_line(message: &str) -> String {
    let line = message.split_whitespace().collect::<Vec<_>>().join(" ");
    if !line.contains(char::is_control) {
        return line;
    }
    let shown = |c: char| if c.is_control() { c.escape_unicode().to_string() } else { c.to_string() };
    line.chars().map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_is_one_line_without_controls() {
        // DEL, and the single character that introduces a control sequence; found by fuzzing.
        let failure = Failure::refused("estimator.kind: found \"jittered\u{7f}ratio\",\n  \u{9b}31m");
        assert_eq!(
            failure.to_string(),
            "refused: estimator.kind: found \"jittered\\u{7f}ratio\", \\u{9b}31m"
        );
    }
}
