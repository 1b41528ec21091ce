//! A solid of one's own, made outside of the library: a metaball, the points p with Σ rᵢ² / |p − cᵢ|² ≥ 1.
//!
//! The solid climbs the ladder in the documentation of `leafless::solid` one step at a time, and the example
//! prints what each step gains. Run it with `cargo run --release --example metaball`.

use leafless::lattice::Cube;
use leafless::solid::{
    Adaptive, Enclosure, Fingerprint, Fingerprinter, FreeParts, OneByOne, Question, Slab, SlabJoin,
    WholeQuestion,
};
use leafless::{
    Bounds, Cell, Classifier, Control, Error, Frame, Interval, Proof, Rule, Solid, Tag, Verdict, Worker,
    bounding_box, build, measure,
};
use std::sync::Arc;
use std::time::Instant;

/// A ball that is drawn towards the others.
#[derive(Debug, Clone, Copy)]
pub struct Ball {
    /// In model units.
    pub centre: [f64; 3],
    /// In model units, positive.
    pub radius: f64,
}

impl Ball {
    fn weight(&self) -> Interval {
        Interval::exactly(self.radius).square()
    }
}

/// How far the solid climbs the ladder. (A solid that is meant for use climbs all of it.)
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    /// Only verdicts of cells.
    Cells,
    /// Which side centres of cells lie on, too.
    Centres,
    /// Slabs around the boundary, too.
    Slabs,
}

/// All points p with Σ rᵢ² / |p − cᵢ|² ≥ 1.
#[derive(Debug, Clone)]
pub struct Metaball {
    /// Any number of balls; none of them is the empty set.
    pub balls: Arc<[Ball]>,
    /// What it answers.
    pub step: Step,
}

impl Metaball {
    /// One ball by itself has the radius that is given. All numbers must be finite, and the radii positive.
    pub fn new(balls: &[([f64; 3], f64)], step: Step) -> Metaball {
        let balls = balls.iter().map(|&(centre, radius)| {
            assert!(centre.iter().all(|x| x.is_finite()) && radius.is_finite() && radius > 0.0);
            Ball { centre, radius }
        });
        Metaball { balls: balls.collect(), step }
    }
}

impl Solid for Metaball {
    type Classifier = OnFrame;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<OnFrame, Error> {
        let ends = self.bounds().is_some_and(|bounds| bounds.is_within(frame));
        Ok(OnFrame { shape: self.clone(), frame: *frame, ends })
    }

    /// Let S be the sum of the radii. A point farther than √(rᵢ S) from each cᵢ has a sum below
    /// Σ rᵢ² / (rᵢ S) = 1.
    fn bounds(&self) -> Option<Bounds> {
        let total = self
            .balls
            .iter()
            .fold(Interval::exactly(0.0), |sum, ball| sum.plus(Interval::exactly(ball.radius)));
        let own = self.balls.iter().map(|ball| {
            let reach = Interval::exactly(ball.radius).times(total).root().upper;
            Some(Bounds::new(ball.centre, ball.centre)?.grown(reach))
        });
        own.reduce(|all, own| Some(all?.hull(&own?)))?
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let numbers = self.balls.iter().flat_map(|ball| ball.centre.into_iter().chain([ball.radius]));
        let numbers: Vec<f64> = numbers.collect();
        Some(Fingerprinter::new("example: metaball, first form").numbers(&numbers).finish())
    }
}

/// The shape on a frame. There is no scratch memory, so that the handle is its own worker.
#[derive(Debug, Clone)]
pub struct OnFrame {
    shape: Metaball,
    frame: Frame,
    /// Whether the shape surely ends in the universe.
    ends: bool,
}

impl Classifier for OnFrame {
    type Worker = OnFrame;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<OnFrame, Error> {
        Ok(self.clone())
    }

    /// Without this each measure would say that the shape is clipped.
    fn exterior(&self) -> Tag {
        if self.ends { Tag::Empty } else { Tag::Partial }
    }

    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

// Nothing is remembered about a cell, and no question is better asked with others.
impl FreeParts for OnFrame {
    type Part = ();
}

impl OneByOne for OnFrame {}

impl Worker for OnFrame {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        Ok(self.verdict(Cell::ROOT))
    }

    fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
        Ok([0, 1, 2, 3, 4, 5, 6, 7].map(|octant| self.verdict(cell.child(octant))))
    }

    fn answer(&mut self, cell: Cell, _: &(), question: Question<'_>) -> Result<(), Error> {
        match question {
            Question::Centre(inside) if self.shape.step >= Step::Centres => {
                *inside = Some(self.is_inside(cell))
            }
            Question::Enclosure(known) if self.shape.step >= Step::Slabs => *known = self.slab(cell),
            _ => {}
        }
        Ok(())
    }
}

fn sum_of_squares(v: [Interval; 3]) -> Interval {
    v[0].square().plus(v[1].square()).plus(v[2].square())
}

/// A quotient of positive numbers of which the divisor may be 0.
fn over(weight: Interval, square: Interval) -> Interval {
    let least = weight.over(Interval::exactly(square.upper)).lower.max(0.0);
    let most = if square.lower > 0.0 { weight.over(square).upper } else { f64::INFINITY };
    Interval::new(least, most).unwrap_or(Interval::ALL)
}

/// A ball as a cell sees it.
struct Seen {
    weight: Interval,
    /// From the ball's centre to the cell's.
    way: [Interval; 3],
    /// The square of the way's length.
    at: Interval,
    /// The squares of the distances of all points of the cell.
    within: Interval,
}

impl OnFrame {
    fn balls(&self, cell: Cell) -> impl Iterator<Item = Seen> {
        let cube = Cube { frame: &self.frame, cell };
        let half = cube.half_edge();
        let reach = Interval::new(-half, half).unwrap_or(Interval::ALL);
        self.shape.balls.iter().map(move |ball| {
            let way = cube.centre_from(ball.centre);
            let within = sum_of_squares(way.map(|along| along.plus(reach)));
            Seen { weight: ball.weight(), way, at: sum_of_squares(way), within }
        })
    }

    fn verdict(&self, cell: Cell) -> Verdict<()> {
        let terms = self.balls(cell).map(|ball| over(ball.weight, ball.within));
        let sum = terms.fold(Interval::exactly(0.0), Interval::plus);
        if sum.lower >= 1.0 {
            Verdict::Full
        } else if sum.upper < 1.0 {
            Verdict::Empty
        } else {
            Verdict::Partial(())
        }
    }

    /// Whether the centre lies in the solid. What is within rounding of the boundary is decided as if it lay
    /// on it: by the first axis along which the sum changes. (Which side it is really on, doubles cannot
    /// tell.)
    fn is_inside(&self, cell: Cell) -> bool {
        let mut sum = Interval::exactly(0.0);
        let mut outward = [Interval::exactly(0.0); 3];
        for ball in self.balls(cell) {
            let term = over(ball.weight, ball.at);
            let share = over(term, ball.at);
            sum = sum.plus(term);
            outward = [0, 1, 2].map(|axis| outward[axis].plus(share.times(ball.way[axis])));
        }
        if sum.lower > 1.0 || sum.upper < 1.0 {
            return sum.lower > 1.0;
        }
        outward.into_iter().find(|n| n.lower > 0.0 || n.upper < 0.0).is_some_and(|n| n.upper < 0.0)
    }

    /// A slab around the boundary, by the sum and its gradient at the cell's centre.
    ///
    /// Let v be the way from a ball's centre to the cell's, and u that from there to any point of the cell.
    /// Then
    /// |v + u|² = v² + t with t = 2 v·u + u², and by 1 / (1 + s) = 1 − s + s² / (1 + s)
    ///
    /// 1 / |v + u|² = 1 / v² − 2 v·u / v⁴ − u² / v⁴ + t² / (v⁴ |v + u|²),
    ///
    /// with nothing left out. The first two terms are linear in u, the others lie between bounds.
    fn slab(&self, cell: Cell) -> Option<Enclosure> {
        let half = Interval::exactly(Cube { frame: &self.frame, cell }.half_edge());
        // In the cell the sum is 1 + value − normal·x, x being u in half edges.
        let mut value = Interval::exactly(-1.0);
        let mut normal = [Interval::exactly(0.0); 3];
        for Seen { weight, way, at, within } in self.balls(cell) {
            // The sum is not bounded in a cell that a ball's centre may lie in.
            if at.lower <= 0.0 || within.lower <= 0.0 {
                return None;
            }
            let term = weight.over(at);
            let share = term.over(at);
            let slope = Interval::exactly(2.0).times(share).times(half);
            normal = [0, 1, 2].map(|axis| normal[axis].plus(slope.times(way[axis])));
            // u² is at most three squares of the half edge.
            let fall = share.times(Interval::exactly(3.0)).times(half.square());
            // t² / |v + u|² is (a − v²)² / a with a = |v + u|². That is convex in a, so greatest at an end.
            let rise = [within.lower, within.upper].map(|a| {
                let a = Interval::exactly(a);
                share.times(a.minus(at).square().over(a)).upper
            });
            value = value.plus(term).plus(Interval::new(-fall.upper, rise[0].max(rise[1]))?);
        }
        // The slab has one direction. What that leaves of the normal's range goes into the offsets: no |xⱼ|
        // exceeds 1.
        let direction = normal.map(|along| 0.5 * along.lower + 0.5 * along.upper);
        let blur = (0..3).fold(Interval::exactly(0.0), |sum, axis| {
            let rest = normal[axis].minus(Interval::exactly(direction[axis]));
            sum.plus(Interval::exactly(rest.upper.max(-rest.lower)))
        });
        let (inner, outer) = (value.minus(blur).lower, value.plus(blur).upper);
        // What says nothing about any point of the cell, or is no number, is not said.
        let most: f64 = direction.iter().map(|n| n.abs()).sum();
        if !(most.is_finite() && inner <= outer && (inner > -most || outer < most)) {
            return None;
        }
        let none = Slab { normal: [0.0; 3], inner: f64::NEG_INFINITY, outer: f64::INFINITY };
        let slabs = [Slab { normal: direction, inner, outer }, none, none];
        Some(Enclosure { slabs, join: SlabJoin::All, cone: f64::INFINITY })
    }
}

/// The sum as anyone would write it.
pub fn plain_sum(balls: &[Ball], p: [f64; 3]) -> f64 {
    let term = |ball: &Ball| {
        let v = [0, 1, 2].map(|axis| p[axis] - ball.centre[axis]);
        ball.radius * ball.radius / (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    };
    balls.iter().map(term).sum()
}

/// The three balls that the example melts together.
pub fn three_balls(step: Step) -> Metaball {
    Metaball::new(&[([-0.45, -0.1, 0.05], 0.3), ([0.35, 0.2, -0.15], 0.35), ([0.05, -0.4, 0.3], 0.25)], step)
}

fn print_measure(solid: &Metaball, bounds: &Bounds, tolerance: f64) -> Result<(), Error> {
    let start = Instant::now();
    let frame = Frame::fitted(bounds.min, bounds.max, 20)?;
    let control = Control { max_splits: Some(200_000), ..Control::default() };
    let found = measure(solid, &frame, tolerance, &control)?;
    let (volume, reason) = (found.volume, found.stop_reason);
    println!(
        "  measure to {tolerance:.0e}: {:.6} to {:.6}, {} splits ({reason:?}, {:.1?})",
        volume.lower,
        volume.upper,
        found.splits,
        start.elapsed()
    );
    Ok(())
}

fn print_box(solid: &Metaball, bounds: &Bounds, tolerance: f64) -> Result<(), Error> {
    let frame = Frame::fitted(bounds.min, bounds.max, 20)?;
    let control = Control { max_splits: Some(200_000), ..Control::default() };
    let found = bounding_box(solid, &frame, tolerance, &control)?;
    let sides = found.corners.unwrap_or([[Interval::ALL; 3]; 2]);
    let widest = sides.iter().flatten().map(|side| side.width()).fold(0.0, f64::max);
    let (splits, reason) = (found.splits, found.stop_reason);
    println!("  bounding box to {tolerance:.0e}: sides known to {widest:.1e}, {splits} splits ({reason:?})");
    Ok(())
}

/// Climbs the ladder.
pub fn main() -> Result<(), Error> {
    let control = Control::default();
    let bounds = three_balls(Step::Cells).bounds().unwrap_or(Bounds { min: [-1.0; 3], max: [1.0; 3] });
    let frame = Frame::fitted(bounds.min, bounds.max, 8)?;

    println!("Cells");
    let cells = three_balls(Step::Cells);
    let tree = build(&cells, &frame, Rule::Certified, &control)?;
    let (nodes, volume) = (tree.statistics().nodes(), tree.statistics().volume());
    println!("  octree of depth 8: {nodes} nodes, volume {:.6} to {:.6}", volume.lower, volume.upper);
    print_measure(&cells, &bounds, 1e-1)?;
    print_measure(&cells, &bounds, 1e-2)?;
    print_box(&cells, &bounds, 1e-3)?;

    println!("Centres");
    let centres = three_balls(Step::Centres);
    let tree = build(&centres, &frame, Rule::Sampled, &control)?;
    println!("  sampled octree of depth 8: volume {:.6}", tree.statistics().volume().lower);

    println!("Slabs");
    let slabs = three_balls(Step::Slabs);
    for tolerance in [1e-1, 1e-2, 1e-3] {
        print_measure(&slabs, &bounds, tolerance)?;
    }
    for tolerance in [1e-3, 1e-9] {
        print_box(&slabs, &bounds, tolerance)?;
    }
    let tree = build(&Adaptive::new(slabs, 1e-2)?, &frame, Rule::Certified, &control)?;
    println!(
        "  octree of depth 8 that ends where the surface is known to 0.01: {} nodes",
        tree.statistics().nodes()
    );
    Ok(())
}
