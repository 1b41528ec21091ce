//! A reader for text made of words and lines.

use super::{decimal, is_line_end, is_space};
use crate::error::MeshFileError;

/// A partly consumed text.
#[derive(Clone, Copy)]
pub(super) struct Text<'a> {
    all: &'a [u8],
    rest: &'a [u8],
}

impl<'a> Text<'a> {
    /// Makes a reader of a file that is text from beginning to end.
    pub fn new(bytes: &'a [u8]) -> Self {
        // Block-wise transfers and DOS programs append zero bytes and Ctrl-Z.
        let end = bytes.iter().rposition(|b| !matches!(b, 0 | 0x1A)).map_or(0, |last| last + 1);
        let all = &bytes[..end];
        // Skip a byte order mark.
        Self { all, rest: all.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(all) }
    }

    /// Makes a reader of a file that begins with text.
    pub fn beginning(bytes: &'a [u8]) -> Self {
        Self { all: bytes, rest: bytes }
    }

    /// Returns the number of bytes that were taken.
    pub fn taken(&self) -> usize {
        self.all.len() - self.rest.len()
    }

    /// Returns the bytes that are left.
    #[inline]
    pub fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// Continues with `rest`, which must be an end of [`rest`](Self::rest).
    #[inline]
    pub fn continue_with(&mut self, rest: &'a [u8]) {
        debug_assert!(rest.len() <= self.rest.len());
        self.rest = rest;
    }

    /// Takes blanks, but no line ends.
    #[inline]
    pub fn skip_blanks(&mut self) {
        while let [b' ' | b'\t' | 0x0B | 0x0C, rest @ ..] = self.rest {
            self.rest = rest;
        }
    }

    /// Takes blanks and line ends.
    #[inline]
    pub fn skip_space(&mut self) {
        while let [b' ' | b'\t'..=b'\r', rest @ ..] = self.rest {
            self.rest = rest;
        }
    }

    /// Takes the rest of the line, with its end.
    #[inline]
    pub fn skip_line(&mut self) {
        let end = self.rest.iter().position(|&b| is_line_end(b)).unwrap_or(self.rest.len());
        self.rest = match &self.rest[end..] {
            [b'\r', b'\n', rest @ ..] | [_, rest @ ..] => rest,
            [] => &[],
        };
    }

    /// Returns whether everything was taken.
    #[inline]
    pub fn is_at_end(&self) -> bool {
        self.rest.is_empty()
    }

    /// Returns whether the line, or the text, ends here.
    #[inline]
    pub fn is_at_line_end(&self) -> bool {
        self.rest.first().is_none_or(|&b| is_line_end(b))
    }

    /// Takes all bytes up to the next white space.
    #[inline]
    pub fn word(&mut self) -> &'a [u8] {
        let length = self.rest.iter().position(|&b| is_space(b)).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(length);
        self.rest = rest;
        word
    }

    /// Takes a finite number, if there is one here.
    #[inline]
    pub fn number(&mut self) -> Option<f64> {
        let (number, rest) = decimal::number(self.rest)?;
        self.rest = rest;
        Some(number)
    }

    /// Takes an integer, if there is one here and no letter, digit, sign or point follows it.
    #[inline]
    pub fn integer(&mut self) -> Option<i64> {
        let (integer, rest) = decimal::integer(self.rest)?;
        if rest.first().is_some_and(|&byte| decimal::continues(byte)) {
            return None;
        }
        self.rest = rest;
        Some(integer)
    }

    /// Returns the error that something else was expected at the current place.
    #[cold]
    pub fn error(&self, expected: &'static str) -> MeshFileError {
        MeshFileError::Syntax { line: self.line(), expected }
    }

    /// Returns the line of the next byte, counted from 1; at the end of the text the line of the last word.
    /// O(n): lines are counted only for errors.
    #[cold]
    pub fn line(&self) -> u64 {
        let mut taken = self.taken();
        if self.rest.iter().all(|&b| is_space(b)) {
            taken = self.all[..taken].iter().rposition(|&b| !is_space(b)).map_or(0, |last| last + 1);
        }
        let before = &self.all[..taken];
        let line_feeds = before.iter().filter(|&&b| b == b'\n').count();
        // A carriage return is a line end unless a line feed follows.
        let returns = before.iter().zip(self.all.iter().skip(1).chain(&[0]));
        let lone_returns = returns.filter(|&(&b, &next)| b == b'\r' && next != b'\n').count();
        1 + (line_feeds + lone_returns) as u64
    }
}
