//! Numbers as people read them.

use std::fmt::Write;

/// Formats a count, with commas: 1,234,567.
pub fn count(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Formats a count and the counted noun: "1 body", "2 bodies".
pub fn counted(number: u64, one: &str, many: &str) -> String {
    format!("{} {}", count(number), if number == 1 { one } else { many })
}

/// Formats a number in full precision, in scientific notation if it is very large or small.
pub fn number(x: f64) -> String {
    let mut text = String::new();
    push_number(&mut text, x);
    text
}

/// Appends a [`number`].
pub fn push_number(text: &mut String, x: f64) {
    // (Writing to a string does not fail.)
    let _ = write!(text, "{x:?}");
    if text.ends_with(".0") {
        text.truncate(text.len() - 2);
    }
}

/// Appends a line to a text: a name, and a value in a column behind it.
pub fn put_line(text: &mut String, name: &str, value: &str) {
    // (Writing to a string does not fail.)
    let _ = writeln!(text, "{name:<16}{value}");
}

/// Formats a duration in a suitable unit.
pub fn seconds(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.1} µs", s * 1e6),
        s if s < 1.0 => format!("{:.1} ms", s * 1e3),
        s => format!("{s:.2} s"),
    }
}

/// Formats a number for a table: six digits are enough there.
pub fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    number(rounded)
}

/// Formats lines whose columns are aligned to the right.
pub fn table<R: AsRef<[String]>>(head: &R, rows: &[R]) -> String {
    let all = || [head].into_iter().chain(rows).map(AsRef::as_ref);
    let width = |column: usize| all().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for row in all() {
        for (column, cell) in row.iter().enumerate() {
            let gap = if column == 0 { "" } else { "  " };
            let _ = write!(text, "{gap}{cell:>width$}", width = width(column));
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        for (number, text) in [(0, "0"), (999, "999"), (1000, "1,000"), (1_234_567, "1,234,567")] {
            assert_eq!(count(number), text);
        }
        for (x, text) in
            [(0.0, "0"), (1.5, "1.5"), (-3.0, "-3"), (1e300, "1e300"), (0.1 + 0.2, "0.30000000000000004")]
        {
            assert_eq!(number(x), text);
        }
        assert_eq!(counted(1, "body", "bodies"), "1 body");
        assert_eq!(
            (seconds(2e-6), seconds(0.0123), seconds(61.0)),
            ("2.0 µs".into(), "12.3 ms".into(), "61.00 s".into())
        );
    }
}
