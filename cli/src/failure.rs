//! How a subcommand ends without success.

use std::fmt::Display;

/// Why a subcommand stopped.
#[derive(Debug)]
pub enum Failure {
    /// One line that says what is wrong with which file.
    Failed(String),
    /// One line that says what is wrong with the arguments.
    Usage(String),
    /// Nobody reads standard output any more: no reason to say anything.
    ReaderGone,
    /// Nobody reads standard output any more, where a solid was to go.
    Undelivered,
}

impl Failure {
    /// A failure of the file that is called `name`.
    pub fn of(name: impl Display, problem: impl Display) -> Failure {
        Failure::Failed(format!("{name}: {problem}"))
    }
}

/// Names the file that an error is about.
pub trait Of<T> {
    /// The result, its error about the file that is called `name`.
    fn of(self, name: impl Display) -> Result<T, Failure>;
}

impl<T, E: Display> Of<T> for Result<T, E> {
    fn of(self, name: impl Display) -> Result<T, Failure> {
        self.map_err(|error| Failure::of(name, error))
    }
}
