//! Surfaces as triangle meshes.

use crate::ask::{self, FrameLike, Wish};
use crate::error::refused;
use crate::mesh::Mesh;
use crate::octree::Octree;
use crate::solid::given;
use crate::volume::Volume;
use crate::work::Limits;
use leafless::surface::{self as surfaces, Resolve, Snap, VertexPlacement};
use leafless::{Bounds, Error, FillRule, TriangleMesh, marching_cubes};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Default depths: for cells that end by themselves, for cells that hold one vertex each, and for cells of one size.
const DEEP: u8 = 14;
const FINE: u8 = 12;
const EQUAL: u8 = 8;

/// The default tolerance, as a part of the longest extent.
const TOLERANCE: f64 = 1e-3;

/// Where coplanar shrink puts vertices.
const SNAP: Snap = Snap::Fat;

/// What `method` of a report may be.
const METHODS: [&str; 6] = ["faces", "adaptive", "cubes", "nets", "shrink", "simplify"];

/// How a mesh was made of a solid.
#[pyclass(frozen, eq, get_all, weakref, from_py_object, module = "leafless")]
#[derive(Clone, Copy, PartialEq)]
pub struct SurfaceReport {
    /// "faces", "adaptive", "cubes", "nets", "shrink" or "simplify".
    method: &'static str,
    /// No point of the mesh is further from the solid's boundary than that, and no point of the boundary is further from the mesh
    /// (model units): proven. Infinite if nothing is known.
    pub deviation: f64,
    /// Whether the deviation is that from another mesh, of which no deviation is known: `simplify` of a mesh from a file.
    pub from_mesh: bool,
    /// Pairs of triangles that intersect each other, where the method counts them.
    intersecting_pairs: u64,
}

#[pymethods]
impl SurfaceReport {
    /// A report, as `mesh.surface_report` tells it.
    #[new]
    fn new(
        py: Python<'_>,
        method: &str,
        deviation: f64,
        from_mesh: bool,
        intersecting_pairs: u64,
    ) -> PyResult<SurfaceReport> {
        let unknown = || refused(py, "method", format!("must be one of {}", METHODS.join(", ")));
        let method = METHODS.into_iter().find(|known| *known == method).ok_or_else(unknown)?;
        Ok(SurfaceReport { method, deviation, from_mesh, intersecting_pairs })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let SurfaceReport { method, deviation, from_mesh, intersecting_pairs } = *slf.get();
        let arguments = (method, deviation, from_mesh, intersecting_pairs);
        Ok((slf.get_type().into_any(), arguments.into_bound_py_any(slf.py())?))
    }

    fn __repr__(&self) -> String {
        let SurfaceReport { method, deviation, intersecting_pairs, .. } = self;
        format!(
            "<SurfaceReport: {method}, deviation {deviation:.3e}, {intersecting_pairs} intersecting pairs>"
        )
    }
}

/// What `surface` may make.
#[derive(Clone, Copy, PartialEq)]
enum Method {
    Any,
    Faces,
    Adaptive,
    Cubes,
    Nets,
    Shrink,
}

/// The surface of a solid as a closed triangle mesh.
///
/// `method` is one of these. Without it, the first method that suits the solid is taken.
///
/// - "faces": plane faces as they are, sharp edges, few triangles. For solids that know their surfaces (expressions, octrees that keep them)
///   and for meshes.
/// - "adaptive": few triangles where the surface is flat. For any solid.
/// - "cubes": marching cubes in 2^`depth` cells along an axis. For octrees it uses their cells, for volumes their voxels.
/// - "nets": surface nets, smoother, in the same cells.
/// - "shrink": coplanar shrink, with few triangles where the cells make a plane.
///
/// `tolerance` (model units) is how far "faces" and "adaptive" may be from the solid; the default is a thousandth of the longest side.
/// `mesh.surface_report.deviation` is what is proven of that distance. `resolve` says whether undecided cells of an octree belong to the
/// solid: "outer" (they do) or "inner" (they do not).
///
/// >>> mesh = surface(Csg.cuboid([0, 0, 0], [3, 2, 1]))
/// >>> len(mesh.faces), mesh.surface_report.method
/// (12, 'faces')
#[pyfunction]
#[pyo3(signature = (solid, *, tolerance=None, method=None, resolve=None, frame=None, depth=None, **limits))]
pub fn surface<'py>(
    solid: &Bound<'py, PyAny>,
    tolerance: Option<f64>,
    method: Option<&str>,
    resolve: Option<&str>,
    frame: Option<FrameLike>,
    depth: Option<u8>,
    limits: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, Mesh>> {
    let (py, limits) = (solid.py(), Limits::of(limits)?);
    let method = match method {
        None => Method::Any,
        Some("faces") => Method::Faces,
        Some("adaptive") => Method::Adaptive,
        Some("cubes") => Method::Cubes,
        Some("nets") => Method::Nets,
        Some("shrink") => Method::Shrink,
        Some(other) => {
            let problem =
                format!("must be one of 'faces', 'adaptive', 'cubes', 'nets', 'shrink', not '{other}'");
            return Err(refused(py, "method", problem));
        }
    };
    let resolve = match resolve {
        None | Some("outer") => Resolve::Outer,
        Some("inner") => Resolve::Inner,
        Some(_) => return Err(refused(py, "resolve", "must be 'outer' or 'inner'")),
    };
    let samples = solid.cast::<Volume>().ok().map(|volume| volume.get().volume.clone());
    if let Some(volume) = samples.filter(|_| matches!(method, Method::Any | Method::Cubes) && depth.is_none())
    {
        let mesh = limits.run(py, |control| surfaces::marching_cubes_volume(&volume, control))?;
        return made(
            py,
            mesh,
            SurfaceReport {
                method: "cubes",
                deviation: f64::INFINITY,
                from_mesh: false,
                intersecting_pairs: 0,
            },
        );
    }
    let stored = solid.cast::<Octree>().ok().map(|octree| octree.get().octree.clone());
    let stored = stored.filter(|octree| octree.view().cuts().is_none());
    let solid = given(solid, "solid")?;
    let wish = Wish { frame, depth };
    if let Some(octree) = stored.filter(|_| !matches!(method, Method::Faces | Method::Adaptive)) {
        let mesh = limits.run(py, |control| match method {
            Method::Nets => surfaces::surface_nets(octree.view(), Some(resolve), control),
            Method::Shrink => surfaces::coplanar_shrink(octree.view(), SNAP, Some(resolve), control),
            _ => marching_cubes(octree.view(), Some(resolve), control),
        })?;
        let method = match method {
            Method::Nets => "nets",
            Method::Shrink => "shrink",
            _ => "cubes",
        };
        return made(
            py,
            mesh,
            SurfaceReport { method, deviation: f64::INFINITY, from_mesh: false, intersecting_pairs: 0 },
        );
    }
    if let Method::Cubes | Method::Shrink | Method::Nets = method {
        let frame = wish.of(py, &solid, EQUAL)?;
        let name = if method == Method::Shrink { "shrink" } else { "cubes" };
        let mesh = limits.run(py, |control| match method {
            Method::Nets => {
                let octree = leafless::build(&solid.shape, &frame, leafless::Rule::Sampled, control)?;
                surfaces::surface_nets(octree.view(), Some(resolve), control)
            }
            Method::Shrink => surfaces::coplanar_shrink_solid(&solid.shape, &frame, SNAP, control),
            _ => surfaces::marching_cubes_solid(&solid.shape, &frame, VertexPlacement::Crossing, control),
        })?;
        let method = if method == Method::Nets { "nets" } else { name };
        return made(
            py,
            mesh,
            SurfaceReport { method, deviation: f64::INFINITY, from_mesh: false, intersecting_pairs: 0 },
        );
    }
    let bounds = match frame {
        Some(FrameLike(frame)) => Bounds::of(&frame),
        None => ask::bounds(py, &solid)?,
    };
    let longest = (0..3).map(|axis| bounds.max[axis] - bounds.min[axis]).fold(0.0, f64::max);
    let tolerance = tolerance.unwrap_or(TOLERANCE * longest);
    let (deep, fine) = (wish.of(py, &solid, DEEP)?, wish.of(py, &solid, FINE)?);
    let (mesh, report) = limits.run(py, |control| {
        if method != Method::Adaptive {
            match surfaces::boundary(&solid.shape, &deep, tolerance, control) {
                Ok(found) => {
                    let report = found.report();
                    let (deviation, intersecting_pairs) = (report.deviation, report.intersecting_pairs);
                    let report =
                        SurfaceReport { method: "faces", deviation, from_mesh: false, intersecting_pairs };
                    return Ok((found.into_mesh(), report));
                }
                // Of what is not bounded by surfaces the other method makes one.
                Err(Error::Argument { name, .. }) if method == Method::Any && name != "tolerance" => {}
                Err(error) => return Err(error),
            }
        }
        let found = surfaces::contour(&solid.shape, &fine, tolerance, control)?;
        let report = found.report();
        let (deviation, intersecting_pairs) = (report.deviation, report.intersecting_pairs);
        let report = SurfaceReport { method: "adaptive", deviation, from_mesh: false, intersecting_pairs };
        Ok((found.into_mesh(), report))
    })?;
    made(py, mesh, report)
}

/// The same mesh with fewer triangles. Both meshes are within `tolerance` (model units) of each other: proven, for open meshes too.
#[pyfunction]
#[pyo3(signature = (mesh, tolerance, **limits))]
pub fn simplify<'py>(
    mesh: &Bound<'py, Mesh>,
    tolerance: f64,
    limits: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, Mesh>> {
    let (py, own) = (mesh.py(), mesh.get());
    let found = Limits::of(limits)?.run(py, |control| surfaces::simplify(&own.mesh, tolerance, control))?;
    let report = found.report();
    // What the mesh was off before, and what it is off now.
    let before = own.deviation();
    let deviation = before.map_or(report.deviation, |before| (before + report.deviation).next_up());
    let intersecting_pairs = report.intersecting_pairs;
    let report =
        SurfaceReport { method: "simplify", deviation, from_mesh: before.is_none(), intersecting_pairs };
    Mesh::bound(py, found.into_mesh(), own.fill, own.unit.clone(), Some(report))
}

fn made(py: Python<'_>, mesh: TriangleMesh, report: SurfaceReport) -> PyResult<Bound<'_, Mesh>> {
    Mesh::bound(py, mesh, FillRule::NonZero, None, Some(report))
}
