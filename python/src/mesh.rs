//! Triangle meshes.

use crate::arguments::{named, other_type};
use crate::arrays::{self, Rows, layout, shape_text, shown};
use crate::error::{OrRaise, refused};
use crate::from_package;
use crate::solid::{Given, Solid};
use crate::surface_report::SurfaceReport;
use crate::words;
use crate::work::Limits;
use leafless::mesh::{AttributeDomain, MeshAttribute, MeshHistory, MeshReport};
use leafless::{Affine, AnySolid, FillRule, MeshSolid, TriangleMesh};
use numpy::{PyArrayMethods, PyUntypedArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// A triangle mesh with the solid that it encloses.
///
/// Any mesh is a solid. For a closed mesh, the inside is exact. For a mesh with holes, fins or inverted
/// facets, the winding number decides by the rule `fill`: "nonzero" (at least ½ in magnitude), "positive" or
/// "evenodd".
///
/// >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
/// >>> mesh = Mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
/// >>> mesh.is_closed, 1 / 6 in measure(mesh).volume
/// (True, True)
///
/// `vertices` and `faces` are arrays that trimesh, meshio, PyVista and Open3D accept unchanged.
#[pyclass(extends = Solid, frozen, module = "leafless")]
pub struct Mesh {
    pub mesh: Arc<TriangleMesh>,
    pub fill: FillRule,
    /// The unit of the coordinates, if the file states one.
    pub unit: Option<String>,
    /// The report of the method that made the mesh of a solid.
    surface: Option<SurfaceReport>,
}

impl Mesh {
    /// Wraps a mesh.
    pub fn bound(
        py: Python<'_>,
        mesh: impl Into<Arc<TriangleMesh>>,
        fill: FillRule,
        unit: Option<String>,
        surface: Option<SurfaceReport>,
    ) -> PyResult<Bound<'_, Mesh>> {
        let mesh = mesh.into();
        let solid = py.detach(|| MeshSolid::new(mesh, fill)).or_raise(py)?;
        Mesh::of_solid(py, solid, fill, unit, surface)
    }

    fn of_solid(
        py: Python<'_>,
        solid: MeshSolid,
        fill: FillRule,
        unit: Option<String>,
        surface: Option<SurfaceReport>,
    ) -> PyResult<Bound<'_, Mesh>> {
        let mesh = solid.mesh().clone();
        let given = Given::new(AnySolid::new(solid));
        let mesh = Mesh { mesh, fill, unit, surface };
        Bound::new(py, PyClassInitializer::from(Solid::new(given)).add_subclass(mesh))
    }

    /// Returns the maximum distance of the true boundary from the mesh, if it is known.
    pub fn deviation(&self) -> Option<f64> {
        self.surface
            .filter(|report| report.deviation.is_finite() && !report.from_mesh)
            .map(|report| report.deviation)
    }

    /// Returns the mesh's report, which is computed once.
    pub fn inspected(&self, py: Python<'_>) -> PyResult<MeshReport> {
        py.detach(|| self.mesh.report()).or_raise(py)
    }

    /// Moves the mesh.
    pub fn placed<'py>(&self, py: Python<'py>, placement: &Affine) -> PyResult<Bound<'py, Mesh>> {
        let moved =
            py.detach(|| MeshSolid::new(self.mesh.clone(), self.fill)?.placed(placement)).or_raise(py)?;
        Mesh::of_solid(py, moved, self.fill, self.unit.clone(), None)
    }
}

#[pymethods]
impl Mesh {
    /// Makes a mesh from vertices (shape (n, 3)) and triangles (indices of shape (m, 3), counter-clockwise as
    /// seen from outside). Equal vertices become one, and triangles without area are dropped.
    #[new]
    #[pyo3(signature = (vertices, faces, *, fill="nonzero"))]
    fn new(
        vertices: &Bound<'_, PyAny>,
        faces: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = named::fill)] fill: &str,
    ) -> PyResult<PyClassInitializer<Mesh>> {
        let py = vertices.py();
        let fill = words::value(py, fill)?;
        let vertices = Rows::of(vertices, "vertices")?;
        let faces = indices(faces)?;
        let list = vertices.list();
        let solid = Limits::default().run_here(py, |_| {
            let mut own = Vec::new();
            own.try_reserve_exact(list.len()).map_err(|_| leafless::Error::OutOfMemory)?;
            own.extend_from_slice(list);
            MeshSolid::new(TriangleMesh::new(own, faces)?, fill)
        })?;
        let mesh = solid.mesh().clone();
        let given = Given::new(AnySolid::new(solid));
        let mesh = Mesh { mesh, fill, unit: None, surface: None };
        Ok(PyClassInitializer::from(Solid::new(given)).add_subclass(mesh))
    }

    /// Restores a pickled mesh.
    #[staticmethod]
    fn _restored<'py>(
        vertices: &Bound<'py, PyAny>,
        faces: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::fill)] fill: &str,
        unit: Option<String>,
        surface_report: Option<SurfaceReport>,
        attributes: Vec<(String, Vec<String>, Bound<'py, PyAny>)>,
        history: History,
    ) -> PyResult<Bound<'py, Mesh>> {
        let py = vertices.py();
        let vertices = Rows::of(vertices, "vertices")?.list().to_vec();
        let attributes =
            attributes.iter().map(|(name, names, values)| Ok(read(name, values)?.named(names.clone())));
        let attributes = attributes.collect::<PyResult<Vec<_>>>()?;
        let (counts, lengths) = history;
        let [welded, degenerate, sewn, polygons, bent_polygons] = counts;
        let [displacement, deviation, polygon_deviation] = lengths;
        let history = MeshHistory {
            welded,
            degenerate,
            sewn,
            displacement,
            deviation,
            polygons,
            bent_polygons,
            polygon_deviation,
        };
        let faces = indices(faces)?;
        let mesh = py.detach(|| {
            let mesh = TriangleMesh::with_attributes(vertices, faces, attributes)?;
            mesh.with_history(history)
        });
        let mesh = mesh.or_raise(py)?;
        Mesh::bound(py, mesh, words::value(py, fill)?, unit, surface_report)
    }

    /// Converts a `mesh` of trimesh, or any other object with `vertices` and `faces`, with the rule `fill`.
    #[staticmethod]
    #[pyo3(signature = (mesh, *, fill="nonzero"))]
    fn from_trimesh<'py>(
        mesh: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::fill)] fill: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (Ok(vertices), Ok(faces)) = (mesh.getattr("vertices"), mesh.getattr("faces")) else {
            return Err(other_type(mesh, "mesh", "a mesh with vertices and faces, as one of trimesh is"));
        };
        let arguments = (vertices, faces);
        let fill_rule = PyDict::new(mesh.py());
        fill_rule.set_item("fill", fill)?;
        mesh.py().get_type::<Mesh>().call(arguments, Some(&fill_rule))
    }

    /// Returns the mesh as a `trimesh.Trimesh`. The package trimesh must be installed.
    fn to_trimesh<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        from_package!(slf.py(), "leafless._exchange", "to_trimesh")?.call1((slf,))
    }

    /// The vertices, shape (n, 3): a view of the library's own memory.
    #[getter]
    fn vertices<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let list = slf.get().mesh.vertices();
        shown(slf.as_any(), list.as_flattened(), layout([list.len(), 3], false))
    }

    /// The triangles, as indices of shape (m, 3): a view of the library's own memory.
    #[getter]
    fn faces<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let list = slf.get().mesh.triangles();
        shown(slf.as_any(), list.as_flattened(), layout([list.len(), 3], false))
    }

    /// The fill rule, which defines the inside.
    #[getter]
    fn fill(&self) -> &'static str {
        words::word(self.fill)
    }

    /// The unit of the coordinates, if the file states one.
    #[getter]
    fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    /// True if the triangles have no open edge.
    #[getter]
    fn is_closed(&self, py: Python<'_>) -> PyResult<bool> {
        Ok(self.inspected(py)?.is_closed())
    }

    /// The report of `surface` or `simplify`, if one of them made the mesh.
    #[getter]
    fn surface_report(&self) -> Option<SurfaceReport> {
        self.surface
    }

    /// Returns the mesh with hair cracks closed: vertices at open edges that differ only by rounding are
    /// merged. `report` counts them (`sewn`). Proofs about the new mesh account for the distance that
    /// vertices moved.
    fn sewn<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, Mesh>> {
        let mesh = Limits::default().run(py, |_| self.mesh.try_clone()?.sewn())?;
        Mesh::bound(py, mesh, self.fill, self.unit.clone(), self.surface)
    }

    /// Returns the defects of the mesh: counts of bodies, open edges, inverted facets and the like, as a
    /// dictionary.
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let report = self.inspected(py)?;
        let told = PyDict::new(py);
        let counts = [
            ("triangles", report.triangles),
            ("vertices", report.vertices),
            ("bodies", report.bodies),
            ("open_bodies", report.open_bodies),
            ("inside_out_bodies", report.inside_out_bodies),
            ("overlapping_bodies", report.overlapping_bodies),
            ("boundary_edges", report.boundary_edges),
            ("boundary_loops", report.boundary_loops),
            ("misoriented_edges", report.misoriented_edges),
            ("non_manifold_edges", report.non_manifold_edges),
            ("duplicate", report.duplicate),
            ("opposite", report.opposite),
            ("flat", report.flat),
            ("degenerate", report.degenerate),
            ("welded", report.welded),
            ("sewn", report.sewn),
        ];
        for (name, count) in counts {
            told.set_item(name, count)?;
        }
        told.set_item("is_closed", report.is_closed())?;
        told.set_item("is_manifold", report.is_manifold())?;
        Ok(told)
    }

    /// The names of the attributes of triangles or their corners, such as a file's colours and materials.
    #[getter]
    fn attributes(&self) -> Vec<String> {
        self.mesh.attributes().iter().map(|attribute| attribute.name().to_owned()).collect()
    }

    /// Returns the values of the attribute called `name` at the corners of triangles: shape (m, 3,
    /// components), NaN where there is none.
    fn attribute<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::name)] name: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Some(attribute) = self.mesh.attribute(name) else {
            return Err(refused(py, "name", format!("no attribute is called '{name}'")));
        };
        values(py, attribute, 3)
    }

    fn __len__(&self) -> usize {
        self.mesh.triangles().len()
    }

    fn __repr__(&self) -> String {
        let (vertices, triangles) = (self.mesh.vertices().len(), self.mesh.triangles().len());
        format!("<Mesh: {vertices} vertices, {triangles} triangles>")
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let again = from_package!(slf.py(), "leafless._pickle", "mesh")?;
        let own = slf.get();
        let attributes = own.mesh.attributes().iter().map(|attribute| {
            let corners = if attribute.domain() == AttributeDomain::Corner { 3 } else { 1 };
            Ok((attribute.name(), attribute.names(), values(slf.py(), attribute, corners)?))
        });
        // Proofs about a mesh account for the distance that its vertices were moved. Proofs about the copy
        // must do the same.
        let past = own.mesh.history();
        let history: History = (
            [past.welded, past.degenerate, past.sewn, past.polygons, past.bent_polygons],
            [past.displacement, past.deviation, past.polygon_deviation],
        );
        let arguments = (
            Mesh::vertices(slf)?,
            Mesh::faces(slf)?,
            own.fill(),
            own.unit.clone(),
            own.surface,
            attributes.collect::<PyResult<Vec<_>>>()?,
            history,
        );
        Ok((again, arguments.into_bound_py_any(slf.py())?))
    }
}

/// The pickled form of a mesh's history: its counts and its lengths.
type History = ([u64; 5], [f64; 3]);

/// Returns the values of an attribute, shape (m, corners, components), at the first corner of each triangle
/// or at all three.
fn values<'py>(py: Python<'py>, attribute: &MeshAttribute, corners: usize) -> PyResult<Bound<'py, PyAny>> {
    let (count, components) = (attribute.len(), attribute.components());
    let values = py.detach(|| {
        let all = (0..count).flat_map(|triangle| (0..corners).map(move |corner| (triangle, corner)));
        let value = |(triangle, corner)| attribute.value(triangle, corner).unwrap_or([f64::NAN; 4]);
        all.flat_map(|at| value(at).into_iter().take(components)).collect()
    });
    Ok(arrays::array(py, values, &[count, corners, components])?.into_any())
}

/// Reads an attribute from values of shape (m, 1, components) for triangles or (m, 3, components) for their
/// corners.
fn read(name: &str, values: &Bound<'_, PyAny>) -> PyResult<MeshAttribute> {
    let py = values.py();
    let array = arrays::doubles(values, name)?;
    let list = array.readonly();
    let attribute = match *array.shape() {
        [_, 1, components] => MeshAttribute::per_triangle(name, components, list.as_slice()?),
        [_, 3, components] => MeshAttribute::per_corner(name, components, list.as_slice()?),
        ref shape => {
            return Err(refused(
                py,
                name,
                format!("must have values of triangles or of corners, not {}", shape_text(shape)),
            ));
        }
    };
    attribute.or_raise(py)
}

/// Reads triples of indices, from integers of any type.
fn indices(given: &Bound<'_, PyAny>) -> PyResult<Vec<[u32; 3]>> {
    let py = given.py();
    let array = arrays::required::<i64>(given, "int64", "faces")?;
    // An empty list has one axis.
    if !matches!(array.shape(), [0] | [_, 3]) {
        return Err(refused(
            py,
            "faces",
            format!("must have the shape (n, 3), not {}", shape_text(array.shape())),
        ));
    }
    let list = array.readonly();
    let index = |&index: &i64| {
        let problem = || refused(py, "faces", format!("{index} is not the index of a vertex"));
        u32::try_from(index).map_err(|_| problem())
    };
    list.as_slice()?
        .chunks_exact(3)
        .map(|corners| Ok([index(&corners[0])?, index(&corners[1])?, index(&corners[2])?]))
        .collect()
}
