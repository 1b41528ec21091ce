//! Meshes in any condition, against the winding number by its definition.
//!
//! The truth of a soup is the set of points with |w| ≥ ½ (or w ≥ ½), where w is the sum of the solid angles
//! of all its triangles over 4π. The tests build damaged variants of many shapes, and compare every kind of
//! verdict with that sum.
//!
//! The heavier tests have many more variants, deeper trees, more points, and five million triangles:
//!
//! ```text
//! LEAFLESS_MODELS=/path/to/models \
//!     cargo test --release --test meshes open:: -- --ignored --nocapture --test-threads 1
//! ```

use crate::descended::Descended;
use crate::oracle::PointOracle;
use crate::shapes::*;
use crate::soup;
use crate::soup::check::{Case, Effort, Findings, around_centre, examine, is_inside, trees};
use crate::soup::damage::{self, Damage, damaged};
use crate::soup::forms::*;
use crate::soup::reference::{Lie, Reference};
use crate::soup::winding::{Boundary, Soupy};
use leafless::exchange::{MeshOptions, open_mesh};
use leafless::file::write_to;
use leafless::{
    Control, FillRule, Frame, Membership, MeshSolid, Octree, Rule, Solid, Tag, TriangleMesh, build,
};
use leafless_testkit::{Random, alone, repeated};

const RULES: [FillRule; 2] = [FillRule::NonZero, FillRule::Positive];

/// A frame around a soup, with some room. Its planes are not at short doubles.
fn odd_frame(soup: &Soup, depth: u8) -> Frame {
    let truth = Soupy::new(soup);
    let extent = damage::extent(soup) * 1.3;
    let origin = [0, 1, 2].map(|axis| (truth.low[axis] + truth.high[axis] - extent) / 2.0 - 0.013 * extent);
    Frame::new(origin, extent, depth).unwrap()
}

/// Shapes in the cube [0, 32]³. The flag says whether a shape lies on the planes and centres of the lattice
/// of depth 5.
fn shapes_of_all_kinds(detail: usize) -> Vec<(&'static str, Soup, bool)> {
    let mut random = Random(17);
    let far = [16.0; 3];
    vec![
        ("sphere", sphere([16.1, 15.9, 16.2], 11.3, 2 + detail), false),
        ("torus", torus([16.0, 16.3, 15.8], 9.0, 4.0, 14 << detail, 8 << detail), false),
        (
            "turned ell",
            moved(&turned(&refined(&ell([-8.0; 3], 8.0, 16.0), 1 + detail)), |p| p.map(|x| x + 16.0)),
            false,
        ),
        ("cube", refined(&block([4.0; 3], [28.0; 3]), 2 + detail), true),
        ("cube through centres", refined(&block([4.5; 3], [28.5, 20.5, 12.5]), 1 + detail), true),
        ("ell", refined(&ell([4.0, 4.0, 6.0], 12.0, 16.0), 1 + detail), true),
        ("ell through centres", refined(&ell([3.5, 4.5, 6.5], 8.0, 8.0), 1 + detail), true),
        ("tube", refined(&tube([4.0, 4.0, 8.0], [28.0, 28.0, 24.0], 8.0), 1 + detail), true),
        ("tube through centres", refined(&tube([4.5, 4.5, 8.5], [20.5, 20.5, 24.5], 4.0), 1 + detail), true),
        ("octahedron", refined(&octahedron(far, 12.0), 2 + detail), true),
        ("octahedron at a centre", refined(&octahedron([15.5; 3], 8.0), 1 + detail), true),
        (
            "nested",
            [
                sphere(far, 13.0, 1 + detail),
                inside_out(sphere([15.0; 3], 8.0, 1 + detail)),
                sphere([15.5; 3], 4.0, 1),
            ]
            .concat(),
            false,
        ),
        (
            "overlapping",
            [sphere([12.0; 3], 8.0, 1 + detail), torus([18.0; 3], 7.0, 3.0, 8 << detail, 4 << detail)]
                .concat(),
            false,
        ),
        ("bowl", bowl([16.3, 16.1, 20.2], 12.0, 2 + detail), false),
        ("pipe", pipe([16.2, 15.9, 16.1], 8.0, 22.0, detail), false),
        ("spiral", spiral([16.0; 3], 13.0, 3.0, 14.0, detail), false),
        ("sheet", sheet(far, 24.0, 1.5, detail), false),
        ("flat sheet", sheet([16.0, 16.0, 16.5], 24.0, 0.0, detail), true),
        ("Moebius", moebius(far, 9.0, 7.0, detail), false),
        ("Klein", klein(far, 9.0, detail), false),
        ("rubble", rubble(&mut random, 25 << detail, 2.0, 30.0), false),
        ("rubble on the lattice", lattice_rubble(&mut random, 20 << detail, 32), true),
        ("triangle", vec![[[5.1, 6.2, 7.3], [27.4, 8.1, 12.6], [11.3, 26.2, 19.4]]], false),
        ("triangle on the lattice", vec![[[4.0, 4.0, 16.5], [28.0, 4.0, 16.5], [4.0, 28.0, 16.5]]], true),
        (
            "two triangles",
            vec![
                [[4.5, 4.5, 8.5], [28.5, 4.5, 8.5], [4.5, 28.5, 8.5]],
                [[4.5, 4.5, 10.5], [28.5, 4.5, 10.5], [4.5, 28.5, 10.5]],
            ],
            true,
        ),
    ]
}

fn solid(soup: &Soup, fill: FillRule) -> MeshSolid {
    MeshSolid::new(mesh(soup), fill).unwrap()
}

/// Checks everything about one soup on one frame.
fn verify(name: &str, soup: &Soup, frame: &Frame, fill: FillRule, aligned: bool, effort: Effort) -> Findings {
    let solid = solid(soup, fill);
    let all = trees(&solid, frame);
    let case = Case { name: name.into(), soup, frame: *frame, fill, aligned };
    let mut findings = examine(&case, &all, effort, frame.depth() as u64);
    if frame.depth() >= 6 && trees(&Descended(&solid), frame) != all {
        findings.faults.push(format!("{name}: by scan and by descent differ"));
    }
    findings
}

const LIGHT: Effort = Effort { points: 800, centres: 500, corners: 120, shares: 160 };

#[test]
fn the_oracle_agrees_with_integers_and_with_itself() {
    let mut random = Random(1);
    let closed = [
        torus([0.1, 0.2, 0.3], 2.0, 0.7, 40, 24),
        sphere([0.3; 3], 1.7, 3),
        [sphere([0.0; 3], 2.0, 3), inside_out(sphere([0.1; 3], 1.0, 2)), sphere([1.0; 3], 1.5, 2)].concat(),
        turned(&tube([-2.0; 3], [2.0; 3], 1.0)),
    ];
    for soup in &closed {
        let exact = PointOracle::new(&mesh(soup));
        let mut whole = Soupy::new(soup);
        // Open pieces of it. Their winding numbers add up to that of the whole.
        let (one, other): (Vec<_>, Vec<_>) = soup.iter().partition(|facet| facet[0][0] + facet[1][1] > 0.3);
        let (mut one, mut other) = (Soupy::new(&one), Soupy::new(&other));
        for i in 0..4000 {
            let p = if i % 2 == 0 {
                [0; 3].map(|_: i32| random.between(-3.0, 3.0))
            } else {
                // Very near the surface, where only exact signs distinguish the sides.
                let [a, b, c] = whole.corners(random.below(whole.len() as u64) as usize);
                let far = 10f64.powi(-(random.below(16) as i32));
                [0, 1, 2]
                    .map(|axis| (a[axis] + b[axis] + 2.0 * c[axis]) / 4.0 + far * random.between(-1.0, 1.0))
            };
            let winding = whole.at(p);
            let parts = [one.at(p), other.at(p)];
            let error = winding.error + parts[0].error + parts[1].error;
            assert!(error < 1e-6, "{p:?} {winding:?}");
            assert!((parts[0].value + parts[1].value - winding.value).abs() <= error);
            if let Some(exact) = exact.winding(p) {
                assert!((winding.value - exact as f64).abs() <= winding.error, "{p:?} {winding:?} {exact}");
            }
        }
    }
    // A rectangle with the point above its corner: atan(ab / (h·√(a² + b² + h²))).
    for (a, b, h) in [(1.0f64, 2.0f64, 0.5f64), (3.0, 0.1, 1e-6), (1e-3, 1e-3, 4.0), (7.0, 5.0, -3.0)] {
        let mut plate =
            Soupy::new(&vec![[[0.0; 3], [a, 0.0, 0.0], [a, b, 0.0]], [[0.0; 3], [a, b, 0.0], [0.0, b, 0.0]]]);
        let expected = -(a * b / (h * (a * a + b * b + h * h).sqrt())).atan() / (4.0 * std::f64::consts::PI);
        let winding = plate.at([0.0, 0.0, h]);
        assert!((winding.value - expected).abs() <= winding.error, "{winding:?} {expected}");
        assert!(winding.error < 1e-8);
    }
    // On the surface, the shifted point decides: up is outside at the top and inside at the bottom.
    let mut cube = Soupy::new(&block([0.0; 3], [2.0; 3]));
    for (p, inside) in [
        ([1.0, 0.5, 0.0], 1.0),
        ([1.0, 0.5, 2.0], 0.0),
        ([0.0, 0.5, 1.0], 1.0),
        ([2.0, 0.5, 1.0], 0.0),
        ([0.5, 2.0, 1.0], 0.0),
    ] {
        let winding = cube.at(p);
        assert!(winding.on_surface && (winding.value - inside).abs() <= winding.error, "{p:?} {winding:?}");
    }
    assert_eq!(cube.at([0.0, 0.0, 1.0]).error, f64::INFINITY);
}

#[test]
fn gradients_are_bounded() {
    let mut random = Random(5);
    for (name, soup, _) in shapes_of_all_kinds(0) {
        let soup = damaged(&soup, Damage::RemoveFew, &mut random, 1.0, false);
        let boundary = Boundary::of(&soup);
        let mut truth = Soupy::new(&soup);
        let mut used = 0;
        for _ in 0..60 {
            let p = [0; 3].map(|_: i32| random.between(0.0, 32.0));
            let radius = random.between(0.01, 1.0);
            if truth.is_near(p, radius) {
                continue;
            }
            let q = p.map(|x| x + radius * random.between(-0.57, 0.57));
            let (a, b) = (truth.at(p), truth.at(q));
            let bound = radius * boundary.gradient(p, radius) + a.error + b.error;
            assert!((a.value - b.value).abs() <= bound, "{name} {p:?} {q:?}: {a:?} {b:?} {bound}");
            used += (bound < 0.5) as i32;
        }
        assert!(used > 10, "{name}: {used} bounds that mean something");
    }
}

#[test]
fn the_checks_see_lies() {
    let mut random = Random(9);
    let frame = odd_frame(&sphere([16.0; 3], 10.0, 2), 4);
    let soups = [
        damaged(&sphere([16.0; 3], 10.0, 2), Damage::RemovePatch, &mut random, 1.0, false),
        damaged(&bowl([16.0, 16.0, 19.0], 10.0, 2), Damage::DuplicateAll, &mut random, 1.0, false),
        damaged(&torus([16.0; 3], 8.0, 4.0, 12, 8), Damage::Everything, &mut random, 1.0, false),
        spiral([16.0; 3], 11.0, 2.0, 10.0, 1),
        inside_out(bowl([16.0, 16.0, 19.0], 10.0, 2)),
    ];
    let effort = Effort { points: 2000, centres: 500, corners: 400, shares: 300 };
    let findings_of = |lie: Lie, i: usize, fill: FillRule| {
        let soup = &soups[i];
        let solid = Reference::new(soup, fill, lie);
        let case = Case { name: format!("{lie:?} {i}"), soup, frame, fill, aligned: false };
        examine(&case, &trees(&solid, &frame), effort, i as u64)
    };
    let each = || (0..soups.len()).flat_map(|i| RULES.map(|fill| (i, fill)));
    let findings = |lie: Lie| {
        let mut findings = Findings::default();
        each().for_each(|(i, fill)| findings.add(findings_of(lie, i, fill)));
        findings
    };
    findings(Lie::Nothing).judge();
    for lie in [
        Lie::NoGradient,
        Lie::SmallReach,
        Lie::Threshold,
        Lie::Closed,
        Lie::Unsigned,
        Lie::Unique,
        Lie::Corner,
        Lie::Unoriented,
        Lie::Ends,
    ] {
        let is_seen = each().any(|(i, fill)| !findings_of(lie, i, fill).faults.is_empty());
        assert!(is_seen, "{lie:?} was not seen");
    }
    // A solid that decides too little tells no lie, but the checks notice it.
    let coward = findings(Lie::Coward);
    assert!(coward.faults.is_empty() && coward.left_open * 100 > coward.decidable, "{coward:?}");
}

/// Applies every damage to every shape, and examines a part of the variants. Without `only`, this is every
/// other variant. `only` gives a rule and, behind it, whether one of two variants of this rule is examined,
/// or (with four instead of one) one of eight.
fn damage_all(
    seed: u64,
    detail: usize,
    deeper: u8,
    only: Option<(FillRule, usize)>,
    effort: Effort,
) -> (usize, Findings) {
    let mut random = Random(seed);
    let mut total = Findings::default();
    let (mut number, mut variants) = (0, 0);
    for (name, soup, aligned) in shapes_of_all_kinds(detail) {
        for damage in damage::ALL {
            let spoiled = damaged(&soup, damage, &mut random, 1.0, aligned);
            if mesh(&spoiled).triangles().is_empty() {
                continue;
            }
            number += 1;
            let fill = RULES[(number + seed as usize) % 2];
            if only.is_some_and(|(only, of)| only != fill || number % (4 * of) < 4 * of - 2) {
                continue;
            }
            let is_aligned = aligned && damage != Damage::JitterSlightly;
            // Soups that fall apart into many pieces cost more, in every cell.
            let depth = deeper
                + match Boundary::of(&spoiled).0.len() {
                    0..80 => 5,
                    80..640 => 4,
                    _ => 3,
                };
            let frame = match aligned {
                true => Frame::new([0.0; 3], 32.0, depth).unwrap(),
                false => odd_frame(&spoiled, depth),
            };
            let what = format!("{name} {damage:?}");
            total.add(verify(&what, &spoiled, &frame, fill, is_aligned, effort));
            variants += 1;
        }
    }
    println!(
        "{variants} variants: {} asked, {} skipped; {} decidable, {} of them open; {} clear, {} of them open",
        total.asked, total.skipped, total.decidable, total.left_open, total.clear, total.clear_open
    );
    (variants, total)
}

fn damaged_shapes(fill: FillRule) {
    let effort = Effort { points: 250, centres: 160, corners: 40, shares: 50 };
    let (variants, total) = damage_all(2, 0, 0, Some((fill, repeated(8, 1))), effort);
    assert!(variants > repeated(16, 130));
    // Most cells that no triangle meets are decided, though many of these soups consist of holes.
    assert!(total.clear_open * 5 < total.clear);
    total.judge();
}

#[test]
fn damaged_shapes_where_the_winding_number_is_not_zero() {
    damaged_shapes(FillRule::NonZero);
}

#[test]
fn damaged_shapes_where_the_winding_number_is_positive() {
    damaged_shapes(FillRule::Positive);
}

#[test]
#[ignore = "takes many minutes"]
fn more_damaged_shapes() {
    let effort = Effort { points: 4000, centres: 3000, corners: 600, shares: 1000 };
    for seed in [3, 4, 5] {
        damage_all(seed, 1, 1, None, effort).1.judge();
    }
}

/// Holes with long boundaries of many short edges. The closing membrane is near in one place and far in
/// another.
#[test]
fn large_holes() {
    let centre = [16.1, 15.9, 16.2];
    let around = |n: usize, r: f64, z: f64, turn: f64| -> Vec<[f64; 3]> {
        let at = |i: usize| (i as f64 + turn) / n as f64 * std::f64::consts::TAU;
        (0..n).map(|i| [centre[0] + r * at(i).cos(), centre[1] + r * at(i).sin(), centre[2] + z]).collect()
    };
    let cone = |n: usize, r: f64, z: f64| -> Soup {
        let ring = around(n, r, z, 0.3);
        (0..n).map(|i| [ring[(i + 1) % n], ring[i], [centre[0], centre[1], centre[2] - z]]).collect()
    };
    let mut total = Findings::default();
    for n in [5, 24, 100, 400] {
        for (r, z) in [(13.0, 6.0), (9.0, 13.0), (14.0, 0.5)] {
            for depth in [4, 5] {
                let soup = cone(n, r, z);
                let frame = Frame::new([0.013, -0.1, 0.0], 33.0, depth).unwrap();
                let effort = Effort { points: 1500, centres: 1000, corners: 1500, shares: 200 };
                let what = format!("cone {n} {r} {z}");
                total.add(verify(&what, &soup, &frame, FillRule::NonZero, false, effort));
            }
        }
    }
    total.judge();
}

/// A block with faces through centres, some faces missing. Every centre of the lattice is checked, also
/// centres on the membrane over the holes.
#[test]
fn every_centre_of_an_aligned_block_without_some_faces() {
    let frame = Frame::new([0.0; 3], 16.0, 4).unwrap();
    let whole = block([1.5, 2.5, 3.5], [13.5, 10.5, 11.5]);
    let mut faults = Vec::new();
    let (mut asked, mut skipped) = (0, 0);
    for faces in 1..63u32 {
        let soup: Soup =
            (0..12).filter(|facet| faces >> (facet / 2) & 1 != 0).map(|facet| whole[facet]).collect();
        let mut truth = Soupy::new(&soup);
        for fill in RULES {
            let tree = &trees(&solid(&soup, fill), &frame)[1];
            for at in leafless_testkit::positions(4) {
                let winding = around_centre(&mut truth, &frame, at, true);
                let found = tree.view().tag_at(at) == Tag::Full;
                match is_inside(fill, winding, 1e-9) {
                    Some(inside) if inside != found => {
                        faults.push(format!("faces {faces:06b} {fill:?} {at:?}: {found}, but {winding:?}"));
                    }
                    Some(_) => {}
                    None => skipped += 1,
                }
                asked += 1;
            }
        }
    }
    assert!(
        faults.is_empty(),
        "{} faults, such as\n{}",
        faults.len(),
        faults[..faults.len().min(20)].join("\n")
    );
    // In the plane of a face that is missing, one half is exactly right.
    assert!(skipped * 20 < asked, "{skipped} of {asked} skipped");
}

/// Soups at several positions relative to the universe of a frame.
#[test]
fn holes_and_meshes_outside_of_the_universe() {
    let mut random = Random(12);
    let centre = [16.0, 16.2, 15.9];
    let soups = [
        ("patch", damaged(&sphere(centre, 11.0, 2), Damage::RemovePatch, &mut random, 1.0, false)),
        ("half", damaged(&torus(centre, 8.0, 4.0, 16, 8), Damage::RemoveHalf, &mut random, 1.0, false)),
        ("bowl", bowl([16.0, 16.0, 20.0], 12.0, 2)),
        ("doubled", damaged(&bowl(centre, 12.0, 2), Damage::DuplicateAll, &mut random, 1.0, false)),
        ("turned", inside_out(bowl([16.0, 16.0, 20.0], 12.0, 2))),
        ("pipe", pipe(centre, 8.0, 22.0, 0)),
        ("sheet", sheet(centre, 24.0, 1.5, 0)),
    ];
    let frames = [
        // Universes that cut it by faces, an edge and a corner; a cube inside; one beside; one far away; and
        // one in which it is tiny.
        ([16.1, 0.0, 0.0], 32.0),
        ([0.0, 0.0, 16.05], 32.0),
        ([-16.0, -16.1, 0.0], 32.3),
        ([16.0, 16.0, 16.0], 20.0),
        ([12.0, 12.5, 11.0], 7.0),
        ([14.0, 14.0, 20.5], 4.0),
        ([40.0, 10.0, 10.0], 9.0),
        ([1e4, -3e5, 7.0], 1e3),
        ([-500.0, -300.0, -400.0], 1000.0),
    ];
    let mut total = Findings::default();
    for (i, (name, soup)) in soups.iter().enumerate() {
        for (j, &(origin, edge)) in frames.iter().enumerate() {
            let depth = if j % 3 == i % 3 { 5 } else { 4 };
            let frame = Frame::new(origin, edge, depth).unwrap();
            let what = format!("{name} in {origin:?} + {edge}");
            total.add(verify(&what, soup, &frame, RULES[(i + j) % 2], false, LIGHT));
        }
    }
    // Far from the origin, where doubles are coarse.
    for far in [1e5, 1e9] {
        for (name, soup) in &soups {
            let soup = moved(soup, |[x, y, z]| [x + far, y - far, z + 3.0 * far]);
            let frame = Frame::new([far + 1.0, 1.5 - far, 3.0 * far + 0.25], 30.0, 4).unwrap();
            total.add(verify(&format!("{name} {far} away"), &soup, &frame, FillRule::NonZero, false, LIGHT));
        }
    }
    total.judge();
}

#[test]
fn any_number_of_threads_and_blocks_or_not() {
    let mut random = Random(21);
    let centre = [16.1, 15.9, 16.2];
    let kinds = [
        Damage::RemovePatch,
        Damage::RemoveFew,
        Damage::FlipOne,
        Damage::DuplicateOne,
        Damage::Stack,
        Damage::Nest,
    ];
    for (i, damage) in kinds.into_iter().enumerate() {
        let (soup, aligned) = match i % 3 {
            0 => (sphere(centre, 12.0, 2), false),
            1 => (refined(&tube([4.0, 4.0, 8.0], [28.0, 28.0, 24.0], 8.0), 1), true),
            _ => (torus(centre, 9.0, 4.0, 20, 12), false),
        };
        let soup = damaged(&soup, damage, &mut random, 1.0, aligned);
        // At depth 8, blocks are scanned below nodes that pass from thread to thread.
        let frame = if aligned { Frame::new([0.0; 3], 32.0, 8).unwrap() } else { odd_frame(&soup, 7) };
        let solid = solid(&soup, RULES[i % 2]);
        for rule in [Rule::Certified, Rule::Sampled] {
            let tree = build(&solid, &frame, rule, &alone()).unwrap();
            for threads in [2, 4] {
                let threaded = build(&solid, &frame, rule, &Control::threads(threads)).unwrap();
                assert!(threaded == tree, "{damage:?} {rule:?}: {threads} threads");
                assert!(bytes(&threaded) == bytes(&tree), "{damage:?} {rule:?}: other bytes");
            }
            let descended = build(&Descended(&solid), &frame, rule, &alone()).unwrap();
            assert!(descended == tree, "{damage:?} {rule:?}: by scan and by descent differ");
        }
    }
}

fn bytes(tree: &Octree) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_to(tree, &mut bytes).unwrap();
    bytes
}

/// Builds a certified and a sampled tree.
fn both(soup: &Soup, frame: &Frame) -> [Octree; 2] {
    let solid = solid(soup, FillRule::NonZero);
    [Rule::Certified, Rule::Sampled].map(|rule| build(&solid, frame, rule, &Control::threads(2)).unwrap())
}

/// Removes single facets of a closed soup, and compares the trees with the intact soup's trees.
///
/// Consider a point with the integer winding number n. Without a facet seen at the solid angle Ω, the winding
/// number is n ± Ω/4π, and |Ω| < 2π away from the facet. Hence no winding number crosses ½, and
///
/// * sampled cells stay the same, unless their centre is on the facet;
/// * decided cells never change between FULL and EMPTY;
/// * beyond d + 2h of the facet (d its diameter, h half the diagonal of a cell), finest cells keep their
///   decision. All of such a cell is at least d + h away, so that Ω ≤ (√3/4) d²/(d + h)² and |w − n| < 0.035.
///   In the cell, w changes by at most 3d h/(4π (d + h)²) ≤ 3/16π < 0.06. Both are far from ½.
fn remove_single_facets(name: &str, soup: &Soup, depth: u8, times: usize, random: &mut Random) {
    // (Some models that are taken for closed have cracks as wide as a rounding.)
    assert!(Boundary::of(soup).0.is_empty(), "{name} is not closed");
    let frame = odd_frame(soup, depth);
    let [intact, sampled] = both(soup, &frame);
    let half_diagonal = 0.866_025_5 * frame.cell_size();
    let mut changed = 0;
    for _ in 0..times {
        let mut spoiled = soup.clone();
        let gone = spoiled.swap_remove(random.below(soup.len() as u64) as usize);
        let edge = |i: usize| {
            let (a, b) = (gone[i], gone[(i + 1) % 3]);
            (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
        };
        let reach = edge(0).max(edge(1)).max(edge(2)) + 2.0 * half_diagonal;
        let trees = both(&spoiled, &frame);
        let mut truth = Soupy::new(&spoiled);
        let n = frame.cells();
        for (kind, [before, after]) in [[&intact, &trees[0]], [&sampled, &trees[1]]].into_iter().enumerate() {
            if kind == 1 {
                assert!(before == after, "{name}: sampled cells changed without {gone:?}");
                continue;
            }
            for at in (0..n).flat_map(|z| (0..n).flat_map(move |y| (0..n).map(move |x| [x, y, z]))) {
                let tags = [before.view().tag_at(at), after.view().tag_at(at)];
                if tags[0] == tags[1] {
                    continue;
                }
                changed += 1;
                let distance = soup::winding::distance(gone, soup::check::centre(&frame, at));
                assert!(tags.contains(&Tag::Partial), "{name} {at:?}: {tags:?} without {gone:?}");
                assert!(distance <= reach, "{name} {at:?}: {tags:?} at {distance} of {gone:?}, {reach}");
                // A missing facet between the winding numbers 0 and 1 still bounds the solid.
                let is_within = distance < 0.5 * frame.cell_size() && tags[1] != Tag::Partial;
                let between = |winding: f64| (0.05..0.95).contains(&winding.abs());
                assert!(
                    !(is_within && between(truth.at(soup::check::centre(&frame, at)).value)),
                    "{name} {at:?}: {tags:?} on {gone:?}"
                );
            }
        }
    }
    println!("{name}: {changed} certified cells changed by {times} facets");
}

#[test]
fn a_facet_that_is_gone_changes_little_and_only_near_it() {
    let mut random = Random(31);
    remove_single_facets("sphere", &sphere([16.1, 15.9, 16.2], 11.3, 3), 6, 4, &mut random);
    remove_single_facets("torus", &torus([16.0; 3], 9.0, 4.0, 28, 16), 6, 4, &mut random);
    remove_single_facets("block", &turned(&block([4.0; 3], [28.0, 20.0, 16.0])), 6, 4, &mut random);
    remove_single_facets("tube", &turned(&tube([4.0; 3], [28.0, 28.0, 16.0], 6.0)), 6, 4, &mut random);
    let wound =
        [sphere([16.0; 3], 11.0, 2), inside_out(sphere([15.0; 3], 7.0, 2)), sphere([19.0; 3], 9.0, 2)];
    remove_single_facets("wound", &wound.concat(), 6, 4, &mut random);
    for (name, depth) in [("busted.STL", 6), ("bunny-closed.stl", 7)] {
        if let Some(soup) = read(name) {
            remove_single_facets(name, &soup, depth, 2, &mut random);
        }
    }
}

/// Reads a model exactly as its file has it, facet by facet.
fn read(name: &str) -> Option<Soup> {
    let mesh = open_mesh(leafless_testkit::model(name)?, &MeshOptions::default()).unwrap().mesh;
    let vertices = mesh.vertices();
    Some(mesh.triangles().iter().map(|t| t.map(|v| vertices[v as usize])).collect())
}

/// Undecided cells lie around a surface: the mesh, or the membrane over its holes where the winding number is
/// ½. Halving the cells' edge halves the undecided volume.
#[test]
fn what_is_undecided_halves_with_every_level() {
    let mut random = Random(41);
    let ball = sphere([16.1, 15.9, 16.2], 11.3, 3);
    let soups = [
        ("patch", damaged(&ball, Damage::RemovePatch, &mut random, 1.0, false)),
        ("few", damaged(&ball, Damage::RemoveFew, &mut random, 1.0, false)),
        ("half", damaged(&ball, Damage::RemoveHalf, &mut random, 1.0, false)),
        ("flipped", damaged(&ball, Damage::FlipHalf, &mut random, 1.0, false)),
        ("bowl", bowl([16.3, 16.1, 20.2], 12.0, 3)),
        ("block", turned(&block([4.0; 3], [28.0, 20.0, 16.0])[2..].to_vec())),
    ];
    for (name, soup) in &soups {
        let frame = odd_frame(soup, 7);
        let tree = &both(soup, &frame)[0];
        let statistics = tree.statistics();
        let open: Vec<f64> =
            statistics.levels().iter().map(|level| level.volume.upper - level.volume.lower).collect();
        for pair in open[4..].windows(2) {
            let ratio = pair[1] / pair[0];
            assert!((0.4..0.6).contains(&ratio), "{name}: {ratio}, {open:?}");
        }
        println!("{name}: {:?}", open[4..].windows(2).map(|pair| pair[1] / pair[0]).collect::<Vec<_>>());
        // The undecided volume is a layer of a few cells on the surface and on membranes no larger than the
        // surface.
        let area: f64 = soup.iter().map(area).sum();
        let layer = open[7] / (area * frame.cell_size());
        assert!((1.0..4.5).contains(&layer), "{name}: a layer of {layer} cells");
    }
}

fn area([a, b, c]: &[[f64; 3]; 3]) -> f64 {
    let side = |to: &[f64; 3]| [0, 1, 2].map(|axis| to[axis] - a[axis]);
    let (u, v) = (side(b), side(c));
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    cross.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0
}

/// Checks models, intact and damaged.
fn models(names: &[(&str, u8)], kinds: &[Damage], effort: Effort) {
    let mut random = Random(51);
    let mut total = Findings::default();
    for &(name, depth) in names {
        let Some(soup) = read(name) else { return };
        for (i, &damage) in kinds.iter().enumerate() {
            let frame = odd_frame(&soup, depth);
            let spoiled = damaged(&soup, damage, &mut random, frame.cell_size(), false);
            let what = format!("{name} {damage:?}");
            total.add(verify(&what, &spoiled, &frame, RULES[i % 2], false, effort));
        }
    }
    println!(
        "{} asked, {} skipped; {} clear, {} open",
        total.asked, total.skipped, total.clear, total.clear_open
    );
    total.judge();
}

#[test]
fn models_as_they_come() {
    let kinds = [Damage::Intact, Damage::RemoveFew, Damage::FlipOne, Damage::RemovePatch];
    let names = [("multibody.stl", 5), ("wallhole.obj", 5), ("busted.STL", 5), ("featuretype.STL", 5)];
    models(&names, &kinds, Effort { points: 300, centres: 300, corners: 60, shares: 80 });
}

#[test]
#[ignore = "takes many minutes"]
fn more_models() {
    let kinds = [
        Damage::Intact,
        Damage::RemoveFew,
        Damage::RemovePatch,
        Damage::FlipTenth,
        Damage::DuplicateFifth,
        Damage::Nest,
        Damage::Overlap,
    ];
    let effort = Effort { points: 2000, centres: 2000, corners: 400, shares: 400 };
    let small = [
        ("multibody.stl", 7),
        ("wallhole.obj", 7),
        ("busted.STL", 6),
        ("featuretype.STL", 6),
        ("spot.obj", 6),
    ];
    models(&small, &kinds, effort);
    let large = [("cycloidal.ply", 6), ("stanford-bunny.obj", 6)];
    models(&large, &[Damage::Intact, Damage::RemovePatch], Effort { points: 400, centres: 400, ..LIGHT });
}

/// Returns the relative difference of the sampled volume from `intact`.
fn off(name: &str, soup: &Soup, frame: &Frame, intact: f64) -> f64 {
    let volume = both(soup, frame)[1].statistics().volume().lower;
    println!("{name}: {volume}, {:.4} % off", 100.0 * (volume / intact - 1.0));
    (volume / intact - 1.0).abs()
}

/// Holes that are small relative to the part cost little of its volume. A single missing facet costs nothing
/// but rounding. Several connected missing facets lose about the volume that the membrane over the hole cuts
/// off.
fn holes_cost_little(name: &str, soup: &Soup, depth: u8, share: f64, random: &mut Random) {
    let frame = odd_frame(soup, depth);
    let intact = both(soup, &frame)[1].statistics().volume().lower;
    for (count, most) in [(1, 1e-9), (10, 0.005), ((soup.len() as f64 * share) as usize, 0.005)] {
        let mut spoiled = soup.clone();
        damage::remove(&mut spoiled, random, count);
        let off = off(&format!("{name} without {count}"), &spoiled, &frame, intact);
        assert!(off < most, "{name} without {count}: {off}");
    }
}

#[test]
fn small_holes_cost_little_volume() {
    let mut random = Random(61);
    holes_cost_little("sphere", &sphere([16.1, 15.9, 16.2], 11.3, 3), 6, 0.02, &mut random);
    holes_cost_little("torus", &torus([16.0; 3], 9.0, 4.0, 40, 24), 6, 0.02, &mut random);
}

#[test]
#[ignore = "takes many minutes"]
fn small_holes_cost_little_volume_of_models() {
    let mut random = Random(62);
    for name in ["featuretype.STL", "plate_holes.STL", "angle_block.STL", "busted.STL", "fandisk.obj"] {
        let Some(soup) = read(name) else { return };
        holes_cost_little(name, &soup, 9, 0.01, &mut random);
    }
    let (Some(closed), Some(open)) = (read("bunny-closed.stl"), read("stanford-bunny.obj")) else { return };
    let frame = odd_frame(&closed, 9);
    let intact = both(&closed, &frame)[1].statistics().volume().lower;
    // Its five holes are as wide as a tenth of its base.
    assert!(off("bunny as scanned", &open, &frame, intact) < 0.005);
    holes_cost_little("bunny", &closed, 9, 0.01, &mut random);
}

/// Measures the time for five million triangles. (Only a few points are checked.)
#[test]
#[ignore = "takes minutes, and some gigabytes"]
fn five_million_triangles() {
    let mut random = Random(71);
    let whole = torus([16.0, 16.1, 15.9], 9.0, 4.0, 2500, 1000);
    for (name, share) in [("closed", 0.0), ("a patch", -1.0), ("a thousandth", 0.001), ("a hundredth", 0.01)]
    {
        let mut soup = whole.clone();
        if share < 0.0 {
            soup = damaged(&soup, Damage::RemovePatch, &mut random, 0.0, false);
        } else {
            let count = (share * soup.len() as f64) as usize;
            damage::remove(&mut soup, &mut random, count);
        }
        let frame = Frame::new([0.013, 0.021, 0.034], 32.0, 9).unwrap();
        let start = std::time::Instant::now();
        let mesh = mesh(&soup);
        let welded = start.elapsed();
        let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
        let placed = start.elapsed();
        let tree = build(&solid, &frame, Rule::Certified, &Control::threads(2)).unwrap();
        println!(
            "{name} of {}: welded {:.1} s, placed {:.1} s, certified at depth 9 in {:.1} s, volume {:?}",
            soup.len(),
            welded.as_secs_f64(),
            (placed - welded).as_secs_f64(),
            (start.elapsed() - placed).as_secs_f64(),
            tree.statistics().volume()
        );
        let mut truth = Soupy::new(&soup);
        for _ in 0..20 {
            let p = [0; 3].map(|_: i32| random.between(0.1, 32.0));
            let tag = tree.view().tag_at(frame.cell_of(p).unwrap());
            if let Some(inside) = is_inside(FillRule::NonZero, truth.at(p), 1e-6) {
                assert_ne!(tag, if inside { Tag::Empty } else { Tag::Full }, "{p:?}");
            }
        }
    }
}

/// The corners of a cube, and its outward facets.
fn cube() -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let corners = (0..8).map(|k| [0, 1, 2].map(|axis| f64::from(k >> axis & 1))).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let facets = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    (corners, facets)
}

/// Random facets of a cube are inverted, missing or doubled. The bounds contain the whole enclosed set,
/// although the set reaches beyond the corners' bounding box.
#[test]
fn bounds_hold_whatever_an_open_surface_encloses() {
    let (corners, whole) = cube();
    let mut random = Random(7);
    let (mut beyond, mut slack) = (0, 0.0f64);
    for round in 0..400 {
        let mut facets = Vec::new();
        for &[a, b, c] in &whole {
            match random.below(5) {
                0 => facets.push([a, c, b]),
                1 if round % 2 == 0 => {}
                2 if round % 3 == 0 => facets.extend([[a, b, c]; 2]),
                _ => facets.push([a, b, c]),
            }
        }
        let Ok(mesh) = TriangleMesh::new(corners.clone(), facets) else { continue };
        let fill = if round % 5 == 0 { FillRule::Positive } else { FillRule::NonZero };
        let Ok(solid) = MeshSolid::new(mesh, fill) else { continue };
        let bounds = solid.bounds().expect("bounds of every mesh");
        let frame = Frame::new([-1.5; 3], 4.0, 4).unwrap();
        let tree = build(&solid, &frame, Rule::Sampled, &Control::default()).unwrap();
        for at in 0..4096u32 {
            let centre = [0, 4, 8].map(|shift| -1.5 + 0.25 * (f64::from(at >> shift & 15) + 0.5));
            if tree.contains(centre) == Membership::Inside {
                let is_within = |low: f64, high: f64| centre.iter().all(|&c| low <= c && c <= high);
                beyond += u32::from(!is_within(0.0, 1.0));
                let [min, max] = [bounds.min, bounds.max];
                assert!(
                    (0..3).all(|k| min[k] <= centre[k] && centre[k] <= max[k]),
                    "{round} {centre:?} {bounds:?}"
                );
            }
        }
        slack = (0..3).fold(slack, |slack, k| slack.max(bounds.max[k] - 1.0).max(-bounds.min[k]));
    }
    assert!(beyond > 0 && slack < 1.5, "{beyond} {slack}");
}

/// With one flat, convex hole, the enclosed set stays within the corners' bounding box.
#[test]
fn bounds_of_a_surface_with_one_flat_hole_are_those_of_its_corners() {
    let (corners, whole) = cube();
    for lid in 0..6 {
        let open: Vec<_> = (0..12).filter(|facet| facet / 2 != lid).map(|facet| whole[facet]).collect();
        for facets in [open, whole[1..].to_vec()] {
            let solid =
                MeshSolid::new(TriangleMesh::new(corners.clone(), facets).unwrap(), FillRule::NonZero)
                    .unwrap();
            assert_eq!(solid.bounds(), leafless::Bounds::new([0.0; 3], [1.0; 3]));
        }
    }
}
