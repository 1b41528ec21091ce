//! The moments and areas that meshes provide for cells without splits, against exact clipping of tetrahedra.

use leafless::lattice::{CellMoments, CubeMoments, MAX_DEPTH};
use leafless::query::{StopReason, surface_area};
use leafless::solid::{Ask, Parts};
use leafless::{Cell, Classifier, FillRule, Frame, MeshSolid, Solid, TriangleMesh, Verdict, Worker};
use leafless_testkit::{Random, Way, alone, lattice_frame};
use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive};

const RULES: [FillRule; 3] = [FillRule::NonZero, FillRule::EvenOdd, FillRule::Positive];
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Binary digits after the point in coordinates, and in sums.
const GRAIN: u32 = 40;
const POINT: usize = 160;

/// A point in multiples of 2^-[`GRAIN`].
type Point = [i64; 3];
/// Homogeneous coordinates: x, y and z times w, and w > 0.
type Corner = [BigInt; 4];
/// The half-space a x + b y + c z ≤ d.
type Plane = [BigInt; 4];

/// A tetrahedron, with a flag for an inside-out one.
#[derive(Debug, Clone)]
struct Body {
    corners: [Point; 4],
    inside_out: bool,
}

fn turn([a, b, c, d]: &[Point; 4]) -> BigInt {
    let [u, v, w] = [b, c, d].map(|p| [0, 1, 2].map(|k| BigInt::from(p[k] - a[k])));
    let minor = |i: usize, j: usize| &u[i] * &v[j] - &u[j] * &v[i];
    minor(1, 2) * &w[0] + minor(2, 0) * &w[1] + minor(0, 1) * &w[2]
}

impl Body {
    fn new(mut corners: [Point; 4], inside_out: bool) -> Option<Body> {
        let turn = turn(&corners);
        if turn.is_negative() {
            corners.swap(0, 1);
        }
        (turn != BigInt::from(0)).then_some(Body { corners, inside_out })
    }

    /// The faces. Seen from outside, corners are counter-clockwise.
    fn faces(&self) -> [[Point; 3]; 4] {
        let [a, b, c, d] = self.corners;
        [[a, c, b], [a, b, d], [b, c, d], [c, a, d]]
    }

    fn facets(&self) -> Vec<[[f64; 3]; 3]> {
        let unit = 2f64.powi(-(GRAIN as i32));
        let faces = self.faces().into_iter();
        faces
            .map(|[a, b, c]| if self.inside_out { [a, c, b] } else { [a, b, c] })
            .map(|face| face.map(|p| p.map(|x| x as f64 * unit)))
            .collect()
    }

    fn planes(&self) -> Vec<Plane> {
        let of = |[a, b, c]: [Point; 3]| {
            let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| BigInt::from(p[k] - a[k])));
            let minor = |i: usize, j: usize| &u[i] * &v[j] - &u[j] * &v[i];
            let n = [minor(1, 2), minor(2, 0), minor(0, 1)];
            let d = (0..3).map(|k| &n[k] * a[k]).sum();
            let [x, y, z] = n;
            [x, y, z, d]
        };
        self.faces().into_iter().map(of).collect()
    }
}

/// Appends the parts of a tetrahedron on the inner side of a plane.
fn clip(plane: &Plane, corners: &[Corner; 4], out: &mut Vec<[Corner; 4]>) {
    let value =
        |p: &Corner| (0..3).fold(-(&plane[3] * &p[3]), |sum: BigInt, axis| sum + &plane[axis] * &p[axis]);
    let (mut inner, mut outer) = (Vec::new(), Vec::new());
    for p in corners {
        let at = value(p);
        if at.is_positive() { outer.push((p, at)) } else { inner.push((p, at)) }
    }
    let between = |a: usize, b: usize| {
        let ((p, at_p), (q, at_q)) = (&inner[a], &outer[b]);
        [0, 1, 2, 3].map(|i| at_q * &p[i] - at_p * &q[i])
    };
    let inside = |a: usize| inner[a].0.clone();
    let mut prism = |a: [Corner; 3], b: [Corner; 3]| {
        let ([a0, a1, a2], [b0, b1, b2]) = (a, b);
        out.push([a0.clone(), a1.clone(), a2, b2.clone()]);
        out.push([a0.clone(), a1, b1.clone(), b2.clone()]);
        out.push([a0, b0, b1, b2]);
    };
    match inner.len() {
        0 => {}
        1 => out.push([inside(0), between(0, 0), between(0, 1), between(0, 2)]),
        2 => {
            let [a, b] = [0, 1].map(|k| [inside(k), between(k, 0), between(k, 1)]);
            prism(a, b);
        }
        3 => prism([0, 1, 2].map(inside), [0, 1, 2].map(|k| between(k, 0))),
        _ => out.push([0, 1, 2, 3].map(inside)),
    }
}

/// Moments in a cell's coordinates, in 2^-[`POINT`]: volume, first and second moments.
#[derive(Debug, Clone, Default)]
struct Exactly([BigInt; 10]);

/// Returns the cell's centre and half its edge, in units of the grain.
fn centre(cell: Cell, depth: u8) -> (Point, i64) {
    let half = 1i64 << (u32::from(depth - cell.level) + GRAIN - 1);
    (cell.at.map(|a| (2 * i64::from(a) + 1) * half), half)
}

impl Exactly {
    /// Returns the moments of the bodies' intersection with a cell; without bodies, those of the whole cell.
    fn common(bodies: &[&Body], cell: Cell, depth: u8) -> Exactly {
        let (centre, half) = centre(cell, depth);
        let mut pieces = Vec::new();
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let mut corner = centre.map(|c| c - half);
            let mut path = vec![corner];
            for axis in order {
                corner[axis] += 2 * half;
                path.push(corner);
            }
            let homogeneous = |[x, y, z]: Point| [x, y, z, 1].map(BigInt::from);
            pieces.push([0, 1, 2, 3].map(|k| homogeneous(path[k])));
        }
        for plane in bodies.iter().flat_map(|body| body.planes()) {
            let mut kept = Vec::new();
            pieces.iter().for_each(|piece| clip(&plane, piece, &mut kept));
            pieces = kept;
        }
        let mut sums: [BigInt; 10] = Default::default();
        for corners in &pieces {
            let p = corners
                .each_ref()
                .map(|c| [0, 1, 2].map(|i| ((&c[i] - &c[3] * centre[i]) << POINT) / (&c[3] * half)));
            let d = [1, 2, 3].map(|k| [0, 1, 2].map(|i| &p[k][i] - &p[0][i]));
            let minor = |i: usize, j: usize| &d[1][i] * &d[2][j] - &d[1][j] * &d[2][i];
            let determinant = &d[0][0] * minor(1, 2) + &d[0][1] * minor(2, 0) + &d[0][2] * minor(0, 1);
            let volume: BigInt = (determinant.abs() / 6) >> (2 * POINT);
            let s = [0, 1, 2].map(|i| p.iter().map(|p| &p[i]).sum::<BigInt>());
            for i in 0..3 {
                sums[1 + i] += (&volume * &s[i] / 4) >> POINT;
            }
            for (k, (i, j)) in PAIRS.into_iter().enumerate() {
                let products: BigInt = p.iter().map(|p| &p[i] * &p[j]).sum();
                sums[4 + k] += (&volume * (products + &s[i] * &s[j]) / 20) >> (2 * POINT);
            }
            sums[0] += volume;
        }
        Exactly(sums)
    }

    /// Returns the moments of the points in a cell that the bodies enclose by a rule. The indicator function
    /// is a polynomial in the bodies' indicator functions.
    fn enclosed(bodies: &[Body], rule: FillRule, cell: Cell, depth: u8) -> Exactly {
        let is_inside = |set: u32| {
            let winding: i32 = (0..bodies.len())
                .filter(|k| set >> k & 1 != 0)
                .map(|k| if bodies[k].inside_out { -1 } else { 1 })
                .sum();
            i32::from(match rule {
                FillRule::NonZero => winding != 0,
                FillRule::EvenOdd => winding % 2 != 0,
                FillRule::Positive => winding > 0,
            })
        };
        let mut sums = Exactly::default();
        for set in 0..1u32 << bodies.len() {
            let coefficient: i32 = (0..=set)
                .filter(|part| part & !set == 0)
                .map(
                    |part| {
                        if (set ^ part).count_ones() % 2 == 0 { is_inside(part) } else { -is_inside(part) }
                    },
                )
                .sum();
            if coefficient != 0 {
                let members: Vec<&Body> =
                    (0..bodies.len()).filter(|k| set >> k & 1 != 0).map(|k| &bodies[k]).collect();
                let common = Exactly::common(&members, cell, depth);
                sums.0.iter_mut().zip(common.0).for_each(|(sum, term)| *sum += term * coefficient);
            }
        }
        sums
    }

    /// Returns the greatest difference from the computed moments.
    fn error(&self, moments: &CubeMoments) -> f64 {
        let [x, y, z] = moments.first;
        let [xx, yy, zz, xy, xz, yz] = moments.second;
        let values = [moments.volume, x, y, z, xx, yy, zz, xy, xz, yz];
        let errors = values.into_iter().zip(&self.0).map(|(value, exact)| {
            let scaled = BigInt::from((value * 2f64.powi(100)) as i128) << (POINT - 100);
            ((scaled - exact) >> (POINT - 120)).to_f64().unwrap().abs() / 2f64.powi(120)
        });
        errors.fold(0.0, f64::max)
    }
}

/// A random point of the universe or of a coarse lattice in it, or a vertex of another body.
fn point(random: &mut Random, depth: u8, grain: u32, others: &[Body]) -> Point {
    if !others.is_empty() && random.below(3) == 0 {
        let body = &others[random.below(others.len() as u64) as usize];
        return body.corners[random.below(4) as usize];
    }
    let edge = 1i64 << (u32::from(depth) + GRAIN);
    let unit = 1i64 << grain;
    // Doubles have 53 bits.
    [0; 3].map(|_| ((random.below((edge / unit) as u64 + 1) as i64) * unit) as f64 as i64)
}

fn bodies(random: &mut Random, depth: u8) -> Vec<Body> {
    let mut found: Vec<Body> = Vec::new();
    let count = 1 + random.below(4) as usize;
    // Coordinates of any size, of half finest cells, or of an eighth of the universe.
    let grain = match random.below(4) {
        0 => GRAIN - 1,
        1 => u32::from(depth) + GRAIN - 3,
        _ => 0,
    };
    for _ in 0..100 {
        let corners = [(); 4].map(|()| point(random, depth, grain, &found));
        found.extend(Body::new(corners, random.below(3) == 0));
        if found.len() == count {
            break;
        }
    }
    found
}

#[derive(Debug, Default)]
struct Found {
    cells: u64,
    known: u64,
    /// Number of known cells that are neither full nor empty.
    cut: u64,
    /// Number of known cells with bodies that overlap or touch.
    several: u64,
    greatest: f64,
    /// Greatest ratio of an error to its stated bound.
    share: f64,
}

/// Walks to a finest cell. Checks the moments of every cell on the way against exact clipping.
fn walk(bodies: &[Body], rule: FillRule, frame: &Frame, stray: bool, random: &mut Random, found: &mut Found) {
    let mut facets: Vec<_> = bodies.iter().flat_map(Body::facets).collect();
    if stray {
        // A triangle far away, too small to decide anything. It makes the surface open.
        let far = 64.0 * frame.edge();
        facets.push([
            [far, 0.0, 0.0],
            [far + frame.edge() / 64.0, 0.0, 0.0],
            [far, 0.0, frame.edge() / 64.0],
        ]);
    }
    let Ok(mesh) = TriangleMesh::from_facets(facets) else { return };
    let Ok(solid) = MeshSolid::new(mesh, rule) else { return };
    let Some(mut way) = Way::new(solid.on(frame, &alone()).unwrap().worker().unwrap()) else { return };
    loop {
        let cell = way.cell;
        found.cells += 1;
        if let Some(CellMoments { moments, error }) = way.worker.moments(cell, &way.part).unwrap() {
            let exact = Exactly::enclosed(bodies, rule, cell, frame.depth());
            let off = exact.error(&moments);
            assert!(off <= error, "{off:e} {error:e} {cell:?} {rule:?}\n{bodies:?}");
            found.known += 1;
            found.share = found.share.max(off / error);
            found.cut += u64::from(moments.volume > 1e-9 && moments.volume < 8.0 - 1e-9);
            found.several += u64::from(bodies.len() > 1);
            found.greatest = found.greatest.max(error * 2f64.powi(-3 * i32::from(cell.level)));
        }
        if !way.descend(random) {
            return;
        }
    }
}

fn soups(count: u64, first: u64) {
    let mut found = [Found::default(), Found::default()];
    for seed in first..first + count {
        let mut random = Random(seed ^ 0x3E5);
        let depth = [2, 5, 10, MAX_DEPTH][random.below(4) as usize];
        let frame = lattice_frame(depth);
        let bodies = bodies(&mut random, depth);
        let stray = random.below(4) == 0;
        for rule in RULES {
            walk(&bodies, rule, &frame, stray, &mut random, &mut found[usize::from(stray)]);
        }
    }
    println!("{found:#?}");
    for found in &found {
        assert!(found.known > found.cells / 4 && found.cut > found.known / 4, "{found:?}");
        assert!(found.several > 0 && found.greatest < 1e-10, "{found:?}");
    }
}

/// Returns the area of the boundary in a cell: the sum of its bounds over descendants with an area known to
/// 1e-9.
fn area(
    worker: &mut <<MeshSolid as Solid>::Classifier as Classifier>::Worker,
    cell: Cell,
    part: &Part,
) -> [f64; 2] {
    let half = 0.5 * 2f64.powi(-i32::from(cell.level));
    let known = worker.area(cell, part).unwrap().unwrap();
    assert!(0.0 <= known.lower && known.lower <= known.upper);
    if known.width() < 1e-9 || cell.level == 7 {
        return [known.lower, known.upper].map(|x| x * half * half);
    }
    let mark = worker.mark();
    let mut sums = [0.0; 2];
    for (octant, verdict) in (0..8).zip(worker.split(cell, part).unwrap()) {
        if let Verdict::Partial(part) = verdict {
            let below = area(worker, cell.child(octant), &part);
            sums = [sums[0] + below[0], sums[1] + below[1]];
        }
    }
    worker.release(mark);
    sums
}

type Part = <<<MeshSolid as Solid>::Classifier as Classifier>::Worker as Parts>::Part;

/// Two tetrahedra with right angles at a corner, of edges 0.6 and 0.3, in the universe of edge 1.
#[test]
fn areas_are_those_of_triangles() {
    let unit = (1i64 << GRAIN) / 10;
    let tetrahedron = |corner: Point, edge: i64, inside_out| {
        let tip = |axis: usize| {
            let mut tip = corner;
            tip[axis] += edge;
            tip
        };
        Body::new([corner, tip(0), tip(1), tip(2)], inside_out).unwrap()
    };
    let area_of = |edge: f64| edge * edge * (1.5 + 0.75f64.sqrt());
    let large = tetrahedron([unit; 3], 6 * unit, false);
    let within = |inside_out| tetrahedron([2 * unit; 3], unit, inside_out);
    let beside = tetrahedron([2 * unit, 2 * unit, 8 * unit], unit, false);
    // A corner of this one reaches out of the face at x = 0.1.
    let across = tetrahedron([unit - unit / 2, 2 * unit, 2 * unit], unit, false);
    let section = (0.05 / 0.1) * (0.05 / 0.1) * (0.1 * 0.1 / 2.0);
    let hidden = area_of(0.05) - section;
    for (second, rule, expected) in [
        (beside.clone(), FillRule::NonZero, area_of(0.6) + area_of(0.1)),
        (within(true), FillRule::NonZero, area_of(0.6) + area_of(0.1)),
        (within(false), FillRule::NonZero, area_of(0.6)),
        (within(false), FillRule::EvenOdd, area_of(0.6) + area_of(0.1)),
        (across.clone(), FillRule::EvenOdd, area_of(0.6) + area_of(0.1)),
        // The part of either boundary inside the other body is no boundary.
        (across, FillRule::NonZero, area_of(0.6) + area_of(0.1) - hidden - section),
    ] {
        let facets: Vec<_> = [&large, &second].into_iter().flat_map(Body::facets).collect();
        let solid = MeshSolid::new(TriangleMesh::from_facets(facets).unwrap(), rule).unwrap();
        let frame = Frame::new([-0.01, 0.0, 0.0], 1.0, 12).unwrap();
        let mut worker = solid.on(&frame, &alone()).unwrap().worker().unwrap();
        let Verdict::Partial(part) = worker.root().unwrap() else { panic!() };
        let [lower, upper] = area(&mut worker, Cell::ROOT, &part);
        assert!(
            lower <= expected + 1e-10 && expected <= upper + 1e-10,
            "{rule:?}: {lower} {expected} {upper}"
        );
        assert!(upper - lower < 5e-3, "{rule:?}: {lower} {expected} {upper}");
        let all = surface_area(&solid, &frame, 1e-3, &alone()).unwrap();
        let is_within = all.area.lower <= expected + 1e-10 && expected <= all.area.upper + 1e-10;
        assert!(is_within && all.stop_reason == StopReason::Tolerance, "{rule:?}: {expected} {all:?}");
    }
}

#[test]
fn moments_of_soups_are_exact() {
    soups(60, 0);
}

/// As above, with more soups.
#[test]
#[ignore = "takes minutes"]
fn moments_of_many_soups_are_exact() {
    soups(2000, 1000);
}
