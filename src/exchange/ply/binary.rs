//! Binary elements of a PLY, in both byte orders.

use alloc::vec::Vec;

use super::indices::{Indices, vertex};
use super::number_kind::NumberKind;
use super::source::Source;
use crate::error::{Error, MeshFileError};
use crate::exchange::bytes::Bytes;

/// Adds the indices `items`, which are next in `source`.
#[inline]
fn read_indices<const BIG: bool, const N: usize>(
    source: &Bytes<BIG>,
    out: &mut Vec<u32>,
    items: &[u8],
    of: &Indices,
    vertices: u64,
    value: impl Fn([u8; N]) -> i64,
) -> Result<(), Error> {
    out.try_reserve(items.len() / N)?;
    for (k, item) in items.as_chunks::<N>().0.iter().enumerate() {
        let index = value(Bytes::<BIG>::in_order(*item));
        let Some(index) = vertex(index, of, vertices) else {
            return Err(source.index_error(k * N, index, vertices).into());
        };
        out.push(index);
    }
    Ok(())
}

impl<const BIG: bool> Source for Bytes<'_, BIG> {
    fn error(&self, expected: &'static str) -> MeshFileError {
        Bytes::error(self, expected)
    }

    fn at_most(&self, _: usize, bytes: usize) -> usize {
        self.rest().len() / bytes.max(1)
    }

    #[inline]
    fn coordinate(&mut self, kind: NumberKind) -> Result<f64, MeshFileError> {
        let start = *self;
        self.value(kind)?.ok_or_else(|| start.error("a finite number"))
    }

    #[inline]
    fn value(&mut self, kind: NumberKind) -> Result<Option<f64>, MeshFileError> {
        let number = match kind {
            NumberKind::F32 => f64::from(f32::from_le_bytes(self.number()?)),
            NumberKind::F64 => f64::from_le_bytes(self.number()?),
            _ => integer(self, kind)? as f64,
        };
        Ok(Some(number).filter(|number| number.is_finite()))
    }

    #[inline]
    fn count(&mut self, kind: NumberKind) -> Result<u64, MeshFileError> {
        let start = *self;
        u64::try_from(integer(self, kind)?).map_err(|_| start.error("the length of a list"))
    }

    #[inline]
    fn skip(&mut self, _: u64, bytes: u64) -> Result<(), MeshFileError> {
        self.take(bytes).map(drop)
    }

    #[inline]
    fn indices(&mut self, out: &mut Vec<u32>, count: u64, of: &Indices, vertices: u64) -> Result<(), Error> {
        let start = *self;
        // No overflow: a length has at most 32 bits.
        let items = self.take(count * of.kind.size() as u64)?;
        match of.kind {
            NumberKind::I8 => read_indices(&start, out, items, of, vertices, |b| i8::from_le_bytes(b).into()),
            NumberKind::U8 => read_indices(&start, out, items, of, vertices, |b| u8::from_le_bytes(b).into()),
            NumberKind::I16 => {
                read_indices(&start, out, items, of, vertices, |b| i16::from_le_bytes(b).into())
            }
            NumberKind::U16 => {
                read_indices(&start, out, items, of, vertices, |b| u16::from_le_bytes(b).into())
            }
            NumberKind::I32 => {
                read_indices(&start, out, items, of, vertices, |b| i32::from_le_bytes(b).into())
            }
            NumberKind::U32 => {
                read_indices(&start, out, items, of, vertices, |b| u32::from_le_bytes(b).into())
            }
            NumberKind::F32 | NumberKind::F64 => Err(start.error("integers").into()),
        }
    }

    #[inline]
    fn end_element(&mut self, _: &Self, _: Option<u64>) -> Result<u64, MeshFileError> {
        Ok(0)
    }

    fn line(&self) -> u64 {
        0
    }

    fn end_file(&mut self) -> Result<(), MeshFileError> {
        self.end()
    }
}

#[inline]
fn integer<const BIG: bool>(source: &mut Bytes<BIG>, kind: NumberKind) -> Result<i64, MeshFileError> {
    Ok(match kind {
        NumberKind::I8 => i8::from_le_bytes(source.number()?).into(),
        NumberKind::U8 => u8::from_le_bytes(source.number()?).into(),
        NumberKind::I16 => i16::from_le_bytes(source.number()?).into(),
        NumberKind::U16 => u16::from_le_bytes(source.number()?).into(),
        NumberKind::I32 => i32::from_le_bytes(source.number()?).into(),
        NumberKind::U32 => u32::from_le_bytes(source.number()?).into(),
        NumberKind::F32 | NumberKind::F64 => return Err(source.error("an integer")),
    })
}

#[cfg(test)]
mod tests {
    use super::super::read_ply;
    use super::super::samples::{
        CORNERS, FLOATS, FORMATS, INTS, assert_binary, assert_tetrahedron, bytes_of, file, header_length,
        plain, singles,
    };
    use super::*;
    use alloc::string::String;
    use alloc::{format, vec};

    #[test]
    fn binary_data() {
        for (big, format) in [(false, FORMATS[1]), (true, FORMATS[2])] {
            let bytes = plain(format);
            let start = header_length(&bytes);
            for tail in [&b"\n"[..], b"\r\n\0\0\0", b"\x1A"] {
                assert_tetrahedron([&bytes[..], tail].concat(), 0.125);
            }
            assert_binary(&[&bytes[..], b"\0x"].concat(), bytes.len(), "longer");
            for length in start..bytes.len() {
                assert_binary(&bytes[..length], length, "shorter");
            }
            let change = |at: usize, new: &[u8]| {
                let mut changed = bytes.clone();
                changed[at..at + new.len()].copy_from_slice(new);
                changed
            };
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                assert_binary(&change(start + 8, &bytes_of(value, "float", big)), start + 8, "finite");
            }
            let faces = start + 48;
            assert_binary(&change(faces, &[2]), faces, "three vertices");
            assert_binary(&change(faces, &[255]), bytes.len(), "shorter");
            for index in [-1, 4, i32::MAX, i32::MIN] {
                let changed = change(faces + 5, &bytes_of(index.into(), "int", big));
                match read_ply(&changed) {
                    Err(Error::MeshFile(MeshFileError::BinaryIndex {
                        offset,
                        index: found,
                        vertices: 4,
                    })) => {
                        assert_eq!((offset, found), (faces as u64 + 5, index.into()));
                    }
                    other => panic!("{other:?}"),
                }
            }
            // Counts that exceed the file.
            for name in ["vertex", "face"] {
                let (header, data) = bytes.split_at(start);
                let header = core::str::from_utf8(header).unwrap();
                let header = header.replace(&format!("{name} 4"), &format!("{name} 4000000000"));
                let changed = [header.as_bytes(), data].concat();
                assert!(read_ply(&changed).is_err());
            }
            // Lists of negative and of huge lengths.
            let list = |count: f64| {
                let mut bytes = file(
                    format,
                    &[
                        ("vertex", &FLOATS, singles(&CORNERS)),
                        ("face", &["list int double a", INTS[0]], vec![]),
                    ],
                );
                let text =
                    String::from_utf8_lossy(&bytes[..header_length(&bytes)]).replace("face 0", "face 1");
                let rest = bytes.split_off(header_length(&bytes));
                [text.as_bytes(), &rest, &bytes_of(count, "int", big)].concat()
            };
            let length = list(0.).len();
            assert_binary(&list(-1.), length - 4, "length of a list");
            assert_binary(&list(f64::from(i32::MAX)), length, "shorter");
            assert_binary(&list(0.), length, "shorter");
        }
    }
}
