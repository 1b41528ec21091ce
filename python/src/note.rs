//! Stores the threshold of a volume in its NRRD file: a key with a value, which other programs skip or pass
//! on.

use crate::volume::Threshold;

/// The key with its separator.
const KEY: &[u8] = b"leafless threshold:=";

/// Iterates over the lines of a header, which ends at an empty line or at the end of the file.
fn lines(file: &[u8]) -> impl Iterator<Item = &[u8]> {
    let lines = file.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii_end);
    lines.take_while(|line| !line.is_empty())
}

/// Adds the threshold to a file that the library wrote.
pub fn add(file: &mut Vec<u8>, (low, high): Threshold) {
    // The first line, which names the format, stays the first.
    let first = lines(file).next().map_or(0, <[u8]>::len) + 1;
    let high = high.map_or(String::new(), |high| format!(" {high:?}"));
    let line = [KEY, format!("{low:?}{high}\n").as_bytes()].concat();
    file.splice(first..first, line);
}

/// Returns the threshold in a header, if there is one.
pub fn threshold(file: &[u8]) -> Option<Threshold> {
    let told = lines(file).find_map(|line| line.strip_prefix(KEY))?;
    let mut numbers =
        std::str::from_utf8(told).ok()?.split_ascii_whitespace().map(|number| number.parse().ok());
    let (low, high) = (numbers.next()??, numbers.next());
    Some((low, high.map_or(Some(None), |high| high.map(Some))?))
}
