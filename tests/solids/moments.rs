//! The moments that solids provide for a cell, against those of far smaller cells.

use leafless::lattice::{CellMoments, CubeMoments, MAX_DEPTH};
use leafless::solid::Ask;
use leafless::{Cell, Classifier, Csg, Frame, Solid, SurfaceOptions, Verdict, Worker, build_extended};
use leafless_testkit::csg::{Maker, Model};
use leafless_testkit::{Random, Way, alone, lattice_frame};

/// Index pairs of the second moments, in order.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Moments (1, x, y, z and the second moments), with the greatest error, including the volume of unknown
/// cells.
#[derive(Debug, Clone, Copy)]
struct Sum {
    moments: [f64; 10],
    error: f64,
}

impl Sum {
    fn of(moments: &CubeMoments, error: f64) -> Sum {
        let ([x, y, z], [a, b, c, d, e, f]) = (moments.first, moments.second);
        Sum { moments: [moments.volume, x, y, z, a, b, c, d, e, f], error }
    }

    /// Adds the moments of a child.
    fn add(&mut self, octant: u8, child: &Sum) {
        let at = [0, 1, 2].map(|axis| (octant >> axis & 1) as f64 - 0.5);
        let [volume, first @ .., _, _, _, _, _, _] = child.moments;
        let first: [f64; 3] = first;
        self.moments[0] += volume / 8.0;
        for i in 0..3 {
            self.moments[1 + i] += (0.5 * first[i] + at[i] * volume) / 8.0;
        }
        for (k, (i, j)) in PAIRS.into_iter().enumerate() {
            let mixed = 0.5 * (at[i] * first[j] + at[j] * first[i]);
            self.moments[4 + k] += (0.25 * child.moments[4 + k] + mixed + at[i] * at[j] * volume) / 8.0;
        }
        self.error += child.error / 8.0;
    }
}

/// Returns the moments of a cell from cells some levels below: decided cells, cells with known moments, and
/// unknown cells, of which any part may be solid.
fn below<W: Worker>(worker: &mut W, cell: Cell, part: &W::Part, levels: u32, fine: bool) -> Sum {
    let any = || {
        let mut half = Sum::of(&CubeMoments::FULL, 4.0);
        half.moments.iter_mut().for_each(|moment| *moment *= 0.5);
        half
    };
    if levels == 0 || cell.level == worker.frame().depth() {
        let known = if fine { worker.moments(cell, part).unwrap() } else { None };
        return match known {
            Some(CellMoments { moments, error }) => Sum::of(&moments, error),
            None => any(),
        };
    }
    let mark = worker.mark();
    let mut sum = Sum::of(&CubeMoments::EMPTY, 0.0);
    for (octant, verdict) in (0..8).zip(worker.split(cell, part).unwrap()) {
        let child = match verdict {
            Verdict::Empty => continue,
            Verdict::Full => Sum::of(&CubeMoments::FULL, 0.0),
            // A cell of an extended tree that was given up.
            Verdict::Undecided => any(),
            Verdict::Partial(part) => below(worker, cell.child(octant), &part, levels - 1, fine),
        };
        sum.add(octant, &child);
    }
    worker.release(mark);
    sum
}

/// Returns the greatest difference.
fn difference(a: &Sum, b: &Sum) -> f64 {
    (0..10).fold(0.0, |most, i| most.max((a.moments[i] - b.moments[i]).abs()))
}

/// Numbers of queried cells, of cells with known moments, and of cells whose descendants know far more.
#[derive(Debug, Default)]
struct Found {
    asked: u64,
    known: u64,
    strong: u64,
    /// Number of cells with planes only, whose moments are known up to rounding.
    exact: u64,
    /// Greatest ratio of difference to error bound, over the strong cells.
    most: f64,
}

/// Checks a solid and its complement along a descent.
fn walk<S: Solid>(
    model: &Model,
    frame: &Frame,
    [solid, complement]: [&S; 2],
    random: &mut Random,
    found: &mut Found,
) {
    let way = |solid: &S| Way::new(solid.on(frame, &alone()).unwrap().worker().unwrap());
    let (Some(mut way), Some(mut opposite)) = (way(solid), way(complement)) else { return };
    while way.cell.level < frame.depth() {
        let cell = way.cell;
        found.asked += 1;
        let context = || format!("{cell:?}\n{frame:?}\n{model:#?}");
        let complement = opposite.worker.moments(cell, &opposite.part).unwrap();
        let known = way.worker.moments(cell, &way.part).unwrap();
        assert_eq!(known.is_some(), complement.is_some(), "{}", context());
        if let (Some(known), Some(complement)) = (known, complement) {
            found.known += 1;
            found.exact += (known.error < 1e-10) as u64;
            let own = Sum::of(&known.moments, known.error);
            let back = complement.complement();
            let error = known.error + back.error;
            assert!(difference(&own, &Sum::of(&back.moments, 0.0)) <= error, "{}", context());
            for (levels, fine) in [(4, false), (2, true)] {
                let sum = below(&mut way.worker, cell, &way.part, levels, fine);
                let off = difference(&own, &sum);
                let rounding = 1e-14;
                assert!(
                    off <= own.error + sum.error + rounding,
                    "{off} {fine}: {known:?}\n{sum:?}\n{}",
                    context()
                );
                if fine && sum.error < 0.25 * own.error {
                    found.strong += 1;
                    found.most = found.most.max(off / own.error);
                }
            }
        }
        if !way.descend(random) {
            return;
        }
        opposite.follow(way.cell);
    }
}

/// Checks random solids made by `make`, until `wanted` cells have known moments.
fn hold(name: &str, wanted: u64, make: impl Fn(&mut Maker<'_>) -> Model) {
    for extended in [false, true] {
        hold_as(name, wanted, extended, &make);
    }
}

/// The same for expressions, or for extended trees of them.
fn hold_as(name: &str, wanted: u64, extended: bool, make: impl Fn(&mut Maker<'_>) -> Model) {
    let mut found = Found::default();
    for seed in 0.. {
        if found.known >= wanted {
            break;
        }
        assert!(seed < 10_000 + wanted, "{name}: {found:?}");
        let mut random = Random(seed ^ 0x303);
        let depth = 4 + random.below(MAX_DEPTH as u64 - 10) as u8;
        let frame = match random.below(2) {
            0 => lattice_frame(depth),
            _ => Frame::new([0.1, -7.3, 1e5 / 3.0], 10.0 / 3.0, depth).unwrap(),
        };
        let aligned = random.below(3) == 0;
        let mut maker = Maker { random: &mut random, frame, aligned, others: false };
        let model = make(&mut maker);
        // The library refuses arguments out of range.
        let Ok(csg) = model.csg(&frame) else { continue };
        if extended {
            let tree = |csg: &Csg| {
                let shallow = frame.with_depth(4).unwrap();
                build_extended(csg, &shallow, &SurfaceOptions::default(), &alone()).ok()
            };
            let (Some(own), Some(other)) = (tree(&csg), tree(&csg.complement())) else { continue };
            walk(&model, &frame, [&own, &other], &mut random, &mut found);
        } else {
            walk(&model, &frame, [&csg, &csg.complement()], &mut random, &mut found);
        }
    }
    println!("{name}, {}: {found:?}", if extended { "extended" } else { "as it is" });
    assert!(found.strong + found.exact > wanted / 4, "{name}: {found:?}");
}

/// A curved half-space cut by one or two planes.
fn cut(maker: &mut Maker<'_>) -> Model {
    let mixed = maker.below(2) == 0;
    let mut model = match maker.below(4) {
        0 => maker.power(),
        1 => maker.torus(),
        _ => maker.quadric(mixed),
    };
    for _ in 0..1 + maker.below(2) {
        let plane = maker.plane();
        model = match maker.below(3) {
            0 => Model::Union(vec![model, plane]),
            1 => Model::Intersection(vec![plane, model]),
            _ => Model::Difference(Box::new([plane, model])),
        };
    }
    model
}

fn every_producer(cells: u64) {
    hold("quadrics", cells, |maker| maker.quadric(false));
    hold("mixed quadrics", cells, |maker| maker.quadric(true));
    hold("turned quadrics", cells, |maker| {
        let quadric = maker.quadric(false);
        maker.placed(quadric)
    });
    hold("powers", cells, |maker| maker.power());
    hold("turned powers", cells, |maker| {
        let power = maker.power();
        maker.placed(power)
    });
    hold("tori", cells, |maker| maker.torus());
    hold("turned tori", cells, |maker| {
        let torus = maker.torus();
        maker.placed(torus)
    });
    hold("primitives", cells, |maker| maker.primitive());
    hold("cut by planes", cells, cut);
    hold("cut by planes, turned", cells, |maker| {
        let cut = cut(maker);
        maker.placed(cut)
    });
    hold("functions of planes", cells, |maker| maker.function(|maker| maker.plane()));
    hold("functions of half-spaces", cells, |maker| maker.function(|maker| maker.half_space()));
    hold("functions of half-spaces, turned", cells, |maker| {
        let function = maker.function(|maker| maker.half_space());
        maker.placed(function)
    });
}

#[test]
fn moments_agree_with_those_of_smaller_cells() {
    every_producer(400);
}

#[test]
#[ignore = "minutes"]
fn a_hundred_thousand_cells() {
    every_producer(10_000);
}
