//! Trees against points.

use leafless::{Bounds, Frame, Octree, Tag};
use leafless_testkit::Random;
use leafless_testkit::csg::{Model, Point, Probe};
use leafless_testkit::exact::Exact;

/// Positions are multiples of 2^-20 of a finest cell.
const STEPS: u32 = 20;

fn coordinate(frame: &Frame, axis: usize, k: i64) -> Exact {
    let step = Exact::power_of_two(-(frame.depth() as i64) - STEPS as i64).times(&Exact::from(frame.edge()));
    Exact::from(frame.origin()[axis]).plus(&step.times(&Exact::from(k as f64)))
}

fn point(frame: &Frame, at: [i64; 3]) -> Point {
    let [x, y, z] = [0, 1, 2].map(|axis| coordinate(frame, axis, at[axis]));
    [x, y, z, Exact::from(1.0)]
}

/// Counts of the points examined.
#[derive(Default, Debug, PartialEq)]
pub struct Found {
    pub inside: u64,
    pub outside: u64,
    /// Number of points in decided cells.
    pub decided: u64,
}

pub struct Judge<'a> {
    pub model: &'a Model,
    pub tree: &'a Octree,
    pub bounds: Option<Bounds>,
    pub found: Found,
}

impl Judge<'_> {
    /// Returns the side on which a position lies. The check fails if the tree contradicts it.
    fn sign(&mut self, at: [i64; 3]) -> i32 {
        let frame = self.tree.frame();
        let p = point(frame, at);
        let sign = self.model.sign(&p);
        self.found.inside += (sign > 0) as u64;
        self.found.outside += (sign < 0) as u64;
        let contradicted = match sign {
            1 => Tag::Empty,
            -1 => Tag::Full,
            _ => return sign,
        };
        let end = (frame.cells() as i64) << STEPS;
        let ranges = at.map(|k| [((k + (1 << STEPS) - 1) >> STEPS) - 1, k >> STEPS]);
        for corner in 0..8 {
            let cell = [0, 1, 2].map(|axis| ranges[axis][corner >> axis & 1]);
            let inside = cell.iter().all(|&i| (0..frame.cells() as i64).contains(&i));
            let tag = match inside {
                true => self.tree.view().tag_at(cell.map(|i| i as u32)),
                false => self.tree.view().exterior(),
            };
            self.found.decided += (corner == 0 && tag != Tag::Partial) as u64;
            assert_ne!(
                tag, contradicted,
                "{at:?} of {end}: {sign} in {cell:?}\n{frame:?}\n{:#?}",
                self.model
            );
        }
        if sign > 0
            && let Some(Bounds { min, max }) = self.bounds
        {
            for axis in 0..3 {
                let above = p[axis].minus(&Exact::from(min[axis])).sign() >= 0;
                let below = p[axis].minus(&Exact::from(max[axis])).sign() <= 0;
                assert!(above && below, "{at:?} beyond {min:?}, {max:?}\n{frame:?}\n{:#?}", self.model);
            }
        }
        sign
    }

    /// A random position: anywhere, on lattice planes, at a vertex or a centre, or outside the universe.
    fn position(&self, random: &mut Random) -> [i64; 3] {
        let n = self.tree.frame().cells() as u64;
        let kind = random.below(8);
        [0; 3].map(|_| {
            let cell = (random.below(n) as i64) << STEPS;
            match kind {
                0 => cell,
                1 => cell + (1 << (STEPS - 1)),
                2 => cell + ((random.below(2) as i64) << (STEPS - 1)),
                3 => (random.below((3 * n) << STEPS)) as i64 - ((n as i64) << STEPS),
                4 if random.below(2) == 0 => cell,
                5 => cell + random.below(3) as i64 - 1,
                _ => cell + random.below(1 << STEPS) as i64,
            }
        })
    }

    /// Checks random points, and points ever closer to the surface by bisection between two points on
    /// different sides.
    pub fn ask(&mut self, points: u64, random: &mut Random) {
        let mut last = [None; 2];
        let mut asked = 0;
        while asked < points {
            let at = self.position(random);
            let sign = self.sign(at);
            asked += 1;
            if sign == 0 {
                continue;
            }
            last[(sign > 0) as usize] = Some(at);
            if let [Some(mut outside), Some(mut inside)] = last {
                loop {
                    let middle = [0, 1, 2].map(|axis| (outside[axis] + inside[axis]) >> 1);
                    if middle == outside || middle == inside {
                        break;
                    }
                    asked += 1;
                    match self.sign(middle) {
                        1 => inside = middle,
                        -1 => outside = middle,
                        _ => break,
                    }
                }
                last = [None; 2];
            }
        }
    }
}

/// Returns the centre of a finest cell, and the point beside it.
pub fn centre(frame: &Frame, at: [u32; 3]) -> Probe {
    let middle = at.map(|i| ((2 * i as i64) + 1) << (STEPS - 1));
    let at = point(frame, middle);
    let mut beside = at.clone();
    for (axis, coordinate) in beside[..3].iter_mut().enumerate() {
        *coordinate = coordinate.plus(&Exact::power_of_two(-20_000 - 3000 * axis as i64));
    }
    Probe { at, beside }
}
