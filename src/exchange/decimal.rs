//! Parsing of decimal numbers: fast, and correctly rounded.
//!
//! If a number has at most 19 digits, its digits form an integer below 2^53, and the magnitude of its power
//! of ten is at most 22, then the number is one product or quotient of two `f64` that are both exact. The one
//! rounding is then the right one. All other numbers go to [`str::parse`].

/// The powers of ten that `f64` holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// Powers of ten as integers, for up to eight digits at once.
const TENS: [u64; 9] = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];

/// Parses the finite number at the beginning of `text`, and returns the nearest `f64` (ties to even) and the
/// text after the number. The number must not be followed by a letter, digit, sign or point.
///
/// Accepts the numbers that [`f64`] parses, without infinities and NaN: `1`, `+1.`, `-.5`, `1e-3`, `1E+05`.
#[inline]
pub(super) fn number(text: &[u8]) -> Option<(f64, &[u8])> {
    let (negative, unsigned) = sign(text);
    let (mut mantissa, mut rest) = digits(0, unsigned);
    let mut count = unsigned.len() - rest.len();
    let mut exponent = 0;
    if let [b'.', fraction @ ..] = rest {
        (mantissa, rest) = digits(mantissa, fraction);
        let places = fraction.len() - rest.len();
        count += places;
        exponent = -(places.min(64) as i64);
    }
    if let [b'e' | b'E', tail @ ..] = rest {
        let (negative, unsigned) = sign(tail);
        let (value, after) = digits(0, unsigned);
        let places = unsigned.len() - after.len();
        if !(1..=9).contains(&places) {
            return by_the_book(text);
        }
        exponent += if negative { -(value as i64) } else { value as i64 };
        rest = after;
    }
    let plain = (1..=19).contains(&count) && mantissa < 1 << 53 && exponent.unsigned_abs() <= 22;
    if !plain || rest.first().is_some_and(|&byte| continues(byte)) {
        return by_the_book(text);
    }
    let power = POWERS[exponent.unsigned_abs() as usize];
    let value = if exponent < 0 { mantissa as f64 / power } else { mantissa as f64 * power };
    Some((if negative { -value } else { value }, rest))
}

/// Parses the integer at the beginning of `text`, and returns it and the rest, whatever follows. At most 18
/// digits.
#[inline]
pub(super) fn integer(text: &[u8]) -> Option<(i64, &[u8])> {
    let (negative, unsigned) = sign(text);
    let (value, rest) = digits(0, unsigned);
    (1..=18).contains(&(unsigned.len() - rest.len())).then_some(())?;
    Some((if negative { -(value as i64) } else { value as i64 }, rest))
}

#[inline]
fn sign(text: &[u8]) -> (bool, &[u8]) {
    match text {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, text),
    }
}

/// Appends the digits at the beginning of `text` to `value`, modulo 2^64, and returns the result and the
/// rest.
#[inline]
fn digits(mut value: u64, mut text: &[u8]) -> (u64, &[u8]) {
    while let Some((chunk, behind)) = text.split_first_chunk::<8>() {
        // Digits become 0 to 9, and every other byte is at least 10.
        let bytes = u64::from_le_bytes(*chunk) ^ 0x3030_3030_3030_3030;
        // The topmost bit of a byte is set if the byte is no digit. A carry only reaches bytes behind such a
        // byte.
        let others = (bytes.wrapping_add(0x7676_7676_7676_7676) | bytes) & 0x8080_8080_8080_8080;
        if others == 0 {
            value = value.wrapping_mul(TENS[8]).wrapping_add(eight_digits(bytes));
            text = behind;
            continue;
        }
        let count = others.trailing_zeros() as usize / 8;
        if count > 0 {
            // Shift the digits to the end, so that zeros precede them.
            let low = eight_digits(bytes << (64 - 8 * count));
            value = value.wrapping_mul(TENS[count]).wrapping_add(low);
        }
        return (value, &text[count..]);
    }
    while let [byte @ b'0'..=b'9', rest @ ..] = text {
        value = value.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
        text = rest;
    }
    (value, text)
}

/// Returns the number of eight digits, the first in the lowest byte: combines pairs of digits, then fours,
/// then all.
#[inline]
fn eight_digits(bytes: u64) -> u64 {
    let pairs = bytes.wrapping_mul(10).wrapping_add(bytes >> 8);
    let low = (pairs & 0x0000_00FF_0000_00FF).wrapping_mul(100 + (1_000_000 << 32));
    let high = (pairs >> 16 & 0x0000_00FF_0000_00FF).wrapping_mul(1 + (10_000 << 32));
    low.wrapping_add(high) >> 32
}

/// Returns whether a byte after a number makes it invalid or longer.
#[inline]
pub(super) fn continues(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'+' | b'-' | b'_')
}

#[cold]
fn by_the_book(text: &[u8]) -> Option<(f64, &[u8])> {
    let length = text.iter().position(|&byte| !continues(byte)).unwrap_or(text.len());
    let (word, rest) = text.split_at(length);
    let value = core::str::from_utf8(word).ok()?.parse::<f64>().ok()?;
    value.is_finite().then_some((value, rest))
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use alloc::format;
    use alloc::string::String;
    use proptest::prelude::*;

    /// The reference implementation.
    fn slowly(text: &str) -> Option<f64> {
        text.parse::<f64>().ok().filter(|x| x.is_finite())
    }

    #[track_caller]
    fn check(text: &str) {
        for behind in ["", " ", "\n", "/", "\\", " 12345678", "#123456789", "\u{e9}", ",5", "\t1.5e7 9"] {
            let all = format!("{text}{behind}");
            let found = number(all.as_bytes());
            let expected = slowly(text).map(|value| (value.to_bits(), behind.as_bytes()));
            assert_eq!(found.map(|(value, rest)| (value.to_bits(), rest)), expected, "{all:?}");
        }
    }

    #[test]
    fn numbers_of_all_kinds() {
        for text in [
            "0",
            "-0",
            "+0",
            "1",
            "12345678",
            "123456789",
            "1234567890123456789",
            "12345678901234567890",
            "9007199254740991",
            "9007199254740992",
            "9007199254740993",
            "-9007199254740993",
            "1.",
            ".5",
            "-.5",
            "+.5",
            "1e-3",
            "1E+05",
            "1e5",
            "1e22",
            "1e23",
            "1e-22",
            "1e-23",
            "123456e17",
            "4.35",
            "0.1",
            "0.3",
            "0.000001",
            "1.7976931348623157e308",
            "1e308",
            "1e309",
            "-1e999",
            "1e-400",
            "4.9e-324",
            "2.4e-324",
            "00000000000000000000000000000001",
            "0.00000000000000000000000000000000001",
            "1e0000000000000000001",
            "1e000000001",
            "8.41",
            "0.08156099999999999",
            "0.070710676908493042",
            "6.02214076e23",
            "",
            ".",
            "-",
            "+",
            "e5",
            ".e5",
            "1e",
            "1e+",
            "1e-",
            "--1",
            "+-1",
            "1..2",
            "1.2.3",
            "nan",
            "NaN",
            "inf",
            "-inf",
            "infinity",
            "1d3",
            "1f",
            "0x10",
            "1_000",
            "1e5e5",
            "1e5.5",
            "1-2",
            "1+2",
            "\u{661}",
            "12a",
        ] {
            check(text);
        }
    }

    #[test]
    fn words_that_go_on_are_no_numbers() {
        assert_eq!(number(b"1.5mm"), None);
        assert_eq!(number(b"1.5.5"), None);
        assert_eq!(number(b"1.5,5"), Some((1.5, &b",5"[..])));
    }

    #[test]
    fn integers() {
        let cases: [(&str, Option<(i64, &str)>); 9] = [
            ("1", Some((1, ""))),
            ("-12/3", Some((-12, "/3"))),
            ("+7 8", Some((7, " 8"))),
            ("123456789012345678 ", Some((123_456_789_012_345_678, " "))),
            ("1234567890123456789", None),
            ("000000000000000001x", Some((1, "x"))),
            ("", None),
            ("-", None),
            ("x", None),
        ];
        for (text, expected) in cases {
            assert_eq!(integer(text.as_bytes()), expected.map(|(i, rest)| (i, rest.as_bytes())), "{text}");
        }
    }

    #[test]
    fn digits_end_at_every_other_byte() {
        for byte in (0..=255u8).filter(|byte| !byte.is_ascii_digit()) {
            for place in 0..20 {
                let mut text = *b"98765432109876543210";
                text[place] = byte;
                let (value, rest) = digits(3, &text);
                let expected = [b"3", &text[..place]].concat();
                let expected: u128 = core::str::from_utf8(&expected).unwrap().parse().unwrap();
                assert_eq!((value, rest), (expected as u64, &text[place..]), "{byte} at {place}");
            }
        }
    }

    fn digit_runs(longest: usize) -> impl Strategy<Value = String> {
        proptest::collection::vec(b'0'..=b'9', 0..=longest).prop_map(|d| String::from_utf8(d).unwrap())
    }

    proptest! {
        #![proptest_config(leafless_testkit::cases(50_000))]

        #[test]
        fn decimals_round_as_by_the_book(
            sign in prop_oneof!["", "-", r"\+"],
            before in digit_runs(21),
            point in any::<bool>(),
            after in digit_runs(25),
            exponent in proptest::option::of(-330i32..330),
        ) {
            let mut text = sign + &before;
            if point {
                text = text + "." + &after;
            }
            if let Some(exponent) = exponent {
                text += &format!("e{exponent}");
            }
            check(&text);
        }

        #[test]
        fn printed_numbers_come_back(bits in any::<u64>(), narrow in any::<f32>()) {
            let (value, narrow) = (f64::from_bits(bits), f64::from(narrow));
            for value in [value, narrow] {
                check(&format!("{value}"));
                check(&format!("{value:e}"));
                check(&format!("{value:.6}"));
            }
        }

        #[test]
        fn any_characters(text in r"[-+.eE0-9nif/ a_]{0,12}") {
            let length = text.bytes().position(|b| !continues(b)).unwrap_or(text.len());
            let expected = slowly(&text[..length]).map(|value| (value.to_bits(), &text.as_bytes()[length..]));
            prop_assert_eq!(number(text.as_bytes()).map(|(x, rest)| (x.to_bits(), rest)), expected);
        }
    }
}
