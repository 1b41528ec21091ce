//! Reading and writing of files: Leafless's own and those of other programs.

use crate::arguments::{Argument, named};
use crate::csg::scene;
use crate::dexels::TriDexel;
use crate::error::{OrRaise, called, refused};
use crate::mesh::Mesh;
use crate::note;
use crate::octree::Octree;
use crate::picture::Picture;
use crate::volume::{Threshold, Volume, band, threshold};
use crate::words;
use crate::work::{Limits, afford};
use leafless::Error;
use leafless::error::FormatError;
use leafless::exchange::{
    self, LengthUnit, MeshFile, MeshFormat, MeshOptions, NrrdEncoding, VolumeFile, VolumeFormat, WriteOptions,
};
use leafless::file::{self, dexels};
use leafless::scene::is_scene;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::{PyTypeError, PyUserWarning};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::ffi::CString;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

/// The size of a file's header, and the place of its checksum, which covers the checksums of all sections.
const HEADER: usize = 128;
const CHECKSUM: std::ops::Range<usize> = 124..128;

/// The kinds of content.
#[derive(Clone, Copy)]
enum Content {
    Solid,
    Volume,
    Mesh,
    Scene,
}

/// Detects the kind of a file: from the content where that is conclusive, else from the name.
fn content(bytes: &[u8], name: &Path) -> Option<Content> {
    let extension = name.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    if bytes.starts_with(&file::MAGIC) || extension == "lfl" {
        Some(Content::Solid)
    } else if VolumeFormat::detect(bytes).is_some() {
        Some(Content::Volume)
    } else if MeshFormat::detect(bytes, None).is_some() {
        Some(Content::Mesh)
    } else if is_scene(bytes) || ["csg", "scad"].iter().any(|scene| extension.eq_ignore_ascii_case(scene)) {
        Some(Content::Scene)
    } else {
        MeshFormat::from_extension(extension).map(|_| Content::Mesh)
    }
}

/// The keyword arguments for reading meshes and volumes: `fill`, `unit`, `to_unit`, `scale`, `sew`,
/// `threshold`; and limits.
struct Taking<'py> {
    fill: leafless::FillRule,
    options: MeshOptions,
    threshold: Option<Bound<'py, PyAny>>,
    sew: bool,
    limits: Limits,
}

impl<'py> Taking<'py> {
    fn of(py: Python<'py>, given: Option<&Bound<'py, PyDict>>) -> PyResult<Taking<'py>> {
        let mut taking = Taking {
            fill: leafless::FillRule::NonZero,
            options: MeshOptions::default(),
            threshold: None,
            sew: true,
            limits: Limits::default(),
        };
        let limits = PyDict::new(py);
        for (name, value) in given.into_iter().flat_map(|given| given.iter()) {
            if value.is_none() {
                continue;
            }
            let unit = |name| {
                let unit = <&str>::take(&value, name)?.parse::<LengthUnit>();
                unit.map_err(called([("unit", name)])).or_raise(py)
            };
            match name.extract::<&str>()? {
                "fill" => taking.fill = words::value(py, <&str>::take(&value, "fill")?)?,
                "unit" => taking.options.unit = Some(unit("unit")?),
                "to_unit" => taking.options.target = Some(unit("to_unit")?),
                "scale" => taking.options.scale = Argument::take(&value, "scale")?,
                "sew" => taking.sew = Argument::take(&value, "sew")?,
                "threshold" => taking.threshold = Some(value),
                _ => limits.set_item(name, value)?,
            }
        }
        taking.limits = Limits::of(Some(&limits))?;
        Ok(taking)
    }
}

/// Reads the object in the bytes of a file. `name` gives the format where the content does not, and errors
/// contain it. Other files that the file names lie in `folder`.
#[pyfunction]
#[pyo3(signature = (data, name, folder=None, **taking))]
pub fn open_bytes<'py>(
    py: Python<'py>,
    data: &[u8],
    name: PathBuf,
    folder: Option<PathBuf>,
    taking: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let taking = Taking::of(py, taking)?;
    let (limits, of_file) = (&taking.limits, |error: Error| error.of_file(&name));
    limits.run_here(py, |control| afford(control, "the file", data.len() as u64))?;
    match content(data, &name) {
        Some(Content::Solid) => limits.run(py, |_| stored(data))?.into_object(py, None),
        Some(Content::Volume) => {
            let found = py.detach(|| exchange::read_volume(data, None).map_err(of_file)).or_raise(py)?;
            volume(py, found, &taking, note::threshold(data))
        }
        Some(Content::Mesh) => {
            let options = &taking.options;
            let found = limits.run(py, |_| exchange::read_mesh(data, options).map_err(of_file))?;
            mesh(py, found, &taking)
        }
        Some(Content::Scene) => {
            let text = std::str::from_utf8(data).map_err(|_| refused(py, "data", "is no text in UTF-8"))?;
            scene(py, text, folder.as_deref(), &name, limits)
        }
        None => Err(unknown(py, &name)),
    }
}

fn unknown(py: Python<'_>, name: &Path) -> PyErr {
    let kinds = "a solid (.lfl), nor a mesh (STL, OBJ, PLY, OFF, 3MF), nor a scene (.csg), nor a volume (NRRD, MetaImage)";
    let name = name.display();
    refused(py, "path", format!("{name}: neither the content nor the name is that of {kinds}"))
}

/// Reads the object in the file at a path.
#[pyfunction]
#[pyo3(signature = (path, **taking))]
pub fn open_path<'py>(
    py: Python<'py>,
    path: PathBuf,
    taking: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let taken = Taking::of(py, taking)?;
    let limits = &taken.limits;
    let (bytes, content) = limits.run_here(py, |control| {
        // A pipe has no known length.
        let length = std::fs::metadata(&path).map_or(0, |metadata| metadata.len());
        afford(control, "the file", length)?;
        let bytes = exchange::read_whole(&path).map_err(|error| error.of_file(&path))?;
        let content = content(&bytes, &path);
        Ok((bytes, content))
    })?;
    if let Some(Content::Solid) = content {
        let found = limits.run(py, |_| stored(&bytes).map_err(|error| error.of_file(&path)))?;
        return found.into_object(py, None);
    }
    if let Some(Content::Volume) = content {
        // Samples may lie in a separate file beside the header.
        let found = py.detach(|| exchange::open_volume(&path)).or_raise(py)?;
        return volume(py, found, &taken, note::threshold(&bytes));
    }
    let folder = path.parent().map(Path::to_path_buf);
    open_bytes(py, &bytes, path, folder, taking)
}

/// A stored solid.
enum Stored {
    Octree(leafless::Octree),
    TriDexel(leafless::TriDexel),
}

impl Stored {
    fn into_object(self, py: Python<'_>, mapped: Option<(PathBuf, u64)>) -> PyResult<Bound<'_, PyAny>> {
        match self {
            Stored::Octree(octree) => Ok(Octree::of_file(py, octree, mapped)?.into_any()),
            Stored::TriDexel(model) => TriDexel { model, mapped }.into_bound_py_any(py),
        }
    }
}

/// Reads a solid of the first kind, or of the second if the file is not of the first.
fn either(
    octree: impl FnOnce() -> Result<leafless::Octree, Error>,
    model: impl FnOnce() -> Result<leafless::TriDexel, Error>,
) -> Result<Stored, Error> {
    match octree() {
        Err(error) if matches!(error.cause(), Error::Format(FormatError::OtherModel { .. })) => {
            model().map(Stored::TriDexel)
        }
        found => found.map(Stored::Octree),
    }
}

fn stored(bytes: &[u8]) -> Result<Stored, Error> {
    either(|| file::from_bytes(bytes), || dexels::from_bytes(bytes))
}

/// Maps the solid in a Leafless file. Nothing is copied, and only the queried parts are ever read. While the
/// object lives, the file may be replaced, but must not be shortened or written to. `verify=True` looks for
/// damage first, which reads the whole file. `checksum` refuses a file with another checksum.
#[pyfunction]
#[pyo3(name = "map_path", signature = (path, *, verify=false, checksum=None))]
pub fn map_path<'py>(
    py: Python<'py>,
    path: PathBuf,
    #[pyo3(from_py_with = named::verify)] verify: bool,
    checksum: Option<u64>,
) -> PyResult<Bound<'py, PyAny>> {
    let path = std::path::absolute(&path).map_err(|error| Error::Io(error).of_file(&path)).or_raise(py)?;
    let (own, found) = py.detach(|| {
        let before = header_checksum(&path);
        let found = either(
            // SAFETY: `leafless.map` requires that callers neither shorten the file nor write to it.
            #[allow(unsafe_code)]
            || unsafe { if verify { file::map_verified(&path) } else { file::map(&path) } },
            // SAFETY: as above.
            #[allow(unsafe_code)]
            || unsafe { if verify { dexels::map_verified(&path) } else { dexels::map(&path) } },
        );
        // If the file was replaced in between, the mapped file is not known.
        (before.filter(|_| header_checksum(&path) == before), found)
    });
    let found = found.or_raise(py)?;
    if checksum.is_some() && checksum != own {
        let path = path.display();
        return Err(refused(py, "checksum", format!("{path} is not the file that it was")));
    }
    found.into_object(py, own.map(|own| (path, own)))
}

/// Returns the checksum in the header of a file, which covers the checksums of all sections; `None` without a
/// header.
fn header_checksum(path: &Path) -> Option<u64> {
    // Opening a pipe would wait for its writer.
    std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file)?;
    let mut header = [0; HEADER];
    std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut header)).ok()?;
    Some(header[CHECKSUM].iter().rev().fold(0, |sum, &byte| sum << 8 | u64::from(byte)))
}

fn mesh<'py>(py: Python<'py>, found: MeshFile, taking: &Taking<'py>) -> PyResult<Bound<'py, PyAny>> {
    for warning in &found.warnings {
        let text = CString::new(warning.to_string().replace('\0', " "))?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
    }
    let unit = found.unit.map(|unit| unit.to_string());
    let mesh = if taking.sew { py.detach(|| found.mesh.sewn()).or_raise(py)? } else { found.mesh };
    Ok(Mesh::bound(py, mesh, taking.fill, unit, None)?.into_any())
}

/// Makes the volume of a file. `saved` is the threshold in the file's header, if there is one.
fn volume<'py>(
    py: Python<'py>,
    found: VolumeFile,
    taking: &Taking<'py>,
    saved: Option<Threshold>,
) -> PyResult<Bound<'py, PyAny>> {
    let told = match &taking.threshold {
        Some(given) => threshold(given)?,
        None => saved.unwrap_or((found.kind.half_range(), None)),
    };
    let band = band(py, told, taking.threshold.as_ref())?;
    let (samples, grid) = (found.samples, found.grid);
    let volume = taking.limits.run(py, |control| leafless::Volume::new(samples, &grid, band, control))?;
    let volume = Bound::new(py, Volume::initial(volume, false, false, told)?)?.into_any();
    match found.placement {
        None => Ok(volume),
        // A volume with other axes than x, y and z becomes an expression.
        Some(placement) => volume.call_method1("placed", (crate::affine::Affine(placement),)),
    }
}

/// Writes an object to the file at a path, whose name gives the format. The file is replaced atomically: at
/// any moment it is the old file or the new one.
#[pyfunction]
pub fn save_path(object: &Bound<'_, PyAny>, path: PathBuf) -> PyResult<()> {
    let py = object.py();
    let is_own = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("lfl"));
    if let Ok(octree) = object.cast::<Octree>()
        && is_own
    {
        let octree = octree.get().octree.clone();
        return Limits::default().run(py, |_| file::save(&octree, &path));
    }
    if let Ok(model) = object.cast::<TriDexel>()
        && is_own
    {
        let model = model.get().model.clone();
        return Limits::default().run(py, |_| dexels::save(&model, &path));
    }
    let bytes = save_bytes(object, path.clone())?;
    let bytes = bytes.as_bytes();
    Limits::default().run(py, |_| file::replace(&path, |file| Ok(file.write_all(bytes)?)))
}

/// Returns the bytes of an object's file, in the format that the name gives.
#[pyfunction]
pub fn save_bytes<'py>(object: &Bound<'py, PyAny>, name: PathBuf) -> PyResult<Bound<'py, PyBytes>> {
    let py = object.py();
    let extension =
        name.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_lowercase();
    let wrong = |kinds: &str| {
        let name = name.display();
        Err(refused(py, "path", format!("{name}: the name must end in {kinds}")))
    };
    let bytes = if let Ok(octree) = object.cast::<Octree>() {
        return if extension == "lfl" { octree.get().to_bytes(py) } else { wrong(".lfl") };
    } else if let Ok(model) = object.cast::<TriDexel>() {
        if extension != "lfl" {
            return wrong(".lfl");
        }
        let model = &model.get().model;
        py.detach(|| dexels::to_bytes(model)).or_raise(py)?
    } else if let Ok(mesh) = object.cast::<Mesh>() {
        let Some(format) = MeshFormat::from_extension(&extension) else {
            return wrong(".stl, .obj, .ply, .off or .3mf");
        };
        let own = mesh.get();
        let unit = own.unit.as_deref().and_then(|unit| unit.parse().ok());
        let options = WriteOptions { unit, deviation: own.deviation(), ..WriteOptions::default() };
        Limits::default().run(py, |_| exchange::write_mesh(&own.mesh, format, &options))?
    } else if let Ok(volume) = object.cast::<Volume>() {
        if extension != "nrrd" {
            return wrong(".nrrd");
        }
        let (volume, threshold) = (volume.get().volume.clone(), volume.get().threshold);
        Limits::default().run(py, |_| {
            let mut file = exchange::write_nrrd(volume.samples(), volume.grid(), NrrdEncoding::Gzip)?;
            note::add(&mut file, threshold);
            Ok(file)
        })?
    } else if let Ok(picture) = object.cast::<Picture>() {
        return if extension == "png" { picture.get().to_png(py) } else { wrong(".png") };
    } else {
        let kind = object.get_type().name()?;
        return Err(PyTypeError::new_err(format!(
            "object: a {kind} has no file of its own: build makes an Octree of a solid, and surface a Mesh"
        )));
    };
    Ok(PyBytes::new(py, &bytes))
}
