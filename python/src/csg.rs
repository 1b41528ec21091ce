//! Expressions of half-spaces, and of any other solids.

use crate::arrays::{self, triple};
use crate::error::OrRaise;
use crate::from_package;
use crate::operators::expression;
use crate::solid::{Given, Solid};
use leafless::error::Error;
use leafless::{AnySolid, Csg as Expression};
use pyo3::IntoPyObjectExt;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// An expression: half-spaces, primitives, and set operations of these and of any other solids.
///
/// Nothing is computed before something is asked, and then only where it matters. Numbers are taken as they are: a ball is a ball,
/// not a polyhedron.
///
/// >>> plate = Csg.cuboid([0, 0, 0], [80, 60, 10]) - Csg.cylinder_between([20, 30, -1], [20, 30, 11], 8)
/// >>> measure(plate, tolerance=1e-6).volume
/// 45989.3798 ± 0.0048
#[pyclass(extends = Solid, frozen, module = "leafless")]
pub struct Csg {
    pub expression: Expression,
    /// The function of this class and its arguments that made it. A shape of Python in the expression lives as long as these do.
    recipe: (&'static str, Py<PyTuple>),
}

impl Csg {
    /// An expression as an object, with the recipe to make it again.
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

/// An expression of the library, as an object that knows how it was made.
macro_rules! made {
    ($py:expr, $expression:expr, $name:literal, $($argument:expr),*) => {{
        let expression: Result<Expression, Error> = $expression;
        Csg::made($py, expression.or_raise($py)?, $name, ($($argument,)*))
    }};
}

#[pymethods]
impl Csg {
    /// A solid of another kind as an expression.
    #[staticmethod]
    fn of<'py>(solid: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        let py = solid.py();
        made!(py, Ok(expression(solid, "solid")?), "of", solid)
    }

    /// The points p with normal · p + offset ≥ 0. The normal, of any length, points into the solid.
    #[staticmethod]
    fn half_space<'py>(normal: &Bound<'py, PyAny>, offset: f64) -> PyResult<Bound<'py, Csg>> {
        let (py, n) = (normal.py(), triple(normal, "normal")?);
        made!(py, Expression::half_space(n, offset), "half_space", n, offset)
    }

    /// The points where a polynomial of degree two is not negative: ten coefficients, of xx, yy, zz, xy, yz, zx, x, y, z and 1.
    #[staticmethod]
    fn quadric<'py>(coefficients: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        let (py, coefficients) = (coefficients.py(), arrays::tuple::<10>(coefficients, "coefficients")?);
        let half = leafless::solid::HalfSpace::quadric(coefficients).map(Expression::from);
        made!(py, half, "quadric", coefficients)
    }

    /// The block between two corners.
    ///
    /// >>> Csg.cuboid([0, 0, 0], [1, 2, 3]).bounds
    /// array([[0., 0., 0.],
    ///        [1., 2., 3.]])
    #[staticmethod]
    fn cuboid<'py>(min: &Bound<'py, PyAny>, max: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        let (py, a, b) = (min.py(), triple(min, "min")?, triple(max, "max")?);
        made!(py, Expression::cuboid(a, b), "cuboid", a, b)
    }

    /// The ball around a centre.
    #[staticmethod]
    fn ball<'py>(centre: &Bound<'py, PyAny>, radius: f64) -> PyResult<Bound<'py, Csg>> {
        let (py, c) = (centre.py(), triple(centre, "centre")?);
        made!(py, Expression::ball(c, radius), "ball", c, radius)
    }

    /// The ellipsoid around a centre with semi-axes along x, y and z.
    #[staticmethod]
    fn ellipsoid<'py>(centre: &Bound<'py, PyAny>, radii: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        let (py, c, r) = (centre.py(), triple(centre, "centre")?, triple(radii, "radii")?);
        made!(py, Expression::ellipsoid(c, r), "ellipsoid", c, r)
    }

    /// The cylinder around the z axis between two heights.
    #[staticmethod]
    fn cylinder(py: Python<'_>, radius: f64, low: f64, high: f64) -> PyResult<Bound<'_, Csg>> {
        made!(py, Expression::cylinder(radius, low, high), "cylinder", radius, low, high)
    }

    /// The cylinder between two points on its axis.
    #[staticmethod]
    #[pyo3(signature = (start, end, radius))]
    fn cylinder_between<'py>(
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        radius: f64,
    ) -> PyResult<Bound<'py, Csg>> {
        let (py, a, b) = (start.py(), triple(start, "start")?, triple(end, "end")?);
        made!(py, Expression::cylinder_between(a, b, radius), "cylinder_between", a, b, radius)
    }

    /// The frustum of a cone around the z axis: its radii at the lower and at the upper height. One of them may be 0.
    #[staticmethod]
    fn frustum(py: Python<'_>, bottom: f64, top: f64, low: f64, high: f64) -> PyResult<Bound<'_, Csg>> {
        made!(py, Expression::frustum(bottom, top, low, high), "frustum", bottom, top, low, high)
    }

    /// The frustum of a cone between two points on its axis, with the radii there.
    #[staticmethod]
    fn frustum_between<'py>(
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, Csg>> {
        let (py, a, b) = (start.py(), triple(start, "start")?, triple(end, "end")?);
        let radii = arrays::tuple::<2>(radii, "radii")?;
        made!(py, Expression::frustum_between(a, b, radii), "frustum_between", a, b, radii)
    }

    /// The torus around the z axis: all points at most `minor` from the circle of the radius `major` in the plane z = 0.
    #[staticmethod]
    fn torus(py: Python<'_>, major: f64, minor: f64) -> PyResult<Bound<'_, Csg>> {
        made!(py, Expression::torus(major, minor), "torus", major, minor)
    }

    /// The block of a size with a corner at the origin, whose top face is `top` long along x: a wedge for 0.
    #[staticmethod]
    fn wedge<'py>(size: &Bound<'py, PyAny>, top: f64) -> PyResult<Bound<'py, Csg>> {
        let (py, s) = (size.py(), triple(size, "size")?);
        made!(py, Expression::wedge(s, top), "wedge", s, top)
    }

    /// The prism over a simple polygon in the plane of x and y (points of shape (n, 2)), between two heights.
    #[staticmethod]
    fn prism<'py>(polygon: &Bound<'py, PyAny>, low: f64, high: f64) -> PyResult<Bound<'py, Csg>> {
        let py = polygon.py();
        let corners: Vec<[f64; 2]> =
            arrays::doubles(polygon, "polygon")?.call_method0("tolist")?.extract()?;
        made!(py, Expression::prism(&corners, low, high), "prism", corners, low, high)
    }

    /// What lies in all half-spaces normal · p + offset ≥ 0, given as rows of four numbers.
    #[staticmethod]
    fn convex<'py>(planes: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        let py = planes.py();
        let rows: Vec<[f64; 4]> = arrays::doubles(planes, "planes")?.call_method0("tolist")?.extract()?;
        let sides: Vec<_> = rows.iter().map(|&[a, b, c, d]| ([a, b, c], d)).collect();
        made!(py, Expression::convex(&sides), "convex", rows)
    }

    /// No points.
    #[staticmethod]
    fn empty(py: Python<'_>) -> PyResult<Bound<'_, Csg>> {
        made!(py, Ok(Expression::empty()), "empty",)
    }

    /// All of space.
    #[staticmethod]
    fn everything(py: Python<'_>) -> PyResult<Bound<'_, Csg>> {
        made!(py, Ok(Expression::everything()), "everything",)
    }

    /// What at least one of any number of solids contains: for many at once faster than `|` one after another.
    #[staticmethod]
    #[pyo3(signature = (*solids))]
    fn union_of<'py>(solids: &Bound<'py, PyTuple>) -> PyResult<Bound<'py, Csg>> {
        let whole = Expression::union_of(all(solids)?).or_raise(solids.py())?;
        Csg::made(solids.py(), whole, "union_of", solids.clone())
    }

    /// What all of any number of solids contain.
    #[staticmethod]
    #[pyo3(signature = (*solids))]
    fn intersection_of<'py>(solids: &Bound<'py, PyTuple>) -> PyResult<Bound<'py, Csg>> {
        let whole = Expression::intersection_of(all(solids)?).or_raise(solids.py())?;
        Csg::made(solids.py(), whole, "intersection_of", solids.clone())
    }

    /// What the first solid contains, and none of the others.
    #[staticmethod]
    #[pyo3(signature = (first, *others))]
    fn difference_of<'py>(
        first: &Bound<'py, PyAny>,
        others: &Bound<'py, PyTuple>,
    ) -> PyResult<Bound<'py, Csg>> {
        let py = first.py();
        let away = Expression::union_of(all(others)?).or_raise(py)?;
        let whole = expression(first, "first")?.difference(&away).or_raise(py)?;
        let arguments = [first.clone()].into_iter().chain(others.iter());
        Csg::made(py, whole, "difference_of", PyTuple::new(py, arguments.collect::<Vec<_>>())?)
    }

    /// What an odd number of the solids contain.
    #[staticmethod]
    #[pyo3(signature = (*solids))]
    fn xor_of<'py>(solids: &Bound<'py, PyTuple>) -> PyResult<Bound<'py, Csg>> {
        let whole = Expression::xor_of(all(solids)?).or_raise(solids.py())?;
        Csg::made(solids.py(), whole, "xor_of", solids.clone())
    }

    /// What a solid leaves of space, as `~solid`.
    #[staticmethod]
    fn complement_of<'py>(solid: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        made!(solid.py(), Ok(expression(solid, "solid")?.complement()), "complement_of", solid)
    }

    /// A solid moved by a map, as `placement @ solid`.
    #[staticmethod]
    fn placed_of<'py>(solid: &Bound<'py, PyAny>, placement: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Csg>> {
        let map = crate::affine::affine(placement, "placement")?;
        let moved = expression(solid, "solid")?.placed(&map);
        made!(solid.py(), moved, "placed_of", solid, crate::affine::Affine(map))
    }

    /// The solid of a scene, a text in the language that OpenSCAD writes as `.csg`; files that it names lie in `folder`.
    ///
    /// >>> Csg.from_scene("difference() { cube([4, 4, 4]); cylinder(h = 9, r = 1); }").bounds[1]
    /// array([4., 4., 4.])
    #[staticmethod]
    #[pyo3(signature = (text, folder=None))]
    fn from_scene<'py>(py: Python<'py>, text: &str, folder: Option<PathBuf>) -> PyResult<Bound<'py, PyAny>> {
        crate::files::scene(py, text, folder.as_deref(), Path::new("scene"))
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let (name, arguments) = &slf.get().recipe;
        let count = arguments.bind(slf.py()).len();
        if *name == "from_scene" {
            let text: String = arguments.bind(slf.py()).get_item(0)?.extract()?;
            return Ok(format!("<Csg: from_scene ({} lines)>", text.lines().count()));
        }
        if arguments.bind(slf.py()).iter().any(|argument| crate::solid::is_solid(&argument)) {
            return Ok(format!("<Csg: {name} ({count})>"));
        }
        let told: Vec<_> = arguments.bind(slf.py()).iter().map(|argument| argument.to_string()).collect();
        Ok(format!("Csg.{name}({})", told.join(", ")))
    }

    /// By how it was made: names and numbers, and the solids in it.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let again = from_package!(slf.py(), "leafless._pickle", "csg")?;
        Ok((again, (steps(slf)?,).into_bound_py_any(slf.py())?))
    }

    // Like a tuple, an expression never changes, so that each cycle through it has an object that the collector can clear.
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.recipe.1)
    }
}

/// The recipe of an expression as a list of steps, each a name and arguments, that needs no recursion. An expression among the
/// arguments is the number of the step that made it, and has one step however often it occurs.
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

/// Solids as expressions.
fn all(solids: &Bound<'_, PyTuple>) -> PyResult<Vec<Expression>> {
    solids.iter().map(|solid| expression(&solid, "solids")).collect()
}
