//! Expressions of half-spaces and of any other solids.

use crate::affine::{Affine, affine};
use crate::anywhere::anywhere;
use crate::arguments::named;
use crate::arrays::{self, triple};
use crate::error::{OrRaise, called, refused};
use crate::from_package;
use crate::solid::{Given, Solid, given, is_solid};
use crate::work::Limits;
use leafless::error::Error;
use leafless::lattice::MAX_DEPTH;
use leafless::scene::SceneOptions;
use leafless::{AnySolid, Csg as Expression, Frame};
use pyo3::IntoPyObjectExt;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// An expression of half-spaces, primitives, and set operations on them and on any other solids.
///
/// Nothing is computed before a query, and a query computes only the parts that matter. Numbers are used
/// unchanged: a ball is a ball, not a polyhedron.
///
/// >>> plate = Csg.cuboid([0, 0, 0], [80, 60, 10]) - Csg.cylinder_between([20, 30, -1], [20, 30, 11], 8)
/// >>> measure(plate, tolerance=1e-6).volume
/// 45989.3798 ± 0.0048
#[pyclass(extends = Solid, frozen, module = "leafless")]
pub struct Csg {
    pub expression: Expression,
    /// The function of this class that made the expression, with its arguments. The arguments keep Python
    /// shapes in the expression alive.
    recipe: (&'static str, Py<PyTuple>),
}

impl Csg {
    /// Wraps an expression, with the recipe to make it again.
    pub fn made<'py>(
        py: Python<'py>,
        expression: Expression,
        name: &'static str,
        arguments: impl IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error: Into<PyErr>>,
    ) -> PyResult<Bound<'py, Csg>> {
        let given = Given::new(AnySolid::new(expression.clone()));
        let csg =
            Csg { expression, recipe: (name, arguments.into_pyobject(py).map_err(Into::into)?.unbind()) };
        Bound::new(py, PyClassInitializer::from(Solid::new(given)).add_subclass(csg))
    }
}

/// Wraps an expression of the library, with the recipe to make it again.
macro_rules! made {
    ($py:expr, $expression:expr, $name:literal, $($argument:expr),*) => {{
        let expression: Result<Expression, Error> = $expression;
        Csg::made($py, expression.or_raise($py)?, $name, ($($argument,)*))
    }};
}

#[pymethods]
impl Csg {
    /// Makes an expression of a `solid` of another kind.
    #[staticmethod]
    fn of<'py>(solid: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        let py = solid.py();
        made!(py, Ok(expression(solid, "solid")?), "of", solid)
    }

    /// Returns the half-space of the points p with `normal` · p + `offset` ≥ 0. The normal has any length and
    /// points into the solid.
    #[staticmethod]
    fn half_space<'py>(
        normal: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::offset)] offset: f64,
    ) -> PyResult<Bound<'py, Csg>> {
        let (py, n) = (normal.py(), triple(normal, "normal")?);
        made!(py, Expression::half_space(n, offset), "half_space", n, offset)
    }

    /// Returns the points where a polynomial of degree two is not negative. The ten `coefficients` belong to
    /// xx, yy, zz, xy, yz, zx, x, y, z and 1.
    #[staticmethod]
    fn quadric<'py>(
        py: Python<'py>,
        #[pyo3(from_py_with = named::coefficients)] coefficients: [f64; 10],
    ) -> PyResult<Bound<'py, Csg>> {
        let half = leafless::solid::HalfSpace::quadric(coefficients).map(Expression::from);
        made!(py, half, "quadric", coefficients)
    }

    /// Returns the block between its lower corner `min` and its upper corner `max`.
    ///
    /// >>> Csg.cuboid([0, 0, 0], [1, 2, 3]).bounds
    /// array([[0., 0., 0.],
    ///        [1., 2., 3.]])
    #[staticmethod]
    fn cuboid<'py>(min: &Bound<'py, PyAny>, max: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        let (py, a, b) = (min.py(), triple(min, "min")?, triple(max, "max")?);
        made!(py, Expression::cuboid(a, b), "cuboid", a, b)
    }

    /// Returns the ball with a `radius` around a `centre`.
    #[staticmethod]
    fn ball<'py>(
        centre: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::radius)] radius: f64,
    ) -> PyResult<Bound<'py, Csg>> {
        let (py, c) = (centre.py(), triple(centre, "centre")?);
        made!(py, Expression::ball(c, radius), "ball", c, radius)
    }

    /// Returns the ellipsoid around a `centre` with the semi-axes `radii` along x, y and z.
    #[staticmethod]
    fn ellipsoid<'py>(centre: &Bound<'py, PyAny>, radii: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        let (py, c, r) = (centre.py(), triple(centre, "centre")?, triple(radii, "radii")?);
        made!(py, Expression::ellipsoid(c, r).map_err(called([("radius", "radii")])), "ellipsoid", c, r)
    }

    /// Returns the cylinder with a `radius` around the z axis, between the heights `low` and `high`.
    #[staticmethod]
    fn cylinder(
        py: Python<'_>,
        #[pyo3(from_py_with = named::radius)] radius: f64,
        #[pyo3(from_py_with = named::low)] low: f64,
        #[pyo3(from_py_with = named::high)] high: f64,
    ) -> PyResult<Bound<'_, Csg>> {
        made!(py, Expression::cylinder(radius, low, high).map_err(height(low)), "cylinder", radius, low, high)
    }

    /// Returns the cylinder with a `radius` between two points on its axis, `start` and `end`.
    #[staticmethod]
    #[pyo3(signature = (start, end, radius))]
    fn cylinder_between<'py>(
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::radius)] radius: f64,
    ) -> PyResult<Bound<'py, Csg>> {
        let (py, [a, b]) = (start.py(), ends(start, end)?);
        made!(
            py,
            Expression::cylinder_between(a, b, radius).map_err(called([ENDS[0], ENDS[1]])),
            "cylinder_between",
            a,
            b,
            radius
        )
    }

    /// Returns the frustum of a cone around the z axis, between the heights `low` and `high`. The radius is
    /// `bottom` at the lower height and `top` at the upper one. One of the radii may be 0.
    #[staticmethod]
    fn frustum(
        py: Python<'_>,
        #[pyo3(from_py_with = named::bottom)] bottom: f64,
        #[pyo3(from_py_with = named::top)] top: f64,
        #[pyo3(from_py_with = named::low)] low: f64,
        #[pyo3(from_py_with = named::high)] high: f64,
    ) -> PyResult<Bound<'_, Csg>> {
        let found = Expression::frustum(bottom, top, low, high).map_err(height(low));
        let found = found
            .map_err(called([("radius", if is_fit(bottom) && bottom >= 0.0 { "top" } else { "bottom" })]));
        made!(py, found, "frustum", bottom, top, low, high)
    }

    /// Returns the frustum of a cone between two points on its axis, `start` and `end`, with the two `radii`
    /// there. One of them may be 0.
    #[staticmethod]
    fn frustum_between<'py>(
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::radii)] radii: [f64; 2],
    ) -> PyResult<Bound<'py, Csg>> {
        let (py, [a, b]) = (start.py(), ends(start, end)?);
        made!(
            py,
            Expression::frustum_between(a, b, radii).map_err(called(ENDS)),
            "frustum_between",
            a,
            b,
            radii
        )
    }

    /// Returns the torus around the z axis: all points at most `minor` from the circle with the radius
    /// `major` in the plane z = 0.
    #[staticmethod]
    fn torus(
        py: Python<'_>,
        #[pyo3(from_py_with = named::major)] major: f64,
        #[pyo3(from_py_with = named::minor)] minor: f64,
    ) -> PyResult<Bound<'_, Csg>> {
        made!(py, Expression::torus(major, minor), "torus", major, minor)
    }

    /// Returns a block with the edges `size` along x, y and z and a corner at the origin. Its top face has
    /// the length `top` along x; with 0 it is a wedge.
    #[staticmethod]
    fn wedge<'py>(
        size: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::top)] top: f64,
    ) -> PyResult<Bound<'py, Csg>> {
        let (py, s) = (size.py(), triple(size, "size")?);
        made!(py, Expression::wedge(s, top), "wedge", s, top)
    }

    /// Returns the prism over a simple `polygon` in the xy plane (points of shape (n, 2)), between the
    /// heights `low` and `high`.
    #[staticmethod]
    fn prism<'py>(
        polygon: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::low)] low: f64,
        #[pyo3(from_py_with = named::high)] high: f64,
    ) -> PyResult<Bound<'py, Csg>> {
        let py = polygon.py();
        let corners = arrays::table::<2>(polygon, "polygon")?;
        let found = py.detach(|| Expression::prism(&corners, low, high)).map_err(height(low));
        made!(py, found, "prism", corners, low, high)
    }

    /// Returns the intersection of the half-spaces normal · p + offset ≥ 0, given as `planes`: rows of four
    /// numbers, the normal first.
    #[staticmethod]
    fn convex<'py>(planes: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        let py = planes.py();
        let rows = arrays::table::<4>(planes, "planes")?;
        let sides: Vec<_> = rows.iter().map(|&[a, b, c, d]| ([a, b, c], d)).collect();
        let found = Expression::convex(&sides).map_err(called([("normal", "planes"), ("offset", "planes")]));
        made!(py, found, "convex", rows)
    }

    /// Returns the empty set.
    #[staticmethod]
    fn empty(py: Python<'_>) -> PyResult<Bound<'_, Csg>> {
        made!(py, Ok(Expression::empty()), "empty",)
    }

    /// Returns all of space.
    #[staticmethod]
    fn everything(py: Python<'_>) -> PyResult<Bound<'_, Csg>> {
        made!(py, Ok(Expression::everything()), "everything",)
    }

    /// Returns the union of any number of `solids`: the points that lie in at least one of them. For many
    /// solids it is faster than repeated `|`.
    #[staticmethod]
    #[pyo3(signature = (*solids))]
    fn union_of<'py>(solids: &Bound<'py, PyTuple>) -> PyResult<Bound<'py, Csg>> {
        let parts = all(solids, "solids")?;
        let whole = solids.py().detach(|| Expression::union_of(parts)).or_raise(solids.py())?;
        Csg::made(solids.py(), whole, "union_of", solids.clone())
    }

    /// Returns the intersection of any number of `solids`: the points that lie in all of them.
    #[staticmethod]
    #[pyo3(signature = (*solids))]
    fn intersection_of<'py>(solids: &Bound<'py, PyTuple>) -> PyResult<Bound<'py, Csg>> {
        let parts = all(solids, "solids")?;
        let whole = solids.py().detach(|| Expression::intersection_of(parts)).or_raise(solids.py())?;
        Csg::made(solids.py(), whole, "intersection_of", solids.clone())
    }

    /// Returns the points that lie in the `first` solid and in none of the `others`.
    #[staticmethod]
    #[pyo3(signature = (first, *others))]
    fn difference_of<'py>(
        first: &Bound<'py, PyAny>,
        others: &Bound<'py, PyTuple>,
    ) -> PyResult<Bound<'py, Csg>> {
        let py = first.py();
        let others_of = all(others, "others")?;
        let own = expression(first, "first")?;
        let whole = py.detach(|| match &others_of[..] {
            // A difference of two solids must have the fingerprint of `first - other` when it is pickled and
            // restored.
            [other] => own.difference(other),
            _ => own.difference(&Expression::union_of(others_of)?),
        });
        let whole = whole.or_raise(py)?;
        let arguments = [first.clone()].into_iter().chain(others.iter());
        Csg::made(py, whole, "difference_of", PyTuple::new(py, arguments.collect::<Vec<_>>())?)
    }

    /// Returns the symmetric difference: the points that lie in an odd number of the `solids`.
    #[staticmethod]
    #[pyo3(signature = (*solids))]
    fn xor_of<'py>(solids: &Bound<'py, PyTuple>) -> PyResult<Bound<'py, Csg>> {
        let parts = all(solids, "solids")?;
        let whole = solids.py().detach(|| Expression::xor_of(parts)).or_raise(solids.py())?;
        Csg::made(solids.py(), whole, "xor_of", solids.clone())
    }

    /// Returns the complement of a `solid`, as `~solid`.
    #[staticmethod]
    fn complement_of<'py>(solid: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        made!(solid.py(), Ok(expression(solid, "solid")?.complement()), "complement_of", solid)
    }

    /// Returns a `solid` moved by a `placement`, an `Affine` or a matrix, as `placement @ solid`.
    #[staticmethod]
    fn placed_of<'py>(solid: &Bound<'py, PyAny>, placement: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        let map = affine(placement, "placement")?;
        let moved = expression(solid, "solid")?.placed(&map);
        made!(solid.py(), moved, "placed_of", solid, Affine(map))
    }

    /// Reads the solid of a scene. `text` is in the language that OpenSCAD writes as `.csg`. Files that it
    /// names lie in `folder`; files longer than `max_bytes` are refused.
    ///
    /// >>> Csg.from_scene("difference() { cube([4, 4, 4]); cylinder(h = 9, r = 1); }").bounds[1]
    /// array([4., 4., 4.])
    #[staticmethod]
    #[pyo3(signature = (text, folder=None, **limits))]
    fn from_scene<'py>(
        py: Python<'py>,
        #[pyo3(from_py_with = named::text)] text: &str,
        #[pyo3(from_py_with = named::folder)] folder: Option<PathBuf>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        scene(py, text, folder.as_deref(), Path::new("scene"), &Limits::of(limits)?)
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let (name, arguments) = &slf.get().recipe;
        let count = arguments.bind(slf.py()).len();
        if *name == "from_scene" {
            let text: String = arguments.bind(slf.py()).get_item(0)?.extract()?;
            return Ok(format!("<Csg: from_scene ({} lines)>", text.lines().count()));
        }
        if arguments.bind(slf.py()).iter().any(|argument| is_solid(&argument)) {
            return Ok(format!("<Csg: {name} ({count})>"));
        }
        let told: Vec<_> = arguments.bind(slf.py()).iter().map(|argument| argument.to_string()).collect();
        Ok(format!("Csg.{name}({})", told.join(", ")))
    }

    /// Pickles the recipe: names, numbers, and the solids in the expression.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let again = from_package!(slf.py(), "leafless._pickle", "csg")?;
        Ok((again, (steps(slf)?,).into_bound_py_any(slf.py())?))
    }

    // Like a tuple, an expression never changes. So each cycle through it contains another object that the
    // collector can clear.
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.recipe.1)
    }
}

/// Returns the recipe of an expression as a list of steps, each a name and arguments, so that restoring needs
/// no recursion. An expression among the arguments is the number of the step that made it. It has one step
/// however often it occurs.
fn steps<'py>(whole: &Bound<'py, Csg>) -> PyResult<Bound<'py, PyList>> {
    let py = whole.py();
    let steps = PyList::empty(py);
    let mut numbers: HashMap<_, usize> = HashMap::new();
    let mut rest = vec![(whole.clone(), false)];
    while let Some((csg, has_parts)) = rest.pop() {
        if numbers.contains_key(&csg.as_ptr()) {
            continue;
        }
        let (name, arguments) = &csg.get().recipe;
        let arguments = arguments.bind(py);
        if !has_parts {
            rest.push((csg.clone(), true));
            rest.extend(arguments.iter().filter_map(|part| Some((part.cast_into::<Csg>().ok()?, false))));
            continue;
        }
        let told = arguments.iter().map(|argument| match numbers.get(&argument.as_ptr()) {
            Some(number) => number.into_bound_py_any(py),
            None => Ok(argument),
        });
        let told = PyTuple::new(py, told.collect::<PyResult<Vec<_>>>()?)?;
        numbers.insert(csg.as_ptr(), steps.len());
        steps.append((*name, told))?;
    }
    Ok(steps)
}

/// The library's names of the ends of an axis, and of the radii there.
const ENDS: [(&str, &str); 3] = [("from", "start"), ("to", "end"), ("radius", "radii")];

/// Reads the ends of an axis, which must differ.
fn ends(start: &Bound<'_, PyAny>, end: &Bound<'_, PyAny>) -> PyResult<[[f64; 3]; 2]> {
    let (a, b) = (triple(start, "start")?, triple(end, "end")?);
    if a == b { Err(refused(start.py(), "end", "must be another point than start")) } else { Ok([a, b]) }
}

/// Returns whether a number is zero or has a magnitude that the library supports.
fn is_fit(number: f64) -> bool {
    number == 0.0 || (2f64.powi(-256)..=2f64.powi(256)).contains(&number.abs())
}

/// Names the height that is refused.
fn height(low: f64) -> impl Fn(Error) -> Error {
    called([("height", if is_fit(low) { "high" } else { "low" })])
}

/// Reads solids as expressions.
fn all(solids: &Bound<'_, PyTuple>, name: &str) -> PyResult<Vec<Expression>> {
    solids.iter().map(|solid| expression(&solid, name)).collect()
}

/// Returns a solid as an expression.
pub fn expression(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Expression> {
    match object.cast::<Csg>() {
        Ok(csg) => Ok(csg.get().expression.clone()),
        Err(_) => Ok(Expression::solid(anywhere(given(object, name)?.any()))),
    }
}

/// Reads the solid of a scene.
pub fn scene<'py>(
    py: Python<'py>,
    text: &str,
    folder: Option<&Path>,
    name: &Path,
    limits: &Limits,
) -> PyResult<Bound<'py, PyAny>> {
    // The recipe must find the files from any working directory.
    let here = |folder: &Path| {
        std::path::absolute(if folder.as_os_str().is_empty() { Path::new(".") } else { folder })
    };
    let folder = folder.map(here).transpose().map_err(Error::Io).or_raise(py)?;
    let folder = folder.as_deref();
    let whole = limits.run(py, |control| {
        let mut options = SceneOptions::default();
        options.max_bytes = control.max_bytes;
        let scene = options.read(text, folder).map_err(|error| error.of_file(name))?;
        let (min, max) = scene.bounds()?.unwrap_or(([0.0; 3], [1.0; 3]));
        // Octrees in the scene lie on a frame; other solids can be queried on any.
        let frame = Frame::fitted(min, max, MAX_DEPTH).or_else(|_| Frame::new([0.0; 3], 1.0, MAX_DEPTH))?;
        scene.solid(&frame)
    })?;
    let recipe = (text, folder.map(Path::to_path_buf)).into_pyobject(py)?;
    Ok(Csg::made(py, whole, "from_scene", recipe)?.into_any())
}
