//! Questions on standard input, one a line, that are answered as they come.

use crate::failure::Failure;
use std::io::{ErrorKind, Read};

/// Questions of `N` numbers each.
pub trait Questions<const N: usize> {
    /// Takes one in, or says what is wrong with it.
    fn ask(&mut self, numbers: [f64; N]) -> Result<(), String>;

    /// Prints the answers to all that were taken in, and forgets them.
    fn answer(&mut self) -> Result<(), Failure>;
}

/// Bytes that are asked for at once.
const CHUNK: usize = 1 << 18;
/// No line with a few numbers is longer.
const LONGEST_LINE: usize = 1 << 16;

/// Reads questions from standard input to its end: numbers separated by blanks, tabs or commas. Empty lines
/// and lines that begin with # are skipped. Whole lines are answered as soon as they are there, in bounded
/// memory.
pub fn serve<const N: usize>(questions: &mut impl Questions<N>) -> Result<(), Failure> {
    let mut stdin = std::io::stdin().lock();
    let mut buffer = vec![0; CHUNK];
    let mut lines = 0;
    // The beginning of the buffer holds the beginning of a line whose end has not come yet.
    let mut kept = 0;
    loop {
        let read = match stdin.read(&mut buffer[kept..]) {
            Ok(read) => read,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) => return Err(Failure::of("standard input", error)),
        };
        let filled = kept + read;
        // At the end a last line need not be ended.
        let end = if read == 0 {
            filled
        } else {
            buffer[..filled].iter().rposition(|&byte| byte == b'\n').map_or(0, |last| last + 1)
        };
        let taken = take(questions, &buffer[..end], &mut lines);
        // What could be understood is answered before anybody hears of what could not.
        questions.answer()?;
        taken?;
        if read == 0 {
            return Ok(());
        }
        kept = filled - end;
        if kept > LONGEST_LINE {
            return Err(refuse(lines, &not_numbers::<N>(&buffer[end..filled])));
        }
        buffer.copy_within(end..filled, 0);
    }
}

/// Reads the questions in whole lines; `lines` were read before.
fn take<const N: usize>(
    questions: &mut impl Questions<N>,
    bytes: &[u8],
    lines: &mut u64,
) -> Result<(), Failure> {
    // The lines end in line feeds; what stands behind the last one is a line only if there is something.
    for line in bytes.split_inclusive(|&byte| byte == b'\n') {
        let asked = match row(line) {
            Some(Ok(numbers)) => questions.ask(numbers),
            None => Ok(()),
            Some(Err(())) => Err(not_numbers::<N>(line)),
        };
        asked.map_err(|problem| refuse(*lines, &problem))?;
        *lines += 1;
    }
    Ok(())
}

/// The failure of the line after the first `lines`.
fn refuse(lines: u64, problem: &str) -> Failure {
    Failure::of("standard input", format_args!("line {}: {problem}", lines + 1))
}

/// The problem with a line that does not consist of `N` numbers.
fn not_numbers<const N: usize>(line: &[u8]) -> String {
    /// Enough to recognise the line by.
    const SHOWN: usize = 40;
    let text = String::from_utf8_lossy(line);
    let text = text.trim();
    let shown: String = text.chars().take(SHOWN).collect();
    let more = if shown.len() < text.len() { "…" } else { "" };
    let expected = match N {
        3 => "three".to_owned(),
        4 => "four".to_owned(),
        6 => "six".to_owned(),
        n => n.to_string(),
    };
    format!("expected {expected} numbers, found \"{}{more}\"", shown.escape_debug())
}

/// The numbers on a line, if there are any.
fn row<const N: usize>(line: &[u8]) -> Option<Result<[f64; N], ()>> {
    let Ok(line) = std::str::from_utf8(line) else { return Some(Err(())) };
    let line = line.trim();
    if line.is_empty() || line.starts_with('#') {
        return None;
    }
    Some(numbers(line).ok_or(()))
}

/// Numbers with a comma or white space between them.
fn numbers<const N: usize>(line: &str) -> Option<[f64; N]> {
    let mut numbers = [0.0; N];
    let mut rest = line;
    for (i, number) in numbers.iter_mut().enumerate() {
        if i > 0 {
            // One comma at most, with or without blanks around it.
            rest = rest.trim_start();
            rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
        }
        let end = rest.find(|c: char| c == ',' || c.is_whitespace()).unwrap_or(rest.len());
        let (text, after) = rest.split_at(end);
        *number = text.parse().ok()?;
        rest = after;
    }
    rest.is_empty().then_some(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_with_numbers() {
        for line in ["1 2 -3", "1,2,-3", "1\t2\t-3\r\n", "  1 , 2 ,-3e0  ", "1.0, 2. -3\n"] {
            assert_eq!(row(line.as_bytes()), Some(Ok([1.0, 2.0, -3.0])), "{line:?}");
        }
        for line in ["", "\r\n", "   ", "# 1 2 3", "  #"] {
            assert_eq!(row::<3>(line.as_bytes()), None, "{line:?}");
        }
        for line in ["1", "1 2", "1 2 3 4", "1,,2,3", ",1,2,3", "1,2,3,", "a b c", "1 2 3 # here", "0x1 2 3"]
        {
            assert_eq!(row::<3>(line.as_bytes()), Some(Err(())), "{line:?}");
        }
        assert_eq!(row::<3>(b"1 2 \xff3"), Some(Err(())));
        assert!(row::<3>(b"nan inf -infinity").unwrap().unwrap()[0].is_nan());
        assert_eq!(row(b"1,2,3 4 5,6\n"), Some(Ok([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])));
    }
}
