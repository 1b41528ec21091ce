//! `leafless contains`: does the solid contain these points?

use crate::failure::Failure;
use crate::input::Input;
use crate::output::print;
use clap::Args;
use leafless::{Membership, OctreeRef};
use std::ffi::OsString;
use std::io::{ErrorKind, Read};

/// Reads points from standard input, one a line: x, y and z in the solid's units, separated by blanks, tabs
/// or commas. Empty lines and lines that begin with # are skipped.
///
/// Prints a line for each point: `inside` and `outside` are proven if the solid is certified; `undecided` are
/// points in cells that the surface may pass through, points outside of the solid's bounds, and such as
/// `nan`. Answers come as soon as lines are there, so that another program can ask and wait.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl)
    file: OsString,
}

/// Bytes that are asked for at once.
const CHUNK: usize = 1 << 18;
/// No line with three numbers is longer.
const LONGEST_LINE: usize = 1 << 16;

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let input = Input::from(&*arguments.file);
    if input.path().is_none() {
        return Err(Failure::Usage("standard input carries the points, so the solid must be a file".into()));
    }
    // Proven answers need a file that is what its maker wrote.
    let (octree, _) = input.octree(true)?;
    let mut batch = Batch::new(octree.view());
    let mut stdin = std::io::stdin().lock();
    let mut buffer = vec![0; CHUNK];
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
        let taken = batch.take(&buffer[..end]);
        // What could be understood is answered before anybody hears of what could not.
        batch.answer()?;
        taken?;
        if read == 0 {
            return Ok(());
        }
        kept = filled - end;
        if kept > LONGEST_LINE {
            return Err(batch.refuse(&buffer[end..filled]));
        }
        buffer.copy_within(end..filled, 0);
    }
}

/// Points that are answered together.
struct Batch<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    points: Vec<[f64; 3]>,
    answers: Vec<Membership>,
    text: Vec<u8>,
    /// Lines that were read.
    lines: u64,
}

impl<'t, 'a> Batch<'t, 'a> {
    fn new(tree: &'t OctreeRef<'a>) -> Batch<'t, 'a> {
        Batch { tree, points: Vec::new(), answers: Vec::new(), text: Vec::new(), lines: 0 }
    }

    /// Reads the points in whole lines.
    fn take(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        // The lines end in line feeds; what stands behind the last one is a line only if there is something.
        for line in bytes.split_inclusive(|&byte| byte == b'\n') {
            match point(line) {
                Some(Ok(point)) => self.points.push(point),
                None => {}
                Some(Err(())) => return Err(self.refuse(line)),
            }
            self.lines += 1;
        }
        Ok(())
    }

    /// Prints the answers, and forgets the points.
    fn answer(&mut self) -> Result<(), Failure> {
        if self.points.is_empty() {
            return Ok(());
        }
        self.answers.resize(self.points.len(), Membership::Undecided);
        let answered = self.tree.contains_many(&self.points, &mut self.answers);
        answered.map_err(|error| Failure::Failed(error.to_string()))?;
        self.text.clear();
        for answer in &self.answers {
            self.text.extend_from_slice(match answer {
                Membership::Outside => b"outside\n",
                Membership::Inside => b"inside\n",
                Membership::Undecided => b"undecided\n",
            });
        }
        self.points.clear();
        print(&self.text)
    }

    /// The failure of the line after those that were read.
    fn refuse(&self, line: &[u8]) -> Failure {
        /// Enough to recognise the line by.
        const SHOWN: usize = 40;
        let text = String::from_utf8_lossy(line);
        let text = text.trim();
        let shown: String = text.chars().take(SHOWN).collect();
        let more = if shown.len() < text.len() { "…" } else { "" };
        Failure::of(
            "standard input",
            format_args!(
                "line {}: expected three numbers, found \"{}{more}\"",
                self.lines + 1,
                shown.escape_debug()
            ),
        )
    }
}

/// The point on a line, if there is one.
fn point(line: &[u8]) -> Option<Result<[f64; 3], ()>> {
    let Ok(line) = std::str::from_utf8(line) else { return Some(Err(())) };
    let line = line.trim();
    if line.is_empty() || line.starts_with('#') {
        return None;
    }
    Some(numbers(line).ok_or(()))
}

/// Three numbers with a comma or white space between them.
fn numbers(line: &str) -> Option<[f64; 3]> {
    let mut point = [0.0; 3];
    let mut rest = line;
    for (axis, x) in point.iter_mut().enumerate() {
        if axis > 0 {
            // One comma at most, with or without blanks around it.
            rest = rest.trim_start();
            rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
        }
        let end = rest.find(|c: char| c == ',' || c.is_whitespace()).unwrap_or(rest.len());
        let (number, after) = rest.split_at(end);
        *x = number.parse().ok()?;
        rest = after;
    }
    rest.is_empty().then_some(point)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_with_points() {
        for line in ["1 2 -3", "1,2,-3", "1\t2\t-3\r\n", "  1 , 2 ,-3e0  ", "1.0, 2. -3\n"] {
            assert_eq!(point(line.as_bytes()), Some(Ok([1.0, 2.0, -3.0])), "{line:?}");
        }
        for line in ["", "\r\n", "   ", "# 1 2 3", "  #"] {
            assert_eq!(point(line.as_bytes()), None, "{line:?}");
        }
        for line in ["1", "1 2", "1 2 3 4", "1,,2,3", ",1,2,3", "1,2,3,", "a b c", "1 2 3 # here", "0x1 2 3"]
        {
            assert_eq!(point(line.as_bytes()), Some(Err(())), "{line:?}");
        }
        assert_eq!(point(b"1 2 \xff3"), Some(Err(())));
        assert!(point(b"nan inf -infinity").unwrap().unwrap()[0].is_nan());
    }
}
