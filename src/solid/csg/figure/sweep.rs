//! Plane figures, and the solids that they sweep: prisms, tapered prisms and solids of revolution.
//!
//! A figure is an expression of half-planes and conics in x and y. As a solid it is the cylinder over itself
//! along z, so that placements and set operations in the plane are those of space. A swept solid replaces
//! each half-plane and each conic by the solid that it sweeps; nothing is rounded.

use super::fan::Fan;
use crate::error::Error;
use crate::lattice::Affine;
use crate::lattice::Each;
use crate::lattice::exact::Dyadic;
use crate::memory;
use crate::solid::csg::primitive::slab;
use crate::solid::csg::{Csg, Join, Kind, Node};
use crate::solid::half_space::map::{ExactMap, MOST_BITS, MOST_BITS_ARE};
use crate::solid::half_space::quadric::substitute;
use crate::solid::half_space::torus::Torus;
use crate::solid::half_space::{HalfSpace, Surface};
use alloc::sync::Arc;
use alloc::vec::Vec;

/// A set of points in the plane.
#[derive(Clone)]
pub(crate) struct Figure {
    /// The cylinder over the figure along z.
    csg: Csg,
    /// A rectangle that contains the figure; `None` if the figure is empty.
    extent: Option<Rectangle>,
    /// A rectangle that the figure contains, if one is known.
    core: Option<Rectangle>,
}

/// A rectangle by its lower and upper corner.
#[derive(Clone)]
struct Rectangle {
    min: [Dyadic; 2],
    max: [Dyadic; 2],
}

const ONE_SIDE: &str = "must lie on one side of the axis, x ≥ 0 or x ≤ 0";

/// The coefficients of a x² + b y² + c xy + d x + e y + f.
type Conic = [Dyadic; 6];

fn refuse<T>(name: &'static str, problem: &'static str) -> Result<T, Error> {
    Err(Error::Argument { name, problem })
}

impl Figure {
    pub(crate) fn nothing() -> Figure {
        Figure { csg: Csg::empty(), extent: None, core: None }
    }

    /// Returns the rectangle between two corners. Coordinates must be zero or of a magnitude between 2^-256
    /// and 2^256, and `min` less than `max`.
    pub(crate) fn rectangle(min: [f64; 2], max: [f64; 2]) -> Result<Figure, Error> {
        let sides = (0..2).flat_map(|axis| slab(axis, min[axis], max[axis]));
        let extent = Some(Rectangle { min: min.each(Dyadic::new), max: max.each(Dyadic::new) });
        Ok(Figure { csg: Csg::intersection_of(sides)?, core: extent.clone(), extent })
    }

    /// Returns the disc of a radius between 2^-256 and 2^256 around the origin.
    pub(crate) fn disc(radius: f64) -> Figure {
        let [squares, linear] = [[-1.0, -1.0, 0.0], [0.0; 3]].each(|c| c.each(Dyadic::new));
        let disc = HalfSpace::separable(squares, linear, Dyadic::new(radius).pow(2));
        let [min, max] = [-radius, radius].each(|x| [x; 2].each(Dyadic::new));
        let extent = Some(Rectangle { min, max });
        Figure { csg: disc.into(), extent, core: None }
    }

    /// Returns the polygon that replaces a disc of a radius between 2^-256 and 2^256.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(crate) fn regular(radius: f64, fan: &Fan) -> Result<Figure, Error> {
        let radius = Dyadic::new(radius);
        let csg = fan.sweep([Dyadic::new(-1.0), Dyadic::zero(), radius.clone()])?;
        Ok(Figure { csg, extent: Rectangle::around(fan, &radius), core: None })
    }

    /// Returns the simple polygon with these corners, in either direction.
    ///
    /// # Errors
    /// As [`Csg::prism`].
    pub(crate) fn polygon(points: &[[f64; 2]]) -> Result<Figure, Error> {
        let csg = Csg::column(points)?;
        let limit = |axis: usize, least: bool| {
            let of = points.iter().map(|point| point[axis]);
            Dyadic::new(if least {
                of.fold(f64::INFINITY, f64::min)
            } else {
                of.fold(f64::NEG_INFINITY, f64::max)
            })
        };
        let extent =
            Rectangle { min: [limit(0, true), limit(1, true)], max: [limit(0, false), limit(1, false)] };
        Ok(Figure { csg, extent: Some(extent), core: None })
    }

    fn join(join: Join, figures: Vec<Figure>, extent: Option<Rectangle>) -> Result<Figure, Error> {
        let csg = Csg::join(join, figures.into_iter().map(|figure| figure.csg))?;
        Ok(Figure { csg, extent, core: None })
    }

    pub(crate) fn union_of(figures: Vec<Figure>) -> Result<Figure, Error> {
        let extent = hull(&figures);
        Figure::join(Join::Union, figures, extent)
    }

    /// Returns the symmetric difference: the points in an odd number of figures.
    pub(crate) fn xor_of(figures: Vec<Figure>) -> Result<Figure, Error> {
        let extent = hull(&figures);
        Figure::join(Join::Parity, figures, extent)
    }

    /// Returns the intersection of the figures; there must be at least one.
    pub(crate) fn intersection_of(figures: Vec<Figure>) -> Result<Figure, Error> {
        let extents = figures.iter().map(|figure| figure.extent.clone());
        let extent = extents.reduce(|a, b| a?.common(&b?)).flatten();
        Figure::join(Join::Intersection, figures, extent)
    }

    /// Returns the points of this figure that lie in none of `others`.
    pub(crate) fn difference(&self, others: Vec<Figure>) -> Result<Figure, Error> {
        let cores = others.iter().filter_map(|other| other.core.as_ref());
        let extent = cores.fold(self.extent.clone(), |extent, core| extent?.without(core));
        let csg = self.csg.difference(&Figure::union_of(others)?.csg)?;
        Ok(Figure { csg, extent, core: None })
    }

    /// Returns the figure under the map of the plane with the rows of `[M | t]`. The result is empty if the
    /// map takes the plane to a line.
    ///
    /// # Errors
    /// As [`Affine::new`]; [`Error::Limit`] if exact coordinates become too long.
    pub(crate) fn placed(&self, rows: [[f64; 3]; 2]) -> Result<Figure, Error> {
        let [[a, b, s], [c, d, t]] = rows;
        let placement = match Affine::new([[a, b, 0.0, s], [c, d, 0.0, t], [0.0, 0.0, 1.0, 0.0]]) {
            Err(Error::Argument { problem: Affine::SINGULAR, .. }) => return Ok(Figure::nothing()),
            placement => placement?,
        };
        let keeps_axes = b == 0.0 && c == 0.0 || a == 0.0 && d == 0.0;
        let core = self.core.as_ref().filter(|_| keeps_axes).map(|core| core.placed(rows));
        let extent = self.extent.as_ref().map(|extent| extent.placed(rows));
        if extent.as_ref().is_some_and(|extent| extent.bits() > MOST_BITS) {
            return Err(Error::Limit { what: MOST_BITS_ARE, limit: MOST_BITS });
        }
        Ok(Figure { csg: self.csg.placed(&placement)?, extent, core })
    }

    /// Returns the prism over the figure between two heights, `low` less than `high`.
    pub(crate) fn prism(&self, low: f64, high: f64) -> Result<Csg, Error> {
        let Some(extent) = &self.extent else { return Ok(Csg::empty()) };
        extent.between(self.csg.clone(), low, high)
    }

    /// Returns the tapered prism between two heights, `low` less than `high`. Its section at `low` is the
    /// figure. The section is scaled about the z axis linearly with the height, to `scale` ≥ 0 (along x and
    /// y) at `high`.
    ///
    /// # Errors
    /// [`Error::Argument`] if the scales differ and the figure has curves.
    pub(crate) fn tapered(&self, low: f64, high: f64, scale: [f64; 2]) -> Result<Csg, Error> {
        let Some(extent) = &self.extent else { return Ok(Csg::empty()) };
        let (bottom, height) = (Dyadic::new(low), &Dyadic::new(high) - &Dyadic::new(low));
        // The scale at z times the height, [constant, factor of z], along both axes. It is not negative
        // between the heights.
        let scales = scale.each(|scale| {
            let slope = &Dyadic::new(scale) - &Dyadic::new(1.0);
            [&height - &(&slope * &bottom), slope]
        });
        let sides = self.with_half_planes(|conic| taper(conic, &height, &scales))?;
        let [x, y] = scale;
        let end = extent.placed([[x, 0.0, 0.0], [0.0, y, 0.0]]);
        extent.hull(&end).between(sides, low, high)
    }

    /// Returns whether the figure lies where x ≤ 0.
    pub(crate) fn is_mirrored(&self) -> bool {
        self.extent.as_ref().is_some_and(|extent| extent.max[0].sign() <= 0)
    }

    /// Returns the solid of revolution: the figure is put into the plane of x and z, with x to x and y to z,
    /// and turned around the z axis.
    ///
    /// # Errors
    /// [`Error::Argument`] if the figure is not known to lie on one side of its y axis, or if it has curves
    /// other than circles.
    pub(crate) fn revolved(&self) -> Result<Csg, Error> {
        let Some(Rectangle { min, max }) = &self.extent else { return Ok(Csg::empty()) };
        let is_mirrored = self.is_mirrored();
        if !is_mirrored && min[0].sign() < 0 {
            return refuse("figure", ONE_SIDE);
        }
        let solid = self.with_half_planes(|mut conic| {
            if is_mirrored {
                (conic[2], conic[3]) = (-&conic[2], -&conic[3]);
            }
            revolve(conic)
        })?;
        let radius = up(if is_mirrored { -&min[0] } else { max[0].clone() });
        let [low, high] = [down(&min[1]), up(max[1].clone())];
        Ok(Csg::intersection_of([solid])?.within([-radius, -radius, low], [radius, radius, high]))
    }

    /// The greatest distance of the figure from the y axis; 0 for an empty figure.
    pub(crate) fn reach(&self) -> f64 {
        let Some(extent) = &self.extent else { return 0.0 };
        (-down(&extent.min[0])).max(up(extent.max[0].clone())).max(0.0)
    }

    /// Returns the solid of [`revolved`](Self::revolved) with polygons instead of circles; only a part of it
    /// if the fan is open. The fan begins where points with x > 0 begin.
    ///
    /// # Errors
    /// As [`revolved`](Self::revolved), and [`Error::Argument`] if the figure has any curves.
    pub(crate) fn turned(&self, fan: Fan) -> Result<Csg, Error> {
        let Some(Rectangle { min, max }) = &self.extent else { return Ok(Csg::empty()) };
        let is_mirrored = self.is_mirrored();
        if !is_mirrored && min[0].sign() < 0 {
            return refuse("figure", ONE_SIDE);
        }
        let fan = if is_mirrored { fan.opposite() } else { fan };
        let solid = self.with_half_planes(|[xx, yy, xy, x, y, one]| {
            if [&xx, &yy, &xy].iter().any(|c| !c.is_zero()) {
                return refuse("figure", "has curves, and is to be turned as a polygon");
            }
            fan.sweep([if is_mirrored { -&x } else { x }, y, one])
        })?;
        let radius = if is_mirrored { -&min[0] } else { max[0].clone() };
        let Some(around) = Rectangle::around(&fan, &radius) else { return Ok(Csg::empty()) };
        let [[a, b], [c, d]] = [around.min.each_ref().each(down), around.max.each(up)];
        let wedge = fan.wedge()?.unwrap_or_else(Csg::everything);
        Ok(Csg::intersection_of([solid, wedge])?.within([a, b, down(&min[1])], [c, d, up(max[1].clone())]))
    }

    /// Returns whether the figure contains a curve.
    pub(crate) fn has_curves(&self) -> Result<bool, Error> {
        let mut found = false;
        self.with_half_planes(|[xx, yy, xy, ..]| {
            found |= [&xx, &yy, &xy].iter().any(|c| !c.is_zero());
            Ok(Csg::empty())
        })?;
        Ok(found)
    }

    /// Returns the same expression with each half-plane or conic replaced by its image.
    fn with_half_planes(&self, mut image: impl FnMut(Conic) -> Result<Csg, Error>) -> Result<Csg, Error> {
        enum Task<'a> {
            Map(&'a Node, Arc<ExactMap>),
            Join(Join, usize),
            Complement,
        }
        let mut tasks = Vec::new();
        let mut images: Vec<Csg> = Vec::new();
        memory::push(&mut tasks, Task::Map(&self.csg.root, Arc::new(ExactMap::identity())))?;
        while let Some(task) = tasks.pop() {
            match task {
                Task::Map(node, map) => match &node.kind {
                    Kind::HalfSpace(half_space) => {
                        let conic = match &*half_space.0 {
                            Surface::Plane(plane) => {
                                // Like a conic, times w².
                                let [x, y, _, one] = map.linear(plane).each(|c| &c * &map.w);
                                [Dyadic::zero(), Dyadic::zero(), Dyadic::zero(), x, y, one]
                            }
                            Surface::Quadric(coefficients) => {
                                let [xx, yy, _, xy, _, _, x, y, _, one] = substitute(coefficients, &map);
                                [xx, yy, xy, x, y, one]
                            }
                            _ => return refuse("figure", "must consist of half-planes and conics"),
                        };
                        memory::push(&mut images, image(conic)?)?;
                    }
                    Kind::Placed(part, placement) => {
                        memory::push(&mut tasks, Task::Map(part, Arc::new(map.of_placed(placement)?)))?;
                    }
                    Kind::Complement(part) => {
                        memory::push(&mut tasks, Task::Complement)?;
                        memory::push(&mut tasks, Task::Map(part, map))?;
                    }
                    Kind::Join(join, parts) => {
                        memory::push(&mut tasks, Task::Join(*join, parts.len()))?;
                        for part in parts.iter().rev() {
                            memory::push(&mut tasks, Task::Map(part, map.clone()))?;
                        }
                    }
                    Kind::Solid(_) => return refuse("figure", "must consist of half-planes and conics"),
                },
                Task::Join(join, count) => {
                    let joined = Csg::join(join, images.drain(images.len() - count..))?;
                    memory::push(&mut images, joined)?;
                }
                Task::Complement => {
                    if let Some(image) = images.last_mut() {
                        *image = image.complement();
                    }
                }
            }
        }
        Ok(images.pop().unwrap_or_else(Csg::empty))
    }
}

/// Returns the image of a half-plane or conic if x and y are divided by the two scales. Each scale is a
/// linear function of z, which is not negative, over `height`.
fn taper([xx, yy, xy, x, y, one]: Conic, height: &Dyadic, scales: &[[Dyadic; 2]; 2]) -> Result<Csg, Error> {
    let zero = Dyadic::zero;
    let [p, q] = scales;
    let (x, y) = (&x * height, &y * height);
    let is_linear = xx.is_zero() && yy.is_zero() && xy.is_zero();
    if is_linear && (y.is_zero() || x.is_zero() || p == q) {
        // x h + y h + p ≥ 0.
        let scale = if y.is_zero() { p } else { q };
        let [constant, z] = scale.each_ref().each(|c| &one * c);
        return Ok(HalfSpace::linear([x, y, z, constant]).into());
    }
    let pq = |c: &Dyadic| -> [Dyadic; 3] {
        let middle = &(&p[0] * &q[1]) + &(&p[1] * &q[0]);
        [&p[0] * &q[0], middle, &p[1] * &q[1]].each(|k| &k * c)
    };
    let [constant, z, zz] = pq(&one);
    if is_linear {
        // x h q + y h p + p q ≥ 0: a hyperbolic paraboloid.
        let c = [zero(), zero(), zz, zero(), &y * &p[1], &x * &q[1], &x * &q[0], &y * &p[0], z, constant];
        return Ok(HalfSpace::exactly(c).into());
    }
    if p != q {
        return refuse(
            "scale",
            "must be the same along x and y for figures with curves; drawn as polygons, they have none",
        );
    }
    // (xx + yy + xy) h² + (x + y) h p + p² ≥ 0: a cone.
    let [xx, yy, xy] = [xx, yy, xy].each(|c| &(&c * height) * height);
    let c = [xx, yy, zz, xy, &y * &p[1], &x * &p[1], &x * &p[0], &y * &p[0], z, constant];
    Ok(HalfSpace::exactly(c).into())
}

/// Returns the image of a half-plane or circle if x is the distance from the z axis, and y is z.
fn revolve([xx, yy, xy, x, y, one]: Conic) -> Result<Csg, Error> {
    let zero = Dyadic::zero;
    if !xy.is_zero() || xx != yy {
        return refuse("figure", "has a curve that is no circle");
    }
    if !xx.is_zero() {
        return ring(xx, x, y, one);
    }
    // x r + L ≥ 0, with L = y z + 1.
    if x.is_zero() {
        return Ok(HalfSpace::linear([zero(), zero(), y, one]).into());
    }
    // Where L has the sign of x or is 0, the sum has that sign; elsewhere the squares decide.
    let square = x.pow(2);
    let inward = x.sign() < 0;
    let signed = |c: Dyadic| if inward { -&c } else { c };
    let squares = [square.clone(), square, -&y.pow(2)].each(signed);
    let linear = [zero(), zero(), signed(-&(&y * &one).shifted(1))];
    let squares = Csg::from(HalfSpace::separable(squares, linear, signed(-&one.pow(2))));
    if y.is_zero() {
        // A cylinder, unless L has the sign of x.
        return Ok(match (inward, one.sign()) {
            (false, 0..) => Csg::everything(),
            (true, ..=0) => Csg::empty(),
            _ => squares,
        });
    }
    let linear = HalfSpace::linear([zero(), zero(), y, one]).into();
    if inward { Csg::intersection_of([linear, squares]) } else { Csg::union_of([linear, squares]) }
}

/// Returns the solid of revolution of the disc with `square` (x² + y²) + `x` x + `y` y + `one` ≥ 0.
fn ring(square: Dyadic, x: Dyadic, y: Dyadic, one: Dyadic) -> Result<Csg, Error> {
    if x.is_zero() {
        let squares = [square.clone(), square.clone(), square];
        return Ok(HalfSpace::separable(squares, [Dyadic::zero(), Dyadic::zero(), y], one).into());
    }
    if x.sign() < 0 {
        return refuse("figure", "has a circle whose centre lies beyond the axis");
    }
    // With A = −square > 0 and ρ² = x² + y²: A (ρ² + z²) ≤ x ρ + y z + 1. Times 4 A, with each square
    // completed: (2 A ρ − x)² + (2 A z − y)² ≤ x² + y² + 4 A.
    let scale = -&square.shifted(1);
    let square = &(&x.pow(2) + &y.pow(2)) + &(&scale * &one).shifted(1);
    Ok(HalfSpace::ring(Torus { major: x, square, scale, shift: -&y }).into())
}

/// Returns the bounding rectangle of figures.
fn hull(figures: &[Figure]) -> Option<Rectangle> {
    let extents = figures.iter().filter_map(|figure| figure.extent.as_ref());
    extents.fold(None, |hull: Option<Rectangle>, extent| match hull {
        None => Some(extent.clone()),
        Some(hull) => Some(hull.hull(extent)),
    })
}

/// Returns a double that is not greater: the value itself if it is a double.
fn down(value: &Dyadic) -> f64 {
    value.exactly().unwrap_or_else(|| value.rounded().next_down())
}

/// Returns a double that is not less: the value itself if it is a double.
fn up(value: Dyadic) -> f64 {
    -down(&-&value)
}

impl Rectangle {
    /// Returns the bounding rectangle of the origin and the corners of a fan, times a radius.
    fn around(fan: &Fan, radius: &Dyadic) -> Option<Rectangle> {
        let end = |axis: usize, pick: fn(f64, f64) -> f64| {
            &Dyadic::new(fan.corners().iter().map(|corner| corner[axis]).fold(0.0, pick)) * radius
        };
        Rectangle {
            min: [0, 1].each(|axis| end(axis, f64::min)),
            max: [0, 1].each(|axis| end(axis, f64::max)),
        }
        .proper()
    }

    fn hull(&self, other: &Rectangle) -> Rectangle {
        Rectangle {
            min: [0, 1].each(|axis| (&self.min[axis]).min(&other.min[axis]).clone()),
            max: [0, 1].each(|axis| (&self.max[axis]).max(&other.max[axis]).clone()),
        }
    }

    fn common(&self, other: &Rectangle) -> Option<Rectangle> {
        Rectangle {
            min: [0, 1].each(|axis| (&self.min[axis]).max(&other.min[axis]).clone()),
            max: [0, 1].each(|axis| (&self.max[axis]).min(&other.max[axis]).clone()),
        }
        .proper()
    }

    /// Returns the rectangle; `None` if its interior is empty.
    fn proper(self) -> Option<Rectangle> {
        (0..2).all(|axis| self.min[axis] < self.max[axis]).then_some(self)
    }

    /// Returns the bounding rectangle of the part outside another rectangle.
    fn without(mut self, other: &Rectangle) -> Option<Rectangle> {
        for (axis, across) in [(0, 1), (1, 0)] {
            let covers = other.min[across] <= self.min[across] && other.max[across] >= self.max[across];
            if covers && other.min[axis] <= self.min[axis] {
                self.min[axis] = (&self.min[axis]).max(&other.max[axis]).clone();
            }
            if covers && other.max[axis] >= self.max[axis] {
                self.max[axis] = (&self.max[axis]).min(&other.min[axis]).clone();
            }
            self = self.proper()?;
        }
        Some(self)
    }

    /// The bits of the longest coordinate.
    fn bits(&self) -> u64 {
        self.min.iter().chain(&self.max).map(Dyadic::bits).max().unwrap_or(0)
    }

    /// Returns the bounding rectangle of the image under `[M | t]`.
    fn placed(&self, rows: [[f64; 3]; 2]) -> Rectangle {
        let limit = |row: [f64; 3], most: bool| {
            let mut sum = Dyadic::new(row[2]);
            for axis in 0..2 {
                let upper = most == (row[axis] > 0.0);
                let end = if upper { &self.max[axis] } else { &self.min[axis] };
                sum = &sum + &(&Dyadic::new(row[axis]) * end);
            }
            sum
        };
        Rectangle { min: rows.each(|row| limit(row, false)), max: rows.each(|row| limit(row, true)) }
    }

    /// Returns the part of a solid between two heights. Between them the solid must lie over the rectangle.
    fn between(&self, solid: Csg, low: f64, high: f64) -> Result<Csg, Error> {
        let [floor, ceiling] = slab(2, low, high);
        let [[x, y], [u, v]] =
            [self.min.each_ref().each(down), self.max.each_ref().each(|max| up(max.clone()))];
        Ok(Csg::intersection_of([solid, floor, ceiling])?.within([x, y, low], [u, v, high]))
    }
}

/// Returns the wedge of directions around the z axis from `start` on, counter-clockwise by `angle` degrees
/// (between 0 and 360, both exclusive). Its two planes have the directions of the angles' cosines and sines,
/// rounded to doubles. At multiples of 45° the directions are exact.
pub(crate) fn wedge(start: f64, angle: f64) -> Result<Csg, Error> {
    let side = |degrees: f64, sense: f64| {
        let [cos, sin] = direction(degrees);
        HalfSpace::plane([-sense * sin, sense * cos, 0.0], 0.0).map(Csg::from)
    };
    if angle == 180.0 {
        return side(start, 1.0);
    }
    let sides = [side(start, 1.0)?, side(start + angle, -1.0)?];
    if angle < 180.0 { Csg::intersection_of(sides) } else { Csg::union_of(sides) }
}

/// Returns cosine and sine of an angle in degrees, up to a positive factor.
fn direction(degrees: f64) -> [f64; 2] {
    let turned = libm::fmod(degrees, 360.0);
    let eighths = turned / 45.0;
    if libm::trunc(eighths) == eighths {
        let index = (eighths as i32).rem_euclid(8);
        return [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]][index as usize]
            .each(f64::from);
    }
    let (sin, cos) = libm::sincos(turned.to_radians());
    [cos, sin]
}
