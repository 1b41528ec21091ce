//! Rendering of pictures.

use crate::arguments::named;
use crate::arrays::{self, layout, required, shown};
use crate::ask::{self, FrameLike, Wish};
use crate::error::{OrRaise, called, refused};
use crate::from_package;
use crate::mesh::Mesh;
use crate::octree::Octree;
use crate::solid::{Given, given};
use crate::work::Limits;
use leafless::lattice::MAX_DEPTH;
use leafless::render::{
    self as pictures, Camera, Clip, FIELD_OF_VIEW, Finish, Layer, MeshEdges, MeshLayer, OctreeLayer, Outline,
    Shot, SliceLayer, SlicePlane, SolidLayer, write_png,
};
use leafless::{Bounds, Frame, TriangleMesh};
use numpy::{PyArrayMethods, PyUntypedArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use std::sync::Arc;

/// The default direction of view: azimuth and elevation in degrees.
const FROM: [f64; 2] = [30.0, 25.0];

/// The colours of several solids, which colour-blind people can tell apart (Okabe and Ito 2002).
const COLOURS: [[u8; 3]; 6] =
    [[178, 187, 196], [230, 159, 0], [86, 180, 233], [0, 158, 115], [204, 121, 167], [213, 94, 0]];

/// The depth of a solid's cells in a section.
const CELLS: u8 = 7;

/// A picture: an array `rgba` of shape (height, width, 4), and an array `depth` of shape (height, width),
/// infinite where nothing is seen.
///
/// Notebooks display it. `leafless.save(picture, "part.png")` writes a PNG.
#[pyclass(frozen, weakref, module = "leafless")]
pub struct Picture(pub pictures::Picture);

#[pymethods]
impl Picture {
    /// Red, green, blue (sRGB) and opacity of each pixel, the upper row first.
    #[getter]
    fn rgba<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let picture = &slf.get().0;
        let shape = [picture.height() as usize, picture.width() as usize, 4];
        shown(slf.as_any(), picture.colours().as_flattened(), layout(shape, false))
    }

    /// The distance of each pixel's nearest point along the line of sight.
    #[getter]
    fn depth<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let picture = &slf.get().0;
        let shape = [picture.height() as usize, picture.width() as usize];
        shown(slf.as_any(), picture.depths(), layout(shape, false))
    }

    /// Returns the bytes of a PNG file.
    pub fn to_png<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &py.detach(|| write_png(&self.0)).or_raise(py)?))
    }

    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        self.to_png(py)
    }

    /// Restores a pickled picture.
    #[staticmethod]
    fn _restored(rgba: &Bound<'_, PyAny>, depth: &Bound<'_, PyAny>) -> PyResult<Picture> {
        let py = rgba.py();
        let (rgba, depth) =
            (required::<u8>(rgba, "uint8", "rgba")?, required::<f32>(depth, "float32", "depth")?);
        let &[height, width, 4] = rgba.shape() else {
            return Err(refused(py, "rgba", "must have the shape (height, width, 4)"));
        };
        let size = [width, height].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
        let colours = bytemuck::cast_slice(rgba.readonly().as_slice()?).to_vec();
        let picture = pictures::Picture::of_colours(size, colours);
        let depths = depth.readonly().as_slice()?.to_vec();
        picture.and_then(|picture| picture.with_depths(depths)).or_raise(py).map(Picture)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let again = from_package!(slf.py(), "leafless._pickle", "picture")?;
        Ok((again, (Picture::rgba(slf)?, Picture::depth(slf)?).into_bound_py_any(slf.py())?))
    }

    fn __repr__(&self) -> String {
        format!("<Picture: {} × {} pixels>", self.0.width(), self.0.height())
    }
}

/// A solid, with its frame and colour in the picture.
struct Shown {
    solid: Given,
    stored: Option<leafless::Octree>,
    open: Option<Arc<TriangleMesh>>,
    frame: Frame,
    colour: [u8; 4],
}

/// Renders a picture of `solids` with a `size` in pixels (width, height). A mesh with holes is shown by its
/// triangles.
///
/// `view` is the azimuth and the elevation of the camera in degrees. `colours` are triples or quadruples of 0
/// to 255, one for each solid. `clip` keeps the part within planes a x + b y + c z + d ≥ 0, rows of four
/// numbers. `slice` is one plane a x + b y + c z + d = 0. It shows the cells of the first solid in that
/// plane: EMPTY light blue, FULL blue, PARTIAL orange. `cells=True` shows octrees by their cells.
/// `edges=False` leaves out the lines along sharp edges. `background` is a colour with its opacity, four
/// numbers of 0 to 255. `samples` is the number of samples in a pixel: 1, 4, 9, 16, 25, 36, 49 or 64.
///
/// `frame` is a `Frame`, or an octree on that frame. The picture shows this cube, and solids are searched in
/// it. Without it, the picture shows the whole solids. Octrees, and meshes with holes, are drawn without a
/// search.
///
/// >>> render(Csg.ball([0, 0, 0], 1), size=(320, 240))
/// <Picture: 320 × 240 pixels>
#[pyfunction]
#[pyo3(signature = (
    *solids, size=[640, 480], view=FROM, colours=None, clip=None, slice=None, edges=true, cells=false,
    background=[255; 4], samples=4, frame=None, **limits
))]
#[allow(clippy::too_many_arguments)]
pub fn render(
    solids: &Bound<'_, PyTuple>,
    #[pyo3(from_py_with = named::size)] size: [u32; 2],
    #[pyo3(from_py_with = named::view)] view: [f64; 2],
    colours: Option<&Bound<'_, PyAny>>,
    clip: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = named::slice)] slice: Option<[f64; 4]>,
    #[pyo3(from_py_with = named::edges)] edges: bool,
    #[pyo3(from_py_with = named::cells)] cells: bool,
    #[pyo3(from_py_with = named::background)] background: [u8; 4],
    #[pyo3(from_py_with = named::samples)] samples: u32,
    frame: Option<FrameLike>,
    limits: Option<&Bound<'_, PyDict>>,
) -> PyResult<Picture> {
    let (py, limits) = (solids.py(), Limits::of(limits)?);
    let mut scene = Vec::new();
    for (i, object) in solids.iter().enumerate() {
        let colour = match &colours {
            None => {
                let [red, green, blue] = COLOURS[i % COLOURS.len()];
                [red, green, blue, 255]
            }
            Some(colours) => colour(colours, i, solids.len())?,
        };
        let stored = object.cast::<Octree>().ok().map(|octree| octree.get().octree.clone());
        // A mesh with holes is shown by its triangles.
        let open = match object.cast::<Mesh>() {
            Ok(mesh) if !mesh.get().inspected(py)?.is_closed() => Some(mesh.get().mesh.clone()),
            _ => None,
        };
        let solid = given(&object, "solids")?;
        // An octree is drawn on its own frame.
        let frame = if stored.is_some() { None } else { frame };
        let frame =
            Wish { frame, depth: None }.of(py, &solid, if slice.is_some() { CELLS } else { MAX_DEPTH })?;
        scene.push(Shown { solid, stored, open, frame, colour });
    }
    if scene.is_empty() {
        return Err(refused(py, "solids", "must be one at least"));
    }
    let mut points = Vec::new();
    match frame {
        Some(FrameLike(frame)) => points.extend(Bounds::of(&frame).corners()),
        None => {
            for shown in &scene {
                let known = match &shown.open {
                    Some(mesh) => Bounds { min: mesh.bounds().0, max: mesh.bounds().1 },
                    None => tight(py, &shown.solid)?,
                };
                points.extend(known.corners());
            }
        }
    }
    let plane = slice.map(|[a, b, c, d]| SlicePlane::new([a, b, c], d)).transpose();
    let plane = plane.map_err(called([("normal", "slice"), ("offset", "slice")])).or_raise(py)?;
    let aspect = f64::from(size[0]) / f64::from(size[1].max(1));
    let camera = match slice {
        None => Camera::fitted(&points, view, Some(FIELD_OF_VIEW), aspect),
        // The camera looks from above the plane.
        Some([a, b, c, _]) => {
            let flat = (a * a + b * b).sqrt();
            let from = [a.atan2(-b).to_degrees(), c.atan2(flat).to_degrees()];
            let from = if flat == 0.0 { [0.0, if c < 0.0 { -90.0 } else { 90.0 }] } else { from };
            Camera::fitted(&points, from, None, aspect)
        }
    };
    let names = [("from", "view"), ("lens", "view"), ("aspect", "size"), ("points", "solids")];
    let mut shot = Shot::new(camera.map_err(called(names)).or_raise(py)?, size);
    shot.background = background;
    shot.samples = samples;
    if let Some(planes) = clip {
        let mut kept = Clip::new();
        for plane in arrays::table(planes, "clip")? {
            kept = kept
                .plane(plane)
                .map_err(called([("plane", "clip"), ("planes", "clip"), ("normal", "clip")]))
                .or_raise(py)?;
        }
        shot.clip = kept;
    }
    let picture = limits.run(py, |control| {
        let mut layers: Vec<Box<dyn Layer + '_>> = Vec::new();
        for Shown { solid, stored, open, frame, colour } in &scene {
            let drawn = if edges { MeshEdges::Features } else { MeshEdges::None };
            let edges = if edges { Some(Outline::default()) } else { None };
            let finish = Finish { colour: *colour, edges, faces: cells, ..Finish::default() };
            if let (None, Some(mesh)) = (plane, open) {
                layers.push(Box::new(MeshLayer::new(mesh).colour(*colour).edges(
                    drawn,
                    1.5,
                    [30, 30, 30, 255],
                )));
                continue;
            }
            layers.push(match (plane, stored) {
                (Some(plane), Some(octree)) => Box::new(SliceLayer::new(octree.view(), plane)),
                (Some(plane), None) => Box::new(SliceLayer::of_solid(&solid.shape, frame, plane)),
                (None, Some(octree)) => Box::new(OctreeLayer::new(octree.view(), finish)),
                (None, None) => {
                    Box::new(SolidLayer::new(&solid.shape, frame, Finish { faces: false, ..finish }))
                }
            });
            if plane.is_some() {
                break;
            }
        }
        let layers: Vec<&dyn Layer> = layers.iter().map(|layer| &**layer).collect();
        pictures::render(&shot, &layers, control)
    })?;
    Ok(Picture(picture))
}

/// Reads the colour of one of several solids.
fn colour(colours: &Bound<'_, PyAny>, i: usize, count: usize) -> PyResult<[u8; 4]> {
    let py = colours.py();
    let problem = || {
        let all =
            format!("must be three or four whole numbers from 0 to 255 for each of the solids, {count} rows");
        refused(py, "colours", all)
    };
    let own: Vec<u8> = colours.get_item(i).and_then(|row| row.extract()).map_err(|_| problem())?;
    match own[..] {
        [red, green, blue] => Ok([red, green, blue, 255]),
        [red, green, blue, opacity] => Ok([red, green, blue, opacity]),
        _ => Err(problem()),
    }
}

/// Returns a tight box around a solid.
fn tight(py: Python<'_>, solid: &Given) -> PyResult<Bounds> {
    match (solid.own, solid.bounds(py)) {
        // The universe of an octree may be much larger than its solid.
        (Some(own), _) => {
            let (shape, coarse) = (&solid.shape, own);
            let found = py.detach(|| {
                let control = leafless::Control { max_splits: Some(2000), threads: 1, ..Default::default() };
                leafless::bounding_box(shape, &coarse, 0.01 * coarse.edge(), &control)
            });
            let corners = found.or_raise(py)?.corners;
            Ok(corners.map_or(Bounds::of(&own), |[low, high]| Bounds {
                min: low.map(|x| x.lower),
                max: high.map(|x| x.upper),
            }))
        }
        (None, _) => ask::bounds(py, solid),
    }
}
