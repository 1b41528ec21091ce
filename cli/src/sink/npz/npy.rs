//! NPY: an array as a file. A header, which is a dictionary in Python's notation, states the type of the
//! elements, their order and the shape. The elements follow.

use winnow::Parser;
use winnow::ascii::{digit1, multispace0};
use winnow::combinator::{alt, delimited, eof, opt, separated, terminated};
use winnow::error::EmptyError;
use winnow::token::take_till;

const MAGIC: &[u8] = b"\x93NUMPY";
/// The elements begin at a multiple of this.
const ALIGNMENT: usize = 64;
/// Most characters of a foreign header that a message shows.
const SHOWN: usize = 80;

/// A type of elements.
pub trait Element: Copy {
    /// NumPy's name of the type, without the order of the bytes.
    const NAME: &'static str;
    const SIZE: usize;
    fn append(self, bytes: &mut Vec<u8>);
    /// Returns the element in [`Self::SIZE`] bytes.
    fn of(bytes: &[u8], is_big_endian: bool) -> Self;
}

macro_rules! element {
    ($type:ty, $name:literal) => {
        impl Element for $type {
            const NAME: &'static str = $name;
            const SIZE: usize = size_of::<$type>();

            fn append(self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }

            fn of(bytes: &[u8], is_big_endian: bool) -> Self {
                let mut own = [0; size_of::<$type>()];
                own.copy_from_slice(bytes);
                if is_big_endian { Self::from_be_bytes(own) } else { Self::from_le_bytes(own) }
            }
        }
    };
}

element!(u8, "u1");
element!(u32, "u4");
element!(u64, "u8");
element!(f64, "f8");

/// Appends the file of an array of this shape, with its elements in C order.
pub fn append<T: Element>(bytes: &mut Vec<u8>, shape: &[u64], elements: &[T]) {
    assert_eq!(shape.iter().product::<u64>(), elements.len() as u64, "the shape is that of the elements");
    let order = if T::SIZE == 1 { '|' } else { '<' };
    let sides: String = shape.iter().map(|side| format!("{side}, ")).collect();
    let mut header =
        format!("{{'descr': '{order}{}', 'fortran_order': False, 'shape': ({sides}), }}", T::NAME);
    // The magic, two bytes of the version, two bytes of the length; a line feed at the end.
    let start = MAGIC.len() + 4;
    let padded = (start + header.len() + 1).next_multiple_of(ALIGNMENT) - start;
    header.extend(std::iter::repeat_n(' ', padded - 1 - header.len()));
    header.push('\n');
    let length = u16::try_from(padded).expect("NumPy has at most 64 dimensions");
    bytes.reserve_exact(start + padded + elements.len() * T::SIZE);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&[1, 0]);
    bytes.extend_from_slice(&length.to_le_bytes());
    bytes.extend_from_slice(header.as_bytes());
    for &element in elements {
        element.append(bytes);
    }
}

/// Returns the shape and the elements, in C order. An error says what the array has or is.
pub fn read<T: Element>(bytes: &[u8]) -> Result<(Vec<u64>, Vec<T>), String> {
    let (text, rest) = split(bytes)?;
    let Header { descr, fortran_order, shape } = header(text).ok_or_else(|| {
        let shown: String = text.trim_end().chars().take(SHOWN).collect();
        format!("has a header without descr, fortran_order and shape of a plain array: {shown}")
    })?;
    let is_big_endian = match descr.strip_suffix(T::NAME) {
        Some("<") => false,
        Some(">") => true,
        Some("|") if T::SIZE == 1 => false,
        _ => return Err(format!("has elements of type {descr}, and they must be of type {}", T::NAME)),
    };
    if fortran_order && shape.len() > 1 {
        return Err("is in Fortran order, and must be in C order (numpy.ascontiguousarray)".into());
    }
    let size = shape.iter().try_fold(T::SIZE as u64, |size, &side| size.checked_mul(side));
    if size != Some(rest.len() as u64) {
        let shape: Vec<String> = shape.iter().map(u64::to_string).collect();
        let shape = shape.join(", ");
        return Err(format!("has the shape ({shape}) and another number of bytes, {}", rest.len()));
    }
    let elements = rest.chunks_exact(T::SIZE).map(|bytes| T::of(bytes, is_big_endian)).collect();
    Ok((shape, elements))
}

/// Returns the text of the header, and the bytes after it.
fn split(bytes: &[u8]) -> Result<(&str, &[u8]), String> {
    let Some((&version, rest)) = bytes.strip_prefix(MAGIC).and_then(|rest| rest.split_first_chunk::<2>())
    else {
        return Err("is no array: it does not begin as an NPY file does".into());
    };
    let parts = match version {
        [1, 0] => {
            rest.split_first_chunk().map(|(&length, rest)| (u32::from(u16::from_le_bytes(length)), rest))
        }
        [2 | 3, 0] => rest.split_first_chunk().map(|(&length, rest)| (u32::from_le_bytes(length), rest)),
        [major, minor] => {
            return Err(format!("has version {major}.{minor} of NPY, and 1.0, 2.0 and 3.0 are known"));
        }
    };
    let parts = parts.and_then(|(length, rest)| rest.split_at_checked(usize::try_from(length).ok()?));
    let (text, rest) = parts.ok_or("ends within its header")?;
    Ok((std::str::from_utf8(text).map_err(|_| "has a header that is no text")?, rest))
}

#[derive(Debug, PartialEq)]
struct Header<'t> {
    descr: &'t str,
    fortran_order: bool,
    shape: Vec<u64>,
}

enum Value<'t> {
    Text(&'t str),
    Truth(bool),
    Shape(Vec<u64>),
}

type Parsed<O> = Result<O, EmptyError>;

/// Returns the header, unless a key is missing, unknown or has a value of another type.
fn header(text: &str) -> Option<Header<'_>> {
    let (mut descr, mut fortran_order, mut shape) = (None, None, None);
    let item = (terminated(quoted, sign(':')), value).verify_map(|item| {
        match item {
            ("descr", Value::Text(found)) => descr = Some(found),
            ("fortran_order", Value::Truth(found)) => fortran_order = Some(found),
            ("shape", Value::Shape(found)) => shape = Some(found),
            _ => return None,
        }
        Some(())
    });
    let items = delimited(sign('{'), list(item), sign('}'));
    delimited(multispace0, items, eof).parse(text).ok()?;
    Some(Header { descr: descr?, fortran_order: fortran_order?, shape: shape? })
}

/// Returns the parser of a character and the space after it.
fn sign<'t>(sign: char) -> impl Parser<&'t str, char, EmptyError> {
    terminated(sign, multispace0)
}

/// Parses a text in quotes without escape sequences.
fn quoted<'t>(input: &mut &'t str) -> Parsed<&'t str> {
    let single = delimited('\'', take_till(0.., ['\'', '\\']), '\'');
    let double = delimited('"', take_till(0.., ['"', '\\']), '"');
    terminated(alt((single, double)), multispace0).parse_next(input)
}

/// Returns the parser of any number of items with commas between them, and perhaps behind the last.
fn list<'t>(item: impl Parser<&'t str, (), EmptyError>) -> impl Parser<&'t str, (), EmptyError> {
    let items = separated::<_, _, (), _, _, _, _>(1.., item, sign(','));
    opt((items, opt(sign(',')))).void()
}

fn shape(input: &mut &str) -> Parsed<Vec<u64>> {
    let mut sides = Vec::new();
    let open = alt((sign('(').value(')'), sign('[').value(']'))).parse_next(input)?;
    let number = terminated(digit1, multispace0).verify_map(|digits: &str| digits.parse().ok());
    terminated(list(number.map(|side| sides.push(side))), sign(open)).parse_next(input)?;
    Ok(sides)
}

fn value<'t>(input: &mut &'t str) -> Parsed<Value<'t>> {
    let truth = alt(("True".value(true), "False".value(false)));
    alt((quoted.map(Value::Text), terminated(truth, multispace0).map(Value::Truth), shape.map(Value::Shape)))
        .parse_next(input)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(version: [u8; 2], header: &str, elements: &[u8]) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(version);
        let length = (header.len() as u32).to_le_bytes();
        bytes.extend(&length[..if version[0] == 1 { 2 } else { 4 }]);
        bytes.extend(header.as_bytes());
        bytes.extend(elements);
        bytes
    }

    #[test]
    fn arrays_are_read_back() {
        fn check<T: Element + PartialEq + std::fmt::Debug>(shape: &[u64], elements: &[T]) {
            let mut bytes = Vec::new();
            append(&mut bytes, shape, elements);
            assert_eq!((bytes.len() - size_of_val(elements)) % ALIGNMENT, 0);
            assert_eq!(read(&bytes).unwrap(), (shape.to_vec(), elements.to_vec()));
            for length in 0..bytes.len() {
                assert!(read::<T>(&bytes[..length]).is_err(), "{length}");
            }
        }
        check(&[], &[7.5]);
        check(&[3], &[1u8, 2, 3]);
        check(&[2, 1], &[1u32, u32::MAX]);
        check(&[2, 0], &[] as &[u64]);
        for dimensions in 1..=64 {
            check(&vec![1; dimensions], &[u64::MAX - 1]);
        }
    }

    #[test]
    fn headers_are_read_as_python_writes_them() {
        for (version, header) in [
            ([1, 0], "{'descr': '<u4', 'fortran_order': False, 'shape': (2, 1), }      \n"),
            ([2, 0], "{'descr':'<u4','fortran_order':False,'shape':(2,1)}"),
            ([3, 0], " { \"shape\" : [ 2 , 1 , ] , \"fortran_order\" : False , \"descr\" : \"<u4\" , } "),
        ] {
            let bytes = file(version, header, &[1, 0, 0, 0, 2, 0, 0, 0]);
            assert_eq!(read(&bytes).unwrap(), (vec![2, 1], vec![1u32, 2]), "{header}");
        }
        let big = file([1, 0], "{'descr': '>u4', 'fortran_order': True, 'shape': (1,)}", &[0, 0, 1, 2]);
        assert_eq!(read(&big).unwrap(), (vec![1], vec![258u32]));
        let byte = file([1, 0], "{'descr': '<u1', 'fortran_order': False, 'shape': ()}", &[9]);
        assert_eq!(read(&byte).unwrap(), (vec![], vec![9u8]));
    }

    #[test]
    fn arrays_that_are_none_are_refused() {
        let plain = "{'descr': '<f8', 'fortran_order': False, 'shape': (1,)}";
        let deep = "(".repeat(60_000);
        for (header, problem) in [
            ("", "descr, fortran_order and shape"),
            ("{}", "descr, fortran_order and shape"),
            ("{'descr': '<f8', 'shape': (1,)}", "descr, fortran_order and shape"),
            (&plain.replace("descr", "kind"), "'kind'"),
            (&plain.replace("'<f8'", "[('a', '<f8')]"), "[('a', '<f8')]"),
            (&plain.replace("'<f8'", "<f8"), "plain array"),
            (&plain.replace("False", "0"), "plain array"),
            (&plain.replace("(1,)", "(-1,)"), "plain array"),
            (&plain.replace("(1,)", "(1 1)"), "plain array"),
            (&plain.replace("(1,)", "(,)"), "plain array"),
            (&plain.replace("(1,)", "(18446744073709551616,)"), "plain array"),
            (&plain.replace('}', "} 1"), "plain array"),
            (&plain.replace("(1,)", &deep), "plain array"),
            (&plain.replace("<f8", "|f8"), "|f8"),
            (&plain.replace("<f8", "<f4"), "<f4"),
            (&plain.replace("<f8", "O"), "type O"),
            (&plain.replace("(1,)", "(2,)"), "(2) and another number of bytes, 8"),
            (&plain.replace("(1,)", "(1, 0)"), "(1, 0) and another number of bytes"),
            (&plain.replace("(1,)", "(4294967296, 4294967296)"), "another number of bytes"),
            (&plain.replace("(1,)", "(9223372036854775808, 2)"), "another number of bytes"),
            (&plain.replace("(1,)", "(1, 1)").replace("False", "True"), "Fortran"),
        ] {
            let found = read::<f64>(&file([1, 0], header, &[0; 8])).unwrap_err();
            assert!(found.contains(problem), "{header}: {found}");
            assert!(found.len() < 300, "{found}");
        }
        assert!(read::<f64>(&file([1, 0], plain, &[0; 8])).is_ok());
        assert!(read::<f64>(&file([4, 0], plain, &[0; 8])).unwrap_err().contains("4.0"));
        let mut latin = file([1, 0], plain, &[0; 8]);
        latin[12] = 0xE9;
        assert!(read::<f64>(&latin).unwrap_err().contains("no text"));
        let long = [MAGIC, &[2, 0], &[255; 4], plain.as_bytes()].concat();
        assert!(read::<f64>(&long).unwrap_err().contains("within its header"));
    }
}
