//! Text output with fallible allocation.

use crate::error::Error;
use crate::lattice::Each;
use alloc::vec::Vec;
use core::fmt::{self, Write};

/// A text file in memory.
#[derive(Default)]
pub(super) struct Lines(Vec<u8>);

impl Lines {
    /// Appends formatted text.
    pub fn add(&mut self, text: fmt::Arguments<'_>) -> Result<(), Error> {
        // Formatting fails here only for lack of memory.
        self.write_fmt(text).map_err(|_| Error::OutOfMemory)
    }

    pub fn bytes(self) -> Vec<u8> {
        self.0
    }
}

impl Write for Lines {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.try_reserve(text.len()).map_err(|_| fmt::Error)?;
        self.0.extend_from_slice(text.as_bytes());
        Ok(())
    }
}

/// A number, formatted with the fewest digits that are read back as the same number.
pub(super) struct Number<T>(pub T);

impl<T: Copy + Into<f64> + fmt::Display + fmt::LowerExp> fmt::Display for Number<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.into().abs();
        // Other numbers would have long rows of zeros.
        if size == 0.0 || (1e-5..1e16).contains(&size) {
            fmt::Display::fmt(&self.0, f)
        } else {
            fmt::LowerExp::fmt(&self.0, f)
        }
    }
}

/// Coordinates, separated by blanks.
pub(super) struct Point<T>(pub [T; 3]);

impl<T: Copy + Into<f64> + fmt::Display + fmt::LowerExp> fmt::Display for Point<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.0.each(Number);
        write!(f, "{x} {y} {z}")
    }
}
