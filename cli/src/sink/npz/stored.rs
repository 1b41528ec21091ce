//! ZIP archives of uncompressed files.
//!
//! The time is always the same, so that equal files make equal archives. The lengths of a file stand before
//! it, always with 64 bits, for programs that read an archive from its beginning. (`rawzip` writes them after
//! it.)

/// The first version of ZIP with numbers of 64 bits.
const VERSION: u16 = 45;
/// Who wrote it: a program that knows this version, on Unix.
const MADE_BY: u16 = 3 << 8 | VERSION;
/// The first day that ZIP knows: 1 January 1980.
const DATE: u16 = 1 << 5 | 1;
/// A file that its owner may write, and everybody may read.
const ATTRIBUTES: u32 = 0o100_644 << 16;
/// Stands for a number that follows in a field of 64 bits.
const ELSEWHERE: u32 = u32::MAX;

/// An archive that is being written.
#[derive(Default)]
pub struct Archive {
    bytes: Vec<u8>,
    entries: Vec<Entry>,
}

struct Entry {
    name: String,
    crc: u32,
    length: u64,
    /// Where its header begins.
    offset: u64,
}

impl Archive {
    /// Adds a file.
    pub fn add(&mut self, name: String, content: &[u8]) {
        let (crc, length) = (crc32fast::hash(content), content.len() as u64);
        let entry = Entry { name, crc, length, offset: self.bytes.len() as u64 };
        let bytes = &mut self.bytes;
        bytes.extend(b"PK\x03\x04");
        entry.append_description(bytes, 2);
        bytes.extend(entry.name.as_bytes());
        append_wide(bytes, &[length, length]);
        bytes.extend(content);
        self.entries.push(entry);
    }

    /// Returns the bytes of the archive.
    pub fn finish(mut self) -> Vec<u8> {
        let start = self.bytes.len() as u64;
        append_directory(&mut self.bytes, &self.entries, start);
        self.bytes
    }
}

impl Entry {
    /// Appends the part that is the same in its header and in the directory. `wide` numbers of 64 bits follow
    /// the name.
    fn append_description(&self, bytes: &mut Vec<u8>, wide: u16) {
        let name = u16::try_from(self.name.len()).expect("the name is short");
        // No flags, no compression, midnight.
        append16(bytes, &[VERSION, 0, 0, 0, DATE]);
        append32(bytes, &[self.crc, ELSEWHERE, ELSEWHERE]);
        append16(bytes, &[name, 4 + 8 * wide]);
    }
}

/// Appends the directory of entries, which begins at `start`, and the end of the archive.
fn append_directory(bytes: &mut Vec<u8>, entries: &[Entry], start: u64) {
    let before = bytes.len();
    for entry in entries {
        let is_near = entry.offset < u64::from(ELSEWHERE);
        let wide = [entry.length, entry.length, entry.offset];
        let wide = if is_near { &wide[..2] } else { &wide[..] };
        bytes.extend(b"PK\x01\x02");
        append16(bytes, &[MADE_BY]);
        entry.append_description(bytes, wide.len() as u16);
        // No comment, the first disk, no internal attributes.
        append16(bytes, &[0, 0, 0]);
        append32(bytes, &[ATTRIBUTES, narrow(entry.offset)]);
        bytes.extend(entry.name.as_bytes());
        append_wide(bytes, wide);
    }
    let (count, length) = (entries.len() as u64, (bytes.len() - before) as u64);
    if start >= u64::from(ELSEWHERE) {
        bytes.extend(b"PK\x06\x06");
        append64(bytes, &[44]);
        append16(bytes, &[VERSION, VERSION]);
        append32(bytes, &[0, 0]);
        append64(bytes, &[count, count, length, start]);
        // Where the part before begins, on the first of one disk.
        bytes.extend(b"PK\x06\x07");
        append32(bytes, &[0]);
        append64(bytes, &[start + length]);
        append32(bytes, &[1]);
    }
    let count = u16::try_from(count).expect("an archive has few files");
    bytes.extend(b"PK\x05\x06");
    append16(bytes, &[0, 0, count, count]);
    append32(bytes, &[narrow(length), narrow(start)]);
    append16(bytes, &[0]);
}

/// Returns the number, if 32 bits hold it, or else that it is elsewhere.
fn narrow(number: u64) -> u32 {
    u32::try_from(number).unwrap_or(ELSEWHERE)
}

/// Appends the extra field of numbers of 64 bits.
fn append_wide(bytes: &mut Vec<u8>, numbers: &[u64]) {
    append16(bytes, &[1, 8 * numbers.len() as u16]);
    append64(bytes, numbers);
}

fn append16(bytes: &mut Vec<u8>, numbers: &[u16]) {
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
}

fn append32(bytes: &mut Vec<u8>, numbers: &[u32]) {
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
}

fn append64(bytes: &mut Vec<u8>, numbers: &[u64]) {
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
}

#[cfg(test)]
mod tests {
    use super::*;
    use rawzip::{RECOMMENDED_BUFFER_SIZE, ReaderAt, ZipLocator};

    /// The end of an archive, after zeros.
    struct End {
        start: u64,
        bytes: Vec<u8>,
    }

    impl ReaderAt for End {
        fn read_at(&self, buffer: &mut [u8], offset: u64) -> std::io::Result<usize> {
            let mut length = 0;
            for (byte, place) in buffer.iter_mut().zip(offset..self.start + self.bytes.len() as u64) {
                *byte = place.checked_sub(self.start).map_or(0, |k| self.bytes[k as usize]);
                length += 1;
            }
            Ok(length)
        }
    }

    #[test]
    fn archives_may_be_longer_than_32_bits_tell() {
        let edge = u64::from(u32::MAX);
        for start in [1 << 20, edge - 1, edge, edge + 1, 1 << 40] {
            let entry = |name: &str, offset| Entry { name: name.into(), crc: 7, length: start / 2, offset };
            let entries = [entry("first", 0), entry("last", start - 64)];
            let mut bytes = Vec::new();
            append_directory(&mut bytes, &entries, start);
            let end = start + bytes.len() as u64;
            let mut buffer = vec![0; RECOMMENDED_BUFFER_SIZE];
            let located = ZipLocator::new().locate_in_reader(End { start, bytes }, &mut buffer, end);
            let archive = located.map_err(|(_, error)| error).unwrap();
            assert_eq!(archive.entries_hint(), 2);
            let mut records = archive.entries(&mut buffer);
            for entry in entries {
                let record = records.next_entry().unwrap().unwrap();
                assert_eq!(record.file_path().as_bytes(), entry.name.as_bytes());
                let lengths = (record.compressed_size_hint(), record.uncompressed_size_hint());
                assert_eq!(lengths, (entry.length, entry.length));
                assert_eq!((record.local_header_offset(), record.crc32()), (entry.offset, 7), "{start}");
            }
            assert!(records.next_entry().unwrap().is_none());
        }
    }
}
