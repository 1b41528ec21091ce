//! Constructive solid geometry: the published tables, and the costs of operations.

use leafless::solid::{HalfSpace, Parts, Touch, Transform};
use leafless::{
    Affine, AnySolid, Cell, Classifier, Control, Csg, Error, Frame, Interval, Rule, Solid, Tag, Verdict,
    Worker, build,
};
use leafless_testkit::cubes::Plain;

type CsgWorker = <<Csg as Solid>::Classifier as Classifier>::Worker;
type CsgPart = <CsgWorker as Parts>::Part;

/// Returns, for each level of a full descent, the number of cells split above it, the volume of the FULL
/// cells, and the volume of the FULL and PARTIAL cells.
fn table(solid: &Csg, frame: &Frame) -> Vec<(u64, f64, f64)> {
    struct Descent {
        worker: CsgWorker,
        rows: Vec<(u64, f64, f64)>,
    }
    impl Descent {
        fn cell(&mut self, cell: Cell, verdict: Verdict<CsgPart>) {
            let level = cell.level as usize;
            let volume = (self.worker.frame().edge() / (1u64 << level) as f64).powi(3);
            match verdict {
                Verdict::Empty => {}
                Verdict::Full => (level..self.rows.len()).for_each(|l| {
                    self.rows[l].1 += volume;
                    self.rows[l].2 += volume;
                }),
                Verdict::Undecided => (level..self.rows.len()).for_each(|l| self.rows[l].2 += volume),
                Verdict::Partial(part) => {
                    self.rows[level].2 += volume;
                    if level + 1 < self.rows.len() {
                        (level + 1..self.rows.len()).for_each(|l| self.rows[l].0 += 1);
                        let mark = self.worker.mark();
                        let children = self.worker.split(cell, &part).unwrap();
                        for (k, child) in (0..8).zip(children) {
                            self.cell(cell.child(k), child);
                        }
                        self.worker.release(mark);
                    }
                }
            }
        }
    }
    let worker = solid.on(frame, &Control::default()).unwrap().worker().unwrap();
    let mut descent = Descent { worker, rows: vec![(0, 0.0, 0.0); frame.depth() as usize + 1] };
    let root = descent.worker.root().unwrap();
    descent.cell(Cell::ROOT, root);
    descent.rows
}

/// (x − 64)² + (y − 64)² + (z − 64)² ≤ 4096.
fn sphere() -> Result<Csg, Error> {
    Csg::ball([64.0; 3], 64.0)
}

/// (x − 64)² − ¼ (y − 128)² + (z − 64)² ≤ 0, y ≤ 128.
fn cone() -> Result<Csg, Error> {
    let mantle = HalfSpace::quadric([
        -1.0,
        0.25,
        -1.0,
        0.0,
        0.0,
        0.0,
        128.0,
        -64.0,
        128.0,
        0.25 * 16384.0 - 2.0 * 4096.0,
    ])?;
    Csg::intersection_of([mantle.into(), Csg::half_space([0.0, -1.0, 0.0], 128.0)?])
}

/// (x − 64)² − 0.64 (y − 64)² + (z − 64)² ≤ 576, 0 ≤ y ≤ 128, scaled by 25, so that the coefficients are
/// exact.
fn hyperboloid() -> Result<Csg, Error> {
    let mantle = HalfSpace::quadric([
        -25.0,
        16.0,
        -25.0,
        0.0,
        0.0,
        0.0,
        3200.0,
        -2048.0,
        3200.0,
        14400.0 - (50.0 - 16.0) * 4096.0,
    ])?;
    let (low, high) = (Csg::half_space([0.0, 1.0, 0.0], 0.0)?, Csg::half_space([0.0, -1.0, 0.0], 128.0)?);
    Csg::intersection_of([mantle.into(), low, high])
}

/// Compares with the published levels 2 to 5, which are levels 3 to 6 here: cells of edge 128/2^level.
fn check(solid: Csg, touch: Touch, published: [(u64, f64, f64); 4]) {
    let frame = Frame::new([0.0; 3], 128.0, 6).unwrap();
    let rows = table(&solid.with_touch(touch), &frame);
    assert_eq!(rows[3..], published, "{touch:?}");
}

#[test]
fn published_sphere() {
    let rows = [
        (65, 557056.0, 1671168.0),
        (337, 802816.0, 1396736.0),
        (1497, 946176.0, 1250816.0),
        (6257, 1021056.0, 1174912.0),
    ];
    check(sphere().unwrap(), Touch::Paper, rows);
    check(sphere().unwrap(), Touch::Exact, rows);
}

#[test]
fn published_cone() {
    let lower = [245760.0, 382976.0, 460800.0, 503808.0];
    let rows = |nodes: [u64; 4], upper: [f64; 4]| [0, 1, 2, 3].map(|i| (nodes[i], lower[i], upper[i]));
    check(
        cone().unwrap(),
        Touch::Paper,
        rows([53, 237, 969, 3869], [999424.0, 757760.0, 646400.0, 595968.0]),
    );
    check(
        cone().unwrap(),
        Touch::Exact,
        rows([45, 205, 873, 3621], [901120.0, 724992.0, 636672.0, 593280.0]),
    );
}

#[test]
fn published_hyperboloid() {
    // The printed lower bounds and counts of levels 3 to 5 are replaced by those of exact arithmetic; see
    // `printed_hyperboloid`.
    let lower = [229376.0, 385024.0, 479232.0, 529984.0];
    let rows = |nodes: [u64; 4], upper: [f64; 4]| [0, 1, 2, 3].map(|i| (nodes[i], lower[i], upper[i]));
    let printed_upper = [1048576.0, 819200.0, 696832.0, 638336.0];
    check(hyperboloid().unwrap(), Touch::Paper, rows([65, 265, 1113, 4513], printed_upper));
    let upper = [1048576.0, 802816.0, 692736.0, 637504.0];
    check(hyperboloid().unwrap(), Touch::Exact, rows([65, 265, 1081, 4417], upper));
}

#[test]
fn a_box_on_the_lattice_is_exact_at_every_level() {
    for depth in 1..=6 {
        let frame = Frame::new([0.0; 3], 128.0, depth).unwrap();
        let half = 64.0;
        let rows = table(&Csg::cuboid([0.0; 3], [half, 128.0, half]).unwrap(), &frame);
        let truth = half * 128.0 * half;
        assert!(rows[1..].iter().all(|&(_, lower, upper)| (lower, upper) == (truth, truth)), "{rows:?}");
    }
}

#[test]
fn what_is_known_around_the_universe() {
    let frame = Frame::new([0.0; 3], 128.0, 6).unwrap();
    let outside = |solid: &Csg| solid.on(&frame, &Control::default()).unwrap().exterior();
    let ball = sphere().unwrap();
    assert_eq!((outside(&ball), outside(&ball.complement())), (Tag::Empty, Tag::Full));
    assert_eq!(outside(&Csg::ball([64.0; 3], 64.1).unwrap()), Tag::Partial);
    assert_eq!(outside(&Csg::half_space([1.0, 0.0, 0.0], -1.0).unwrap()), Tag::Partial);
    assert_eq!((outside(&Csg::empty()), outside(&Csg::everything())), (Tag::Empty, Tag::Full));
    // Another solid knows more than its bounding box.
    let other = Csg::solid(AnySolid::new(Plain::cuboid([1.0; 3], [2.0; 3]).unwrap()));
    assert_eq!((outside(&other), outside(&other.complement())), (Tag::Empty, Tag::Full));
    let unknown = Csg::half_space([0.1, 0.2, 0.3], 0.0).unwrap();
    let cases = [
        (Csg::union_of([other.clone(), ball.clone()]), Tag::Empty),
        (Csg::union_of([other.clone(), ball.complement()]), Tag::Full),
        (Csg::intersection_of([other.clone(), unknown.clone()]), Tag::Empty),
        (Csg::union_of([other.clone(), unknown.clone()]), Tag::Partial),
        (Csg::xor_of([other.complement(), ball.clone()]), Tag::Full),
        (Csg::xor_of([other.complement(), other.complement()]), Tag::Empty),
        (Csg::xor_of([other.complement(), unknown]), Tag::Partial),
        (other.difference(&ball), Tag::Empty),
    ];
    for (solid, expected) in cases {
        assert_eq!(outside(&solid.unwrap()), expected);
    }
    let octree = build(&other, &frame, Rule::Certified, &Control::default()).unwrap();
    assert!(octree.view().exterior() == Tag::Empty);
}

#[test]
fn solids_within_each_other_have_an_end() {
    let frame = Frame::new([0.0; 3], 4.0, 3).unwrap();
    let nested = |times: u32| {
        let innermost = AnySolid::new(Plain::cuboid([1.0; 3], [2.0; 3]).unwrap());
        let place = |solid: AnySolid| AnySolid::new(Transform::new(solid, &frame, &Affine::IDENTITY));
        Csg::solid((1..times).fold(innermost, |solid, _| place(solid)))
    };
    let volume = |solid: &Csg| {
        build(solid, &frame, Rule::Certified, &Control::default()).map(|tree| tree.statistics().volume())
    };
    assert_eq!(volume(&nested(64)).unwrap(), Interval::exactly(1.0));
    assert!(matches!(volume(&nested(65)), Err(Error::Limit { limit: 64, .. })));
    assert!(matches!(volume(&nested(20_000)), Err(Error::Limit { limit: 64, .. })));
    // An expression of expressions is one.
    let mut csg = nested(1);
    for _ in 0..20_000 {
        csg = Csg::solid(AnySolid::new(csg));
    }
    assert_eq!((csg.nesting(), volume(&csg).unwrap()), (1, Interval::exactly(1.0)));
}

/// The reason why the source prints other lower bounds, and 1129 and 4577 nodes. Some vertices lie on the
/// surface, such as those with y - 64 = ±40 at distance 40 from the axis. They lie outside once 0.64 is
/// rounded to single precision, which is less. The printed lower bounds follow from this. The printed upper
/// bounds are those of exact arithmetic, where these vertices are inside: the source's test seems strict in
/// one direction. The printed counts are those of the cells between the printed bounds.
#[test]
fn printed_hyperboloid() {
    let k = f64::from(0.64f32);
    let offset = 576.0 - (2.0 - k) * 4096.0;
    let mantle =
        HalfSpace::quadric([-1.0, k, -1.0, 0.0, 0.0, 0.0, 128.0, -128.0 * k, 128.0, offset]).unwrap();
    let planes = [Csg::half_space([0.0, 1.0, 0.0], 0.0), Csg::half_space([0.0, -1.0, 0.0], 128.0)];
    let [low, high] = planes.map(Result::unwrap);
    let solid = Csg::intersection_of([mantle.into(), low, high]).unwrap().with_touch(Touch::Paper);
    let frame = Frame::new([0.0; 3], 128.0, 6).unwrap();
    let lower: Vec<f64> = table(&solid, &frame)[3..].iter().map(|row| row.1).collect();
    assert_eq!(lower, [229376.0, 376832.0, 476160.0, 529280.0]);
    let upper = [1048576.0, 819200.0, 696832.0, 638336.0];
    // Each cell that is cut has eight children.
    let mut nodes = 65;
    for (level, printed) in [(2, 265), (3, 1129), (4, 4577)] {
        let cell = (128.0 / f64::from(1 << level)).powi(3);
        nodes += 8 * ((upper[level as usize - 2] - lower[level as usize - 2]) / cell) as u64;
        assert_eq!(nodes, printed);
    }
}
