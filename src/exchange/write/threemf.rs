//! 3MF packages of the core specification 1.x, one object each.

use super::lines::Number;
use crate::error::Error;
use crate::exchange::LengthUnit;
use crate::mesh::TriangleMesh;
use alloc::boxed::Box;
use alloc::vec::Vec;
use miniz_oxide::deflate::core::{
    CompressorOxide, TDEFLFlush, TDEFLStatus, compress_to_output, create_comp_flags_from_zip_params,
};
use rawzip::{CompressionMethod, ZipArchiveWriter};
use std::io::{self, Write};

const CONTENT_TYPES: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
    <Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\
    <Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\
    <Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n";

const RELATIONSHIPS: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
    <Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\
    <Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" \
    Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";

pub(super) fn write(mesh: &TriangleMesh, unit: LengthUnit) -> Result<Vec<u8>, Error> {
    // Writing to memory fails only for want of it.
    package(mesh, unit).map_err(|_| Error::OutOfMemory)
}

fn package(mesh: &TriangleMesh, unit: LengthUnit) -> io::Result<Vec<u8>> {
    let mut archive = ZipArchiveWriter::new(Bytes::default());
    part(&mut archive, "[Content_Types].xml", |out| out.write_all(CONTENT_TYPES.as_bytes()))?;
    part(&mut archive, "_rels/.rels", |out| out.write_all(RELATIONSHIPS.as_bytes()))?;
    part(&mut archive, "3D/3dmodel.model", |out| model(mesh, unit, &mut io::BufWriter::new(out)))?;
    Ok(archive.finish().map_err(io::Error::other)?.0)
}

/// Adds a part to a package.
fn part(
    archive: &mut ZipArchiveWriter<Bytes>,
    name: &str,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let file = archive.new_file(name).compression_method(CompressionMethod::DEFLATE);
    let (mut entry, config) = file.start().map_err(io::Error::other)?;
    let mut data = config.wrap(Deflate::new(&mut entry));
    write(&mut data)?;
    let (deflate, description) = data.finish().map_err(io::Error::other)?;
    deflate.finish()?;
    entry.finish(description).map_err(io::Error::other)?;
    Ok(())
}

fn model(mesh: &TriangleMesh, unit: LengthUnit, out: &mut impl Write) -> io::Result<()> {
    let unit = match unit {
        LengthUnit::Micrometre => "micron",
        LengthUnit::Millimetre => "millimeter",
        LengthUnit::Centimetre => "centimeter",
        LengthUnit::Metre => "meter",
        LengthUnit::Inch => "inch",
        LengthUnit::Foot => "foot",
    };
    write!(
        out,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{unit}\" xml:lang=\"en-US\" \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n\
         <metadata name=\"Application\">Leafless</metadata>\n"
    )?;
    let mut triangles = mesh.triangles().iter().filter(|[a, b, c]| a != b && b != c && c != a).peekable();
    // An object must have triangles.
    if triangles.peek().is_none() {
        writeln!(out, "<resources/>\n<build/>\n</model>")?;
        return out.flush();
    }
    write!(out, "<resources>\n<object id=\"1\" type=\"model\">\n<mesh>\n<vertices>\n")?;
    for vertex in mesh.vertices() {
        let [x, y, z] = vertex.map(Number);
        writeln!(out, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>")?;
    }
    write!(out, "</vertices>\n<triangles>\n")?;
    for [a, b, c] in triangles {
        writeln!(out, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>")?;
    }
    write!(
        out,
        "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"1\"/>\n</build>\n</model>\n"
    )?;
    out.flush()
}

/// Bytes that grow as long as there is memory.
#[derive(Default)]
struct Bytes(Vec<u8>);

impl Write for Bytes {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.try_reserve(bytes.len()).map_err(|_| io::ErrorKind::OutOfMemory)?;
        self.0.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Compresses what is written to it.
struct Deflate<W> {
    compressor: Box<CompressorOxide>,
    out: W,
}

impl<W: Write> Deflate<W> {
    fn new(out: W) -> Deflate<W> {
        // Level 6, no zlib header.
        let flags = create_comp_flags_from_zip_params(6, 0, 0);
        Deflate { compressor: Box::new(CompressorOxide::new(flags)), out }
    }

    fn compress(&mut self, bytes: &[u8], flush: TDEFLFlush) -> io::Result<usize> {
        let mut result = Ok(());
        let (status, taken) = compress_to_output(&mut self.compressor, bytes, flush, |compressed| {
            result = self.out.write_all(compressed);
            result.is_ok()
        });
        result?;
        match status {
            TDEFLStatus::Okay | TDEFLStatus::Done => Ok(taken),
            _ => Err(io::ErrorKind::Other.into()),
        }
    }

    fn finish(mut self) -> io::Result<()> {
        self.compress(&[], TDEFLFlush::Finish).map(drop)
    }
}

impl<W: Write> Write for Deflate<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.compress(bytes, TDEFLFlush::None)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
