//! Extended octrees of meshes: the planes that bound the solid in a cell, and the Boolean function of their
//! sides.

use crate::attributes::distance;
use crate::oracle::{Oracle, PointOracle};
use crate::shapes::{self, Soup};
use leafless_testkit::{Random, alone, model, on_all_processors, repeated};

use leafless::file::{from_bytes, to_bytes};
use leafless::mesh::MeshMoments;
use leafless::solid::HalfSpace;
use leafless::{
    Affine, AnySolid, Cell, Control, Csg, FillRule, Frame, Membership, MeshSolid, Octree, Solid,
    SurfaceOptions, TriangleMesh, build_extended, compact, complement, contains, difference, exchange,
    intersection, measure, union, xor,
};

type Point = [f64; 3];

fn at(of: impl FnMut(usize) -> f64) -> Point {
    [0, 1, 2].map(of)
}

/// Rotates a soup by an angle of no round number, and moves it.
fn turned(soup: &Soup) -> Soup {
    shapes::moved(soup, |[x, y, z]| {
        let (x, y) = (0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y);
        let (y, z) = (0.28 * y + 0.96 * z, 0.28 * z - 0.96 * y);
        [x + 0.013, y - 0.17, z + 0.4]
    })
}

/// Rounds a soup to single precision, as a file does.
fn single(soup: &Soup) -> Soup {
    shapes::moved(soup, |p| p.map(|c| f64::from(c as f32)))
}

fn joined(soups: &[Soup]) -> Soup {
    soups.concat()
}

/// All test meshes, each with its purpose.
fn soups(random: &mut Random) -> Vec<(&'static str, Soup)> {
    let block = shapes::block;
    let base = || block([0.0; 3], [1.0, 0.75, 0.5]);
    let octagon: Vec<[f64; 2]> = (0..8)
        .map(|k| (0.5 + f64::from(k)) * std::f64::consts::FRAC_PI_4)
        .map(|angle| [0.5 * angle.cos(), 0.5 * angle.sin()])
        .collect();
    let many: Vec<[f64; 2]> = (0..48)
        .map(|k| f64::from(k) * std::f64::consts::TAU / 48.0)
        .map(|angle| [0.5 * angle.cos(), 0.5 * angle.sin()])
        .collect();
    // Two facets on the same corners, one for each side.
    let fin = |[a, b, c]: [Point; 3]| vec![[a, b, c], [a, c, b]];
    let wedge = shapes::tetrahedron([[0.0; 3], [1.0, 0.0, 0.125], [1.0, 0.0, 0.25], [0.0, 1.0, 0.0]]);
    let mut all = vec![
        ("block", base()),
        ("prism", shapes::prism(&octagon, [0.0; 2], -0.25, 0.25)),
        ("cylinder", shapes::prism(&many, [0.0; 2], -0.25, 0.25)),
        ("octahedron", shapes::octahedron([0.1, 0.2, 0.3], 0.7)),
        ("torus", shapes::torus([0.0; 3], 1.0, 0.4, 24, 16)),
        ("knife edge", wedge),
        ("rib", joined(&[base(), block([0.3, 0.2, 0.5], [0.3001, 0.5, 0.9])])),
        ("rib through", joined(&[base(), block([0.3, 0.2, -0.2], [0.3001, 0.5, 0.9])])),
        ("slit", joined(&[base(), shapes::inside_out(block([0.3, 0.2, 0.1], [0.3001, 0.5, 0.4]))])),
        ("fin", joined(&[base(), fin([[0.3, 0.2, 0.5], [0.5, 0.6, 0.5], [0.4, 0.3, 1.0]])])),
        ("nested", joined(&[base(), block([0.2; 3], [0.7, 0.6, 0.4])])),
        ("hollow", joined(&[base(), shapes::inside_out(block([0.2; 3], [0.7, 0.6, 0.4]))])),
        ("inside out", shapes::inside_out(base())),
        ("crossed", joined(&[base(), block([0.25, -0.2, 0.25], [0.75, 1.2, 0.75])])),
        (
            "crossed inside out",
            joined(&[base(), shapes::inside_out(block([0.25, -0.2, 0.25], [0.75, 1.2, 0.75]))]),
        ),
        ("touching", joined(&[base(), block([1.0, 0.2, 0.1], [1.5, 0.6, 0.9])])),
        ("twice", joined(&[base(), base()])),
        ("bodies", shapes::tetrahedra(random, 6, |random| at(|_| random.between(-1.0, 1.0)))),
        ("bodies on a grid", shapes::tetrahedra(random, 6, |random| at(|_| random.below(5) as f64 * 0.25))),
        ("needle", shapes::tetrahedron([[0.0; 3], [1.0, 0.0, 1e-9], [1.0, 1e-9, 0.0], [0.0, 1e-9, 1e-9]])),
    ];
    let more: Vec<(&str, Soup)> = all.iter().map(|(name, soup)| (*name, turned(soup))).collect();
    let rounded: Vec<(&str, Soup)> = more.iter().map(|(name, soup)| (*name, single(soup))).collect();
    all.extend(more);
    all.extend(rounded);
    all
}

struct Trial {
    mesh: TriangleMesh,
    oracle: PointOracle,
    fill: FillRule,
    frame: Frame,
    tolerance: f64,
    tree: Octree,
}

impl Trial {
    fn new(mesh: TriangleMesh, fill: FillRule, tolerance: f64, most: u8) -> Trial {
        let solid = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
        let options = SurfaceOptions { tolerance: Some(tolerance) };
        let frame = options.frame(&Solid::bounds(&solid).unwrap()).unwrap();
        let frame = frame.with_depth(frame.depth().min(most)).unwrap();
        let tree = build_extended(&solid, &frame, &options, &alone()).unwrap();
        tree.view().check().unwrap();
        let again = build_extended(&solid, &frame, &options, &Control::threads(2)).unwrap();
        assert_eq!(tree, again);
        Trial { oracle: PointOracle::new(&mesh), mesh, fill, frame, tolerance, tree }
    }

    /// Returns the truth at a point; `None` on the surface.
    fn truth(&self, p: Point) -> Option<bool> {
        self.oracle.winding(p).map(|winding| Oracle::inside(self.fill, winding))
    }

    fn corners(&self) -> impl Iterator<Item = [Point; 3]> {
        let vertices = self.mesh.vertices();
        self.mesh.triangles().iter().map(|t| t.map(|v| vertices[v as usize]))
    }

    /// Points on the surface, points at distances from almost nothing to a tenth of the size, and points
    /// anywhere.
    fn points(&self, random: &mut Random, count: usize) -> Vec<Point> {
        let (low, high) = self.mesh.bounds();
        let size = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        let corners: Vec<_> = self.corners().collect();
        (0..count)
            .map(|k| {
                let [a, b, c] = corners[random.below(corners.len() as u64) as usize];
                let (mut u, mut v) = (random.unit(), random.unit());
                if u + v > 1.0 {
                    (u, v) = (1.0 - u, 1.0 - v);
                }
                if k % 5 == 1 {
                    v = 0.0;
                }
                let off = size * 10f64.powf(random.between(-16.0, -1.0));
                let near =
                    at(|i| a[i] + u * (b[i] - a[i]) + v * (c[i] - a[i]) + off * random.between(-1.0, 1.0));
                match k % 5 {
                    0 => at(|i| random.between(low[i] - 0.1 * size, high[i] + 0.1 * size)),
                    2 => at(|i| a[i] + off * random.between(-1.0, 1.0)),
                    _ => near,
                }
            })
            .collect()
    }

    /// True if a triangle lies within a distance of a point.
    fn is_within(&self, p: Point, most: f64) -> bool {
        self.corners().any(|corners| {
            let [a, b, c] = corners;
            let is_beside =
                |k: usize| p[k] < a[k].min(b[k]).min(c[k]) - most || p[k] > a[k].max(b[k]).max(c[k]) + most;
            !(0..3).any(is_beside) && distance(p, corners).0 <= most
        })
    }

    /// True if the finest cell that contains a point has no function.
    fn is_given_up(&self, p: Point) -> bool {
        let Some(at) = self.frame.cell_of(p) else { return true };
        self.tree.view().cell_function(Cell { level: self.frame.depth(), at }).is_none()
    }

    /// Compares the answers for points with the truth; returns the number of decided points.
    fn check(&self, name: &str, points: &[Point]) -> usize {
        let mut answers = vec![Membership::Undecided; points.len()];
        contains(&self.tree, &self.frame, points, &mut answers, &alone()).unwrap();
        let mut known = 0;
        for (&p, answer) in points.iter().zip(answers) {
            let told = || format!("{name}, {:?}, {}, {:?}: {p:?}", self.fill, self.tolerance, self.frame);
            match (answer, self.truth(p)) {
                (Membership::Inside, truth) => assert!(truth != Some(false), "not inside: {}", told()),
                (Membership::Outside, truth) => assert!(truth != Some(true), "not outside: {}", told()),
                (Membership::Undecided, _) => {
                    let is_near = self.is_within(p, 2.0 * self.tolerance) || self.is_given_up(p);
                    assert!(is_near, "undecided off the surface: {}", told());
                    continue;
                }
            }
            known += 1;
        }
        known
    }
}

/// For every mesh, no point is decided wrongly, and all points away from the surface are decided.
#[test]
fn functions_of_planes_are_the_solid() {
    let mut random = Random(0x1A7E5);
    for (name, soup) in soups(&mut random).into_iter().step_by(repeated(3, 1)) {
        for (tolerance, most) in [(0.05, 9), (1e-3, 9)] {
            let fill = [FillRule::NonZero, FillRule::EvenOdd, FillRule::Positive][random.below(3) as usize];
            let trial = Trial::new(shapes::mesh(&soup), fill, tolerance, most);
            let points = trial.points(&mut random, 2_000);
            let known = trial.check(name, &points);
            // (For a needle, most points are closer to the surface than a thousandth of the tolerance.)
            assert!(known > 250, "{name}, {tolerance}: {known}");
        }
    }
}

/// In a cube, straight lines between points of a cell run through edges and corners.
#[test]
fn cubes_take_a_cell_a_corner() {
    for (low, high) in [(0.0, 1.0), (-1.0, 1.0), (1.1, 3.3), (1.125, 3.25), (-7.7, 5.9)] {
        for tolerance in [1e-2, 1e-4] {
            let cube = shapes::block([low; 3], [high; 3]);
            let trial = Trial::new(shapes::mesh(&cube), FillRule::NonZero, tolerance, 16);
            let cuts = trial.tree.view().cuts().unwrap();
            assert!(cuts.cells == 8 && cuts.given_up == 0, "{low} to {high}, {tolerance}: {cuts:?}");
            trial.check("cube", &trial.points(&mut Random(1), 500));
        }
    }
}

/// A mesh's own moments are kept until an operation changes the solid.
#[test]
fn moments_of_meshes_are_kept() {
    let options = SurfaceOptions { tolerance: Some(1e-3) };
    let solid = |soup: &Soup| MeshSolid::new(shapes::mesh(soup), FillRule::NonZero).unwrap();
    let built = |soup: &Soup| {
        let solid = solid(soup);
        let frame = options.frame(&Solid::bounds(&solid).unwrap()).unwrap();
        build_extended(&solid, &frame, &options, &alone()).unwrap()
    };
    let whole = turned(&shapes::torus([0.0; 3], 1.0, 0.4, 24, 16));
    let tree = built(&whole);
    let moments = tree.view().moments().expect("moments");
    let MeshMoments::Known(own) = solid(&whole).moments(&alone()).unwrap() else { panic!("no moments") };
    assert_eq!(moments, own);
    let found = measure(&tree, tree.frame(), 0.0, &alone()).unwrap();
    assert!(found.exact && found.splits == 0 && found.volume == own.volume);
    assert_eq!(found.centroid, own.centroid());

    // Without moments the cells give wider bounds, and all else is the same.
    let bare = tree.without_moments();
    assert_eq!((&bare, bare.view().moments()), (&tree, None));
    let few = Control { max_splits: Some(10_000), ..alone() };
    let by_cells = measure(&bare, tree.frame(), 0.0, &few).unwrap();
    assert!(!by_cells.exact && by_cells.volume.contains(own.volume.lower));
    assert!(by_cells.volume.width() > found.volume.width());

    // Files, copies, and trees built from the tree have the moments.
    let bytes = to_bytes(&tree).unwrap();
    let opened = from_bytes(&bytes).unwrap();
    assert_eq!(opened.view().moments(), Some(own));
    assert_eq!(to_bytes(&opened).unwrap(), bytes);
    assert_eq!(compact(tree.view()).unwrap().view().moments(), Some(own));
    let again = build_extended(&tree, tree.frame(), &options, &alone()).unwrap();
    assert_eq!(again.view().moments(), Some(own));
    // A different solid has no stored moments.
    let ball =
        build_extended(&Csg::ball([1.0, 0.0, 0.0], 0.3).unwrap(), tree.frame(), &options, &alone()).unwrap();
    assert_eq!(difference(tree.view(), ball.view(), &alone()).unwrap().view().moments(), None);
    assert_eq!(complement(tree.view(), &alone()).unwrap().view().moments(), None);
    // A mesh with intersecting triangles has none, either, nor has a mesh cut off by the universe.
    let crossed = joined(&[shapes::block([0.0; 3], [1.0; 3]), turned(&shapes::block([0.0; 3], [1.0; 3]))]);
    assert_eq!(built(&crossed).view().moments(), None);
    let inner = Frame::new([0.0; 3], 1.0, 8).unwrap();
    assert_eq!(build_extended(&solid(&whole), &inner, &options, &alone()).unwrap().view().moments(), None);
}

/// A Boolean function of two operands.
type Joins = fn(bool, bool) -> bool;

/// Set operations of a stored mesh with a ball, a rotated block and the same mesh moved. No point may be
/// decided wrongly.
fn check_booleans(name: &str, trial: &Trial, random: &mut Random, count: usize) {
    let (low, high) = trial.mesh.bounds();
    let middle = at(|k| low[k].midpoint(high[k]));
    let size = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    let centre = at(|k| middle[k] + [0.11, 0.07, 0.2][k] * size);
    let radius = 0.23 * size;
    let ball = Csg::ball(centre, radius).unwrap();
    let normal = [0.6, -0.64, 0.48];
    let offset = -(0..3).map(|k| normal[k] * middle[k]).sum::<f64>();
    let half = Csg::from(HalfSpace::plane(normal, offset).unwrap());
    let options = SurfaceOptions { tolerance: Some(trial.tolerance) };
    let stored = |csg: &Csg| build_extended(csg, &trial.frame, &options, &alone()).unwrap();
    let in_ball = |p: Point| {
        let off = (0..3).map(|k| (p[k] - centre[k]).powi(2)).sum::<f64>().sqrt() - radius;
        (off.abs() > 1e-12 * size).then_some(off < 0.0)
    };
    let in_half = |p: Point| {
        let off = (0..3).map(|k| normal[k] * p[k]).sum::<f64>() + offset;
        (off.abs() > 1e-12 * size).then_some(off > 0.0)
    };
    type Truth<'t> = &'t dyn Fn(Point) -> Option<bool>;
    let others: [(&str, Octree, Truth<'_>); 2] =
        [("ball", stored(&ball), &in_ball), ("half-space", stored(&half), &in_half)];
    for (other_name, other, truth) in &others {
        let (own, other, alone) = (trial.tree.view(), other.view(), &alone());
        let results: [(&str, Octree, Joins); 5] = [
            ("union", union(own, other, alone).unwrap(), |a, b| a || b),
            ("intersection", intersection(own, other, alone).unwrap(), |a, b| a && b),
            ("difference", difference(own, other, alone).unwrap(), |a, b| a && !b),
            ("converse", difference(other, own, alone).unwrap(), |a, b| b && !a),
            ("xor", xor(own, other, alone).unwrap(), |a, b| a != b),
        ];
        for (what, tree, joins) in &results {
            tree.view().check().unwrap();
            let points = trial.points(random, count);
            let mut answers = vec![Membership::Undecided; points.len()];
            contains(tree, &trial.frame, &points, &mut answers, alone).unwrap();
            let mut known = 0;
            for (&p, answer) in points.iter().zip(answers) {
                let (Some(a), Some(b)) = (trial.truth(p), truth(p)) else { continue };
                let inside = joins(a, b);
                known += usize::from(answer != Membership::Undecided);
                let is_wrong = answer == if inside { Membership::Outside } else { Membership::Inside };
                assert!(!is_wrong, "{name} {what} {other_name}: {p:?} is told {answer:?}");
            }
            assert!(known > count / 5, "{name} {what} {other_name}: {known} of {count}");
        }
    }
    // A set minus itself is empty, although its slabs are known only within a width.
    let none = difference(trial.tree.view(), trial.tree.view(), &alone()).unwrap();
    let given_up = trial.tree.view().cuts().map_or(0, |cuts| cuts.given_up);
    assert!(given_up > 0 || none.statistics().nodes() == 0, "{name}");
}

#[test]
fn set_operations_of_stored_meshes() {
    let mut random = Random(0xB001);
    for (name, soup) in soups(&mut random).into_iter().skip(1).step_by(3) {
        let trial = Trial::new(shapes::mesh(&soup), FillRule::NonZero, 1e-3, 10);
        check_booleans(name, &trial, &mut random, 500);
    }
}

fn opened(name: &str) -> Option<(TriangleMesh, f64)> {
    let path = model(name)?;
    let mesh = exchange::open_mesh(path, &exchange::MeshOptions::default()).unwrap().mesh.sewn().unwrap();
    let (low, high) = mesh.bounds();
    let size = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    Some((mesh, size))
}

/// Machined parts take few cells, and their volume is known nearly as well as the mesh's own.
#[test]
fn machined_parts_take_few_cells() {
    for (name, most_nodes, width) in
        [("featuretype.STL", 3_500, 1e-8), ("angle_block.STL", 2_500, 1e-6), ("plate_holes.STL", 3_500, 1e-7)]
    {
        let Some((mesh, size)) = opened(name) else { continue };
        let volume = mesh.volume();
        let trial = Trial::new(mesh, FillRule::NonZero, 1e-6 * size, 20);
        let cuts = trial.tree.view().cuts().unwrap();
        let nodes = trial.tree.statistics().nodes();
        assert!(nodes <= most_nodes, "{name}: {nodes} nodes");
        assert!(cuts.given_up < 100, "{name}: {cuts:?}");
        let budget = Control { max_splits: Some(20_000), ..alone() };
        let found = measure(&trial.tree.without_moments(), &trial.frame, 1e-30, &budget).unwrap();
        assert!(found.volume.contains(volume), "{name}: {:?}", found.volume);
        assert!(found.volume.width() < width * volume, "{name}: {:e}", found.volume.width() / volume);
    }
}

/// A million points around the surface of a model, and as many around ten set operations of the model.
fn million(name: &str, tolerance: f64) {
    let Some((mesh, size)) = opened(name) else { return };
    let triangles = mesh.triangles().len();
    let trial = Trial::new(mesh, FillRule::NonZero, tolerance * size, 20);
    let cuts = trial.tree.view().cuts().unwrap();
    let seeds: Vec<u64> = (0..100).collect();
    let known: usize = on_all_processors(&seeds, |&seed| {
        let points = trial.points(&mut Random(seed), 10_000);
        trial.check(name, &points)
    })
    .iter()
    .sum();
    println!(
        "{name}, {triangles} triangles, to {tolerance:e}: {known} of a million points are told, {cuts:?}"
    );
    check_booleans(name, &trial, &mut Random(1), 100_000);
}

#[test]
#[ignore = "minutes"]
fn a_million_points_of_machined_parts() {
    for name in ["featuretype.STL", "angle_block.STL", "plate_holes.STL"] {
        million(name, 1e-6);
    }
}

#[test]
#[ignore = "minutes"]
fn a_million_points_of_smooth_parts() {
    for name in ["fandisk.obj", "bunny-closed.stl", "busted.STL"] {
        million(name, 1e-3);
    }
}

/// Two rotations about axes, scaled by five. They are exact for points of moderately many bits.
const TURNS: [[[f64; 4]; 3]; 2] = [
    [[3.0, -4.0, 0.0, 0.0], [4.0, 3.0, 0.0, 0.0], [0.0, 0.0, 5.0, 0.0]],
    [[5.0, 0.0, 0.0, 0.0], [0.0, 3.0, -4.0, 0.0], [0.0, 4.0, 3.0, 0.0]],
];

/// Rotates a stored mesh again and again. No point may be decided wrongly. Returns, for each rotation, the
/// number of nodes and the number of decided points out of `count`.
fn turned_stored(name: &str, trial: &Trial, turns: usize, count: usize) -> Vec<(u64, usize)> {
    let mut random = Random(0x7057);
    let (low, high) = trial.mesh.bounds();
    let reach = low.iter().chain(&high).fold(0.0, |most: f64, c| most.max(c.abs()));
    let unit = 2f64.powi(reach.log2().ceil() as i32 - 45);
    let mut points = trial.points(&mut random, count);
    points.iter_mut().for_each(|p| *p = p.map(|c| (c / unit).round() * unit + 0.0));
    // (On a facet parallel to its rays, the oracle decides by a shift. Such points count as undecided.)
    let truth_off_surface = |p: Point| {
        let truth = trial.truth(p)?;
        let beside =
            |k: usize| trial.truth(at(|i| p[i] + if i == k / 2 { [-unit, unit][k % 2] } else { 0.0 }));
        (0..6).all(|k| beside(k) == Some(truth)).then_some(truth)
    };
    let truth: Vec<_> = points.iter().map(|&p| truth_off_surface(p)).collect();
    let source = points.clone();
    let (mut tree, mut tolerance, mut found) = (trial.tree.clone(), trial.tolerance, Vec::new());
    for rows in TURNS.iter().cycle().take(turns) {
        let map = Affine::new(*rows).unwrap();
        let moved = AnySolid::new(tree).placed(&map).unwrap();
        tolerance *= 5.0;
        let options = SurfaceOptions { tolerance: Some(tolerance) };
        let frame = options.frame(&Solid::bounds(&moved).unwrap()).unwrap();
        let frame = frame.with_depth(frame.depth().min(trial.frame.depth() + 1)).unwrap();
        tree = build_extended(&moved, &frame, &options, &alone()).unwrap();
        tree.view().check().unwrap();
        points.iter_mut().for_each(|p| *p = map.apply(*p));
        let mut answers = vec![Membership::Undecided; points.len()];
        contains(&tree, &frame, &points, &mut answers, &alone()).unwrap();
        for ((p, answer), truth) in source.iter().zip(&answers).zip(&truth) {
            let is_wrong = match answer {
                Membership::Inside => *truth == Some(false),
                Membership::Outside => *truth == Some(true),
                Membership::Undecided => false,
            };
            let away =
                || trial.corners().map(|corners| distance(*p, corners).0).fold(f64::INFINITY, f64::min);
            assert!(
                !is_wrong,
                "{name}, {:?}, {tolerance}: {p:?} is told {answer:?}, {:e} away",
                trial.fill,
                away()
            );
        }
        let known = answers.iter().filter(|answer| **answer != Membership::Undecided).count();
        found.push((tree.statistics().nodes(), known));
    }
    found
}

#[test]
fn stored_meshes_that_are_turned() {
    let mut random = Random(0x1A7E6);
    for (name, soup) in soups(&mut random).into_iter().step_by(repeated(3, 1)) {
        let fill = [FillRule::NonZero, FillRule::EvenOdd, FillRule::Positive][random.below(3) as usize];
        let trial = Trial::new(shapes::mesh(&soup), fill, 1e-2, 6);
        for (nodes, known) in turned_stored(name, &trial, 2, 1_000) {
            assert!(known > 100, "{name}: {known} of 1000, {nodes} nodes");
        }
    }
}

#[test]
fn turned_prisms_take_few_cells() {
    for count in [8u32, 24] {
        let polygon: Vec<[f64; 2]> = (0..count)
            .map(|k| (f64::from(k) + 0.5) * std::f64::consts::TAU / f64::from(count))
            .map(|angle| [0.5 * angle.cos(), 0.5 * angle.sin()])
            .collect();
        let part = turned(&shapes::prism(&polygon, [0.0; 2], -0.25, 0.25));
        let trial = Trial::new(shapes::mesh(&part), FillRule::NonZero, 1e-5, 20);
        let own = trial.tree.statistics().nodes();
        let found = turned_stored("prism", &trial, 1, 2_000);
        println!("{count} sides: {own} nodes, turned {found:?}");
        assert!(
            found.iter().all(|&(nodes, known)| nodes <= 4 * own && known > 1_000),
            "{own} nodes, {found:?}"
        );
    }
}

/// Rotates a part. The result has at most `most` times the part's nodes.
fn turn_machined_part(name: &str, most: u64) {
    let Some((mesh, size)) = opened(name) else { return };
    let trial = Trial::new(mesh, FillRule::NonZero, 1e-6 * size, 20);
    let own = trial.tree.statistics().nodes();
    let found = turned_stored(name, &trial, 1, 5_000);
    println!("{name}: {own} nodes, turned {found:?}");
    let is_good = |&(nodes, known): &(u64, usize)| nodes <= most * own && known > 3_000;
    assert!(found.iter().all(is_good), "{name}: {own} nodes, {found:?}");
}

#[test]
fn machined_parts_that_are_turned_take_few_cells() {
    turn_machined_part("featuretype.STL", 2);
}

#[test]
#[ignore = "minutes"]
fn more_machined_parts_that_are_turned() {
    turn_machined_part("plate_holes.STL", 6);
    turn_machined_part("angle_block.STL", 8);
}
