//! Failures: how a subcommand ends without success, and the line that it prints.

use leafless::Error;
use leafless::error::FormatError;
use std::fmt::Display;
use std::io::Write;

/// The reason why a subcommand stopped.
#[derive(Debug)]
pub enum Failure {
    /// One line that says what is wrong with which file.
    Failed(String),
    /// One line that says what is wrong with the arguments.
    Usage(String),
    /// The reader of standard output is gone; there is nothing to report.
    ReaderGone,
    /// The reader of standard output is gone, and the output was a solid.
    Undelivered,
}

impl Failure {
    /// Returns a failure of the file called `name`.
    pub fn of(name: impl Display, problem: impl Display) -> Failure {
        Failure::Failed(format!("{name}: {problem}"))
    }
}

/// A problem with a file.
pub trait Problem {
    /// Returns the problem in words, without the name of the file.
    fn text(&self) -> String;
}

impl Problem for Error {
    fn text(&self) -> String {
        let cause = self.cause();
        match cause {
            Error::Format(FormatError::OtherModel { wanted: "an octree", .. }) => {
                format!("{cause}: `leafless convert --to octree` makes one")
            }
            _ => cause.to_string(),
        }
    }
}

impl Problem for std::io::Error {
    fn text(&self) -> String {
        // The numbers of the system's errors mean nothing to people.
        let text = self.to_string();
        let words = text.split_once(" (os error ").map_or(text.as_str(), |parts| parts.0);
        words.to_owned()
    }
}

impl Problem for String {
    fn text(&self) -> String {
        self.clone()
    }
}

/// Names the file that an error is about.
pub trait Of<T> {
    /// Returns the result; an error becomes a failure of the file called `name`.
    fn of(self, name: impl Display) -> Result<T, Failure>;
}

impl<T, E: Problem> Of<T> for Result<T, E> {
    fn of(self, name: impl Display) -> Result<T, Failure> {
        self.map_err(|error| Failure::of(name, error.text()))
    }
}

/// Writes one line to standard error. If standard error is closed, nobody wants to know.
pub fn complain(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "leafless: {}", harmless(line));
}

/// Returns the text without line ends and other characters that a terminal might obey: file names may contain
/// anything.
fn harmless(text: &str) -> String {
    let mut line = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() { line.extend(c.escape_default()) } else { line.push(c) }
    }
    line
}
