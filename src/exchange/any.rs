//! Mesh files of any format, in any unit.

use super::detect::MeshFormat;
use super::stl::read_stl;
#[cfg(feature = "threemf")]
use super::threemf;
use super::unit::{Factor, LengthUnit};
use super::{MeshWarning, refuse_utf16, stated};
#[cfg(feature = "std")]
use super::{ply, read_obj, read_off};
use crate::error::{Error, MeshFileError};
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;

/// How a mesh file is to be taken. The default takes everything from the file and changes nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshOptions {
    /// The file's format; `None`: [detected](MeshFormat::detect).
    pub format: Option<MeshFormat>,
    /// The unit of the numbers in the file. `None`: what the file says, which only a 3MF does. If given, it
    /// overrides that.
    pub unit: Option<LengthUnit>,
    /// The unit that the mesh shall have; `None`: that of the file, and no conversion.
    pub target: Option<LengthUnit>,
    /// What all coordinates are multiplied by besides, from 2^-256 to 2^256.
    pub scale: f64,
}

impl Default for MeshOptions {
    fn default() -> Self {
        Self { format: None, unit: None, target: None, scale: 1.0 }
    }
}

/// A mesh from a file, and what else the file says.
#[non_exhaustive]
#[derive(Debug, Clone)]
pub struct MeshFile {
    /// The mesh, converted and scaled, with the colours and materials of the file as its
    /// [attributes](TriangleMesh::attributes).
    pub mesh: TriangleMesh,
    /// The format that the file has.
    pub format: MeshFormat,
    /// The unit of the mesh's coordinates (apart from [`MeshOptions::scale`]), if it is known.
    pub unit: Option<LengthUnit>,
    /// Instances of objects that the file does not mean to be solid, such as supports, and that the mesh
    /// therefore does not contain. 0 for all formats but 3MF.
    pub skipped: u64,
    /// How far, as a PLY, OBJ, OFF or 3MF that was written with
    /// [`WriteOptions::deviation`](super::WriteOptions::deviation) says, the true boundary may lie from the
    /// mesh: converted and scaled as its coordinates are. The file is not believed:
    /// [`TriangleMesh::with_deviation`] states it, for who does.
    pub deviation: Option<f64>,
    /// Where the file departs from its format, though it could be read.
    pub warnings: Vec<MeshWarning>,
}

/// Reads a mesh file of any format.
///
/// What the single formats allow stands at [`read_stl`] and its neighbours. Everything in the file becomes
/// one mesh, whose vertices are welded where they are equal. That the mesh is closed is not checked.
///
/// A conversion of units and the scale are applied together: one product and, where the factor is no whole
/// number, one quotient, so that coordinates of up to 40 bits (all of binary STL are) are the exact result
/// rounded once. Without both, or if they cancel, coordinates stay as they are, bit by bit.
///
/// A file that departs from its format in a way that leaves no doubt about the mesh is read, and
/// [`MeshFile::warnings`] tells of it.
///
/// O(n).
///
/// # Errors
/// [`Error::Argument`] for a scale that is not allowed, [`MeshFileError::UnknownFormat`],
/// [`MeshFileError::UnknownUnit`] if a conversion is asked for and nobody says from which unit,
/// [`MeshFileError::Unsupported`] for text in UTF-16 and for a format that was left out of this build,
/// [`MeshError::TooLarge`](crate::error::MeshError::TooLarge) if scaling exceeds ±2^256, and the reader's
/// errors.
pub fn read_mesh(bytes: &[u8], options: &MeshOptions) -> Result<MeshFile, Error> {
    read(bytes, None, options)
}

/// Reads a mesh file of any format from a path, whose extension helps to tell the format.
///
/// As [`read_mesh`]. What is wrong with the file is the cause of an [`Error::File`] with the path, and may be
/// [`Error::Io`] besides, or [`Error::Limit`] for a pipe or a device that goes on after 1 GiB.
#[cfg(feature = "std")]
pub fn open_mesh(path: impl AsRef<std::path::Path>, options: &MeshOptions) -> Result<MeshFile, Error> {
    let path = path.as_ref();
    let extension = path.extension().and_then(|extension| extension.to_str());
    let bytes = super::read_whole(path);
    bytes.and_then(|bytes| read(&bytes, extension, options)).map_err(|error| error.of_file(path))
}

fn read(bytes: &[u8], extension: Option<&str>, options: &MeshOptions) -> Result<MeshFile, Error> {
    // Refused before any work is done.
    Factor::new(None, options.scale)?;
    if bytes.is_empty() {
        return Err(MeshFileError::Empty.into());
    }
    if options.format != Some(MeshFormat::ThreeMf) {
        // Before the format is detected, which the bytes of such a text do not tell.
        refuse_utf16(bytes)?;
    }
    let format = (options.format)
        .or_else(|| MeshFormat::detect(bytes, extension))
        .ok_or(MeshFileError::UnknownFormat)?;
    #[cfg_attr(not(feature = "std"), expect(unused_mut, reason = "only these formats warn"))]
    let mut warnings = Vec::new();
    let (mesh, own_unit, skipped, said) = match format {
        MeshFormat::Stl => (read_stl(bytes)?, None, 0, None),
        #[cfg(feature = "std")]
        MeshFormat::Obj => (read_obj(bytes)?, None, 0, None),
        #[cfg(feature = "std")]
        MeshFormat::Ply => (ply::read(bytes, &mut warnings)?, None, 0, None),
        #[cfg(feature = "std")]
        MeshFormat::Off => (read_off(bytes)?, None, 0, None),
        #[cfg(not(feature = "std"))]
        MeshFormat::Obj | MeshFormat::Ply | MeshFormat::Off => {
            let what = "polygons, for which the library was built without the feature `std`,";
            return Err(MeshFileError::Unsupported { what }.into());
        }
        #[cfg(feature = "threemf")]
        MeshFormat::ThreeMf => {
            let threemf::Built { mesh, unit, skipped, deviation } = threemf::read(bytes, &mut warnings)?;
            (mesh, Some(unit), skipped, deviation)
        }
        #[cfg(not(feature = "threemf"))]
        MeshFormat::ThreeMf => {
            let what = "3MF, for which the library was built without the feature `threemf`,";
            return Err(MeshFileError::Unsupported { what }.into());
        }
    };
    let said = said.or_else(|| stated::find(bytes, format));
    let unit = options.unit.or(own_unit);
    let conversion = match (unit, options.target) {
        (_, None) => None,
        (Some(from), Some(to)) => Some((from, to)),
        (None, Some(_)) => return Err(MeshFileError::UnknownUnit.into()),
    };
    let factor = Factor::new(conversion, options.scale)?;
    // (What is rounded is rounded up. What is too large says nothing.)
    let scaled = |said: f64| if said > 0.0 { factor.apply(said).next_up() } else { said };
    let deviation = if factor.is_one() { said } else { said.map(scaled).filter(|said| said.is_finite()) };
    let mesh = if factor.is_one() { mesh } else { mesh.scaled(|x| factor.apply(x))? };
    Ok(MeshFile { mesh, format, unit: options.target.or(unit), skipped, deviation, warnings })
}

#[cfg(test)]
mod tests {
    #[cfg(feature = "std")]
    use super::super::tests::models;
    use super::super::write_stl;
    use super::*;
    use crate::error::MeshError;
    use LengthUnit::*;
    use alloc::vec;
    use alloc::vec::Vec;

    fn triangle(x: f64) -> Vec<u8> {
        let corners = vec![[0.0; 3], [x, 0.0, 0.0], [0.0, -x, 1.5]];
        write_stl(&TriangleMesh::new(corners, vec![[0, 1, 2]]).unwrap()).unwrap()
    }

    fn with(unit: Option<LengthUnit>, target: Option<LengthUnit>, scale: f64) -> MeshOptions {
        MeshOptions { unit, target, scale, ..MeshOptions::default() }
    }

    #[test]
    fn units_and_scale() {
        let bytes = triangle(3.0);
        let plain = read_mesh(&bytes, &MeshOptions::default()).unwrap();
        assert_eq!((plain.format, plain.unit, plain.skipped), (MeshFormat::Stl, None, 0));
        assert_eq!(plain.mesh.vertices(), read_stl(&bytes).unwrap().vertices());
        for (unit, target, scale, expected, known) in [
            (None, None, 1.0, 3.0, None),
            (Some(Inch), None, 1.0, 3.0, Some(Inch)),
            (Some(Inch), Some(Inch), 1.0, 3.0, Some(Inch)),
            (Some(Inch), Some(Millimetre), 1.0, 76.2, Some(Millimetre)),
            (Some(Inch), Some(Millimetre), 10.0, 762.0, Some(Millimetre)),
            (Some(Millimetre), Some(Metre), 1.0, 0.003, Some(Metre)),
            (None, None, 0.5, 1.5, None),
        ] {
            let file = read_mesh(&bytes, &with(unit, target, scale)).unwrap();
            assert_eq!(file.mesh.vertices()[1], [expected, 0.0, 0.0], "{unit:?} {target:?} {scale}");
            assert_eq!(file.unit, known);
            assert_eq!(file.mesh.report().unwrap().facets_read, 1);
        }
        let result = read_mesh(&bytes, &with(None, Some(Millimetre), 1.0));
        assert!(matches!(result, Err(Error::MeshFile(MeshFileError::UnknownUnit))), "{result:?}");
        for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let result = read_mesh(&bytes, &with(None, None, scale));
            assert!(matches!(result, Err(Error::Argument { name: "scale", .. })), "{result:?}");
        }
        let far = read_mesh(&triangle(1e30), &with(None, None, 1e50));
        assert!(matches!(far, Err(Error::Mesh(MeshError::TooLarge { vertex: 1 }))), "{far:?}");
        // What becomes too small to compute with is one place.
        let near = read_mesh(&triangle(0.5), &with(None, None, 1e-77)).unwrap();
        let report = near.mesh.report().unwrap();
        assert_eq!((report.triangles, report.degenerate, report.vertices, report.welded), (0, 1, 2, 1));
    }

    #[test]
    fn counts_outlive_a_scale() {
        // Two triangles with an edge in common, and one of no extent.
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let [a, b, c, d] = square;
        let mesh = TriangleMesh::from_facets([[a, b, c], [a, c, d], [a, a, b]]).unwrap();
        let scaled = mesh.clone().scaled(|x| 2.0 * x).unwrap();
        assert_eq!(scaled.report().unwrap(), mesh.report().unwrap());
        assert_eq!(scaled.bounds(), ([0.0; 3], [2.0, 2.0, 0.0]));
        let flat = mesh.scaled(|_| 0.0).unwrap().report().unwrap();
        assert_eq!((flat.facets_read, flat.degenerate, flat.vertices, flat.welded), (3, 3, 1, 8));
    }

    #[test]
    fn each_format_is_read() {
        let obj = b"# one triangle\nv 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n";
        let off = b"OFF\n3 1 3\n0 0 0\n2 0 0\n0 2 0\n3 0 1 2\n";
        let ply = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
            element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n2 0 0\n0 2 0\n3 0 1 2\n";
        for (bytes, format) in
            [(&obj[..], MeshFormat::Obj), (&off[..], MeshFormat::Off), (&ply[..], MeshFormat::Ply)]
        {
            let file = read_mesh(bytes, &with(Some(Inch), Some(Foot), 1.0)).unwrap();
            assert_eq!((file.format, file.unit), (format, Some(Foot)));
            assert_eq!(file.mesh.vertices()[1], [2.0 / 12.0, 0.0, 0.0]);
            assert_eq!(file.mesh.triangles(), [[0, 1, 2]]);
            assert_eq!(file.warnings, []);
        }
        // What is warned of reaches the caller.
        let strange = [&ply[..21], b"by hand\n", &ply[21..]].concat();
        let file = read_mesh(&strange, &MeshOptions::default()).unwrap();
        assert_eq!(file.warnings, [MeshWarning::HeaderLine { line: 3, lines: 1 }]);
    }

    /// Every model file has the format that its name says, by its content alone.
    #[cfg(feature = "std")]
    #[test]
    fn model_files() {
        let Some(folder) = models() else { return };
        let mut count = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("");
            let Some(format) = MeshFormat::from_extension(extension) else { continue };
            assert_eq!(MeshFormat::detect(&std::fs::read(&path).unwrap(), None), Some(format), "{path:?}");
            let file = open_mesh(&path, &MeshOptions::default()).unwrap();
            assert!(file.format == format && !file.mesh.triangles().is_empty(), "{path:?}");
            count += 1;
        }
        assert!(count >= 12);
    }

    /// Text in UTF-16 is called so, by the reader of every format.
    #[cfg(feature = "std")]
    #[test]
    fn utf_16() {
        let texts = [
            ("solid a\nfacet normal 0 0 1\n", MeshFormat::Stl),
            ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", MeshFormat::Obj),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", MeshFormat::Off),
            ("ply\nformat ascii 1.0\nend_header\n", MeshFormat::Ply),
        ];
        for (text, format) in texts {
            for order in [u16::to_le_bytes, u16::to_be_bytes] {
                let units = core::iter::once(0xFEFF).chain(text.encode_utf16());
                let bytes: Vec<u8> = units.flat_map(order).collect();
                let as_such = MeshOptions { format: Some(format), ..MeshOptions::default() };
                for options in [MeshOptions::default(), as_such] {
                    let found = read_mesh(&bytes, &options);
                    let Err(Error::MeshFile(MeshFileError::Unsupported { what })) = found else {
                        panic!("{format}: {found:?}");
                    };
                    assert!(what.contains("UTF-16"), "{what}");
                }
            }
        }
        // A binary STL may begin with anything.
        let mut stl = triangle(1.0);
        stl[..2].copy_from_slice(b"\xFF\xFE");
        assert_eq!(read_mesh(&stl, &MeshOptions::default()).unwrap().mesh.triangles().len(), 1);
    }

    #[test]
    fn formats() {
        let bytes = triangle(1.0);
        let as_obj = MeshOptions { format: Some(MeshFormat::Obj), ..MeshOptions::default() };
        assert!(read_mesh(&bytes, &as_obj).is_err());
        let result = read_mesh(b"nothing known\n", &MeshOptions::default());
        assert!(matches!(result, Err(Error::MeshFile(MeshFileError::UnknownFormat))), "{result:?}");
        let result = read_mesh(b"", &as_obj);
        assert!(matches!(result, Err(Error::MeshFile(MeshFileError::Empty))), "{result:?}");
    }
}
