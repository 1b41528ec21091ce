//! Questions on standard input, one a line, answered as they arrive.

use crate::failure::Failure;
use std::io::{ErrorKind, Read};

/// A task that answers questions of `N` numbers each.
pub trait Questions<const N: usize> {
    /// Accepts a question, or says what is wrong with it.
    fn ask(&mut self, numbers: [f64; N]) -> Result<(), String>;

    /// Prints the answers to all accepted questions, and forgets the questions.
    fn answer(&mut self) -> Result<(), Failure>;
}

/// Bytes that are read at once.
const CHUNK: usize = 1 << 18;
/// The longest line that is accepted, in bytes; lines of a few numbers are shorter.
const LONGEST_LINE: usize = 1 << 16;

/// Reads questions from standard input to its end: numbers separated by blanks, tabs or commas. Empty lines
/// and lines that begin with # are skipped. Complete lines are answered as soon as they arrive, in bounded
/// memory.
pub fn serve<const N: usize>(questions: &mut impl Questions<N>) -> Result<(), Failure> {
    let mut stdin = std::io::stdin().lock();
    let mut buffer = vec![0; CHUNK];
    let mut lines = 0;
    // The buffer begins with the beginning of a line whose end has not arrived yet.
    let mut kept = 0;
    loop {
        let read = match stdin.read(&mut buffer[kept..]) {
            Ok(read) => read,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) => return Err(Failure::of("standard input", error)),
        };
        let filled = kept + read;
        // The last line may lack its line end.
        let end = if read == 0 {
            filled
        } else {
            buffer[..filled].iter().rposition(|&byte| byte == b'\n').map_or(0, |last| last + 1)
        };
        let taken = take(questions, &buffer[..end], &mut lines);
        // The valid questions are answered before the invalid one is reported.
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

/// Reads the questions in complete lines; `lines` lines were read before.
fn take<const N: usize>(
    questions: &mut impl Questions<N>,
    bytes: &[u8],
    lines: &mut u64,
) -> Result<(), Failure> {
    // Lines end in line feeds. The text behind the last line feed is a line only if it is not empty.
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

/// Returns the failure of the line after the first `lines` lines.
fn refuse(lines: u64, problem: &str) -> Failure {
    Failure::of("standard input", format_args!("line {}: {problem}", lines + 1))
}

/// Describes a line that does not consist of `N` numbers.
fn not_numbers<const N: usize>(line: &[u8]) -> String {
    /// Characters that are enough to recognise the line.
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

/// Parses the numbers on a line; `None` for a line without any.
fn row<const N: usize>(line: &[u8]) -> Option<Result<[f64; N], ()>> {
    let Ok(line) = std::str::from_utf8(line) else { return Some(Err(())) };
    let line = line.trim();
    if line.is_empty() || line.starts_with('#') {
        return None;
    }
    Some(numbers(line).ok_or(()))
}

/// Parses numbers with a comma or white space between them.
fn numbers<const N: usize>(line: &str) -> Option<[f64; N]> {
    let mut numbers = [0.0; N];
    let mut rest = line;
    for (i, number) in numbers.iter_mut().enumerate() {
        if i > 0 {
            // At most one comma, with or without blanks around it.
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
