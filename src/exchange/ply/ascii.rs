//! ASCII elements of a PLY.

use alloc::vec::Vec;

use super::indices::{Indices, vertex};
use super::number_kind::NumberKind;
use super::source::Source;
use crate::error::{Error, MeshFileError};
use crate::exchange::bytes::{TOO_LONG, TOO_SHORT};
use crate::exchange::text::Text;
use crate::exchange::{decimal, is_line_end};
use crate::memory;

impl Source for Text<'_> {
    #[cold]
    fn error(&self, expected: &'static str) -> MeshFileError {
        let mut next = *self;
        next.skip_space();
        Text::error(&next, if next.is_at_end() { TOO_SHORT } else { expected })
    }

    fn at_most(&self, values: usize, _: usize) -> usize {
        // Each value but the last is followed by a separator.
        self.rest().len().div_ceil(2) / values.max(1)
    }

    #[inline]
    fn coordinate(&mut self, _: NumberKind) -> Result<f64, MeshFileError> {
        self.skip_space();
        self.number().ok_or_else(|| Source::error(self, "a finite number"))
    }

    #[inline]
    fn value(&mut self, _: NumberKind) -> Result<Option<f64>, MeshFileError> {
        self.skip_space();
        match self.word() {
            [] => Err(Text::error(self, TOO_SHORT)),
            word => Ok(decimal::number(word).filter(|(_, rest)| rest.is_empty()).map(|(number, _)| number)),
        }
    }

    #[inline]
    fn count(&mut self, _: NumberKind) -> Result<u64, MeshFileError> {
        self.skip_space();
        let start = *self;
        let count = self.integer().and_then(|count| u64::try_from(count).ok());
        count.ok_or_else(|| Source::error(&start, "the length of a list"))
    }

    #[inline]
    fn skip(&mut self, values: u64, _: u64) -> Result<(), MeshFileError> {
        for _ in 0..values {
            self.skip_space();
            if self.word().is_empty() {
                return Err(Text::error(self, TOO_SHORT));
            }
        }
        Ok(())
    }

    #[inline]
    fn indices(&mut self, out: &mut Vec<u32>, count: u64, of: &Indices, vertices: u64) -> Result<(), Error> {
        for _ in 0..count {
            self.skip_space();
            let start = *self;
            let index = self.integer().ok_or_else(|| Source::error(&start, "the index of a vertex"))?;
            let index = vertex(index, of, vertices).ok_or_else(|| MeshFileError::Index {
                line: start.line(),
                index,
                vertices,
            })?;
            memory::push(out, index)?;
        }
        Ok(())
    }

    #[inline]
    fn end_element(&mut self, start: &Self, more: Option<u64>) -> Result<u64, MeshFileError> {
        self.skip_blanks();
        match (self.is_at_line_end(), more) {
            (true, None | Some(0)) => Ok(0),
            _ => skip_more(self, start, more),
        }
    }

    fn line(&self) -> u64 {
        Text::line(self)
    }

    fn end_file(&mut self) -> Result<(), MeshFileError> {
        self.skip_space();
        if self.is_at_end() { Ok(()) } else { Err(Text::error(self, TOO_LONG)) }
    }
}

/// Takes values that the header does not announce, up to the end of the line.
#[cold]
fn skip_more(text: &mut Text, start: &Text, more: Option<u64>) -> Result<u64, MeshFileError> {
    let (behind, mut found) = (*text, 0);
    while !text.is_at_line_end() && text.number().is_some() {
        text.skip_blanks();
        found += 1;
    }
    let mut start = *start;
    start.skip_space();
    let element = &start.rest()[..start.rest().len() - behind.rest().len()];
    // An element of several lines may have taken its last value from the next element.
    let is_on_one_line = !element.iter().any(|&byte| is_line_end(byte));
    let as_many = more.is_none_or(|more| more == found);
    if text.is_at_line_end() && is_on_one_line && as_many {
        Ok(found)
    } else if found == 0 && more.is_some() && text.is_at_line_end() {
        Err(behind.error("more values on the line, as the elements before have them"))
    } else {
        Err(behind.error("the end of the line"))
    }
}

#[cfg(test)]
mod tests {
    use super::super::read_ply;
    use super::super::samples::{
        DATA, ascii, assert_syntax, assert_tetrahedron, header, header_length, warnings_of,
    };
    use super::*;
    use crate::error::MeshError;
    use crate::exchange::MeshWarning;
    use alloc::format;
    use alloc::string::ToString;

    #[test]
    fn ascii_data() {
        let text = ascii();
        let (header, data) = text.split_at(header_length(text.as_bytes()));
        for gap in ["  ", "\t", "\n", "\r\n\r\n"] {
            assert_tetrahedron(format!("{header}{}", data.replace(' ', gap)), 1e-3);
        }
        for end in ["\n\n", " \r\n", "\r", "\n   "] {
            assert_tetrahedron(format!("{header}{}", data.replace('\n', end)), 1e-3);
        }
        assert_tetrahedron(text.trim_end(), 1e-3);
        assert_tetrahedron(format!("{text}\n \r\n\x1A\0\0"), 1e-3);
        let change = |from: &str, to: &str| format!("{header}{}", data.replacen(from, to, 1));
        assert_syntax(change("1.5", "nan"), 11, "finite number");
        assert_syntax(change("1.5", "inf"), 11, "finite number");
        assert_syntax(change("1.5", "1.5x"), 11, "finite number");
        assert_syntax(change("1.5", "1d5"), 11, "finite number");
        assert_syntax(change("0 0 0", "0 0 0 0"), 11, "more values on the line");
        assert_syntax(change("0 0 0\n", "0 0\n"), 11, "end of the line");
        assert_syntax(change("3 0 2", "2 0 2"), 14, "three vertices");
        assert_syntax(change("3 0 2 1", "0"), 14, "three vertices");
        assert_syntax(change("3 0 2", "-3 0 2"), 14, "length of a list");
        assert_syntax(change("3 0 2", "3.0 0 2"), 14, "length of a list");
        assert_syntax(change("3 0 2 1", "4 0 2 1"), 15, "end of the line");
        assert_syntax(change("3 0 2 1", "3 0 x 1"), 14, "index");
        assert_syntax(change("3 0 2 1", "3 0 1.5 1"), 14, "index");
        assert_syntax(format!("{text}3 0 1 2\n"), 18, "longer than");
        for index in [-1, 4, 4_294_967_295, 4_294_967_296] {
            match read_ply(change("3 0 2 1", &format!("3 0 {index} 1")).as_bytes()) {
                Err(Error::MeshFile(MeshFileError::Index { line: 14, index: found, vertices: 4 })) => {
                    assert_eq!(found, index);
                }
                other => panic!("{other:?}"),
            }
        }
        for count in ["5", "4000000000"] {
            assert_syntax(text.replace("vertex 4", &format!("vertex {count}")), 14, "end of the line");
            assert_syntax(text.replace("face 4", &format!("face {count}")), 17, "shorter");
        }
        assert_syntax(
            text.replace("element face", "element other 0\nelement face").replace("face 4", "face 3"),
            18,
            "longer",
        );
        assert_syntax(
            text.replace("element face", "element other 9\nproperty int a\nelement face"),
            19,
            "shorter",
        );
        assert_syntax(
            text.replace("vertex 4", "vertex 4000000000").replace("face 4", "face 0"),
            14,
            "end of the line",
        );
        assert!(matches!(
            read_ply(change("1.5", "1e78").as_bytes()),
            Err(Error::Mesh(MeshError::TooLarge { vertex: 1 }))
        ));
    }

    #[test]
    fn more_values_than_the_header_announces() {
        let (vertices, faces) = DATA.split_at(DATA.find("3 0 2 1").unwrap());
        let head = header("ascii");
        let longer = |data: &str, more: &str| data.replace('\n', &format!("{more}\n"));
        let with = |v: &str, f: &str| head.clone() + &longer(vertices, v) + &longer(faces, f);
        assert_eq!(warnings_of(with("", ""), 1e-3), []);
        assert_eq!(warnings_of(with("  ", "\t"), 1e-3), []);
        let more = |line, lines| [MeshWarning::MoreValues { line, lines }];
        assert_eq!(warnings_of(with(" 255", ""), 1e-3), more(10, 4));
        assert_eq!(warnings_of(with("", " 255 0 0 "), 1e-3), more(14, 4));
        assert_eq!(warnings_of(with(" .5 -1e3 7", " 0"), 1e-3), more(10, 8));
        assert_eq!(warnings_of(with(" 1", "").replace('\n', "\r\n"), 1e-3), more(10, 4));
        // Different numbers of additional values, or no numbers: then the meaning of the values is ambiguous.
        assert_syntax(with(" 255", "").replacen("255", "255 0", 1), 11, "end of the line");
        assert_syntax(with(" 255", "").replacen("0 255", "0", 1), 11, "end of the line");
        assert_syntax(with(" red", ""), 10, "end of the line");
        // A value of the line before is missing.
        assert_syntax(with("", "").replacen("0 0 0\n", "0 0\n", 1), 11, "end of the line");
        let text = MeshWarning::MoreValues { line: 10, lines: 4 }.to_string();
        assert_eq!(
            text,
            "line 10 (like 3 more) has more values than the header announces; the last ones were skipped"
        );
    }
}
