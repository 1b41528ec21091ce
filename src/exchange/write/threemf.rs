//! Writer of 3MF packages of the core specification 1.x: one object that is built as it is, or several placed
//! objects.

use super::WriteOptions;
use super::attributes::{self, Materials};
use super::lines::Number;
use crate::error::Error;
use crate::exchange::LengthUnit;
use crate::exchange::stated::{self, Shown};
use crate::exchange::threemf::model::DEVIATION;
use crate::lattice::Affine;
use crate::lattice::Each;
use crate::memory;
use crate::mesh::TriangleMesh;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::fmt::{self, Write as _};
use hashbrown::HashMap;
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

/// Returns a 3MF of several meshes, each built in any number of places. Each of `objects` becomes an object
/// with a name, which may be empty. Each of `items`, the number of an object and its placement, becomes a
/// build item with a transform.
///
/// Each object is stored once, however often it is placed. [`read_mesh`](crate::exchange::read_mesh) makes
/// one mesh of the whole build. An object without triangles, which the format forbids, is left out with its
/// items. The options `unit` and `deviation` are used; for colours and materials see
/// [`write_mesh`](crate::exchange::write_mesh).
///
/// O(n) time and memory.
///
/// # Errors
/// [`Error::Argument`] if an item has an invalid object number, if there are more than 2^30 objects, and for
/// a deviation that [`TriangleMesh::with_deviation`] refuses; [`Error::OutOfMemory`].
///
/// ```
/// use leafless::exchange::{read_mesh, write_placed_meshes};
/// use leafless::{Affine, TriangleMesh};
/// let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let mesh = TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let places = [(0, Affine::IDENTITY), (0, Affine::translation([5.0, 0.0, 0.0])?)];
/// let bytes = write_placed_meshes(&[("corner", &mesh)], &places, &Default::default())?;
/// let back = read_mesh(&bytes, &Default::default())?.mesh;
/// assert_eq!(back.bounds(), ([0.0; 3], [6.0, 1.0, 1.0]));
/// assert_eq!(back.volume(), 2.0 * mesh.volume());
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn write_placed_meshes(
    objects: &[(&str, &TriangleMesh)],
    items: &[(usize, Affine)],
    options: &WriteOptions,
) -> Result<Vec<u8>, Error> {
    stated::check(options.deviation)?;
    if items.iter().any(|&(object, _)| object >= objects.len()) {
        return Err(Error::Argument { name: "items", problem: "must name one of the objects" });
    }
    if objects.len() > 1 << 30 {
        return Err(Error::Argument { name: "objects", problem: "must not be more than 2^30" });
    }
    let mut all = memory::with_capacity(objects.len())?;
    for (name, mesh) in objects {
        all.push(Object { name, mesh, properties: Properties::of(mesh)? });
    }
    package(&all, items, options).map_err(|_| Error::OutOfMemory)
}

pub(super) fn write(mesh: &TriangleMesh, options: &WriteOptions) -> Result<Vec<u8>, Error> {
    let object = Object { name: "", mesh, properties: Properties::of(mesh)? };
    // Writing to memory fails only for lack of memory.
    package(&[object], &[(0, Affine::IDENTITY)], options).map_err(|_| Error::OutOfMemory)
}

/// An object to write.
struct Object<'a> {
    name: &'a str,
    mesh: &'a TriangleMesh,
    properties: Properties<'a>,
}

impl Object<'_> {
    /// Returns the triangles that a 3MF may contain, with their numbers.
    fn triangles(&self) -> impl Iterator<Item = (usize, &[u32; 3])> {
        self.mesh.triangles().iter().enumerate().filter(|(_, [a, b, c])| a != b && b != c && c != a)
    }

    /// Returns whether it has no such triangle.
    fn is_empty(&self) -> bool {
        self.triangles().next().is_none()
    }
}

fn package(objects: &[Object<'_>], items: &[(usize, Affine)], options: &WriteOptions) -> io::Result<Vec<u8>> {
    let mut archive = ZipArchiveWriter::new(Bytes::default());
    part(&mut archive, "[Content_Types].xml", |out| out.write_all(CONTENT_TYPES.as_bytes()))?;
    part(&mut archive, "_rels/.rels", |out| out.write_all(RELATIONSHIPS.as_bytes()))?;
    part(&mut archive, "3D/3dmodel.model", |out| {
        model(objects, items, options, &mut io::BufWriter::new(out))
    })?;
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

fn model(
    objects: &[Object<'_>],
    items: &[(usize, Affine)],
    options: &WriteOptions,
    out: &mut impl Write,
) -> io::Result<()> {
    let unit = match options.unit.unwrap_or(LengthUnit::Millimetre) {
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
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\""
    )?;
    // A private name needs a namespace.
    if options.deviation.is_some() {
        write!(out, " xmlns:leafless=\"urn:leafless\"")?;
    }
    if objects.iter().any(|object| matches!(object.properties, Properties::Colours { .. })) {
        write!(out, " xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\"")?;
    }
    write!(out, ">\n<metadata name=\"Application\">Leafless</metadata>\n")?;
    if let Some(deviation) = options.deviation {
        writeln!(out, "<metadata name=\"{DEVIATION}\">{}</metadata>", Shown(deviation))?;
    }
    // An object must have triangles.
    if objects.iter().all(Object::is_empty) {
        writeln!(out, "<resources/>\n<build/>\n</model>")?;
        return out.flush();
    }
    writeln!(out, "<resources>")?;
    for (number, object) in objects.iter().enumerate().filter(|(_, object)| !object.is_empty()) {
        object.write(number, out)?;
    }
    write!(out, "</resources>\n<build>\n")?;
    for (number, placement) in items.iter().filter(|(number, _)| !objects[*number].is_empty()) {
        write!(out, "<item objectid=\"{}\"", id(*number))?;
        if !placement.is_identity() {
            // (Transposed, because a 3MF multiplies row vectors.)
            let rows = placement.rows();
            for column in 0..4 {
                let [x, y, z] = rows.each(|row| Number(row[column]));
                write!(out, "{}{x} {y} {z}", if column == 0 { " transform=\"" } else { " " })?;
            }
            write!(out, "\"")?;
        }
        writeln!(out, "/>")?;
    }
    write!(out, "</build>\n</model>\n")?;
    out.flush()
}

/// Returns the identifier of an object; its properties have the next identifier.
fn id(number: usize) -> usize {
    2 * number + 1
}

impl Object<'_> {
    fn write(&self, number: usize, out: &mut impl Write) -> io::Result<()> {
        let (Object { name, mesh, properties }, id) = (self, id(number));
        let group = id + 1;
        properties.group(group, out)?;
        write!(out, "<object id=\"{id}\" type=\"model\"")?;
        if !name.is_empty() {
            write!(out, " name=\"{}\"", Escaped(name))?;
        }
        // Properties that all triangles have should also be stated for the object.
        if properties.have_all(mesh.triangles().len()) {
            write!(out, " pid=\"{group}\" pindex=\"0\"")?;
        }
        write!(out, ">\n<mesh>\n<vertices>\n")?;
        for vertex in mesh.vertices() {
            let [x, y, z] = vertex.each(Number);
            writeln!(out, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>")?;
        }
        write!(out, "</vertices>\n<triangles>\n")?;
        for (place, [a, b, c]) in self.triangles() {
            write!(out, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"")?;
            match properties.get(place) {
                Some([p, q, r]) if p != q || p != r => {
                    write!(out, " pid=\"{group}\" p1=\"{p}\" p2=\"{q}\" p3=\"{r}\"")?;
                }
                Some([p, ..]) => write!(out, " pid=\"{group}\" p1=\"{p}\"")?,
                None => {}
            }
            writeln!(out, "/>")?;
        }
        write!(out, "</triangles>\n</mesh>\n</object>\n")
    }
}

/// A text as an attribute's value. Characters that XML forbids become blanks.
struct Escaped<'a>(&'a str);

impl fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for c in self.0.chars() {
            match c {
                '&' => f.write_str("&amp;")?,
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                '"' => f.write_str("&quot;")?,
                '\0'..=' ' | '\u{FFFE}' | '\u{FFFF}' => f.write_char(' ')?,
                other => f.write_char(other)?,
            }
        }
        Ok(())
    }
}

/// The properties of triangles.
enum Properties<'a> {
    None,
    /// Base materials, and their display colours.
    Materials(Materials<'a>, Vec<[u8; 4]>),
    /// Colours, and the colour number of each corner.
    Colours {
        colours: Vec<[u8; 4]>,
        corners: Vec<Option<[u32; 3]>>,
    },
}

impl<'a> Properties<'a> {
    fn of(mesh: &'a TriangleMesh) -> Result<Properties<'a>, Error> {
        /// The display colour of a material without a colour.
        const GREY: [u8; 4] = [128, 128, 128, 255];
        let (all, colours) = (0..mesh.triangles().len(), attributes::of_corners(mesh));
        let materials = Materials::of(mesh)?;
        if let Some(materials) = materials.filter(|materials| all.clone().any(|t| materials.get(t).is_some()))
        {
            let mut shown = memory::filled(materials.names.len(), None)?;
            for triangle in all {
                if let (Some(material), Some(colours)) = (materials.get(triangle), &colours) {
                    let own: &mut Option<[u8; 4]> = &mut shown[material];
                    *own = own.or_else(|| colours(triangle).map(|corners| corners[0]));
                }
            }
            let shown = memory::collected(shown.into_iter().map(|colour| colour.unwrap_or(GREY)))?;
            return Ok(Properties::Materials(materials, shown));
        }
        let Some(of_corners) = colours else { return Ok(Properties::None) };
        let (mut known, mut colours) = (HashMap::new(), Vec::new());
        let mut corners = memory::with_capacity(all.len())?;
        for triangle in all {
            let Some(own) = of_corners(triangle) else {
                corners.push(None);
                continue;
            };
            let mut rows = [0; 3];
            for (row, colour) in rows.iter_mut().zip(own) {
                known.try_reserve(1)?;
                let next = colours.len() as u32;
                *row = *known.entry(colour).or_insert(next);
                if *row == next {
                    memory::push(&mut colours, colour)?;
                }
            }
            corners.push(Some(rows));
        }
        Ok(if colours.is_empty() { Properties::None } else { Properties::Colours { colours, corners } })
    }

    /// Returns the properties of a triangle's corners.
    fn get(&self, triangle: usize) -> Option<[u32; 3]> {
        match self {
            Properties::None => None,
            Properties::Materials(materials, _) => {
                materials.get(triangle).map(|material| [material as u32; 3])
            }
            Properties::Colours { corners, .. } => corners[triangle],
        }
    }

    fn have_all(&self, triangles: usize) -> bool {
        !matches!(self, Properties::None) && (0..triangles).all(|triangle| self.get(triangle).is_some())
    }

    /// Writes the group of properties.
    fn group(&self, id: usize, out: &mut impl Write) -> io::Result<()> {
        match self {
            Properties::None => Ok(()),
            Properties::Materials(materials, shown) => {
                writeln!(out, "<basematerials id=\"{id}\">")?;
                for (name, [r, g, b, a]) in materials.names.iter().zip(shown) {
                    write!(out, "<base name=\"{}", Escaped(name))?;
                    writeln!(out, "\" displaycolor=\"#{r:02X}{g:02X}{b:02X}{a:02X}\"/>")?;
                }
                writeln!(out, "</basematerials>")
            }
            Properties::Colours { colours, .. } => {
                writeln!(out, "<m:colorgroup id=\"{id}\">")?;
                for [r, g, b, a] in colours {
                    writeln!(out, "<m:color color=\"#{r:02X}{g:02X}{b:02X}{a:02X}\"/>")?;
                }
                writeln!(out, "</m:colorgroup>")
            }
        }
    }
}

/// Bytes with fallible growth.
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

/// A writer that compresses its input.
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
