//! Named arrays in one file, as NumPy reads and writes them: NPZ, which is a ZIP of NPY files.

use npyz::{AutoSerialize, Deserialize, NpyFile, NpyHeader, Order, WriteOptions, WriterBuilder};
use std::io::{Cursor, Error, ErrorKind, Read, Result, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// An NPZ that is being written, without compression, so that its bytes depend on the arrays alone.
pub struct Arrays(ZipWriter<Cursor<Vec<u8>>>);

impl Arrays {
    pub fn new() -> Arrays {
        Arrays(ZipWriter::new(Cursor::new(Vec::new())))
    }

    /// Adds an array of this shape, with its elements in C order.
    pub fn add<T: AutoSerialize + Copy>(&mut self, name: &str, shape: &[u64], elements: &[T]) -> Result<()> {
        let options =
            SimpleFileOptions::default().compression_method(CompressionMethod::Stored).large_file(true);
        self.0.start_file(format!("{name}.npy"), options)?;
        let mut bytes = Vec::new();
        let mut array = WriteOptions::new().default_dtype().shape(shape).writer(&mut bytes).begin_nd()?;
        array.extend(elements.iter().copied())?;
        array.finish()?;
        self.0.write_all(&bytes)
    }

    /// Returns the bytes of the file.
    pub fn finish(self) -> Result<Vec<u8>> {
        Ok(self.0.finish()?.into_inner())
    }
}

/// An NPZ that is being read.
pub struct Reader<'a>(ZipArchive<Cursor<&'a [u8]>>);

fn invalid(problem: String) -> Error {
    Error::new(ErrorKind::InvalidData, problem)
}

impl Reader<'_> {
    pub fn new(bytes: &[u8]) -> Result<Reader<'_>> {
        Ok(Reader(ZipArchive::new(Cursor::new(bytes))?))
    }

    /// True if there is an array with this name.
    pub fn has(&self, name: &str) -> bool {
        self.0.index_for_name(&format!("{name}.npy")).is_some()
    }

    /// Returns the shape and the elements, in C order, of the array with a name.
    pub fn array<T: Deserialize>(&mut self, name: &str) -> Result<(Vec<u64>, Vec<T>)> {
        let mut entry = match self.0.by_name(&format!("{name}.npy")) {
            Ok(entry) => entry,
            Err(_) => return Err(invalid(format!("has no array called {name}"))),
        };
        let mut bytes = Vec::new();
        // A compressed array may be longer than it claims.
        let said = entry.size();
        entry.by_ref().take(said).read_to_end(&mut bytes)?;
        let mut rest = &bytes[..];
        let header = NpyHeader::from_reader(&mut rest)?;
        let shape = header.shape().to_vec();
        let count = shape.iter().try_fold(1u64, |product, &side| product.checked_mul(side));
        // So that the elements never exceed the bytes in the file.
        let size = header.dtype().num_bytes().filter(|&size| size > 0);
        let fits = count.zip(size).and_then(|(count, size)| count.checked_mul(size as u64));
        if fits != Some(rest.len() as u64) || (shape.len() > 1 && header.order() != Order::C) {
            return Err(invalid(format!("the array {name} has another size or order than it says")));
        }
        Ok((shape, NpyFile::with_header(header, rest).into_vec()?))
    }
}
