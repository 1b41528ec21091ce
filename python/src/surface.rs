//! Surface extraction: triangle meshes of solids.

use crate::arguments::{Depth, named};
use crate::ask::{self, FrameLike, Wish};
use crate::error::refused;
use crate::mesh::Mesh;
use crate::octree::Octree;
use crate::solid::given;
use crate::surface_report::SurfaceReport;
use crate::volume::Volume;
use crate::words::{self, Word};
use crate::work::Limits;
use leafless::surface::{self as surfaces, Resolve, Snap, VertexPlacement};
use leafless::{Bounds, Error, FillRule, TriangleMesh, marching_cubes};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The default depths: for cells that end by themselves, for cells that hold one vertex each, and for cells
/// of one size.
const DEEP: u8 = 14;
const FINE: u8 = 12;
const EQUAL: u8 = 8;

/// The default tolerance, as a part of the longest extent.
const TOLERANCE: f64 = 1e-3;

/// The place of vertices in coplanar shrink.
const SNAP: Snap = Snap::Fat;

/// The methods of `surface`.
#[derive(Clone, Copy, PartialEq)]
enum Method {
    Faces,
    Adaptive,
    Cubes,
    Nets,
    Shrink,
}

impl Word for Method {
    const NAME: &'static str = "method";
    const ALL: &'static [(&'static str, Method)] = &[
        ("faces", Method::Faces),
        ("adaptive", Method::Adaptive),
        ("cubes", Method::Cubes),
        ("nets", Method::Nets),
        ("shrink", Method::Shrink),
    ];
}

/// Makes a closed triangle mesh of the surface of a `solid`.
///
/// `method` is one of these. By default, the first method that suits the solid is used.
///
/// - "faces": plane faces stay plane, sharp edges, few triangles. For solids that store their surfaces
///   (expressions, octrees that keep them) and for meshes.
/// - "adaptive": few triangles where the surface is flat. For any solid.
/// - "cubes": marching cubes in 2^`depth` cells along an axis. For an octree in its own cells, for a volume
///   in its voxels.
/// - "nets": surface nets, smoother, in the same cells.
/// - "shrink": coplanar shrink, with few triangles where the cells form a plane.
///
/// `tolerance` (model units) is the maximum distance of "faces" and "adaptive" from the solid; the default is
/// a thousandth of the longest side. `mesh.surface_report.deviation` is the proven bound of that distance.
///
/// `frame` is the cube in which the surface is searched: a `Frame`, or an octree on that frame. `depth`
/// replaces the depth of the frame. `frame`, `depth` and `tolerance` have no meaning for the cells of an
/// octree or the voxels of a volume, and are refused there. A volume with a `frame` or a `depth` is treated
/// like any other solid.
///
/// `resolve` decides whether undecided cells of an octree belong to the solid: "outer" (they do, the default)
/// or "inner" (they do not). It is refused where the mesh is not made of an octree's cells.
///
/// >>> mesh = surface(Csg.cuboid([0, 0, 0], [3, 2, 1]))
/// >>> len(mesh.faces), mesh.surface_report.method
/// (12, 'faces')
#[pyfunction]
#[pyo3(signature = (solid, *, tolerance=None, method=None, resolve=None, frame=None, depth=None, **limits))]
pub fn surface<'py>(
    solid: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = named::tolerance)] tolerance: Option<f64>,
    #[pyo3(from_py_with = named::method)] method: Option<&str>,
    #[pyo3(from_py_with = named::resolve)] resolve: Option<&str>,
    frame: Option<FrameLike>,
    #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
    limits: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, Mesh>> {
    let (py, limits) = (solid.py(), Limits::of(limits)?);
    let method: Option<Method> = method.map(|method| words::value(py, method)).transpose()?;
    let resolve: Option<Resolve<'static>> = resolve.map(|resolve| words::value(py, resolve)).transpose()?;
    let samples = solid.cast::<Volume>().ok().map(|volume| volume.get().volume.clone());
    let stored = solid.cast::<Octree>().ok().map(|octree| octree.get().octree.clone());
    let stored = stored.filter(|octree| octree.view().cuts().is_none());
    let solid = given(solid, "solid")?;
    let wish = Wish { frame, depth };
    // A parameter without a meaning is refused, so that no caller believes that it had an effect.
    let without = |name: &str, is_given: bool, why: &str| {
        if is_given { Err(refused(py, name, format!("has no meaning here: {why}"))) } else { Ok(()) }
    };
    let equal = |mesh, method| {
        let method = words::word(method);
        made(
            py,
            mesh,
            SurfaceReport { method, deviation: f64::INFINITY, from_mesh: false, intersecting_pairs: 0 },
        )
    };
    let by_own_cells = !matches!(method, Some(Method::Faces | Method::Adaptive));
    if let Some(octree) = stored.filter(|_| by_own_cells) {
        let why = "the cells of the octree make the mesh; 'adaptive' asks them as a solid";
        without("tolerance", tolerance.is_some(), why)?;
        without("frame", frame.is_some(), why)?;
        without("depth", depth.is_some(), why)?;
        let resolve = Some(resolve.unwrap_or(Resolve::Outer));
        let mesh = limits.run(py, |control| match method {
            Some(Method::Nets) => surfaces::surface_nets(octree.view(), resolve, control),
            Some(Method::Shrink) => surfaces::coplanar_shrink(octree.view(), SNAP, resolve, control),
            _ => marching_cubes(octree.view(), resolve, control),
        })?;
        return equal(mesh, method.unwrap_or(Method::Cubes));
    }
    without(
        "resolve",
        resolve.is_some(),
        "only cells of a stored octree are undecided; 'cubes', 'nets' and 'shrink' take them as they are",
    )?;
    if let Some(volume) =
        samples.filter(|_| matches!(method, None | Some(Method::Cubes)) && depth.is_none() && frame.is_none())
    {
        without(
            "tolerance",
            tolerance.is_some(),
            "the voxels of the volume make the mesh; 'adaptive' heeds it",
        )?;
        let mesh = limits.run(py, |control| surfaces::marching_cubes_volume(&volume, control))?;
        return equal(mesh, Method::Cubes);
    }
    if let Some(method @ (Method::Cubes | Method::Shrink | Method::Nets)) = method {
        without(
            "tolerance",
            tolerance.is_some(),
            "cells of one size make the mesh; 'faces' and 'adaptive' heed it",
        )?;
        let frame = wish.of(py, &solid, EQUAL)?;
        let mesh = limits.run(py, |control| match method {
            Method::Nets => {
                let octree = leafless::build(&solid.shape, &frame, leafless::Rule::Sampled, control)?;
                surfaces::surface_nets(octree.view(), Some(Resolve::Outer), control)
            }
            Method::Shrink => surfaces::coplanar_shrink_solid(&solid.shape, &frame, SNAP, control),
            _ => surfaces::marching_cubes_solid(&solid.shape, &frame, VertexPlacement::Crossing, control),
        })?;
        return equal(mesh, method);
    }
    let bounds = match frame {
        Some(FrameLike(frame)) => Bounds::of(&frame),
        None => ask::bounds(py, &solid)?,
    };
    let longest = (0..3).map(|axis| bounds.max[axis] - bounds.min[axis]).fold(0.0, f64::max);
    let tolerance = tolerance.unwrap_or(TOLERANCE * longest);
    let (deep, fine) = (wish.of(py, &solid, DEEP)?, wish.of(py, &solid, FINE)?);
    let (mesh, report) = limits.run(py, |control| {
        if method != Some(Method::Adaptive) {
            match surfaces::boundary(&solid.shape, &deep, tolerance, control) {
                Ok(found) => {
                    let report = found.report();
                    let (deviation, intersecting_pairs) = (report.deviation, report.intersecting_pairs);
                    let report =
                        SurfaceReport { method: "faces", deviation, from_mesh: false, intersecting_pairs };
                    return Ok((found.into_mesh(), report));
                }
                // A solid that is not bounded by surfaces is meshed by the other method.
                Err(Error::Argument { name, .. }) if method.is_none() && name != "tolerance" => {}
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

/// Returns a `mesh` with fewer triangles. Both meshes are proven to be within `tolerance` (model units) of
/// each other, even if they are open.
#[pyfunction]
#[pyo3(signature = (mesh, tolerance, **limits))]
pub fn simplify<'py>(
    #[pyo3(from_py_with = named::mesh)] mesh: Bound<'py, Mesh>,
    #[pyo3(from_py_with = named::tolerance)] tolerance: f64,
    limits: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, Mesh>> {
    let (py, own) = (mesh.py(), mesh.get());
    let found = Limits::of(limits)?.run(py, |control| surfaces::simplify(&own.mesh, tolerance, control))?;
    let report = found.report();
    // The sum of the deviation before and the deviation of this step.
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
