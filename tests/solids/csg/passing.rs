//! Expressions in which only one other solid is open, in the whole universe or in a part of it. The
//! expression passes that solid's block-wise work on.

use leafless::op::resolve;
use leafless::{
    AnySolid, Bounds, Callback, Control, Csg, FillRule, Frame, MeshSolid, Octree, Rule, Solid, Tag,
    TriangleMesh, Verdict, build, complement, difference, intersection, union, xor,
};
use leafless_testkit::cubes::Plain;
use leafless_testkit::{alone, repeated};

const RULES: [Rule; 4] = [Rule::Certified, Rule::Sampled, Rule::Inner, Rule::Outer];

/// A closed torus about the z axis through `centre`.
fn torus(centre: [f64; 3], major: f64, minor: f64, [around, across]: [u32; 2]) -> TriangleMesh {
    let turn = |i: u32, n: u32| (std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
    let vertices = (0..around).flat_map(|i| {
        let (sin, cos) = turn(i, around);
        (0..across).map(move |j| {
            let (height, out) = turn(j, across);
            let radius = major + minor * out;
            [centre[0] + radius * cos, centre[1] + radius * sin, centre[2] + minor * height]
        })
    });
    let index = |i: u32, j: u32| i % around * across + j % across;
    let triangles = (0..around).flat_map(|i| {
        (0..across).flat_map(move |j| {
            let [a, b] = [index(i, j), index(i + 1, j)];
            let [c, d] = [index(i + 1, j + 1), index(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
    });
    let mesh = TriangleMesh::new(vertices.collect(), triangles.collect()).unwrap();
    mesh.check_closed(FillRule::NonZero).unwrap();
    mesh
}

/// An octahedron that is not a primitive of the library: |x| + |y| + |z| ≤ r.
fn octahedron(r: f64) -> AnySolid {
    let sum = |p: [f64; 3]| p.iter().map(|c| c.abs()).sum::<f64>();
    let bounds = Bounds::new([-r; 3], [r; 3]).unwrap();
    let classify = move |min: [f64; 3], max: [f64; 3]| {
        let far = [0, 1, 2].map(|i| min[i].abs().max(max[i].abs()));
        let near = [0, 1, 2]
            .map(|i| if min[i] <= 0.0 && max[i] >= 0.0 { 0.0 } else { min[i].abs().min(max[i].abs()) });
        Ok(match (sum(near), sum(far)) {
            (_, far) if far < r => Verdict::Full,
            (near, _) if near > r => Verdict::Empty,
            _ => Verdict::Partial(()),
        })
    };
    AnySolid::new(Callback::new(classify).with_contains(move |p| Ok(sum(p) <= r)).with_bounds(bounds))
}

fn built(solid: &impl Solid, frame: &Frame, rule: Rule) -> Octree {
    let tree = build(solid, frame, rule, &alone()).unwrap();
    tree.view().check().unwrap();
    // Shallower trees are built by one thread anyway.
    if frame.depth() >= 7 {
        let threaded = build(solid, frame, rule, &Control::threads(2)).unwrap();
        assert!(tree == threaded, "{rule:?}: two threads differ on {frame:?}");
    }
    tree
}

/// True if two trees have the same cells, whatever their exteriors.
fn same_cells(a: &Octree, b: &Octree) -> bool {
    [Rule::Inner, Rule::Outer].into_iter().all(|rule| {
        let [a, b] = [a, b].map(|tree| resolve(tree.view(), rule, &alone()).unwrap());
        xor(a.view(), b.view(), &alone()).unwrap().view().root_tag() == Tag::Empty
    })
}

/// True if `a` decides every cell that `b` decides, in the same way.
fn no_looser(a: &Octree, b: &Octree) -> bool {
    let within = |a: &Octree, b: &Octree| {
        difference(a.view(), b.view(), &alone()).unwrap().view().root_tag() == Tag::Empty
    };
    let [a, b] = [a, b]
        .map(|tree| [Rule::Inner, Rule::Outer].map(|rule| resolve(tree.view(), rule, &alone()).unwrap()));
    within(&b[0], &a[0]) && within(&a[1], &b[1])
}

fn check(name: &str, make: impl Fn(&Frame) -> AnySolid, rules: &[Rule]) {
    for depth in 1..=repeated(7, 8) {
        let frames = [Frame::new([-1.0; 3], 2.0, depth), Frame::new([-1.1, -0.9, -1.0], 2.2, depth)];
        // Large trees take long. They get one frame, and fewer cases.
        let frames = if depth < 7 { &frames[..] } else { &frames[depth as usize % 2..][..1] };
        for frame in frames {
            let frame = *frame.as_ref().unwrap();
            let solid = make(&frame);
            let alone_in_it = Csg::solid(solid.clone());
            // Smaller than the universe's octants, and off the lattice.
            let (min, max) = ([0.31, -0.2, -0.17], [0.72, 0.23, 0.19]);
            let small = Csg::cuboid(min, max).unwrap();
            let most = Csg::cuboid([-0.93, -0.9, -0.83], [0.9, 0.7, 0.8]).unwrap();
            for &rule in rules {
                let what = format!("{name} {rule:?} {frame:?}");
                let plain = built(&solid, &frame, rule);
                assert!(built(&alone_in_it, &frame, rule) == plain, "{what}: alone");
                // The part missing in the complement is the part that was left open.
                let opposite = match rule {
                    Rule::Inner => Rule::Outer,
                    Rule::Outer => Rule::Inner,
                    other => other,
                };
                let not = complement(built(&solid, &frame, opposite).view(), &alone()).unwrap();
                assert!(built(&alone_in_it.complement(), &frame, rule) == not, "{what}: the complement");
                // Trees of the parts. The subtracted part has the opposite rule.
                let cutter = build(&small, &frame, opposite, &alone()).unwrap();
                let within = build(&most, &frame, rule, &alone()).unwrap();
                let added = build(&small, &frame, rule, &alone()).unwrap();
                let cases = [
                    (
                        "cut",
                        alone_in_it.difference(&small),
                        difference(plain.view(), cutter.view(), &alone()),
                    ),
                    (
                        "within",
                        Csg::intersection_of([alone_in_it.clone(), most.clone()]),
                        intersection(plain.view(), within.view(), &alone()),
                    ),
                    (
                        "with",
                        Csg::union_of([small.clone(), alone_in_it.clone()]),
                        union(plain.view(), added.view(), &alone()),
                    ),
                    (
                        "taken out",
                        most.difference(&alone_in_it),
                        intersection(within.view(), not.view(), &alone()),
                    ),
                ];
                for (case, csg, expected) in
                    cases.into_iter().take(if depth < repeated(7, 8) { 4 } else { 1 })
                {
                    let (found, expected) = (built(&csg.unwrap(), &frame, rule), expected.unwrap());
                    if rule == Rule::Certified {
                        assert!(no_looser(&found, &expected), "{what}: {case}");
                    } else {
                        assert!(same_cells(&found, &expected), "{what}: {case}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_mesh() {
    let mesh = torus([0.013, 0.021, 0.034], 0.55, 0.23, [40, 24]);
    let solid = AnySolid::new(MeshSolid::new(mesh, FillRule::NonZero).unwrap());
    check("mesh", |_| solid.clone(), &RULES);
}

#[test]
fn a_stored_octree() {
    let mesh = torus([0.013, 0.021, 0.034], 0.55, 0.23, [40, 24]);
    let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
    let stored = |rule, frame: &Frame| AnySolid::new(build(&solid, frame, rule, &alone()).unwrap());
    check("sampled octree", |frame| stored(Rule::Sampled, frame), &RULES);
    // In undecided cells, no centre is known.
    check(
        "certified octree",
        |frame| stored(Rule::Certified, frame),
        &[Rule::Certified, Rule::Inner, Rule::Outer],
    );
    // A tree coarser than the query.
    let coarse = |frame: &Frame| frame.with_depth(frame.depth().div_ceil(2)).unwrap();
    check("coarse octree", |frame| stored(Rule::Sampled, &coarse(frame)), &RULES);
}

#[test]
fn a_callback() {
    check("callback", |_| octahedron(0.93), &RULES);
}

#[test]
fn a_ball() {
    let solid = AnySolid::new(Plain::ball([0.05, -0.02, 0.03], 0.8).unwrap());
    check("ball", |_| solid.clone(), &RULES);
}
