//! Any bytes as a small mesh, closed or with holes, moved or not, and as rays and points. Answers without
//! cells must be true by winding numbers, computed from every triangle in integers or (with holes) by solid
//! angles, and by distances from every triangle in doubles.

use super::Bytes;
use leafless::query::{DistanceTo, Obstacle, distances, line_of_sight, ray_spans};
use leafless::query::{RaySpans, Sight};
use leafless::{
    Affine, Cell, Control, Csg, FillRule, Frame, Interval, Membership, MeshSolid, Octree, Ray,
    SurfaceOptions, TriangleMesh, build_extended, cast_rays, contains, difference,
};
use num_bigint::{BigInt, Sign};

impl Bytes<'_> {
    /// Returns a number from −1 to 1 with full precision.
    fn fraction(&mut self) -> f64 {
        let seed = (self.byte() << 8 | self.byte()) as u64 + 1;
        let mixed = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        (mixed ^ mixed >> 29) as i64 as f64 / 2f64.powi(63)
    }
}

const CONTROL: Control<'static> = Control {
    threads: 1,
    max_nodes: None,
    max_bytes: None,
    max_splits: Some(1 << 9),
    cancel: None,
    progress: None,
};

type Point = [f64; 3];
type Facet = [Point; 3];

/// The most bodies of a mesh, and the most rays and points.
const MOST: usize = 6;

fn at(k: impl Fn(usize) -> f64) -> Point {
    [k(0), k(1), k(2)]
}

fn minus(p: Point, q: Point) -> Point {
    at(|k| p[k] - q[k])
}

fn dot(p: Point, q: Point) -> f64 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

fn cross(p: Point, q: Point) -> Point {
    at(|k| p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3])
}

fn length(p: Point) -> f64 {
    let most = p.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    if most == 0.0 || most.is_infinite() {
        most
    } else {
        most * dot(p.map(|c| c / most), p.map(|c| c / most)).sqrt()
    }
}

// ---- exact numbers ------------------------------------------------------------------------------

/// mantissa · 2^exponent.
#[derive(Clone, Debug)]
struct Exact(BigInt, i64);

impl Exact {
    fn of(x: f64) -> Exact {
        let bits = x.to_bits();
        let (biased, fraction) = ((bits >> 52 & 0x7FF) as i64, bits & ((1 << 52) - 1));
        let (magnitude, exponent) =
            if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
        let zeros = if magnitude == 0 { 0 } else { magnitude.trailing_zeros() };
        let magnitude = BigInt::from(magnitude >> zeros);
        Exact(if x < 0.0 { -magnitude } else { magnitude }, exponent + i64::from(zeros))
    }

    fn plus(&self, other: &Exact) -> Exact {
        if self.0.sign() == Sign::NoSign {
            return other.clone();
        }
        if other.0.sign() == Sign::NoSign {
            return self.clone();
        }
        let unit = self.1.min(other.1);
        Exact(self.in_units(unit) + other.in_units(unit), unit)
    }

    fn times(&self, other: &Exact) -> Exact {
        Exact(&self.0 * &other.0, self.1 + other.1)
    }

    fn negated(&self) -> Exact {
        Exact(-&self.0, self.1)
    }

    fn in_units(&self, unit: i64) -> BigInt {
        if self.0.sign() == Sign::NoSign { BigInt::from(0) } else { &self.0 << (self.1 - unit) as usize }
    }
}

fn sign(x: &BigInt) -> i32 {
    match x.sign() {
        Sign::Minus => -1,
        Sign::NoSign => 0,
        Sign::Plus => 1,
    }
}

fn sure(x: f64, bound: f64) -> Option<i32> {
    if x > bound {
        Some(1)
    } else if x < -bound {
        Some(-1)
    } else {
        None
    }
}

/// An exact point and its doubles. Each double is wrong by at most `size` · 2^-50.
struct Place {
    exact: [Exact; 3],
    near: Point,
    size: f64,
}

impl Place {
    fn new(p: Point) -> Place {
        Place { exact: p.map(Exact::of), near: p, size: p.iter().fold(0.0, |most: f64, c| most.max(c.abs())) }
    }

    /// from + t · way.
    fn on(from: Point, way: Point, t: f64) -> Place {
        let exact = [0, 1, 2].map(|k| Exact::of(from[k]).plus(&Exact::of(way[k]).times(&Exact::of(t))));
        let near = at(|k| from[k] + t * way[k]);
        let size = (0..3).fold(0.0, |most: f64, k| most.max(from[k].abs() + (t * way[k]).abs()));
        Place { exact, near, size }
    }
}

/// Converts points to integers of one common unit.
fn common<const N: usize>(points: [&[Exact; 3]; N]) -> [[BigInt; 3]; N] {
    let all = points.iter().flat_map(|p| p.iter()).filter(|x| x.0.sign() != Sign::NoSign);
    let unit = all.map(|x| x.1).min().unwrap_or(0);
    points.map(|p| [0, 1, 2].map(|k| p[k].in_units(unit)))
}

// ---- the mesh -----------------------------------------------------------------------------------

/// A map by integers and a translation. Its inverse is exact.
struct Motion {
    rows: [[i32; 3]; 3],
    back: [[i32; 3]; 3],
    by: Point,
}

impl Motion {
    /// Returns the map in the library's form, unless it is too large or too small.
    fn affine(&self) -> Option<Affine> {
        let row = |k: usize| {
            let [x, y, z] = self.rows[k].map(f64::from);
            [x, y, z, self.by[k]]
        };
        Affine::new([row(0), row(1), row(2)]).ok()
    }

    fn undo(&self, place: &Place) -> Place {
        let from = [0, 1, 2].map(|k| place.exact[k].plus(&Exact::of(self.by[k]).negated()));
        let near = at(|k| place.near[k] - self.by[k]);
        let row = |k: usize| {
            let parts = (0..3).map(|i| from[i].times(&Exact(BigInt::from(self.back[k][i]), 0)));
            parts.fold(Exact::of(0.0), |sum, part| sum.plus(&part))
        };
        let size = 8.0 * (place.size + self.by.iter().fold(0.0, |most: f64, c| most.max(c.abs())));
        let near = at(|k| (0..3).map(|i| f64::from(self.back[k][i]) * near[i]).sum());
        Place { exact: [row(0), row(1), row(2)], near, size }
    }
}

/// A scene to query, with its truth.
struct Scene {
    /// The facets before they are moved.
    facets: Vec<Facet>,
    exact: Vec<[[Exact; 3]; 3]>,
    fill: FillRule,
    motion: Option<Motion>,
    /// The facets of the solid.
    moved: Vec<Facet>,
    solid: MeshSolid,
    frame: Frame,
    /// The size of all coordinates.
    size: f64,
    /// True if all corners lie on a small lattice.
    is_plain: bool,
    /// True if facets may be missing.
    is_open: bool,
}

impl Scene {
    /// Returns the winding number at a point; `None` on the surface. The ray along x is shifted by (0, ε,
    /// ε²).
    fn winding(&self, place: &Place) -> Option<i32> {
        let moved;
        let place = match &self.motion {
            Some(motion) => {
                moved = motion.undo(place);
                &moved
            }
            None => place,
        };
        let mut winding = 0;
        for (facet, exact) in self.facets.iter().zip(&self.exact) {
            if over(facet, exact, place) == 0 && is_on(exact, place) {
                return None;
            }
            let sides = [0, 1, 2].map(|k| side(facet, exact, [k, (k + 1) % 3], place));
            if sides[0] == 0 || sides[0] != sides[1] || sides[1] != sides[2] {
                continue;
            }
            if over(facet, exact, place) == sides[0] {
                winding -= sides[0];
            }
        }
        Some(winding)
    }

    /// True if the solid contains a point. The result is `None` on the surface of the mesh; for a mesh with
    /// holes, also near the surface, and near points whose winding number is one half.
    fn holds(&self, place: &Place) -> Option<bool> {
        if self.is_open {
            let excess = self.excess(place.near);
            let is_near = || self.is_near(place.near, 1e-8 * self.size);
            return (excess.abs() > 1e-6 && !is_near()).then_some(excess > 0.0);
        }
        self.winding(place).map(|winding| encloses(self.fill, winding))
    }

    /// Returns the excess of the sum of solid angles (van Oosterom and Strackee 1983) over the fill rule's
    /// threshold.
    fn excess(&self, p: Point) -> f64 {
        let angle = |facet: &Facet| {
            let [a, b, c] = facet.map(|corner| minus(corner, p));
            let size = length(a).max(length(b)).max(length(c));
            if size == 0.0 {
                return 0.0;
            }
            let [a, b, c] = [a, b, c].map(|corner| corner.map(|x| x / size));
            let [x, y, z] = [a, b, c].map(length);
            let real = x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y;
            2.0 * dot(a, cross(b, c)).atan2(real)
        };
        let winding = self.moved.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI);
        if self.fill == FillRule::Positive { winding - 0.5 } else { winding.abs() - 0.5 }
    }

    fn is_near(&self, p: Point, distance: f64) -> bool {
        self.moved.iter().any(|facet| from_triangle(*facet, p) <= distance)
    }

    /// True if a point lies near the plane of a facet. At a small angle, times are known less well than
    /// places.
    fn is_near_to_a_plane(&self, p: Point, distance: f64) -> bool {
        self.moved.iter().any(|facet| {
            let [a, b, c, p] = [facet[0], facet[1], facet[2], p].map(|p| p.map(|c| c / self.size));
            let normal = cross(minus(b, a), minus(c, a));
            dot(normal, minus(p, a)).abs() <= distance / self.size * length(normal)
        })
    }

    /// True if a facet is so narrow that doubles do not determine its plane. Any plane through its longest
    /// edge may stand for it.
    fn has_a_needle(&self) -> bool {
        self.moved.iter().any(|facet| {
            let [a, b, c] = facet.map(|p| p.map(|c| c / self.size));
            let [u, v] = [minus(b, a), minus(c, a)];
            length(cross(u, v)) <= 1e-6 * length(u) * length(v)
        })
    }

    /// Returns whether a point lies in the universe; `None` if it is near the universe's faces.
    fn is_in_universe(&self, Place { near: p, size, .. }: &Place) -> Option<bool> {
        let (low, edge) = (self.frame.origin(), self.frame.edge());
        let margin = 1e-9 * (edge + size + length(low));
        let depth = |k: usize| (p[k] - low[k]).min(low[k] + edge - p[k]);
        let least = depth(0).min(depth(1)).min(depth(2));
        if least > margin {
            Some(true)
        } else if least < -margin {
            Some(false)
        } else {
            None
        }
    }
}

fn encloses(fill: FillRule, winding: i32) -> bool {
    match fill {
        FillRule::NonZero => winding != 0,
        FillRule::EvenOdd => winding % 2 != 0,
        FillRule::Positive => winding > 0,
    }
}

fn size_of(facet: &Facet, place: &Place) -> f64 {
    facet.iter().flatten().fold(place.size, |most: f64, c| most.max(c.abs()))
}

/// A bound of the rounding errors, relative to products of sizes.
const SAFE: f64 = 1e-12;

/// Returns the side of an edge on which a point lies, seen along x.
fn side(facet: &Facet, exact: &[[Exact; 3]; 3], [i, j]: [usize; 2], place: &Place) -> i32 {
    let (a, b, p) = (facet[i], facet[j], place.near);
    let size = size_of(facet, place);
    let estimate = (b[1] - a[1]) * (p[2] - a[2]) - (b[2] - a[2]) * (p[1] - a[1]);
    sure(estimate, SAFE * size * size).unwrap_or_else(|| {
        let [a, b, p] = common([&exact[i], &exact[j], &place.exact]);
        let (ey, ez) = (&b[1] - &a[1], &b[2] - &a[2]);
        let side = sign(&(&ey * (&p[2] - &a[2]) - &ez * (&p[1] - &a[1])));
        [side, -sign(&ez), sign(&ey)].into_iter().find(|&s| s != 0).unwrap_or(0)
    })
}

/// Returns the side of a facet's plane on which a point lies.
fn over(facet: &Facet, exact: &[[Exact; 3]; 3], place: &Place) -> i32 {
    let [a, b, c] = *facet;
    let size = size_of(facet, place);
    let estimate = dot(cross(minus(b, a), minus(c, a)), minus(place.near, a));
    sure(estimate, SAFE * size * size * size).unwrap_or_else(|| {
        let [a, b, c, p] = common([&exact[0], &exact[1], &exact[2], &place.exact]);
        let edge = |to: &[BigInt; 3]| [0, 1, 2].map(|k| &to[k] - &a[k]);
        let (u, v, w) = (edge(&b), edge(&c), edge(&p));
        let part = |k: usize| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            (&u[i] * &v[j] - &u[j] * &v[i]) * &w[k]
        };
        sign(&(part(0) + part(1) + part(2)))
    })
}

/// True if a point of a facet's plane lies on the facet, or, if the facet has no area, on the line through
/// it.
fn is_on(exact: &[[Exact; 3]; 3], place: &Place) -> bool {
    let [a, b, c, p] = common([&exact[0], &exact[1], &exact[2], &place.exact]);
    (0..3).all(|axis| {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let side = |a: &[BigInt; 3], b: &[BigInt; 3]| {
            sign(&((&b[i] - &a[i]) * (&p[j] - &a[j]) - (&b[j] - &a[j]) * (&p[i] - &a[i])))
        };
        let sides = [side(&a, &b), side(&b, &c), side(&c, &a)];
        !(sides.contains(&1) && sides.contains(&-1))
    })
}

/// Returns the distance of a point from a triangle, in doubles.
fn from_triangle([a, b, c]: Facet, p: Point) -> f64 {
    // (Squares of the smallest numbers vanish.)
    let unit = [a, b, c, p].iter().flatten().fold(0.0, |most: f64, c| most.max(c.abs()));
    if unit == 0.0 {
        return 0.0;
    }
    let [a, b, c, p] = [a, b, c, p].map(|p| p.map(|c| c / unit));
    let along = |a: Point, b: Point| {
        let (way, from) = (minus(b, a), minus(p, a));
        let square = dot(way, way);
        let t = if square > 0.0 { (dot(way, from) / square).clamp(0.0, 1.0) } else { 0.0 };
        length(minus(from, way.map(|c| t * c)))
    };
    let mut least = along(a, b).min(along(b, c)).min(along(c, a));
    let normal = cross(minus(b, a), minus(c, a));
    let square = dot(normal, normal);
    if square > 0.0 {
        let height = dot(normal, minus(p, a)) / square;
        let foot = at(|k| p[k] - height * normal[k]);
        let is_over = |a, b| dot(cross(minus(b, a), minus(foot, a)), normal) >= 0.0;
        if is_over(a, b) && is_over(b, c) && is_over(c, a) {
            least = least.min(length(minus(p, foot)));
        }
    }
    least * unit
}

/// Returns the ratio of a triangle's height to its longest edge.
fn plumpness([a, b, c]: Facet) -> f64 {
    let longest = length(minus(b, a)).max(length(minus(c, a))).max(length(minus(c, b)));
    let [u, v] = [minus(b, a), minus(c, a)].map(|e| e.map(|c| c / longest));
    length(cross(u, v))
}

// ---- random scenes ------------------------------------------------------------------------------

/// The parameters of random corners.
struct Corners {
    is_plain: bool,
    scale: f64,
    offset: Point,
}

impl Corners {
    fn corner(&self, bytes: &mut Bytes<'_>) -> Point {
        let lattice = [0; 3].map(|_: i32| bytes.below(9) as f64 - 4.0);
        let free = if self.is_plain { 0 } else { bytes.below(4) };
        let p = match free {
            0 => lattice,
            1 => lattice.map(|c| c + 1e-9 * bytes.fraction()),
            2 => lattice.map(|c| c + bytes.fraction()),
            _ => lattice.map(|c| c + 1e-15 * bytes.fraction()),
        };
        at(|k| p[k] * self.scale + self.offset[k])
    }
}

fn block(a: Point, b: Point) -> Vec<Facet> {
    let (low, high) = (at(|k| a[k].min(b[k])), at(|k| a[k].max(b[k])));
    let corner = |i: usize| at(|k| if i >> k & 1 != 0 { high[k] } else { low[k] });
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let quads = faces.iter().map(|face| face.map(corner));
    quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

fn inside_out(facets: &[Facet]) -> Vec<Facet> {
    facets.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

fn soup(bytes: &mut Bytes<'_>, corners: &Corners) -> Vec<Facet> {
    let mut facets: Vec<Facet> = Vec::new();
    let mut last: Vec<Facet> = Vec::new();
    for _ in 0..1 + bytes.below(MOST) {
        let code = bytes.byte();
        last = match code % 8 {
            0..=2 => block(corners.corner(bytes), corners.corner(bytes)),
            3..=5 => {
                let [a, b, c, d] = [0; 4].map(|_| corners.corner(bytes));
                vec![[a, c, b], [a, b, d], [b, c, d], [c, a, d]]
            }
            // The same corner once more.
            6 => last,
            // A triangle and its reverse.
            _ => {
                let [a, b, c] = [0; 3].map(|_| corners.corner(bytes));
                vec![[a, b, c], [a, c, b]]
            }
        };
        if code >= 192 {
            last = inside_out(&last);
        }
        facets.extend(&last);
    }
    facets
}

fn scene(bytes: &mut Bytes<'_>, may_be_open: bool) -> Option<Scene> {
    let (kind, code) = (bytes.byte(), bytes.byte());
    let is_plain = kind % 2 == 0;
    let scale = [1.0, 1.0, 1.0, 0.3, 2f64.powi(-200), 2f64.powi(200), 1e-70, 1e60][kind / 2 % 8];
    let offset = match kind / 16 % 8 {
        0 => [1e9, -3e8, 2e9].map(|c| c * scale),
        1 => [0.1, 0.2, 0.3].map(|c| c * scale),
        _ => [0.0; 3],
    };
    let fill = [FillRule::NonZero, FillRule::EvenOdd, FillRule::Positive][code % 3];
    let is_open = may_be_open && kind >= 128;
    let fill = if is_open && fill == FillRule::EvenOdd { FillRule::NonZero } else { fill };
    let mut facets = soup(bytes, &Corners { is_plain, scale, offset });
    if is_open {
        for _ in 0..1 + bytes.below(4) {
            let gone = bytes.byte() % facets.len().max(1);
            if facets.len() <= 1 {
                return None;
            }
            facets.swap_remove(gone);
        }
    }
    let mesh = TriangleMesh::from_facets(&facets).ok()?;
    // (Welding drops triangles without area.)
    let of = |mesh: &TriangleMesh| -> Vec<Facet> {
        mesh.triangles().iter().map(|t| t.map(|v| mesh.vertices()[v as usize])).collect()
    };
    let facets = of(&mesh);
    let mut solid = MeshSolid::new(mesh, fill).ok()?;
    let motion = match code / 3 % 8 {
        0 => Some(Motion {
            rows: [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
            back: [[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
            by: [0.1, 0.7, -0.3].map(|c| c * scale),
        }),
        1 => Some(Motion {
            rows: [[1, 1, 0], [0, 1, 0], [0, 0, -1]],
            back: [[1, -1, 0], [0, 1, 0], [0, 0, -1]],
            by: [1.1, 1e-9, 0.3].map(|c| c * scale),
        }),
        _ => None,
    };
    if let Some(motion) = &motion {
        solid = solid.placed(&motion.affine()?).ok()?;
    }
    let moved = of(solid.mesh());
    let (origin, edge) = match code / 24 % 8 {
        0 => ([-2.0, -1.5, -3.0], 4.0),
        1 => ([-4.0; 3], 8.0),
        2 => ([1.0, 0.5, 1.0], 4.0),
        _ => ([-32.0; 3], 64.0),
    };
    let frame = Frame::new(at(|k| origin[k] * scale + offset[k]), edge * scale, 5).ok()?;
    let size = moved.iter().flatten().flatten().fold(scale, |most: f64, c| most.max(c.abs()));
    let exact = facets.iter().map(|facet| facet.map(|p| p.map(Exact::of))).collect();
    let is_plain = is_plain && offset == [0.0; 3];
    Some(Scene { facets, exact, fill, motion, moved, solid, frame, size, is_plain, is_open })
}

/// A random point: a vertex, the middle of two, a point of the lattice, or any point.
fn point(bytes: &mut Bytes<'_>, scene: &Scene, corners: &Corners) -> Point {
    let vertices = scene.solid.mesh().vertices();
    match bytes.below(8) {
        0 if !vertices.is_empty() => vertices[bytes.byte() % vertices.len()],
        1 if !vertices.is_empty() => {
            let [a, b] = [0; 2].map(|_| vertices[bytes.byte() % vertices.len()]);
            at(|k| a[k].midpoint(b[k]))
        }
        2 => [0; 3].map(|_| scene.size * [0.0, 1e-300, -5e-324, 1.0, 1e3, 1e17][bytes.below(6)]),
        _ => corners.corner(bytes),
    }
}

/// Runs the fuzz target.
pub fn direct(data: &[u8]) {
    let mut bytes = Bytes(data);
    let bytes = &mut bytes;
    let Some(scene) = scene(bytes, true) else { return };
    let scale = scene.frame.edge() / 8.0;
    let corners = Corners {
        is_plain: bytes.below(2) == 0,
        scale,
        offset: scene.frame.origin().map(|c| c + 4.0 * scale),
    };
    let corners = if bytes.below(2) == 0 {
        // Like the mesh's.
        let around = scene.solid.mesh().vertices().first().copied().unwrap_or_default();
        Corners { scale: scene.size.min(scale), offset: around, ..corners }
    } else {
        corners
    };
    for _ in 0..1 + bytes.below(MOST) {
        if bytes.0.is_empty() {
            break;
        }
        ask_ray(bytes, &scene, &corners);
        ask_point(bytes, &scene, &corners);
    }
}

// ---- stored -------------------------------------------------------------------------------------

/// Runs the fuzz target `layers`: the same meshes, stored with the planes of their facets, alone and minus a
/// block. No point is decided wrongly, and no point far from the surface is undecided unless its cell was
/// given up.
pub fn layers(data: &[u8]) {
    let mut bytes = Bytes(data);
    let bytes = &mut bytes;
    let Some(scene) = scene(bytes, false) else { return };
    let scale = scene.frame.edge() / 8.0;
    let code = bytes.byte();
    let tolerance = scene.frame.edge() / f64::from(8u32 << (code % 12));
    let frame = scene.frame.with_depth(3 + (code / 12 % 6) as u8).expect("a depth");
    let options = SurfaceOptions { tolerance: Some(tolerance) };
    let control = Control { max_nodes: Some(1 << 13), ..CONTROL };
    let Ok(tree) = build_extended(&scene.solid, &frame, &options, &control) else { return };
    tree.view().check().expect("what is built is sound");
    let own = Corners { is_plain: true, scale, offset: scene.frame.origin().map(|c| c + 4.0 * scale) };
    let [a, b] = [0; 2].map(|_| own.corner(bytes));
    let (low, high) = (at(|k| a[k].min(b[k])), at(|k| a[k].max(b[k])));
    let rest = Csg::cuboid(low, high).ok().and_then(|block| {
        let block = build_extended(&block, &frame, &options, &control).ok()?;
        difference(tree.view(), block.view(), &control).ok()
    });
    let mut points = Vec::new();
    for _ in 0..4 * MOST {
        let Some(facet) = scene.moved.get(bytes.byte() % scene.moved.len().max(1)) else { return };
        let [u, v] = [0; 2].map(|_| [0.0, 0.5, bytes.fraction(), 1.0 / 3.0][bytes.below(4)]);
        let off = scene.size * 10f64.powi(-(bytes.below(18) as i32));
        let way = [0; 3].map(|_| off * bytes.fraction());
        points.push(at(|k| {
            let [a, b, c] = facet.map(|p| p[k]);
            a + u * (b - a) + v * (c - a) + way[k]
        }));
    }
    points.extend((0..MOST).map(|_| point(bytes, &scene, &own)));
    let ask = |tree: &Octree| {
        let mut answers = vec![Membership::Undecided; points.len()];
        contains(tree, &frame, &points, &mut answers, &CONTROL).expect("points");
        answers
    };
    let (answers, rests) = (ask(&tree), rest.as_ref().map(ask));
    for (i, &p) in points.iter().enumerate() {
        let place = Place::new(p);
        let truth = scene.holds(&place);
        let told = || format!("{p:?} {tolerance} {frame:?} {:?} {:?}", scene.facets, scene.fill);
        match (answers[i], truth) {
            (Membership::Inside, Some(truth)) => assert!(truth, "not inside: {}", told()),
            (Membership::Outside, Some(truth)) => assert!(!truth, "not outside: {}", told()),
            (Membership::Undecided, _) => {
                let finest = frame.cell_of(p).map(|at| Cell { level: frame.depth(), at });
                let is_known = finest.is_some_and(|cell| tree.view().cell_function(cell).is_some());
                let all =
                    scene.moved.iter().map(|facet| from_triangle(*facet, p)).fold(f64::INFINITY, f64::min);
                let is_far = all > 2.0 * tolerance + 1e-9 * (scene.size + place.size);
                // (A facet without thickness may be taken for a body, because its plane continues beyond it.
                // Planes are up to 2^-22 wide.)
                let is_beside =
                    || scene.is_near_to_a_plane(p, 1e-6 * (scene.size + place.size)) || scene.has_a_needle();
                assert!(!is_known || !is_far || is_beside(), "undecided {all} from the surface: {}", told());
            }
            _ => {}
        }
        let Some(rests) = &rests else { continue };
        let is_within = (0..3).all(|k| low[k] <= p[k] && p[k] <= high[k]);
        let is_inside = (0..3).all(|k| low[k] < p[k] && p[k] < high[k]);
        let told = || format!("less {low:?} {high:?}: {}", told());
        match (rests[i], truth) {
            (Membership::Inside, truth) => {
                assert!(truth != Some(false) && !is_inside, "not inside {}", told())
            }
            (Membership::Outside, truth) => {
                assert!(truth != Some(true) || is_within, "not outside {}", told())
            }
            _ => {}
        }
    }
}

// ---- rays ---------------------------------------------------------------------------------------

fn has(spans: &[Interval], t: f64) -> bool {
    spans.iter().any(|span| span.contains(t))
}

fn ask_ray(bytes: &mut Bytes<'_>, scene: &Scene, corners: &Corners) {
    let (mut from, to) = (point(bytes, scene, corners), point(bytes, scene, corners));
    let code = bytes.byte();
    let mut way = minus(to, from);
    match code % 8 {
        0 => way = at(|k| if k == code / 64 % 3 { corners.scale } else { 0.0 }),
        1 => way = at(|k| if k == code / 64 % 3 { -corners.scale } else { 0.0 }),
        2 | 3 => from = at(|k| from[k] - 4.0 * way[k]),
        4 => from = at(|k| from[k] - 1e12 * way[k]),
        _ => {}
    }
    let stretch = [1.0, 1.0, 1.0, 1e-6, 2f64.powi(-40), 2f64.powi(30), 3.0, 1.0][code / 8 % 8];
    let way = way.map(|c| c * stretch);
    let Ok(ray) = Ray::new(from, way) else { return };
    let last = if code >= 224 { 2.0 / stretch } else { f64::INFINITY };
    let Ok(ray) = ray.until(last) else { return };
    let frame = &scene.frame;
    let told = format!("{ray:?} {:?} {:?} {frame:?}", scene.facets, scene.fill);
    let spans = ray_spans(&scene.solid, frame, &ray, &CONTROL).expect("spans");
    let RaySpans { inner, outer } = &spans;
    for span in inner {
        let holds = |wide: &Interval| wide.lower <= span.lower && span.upper <= wide.upper;
        assert!(outer.iter().any(holds), "inner beyond outer: {spans:?} {told}");
    }
    // Ends of spans, and places where the ray crosses integer coordinates.
    let mut times: Vec<f64> = inner.iter().chain(outer).flat_map(|span| [span.lower, span.upper]).collect();
    times.push(0.0);
    for plane in 0..3 * 9 {
        let (k, plane) = (plane % 3, (plane / 3) as f64 - 4.0);
        let offset = scene.facets.first().map_or(0.0, |facet| facet[0][k]);
        times.push((plane * corners.scale + offset - from[k]) / way[k]);
    }
    times.retain(|t| t.is_finite() && (0.0..1e200).contains(t));
    times.sort_by(f64::total_cmp);
    times.dedup();
    let end = times[times.len() - 1];
    times.push(if end > 0.0 { 2.0 * end } else { 1.0 / stretch });
    let hit = |on: Obstacle| cast_rays(&scene.solid, frame, &[ray], on, &CONTROL).expect("hits")[0];
    let (full, upper) = (hit(Obstacle::Full), hit(Obstacle::Upper));
    for pair in times.windows(2) {
        let t = pair[0].midpoint(pair[1]);
        if t <= pair[0] || t >= pair[1] {
            continue;
        }
        let place = Place::on(from, way, t);
        let (is_inner, is_outer) = (has(inner, t), has(outer, t));
        assert!(is_outer || !is_inner, "{t} {spans:?} {told}");
        if t > last || scene.is_in_universe(&place) == Some(false) {
            assert!(!is_outer, "beyond the universe, or behind its end: {t} {spans:?} {told}");
            continue;
        }
        // (In doubles, places so near the universe's faces are unknown.)
        if scene.is_in_universe(&place).is_none() {
            continue;
        }
        let Some(truth) = scene.holds(&place) else { continue };
        assert!(!is_inner || truth, "not inside: {t} {spans:?} {told}");
        assert!(is_outer || !truth, "not outside: {t} {spans:?} {told}");
        if is_outer && !is_inner && scene.is_plain && scene.motion.is_none() && !scene.is_open {
            let margin = 1e-9 * (scene.size + place.size);
            assert!(scene.is_near_to_a_plane(place.near, margin), "nothing told: {t} {spans:?} {told}");
        }
        for hit in [&full, &upper].into_iter().flatten() {
            assert!(t >= hit.t.lower || !truth, "met before: {t} {hit:?} {spans:?} {told}");
        }
        assert!(upper.is_some() || !truth, "missed: {t} {spans:?} {told}");
    }
    let told = format!("{full:?} {upper:?} {spans:?} {told}");
    match (full, inner.first()) {
        // (A point may be the universe's only point on the ray.)
        (None, Some(span)) => assert!(span.width() == 0.0, "no hit: {told}"),
        (Some(hit), Some(span)) => assert!(hit.t.lower <= span.lower, "{told}"),
        _ => {}
    }
    match (upper, outer.first()) {
        (Some(hit), Some(span)) => assert!(span.lower <= hit.t.upper, "{told}"),
        // (For a ray along a facet, one answer may prove a miss while the other does not. Nothing is missed,
        // see above.)
        (None, _) => {}
        (Some(_), None) => panic!("{told}"),
    }
    if let Some(hit) = full {
        assert!(
            hit.t.upper.is_finite() && upper.is_some_and(|upper| upper.t.common(hit.t).is_some()),
            "{told}"
        );
    }
    for (hit, is_proven) in [(full, true), (upper, false)] {
        let Some(hit) = hit else { continue };
        if let Some(surface) = hit.surface {
            let facet = scene.moved[surface as usize];
            if plumpness(facet) > 1e-3 {
                let [a, b, c] = facet;
                let scaled = |p: Point| p.map(|x| x / scene.size.max(1e-100));
                let normal = cross(scaled(minus(b, a)), scaled(minus(c, a)));
                let turn = dot(normal, hit.normal) / length(normal);
                assert!(turn.abs() > 1.0 - 1e-6, "another normal: {turn} {told}");
                let against = dot(hit.normal, way.map(|c| c / length(way)));
                // (The side of a mere contact is unknown.)
                let goes_in =
                    is_proven && inner.iter().any(|span| span.lower == hit.t.upper && span.width() > 0.0);
                assert!(!goes_in || against < 1e-6, "not outward: {against} {told}");
            }
        }
        let is_unit = (length(hit.normal) - 1.0).abs() < 1e-9;
        assert!(is_unit || hit.normal == [0.0; 3], "no normal: {told}");
    }
    let end = at(|k| from[k] + way[k]);
    if let Ok(sight) = line_of_sight(&scene.solid, frame, from, end, &CONTROL) {
        for k in 0..5 {
            let near = at(|axis| from[axis] + (end[axis] - from[axis]) * f64::from(k) / 4.0);
            let place = Place::new(near);
            // (A point beside the segment, away from its ends, where the segment is far from the surface.)
            let is_clear = !scene.is_near(near, 1e-9 * (scene.size + length(from) + length(end)));
            if is_clear && scene.is_in_universe(&place) == Some(true) && scene.holds(&place) == Some(true) {
                assert_ne!(sight, Sight::Clear, "{near:?} {told}");
                // (For a moved mesh, a ray near an edge is undecided; for a mesh with holes, a ray near the
                // rim. Then the cells are queried.)
                let is_told = scene.motion.is_none() && !scene.is_open;
                assert!(sight == Sight::Blocked || !is_told, "{near:?} {told}");
            }
        }
    }
}

// ---- points -------------------------------------------------------------------------------------

fn ask_point(bytes: &mut Bytes<'_>, scene: &Scene, corners: &Corners) {
    let p = point(bytes, scene, corners);
    let place = Place::new(p);
    let truth = scene.holds(&place);
    let told = format!("{p:?} {:?} {:?} {:?}", scene.facets, scene.fill, scene.frame);
    let all = scene.moved.iter().map(|facet| from_triangle(*facet, p)).fold(f64::INFINITY, f64::min);
    let margin = 1e-9 * (scene.size + place.size);
    // The tree is built before or after.
    let mut answers = [Membership::Undecided];
    let ask = |answers: &mut [Membership; 1]| {
        contains(&scene.solid, &scene.frame, &[p], answers, &CONTROL).expect("points");
    };
    ask(&mut answers);
    match (answers[0], truth) {
        (Membership::Inside, Some(truth)) => assert!(truth, "not inside: {told}"),
        (Membership::Outside, Some(truth)) => assert!(!truth, "not outside: {told}"),
        (Membership::Undecided, _) => {
            let is_in = scene.is_in_universe(&place) == Some(true);
            // (In integers or, with holes, in doubles.)
            let is_told = !scene.is_open || scene.is_plain && scene.motion.is_none() && truth.is_some();
            assert!(!is_in || all <= margin || !is_told, "undecided: {told}");
        }
        _ => {}
    }
    for to in [DistanceTo::Boundary, DistanceTo::Solid, DistanceTo::Complement] {
        let found = distances(&scene.solid, &scene.frame, &[p], to, 0.0, &CONTROL).expect("distances");
        let distance = found[0].distance;
        let told = format!("{to:?} {:?} {told}", found[0]);
        let Some(near) = found[0].nearest else { continue };
        // (Where cells were queried, no triangle is known.)
        let Some(surface) = near.surface else { continue };
        let facet = scene.moved[surface as usize];
        let size = distance.lower.abs().max(distance.upper.abs());
        let way = length(minus(near.point, p));
        assert!(from_triangle(facet, near.point) <= margin, "beside the triangle: {told}");
        assert!(to != DistanceTo::Boundary || (way - size).abs() <= margin, "beside the distance: {told}");
        assert!(to != DistanceTo::Boundary || size >= all - margin, "nearer than any: {all} {told}");
        if let Some(truth) = truth {
            let (outside, inside) = match to {
                DistanceTo::Boundary => (distance.lower > 0.0, distance.upper < 0.0),
                DistanceTo::Solid => (distance.lower > 0.0, distance.upper == 0.0),
                DistanceTo::Complement => (distance.upper == 0.0, distance.lower > 0.0),
            };
            assert!(!outside || !truth, "not outside: {told}");
            assert!(!inside || truth, "not inside: {told}");
            assert!(outside || inside || all <= margin, "no side told: {told}");
        }
        // (From far away, many points are equally near, up to rounding.)
        if to == DistanceTo::Boundary && size < 1e6 * scene.size {
            // (Almost on the surface, all nearby points are equally near, up to rounding.)
            if size > margin {
                bounds_the_solid(scene, near.point, facet, &told);
            }
            no_boundary_is_nearer(scene, p, size, margin, &told);
            if let Some(truth) = truth.filter(|_| scene.is_open && size > margin) {
                let way = [0; 3].map(|_| bytes.fraction());
                let other = at(|k| p[k] + 0.999 * size * way[k] / length(way).max(1e-3));
                let other = scene.holds(&Place::new(other));
                assert!(other.is_none_or(|other| other == truth), "the other side is nearer: {told}");
            }
        }
    }
}

/// Checks that the solid lies on exactly one side of the surface next to a nearest point, slightly towards
/// the middle of its triangle.
fn bounds_the_solid(scene: &Scene, point: Point, facet: Facet, told: &str) {
    let middle = at(|k| (facet[0][k] / 3.0 + facet[1][k] / 3.0) + facet[2][k] / 3.0);
    let inner = at(|k| point[k] + 1e-3 * (middle[k] - point[k]));
    if let Some(sides) = sides(scene, inner, facet) {
        assert!(sides[0] != sides[1], "no boundary: {sides:?} {told}");
    }
}

/// Returns whether the solid lies on either side of a point of a triangle, if no other triangle is near.
fn sides(scene: &Scene, point: Point, facet: Facet) -> Option<[bool; 2]> {
    if plumpness(facet) < 1e-3 {
        return None;
    }
    let [a, b, c] = facet.map(|p| p.map(|c| c / scene.size));
    let normal = cross(minus(b, a), minus(c, a));
    let off = 1e-7 * scene.size;
    let beside = |sign: f64| at(|k| point[k] + sign * off * normal[k] / length(normal));
    let others = scene.moved.iter().filter(|other| from_triangle(**other, point) <= 4.0 * off);
    if others.count() != 1 {
        return None;
    }
    Some([scene.holds(&Place::new(beside(1.0)))?, scene.holds(&Place::new(beside(-1.0)))?])
}

/// Checks that the middles of triangles that bound the solid are not nearer.
fn no_boundary_is_nearer(scene: &Scene, p: Point, distance: f64, margin: f64, told: &str) {
    for facet in &scene.moved {
        let middle = at(|k| (facet[0][k] / 3.0 + facet[1][k] / 3.0) + facet[2][k] / 3.0);
        if sides(scene, middle, *facet).is_some_and(|sides| sides[0] != sides[1]) {
            let away = length(minus(middle, p));
            assert!(distance <= away + 1e-6 * scene.size + margin, "{middle:?} is nearer: {told}");
        }
    }
}
