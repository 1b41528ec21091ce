//! Named arrays in one file, as NumPy reads and writes them: NPZ, which is a ZIP of NPY files.

mod npy;
mod stored;

use miniz_oxide::inflate::decompress_slice_iter_to_slice;
use npy::Element;
use rawzip::{CompressionMethod, ZipArchive, ZipArchiveEntryWayfinder, ZipSliceArchive};
use std::borrow::Cow;
use std::io::{Error, ErrorKind, Result};
use stored::Archive;

/// The most bytes that one byte of compressed data expands to: DEFLATE expands two bits to at most 258 bytes.
const DEFLATE_RATIO: u64 = 1032;

/// An NPZ that is being written, without compression, so that its bytes depend on the arrays alone.
#[derive(Default)]
pub struct Arrays(Archive);

impl Arrays {
    /// Adds an array of this shape, with its elements in C order.
    pub fn add<T: Element>(&mut self, name: &str, shape: &[u64], elements: &[T]) {
        let mut bytes = Vec::new();
        npy::append(&mut bytes, shape, elements);
        self.0.add(format!("{name}.npy"), &bytes);
    }

    /// Returns the bytes of the file.
    pub fn finish(self) -> Vec<u8> {
        self.0.finish()
    }
}

/// An NPZ that is being read.
pub struct Reader<'a> {
    archive: ZipSliceArchive<&'a [u8]>,
    entries: Vec<Entry>,
}

struct Entry {
    name: Vec<u8>,
    way: ZipArchiveEntryWayfinder,
    method: CompressionMethod,
    is_encrypted: bool,
    crc: u32,
}

fn invalid(problem: impl Into<String>) -> Error {
    Error::new(ErrorKind::InvalidData, problem.into())
}

impl<'a> Reader<'a> {
    pub fn new(bytes: &'a [u8]) -> Result<Reader<'a>> {
        let damaged = |error: rawzip::Error| invalid(error.to_string());
        let archive = ZipArchive::from_slice(bytes).map_err(damaged)?;
        let mut entries = Vec::new();
        let mut records = archive.entries();
        while let Some(record) = records.next_entry().map_err(damaged)? {
            entries.push(Entry {
                name: record.file_path().as_bytes().to_vec(),
                way: record.wayfinder(),
                method: record.compression_method(),
                is_encrypted: record.flags().is_encrypted(),
                crc: record.crc32(),
            });
        }
        if entries.len() as u64 != archive.entries_hint() {
            return Err(invalid("the archive has another number of files than it says"));
        }
        Ok(Reader { archive, entries })
    }

    /// Returns the entries of arrays with this name.
    fn entries(&self, name: &str) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(move |entry| entry.name.strip_suffix(b".npy") == Some(name.as_bytes()))
    }

    /// True if there is an array with this name.
    pub fn has(&self, name: &str) -> bool {
        self.entries(name).next().is_some()
    }

    /// Returns the shape and the elements, in C order, of the array with a name.
    pub fn array<T: Element>(&self, name: &str) -> Result<(Vec<u64>, Vec<T>)> {
        let mut entries = self.entries(name);
        let entry = entries.next().ok_or_else(|| invalid(format!("has no array called {name}")))?;
        if entries.next().is_some() {
            return Err(invalid(format!("has two arrays called {name}")));
        }
        let found = self.content(entry).and_then(|bytes| npy::read(&bytes));
        found.map_err(|problem| invalid(format!("the array {name} {problem}")))
    }

    /// Returns the bytes of a file, after verifying its checksum.
    fn content(&self, entry: &Entry) -> std::result::Result<Cow<'_, [u8]>, String> {
        if entry.is_encrypted {
            return Err("is encrypted".into());
        }
        let found = self.archive.get_entry(entry.way).map_err(|error| format!("is damaged: {error}"))?;
        let data = found.data();
        let length = entry.way.uncompressed_size_hint();
        let content = match entry.method {
            CompressionMethod::STORE => Cow::Borrowed(data),
            CompressionMethod::DEFLATE => {
                // What a directory says must not decide how much memory is taken.
                if length > DEFLATE_RATIO.saturating_mul(data.len() as u64) {
                    return Err("is damaged: it is longer than its data can be".into());
                }
                let mut content = Vec::new();
                let length = usize::try_from(length).map_err(|error| error.to_string())?;
                content.try_reserve_exact(length).map_err(|error| format!("is too large: {error}"))?;
                content.resize(length, 0);
                let whole = decompress_slice_iter_to_slice(&mut content, [data].into_iter(), false, true);
                content.truncate(whole.unwrap_or(0));
                Cow::Owned(content)
            }
            _ => return Err("is compressed by another method than DEFLATE".into()),
        };
        if content.len() as u64 != length || crc32fast::hash(&content) != entry.crc {
            return Err("is damaged: its length or checksum is wrong".into());
        }
        Ok(content)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rawzip::ZipArchiveWriter;

    const CORNERS: [f64; 6] = [0.5, -1.0, 2.0, 1e300, f64::NAN, 0.1];

    fn sample() -> Vec<u8> {
        let mut arrays = Arrays::default();
        arrays.add("codes", &[3], &[1, u64::MAX, 7]);
        arrays.add("corners", &[2, 3], &CORNERS);
        arrays.add("edge", &[], &[16.0]);
        arrays.add("kinds", &[0], &[] as &[u8]);
        arrays.add("triangles", &[2], &[1u32, 2]);
        arrays.add("deep", &[1; 20], &[9u8]);
        arrays.finish()
    }

    fn check(bytes: &[u8]) {
        let reader = Reader::new(bytes).unwrap();
        assert_eq!(reader.array("codes").unwrap(), (vec![3], vec![1, u64::MAX, 7]));
        let (shape, corners) = reader.array::<f64>("corners").unwrap();
        assert_eq!(
            (shape, corners.iter().map(|x| x.to_bits()).collect()),
            (vec![2, 3], CORNERS.map(f64::to_bits).to_vec())
        );
        assert_eq!(reader.array("edge").unwrap(), (vec![], vec![16.0]));
        assert_eq!(reader.array::<u8>("kinds").unwrap(), (vec![0], vec![]));
        assert_eq!(reader.array("triangles").unwrap(), (vec![2], vec![1u32, 2]));
        assert!(reader.has("edge") && !reader.has("edge.npy") && !reader.has(""));
        assert!(reader.array::<u8>("edges").unwrap_err().to_string().contains("no array called edges"));
        assert!(
            reader.array::<u8>("edge").unwrap_err().to_string().starts_with("the array edge has elements")
        );
    }

    /// Returns the archive as other programs write it: compressed, with the lengths after the files.
    fn compressed(bytes: &[u8], method: CompressionMethod) -> Vec<u8> {
        let reader = Reader::new(bytes).unwrap();
        let mut archive = ZipArchiveWriter::new(Vec::new());
        for entry in &reader.entries {
            let name = std::str::from_utf8(&entry.name).unwrap();
            let (mut file, config) = archive.new_file(name).compression_method(method).start().unwrap();
            let content = reader.content(entry).unwrap();
            let mut sizes = config.wrap(std::io::sink());
            std::io::Write::write_all(&mut sizes, &content).unwrap();
            let (_, description) = sizes.finish().unwrap();
            let data = miniz_oxide::deflate::compress_to_vec(&content, 6);
            std::io::Write::write_all(&mut file, &data).unwrap();
            file.finish(description).unwrap();
        }
        archive.finish().unwrap()
    }

    /// Files stay the same from release to release.
    #[test]
    fn files_have_these_bytes() {
        let bytes = sample();
        assert_eq!((bytes.len(), crc32fast::hash(&bytes)), (1691, 0xcfe0_ca37));
        check(&bytes);
        check(&compressed(&bytes, CompressionMethod::DEFLATE));
    }

    #[test]
    fn damaged_files_are_refused() {
        let all = |bytes: &[u8]| -> Result<()> {
            let reader = Reader::new(bytes)?;
            reader.array::<u64>("codes")?;
            reader.array::<f64>("corners")?;
            reader.array::<f64>("edge")?;
            reader.array::<u8>("kinds")?;
            reader.array::<u32>("triangles").map(drop)
        };
        for bytes in [sample(), compressed(&sample(), CompressionMethod::DEFLATE)] {
            all(&bytes).unwrap();
            for length in 0..bytes.len() {
                assert!(all(&bytes[..length]).is_err(), "{length}");
            }
            // Some numbers of the headers mean nothing to the reader. None of them changes an array.
            for place in 0..bytes.len() {
                for change in [1, 0x10, 0x80, 0xFF] {
                    let mut changed = bytes.clone();
                    changed[place] ^= change;
                    if all(&changed).is_ok() {
                        check(&changed);
                    }
                }
            }
        }
        let other = compressed(&sample(), CompressionMethod::BZIP2);
        assert!(all(&other).unwrap_err().to_string().contains("another method than DEFLATE"));
        let mut twice = Arrays::default();
        twice.add("a", &[], &[1u8]);
        twice.add("a", &[], &[2u8]);
        let twice = twice.finish();
        let found = Reader::new(&twice).unwrap().array::<u8>("a").unwrap_err();
        assert_eq!(found.to_string(), "has two arrays called a");
        assert_eq!(Reader::new(b"").map(drop).unwrap_err().kind(), ErrorKind::InvalidData);
    }
}
