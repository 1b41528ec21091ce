//! Closed triangle meshes as solids, against oracles in exact integers that share no code with the library.

use crate::descended::Descended;
use crate::oracle::{Contact, Oracle, PointOracle};
use crate::shapes;
use crate::shapes::*;
use leafless::error::MeshError;
use leafless::{
    AnySolid, Classifier, Control, Error, FillRule, Frame, Membership, MeshSolid, Octree, Rule, Solid, Tag,
    TriangleMesh, build, difference, exchange,
};
use leafless_testkit::{Random, alone, cases, lattice_frame, model, repeated};
use proptest::prelude::*;

const FILLS: [FillRule; 2] = [FillRule::NonZero, FillRule::EvenOdd];
const RULES: [Rule; 4] = [Rule::Certified, Rule::Sampled, Rule::Inner, Rule::Outer];

/// Builds all four trees of a mesh. Checks that block-wise scanning and descent give the same trees, for any
/// number of threads.
fn trees(what: &str, mesh: &TriangleMesh, frame: &Frame, fill: FillRule) -> [Octree; 4] {
    let solid = MeshSolid::new(mesh.clone(), fill).unwrap();
    RULES.map(|rule| {
        let tree = build(&solid, frame, rule, &alone()).unwrap();
        tree.view().check().unwrap();
        let descended = build(&Descended(&solid), frame, rule, &alone()).unwrap();
        assert!(tree == descended, "{what}: {rule:?} {fill:?} by scan and by descent differ");
        // Shallower trees are built by one thread anyway.
        for threads in [2, 16].into_iter().filter(|_| frame.depth() >= 7) {
            let threaded = build(&solid, frame, rule, &Control::threads(threads)).unwrap();
            assert!(tree == threaded, "{what}: {rule:?} {fill:?} with {threads} threads differs");
        }
        tree
    })
}

/// The greatest distance of a PARTIAL cell from a triangle, in cells.
const TOLERANCE: f64 = 1e-6;

/// Checks all claims about a mesh on a frame, cell by cell.
fn verify_with(what: &str, mesh: &TriangleMesh, frame: &Frame, fills: &[FillRule]) {
    let oracle = Oracle::new(mesh, frame);
    let windings = oracle.windings();
    let displacement = mesh.displacement() / frame.cell_size();
    let contacts = oracle.contacts(TOLERANCE + 2.0 * displacement);
    // The documentation of lattice-aligned parts says that contact is not overlap.
    let grain = (1u64 << (15 - frame.depth().min(15))) as f64;
    let cells = frame.cells() as f64;
    let is_aligned = |axis: usize, x: f64| {
        let offset = x - frame.origin()[axis];
        let at = offset / frame.cell_size();
        let exact = offset + frame.origin()[axis] == x && at * frame.cell_size() == offset;
        exact && at.abs() <= cells && (at * grain).fract() == 0.0
    };
    let dyadic = frame.cell_size().to_bits() << 12 == 0;
    let aligned = dyadic
        && frame.depth() <= 14
        && displacement == 0.0
        && mesh.vertices().iter().all(|vertex| (0..3).all(|axis| is_aligned(axis, vertex[axis])));
    // Far outside the universe, a double is coarser than the tolerance.
    let tight = mesh.vertices().iter().all(|vertex| {
        (0..3).all(|axis| ((vertex[axis] - frame.origin()[axis]) / frame.cell_size()).abs() < 1e6)
    });
    for &fill in fills {
        let [certified, sampled, inner, outer] = trees(what, mesh, frame, fill);
        let n = frame.cells();
        let mut i = 0;
        for z in 0..n {
            for y in 0..n {
                for x in 0..n {
                    let at = [x, y, z];
                    let tag = certified.view().tag_at(at);
                    let inside = Oracle::inside(fill, windings[i]);
                    let crisp = |inside| if inside { Tag::Full } else { Tag::Empty };
                    let context = || format!("{what}: {fill:?} cell {at:?} winding {}", windings[i]);
                    assert_eq!(sampled.view().tag_at(at), crisp(inside), "sampled {}", context());
                    match contacts[i] {
                        Contact::Meets => assert_eq!(tag, Tag::Partial, "cut {}", context()),
                        Contact::Clear if tight => assert_eq!(tag, crisp(inside), "clear {}", context()),
                        Contact::Near if aligned => assert_eq!(tag, crisp(inside), "contact {}", context()),
                        _ => assert!(tag == Tag::Partial || tag == crisp(inside), "{tag:?} {}", context()),
                    }
                    assert_eq!(inner.view().tag_at(at), crisp(tag == Tag::Full), "inner {}", context());
                    assert_eq!(outer.view().tag_at(at), crisp(tag != Tag::Empty), "outer {}", context());
                    i += 1;
                }
            }
        }
    }
}

/// Checks them for both fill rules.
fn verify(what: &str, soup: &Soup, frame: &Frame) {
    verify_with(what, &mesh(soup), frame, &FILLS);
}

/// Returns the expected exterior: EMPTY if and only if no vertex is outside the universe.
fn exterior(soup: &Soup, frame: &Frame) -> Tag {
    let mesh = mesh(soup);
    let solid = MeshSolid::new(mesh.clone(), FillRule::NonZero).unwrap();
    solid.on(frame, &alone()).unwrap().exterior()
}

fn join(soups: &[Soup]) -> Soup {
    soups.concat()
}

#[test]
fn blocks_on_the_lattice_leave_nothing_undecided() {
    for depth in [1u8, 2, 3, 5, 6, 7] {
        let frame = lattice_frame(depth);
        let n = frame.cells() as f64;
        let edges: &[f64] = if depth < 3 { &[0.0, 1.0] } else { &[0.0, 1.0, 2.0, n / 2.0 - 1.0, n / 2.0] };
        for &low in edges {
            for high in [low + 1.0, n / 2.0 + 1.0, n - 1.0, n] {
                if low >= high || high > n {
                    continue;
                }
                let soup = block([low, 0.0, low], [high, n, high]);
                let mesh = mesh(&soup);
                let [certified, sampled, ..] = trees("aligned block", &mesh, &frame, FillRule::NonZero);
                assert_eq!(certified.statistics().cells(Tag::Partial), 0, "{depth} {low} {high}");
                let volume = (high - low) * (high - low) * n;
                assert_eq!(certified.statistics().volume_cells(), (volume as u64, volume as u64));
                assert_eq!(certified.statistics().volume_cells(), sampled.statistics().volume_cells());
                assert_eq!(exterior(&soup, &frame), Tag::Empty);
            }
        }
    }
}

#[test]
fn faces_between_the_first_centres_of_scanned_blocks() {
    // Every offset of a face within a block of 64³, on every axis. The face cuts the lowest layer of a block.
    // The first crossing of the lowest centre's line must not be lost.
    let frame = lattice_frame(7);
    for offset in [0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 62.75, 63.0, 63.5, 63.75, 64.0, 64.25, 64.5, 65.0] {
        for axis in 0..3 {
            let mut low = [1.0, 2.0, 3.0];
            low[axis] = offset;
            let soup = block(low, [100.0, 101.25, 102.5]);
            let mesh = mesh(&soup);
            let tree = &trees("offset", &mesh, &frame, FillRule::NonZero)[1];
            let count = |low: f64, high: f64| (high - 0.5).floor() - (low - 0.5).ceil() + 1.0;
            // For a face through centres, the shifted centres lie above it.
            let closed = |low: f64, high: f64| count(low, high) - ((high - 0.5).fract() == 0.0) as i32 as f64;
            let expected: f64 = (0..3).map(|axis| closed(low[axis], [100.0, 101.25, 102.5][axis])).product();
            assert_eq!(tree.statistics().volume_cells().0, expected as u64, "offset {offset} axis {axis}");
        }
    }
}

#[test]
fn deep_and_aligned() {
    // Depth 20: some finest cells in the far corner of the lattice.
    let frame = lattice_frame(20);
    let n = frame.cells() as f64;
    for at in [0.0, 524_287.0, 524_288.0, n - 5.0] {
        let soup = block([at; 3], [at + 4.0, at + 5.0, at + 3.0]);
        let mesh = mesh(&soup);
        let [certified, sampled, ..] = trees("deep block", &mesh, &frame, FillRule::NonZero);
        assert_eq!(certified.statistics().volume_cells(), (60, 60));
        assert_eq!(sampled.statistics().volume_cells(), (60, 60));
        assert_eq!(certified.statistics().cells(Tag::Partial), 0);
        // Not aligned: the truth lies between the trees, and every cell has the right tag.
        let soup = block([at + 0.25; 3], [at + 3.75, at + 4.75, at + 2.75]);
        let mesh = shapes::mesh(&soup);
        let [certified, sampled, ..] = trees("deep block", &mesh, &frame, FillRule::NonZero);
        assert_eq!(certified.statistics().volume_cells(), (2 * 3, 60));
        assert_eq!(sampled.statistics().volume_cells(), (60, 60));
    }
}

#[test]
fn ties_chamfers_and_contact() {
    for depth in [3u8, 4, 6] {
        let frame = lattice_frame(depth);
        let n = frame.cells() as f64;
        let m = n / 2.0;
        // Faces through centres; vertices and edges on lines of centres.
        verify("through centres", &block([0.5; 3], [n - 1.5, m + 0.5, 2.5]), &frame);
        verify("quarters", &block([0.25, 0.75, 1.25], [n - 0.25, m + 0.75, 2.0]), &frame);
        // Chamfers along the lattice's diagonals, through corners and through centres.
        verify("octahedron", &octahedron([m; 3], m - 1.0), &frame);
        verify("octahedron at a centre", &octahedron([m - 0.5; 3], m - 1.0), &frame);
        verify("octahedron off centre", &octahedron([m - 0.5, m, m + 0.25], m - 1.5), &frame);
        let diamond = [[m, 1.0], [n - 1.0, m], [m, n - 1.0], [1.0, m]];
        verify("diamond", &prism(&diamond, [m, m], 1.0, n - 1.0), &frame);
        verify("half diamond", &prism(&diamond.map(|p| p.map(|x| x - 0.5)), [m - 0.5; 2], 0.5, n), &frame);
        for turn in 1..3 {
            let turned = |soup: &Soup| moved(soup, |p| [p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3]]);
            verify("turned diamond", &turned(&prism(&diamond, [m, m], 1.0, n - 1.0)), &frame);
        }
    }
}

#[test]
fn touching_nested_and_repeated_bodies() {
    for depth in [4u8, 6] {
        let frame = lattice_frame(depth);
        let q = frame.cells() as f64 / 4.0;
        let cube = |low: f64, high: f64| block([low; 3], [high; 3]);
        // Bodies that touch in a corner, along an edge, over a face.
        verify("corner", &join(&[cube(1.0, q), cube(q, 3.0 * q)]), &frame);
        verify("edge", &join(&[cube(1.0, q), block([q, q, 0.5], [3.0 * q, 3.0 * q, q])]), &frame);
        verify("face", &join(&[cube(1.0, q), block([q, 1.0, 1.0], [2.5, q, q].map(|x| x + q))]), &frame);
        // Nested shells: voids, voids with a body, and bodies counted twice.
        let shells = [cube(0.5, 3.5 * q), cube(1.25, 3.0 * q), cube(2.0, 2.5 * q)];
        let [a, b, c] = shells;
        verify("void", &join(&[a.clone(), inside_out(b.clone())]), &frame);
        verify("body in a void", &join(&[a.clone(), inside_out(b.clone()), c.clone()]), &frame);
        verify("nested", &join(&[a.clone(), b.clone(), c.clone()]), &frame);
        verify("inside out", &inside_out(a.clone()), &frame);
        // Copies, with winding numbers beyond the bitmaps' range, and back to zero.
        for copies in [2usize, 4, 5].into_iter().skip(if depth < 6 { 0 } else { repeated(2, 0) }) {
            let many: Soup = (0..copies).flat_map(|_| b.clone()).collect();
            verify("copies", &many, &frame);
            verify("negative copies", &inside_out(many.clone()), &frame);
            verify("cancelling", &join(&[many.clone(), inside_out(many.clone())]), &frame);
            verify("nested copies", &join(&[many, a.clone(), c.clone()]), &frame);
        }
        // Shells one in another, ever deeper, some of them through centres.
        let onion: Soup =
            (0..7).flat_map(|i| cube(0.5 + 0.25 * i as f64, 3.5 * q - 0.25 * i as f64)).collect();
        verify("onion", &onion, &frame);
        verify("onion inside out", &inside_out(onion), &frame);
    }
}

#[test]
fn triangles_without_area_do_nothing() {
    for depth in [4u8, 6, 7].into_iter().take(repeated(2, 3)) {
        let frame = lattice_frame(depth);
        let n = frame.cells() as f64;
        // A block with the middle of a top edge in one face but not in its neighbour: the flat triangle
        // between keeps the mesh closed.
        let cracked = |at: f64, low: [f64; 3], high: [f64; 3]| {
            let mut soup = block(low, high);
            let (a, b) = ([low[0], low[1], high[2]], [high[0], low[1], high[2]]);
            let middle = [low[0] + (high[0] - low[0]) * at, low[1], high[2]];
            let i = soup.iter().position(|t| (0..3).any(|k| t[k] == a && t[(k + 1) % 3] == b)).unwrap();
            let t = soup.remove(i);
            let k = (0..3).find(|&k| t[k] == a).unwrap();
            let c = t[(k + 2) % 3];
            soup.extend([[a, middle, c], [middle, b, c], [b, middle, a]]);
            soup
        };
        verify("aligned crack", &cracked(0.5, [1.0; 3], [5.0, n - 1.0, 4.0]), &frame);
        verify("crack", &cracked(0.25, [1.5, 1.25, 0.75], [n - 0.5, n - 1.0, 4.125]), &frame);
        // Whole bodies without area or volume: on the lattice's diagonal, within one cell, and flat bodies.
        let body = block([n / 2.0; 3], [n - 1.0; 3]);
        let segment = |p: [f64; 3], d: [f64; 3]| {
            let at = |t: f64| [0, 1, 2].map(|axis| p[axis] + d[axis] * t);
            vec![[at(0.0), at(1.0), at(2.0)], [at(0.0), at(2.0), at(1.0)]]
        };
        verify("diagonal", &join(&[body.clone(), segment([0.25; 3], [1.75; 3])]), &frame);
        verify("within a cell", &join(&[body.clone(), segment([1.25; 3], [0.25; 3])]), &frame);
        verify("within a full cell", &join(&[body.clone(), segment([n - 4.75; 3], [0.25; 3])]), &frame);
        let sheet = vec![
            [[1.5, 1.0, 1.0], [1.5, 5.0, 1.5], [1.5, 2.0, 6.0]],
            [[1.5, 1.0, 1.0], [1.5, 2.0, 6.0], [1.5, 5.0, 1.5]],
        ];
        verify("sheet", &join(&[body, sheet]), &frame);
    }
}

#[test]
fn needles_do_not_smear() {
    // Long thin triangles across the whole universe, at places that are not short doubles: only the cells
    // along them may stay open.
    for depth in [4u8, 6] {
        let n = (1u32 << depth) as f64;
        let frame = Frame::new([0.1; 3], n, depth).unwrap();
        let p = |x: f64, y: f64, z: f64| [0.1 + n * x, 0.1 + n * y, 0.1 + n * z];
        for width in [0.0, 1e-300, 1e-17, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3] {
            let (a, b) = (p(0.11, 0.13, 0.17), p(0.83, 0.79, 0.91));
            let middle = p(0.47, 0.46, 0.54);
            let off = [middle[0] + width, middle[1] - width, middle[2] + 2.0 * width];
            verify("needle", &tetrahedron([a, b, middle, off]), &frame);
            verify("flat needle", &vec![[a, b, middle], [b, a, middle]], &frame);
            let short = [a[0] + width, a[1] + width * 0.3, a[2] - width];
            if short != a {
                verify("sliver", &tetrahedron([a, b, short, off]), &frame);
            }
            let flat = p(0.83, 0.13, 0.17);
            verify("fan", &tetrahedron([a, flat, middle, [a[0], a[1] + width, a[2] + width]]), &frame);
        }
    }
}

#[test]
fn beyond_the_universe() {
    for depth in [3u8, 6] {
        let frame = lattice_frame(depth);
        let n = frame.cells() as f64;
        for axis in 0..3 {
            for side in [false, true] {
                let (mut low, mut high) = ([1.25; 3], [n - 1.75; 3]);
                if side {
                    high[axis] = n + 3.5
                } else {
                    low[axis] = -2.25
                }
                let soup = block(low, high);
                verify("sticking out", &soup, &frame);
                assert_eq!(exterior(&soup, &frame), Tag::Partial);
                // Exactly up to the end, and slightly beyond.
                (low[axis], high[axis]) = if side { (1.25, n) } else { (0.0, n - 1.75) };
                assert_eq!(exterior(&block(low, high), &frame), Tag::Empty);
                (low[axis], high[axis]) = if side { (1.25, n.next_up()) } else { (-1e-70, n - 1.75) };
                assert_eq!(exterior(&block(low, high), &frame), Tag::Partial);
            }
        }
        for (low, high) in
            [([-3.0; 3], [n + 5.0; 3]), ([-3.0; 3], [-1.0; 3]), ([n + 1.0, 0.0, 0.0], [n + 2.0; 3])]
        {
            verify("around or outside", &block(low, high), &frame);
            verify("turned", &octahedron(low, 2.5 * n), &frame);
        }
        verify("touching from outside", &block([-2.0, 0.0, 0.0], [0.0, n, n]), &frame);
    }
}

#[test]
fn coordinates_of_any_size() {
    let frames = [
        ([0.0; 3], 8.0),
        ([0.1, -7.3, 1e5 / 3.0], 10.0 / 3.0),
        // A part of 0.044 units a million units away, and one of 500.
        ([1e6 / 3.0; 3], 0.044),
        ([-11.7; 3], 500.0 / 0.97),
        ([-1e30, 1e30, 0.0], 1e30 / 3.0),
        ([0.0; 3], 1e-70),
        ([1e-3; 3], 3e-70),
    ];
    for (origin, edge) in frames {
        let frame = |depth| Frame::new(origin, edge, depth).unwrap();
        let at = |x: f64, y: f64, z: f64| [origin[0] + edge * x, origin[1] + edge * y, origin[2] + edge * z];
        let is_fine = at(0.3, 0.3, 0.3) != at(0.4, 0.4, 0.4);
        let sizes = [0.3, 1.7, 1e8, 2f64.powi(32), 1e20, 2f64.powi(180)];
        for size in sizes.into_iter().step_by(repeated(2, 1)) {
            if edge * size > 1e75 || !is_fine {
                continue;
            }
            let soups = [
                block(at(0.21, 0.17, 0.4), at(size, size, size)),
                block(at(-size, -size, -size), at(size, size, size)),
                octahedron(at(0.4, 0.6, 0.5), edge * size),
                octahedron(at(size * 2.0, 0.6, 0.5), edge * size),
            ];
            for soup in soups {
                verify("any size", &soup, &frame(3));
                if size < 2.0 && edge > 1.0 {
                    verify("any size", &soup, &frame(6));
                }
            }
        }
        for huge in [1e30, 2f64.powi(250), 2f64.powi(256)] {
            let wedge = tetrahedron([
                [-huge, -huge, origin[2]],
                [huge, -huge, origin[2]],
                [at(0.3, 0.3, 0.3)[0], huge, at(0.3, 0.3, 0.3)[2]],
                at(0.4, 0.3, 0.6),
            ]);
            for soup in [block([-huge; 3], at(0.6, 0.7, 0.8)), octahedron(origin, huge), wedge] {
                verify("huge", &soup, &frame(3));
            }
        }
    }
    // In scanned blocks.
    let frame = lattice_frame(6);
    for huge in [1e17, 1e30] {
        let mesh = mesh(&block([-huge; 3], [38.4, 40.0 + huge, 51.2]));
        let tree = &trees("huge block", &mesh, &frame, FillRule::NonZero)[1];
        assert_eq!(tree.statistics().volume_cells().0, 38 * 64 * 51);
    }
}

#[test]
fn coordinates_that_overflow() {
    // The smallest universe and the largest coordinates: products of positions in cells are infinite.
    let (huge, small) = (2f64.powi(256), 2f64.powi(-256));
    for depth in [1, 2] {
        let frame = Frame::new([0.0; 3], small, depth).unwrap();
        let at = |x: f64| x * small;
        let tips = [[-huge, huge / 4.0, -huge], [huge, huge, -huge], [huge, -huge / 2.0, huge]];
        for x in [0.3, 0.5, 0.75] {
            for turn in 0..8 {
                let flip = |p: [f64; 3]| {
                    [0, 1, 2].map(|axis| if turn >> axis & 1 != 0 { -p[axis] } else { p[axis] })
                };
                let soup = tetrahedron([[at(x); 3], flip(tips[0]), flip(tips[1]), flip(tips[2])]);
                let fan = tetrahedron([[at(x); 3], [at(0.6), at(0.2), huge], flip(tips[1]), flip(tips[2])]);
                for soup in [soup, fan] {
                    verify("overflow", &soup, &frame);
                }
            }
        }
    }
}

#[test]
fn tiny_coordinates() {
    // A needle around the origin, which is a centre. The needle is thinner than any product of doubles
    // resolves.
    for depth in [3u8, 6] {
        let n = (1u32 << depth) as f64;
        let frame = Frame::new([-2.5; 3], n, depth).unwrap();
        for width in [1e-320, 1e-300, 1e-200, 1e-120, 1e-78, 1e-70, 1e-30] {
            for axis in 0..3 {
                let mut low = [-width; 3];
                let mut high = [width; 3];
                (low[axis], high[axis]) = (-1.25, 1.75);
                // Coordinates below 2^-256 count as zero. Then the rest of the needle has no volume.
                let soup = block(low, high);
                let mesh = mesh(&soup);
                match mesh.triangles() {
                    [] => assert!(width < 1e-77),
                    _ => verify_with("thin", &mesh, &frame, &FILLS),
                }
                let thin = moved(&octahedron([0.0; 3], 1.5), |p| {
                    [0, 1, 2].map(|i| if i == axis { p[i] } else { p[i].signum() * p[i].abs().min(width) })
                });
                let mesh = shapes::mesh(&thin);
                match mesh.triangles() {
                    [] => assert!(width < 1e-77),
                    _ => verify_with("thin octahedron", &mesh, &frame, &FILLS),
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn random_tetrahedra(seed in any::<u64>(), count in 1usize..9, kind in 0..6, depth in 1u8..=5) {
        let mut random = Random(seed);
        let n = (1u32 << depth) as f64;
        let frame = match kind {
            0..=2 => lattice_frame(depth),
            _ => Frame::new([0.1, -7.3, 1e5 / 3.0], 10.0 / 3.0, depth).unwrap(),
        };
        let (origin, cell) = (frame.origin(), frame.cell_size());
        let soup = tetrahedra(&mut random, count, |random| [0, 1, 2].map(|axis| {
            let at = match kind {
                // Half cells, eighths, and any place, some beyond the universe.
                0 | 3 => random.below(2 * n as u64 + 5) as f64 / 2.0 - 1.0,
                1 | 4 => random.below(8 * n as u64 + 17) as f64 / 8.0 - 1.0,
                _ => random.between(-0.2 * n, 1.2 * n),
            };
            origin[axis] + at * cell
        }));
        let mesh = mesh(&soup);
        if !mesh.triangles().is_empty() {
            verify_with("tetrahedra", &mesh, &frame, &FILLS);
        }
    }
}

proptest! {
    #![proptest_config(cases(6))]

    #[test]
    fn random_tetrahedra_in_blocks(seed in any::<u64>(), count in 1usize..12, kind in 0..3) {
        let mut random = Random(seed);
        let frame = lattice_frame(6);
        let soup = tetrahedra(&mut random, count, |random| [0; 3].map(|_: i32| match kind {
            0 => random.below(134) as f64 / 2.0 - 1.0,
            1 => random.below(66 * 8) as f64 / 8.0 - 1.0,
            _ => random.between(-3.0, 67.0),
        }));
        let mesh = mesh(&soup);
        if !mesh.triangles().is_empty() {
            verify_with("tetrahedra in a block", &mesh, &frame, &FILLS);
        }
    }
}

/// Reads a model and closes its hair cracks.
fn read(name: &str) -> Option<TriangleMesh> {
    let path = model(name)?;
    let bytes = std::fs::read(path).unwrap();
    Some(exchange::read_stl(&bytes).unwrap().sewn().unwrap())
}

fn around(mesh: &TriangleMesh, depth: u8) -> Frame {
    let (min, max) = mesh.bounds();
    Frame::around(min, max, depth).unwrap()
}

/// Returns the rules that a mesh allows: one of the models' bodies is not consistently oriented.
fn fills(mesh: &TriangleMesh) -> &'static [FillRule] {
    match mesh.check_closed(FillRule::NonZero) {
        Ok(()) => &FILLS,
        Err(Error::Mesh(MeshError::Unoriented { .. })) => &FILLS[1..],
        Err(error) => panic!("{error}"),
    }
}

/// Compares sampled trees with the oracle, cell by cell. It serves meshes that are too large for all checks.
fn assert_sampled(what: &str, mesh: &TriangleMesh, depth: u8) {
    let frame = around(mesh, depth);
    let windings = Oracle::new(mesh, &frame).windings();
    for &fill in fills(mesh) {
        let solid = MeshSolid::new(mesh.clone(), fill).unwrap();
        let tree = build(&solid, &frame, Rule::Sampled, &Control::default()).unwrap();
        let n = frame.cells();
        for (i, &winding) in windings.iter().enumerate() {
            let i = i as u32;
            let at = [i % n, i / n % n, i / n / n];
            let inside = tree.view().tag_at(at) == Tag::Full;
            assert_eq!(inside, Oracle::inside(fill, winding), "{what} {fill:?} {at:?} winding {winding}");
        }
    }
}

#[test]
fn parts_are_certified_and_converge() {
    for (name, volume) in
        [("featuretype.STL", 11.627733), ("plate_holes.STL", 767_362.112_59), ("angle_block.STL", 1.145_523)]
    {
        let Some(mesh) = read(name) else { return };
        assert!((mesh.volume() / volume - 1.0).abs() < 1e-6);
        let mut before: Option<f64> = None;
        for depth in 6..=10 {
            let frame = around(&mesh, depth);
            let solid = MeshSolid::new(mesh.clone(), FillRule::NonZero).unwrap();
            let tree = |rule| build(&solid, &frame, rule, &Control::default()).unwrap();
            let [certified, sampled, inner, outer] = RULES.map(tree);
            let interval = certified.statistics().volume();
            assert!(interval.lower < volume && volume < interval.upper, "{name} {depth} {interval:?}");
            if let Some(before) = before {
                let ratio = interval.width() / before;
                assert!((0.42..0.62).contains(&ratio), "{name} {depth}: {ratio}");
            }
            before = Some(interval.width());
            // inner ⊆ sampled ⊆ outer, as sets.
            for (a, b) in [(&inner, &sampled), (&sampled, &outer)] {
                let left = difference(a.view(), b.view(), &Control::default()).unwrap();
                assert_eq!(left.view().root_tag(), Tag::Empty, "{name} {depth}");
            }
            assert_eq!(certified.view().exterior(), Tag::Empty);
        }
        assert_sampled(name, &mesh, 7);
        // All claims at once, where affordable.
        verify_with(name, &mesh, &around(&mesh, 5), &FILLS);
        verify_with(name, &mesh, &around(&mesh, 6), &[FillRule::NonZero]);
    }
}

#[test]
fn hard_models_are_sampled_exactly() {
    for (name, depth) in [("busted.STL", 6), ("bunny-closed.stl", 6), ("multibody.stl", 6)] {
        let Some(mesh) = read(name) else { return };
        assert_sampled(name, &mesh, depth);
        let depth = if name == "multibody.stl" { 6 } else { 5 };
        verify_with(name, &mesh, &around(&mesh, depth), fills(&mesh));
    }
}

#[test]
fn models_by_scan_and_by_descent_are_the_same() {
    for (name, depth) in
        [("featuretype.STL", 8), ("plate_holes.STL", 8), ("busted.STL", 7), ("multibody.stl", 8)]
    {
        let Some(mesh) = read(name) else { return };
        for &fill in fills(&mesh) {
            trees(name, &mesh, &around(&mesh, depth), fill);
        }
    }
}

#[test]
fn the_erased_solid_is_the_same() {
    // AnySolid requires content with the program's lifetime.
    let soup = join(&[torus([0.1, 0.2, 0.3], 2.0, 0.7, 40, 24), octahedron([2.0, 0.0, 0.3], 1.1)]);
    let mesh: &'static TriangleMesh = Box::leak(Box::new(mesh(&soup)));
    for depth in [5, 6, 8] {
        let frame = around(mesh, depth);
        for fill in FILLS {
            let solid = || MeshSolid::new(mesh.clone(), fill).unwrap();
            let trees = trees("erased", mesh, &frame, fill);
            let any = AnySolid::new(solid());
            for (rule, tree) in RULES.into_iter().zip(&trees) {
                for threads in [1, 2, 16] {
                    assert!(build(&any, &frame, rule, &Control::threads(threads)).unwrap() == *tree);
                }
            }
        }
    }
}

/// A mesh of overlapping closed pieces, used when no model is at hand.
fn generated() -> TriangleMesh {
    mesh(&join(&[
        torus([0.013, 0.021, 0.034], 2.0, 0.7, 60, 36),
        octahedron([1.9, 0.11, 0.2], 1.3),
        block([-2.7, -0.31, -0.9], [2.3, 0.42, 0.57]),
    ]))
}

fn points_never_contradict(what: &str, mesh: &TriangleMesh, points: usize) {
    let oracle = PointOracle::new(mesh);
    let (min, max) = mesh.bounds();
    for depth in [6, 9] {
        let frame = around(mesh, depth);
        let solid = MeshSolid::new(mesh.clone(), FillRule::NonZero).unwrap();
        let tree = build(&solid, &frame, Rule::Certified, &Control::default()).unwrap();
        let mut random = Random(depth as u64);
        let mut counts = [0usize; 3];
        for i in 0..points {
            let point = if i % 2 == 0 {
                [0, 1, 2].map(|axis| random.between(min[axis], max[axis]))
            } else {
                // A point of a triangle, moved by up to two cells.
                let t = mesh.triangles()[random.below(mesh.triangles().len() as u64) as usize];
                let [a, b, c] = t.map(|v| mesh.vertices()[v as usize]);
                let (u, v) = (random.unit(), random.unit());
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let far = frame.cell_size() * 2.0;
                [0, 1, 2].map(|axis| {
                    let on = a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]);
                    on + random.between(-far, far)
                })
            };
            let answer = tree.view().contains(point);
            counts[answer as usize] += 1;
            let Some(winding) = oracle.winding(point) else { continue };
            let truth = if winding != 0 { Membership::Inside } else { Membership::Outside };
            assert!(
                answer == Membership::Undecided || answer == truth,
                "{what} {depth} {point:?}: {answer:?}"
            );
        }
        // Most points away from the surface are decided.
        assert!(counts.iter().all(|&count| count > points / 100), "{what} {depth}: {counts:?}");
        assert!(counts[2] < points * 3 / 4, "{what} {depth}: {counts:?}");
    }
}

#[test]
fn a_million_points() {
    let mesh = read("featuretype.STL").unwrap_or_else(generated);
    points_never_contradict("a model or a generated mesh", &mesh, 500_000);
    points_never_contradict("generated", &generated(), 50_000);
}

#[test]
fn generated_meshes_are_certified() {
    let mesh = generated();
    for depth in [3, 5, 6] {
        verify_with("generated", &mesh, &around(&mesh, depth), &FILLS);
    }
}

#[test]
fn hair_cracks_keep_every_variant_inside() {
    let base = join(&[octahedron([0.0; 3], 1.0), block([-0.75, -0.5, -0.5], [0.5, 0.25, 0.5])]);
    let mut random = Random(3);
    // Noise at coordinates that are zero, where doubles are fine enough to crack.
    let noisy = |random: &mut Random, noise: f64| -> Soup {
        moved_some(&base, random, |x| if x == 0.0 { noise } else { x })
    };
    for noise in [1e-16, -2e-9] {
        let soup = noisy(&mut random, noise);
        let open = mesh(&soup);
        assert!(matches!(open.check_closed(FillRule::NonZero), Err(Error::Mesh(MeshError::Open { .. }))));
        let sewn = open.sewn().unwrap();
        sewn.check_closed(FillRule::NonZero).unwrap();
        assert_eq!(sewn.displacement(), f64::abs(noise));
        for depth in [4, 6, 7].into_iter().take(repeated(2, 3)) {
            for frame in [
                Frame::new([-1.0; 3], 2.0, depth).unwrap(),
                Frame::new([-1.25 + 0.125 / (1 << depth) as f64; 3], 2.5, depth).unwrap(),
            ] {
                verify_with("sewn", &sewn, &frame, &FILLS);
                let solid = MeshSolid::new(sewn.clone(), FillRule::NonZero).unwrap();
                let tree = |rule| build(&solid, &frame, rule, &alone()).unwrap();
                let (inner, outer) = (tree(Rule::Inner), tree(Rule::Outer));
                // Two ways to close the cracks: keep every noisy coordinate, or none.
                for closed in [base.clone(), moved(&base, |p| p.map(|x| if x == 0.0 { noise } else { x }))] {
                    let closed = mesh(&closed);
                    let solid = MeshSolid::new(closed.clone(), FillRule::NonZero).unwrap();
                    let tree = |rule| build(&solid, &frame, rule, &alone()).unwrap();
                    let within = |a: &Octree, b: &Octree| {
                        let left = difference(a.view(), b.view(), &alone()).unwrap();
                        left.view().root_tag() == Tag::Empty
                    };
                    // The closed meshes must not contradict the proofs.
                    assert!(within(&inner, &tree(Rule::Sampled)), "{noise} {depth}");
                    assert!(within(&tree(Rule::Sampled), &outer), "{noise} {depth}");
                    assert!(within(&inner, &tree(Rule::Inner)), "{noise} {depth}");
                    assert!(within(&tree(Rule::Outer), &outer), "{noise} {depth}");
                }
            }
        }
    }
}

/// Changes the coordinates of every third facet.
fn moved_some(soup: &Soup, random: &mut Random, f: impl Fn(f64) -> f64) -> Soup {
    let pick = random.below(3) as usize;
    let change = |(i, facet): (usize, &[[f64; 3]; 3])| {
        if i % 3 == pick { facet.map(|p| p.map(&f)) } else { *facet }
    };
    soup.iter().enumerate().map(change).collect()
}

#[test]
fn meshes_that_bound_nothing_are_refused() {
    let frame = lattice_frame(4);
    let refusal = |soup: &Soup, fill| {
        let mesh = mesh(soup);
        match MeshSolid::new(mesh.clone(), fill) {
            Ok(_) => None,
            Err(Error::Mesh(error)) => Some(error),
            Err(error) => panic!("{error}"),
        }
    };
    let whole = block([2.0; 3], [9.0; 3]);
    for fill in FILLS {
        assert_eq!(refusal(&whole, fill), None);
        assert_eq!(refusal(&Soup::new(), fill), Some(MeshError::Empty));
        assert_eq!(refusal(&vec![[[1.0; 3], [1.0; 3], [2.0; 3]]], fill), Some(MeshError::Empty));
        // Where the winding number decides, open surfaces bound something, too.
        let expected = (fill == FillRule::EvenOdd).then_some(MeshError::Open { edges: 3 });
        assert_eq!(refusal(&whole[1..].to_vec(), fill), expected);
    }
    let mut turned = whole.clone();
    turned[4].swap(0, 1);
    assert_eq!(
        mesh(&turned).check_closed(FillRule::NonZero).unwrap_err().to_string(),
        MeshError::Unoriented { edges: 3 }.to_string()
    );
    for fill in FILLS {
        assert_eq!(refusal(&turned, fill), None);
    }
    // Which way the triangles face does not matter then.
    let other = Frame::new([0.3; 3], 11.0, 6).unwrap();
    for frame in [frame, other] {
        let [whole, turned] = [&whole, &turned].map(|soup| {
            let mesh = mesh(soup);
            trees("turned", &mesh, &frame, FillRule::EvenOdd)
        });
        assert!(whole == turned);
        verify_with("turned", &mesh(&block([2.0; 3], [9.0; 3])), &frame, &[FillRule::EvenOdd]);
    }
    // One solid serves any frame.
    let mesh = mesh(&whole);
    let solid = MeshSolid::new(mesh.clone(), FillRule::NonZero).unwrap();
    for frame in [frame, other, frame] {
        for (rule, tree) in RULES.into_iter().zip(trees("another frame", &mesh, &frame, FillRule::NonZero)) {
            assert!(build(&solid, &frame, rule, &alone()).unwrap() == tree);
        }
    }
}
