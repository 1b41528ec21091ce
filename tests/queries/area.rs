//! The area of a solid's boundary, against formulas and against the areas of smaller cells.

use leafless::query::{StopReason, SurfaceArea, surface_area};
use leafless::solid::{Ask, AskWhole, HalfSpace};
use leafless::{
    Affine, AnySolid, Cell, Classifier, Control, Csg, Error, FillRule, Frame, Interval, MeshSolid, Rule,
    Solid, SurfaceOptions, Tolerance, TriangleMesh, Verdict, Worker, build, build_extended,
};
use leafless_testkit::csg::Maker;
use leafless_testkit::cubes::Plain;
use leafless_testkit::{Random, Way, alone, repeated};
use std::f64::consts::PI;

fn frame() -> Frame {
    Frame::new([-4.0; 3], 8.0, 20).unwrap()
}

/// Checks a result against a truth that is a rounded double.
#[track_caller]
fn holds(found: &SurfaceArea, truth: f64, name: &str) {
    let slack = 1e-12 * truth;
    let area = found.area;
    assert!(area.lower <= truth + slack && truth - slack <= area.upper, "{name}: {truth} {found:?}");
}

/// Returns the lateral area of a cone or a frustum.
fn side(a: f64, b: f64, height: f64) -> f64 {
    PI * (a + b) * ((a - b) * (a - b) + height * height).sqrt()
}

/// Returns the area of an ellipsoid with two equal radii a and a smaller radius c along the axis.
fn oblate(a: f64, c: f64) -> f64 {
    let e = (1.0 - c * c / (a * a)).sqrt();
    2.0 * PI * a * a * (1.0 + (1.0 - e * e) / e * e.atanh())
}

fn primitives() -> Vec<(&'static str, Csg, f64)> {
    let of = |solid: Result<Csg, Error>| solid.unwrap();
    let octahedron = {
        let signs = [1.0, -1.0];
        let normals = signs.iter().flat_map(|&x| signs.iter().flat_map(move |&y| signs.map(|z| [x, y, z])));
        let planes: Vec<_> = normals.map(|normal| (normal, 1.5)).collect();
        of(Csg::convex(&planes))
    };
    let (r, s, h) = (0.8, 0.3, 1.7);
    let ell = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    // The slope of a wedge narrows from a width of 1.5 to a width of 0.4.
    let slope = f64::hypot(1.5 - 0.4, 1.2);
    vec![
        ("ball", of(Csg::ball([0.1, 0.2, 0.3], 1.5)), 4.0 * PI * 2.25),
        ("ellipsoid", of(Csg::ellipsoid([0.1, 0.2, 0.3], [1.5, 1.5, 0.5])), oblate(1.5, 0.5)),
        ("cuboid", of(Csg::cuboid([-1.0; 3], [1.0, 2.0, 0.5])), 2.0 * (6.0 + 3.0 + 4.5)),
        ("cylinder", of(Csg::cylinder(r, 0.0, h)), 2.0 * PI * r * r + side(r, r, h)),
        ("frustum", of(Csg::frustum(r, s, 0.0, h)), PI * (r * r + s * s) + side(r, s, h)),
        ("cone", of(Csg::frustum(0.0, r, 0.0, h)), PI * r * r + side(r, 0.0, h)),
        ("torus", of(Csg::torus(1.5, 0.5)), 4.0 * PI * PI * 1.5 * 0.5),
        ("wedge", of(Csg::wedge([1.5, 1.2, 0.7], 0.4)), (1.5 + 0.4) * 1.2 + 0.7 * (1.5 + 0.4 + 1.2 + slope)),
        ("prism", of(Csg::prism(&ell, 0.0, 0.5)), 2.0 * 3.0 + 8.0 * 0.5),
        // Edges of 1.5 √2.
        ("octahedron", octahedron, 2.0 * 3f64.sqrt() * 4.5),
    ]
}

/// A random placement with its scale: a rotation by a random angle about a random axis, a scale and an
/// offset.
fn placement(random: &mut Random) -> (Affine, f64) {
    let [a, b, c] = [0; 3].map(|_| random.between(-1.0, 1.0));
    let turn = glam::DMat3::from_quat(glam::DQuat::from_scaled_axis(glam::DVec3::new(a, b, c) * 3.0));
    let scale = random.between(0.3, 1.2);
    let rows = [0, 1, 2].map(|i| {
        let row = turn.row(i) * scale;
        [row.x, row.y, row.z, random.between(-0.5, 0.5)]
    });
    (Affine::new(rows).unwrap(), scale)
}

#[test]
fn primitives_have_the_areas_of_formulas() {
    let mut random = Random(1);
    for (name, solid, truth) in primitives() {
        let upright = surface_area(&solid, &frame(), 1e-3, &Control::default()).unwrap();
        assert_eq!((upright.stop_reason, upright.clipped), (StopReason::Tolerance, false), "{name}");
        assert!(upright.area.width() <= 1e-3 * upright.area.upper, "{name} {upright:?}");
        holds(&upright, truth, name);
        let (placement, scale) = placement(&mut random);
        let placed = solid.placed(&placement).unwrap();
        for tolerance in [0.1, 0.01, 1e-3] {
            let found = surface_area(&placed, &frame(), tolerance, &Control::default()).unwrap();
            assert_eq!(found.stop_reason, StopReason::Tolerance, "{name}");
            // Turns are rounded.
            holds(&found, truth * scale * scale, name);
        }
        let complement = surface_area(&placed.complement(), &frame(), 0.01, &Control::default()).unwrap();
        let itself = surface_area(&placed, &frame(), 0.01, &Control::default()).unwrap();
        assert_eq!(complement, itself, "{name}");
    }
}

#[test]
fn each_budget_holds_the_truth() {
    let mut random = Random(2);
    for (name, solid, truth) in primitives() {
        let (placement, scale) = placement(&mut random);
        let placed = solid.placed(&placement).unwrap();
        let mut last = f64::INFINITY;
        for budget in [0, 1, 5, 50, 500, 5_000, 50_000] {
            let control = Control { max_splits: Some(budget), ..Control::default() };
            let found = surface_area(&placed, &frame(), 0.0, &control).unwrap();
            assert!(found.splits <= budget, "{name} {found:?}");
            // (A cell known only by its size may have tighter bounds than its eight children, and roundings
            // add up.)
            assert!(budget < 50 || found.area.width() <= last + 1e-9, "{name} {budget} {found:?}");
            assert_ne!(found.stop_reason, StopReason::Tolerance);
            holds(&found, truth * scale * scale, name);
            last = found.area.width();
        }
        assert!(last < 0.02 * truth, "{name} {last}");
    }
}

#[test]
fn widths_fall_with_the_number_of_splits() {
    // Curved surfaces and their intersections converge with 1 / N for N splits. Plane surfaces are known at
    // once.
    for (name, solid, truth) in primitives() {
        let width = |budget: u64| {
            let control = Control { max_splits: Some(budget), ..Control::default() };
            let found = surface_area(&solid, &frame(), 0.0, &control).unwrap();
            (found.area.width() / truth, found.splits as f64)
        };
        let ((coarse, few), (fine, many)) = (width(10_000), width(repeated(100_000, 400_000)));
        if ["cuboid", "wedge", "prism", "octahedron"].contains(&name) {
            assert!(fine < 1e-9, "{name} {fine}");
            continue;
        }
        let slope = (fine / coarse).ln() / (many / few).ln();
        assert!(slope < -0.9, "{name} {slope} {coarse} {fine}");
    }
}

#[test]
fn what_parts_have_in_common_does_not_count() {
    let ball = |x: f64| Csg::ball([x, 0.1, 0.2], 1.0).unwrap();
    // Two balls at a distance of 1.2: caps of height 0.4 are within the other one.
    let (whole, cap) = (4.0 * PI, 2.0 * PI * 0.4);
    let (a, b) = (ball(-0.6), ball(0.6));
    for (name, solid, truth) in [
        ("union", Csg::union_of([a.clone(), b.clone()]).unwrap(), 2.0 * (whole - cap)),
        ("intersection", Csg::intersection_of([a.clone(), b.clone()]).unwrap(), 2.0 * cap),
        ("difference", a.difference(&b).unwrap(), whole),
        ("xor", Csg::xor_of([a.clone(), b.clone()]).unwrap(), 2.0 * whole),
    ] {
        let found = surface_area(&solid, &frame(), 1e-2, &Control::default()).unwrap();
        assert_eq!(found.stop_reason, StopReason::Tolerance);
        holds(&found, truth, name);
    }
    // A plate with holes. All of its faces lie in planes of the lattice.
    let mut plate = Csg::cuboid([-2.0, -2.0, -0.5], [2.0, 2.0, 0.5]).unwrap();
    for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (0.0, 1.0)] {
        let hole = Csg::cylinder(0.5, -1.0, 1.0).unwrap();
        let away = Affine::new([[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, 0.0]]).unwrap();
        plate = plate.difference(&hole.placed(&away).unwrap()).unwrap();
    }
    let truth = 2.0 * 16.0 + 4.0 * 4.0 + 3.0 * (2.0 * PI * 0.5 - 2.0 * PI * 0.25);
    let found = surface_area(&plate, &frame(), 1e-3, &Control::default()).unwrap();
    holds(&found, truth, "plate");
    assert_eq!(found.stop_reason, StopReason::Tolerance);
    // A pocket as deep as the block is high. The block is gone.
    let block = Csg::cuboid([-1.0; 3], [1.0; 3]).unwrap();
    let rest = block.difference(&Csg::cuboid([-1.0, -1.0, -1.0], [0.0, 1.0, 1.0]).unwrap()).unwrap();
    holds(
        &surface_area(&rest, &frame(), 1e-2, &Control { max_splits: Some(10_000), ..Control::default() })
            .unwrap(),
        16.0,
        "half",
    );
}

#[test]
fn what_is_not_known_is_not_told() {
    let whole = Interval::new(0.0, f64::INFINITY).unwrap();
    let control = Control::default();
    // A stored octree. It does not store the shape of its surface.
    let small = Frame::new([-4.0; 3], 8.0, 5).unwrap();
    let tree = build(&Csg::ball([0.0; 3], 1.5).unwrap(), &small, Rule::Certified, &control).unwrap();
    let found = surface_area(&tree, &small, 0.01, &control).unwrap();
    assert_eq!((found.area, found.stop_reason, found.splits), (whole, StopReason::Exhausted, 0));
    // All cells of a tree may be decided. Then its surface is that of the cells.
    let ell = Csg::prism(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]], 0.0, 0.5);
    let tree = build(&ell.unwrap(), &small, Rule::Certified, &control).unwrap();
    assert!(tree.view().is_binary());
    let found = surface_area(&tree, &small, 0.0, &control).unwrap();
    holds(&found, 2.0 * 3.0 + 8.0 * 0.5, "cells");
    assert!(found.area.width() < 1e-12 && found.stop_reason != StopReason::Budget, "{found:?}");
    // A sampled tree proves nothing.
    let tree = build(&Csg::ball([0.0; 3], 1.5).unwrap(), &small, Rule::Sampled, &control).unwrap();
    assert_eq!(surface_area(&tree, &small, 0.01, &control).unwrap().area, whole);
    // A face of a clipped block in a plane of the lattice, and beside one.
    let block = |x: f64| Csg::cuboid([-9.0, -9.0, -9.0], [x, 9.0, 9.0]).unwrap();
    for x in [1.0, 1.0 / 3.0] {
        let found = surface_area(&block(x), &frame(), 0.01, &control).unwrap();
        assert!(found.clipped && found.area.width() < 1e-9, "{found:?}");
        holds(&found, 64.0, "clipped");
    }
    // The empty set, and a ball outside.
    let a = Csg::ball([0.1; 3], 1.0).unwrap();
    let far = surface_area(&Csg::ball([50.0; 3], 1.0).unwrap(), &frame(), 0.01, &control).unwrap();
    assert_eq!((far.area, far.clipped), (Interval::exactly(0.0), true));
    let none = a.difference(&a).unwrap();
    let found = surface_area(&none, &frame(), 0.01, &control).unwrap();
    assert_eq!(found.area.lower, 0.0);
    assert!(
        surface_area(&a, &frame(), -1.0, &control).is_err()
            && surface_area(&a, &frame(), f64::NAN, &control).is_err()
    );
    let loose = surface_area(&a, &frame(), Tolerance { relative: 0.0, absolute: 1.0 }, &control).unwrap();
    assert!(loose.stop_reason == StopReason::Tolerance && loose.area.width() <= 1.0);
}

/// A plate of 80 × 60 × 10 with twenty bores.
fn plate() -> Csg {
    let bores = (0..20).map(|k| {
        let to = [8.0 + 16.0 * f64::from(k % 5), 7.5 + 15.0 * f64::from(k / 5), 0.0];
        Csg::cylinder(2.5, -1.0, 11.0).unwrap().placed(&Affine::translation(to).unwrap()).unwrap()
    });
    Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0]).unwrap().difference(&Csg::union_of(bores).unwrap()).unwrap()
}

fn extended(solid: &Csg, frame: &Frame) -> leafless::Octree {
    build_extended(solid, frame, &SurfaceOptions::default(), &alone()).unwrap()
}

/// Most faces of the plate lie in planes of the lattice, and so the tree stores no surface for them.
#[test]
fn an_extended_tree_has_the_area_of_its_source() {
    let turn = Affine::new([[0.36, 0.48, -0.8, 0.0], [-0.8, 0.6, 0.0, 0.0], [0.48, 0.64, 0.6, 0.0]]).unwrap();
    let truth = 2.0 * (4800.0 + 800.0 + 600.0) + 20.0 * (2.0 * PI * 2.5 * 10.0 - 2.0 * PI * 6.25);
    for (name, csg) in [("aligned", plate()), ("turned", plate().placed(&turn).unwrap())] {
        let bounds = csg.bounds().unwrap();
        let frame = Frame::around(bounds.min, bounds.max, 20).unwrap();
        let tree = extended(&csg, &frame);
        let finest = repeated(4e-3, 1e-3);
        for tolerance in [1e-2, finest] {
            let [own, source] = [
                surface_area(&tree, &frame, tolerance, &Control::default()).unwrap(),
                surface_area(&csg, &frame, tolerance, &Control::default()).unwrap(),
            ];
            holds(&own, truth, name);
            holds(&source, truth, name);
            assert_eq!(own.stop_reason, StopReason::Tolerance, "{name} {own:?}");
            assert!(own.splits <= source.splits + source.splits / 10 + 100, "{name} {own:?} {source:?}");
        }
        let other =
            surface_area(&extended(&csg.complement(), &frame), &frame, finest, &Control::default()).unwrap();
        holds(&other, truth, name);
        let [one, three] = [alone(), Control::threads(3)]
            .map(|control| surface_area(&tree, &frame, finest, &control).unwrap());
        assert_eq!(one, three, "{name}");
    }
}

/// Faces in planes of the lattice at every depth of the tree, between decided cells and beside cut cells.
#[test]
fn faces_in_planes_of_the_lattice_are_counted_once() {
    let frame = Frame::new([-4.0; 3], 8.0, 12).unwrap();
    let mut checked = 0;
    for seed in 0..repeated(40, 400) {
        let mut random = Random(seed ^ 0xFACE5);
        let aligned = seed % 4 != 0;
        let mut maker =
            Maker { random: &mut random, frame: frame.with_depth(4).unwrap(), aligned, others: false };
        let count = 1 + maker.below(4);
        let model = maker.joined(count);
        let Ok(csg) = model.csg(&frame) else { continue };
        // A solid that ends inside the universe has its area on another lattice, too.
        let block = Csg::cuboid([-3.0, -2.5, -3.0], [3.0, 2.0, 2.75]).unwrap();
        let csg = Csg::intersection_of([csg, block]).unwrap();
        let control = Control { max_splits: Some(20_000), ..alone() };
        let Ok(source) = surface_area(&csg, &frame, 1e-3, &control) else { continue };
        for depth in [1, 3, 12] {
            let Ok(tree) =
                build_extended(&csg, &frame.with_depth(depth).unwrap(), &SurfaceOptions::default(), &alone())
            else {
                continue;
            };
            let own = surface_area(&tree, &frame, 1e-3, &control).unwrap();
            let (a, b) = (own.area, source.area);
            let slack = 1e-9;
            assert!(
                a.lower <= b.upper + slack && b.lower <= a.upper + slack,
                "{seed} {depth}: {own:?} {source:?}\n{model:#?}"
            );
            let is_known = tree.view().cuts().is_none_or(|cuts| cuts.given_up == 0);
            checked += u32::from(is_known && source.area.upper < f64::INFINITY);
            assert!(
                !is_known || source.area.upper == f64::INFINITY || a.upper < f64::INFINITY,
                "{seed} {own:?} {source:?}"
            );
        }
    }
    println!("{checked} areas");
    assert!(checked > repeated(75, 300));
}

/// A surface that vanishes on faces of the cells it crosses, with different signs on both sides of a face.
#[test]
fn a_surface_that_holds_faces_is_counted() {
    let frame = Frame::new([-4.0; 3], 8.0, 12).unwrap();
    // x y > 0 in a block: two quarters with faces in planes of the lattice.
    let pair = Csg::from(HalfSpace::quadric([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).unwrap());
    for (low, high, truth) in [
        // Two cuboids of 2 × 2 × 2 that have an edge in common.
        ([-2.0, -2.0, -1.0], [2.0, 2.0, 1.0], 2.0 * 24.0),
        // One quarter is gone: 1 × 2 × 2, and 2 × 0.5 × 2 beyond.
        ([-1.0, -0.5, -1.0], [1.0, 2.0, 1.0], 2.0 * (2.0 + 4.0 + 2.0) + 2.0 * (0.5 + 1.0 + 2.0)),
    ] {
        let part = Csg::intersection_of([Csg::cuboid(low, high).unwrap(), pair.clone()]).unwrap();
        let tree = extended(&part, &frame);
        let control = Control { max_splits: Some(20_000), ..Control::default() };
        let found = surface_area(&tree, &frame, 1e-2, &control).unwrap();
        holds(&found, truth, "quarters");
        // (Whether x y is zero inside a cell beside such a plane is unknown.)
        assert!(0.5 * truth < found.area.lower && found.area.upper < 2.0 * truth, "{found:?}");
    }
}

/// Two rotated, intersecting cubes of edge 1: a mesh whose area is not known without splits.
fn intersecting_cubes() -> MeshSolid {
    let turn = glam::DMat3::from_quat(glam::DQuat::from_scaled_axis(glam::DVec3::new(0.3, 0.7, -0.4)));
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let corner = |k: u32, shift: f64| {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(k >> axis & 1) + shift);
        (turn * glam::DVec3::new(x, y, z)).to_array()
    };
    let vertices = [0.0, 0.37].iter().flat_map(|&shift| (0..8).map(move |k| corner(k, shift))).collect();
    let triangles = [0, 8].iter().flat_map(|&first| {
        quads.iter().flat_map(move |&[a, b, c, d]| [[a, b, c], [a, c, d]].map(|t| t.map(|k| k + first)))
    });
    let mesh = TriangleMesh::new(vertices, triangles.collect()).unwrap();
    MeshSolid::new(mesh, FillRule::NonZero).unwrap()
}

#[test]
fn an_area_without_an_upper_bound_meets_no_tolerance() {
    // The solid decides cells, and provides no area.
    let solid = Plain::ball([0.1, 0.2, 0.3], 1.5).unwrap();
    let mut unbounded = 0;
    for splits in (0..64).chain([100_000]) {
        let budget = Control { max_splits: Some(splits), ..Control::default() };
        for tolerance in [0.0, 1e-3, 0.1, 1.0, 10.0] {
            let found = surface_area(&solid, &frame(), tolerance, &budget).unwrap();
            let is_met = found.area.width() <= tolerance * (0.5 * (found.area.lower + found.area.upper));
            let is_bounded = found.area.upper < f64::INFINITY;
            assert!(found.stop_reason != StopReason::Tolerance || is_bounded && is_met, "{found:?}");
            unbounded += u32::from(!is_bounded);
        }
    }
    assert!(unbounded > 0);
}

#[test]
fn a_mesh_that_intersects_itself_has_the_area_of_what_it_encloses() {
    let found = surface_area(&intersecting_cubes(), &frame(), 1e-2, &Control::default()).unwrap();
    // Minus two pieces of the faces inside the other cube, each 0.63².
    holds(&found, 12.0 - 6.0 * 0.63 * 0.63, "intersecting cubes");
}

#[test]
fn the_same_for_any_number_of_threads() {
    let (_, solid, _) = primitives().swap_remove(6);
    let tolerance = repeated(4e-3, 1e-3);
    let many = surface_area(&solid, &frame(), tolerance, &Control::default()).unwrap();
    assert_eq!(surface_area(&solid, &frame(), tolerance, &alone()).unwrap(), many);
}

/// Bounds the area in a cell by the areas of cells some levels finer, in squares of the cell's half edge. (If
/// a solid ends in the wall between two cells, the area there is in neither.)
fn by_finer<W: Worker>(worker: &mut W, cell: Cell, part: &W::Part, levels: u8) -> Interval {
    if levels == 0 {
        return worker.area(cell, part).unwrap().unwrap_or(Interval::new(0.0, f64::INFINITY).unwrap());
    }
    let mut sum = Interval::exactly(0.0);
    let mark = worker.mark();
    for (octant, verdict) in (0..8).zip(worker.split(cell, part).unwrap()) {
        let child = match verdict {
            Verdict::Partial(part) => by_finer(worker, cell.child(octant), &part, levels - 1),
            Verdict::Undecided => Interval::new(0.0, f64::INFINITY).unwrap(),
            Verdict::Empty | Verdict::Full => continue,
        };
        sum = Interval::new(sum.lower + child.lower / 4.0, sum.upper + child.upper / 4.0).unwrap();
    }
    worker.release(mark);
    sum
}

/// Compares the areas of the cells of `solid` on the way down to a random cell with the areas of finer cells.
fn cells_of<S: Solid>(solid: &S, frame: &Frame, seed: u64, random: &mut Random, found: &mut [u64; 2]) {
    let classifier = solid.on(frame, &alone()).unwrap();
    let Some(mut way) = Way::new(classifier.worker().unwrap()) else { return };
    while way.cell.level <= 14 {
        let cell = way.cell;
        if let Some(area) = way.worker.area(cell, &way.part).unwrap() {
            let finer = by_finer(&mut way.worker, cell, &way.part, 2);
            let slack = 1e-10;
            assert!(
                area.lower <= finer.upper + slack && finer.lower <= area.upper + slack,
                "{seed} {cell:?} {area:?} {finer:?}"
            );
            found[0] += 1;
            found[1] += (area.width() < 0.5) as u64;
        }
        if !way.descend(random) {
            break;
        }
    }
}

fn cells_agree(count: u64) {
    let frame = Frame::new([-1.013, -1.027, -1.041], 2.1, 20).unwrap();
    // Expressions, functions of three half-spaces, and extended trees of both.
    let mut found = [[0; 2]; 4];
    for seed in 0.. {
        if found.iter().all(|&[checked, _]| checked >= count / 3) {
            break;
        }
        let mut random = Random(seed ^ 0xA12EA);
        let mut maker = Maker { random: &mut random, frame, aligned: false, others: false };
        let is_function = seed % 2 == 1;
        let model = if is_function {
            maker.function(|maker| maker.half_space())
        } else {
            let count = 1 + maker.below(4);
            maker.joined(count)
        };
        let Ok(solid) = model.csg(&frame) else { continue };
        if !solid.on(&frame, &alone()).unwrap().is_off_lattice() {
            continue;
        }
        let kind = 2 * usize::from(is_function);
        cells_of(&solid, &frame, seed, &mut random, &mut found[kind]);
        let shallow = frame.with_depth(4).unwrap();
        let Ok(tree) = build_extended(&solid, &shallow, &SurfaceOptions::default(), &alone()) else {
            continue;
        };
        cells_of(&tree, &frame, seed, &mut random, &mut found[kind + 1]);
    }
    println!("checked, tight: {found:?}");
    for [checked, tight] in found {
        assert!(tight * 4 > checked, "{tight} of {checked}");
    }
}

#[test]
fn cells_have_the_area_of_finer_cells() {
    cells_agree(20_000);
}

#[test]
#[ignore = "a minute"]
fn a_million_cells_have_the_area_of_finer_cells() {
    cells_agree(1_000_000);
}

/// The cube from 0 to `edge`.
fn cube(edge: f64) -> TriangleMesh {
    let corner = |k: usize| [k & 1, k >> 1 & 1, k >> 2].map(|upper| upper as f64 * edge);
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh::new((0..8).map(corner).collect(), triangles).unwrap()
}

#[test]
fn what_fills_the_universe_has_the_area_of_its_walls() {
    let control = Control { max_splits: Some(3000), ..Control::default() };
    let frame = Frame::new([0.0; 3], 4.0, 20).unwrap();
    let block = Csg::cuboid([0.0; 3], [4.0; 3]).unwrap();
    let around = Csg::cuboid([-1.0; 3], [9.0; 3]).unwrap();
    let mesh = AnySolid::new(MeshSolid::new(cube(4.0), FillRule::NonZero).unwrap());
    let of_mesh = Csg::solid(mesh.clone());
    let solids = [
        ("half-spaces", AnySolid::new(block.clone())),
        ("a mesh", mesh),
        ("a mesh in a block", AnySolid::new(Csg::intersection_of([of_mesh.clone(), around]).unwrap())),
        ("a mesh and nothing", AnySolid::new(Csg::union_of([of_mesh, Csg::empty()]).unwrap())),
        ("an octree", AnySolid::new(build(&block, &frame, Rule::Certified, &control).unwrap())),
    ];
    for (name, solid) in solids {
        let found = surface_area(&solid, &frame, 1e-6, &control).unwrap();
        assert!(found.area.contains(96.0), "{name}: {found:?}");
        assert!(found.area.width() < 1e-3, "{name}: {found:?}");
    }
}
