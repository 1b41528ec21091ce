//! Expressions by their definition: the side of the surface on which a point lies, in exact arithmetic and
//! without cells.

use crate::cubes::Plain;
use crate::exact::Exact;
use leafless::solid::{HalfSpace, SplitCounter, Transform};
use leafless::{
    Affine, AnySolid, Callback, Csg, Error, FillRule, Frame, Interval, MeshSolid, Octree, Tag, TriangleMesh,
    Verdict,
};

/// A homogeneous point (x, y, z)/w with w ≠ 0, so that the inverse of a placement needs no division.
pub type Point = [Exact; 4];

/// A point, and the point beside it, shifted by (ε, ε², ε³): ε = 2^-20000, and, equally well, 2^-23000 and
/// 2^-26000 for the powers. Where a function is zero with a nonzero gradient, its value beside the point has
/// the sign that the gradient gives. Where the gradient is zero, the value is far smaller.
pub struct Probe {
    pub at: Point,
    pub beside: Point,
}

/// Exponent of two that separates the functions here: beside a zero with a gradient, no value is smaller;
/// beside a zero without one, no value is larger.
const SLOPE: i64 = -32_000;

#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant)] // There are few.
pub enum Model {
    Plane([f64; 3], f64),
    Quadric([f64; 10]),
    Cuboid([f64; 3], [f64; 3]),
    Ellipsoid([f64; 3], [f64; 3]),
    /// Radii at the bottom and at the top, and their heights.
    Frustum([f64; 2], [f64; 2]),
    Power([(f64, f64, u32); 3], f64),
    Torus(f64, f64),
    /// Sizes, and the length of the narrow face.
    Wedge([f64; 3], f64),
    Prism(Vec<[f64; 2]>, [f64; 2]),
    Convex(Vec<([f64; 3], f64)>),
    /// A ball of a host program.
    Host([f64; 3], f64),
    Union(Vec<Model>),
    Intersection(Vec<Model>),
    Xor(Vec<Model>),
    Difference(Box<[Model; 2]>),
    Complement(Box<Model>),
    Placed(Box<Model>, Affine),
    Other(Other),
}

/// A solid that is not a half-space.
#[derive(Clone, Debug)]
pub enum Other {
    Cuboid([f64; 3], [f64; 3]),
    Ball([f64; 3], f64),
    /// lower ≤ z ≤ upper as a callback.
    Slab(f64, f64),
    /// A tetrahedron as a mesh.
    Tetrahedron([[f64; 3]; 4]),
    Octree(Box<Octree>),
    /// Moved, from a frame of its own.
    Moved(Box<Other>, Frame, Affine),
    /// An expression behind the common solid interface.
    Model(Box<Model>),
}

fn exact(x: f64) -> Exact {
    Exact::from(x)
}

fn sum(terms: impl IntoIterator<Item = Exact>) -> Exact {
    terms.into_iter().fold(exact(0.0), |sum, term| sum.plus(&term))
}

/// Returns a · b for two doubles, times a point's coordinate.
fn times(a: f64, b: &Exact) -> Exact {
    exact(a).times(b)
}

pub fn determinant(m: [[Exact; 3]; 3]) -> Exact {
    let minor = |a: usize, b: usize| m[1][a].times(&m[2][b]).minus(&m[1][b].times(&m[2][a]));
    sum([m[0][0].times(&minor(1, 2)), m[0][1].times(&minor(2, 0)), m[0][2].times(&minor(0, 1))])
}

/// Returns the point that `placement` takes to `p`, by Cramer's rule.
fn original(placement: &Affine, p: &Point) -> Point {
    let m = placement.rows().map(|row| [row[0], row[1], row[2]].map(exact));
    let moved = [0, 1, 2].map(|i| p[i].minus(&times(placement.rows()[i][3], &p[3])));
    let replaced = |column: usize| {
        let mut m = m.clone();
        (0..3).for_each(|i| m[i][column] = moved[i].clone());
        determinant(m)
    };
    [replaced(0), replaced(1), replaced(2), p[3].times(&determinant(m))]
}

/// Returns values with the signs of a box's half-space functions at a point. The functions below do the same
/// for other primitives. All values are multiplied by w².
fn cuboid(min: [f64; 3], max: [f64; 3], p: &Point) -> Vec<Exact> {
    let sides = (0..3)
        .flat_map(|axis| [p[axis].minus(&times(min[axis], &p[3])), times(max[axis], &p[3]).minus(&p[axis])]);
    sides.map(|side| side.times(&p[3])).collect()
}

fn ellipsoid(centre: [f64; 3], radii: [f64; 3], p: &Point) -> Exact {
    // 1 − Σ ((x − c) / r)², times all r².
    let square = |x: &Exact| x.times(x);
    let r = radii.map(|r| square(&exact(r)));
    let distances = (0..3).map(|axis| square(&p[axis].minus(&times(centre[axis], &p[3]))));
    let weighted =
        distances.enumerate().map(|(axis, d)| d.times(&r[(axis + 1) % 3]).times(&r[(axis + 2) % 3]));
    square(&p[3]).times(&r[0]).times(&r[1]).times(&r[2]).minus(&sum(weighted))
}

fn slab([low, high]: [f64; 2], p: &Point) -> [Exact; 2] {
    [p[2].minus(&times(low, &p[3])).times(&p[3]), times(high, &p[3]).minus(&p[2]).times(&p[3])]
}

fn frustum(radii: [f64; 2], heights: [f64; 2], p: &Point) -> Vec<Exact> {
    // The radius at p, times the height, and both times w.
    let [below, above] = [times(heights[1], &p[3]).minus(&p[2]), p[2].minus(&times(heights[0], &p[3]))];
    let radius = times(radii[0], &below).plus(&times(radii[1], &above));
    let height = exact(heights[1]).minus(&exact(heights[0]));
    let [x, y] = [p[0].times(&height), p[1].times(&height)];
    let mantle = radius.times(&radius).minus(&x.times(&x)).minus(&y.times(&y));
    let [bottom, top] = slab(heights, p);
    vec![mantle, bottom, top]
}

fn quadric(c: [f64; 10], p: &Point) -> Exact {
    let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3), (3, 3)];
    sum(pairs.iter().zip(c).filter(|(_, c)| *c != 0.0).map(|(&(a, b), c)| times(c, &p[a].times(&p[b]))))
}

fn plane(normal: [f64; 3], offset: f64, p: &Point) -> Exact {
    let terms = (0..3).map(|axis| times(normal[axis], &p[axis]));
    sum(terms).plus(&times(offset, &p[3])).times(&p[3])
}

fn power(base: &Exact, exponent: u32) -> Exact {
    (0..exponent).fold(exact(1.0), |product, _| product.times(base))
}

fn powers(terms: &[(f64, f64, u32); 3], constant: f64, p: &Point) -> Exact {
    // An even power of w makes all terms of one degree.
    let degree = terms.iter().map(|term| term.2).max().unwrap().next_multiple_of(2);
    let along = terms.iter().enumerate().map(|(axis, &(coefficient, centre, exponent))| {
        let base = p[axis].minus(&times(centre, &p[3]));
        times(coefficient, &power(&base, exponent)).times(&power(&p[3], degree - exponent))
    });
    sum(along).plus(&times(constant, &power(&p[3], degree)))
}

/// Returns a value with the sign of minor² − (ρ − major)² − z² = 2 major ρ − rest.
fn torus(major: f64, minor: f64, p: &Point) -> Exact {
    let square = |x: &Exact| x.times(x);
    let rho = square(&p[0]).plus(&square(&p[1]));
    let radii = square(&exact(major)).minus(&square(&exact(minor)));
    let rest = rho.plus(&square(&p[2])).plus(&radii.times(&square(&p[3])));
    if rest.sign() < 0 {
        return exact(1.0);
    }
    times(4.0, &square(&times(major, &p[3])).times(&rho)).minus(&square(&rest))
}

/// Returns the side of a polygon's outline on which a point lies, by the edges that a ray crosses.
fn inside(polygon: &[[f64; 2]], p: &Point) -> i32 {
    // Everything times |w|.
    let sign = p[3].sign();
    let w = times(sign as f64, &p[3]);
    let [x, y] = [0, 1].map(|axis| times(sign as f64, &p[axis]));
    let mut crossings = 0;
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        let [ax, ay, bx, by] = [a[0], a[1], b[0], b[1]].map(|c| times(c, &w));
        let cross = bx.minus(&ax).times(&y.minus(&ay)).minus(&by.minus(&ay).times(&x.minus(&ax))).sign();
        let apart = |a: &Exact, b: &Exact, c: &Exact| a.minus(c).sign() * b.minus(c).sign() > 0;
        if cross == 0 && !apart(&ax, &bx, &x) && !apart(&ay, &by, &y) {
            return 0;
        }
        let [from, to] = [ay.minus(&y).sign() > 0, by.minus(&y).sign() > 0];
        if from != to && (cross > 0) == to {
            crossings += 1;
        }
    }
    if crossings % 2 == 1 { 1 } else { -1 }
}

/// A ball by its values and ranges.
fn host(centre: [f64; 3], radius: f64) -> HalfSpace {
    // Squared distances to the nearest and the farthest point along each axis, relative to the squares. A few
    // last places allow for rounding.
    let value = move |near: [f64; 3]| radius * radius - near.iter().map(|d| d * d).sum::<f64>();
    let slack = |size: f64| 64.0 * f64::EPSILON * size;
    HalfSpace::host(
        move |p| Ok(value([0, 1, 2].map(|axis| p[axis] - centre[axis]))),
        move |min, max| {
            let ends = |axis: usize| [min[axis] - centre[axis], max[axis] - centre[axis]];
            let far = [0, 1, 2].map(|axis| ends(axis).iter().fold(0.0, |far: f64, d| far.max(d.abs())));
            let near = [0, 1, 2].map(|axis| match ends(axis) {
                [low, high] if low > 0.0 || high < 0.0 => low.abs().min(high.abs()),
                _ => 0.0,
            });
            let coordinates = min.iter().chain(&max).chain(&centre).chain([&radius]);
            let size = coordinates.map(|c| c * c).sum::<f64>();
            Ok(Interval::new(value(far) - slack(size), value(near) + slack(size)).unwrap())
        },
        None,
    )
}

/// Returns the side of `p` for each face of a tetrahedron; the inner side is positive.
fn tetrahedron(corners: [[f64; 3]; 4], p: &Point) -> Vec<Exact> {
    let corners = corners.map(|corner| {
        let [x, y, z] = corner.map(exact);
        [x, y, z, exact(1.0)]
    });
    let volume = |a: &Point, b: &Point, c: &Point, d: &Point| {
        // The determinant of the differences to d, times the weights: all but d's are 1.
        let row = |q: &Point| [0, 1, 2].map(|i| q[i].times(&d[3]).minus(&d[i]));
        determinant([row(a), row(b), row(c)])
    };
    (0..4)
        .map(|k| {
            let [a, b, c] = [1, 2, 3].map(|i| &corners[(k + i) % 4]);
            let value = volume(a, b, c, p).times(&volume(a, b, c, &corners[k]));
            // Each row has a factor w.
            value.times(&p[3])
        })
        .collect()
}

impl Model {
    /// Returns the expression for queries on `frame`.
    pub fn csg(&self, frame: &Frame) -> Result<Csg, Error> {
        let all =
            |parts: &[Model]| parts.iter().map(|part| part.csg(frame)).collect::<Result<Vec<_>, Error>>();
        Ok(match self {
            Model::Plane(normal, offset) => Csg::half_space(*normal, *offset)?,
            Model::Quadric(c) => HalfSpace::quadric(*c)?.into(),
            Model::Cuboid(min, max) => Csg::cuboid(*min, *max)?,
            Model::Ellipsoid(centre, [r, s, t]) if r == s && s == t => Csg::ball(*centre, *r)?,
            Model::Ellipsoid(centre, radii) => Csg::ellipsoid(*centre, *radii)?,
            Model::Frustum([r, s], [low, high]) if r == s => Csg::cylinder(*r, *low, *high)?,
            Model::Frustum([r, s], [low, high]) => Csg::frustum(*r, *s, *low, *high)?,
            Model::Power(terms, constant) => HalfSpace::power(*terms, *constant)?.into(),
            Model::Torus(major, minor) => Csg::torus(*major, *minor)?,
            Model::Wedge(size, top) => Csg::wedge(*size, *top)?,
            Model::Prism(polygon, [low, high]) => Csg::prism(polygon, *low, *high)?,
            Model::Convex(planes) => Csg::convex(planes)?,
            &Model::Host(centre, radius) => host(centre, radius).into(),
            Model::Union(parts) => Csg::union_of(all(parts)?)?,
            Model::Intersection(parts) => Csg::intersection_of(all(parts)?)?,
            Model::Xor(parts) => Csg::xor_of(all(parts)?)?,
            Model::Difference(pair) => pair[0].csg(frame)?.difference(&pair[1].csg(frame)?)?,
            Model::Complement(part) => part.csg(frame)?.complement(),
            Model::Placed(part, placement) => part.csg(frame)?.placed(placement)?,
            Model::Other(other) => Csg::solid(other.solid(frame)?),
        })
    }

    /// Returns the functions of a primitive's half-spaces at a point, times a positive factor.
    fn values(&self, p: &Point) -> Vec<Exact> {
        match self {
            Model::Plane(normal, offset) => vec![plane(*normal, *offset, p)],
            Model::Quadric(c) => vec![quadric(*c, p)],
            Model::Cuboid(min, max) => cuboid(*min, *max, p),
            Model::Ellipsoid(centre, radii) => vec![ellipsoid(*centre, *radii, p)],
            Model::Frustum(radii, heights) => frustum(*radii, *heights, p),
            Model::Power(terms, constant) => vec![powers(terms, *constant, p)],
            Model::Torus(major, minor) => vec![torus(*major, *minor, p)],
            Model::Wedge(size, top) => {
                let [dx, dy] = [size[0], size[1]].map(exact);
                // dx dy + (top − dx) y − dy x.
                let slant = exact(*top).minus(&dx).times(&p[1]).minus(&dy.times(&p[0]));
                let slant = slant.plus(&dx.times(&dy).times(&p[3])).times(&p[3]);
                let far = size[0].max(*top);
                [vec![slant], cuboid([0.0; 3], [far * 2.0, size[1], size[2]], p)].concat()
            }
            Model::Convex(planes) => {
                planes.iter().map(|&(normal, offset)| plane(normal, offset, p)).collect()
            }
            Model::Host(centre, radius) => vec![ellipsoid(*centre, [*radius; 3], p)],
            _ => panic!("not a primitive"),
        }
    }

    /// Returns 1 if a point lies in the interior, −1 if it lies outside, 0 on the boundary or if the
    /// definition does not decide.
    pub fn sign(&self, p: &Point) -> i32 {
        match self {
            Model::Union(parts) => parts.iter().map(|part| part.sign(p)).max().unwrap_or(-1),
            Model::Intersection(parts) => parts.iter().map(|part| part.sign(p)).min().unwrap_or(1),
            Model::Xor(parts) => parts.iter().fold(-1, |sign, part| -sign * part.sign(p)),
            Model::Difference(pair) => pair[0].sign(p).min(-pair[1].sign(p)),
            Model::Complement(part) => -part.sign(p),
            Model::Placed(part, placement) => part.sign(&original(placement, p)),
            Model::Other(other) => other.sign(p),
            Model::Prism(polygon, heights) => inside(polygon, p).min(lowest(slab(*heights, p).to_vec())),
            primitive => lowest(primitive.values(p)),
        }
    }

    /// True if a point lies inside, after all points are shifted by (ε, ε², ε³); `None` if the definition
    /// does not decide.
    pub fn sampled(&self, probe: &Probe) -> Option<bool> {
        let all = |parts: &[Model]| parts.iter().map(|part| part.sampled(probe)).collect::<Option<Vec<_>>>();
        Some(match self {
            Model::Union(parts) => all(parts)?.contains(&true),
            Model::Intersection(parts) => !all(parts)?.contains(&false),
            Model::Xor(parts) => all(parts)?.iter().fold(false, |odd, &inside| odd != inside),
            Model::Difference(pair) => pair[0].sampled(probe)? && !pair[1].sampled(probe)?,
            Model::Complement(part) => !part.sampled(probe)?,
            Model::Placed(part, placement) => {
                let [at, beside] = [&probe.at, &probe.beside].map(|p| original(placement, p));
                part.sampled(&Probe { at, beside })?
            }
            Model::Other(other) => match other.sign(&probe.at) {
                0 => return None,
                sign => sign > 0,
            },
            // A host's function has rounding errors.
            Model::Host(..) => return None,
            Model::Prism(..) => match self.sign(&probe.at) {
                0 => return None,
                sign => sign > 0,
            },
            // The zeros on the axis are too special.
            Model::Torus(..) if self.sign(&probe.at) == 0 && probe.at[..2].iter().all(|c| c.sign() == 0) => {
                return None;
            }
            primitive => {
                let at = primitive.values(&probe.at);
                let lowest = at.iter().map(Exact::sign).min().unwrap_or(1);
                // (The numbers beside zeros are long. They are examined only where the decision depends on
                // them.)
                lowest > 0
                    || lowest == 0
                        && at.iter().zip(&primitive.values(&probe.beside)).all(|(at, beside)| {
                            at.sign() > 0 || beside.minus(&Exact::power_of_two(SLOPE)).sign() > 0
                        })
            }
        })
    }
}

fn lowest(values: Vec<Exact>) -> i32 {
    values.iter().map(Exact::sign).min().unwrap_or(1)
}

impl Other {
    pub fn solid(&self, frame: &Frame) -> Result<AnySolid, Error> {
        Ok(match self {
            Other::Cuboid(min, max) => AnySolid::new(Plain::cuboid(*min, *max)?),
            Other::Ball(centre, radius) => AnySolid::new(Plain::ball(*centre, *radius)?),
            &Other::Slab(low, high) => AnySolid::new(
                Callback::new(move |min, max| {
                    Ok(match (min[2], max[2]) {
                        (a, b) if b <= low || a >= high => Verdict::Empty,
                        (a, b) if a >= low && b <= high => Verdict::Full,
                        _ => Verdict::Partial(()),
                    })
                })
                .with_contains(move |p| Ok(low <= p[2] && p[2] < high)),
            ),
            Other::Tetrahedron(corners) => {
                let faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
                let mesh = TriangleMesh::new(corners.to_vec(), faces)?;
                AnySolid::new(MeshSolid::new(mesh, FillRule::NonZero)?)
            }
            Other::Octree(tree) => AnySolid::new(Octree::clone(tree)),
            Other::Moved(other, own, placement) => {
                AnySolid::new(Transform::new(other.solid(own)?, own, placement))
            }
            // A single expression would become part of the surrounding one.
            Other::Model(model) => AnySolid::new(SplitCounter::new(model.csg(frame)?)),
        })
    }

    fn sign(&self, p: &Point) -> i32 {
        lowest(match self {
            Other::Cuboid(min, max) => cuboid(*min, *max, p),
            Other::Ball(centre, radius) => vec![ellipsoid(*centre, [*radius; 3], p)],
            Other::Slab(low, high) => slab([*low, *high], p).to_vec(),
            Other::Tetrahedron(corners) => tetrahedron(*corners, p),
            Other::Octree(tree) => return stored(tree, p),
            Other::Moved(other, _, placement) => return other.sign(&original(placement, p)),
            Other::Model(model) => return model.sign(p),
        })
    }
}

/// Returns the common sign of all cells of a tree that a point touches; 0 if they differ.
fn stored(tree: &Octree, p: &Point) -> i32 {
    let frame = tree.frame();
    let mut ranges = [[0; 2]; 3];
    for axis in 0..3 {
        // The sign of p − plane i, times w².
        let side = |i: u32| p[axis].minus(&Exact::plane(frame, axis, i).times(&p[3])).times(&p[3]).sign();
        let n = frame.cells();
        if side(0) <= 0 || side(n) >= 0 {
            return 0;
        }
        let (mut low, mut high) = (0, n);
        while high - low > 1 {
            let middle = low.midpoint(high);
            *if side(middle) >= 0 { &mut low } else { &mut high } = middle;
        }
        ranges[axis] = [if side(low) == 0 { low - 1 } else { low }, low];
    }
    let [x, y, z] = ranges;
    let cells = (0..8).map(|corner| [x[corner & 1], y[corner >> 1 & 1], z[corner >> 2]]);
    let signs = cells.map(|at| match tree.view().tag_at(at) {
        Tag::Empty => -1,
        Tag::Full => 1,
        _ => 0,
    });
    signs.reduce(|a, b| if a == b { a } else { 0 }).unwrap_or(0)
}
