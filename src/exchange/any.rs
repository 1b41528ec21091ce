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

/// Options for reading a mesh file. The default takes everything from the file and changes nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshOptions {
    /// The file's format; `None`: [detected](MeshFormat::detect).
    pub format: Option<MeshFormat>,
    /// The unit of the numbers in the file; overrides the unit that the file states. `None`: the unit that
    /// the file states, which only a 3MF does.
    pub unit: Option<LengthUnit>,
    /// The unit of the resulting mesh; `None`: the unit of the file, without conversion.
    pub target: Option<LengthUnit>,
    /// An additional factor for all coordinates, from 2^-256 to 2^256.
    pub scale: f64,
}

impl Default for MeshOptions {
    fn default() -> Self {
        Self { format: None, unit: None, target: None, scale: 1.0 }
    }
}

/// A mesh from a file, with further data of the file.
#[non_exhaustive]
#[derive(Debug, Clone)]
pub struct MeshFile {
    /// The mesh, converted and scaled, with the colours and materials of the file as its
    /// [attributes](TriangleMesh::attributes).
    pub mesh: TriangleMesh,
    /// The format of the file.
    pub format: MeshFormat,
    /// The unit of the mesh's coordinates (apart from [`MeshOptions::scale`]), if it is known.
    pub unit: Option<LengthUnit>,
    /// Number of instances of objects that the file does not declare as solid, such as supports. The mesh
    /// does not contain them. 0 for all formats but 3MF.
    pub skipped: u64,
    /// The deviation that the file states, converted and scaled like the coordinates: the maximum distance of
    /// the true boundary from the mesh. Only a PLY, OBJ, OFF or 3MF that was written with
    /// [`WriteOptions::deviation`](super::WriteOptions::deviation) states one. The reader does not apply it.
    /// A caller who trusts the file sets it with [`TriangleMesh::with_deviation`].
    pub deviation: Option<f64>,
    /// Departures of the file from its format that did not prevent reading.
    pub warnings: Vec<MeshWarning>,
}

/// Reads a mesh file of any format.
///
/// [`read_stl`] and its neighbours document the formats. The whole file becomes one mesh, whose equal
/// vertices are welded. The reader does not check that the mesh is closed.
///
/// A conversion of units and the scale are applied together, as one product and, if the factor is no whole
/// number, one quotient. Coordinates of up to 40 bits (which include all of binary STL) are therefore the
/// exact result rounded once. Without conversion and scale, or if they cancel, coordinates stay as they are,
/// bit by bit.
///
/// A file that departs from its format in a way that leaves no doubt about the mesh is read, and
/// [`MeshFile::warnings`] lists the departures.
///
/// O(n).
///
/// # Errors
/// [`Error::Argument`] for a scale out of range, [`MeshFileError::UnknownFormat`],
/// [`MeshFileError::UnknownUnit`] if a conversion is requested and neither the options nor the file state the
/// unit, [`MeshFileError::Unsupported`] for text in UTF-16 and for a format that was left out of this build,
/// [`MeshError::TooLarge`](crate::error::MeshError::TooLarge) if scaling exceeds ±2^256, and the reader's
/// errors.
pub fn read_mesh(bytes: &[u8], options: &MeshOptions) -> Result<MeshFile, Error> {
    read(bytes, None, options)
}

/// Reads a mesh file of any format from a path, whose extension helps to detect the format.
///
/// Reads as [`read_mesh`] does. Errors of the file are the cause of an [`Error::File`] with the path. They
/// are those of [`read_mesh`], [`Error::Io`], and [`Error::Limit`] for a pipe or a device with more than 1
/// GiB.
#[cfg(feature = "std")]
pub fn open_mesh(path: impl AsRef<std::path::Path>, options: &MeshOptions) -> Result<MeshFile, Error> {
    let path = path.as_ref();
    let extension = path.extension().and_then(|extension| extension.to_str());
    let bytes = super::read_whole(path);
    bytes.and_then(|bytes| read(&bytes, extension, options)).map_err(|error| error.of_file(path))
}

fn read(bytes: &[u8], extension: Option<&str>, options: &MeshOptions) -> Result<MeshFile, Error> {
    // Check the scale before any work is done.
    Factor::new(None, options.scale)?;
    if bytes.is_empty() {
        return Err(MeshFileError::Empty.into());
    }
    if options.format != Some(MeshFormat::ThreeMf) {
        // Before the format is detected, because the bytes of such a text do not show it.
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
    // (Rounded up. A value that is too large says nothing.)
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
        // Coordinates that become too small to compute with coincide.
        let near = read_mesh(&triangle(0.5), &with(None, None, 1e-77)).unwrap();
        let report = near.mesh.report().unwrap();
        assert_eq!((report.triangles, report.degenerate, report.vertices, report.welded), (0, 1, 2, 1));
    }

    #[test]
    fn counts_outlive_a_scale() {
        // Two triangles with a common edge, and one without extent.
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
        // Warnings reach the caller.
        let strange = [&ply[..21], b"by hand\n", &ply[21..]].concat();
        let file = read_mesh(&strange, &MeshOptions::default()).unwrap();
        assert_eq!(file.warnings, [MeshWarning::HeaderLine { line: 3, lines: 1 }]);
    }

    /// The content alone identifies the format of every model file.
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

    /// The reader of every format recognises text in UTF-16.
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
