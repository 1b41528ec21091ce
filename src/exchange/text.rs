//! Text of words and lines, taken from the front.

use super::{decimal, is_line_end, is_space};
use crate::error::MeshFileError;

/// A text, of which a part has been taken.
#[derive(Clone, Copy)]
pub(super) struct Text<'a> {
    all: &'a [u8],
    rest: &'a [u8],
}

impl<'a> Text<'a> {
    /// A file that is text from beginning to end.
    pub fn new(bytes: &'a [u8]) -> Self {
        // Zero bytes and Ctrl-Z are what block-wise transfers and DOS programs append.
        let end = bytes.iter().rposition(|b| !matches!(b, 0 | 0x1A)).map_or(0, |last| last + 1);
        let all = &bytes[..end];
        // A byte order mark.
        Self { all, rest: all.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(all) }
    }

    /// A file that begins with text.
    pub fn beginning(bytes: &'a [u8]) -> Self {
        Self { all: bytes, rest: bytes }
    }

    /// How many bytes of the file have been taken.
    pub fn taken(&self) -> usize {
        self.all.len() - self.rest.len()
    }

    /// What has not been taken yet.
    #[inline]
    pub fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// Goes on with `rest`, which must be an end of [`rest`](Self::rest).
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

    /// Takes what is left of the line, with its end.
    #[inline]
    pub fn skip_line(&mut self) {
        let end = self.rest.iter().position(|&b| is_line_end(b)).unwrap_or(self.rest.len());
        self.rest = match &self.rest[end..] {
            [b'\r', b'\n', rest @ ..] | [_, rest @ ..] => rest,
            [] => &[],
        };
    }

    /// Whether all has been taken.
    #[inline]
    pub fn is_at_end(&self) -> bool {
        self.rest.is_empty()
    }

    /// Whether the line, or the text, ends here.
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

    /// Takes a finite number, if one stands here.
    #[inline]
    pub fn number(&mut self) -> Option<f64> {
        let (number, rest) = decimal::number(self.rest)?;
        self.rest = rest;
        Some(number)
    }

    /// Takes an integer, if one stands here and no letter, digit, sign or point follows it.
    #[inline]
    pub fn integer(&mut self) -> Option<i64> {
        let (integer, rest) = decimal::integer(self.rest)?;
        if rest.first().is_some_and(|&byte| decimal::continues(byte)) {
            return None;
        }
        self.rest = rest;
        Some(integer)
    }

    /// The error that something else than what comes next was expected.
    #[cold]
    pub fn error(&self, expected: &'static str) -> MeshFileError {
        MeshFileError::Syntax { line: self.line(), expected }
    }

    /// The line of what comes next, counted from 1; at the end of the text that of its last word. O(n): lines
    /// are counted only for errors.
    #[cold]
    pub fn line(&self) -> u64 {
        let mut taken = self.taken();
        if self.rest.iter().all(|&b| is_space(b)) {
            taken = self.all[..taken].iter().rposition(|&b| !is_space(b)).map_or(0, |last| last + 1);
        }
        let before = &self.all[..taken];
        let line_feeds = before.iter().filter(|&&b| b == b'\n').count();
        // A carriage return ends a line of its own unless a line feed follows.
        let returns = before.iter().zip(self.all.iter().skip(1).chain(&[0]));
        let lone_returns = returns.filter(|&(&b, &next)| b == b'\r' && next != b'\n').count();
        1 + (line_feeds + lone_returns) as u64
    }
}
