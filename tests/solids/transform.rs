//! Solids under affine maps: verdicts against exact arithmetic, and maps of the lattice onto itself, which
//! must lose nothing.

use leafless::lattice::{Cube, CubeMoments};
use leafless::op::Zone;
use leafless::solid::{Ask, Crossing, Segment, Transform};
use leafless::{
    Affine, AnySolid, Cell, Classifier, Control, Csg, Error, FillRule, Frame, LazyOctree, MeshSolid, Rule,
    Solid, Tag, Verdict, Worker, build, measure,
};
use leafless_testkit::exact::Exact;
use leafless_testkit::{Dense, Random, alone, lattice_frame, positions, shapes};
use proptest::prelude::*;
use std::f64::consts::PI;

/// The exact image of a box under a map.
struct Placed {
    rows: [[Exact; 4]; 3],
    min: [f64; 3],
    max: [f64; 3],
}

type Vector = [Exact; 3];

fn dot(a: &Vector, b: &Vector) -> Exact {
    (0..3).fold(Exact::from(0.0), |sum, i| sum.plus(&a[i].times(&b[i])))
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j].times(&b[k]).minus(&a[k].times(&b[j]))
    })
}

fn difference(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|i| a[i].minus(&b[i]))
}

impl Placed {
    fn new(placement: &Affine, min: [f64; 3], max: [f64; 3]) -> Placed {
        Placed { rows: placement.rows().map(|row| row.map(Exact::from)), min, max }
    }

    fn column(&self, j: usize) -> Vector {
        [0, 1, 2].map(|i| self.rows[i][j].clone())
    }

    fn corners(&self) -> Vec<Vector> {
        (0..8)
            .map(|k| {
                let p = [0, 1, 2]
                    .map(|axis| Exact::from(if k >> axis & 1 == 0 { self.min } else { self.max }[axis]));
                [0, 1, 2].map(|i| {
                    let [x, y, z, t] = &self.rows[i];
                    x.times(&p[0]).plus(&y.times(&p[1])).plus(&z.times(&p[2])).plus(t)
                })
            })
            .collect()
    }

    /// True if a point lies in the box or on it, by Cramer's rule without a division.
    fn contains(&self, point: &Vector) -> bool {
        let [a, b, c] = [self.column(0), self.column(1), self.column(2)];
        let determinant = dot(&a, &cross(&b, &c));
        let moved = difference(point, &self.column(3));
        let sign = determinant.sign();
        [cross(&b, &c), cross(&c, &a), cross(&a, &b)].iter().enumerate().all(|(axis, normal)| {
            let coordinate = dot(normal, &moved);
            let low = coordinate.minus(&determinant.times(&Exact::from(self.min[axis])));
            let high = determinant.times(&Exact::from(self.max[axis])).minus(&coordinate);
            low.sign() * sign >= 0 && high.sign() * sign >= 0
        })
    }

    /// True if a plane separates the box from these corners of a cube.
    fn is_apart(&self, cube: &[Vector]) -> bool {
        let own = self.corners();
        let columns = [0, 1, 2].map(|j| self.column(j));
        let axes = [0, 1, 2].map(|i| [0, 1, 2].map(|j| Exact::from((i == j) as u8 as f64)));
        let mut directions: Vec<Vector> = axes.to_vec();
        directions.extend((0..3).map(|j| cross(&columns[(j + 1) % 3], &columns[(j + 2) % 3])));
        directions.extend(axes.iter().flat_map(|axis| columns.iter().map(|column| cross(axis, column))));
        directions.iter().any(|direction| {
            let range = |points: &[Vector]| {
                let along: Vec<Exact> = points.iter().map(|point| dot(direction, point)).collect();
                let low = along.iter().cloned().reduce(Exact::min).unwrap();
                (low, along.into_iter().reduce(Exact::max).unwrap())
            };
            let ((a, b), (c, d)) = (range(&own), range(cube));
            b.minus(&c).sign() <= 0 || d.minus(&a).sign() <= 0
        })
    }

    /// True if a cell's tag agrees with the box.
    fn agrees(&self, frame: &Frame, at: [u32; 3], tag: Tag) -> bool {
        let corners: Vec<Vector> = (0..8u32)
            .map(|k| [0, 1, 2].map(|axis| Exact::plane(frame, axis, at[axis] + (k >> axis & 1))))
            .collect();
        match tag {
            Tag::Full => corners.iter().all(|corner| self.contains(corner)),
            Tag::Empty => self.is_apart(&corners),
            _ => true,
        }
    }
}

/// Arbitrary maps, and maps of short numbers that take faces to lattice planes.
fn placement(random: &mut Random) -> Affine {
    const TURNS: [[[f64; 3]; 3]; 4] = [
        [[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]],
        [[1.0, 0.0, 0.0], [0.0, 0.28, -0.96], [0.0, 0.96, 0.28]],
        [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [0.0, 0.25, -1.0]],
    ];
    loop {
        let rows = if random.below(2) == 0 {
            [0; 3].map(|_| {
                let t = random.between(-2.0, 2.0);
                let mut entry = || random.between(-1.5, 1.5);
                [entry(), entry(), entry(), t]
            })
        } else {
            let turn = TURNS[random.below(4) as usize];
            [0, 1, 2].map(|i| {
                let [x, y, z] = turn[i];
                [x, y, z, (random.below(17) as f64 - 8.0) / 4.0]
            })
        };
        if let Ok(placement) = Affine::new(rows) {
            return placement;
        }
    }
}

#[test]
fn what_is_proven_of_a_placed_box_is_true() {
    let mut random = Random(1);
    let (mut decided, mut full) = (0, 0);
    for case in 0..120 {
        let placement = placement(&mut random);
        let corner = [0; 3].map(|_| (random.below(9) as f64 - 8.0) / 8.0);
        let extent = [0; 3].map(|_| (1 + random.below(12)) as f64 / 8.0);
        let max = [0, 1, 2].map(|axis| corner[axis] + extent[axis]);
        let own = match random.below(3) {
            0 => Frame::new([-2.0; 3], 4.0, 6).unwrap(),
            1 => Frame::around(corner, max, 5).unwrap(),
            _ => Frame::new([-1.7, -1.9, -1.6], 5.1, 9).unwrap(),
        };
        let frame = match random.below(3) {
            0 => Frame::new([-4.0; 3], 8.0, 5).unwrap(),
            1 => Frame::new([-2.0; 3], 4.0, 5).unwrap(),
            _ => Frame::new([-3.3, -3.1, -3.7], 7.0, 5).unwrap(),
        };
        let solid = Transform::new(Csg::cuboid(corner, max).unwrap(), &own, &placement);
        let tree = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
        let dense = Dense::of(tree.view());
        let exact = Placed::new(&placement, corner, max);
        let cells: Vec<[u32; 3]> = positions(5)
            .filter(|&at| is_next_to_another(&dense, at) && dense.at(at) != Tag::Partial)
            .collect();
        for _ in 0..60.min(cells.len()) {
            let at = cells[random.below(cells.len() as u64) as usize];
            let tag = dense.at(at);
            assert!(
                exact.agrees(&frame, at, tag),
                "case {case}: {at:?} is not {tag:?}: {placement:?} {corner:?} {max:?}"
            );
            decided += 1;
            full += (tag == Tag::Full) as usize;
        }
    }
    assert!(decided > 5000 && full > 200, "{decided} {full}");
}

fn is_next_to_another(dense: &Dense, at: [u32; 3]) -> bool {
    (0..3).any(|axis| {
        [-1i32, 1].iter().any(|step| {
            let mut next = at;
            next[axis] = next[axis].wrapping_add_signed(*step);
            next[axis] < 1 << dense.depth && dense.at(next) != dense.at(at)
        })
    })
}

#[test]
fn volumes_contain_the_truth_and_close_in_on_it() {
    let mut random = Random(2);
    for _ in 0..20 {
        let placement = placement(&mut random);
        let m = placement.rows();
        let determinant = (0..3)
            .map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                m[0][i] * (m[1][j] * m[2][k] - m[1][k] * m[2][j])
            })
            .sum::<f64>()
            .abs();
        let ball = Csg::ball([0.25, 0.0, -0.125], 0.75).unwrap();
        let truth = determinant * 4.0 / 3.0 * PI * 0.75f64.powi(3);
        let own = Frame::new([-1.0; 3], 2.0, 12).unwrap();
        let solid = Transform::new(ball, &own, &placement);
        let mut widths = Vec::new();
        for depth in [3, 5, 7] {
            let frame = Frame::new([-6.0; 3], 12.0, depth).unwrap();
            let tree = build(&solid, &frame, Rule::Certified, &Control::default()).unwrap();
            let volume = tree.statistics().volume();
            assert!(volume.contains(truth), "{volume:?} {truth} {placement:?}");
            assert_eq!(tree.view().exterior(), Tag::Empty);
            widths.push(volume.width());
        }
        assert!(widths[2] < 0.5 * widths[1] && widths[1] < 0.7 * widths[0], "{widths:?} {placement:?}");
    }
}

/// A map of the lattice onto itself. It gives the source of cell `at` of a universe of 2^depth cells, times
/// 2^scale.
#[derive(Debug, Clone, Copy)]
struct Move {
    axes: [usize; 3],
    signs: [i64; 3],
    scale: i32,
    offset: [i64; 3],
}

impl Move {
    fn random(random: &mut Random, reach: i64) -> Move {
        let axes =
            [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]][random.below(6) as usize];
        let signs = [0; 3].map(|_| if random.below(2) == 0 { 1 } else { -1 });
        let offset = [0; 3].map(|_| random.below(4 * reach as u64 + 1) as i64 - 2 * reach);
        Move { axes, signs, scale: random.below(3) as i32 - 1, offset }
    }

    fn affine(&self) -> Affine {
        Affine::new([0, 1, 2].map(|i| {
            let mut row = [0.0; 4];
            row[self.axes[i]] = self.signs[i] as f64 * 2f64.powi(self.scale);
            row[3] = self.offset[i] as f64;
            row
        }))
        .unwrap()
    }

    /// Returns the range of source coordinates of the cell at `at`, in quarters of a cell.
    fn source(&self, at: [u32; 3]) -> [(i64, i64); 3] {
        let mut ranges = [(0, 0); 3];
        for i in 0..3 {
            let planes = [at[i] as i64, at[i] as i64 + 1].map(|plane| {
                let quarters = 4 * self.signs[i] * (plane - self.offset[i]);
                if self.scale >= 0 { quarters >> self.scale } else { quarters << -self.scale }
            });
            ranges[self.axes[i]] = (planes[0].min(planes[1]), planes[0].max(planes[1]));
        }
        ranges
    }

    /// Returns the image of a dense array. A cell is undecided only if it touches cells that differ or that
    /// are undecided.
    fn apply(&self, dense: &Dense, exterior: Tag) -> Dense {
        Dense::from_fn(dense.depth, |at| {
            let ranges = self.source(at).map(|(low, high)| (low.div_euclid(4), (high + 3).div_euclid(4)));
            let mut tags = Vec::new();
            for x in ranges[0].0..ranges[0].1 {
                for y in ranges[1].0..ranges[1].1 {
                    for z in ranges[2].0..ranges[2].1 {
                        let inside = [x, y, z].iter().all(|a| (0..1 << dense.depth).contains(a));
                        tags.push(if inside { dense.at([x, y, z].map(|a| a as u32)) } else { exterior });
                    }
                }
            }
            if tags.iter().all(|&tag| tag == tags[0]) { tags[0] } else { Tag::Partial }
        })
    }
}

proptest! {
    #![proptest_config(leafless_testkit::cases(150))]

    #[test]
    fn maps_of_the_lattice_lose_nothing(shape in shapes(1..=4), seed: u64, outside in 0..3usize) {
        let dense = shape.dense();
        let exterior = leafless_testkit::TAGS[outside];
        let tree = dense.octree_with(exterior, &alone()).unwrap();
        let frame = lattice_frame(dense.depth);
        let mut random = Random(seed);
        for _ in 0..4 {
            let step = Move::random(&mut random, 1 << dense.depth);
            let solid = Transform::new(&tree, &frame, &step.affine());
            let moved = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
            prop_assert_eq!(Dense::of(moved.view()), step.apply(&dense, exterior), "{:?}", step);
        }
    }

    #[test]
    fn centres_are_where_they_were(shape in shapes(1..=4), seed: u64) {
        // Binary trees: every centre can be decided, even if a map takes it onto a face.
        let dense = shape.dense().resolved(Tag::Full);
        let tree = dense.octree();
        let frame = lattice_frame(dense.depth);
        let mut random = Random(seed);
        for _ in 0..4 {
            let step = Move::random(&mut random, 1 << dense.depth);
            let moved = build(&Transform::new(&tree, &frame, &step.affine()), &frame, Rule::Sampled, &alone()).unwrap();
            let expected = Dense::from_fn(dense.depth, |at| {
                let ranges = step.source(at);
                // The middle, in eighths. On a plane it goes with the shift, whose direction the signs may
                // reverse.
                let middle = [0, 1, 2].map(|axis| ranges[axis].0 + ranges[axis].1);
                let cell = [0, 1, 2].map(|axis| {
                    let sign = (0..3).find(|&i| step.axes[i] == axis).map(|i| step.signs[i]).unwrap();
                    if sign > 0 { middle[axis].div_euclid(8) } else { (middle[axis] - 1).div_euclid(8) }
                });
                let inside = cell.iter().all(|a| (0..1 << dense.depth).contains(a));
                if inside { dense.at(cell.map(|a| a as u32)) } else { Tag::Empty }
            });
            prop_assert_eq!(Dense::of(moved.view()), expected, "{:?}", step);
        }
    }
}

#[test]
fn an_offset_of_whole_cells_keeps_the_centres_of_any_solid() {
    let own = Frame::new([-8.0; 3], 16.0, 5).unwrap();
    let ball = Csg::ball([0.25, -0.5, 0.0], 5.25).unwrap();
    let tree = build(&ball, &own, Rule::Sampled, &alone()).unwrap();
    let placement = Affine::translation([1.5, -2.0, 0.5]).unwrap();
    let solid = Transform::new(&ball, &own, &placement);
    let moved = build(&solid, &own, Rule::Sampled, &alone()).unwrap();
    let stored = build(&Transform::new(&tree, &own, &placement), &own, Rule::Certified, &alone()).unwrap();
    assert_eq!(Dense::of(moved.view()), Dense::of(stored.view()));
    assert_eq!(moved.statistics().volume(), tree.statistics().volume());
    // A rotated ball is undecided.
    let turn = Affine::new([[0.6, -0.8, 0.0, 0.0], [0.8, 0.6, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
    let solid = Transform::new(ball, &own, &turn);
    assert!(matches!(build(&solid, &own, Rule::Sampled, &alone()), Err(Error::NotSampled)));
    // A rotated octree without undecided cells decides.
    let solid = Transform::new(&tree, &own, &turn);
    let turned = build(&solid, &own, Rule::Sampled, &alone()).unwrap();
    let (before, after) = (tree.statistics().volume(), turned.statistics().volume());
    assert!((before.lower - after.lower).abs() < 0.02 * before.lower, "{before:?} {after:?}");
}

#[test]
fn threads_and_erasure_change_nothing() {
    let own = Frame::new([-1.0; 3], 2.0, 9).unwrap();
    let frame = Frame::new([-2.0, -2.5, -1.5], 4.5, 8).unwrap();
    let placement =
        Affine::new([[0.7, -0.4, 0.1, 0.2], [0.3, 0.9, -0.2, 0.0], [0.1, 0.2, 1.1, 0.3]]).unwrap();
    let ball = build(&Csg::ball([0.0; 3], 0.9).unwrap(), &own, Rule::Certified, &alone()).unwrap();
    let solid = Transform::new(ball, &own, &placement);
    let one = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
    let many = build(&solid, &frame, Rule::Certified, &Control::threads(4)).unwrap();
    assert!(one == many);
    // A transform of a transform, behind one type.
    let outer = Affine::translation([0.25, 0.0, -0.5]).unwrap();
    let any = AnySolid::new(Transform::new(AnySolid::new(solid), &frame, &outer));
    let one = build(&any, &frame, Rule::Certified, &alone()).unwrap();
    let many = build(&any, &frame, Rule::Certified, &Control::threads(3)).unwrap();
    assert!(one == many);
    assert!(one.statistics().volume().contains(4.0 / 3.0 * PI * 0.729 * 0.858));
}

#[test]
fn what_lies_outside_of_the_own_universe_is_known_as_the_solid_tells() {
    let own = Frame::new([0.0; 3], 1.0, 4).unwrap();
    let frame = Frame::new([-2.0; 3], 4.0, 4).unwrap();
    // A half-space continues outside, where nothing is known.
    let half = Csg::half_space([1.0, 0.0, 0.0], -0.5).unwrap();
    let tree =
        build(&Transform::new(half, &own, &Affine::IDENTITY), &frame, Rule::Certified, &alone()).unwrap();
    assert_eq!(tree.view().tag_at([0, 0, 0]), Tag::Partial);
    assert_eq!(tree.view().tag_at([8, 8, 8]), Tag::Empty);
    assert_eq!(tree.view().tag_at([11, 8, 8]), Tag::Full);
    assert_eq!(tree.view().exterior(), Tag::Partial);
    // A box ends inside.
    let cube = Csg::cuboid([0.25; 3], [0.75; 3]).unwrap();
    let tree =
        build(&Transform::new(&cube, &own, &Affine::IDENTITY), &frame, Rule::Certified, &alone()).unwrap();
    assert_eq!(tree.statistics().volume(), leafless::Interval::exactly(0.125));
    assert_eq!(tree.view().exterior(), Tag::Empty);
    // The frame clips the parts that stick out.
    let away = Affine::translation([1.5, 0.0, 0.0]).unwrap();
    let tree = build(&Transform::new(&cube, &own, &away), &frame, Rule::Certified, &alone()).unwrap();
    assert_eq!(tree.view().exterior(), Tag::Partial);
}

#[test]
fn extreme_numbers_prove_nothing_wrong() {
    let own = Frame::new([-2f64.powi(255); 3], 2f64.powi(256), 6).unwrap();
    let tiny = Frame::new([2f64.powi(-256); 3], 2f64.powi(-250), 6).unwrap();
    let large = 2f64.powi(64);
    let squeeze =
        Affine::new([[large, 0.0, 0.0, 1.0], [0.0, 1.0 / large, 0.0, large], [1.0, 0.0, 1.0, 0.0]]).unwrap();
    for (from, to) in [(&own, &tiny), (&tiny, &own), (&own, &own), (&tiny, &tiny)] {
        for placement in [&squeeze, &Affine::IDENTITY] {
            let cube = Csg::cuboid(from.origin(), from.origin().map(|c| c + 0.5 * from.edge())).unwrap();
            let solid = Transform::new(cube, from, placement);
            let tree = build(&solid, to, Rule::Certified, &alone()).unwrap();
            let exact = Placed::new(placement, from.origin(), from.origin().map(|c| c + 0.5 * from.edge()));
            for at in positions(6).step_by(997) {
                assert!(exact.agrees(to, at, tree.view().tag_at(at)), "{at:?} {from:?} {to:?}");
            }
        }
    }
}

/// The inverse image of the universe began beyond the numbers that a frame may have. The error once named an
/// origin that no caller had given.
#[test]
fn a_universe_at_the_end_of_all_numbers_is_refused_for_the_placement() {
    let frame = Frame::new([-1.0, 2f64.powi(256), 2.5], 2f64.powi(-20), 1).unwrap();
    let turn = [[0.0, 1.0, 0.0, -1.625], [-1.0, 0.0, 0.0, -1.5], [0.0, 0.0, -1.0, 0.0625]];
    let nothing = Csg::ball([0.0; 3], 1.0).unwrap().complement();
    let moved = Transform::of(nothing, &Affine::new(turn).unwrap());
    let found = build(&moved, &frame, Rule::Certified, &alone());
    assert!(matches!(found, Err(Error::Argument { name: "placement", .. })), "{:?}", found.err());
}

/// Gathering each cell that may contain a centre once took all memory, because rounding errors spanned
/// thousands of cells.
#[test]
fn cells_far_smaller_than_rounding_errors_are_not_gathered() {
    let own = Frame::new([-2.0; 3], 4.0, 20).unwrap();
    let far = 1e13;
    let placement = Affine::new([[0.8, -0.6, 0.0, far], [0.6, 0.8, 0.0, far], [0.0, 0.0, 1.0, far]]).unwrap();
    let solid = Transform::new(Csg::ball([0.0; 3], 1.0).unwrap(), &own, &placement);
    let frame = Frame::new([far - 2.0; 3], 4.0, 4).unwrap();
    let certified = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
    let volume = certified.statistics().volume();
    assert!(volume.lower > 0.0 && volume.contains(4.0 / 3.0 * PI), "{volume:?}");
    assert!(matches!(build(&solid, &frame, Rule::Sampled, &alone()), Err(Error::NotSampled)));
}

/// Planes of the frame lie next to planes of the solid's lattice, so near that sums of their coordinates are
/// rounded.
#[test]
fn what_rounds_is_not_taken_for_exact() {
    let size = 256.0 - 2f64.powi(-32);
    let origin = 2f64.powi(14) - (2f64.powi(28) - 2f64.powi(-12));
    let frame = Frame::new([origin; 3], size * 2f64.powi(20), 20).unwrap();
    let own = Frame::new([0.0; 3], 2f64.powi(14), 14).unwrap();
    for j in 1..64 {
        let max = [16384.0 - 256.0 * (j - 1) as f64, 16384.0, 16384.0];
        let solid = Transform::new(Csg::cuboid([0.0; 3], max).unwrap(), &own, &Affine::IDENTITY);
        let at = [(1 << 20) - j; 3];
        let middle = origin + (at[0] as f64 + 0.5) * size;
        let mut lazy = LazyOctree::new(&solid, &frame).unwrap();
        lazy.refine(&Zone::Point([middle; 3]), 20, &alone()).unwrap();
        let tag = lazy.tag(Cell { level: 20, at });
        let exact = Placed::new(&Affine::IDENTITY, [0.0; 3], max);
        assert!(exact.agrees(&frame, at, tag), "{j}: {tag:?}");
    }
}

#[test]
fn centres_on_the_faces_of_the_own_universe_are_decided() {
    let own = Frame::new([0.0; 3], 1.0, 4).unwrap();
    let cube = Csg::cuboid([0.0; 3], [1.0; 3]).unwrap();
    let mirror = Affine::new([[-1.0, 0.0, 0.0, 1.0], [0.0, -1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
    // All cells at the cube's surface have their centres on it.
    let frame = Frame::new([-0.5625; 3], 2.0, 4).unwrap();
    for placement in [Affine::IDENTITY, mirror] {
        let tree = build(&Transform::new(&cube, &own, &placement), &frame, Rule::Sampled, &alone()).unwrap();
        let truth = build(&cube, &frame, Rule::Sampled, &alone()).unwrap();
        assert_eq!(Dense::of(tree.view()), Dense::of(truth.view()), "{placement:?}");
    }
}

/// A part with flat, curved and edged faces.
fn part() -> Csg {
    let block = Csg::cuboid([-0.53, -0.39, -0.27], [0.51, 0.38, 0.26]).unwrap();
    block.difference(&Csg::ball([0.4, 0.3, 0.2], 0.3).unwrap()).unwrap()
}

/// Numbers of cells that provide enclosures, moments, areas and crossings.
type Told = [u32; 4];

#[test]
fn maps_of_the_lattice_hand_on_exactly_what_is_known_of_cells() {
    let told = handed_on(&part());
    assert!(told[0] > 200 && told[1] > 50 && told[2] > 200, "{told:?}");
    let tree = build(&part(), &Frame::new([-1.0; 3], 2.0, 4).unwrap(), Rule::Sampled, &alone()).unwrap();
    let mesh = leafless::marching_cubes(tree.view(), None, &alone()).unwrap();
    let told = handed_on(&MeshSolid::new(mesh, FillRule::NonZero).unwrap());
    assert!(told.iter().all(|&told| told > 50), "{told:?}");
}

/// Descends a moved and an unmoved solid together, from cells to the cells whose images they are.
fn handed_on<S: Solid + Clone>(solid: &S) -> Told {
    let mut told = [0; 4];
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    for (rows, scale) in [
        ([[0.0, -1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]], 1.0),
        ([[0.0, 0.0, 2.0, 0.0], [-2.0, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 0.0]], 0.5),
    ] {
        let own = Frame::new([-scale; 3], 2.0 * scale, 5).unwrap();
        let map = Affine::new(rows).unwrap();
        let moved = Transform::new(solid.clone(), &own, &map);
        let mut outer = moved.on(&frame, &alone()).unwrap().worker().unwrap();
        let mut inner = solid.on(&own, &alone()).unwrap().worker().unwrap();
        let (Verdict::Partial(a), Verdict::Partial(b)) = (outer.root().unwrap(), inner.root().unwrap())
        else {
            panic!("decided");
        };
        // The child that the inverse of the map gives.
        let source = |cell: Cell| {
            let last = (1i64 << cell.level) - 1;
            let at = [0, 1, 2].map(|j| {
                let (i, c) = (0..3).map(|i| (i, rows[i][j])).find(|(_, c)| *c != 0.0).unwrap();
                if c > 0.0 { cell.at[i] } else { (last - cell.at[i] as i64) as u32 }
            });
            Cell { level: cell.level, at }
        };
        let sign = |i: usize, j: usize| rows[i][j].signum() * (rows[i][j] != 0.0) as u8 as f64;
        let turned = |n: [f64; 3]| [0, 1, 2].map(|i| (0..3).map(|j| sign(i, j) * n[j]).sum::<f64>());
        let mut open = vec![(Cell::ROOT, a, b)];
        while let Some((cell, a, b)) = open.pop() {
            let found = outer.enclosure(cell, &a).unwrap();
            let known = inner.enclosure(source(cell), &b).unwrap();
            told[0] += known.is_some() as u32;
            // n · y = n · (P x) = (Pᵀ n) · x.
            let expected = known.map(|mut known| {
                known.slabs.iter_mut().for_each(|slab| slab.normal = turned(slab.normal));
                known
            });
            assert_eq!(found, expected, "{cell:?}");
            // M becomes S M Sᵀ.
            let known = inner.moments(source(cell), &b).unwrap();
            told[1] += known.is_some() as u32;
            let expected = known.map(|mut known| {
                let CubeMoments { first, second: [xx, yy, zz, xy, xz, yz], .. } = known.moments;
                let matrix = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
                let half = matrix.map(turned);
                let columns = [0, 1, 2].map(|j| turned(half.map(|row| row[j])));
                known.moments.first = turned(first);
                known.moments.second =
                    [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|(i, j)| columns[j][i]);
                known
            });
            assert_eq!(outer.moments(cell, &a).unwrap(), expected, "{cell:?}");
            let known = inner.area(source(cell), &b).unwrap();
            told[2] += known.is_some() as u32;
            assert_eq!(outer.area(cell, &a).unwrap(), known, "{cell:?}");
            // Along the diagonals of the cell. The ends are doubles.
            let (min, max) = Cube { frame: &frame, cell }.bounds();
            for k in 0..4 {
                let end =
                    |k: u32| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { min[axis] } else { max[axis] });
                let [from, to] = [k, 7 - k].map(end);
                let back = map.inverse().unwrap();
                let own_segment = Segment { from: back.apply(from), to: back.apply(to) };
                let known = inner.crossing(source(cell), &b, &own_segment).unwrap();
                told[3] += known.is_some() as u32;
                let expected = known.map(|known| Crossing { normal: turned(known.normal), ..known });
                assert_eq!(outer.crossing(cell, &a, &Segment { from, to }).unwrap(), expected, "{cell:?}");
            }
            if cell.level == 5 {
                continue;
            }
            let children = outer.split(cell, &a).unwrap();
            let own = inner.split(source(cell), &b).unwrap();
            for (octant, child) in (0..8).zip(children) {
                let child_cell = cell.child(octant);
                let at = source(child_cell).at.map(|c| c & 1);
                let other = own[(at[0] | at[1] << 1 | at[2] << 2) as usize].clone();
                assert_eq!(child.tag(), other.tag());
                if let (Verdict::Partial(a), Verdict::Partial(b)) = (child, other) {
                    open.push((child_cell, a, b));
                }
            }
        }
    }
    told
}

#[test]
fn measures_of_what_is_moved_converge_with_the_number_of_splits() {
    let turn =
        Affine::new([[0.36, 0.48, -0.8, 0.1], [-0.8, 0.6, 0.0, 0.2], [0.48, 0.64, 0.6, -0.1]]).unwrap();
    let frame = Frame::new([-1.5; 3], 3.0, 20).unwrap();
    let ball = 4.0 / 3.0 * PI * 0.75f64.powi(3);
    let shear = Affine::new([[1.0, 0.3, 0.0, 0.1], [0.0, 1.0, 0.0, -0.2], [0.0, 0.1, 0.5, 0.0]]).unwrap();
    for (name, csg, map, truth, allowed) in [
        ("turned ball", Csg::ball([0.0; 3], 0.75).unwrap(), turn, ball, 3.0),
        ("sheared ball", Csg::ball([0.0; 3], 0.75).unwrap(), shear, 0.5 * ball, 3.0),
        ("turned block", Csg::cuboid([-0.7, -0.5, -0.3], [0.7, 0.5, 0.3]).unwrap(), turn, 1.4 * 0.6, 1.5),
    ] {
        let mut products = Vec::new();
        for tolerance in [1e-1, 1e-2, 1e-3] {
            let solid = Transform::of(csg.clone(), &map);
            let found = measure(&solid, &frame, tolerance, &alone()).unwrap();
            let width = found.volume.width() / truth;
            println!("{name}, {tolerance:e}: {width:.2e} with {} splits", found.splits);
            assert!(found.volume.contains(truth) && width <= 1.01 * tolerance, "{found:?}");
            products.push(width * found.splits as f64);
        }
        assert!(products[2] < allowed * products[0], "{name}: {products:?}");
    }
}

/// Octrees of samples, sampled again on rotated, coarser and finer lattices.
#[test]
fn nearest_cells_decide_every_centre() {
    let frame = lattice_frame(6);
    let (middle, edge) = (frame.origin().map(|c| c + 0.5 * frame.edge()), frame.edge());
    let ball = Csg::ball(middle, 0.3 * edge).unwrap();
    let volume = 4.0 / 3.0 * PI * (0.3 * edge).powi(3);
    let control = Control::default();
    let tree = build(&ball, &frame, Rule::Sampled, &control).unwrap();
    let [x, y, _] = middle;
    // By 30 degrees around the axis through the middle.
    let (sin, cos) = (0.5, 0.75f64.sqrt());
    let turned = Affine::new([
        [cos, -sin, 0.0, x - cos * x + sin * y],
        [sin, cos, 0.0, y - sin * x - cos * y],
        [0.0, 0.0, 1.0, 0.0],
    ])
    .unwrap();
    let shifted = Affine::translation([0.5 * frame.cell_size(), 0.0, 0.0]).unwrap();
    for placement in [Affine::IDENTITY, turned, shifted] {
        let plain = Transform::of(tree.clone(), &placement);
        let nearest = Transform::of(tree.clone(), &placement).nearest();
        for depth in [4, 5, 6, 7] {
            let onto = frame.with_depth(depth).unwrap();
            let moved = build(&nearest, &onto, Rule::Sampled, &control).unwrap();
            assert!(moved.view().is_binary() && !moved.proof().full && !moved.proof().empty);
            let found = moved.statistics().volume().lower;
            assert!((found / volume - 1.0).abs() < 0.03, "{placement:?} {depth}: {found} {volume}");
            // Where the plain transform decides, both give the same.
            match build(&plain, &onto, Rule::Sampled, &control) {
                Ok(same) => assert_eq!(same, moved),
                Err(error) => assert!(matches!(error, Error::NotSampled), "{error}"),
            }
            // Cells are those of the plain transform.
            let certified = |solid| build(solid, &onto, Rule::Certified, &control).unwrap();
            assert_eq!(certified(&nearest), certified(&plain));
        }
    }
    // A failed case: a lattice twice as coarse under a map that rounds.
    let coarse = frame.with_depth(5).unwrap();
    let refused = build(&Transform::of(tree.clone(), &turned), &coarse, Rule::Sampled, &control);
    assert!(matches!(refused, Err(Error::NotSampled)));
    // Cells that are undecided stay so.
    let open = build(&ball, &frame, Rule::Certified, &control).unwrap();
    let nearest = Transform::of(open, &turned).nearest();
    assert!(matches!(build(&nearest, &coarse, Rule::Sampled, &control), Err(Error::NotSampled)));
}

/// Compares each centre with the cell that contains its inverse image, looked up one by one.
#[test]
fn nearest_cells_are_those_that_hold_the_inverse_image() {
    let own = Frame::new([0.0; 3], 8.0, 4).unwrap();
    let onto = Frame::new([-3.0, 1.0, 0.0], 16.0, 4).unwrap();
    let tree = build(&Csg::ball([3.7, 4.2, 4.4], 3.1).unwrap(), &own, Rule::Sampled, &Control::default());
    let tree = tree.unwrap();
    let placement = Affine::new([[0.8, -0.6, 0.0, 3.1], [0.6, 0.8, 0.0, 1.7], [0.1, 0.0, 1.1, 0.3]]).unwrap();
    let back = placement.inverse().unwrap();
    let moved = Transform::of(tree.clone(), &placement).nearest();
    let moved = build(&moved, &onto, Rule::Sampled, &Control::default()).unwrap();
    let mut inside = 0;
    for i in 0..4096u32 {
        let cell = [i & 15, i >> 4 & 15, i >> 8];
        let centre = [0, 1, 2].map(|axis| onto.origin()[axis] + f64::from(cell[axis]) + 0.5);
        let image = back.apply(centre);
        // Rounding decides images in planes of the lattice.
        if image.iter().any(|x| (2.0 * x - (2.0 * x).round()).abs() < 1e-9) {
            continue;
        }
        let source = own.cell_of(image);
        let expected = source.map_or(Tag::Empty, |source| tree.view().tag_at(source));
        assert_eq!(moved.view().tag_at(cell), expected, "{cell:?}");
        inside += u32::from(expected == Tag::Full);
    }
    assert!(inside > 100);
}
