//! Limits of the memory that the program may take, and the messages when they are reached.

use std::sync::OnceLock;

/// The limit that the user set, in bytes.
static ALLOWED: OnceLock<u64> = OnceLock::new();

/// Most bytes that the program takes without --max-memory, if the machine has as many to spare.
const MOST: u64 = 16 << 30;
/// The same limit where the system does not report its free memory.
const UNTOLD: u64 = 8 << 30;
/// Most bytes that are read from a source of unknown length, such as a pipe, without --max-memory.
const STREAM: u64 = 1 << 30;

/// Parses a number of bytes: `1500000000`, or `1500M`, `1.5G`, in powers of 1024.
pub fn size(text: &str) -> Result<u64, String> {
    let refusal = || "expected a number of bytes, or one with the unit K, M, G or T: 512M, 1.5G".to_string();
    let text = text.trim();
    let number = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = text[number.len()..].to_ascii_uppercase();
    let power = match unit.trim_end_matches("IB").trim_end_matches('B') {
        "" => 0,
        "K" => 1,
        "M" => 2,
        "G" => 3,
        "T" => 4,
        _ => return Err(refusal()),
    };
    let bytes = number.parse::<f64>().map_err(|_| refusal())? * 1024f64.powi(power);
    // (NaN is not in the range.)
    if (1.0..=2f64.powi(63)).contains(&bytes) { Ok(bytes as u64) } else { Err(refusal()) }
}

/// Sets the limit that the user chose.
pub fn allow(bytes: u64) {
    // The arguments are read once, so this is the first call.
    let _ = ALLOWED.set(bytes);
}

/// Returns the bytes that the next result may take: half of the memory that is allowed and not yet taken. A
/// result exists twice for a moment, while it is assembled or written.
pub fn affordable() -> u64 {
    let left = match ALLOWED.get() {
        Some(allowed) => allowed.saturating_sub(taken()),
        None => spare().unwrap_or(UNTOLD).min(MOST.saturating_sub(taken())),
    };
    (left / 2).max(1)
}

/// Refuses to make a file in memory if there is no room for it.
pub fn afford_file(bytes: u64) -> Result<(), String> {
    let room = affordable();
    if bytes <= room {
        return Ok(());
    }
    let (bytes, room) = (told(bytes), told(room));
    Err(format!(
        "would have {bytes} or more, and there is room for {room}: give more memory with --max-memory"
    ))
}

/// Returns the length of the longest file that is read into memory, in bytes: the result takes as much again.
pub fn longest_file() -> u64 {
    affordable() / 2
}

/// Returns the same limit for sources of unknown length.
pub fn longest_stream() -> u64 {
    let longest = longest_file();
    if ALLOWED.get().is_some() { longest } else { longest.min(STREAM) }
}

/// Returns the bytes that the system can give without swapping, if it reports them.
fn spare() -> Option<u64> {
    kibibytes(&std::fs::read_to_string("/proc/meminfo").ok()?, "MemAvailable:")
}

/// Returns the bytes that the program has taken, or 0 where the system does not report them. Mapped files do
/// not count.
fn taken() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").ok();
    status.and_then(|status| kibibytes(&status, "RssAnon:")).unwrap_or(0)
}

/// Returns the number behind a name, converted from KiB to bytes.
fn kibibytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// Formats a number of bytes, rounded up: `1.5 GB`, in powers of 1024 as [`size`] reads them.
pub fn told(bytes: u64) -> String {
    if bytes == u64::MAX {
        return "more bytes than can be counted".into();
    }
    let units = ["bytes", "KB", "MB", "GB", "TB", "PB", "EB"];
    let mut power = 0;
    while power + 1 < units.len() && bytes >> (10 * (power + 1)) != 0 {
        power += 1;
    }
    if power == 0 {
        return format!("{bytes} bytes");
    }
    let tenths = (bytes as f64 / 1024f64.powi(power as i32) * 10.0).ceil() / 10.0;
    format!("{tenths} {}", units[power])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        for (text, bytes) in [
            ("1", 1),
            ("1500000000", 1_500_000_000),
            ("1G", 1 << 30),
            ("1g", 1 << 30),
            ("1.5GiB", 3 << 29),
            ("512M", 512 << 20),
            ("64kb", 64 << 10),
            ("2T", 2 << 40),
        ] {
            assert_eq!(size(text), Ok(bytes), "{text}");
        }
        for text in ["", "G", "-1", "0", "0.1", "nan", "inf", "1X", "1 000", "1e300", "1GG"] {
            assert!(size(text).is_err(), "{text}");
        }
    }

    #[test]
    fn sizes_are_told() {
        for (bytes, text) in [
            (0, "0 bytes"),
            (1023, "1023 bytes"),
            (1024, "1 KB"),
            (1 << 30, "1 GB"),
            ((1 << 30) + 1, "1.1 GB"),
            (u64::MAX, "more bytes than can be counted"),
        ] {
            assert_eq!(told(bytes), text);
        }
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn the_system_tells_what_there_is() {
        assert!(spare().is_some_and(|bytes| bytes > 1 << 20));
        assert!((1..1 << 40).contains(&taken()));
        assert!(longest_file() <= affordable() && affordable() <= MOST / 2);
    }
}
