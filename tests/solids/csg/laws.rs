//! Laws of every expression.

use super::oracle::frames;
use leafless::solid::{Parts, SplitCounter};
use leafless::{
    AnySolid, Cell, Classifier, Control, Csg, Frame, Octree, Rule, Solid, Tag, Verdict, Worker, build,
    complement,
};
use leafless_testkit::csg::{Maker, Model};
use leafless_testkit::{Dense, Random, alone, lattice_frame};

type CsgWorker = <<Csg as Solid>::Classifier as Classifier>::Worker;
type CsgPart = <CsgWorker as Parts>::Part;

/// Ways to descend to the finest cells. All must give the same verdicts.
#[derive(Clone, Copy, Debug)]
enum Way {
    /// Releases the scratch memory after each cell.
    Released,
    /// Never releases the scratch memory.
    Kept,
    /// Splits two levels at once.
    Twice,
    /// Hands each part over to the other of two workers.
    HandedOver,
    /// Splits each cell again after all cells below it.
    Again,
}

struct Descent {
    way: Way,
    out: Dense,
}

impl Descent {
    fn run(csg: &Csg, frame: &Frame, way: Way) -> Dense {
        let classifier = csg.on(frame, &alone()).unwrap();
        let mut workers = [classifier.worker().unwrap(), classifier.worker().unwrap()];
        let mut descent = Descent { way, out: Dense::uniform(frame.depth(), Tag::Empty) };
        let [here, there] = &mut workers;
        let root = here.root().unwrap();
        descent.cell(here, there, Cell::ROOT, &root);
        descent.out
    }

    fn cell(&mut self, here: &mut CsgWorker, there: &mut CsgWorker, cell: Cell, verdict: &Verdict<CsgPart>) {
        let depth = here.frame().depth();
        let part = match verdict {
            Verdict::Partial(part) if cell.level < depth => part,
            verdict => {
                let edge = 1 << (depth - cell.level);
                for at in leafless_testkit::positions(depth - cell.level) {
                    let place = [0, 1, 2].map(|axis| cell.at[axis] * edge + at[axis]);
                    self.out.set(place, verdict.tag());
                }
                return;
            }
        };
        let marks = [here.mark(), there.mark()];
        if let (Way::Twice, true) = (self.way, cell.level + 2 <= depth) {
            let mut parts = Vec::new();
            let planes = here.split64(cell, part, &mut parts).unwrap();
            let mut parts = parts.into_iter().peekable();
            for c in 0..64 {
                let verdict = match planes.tag(c) {
                    Tag::Full => Verdict::Full,
                    Tag::Empty => Verdict::Empty,
                    _ => parts
                        .next_if(|(index, _)| *index as u32 == c)
                        .map_or(Verdict::Undecided, |(_, part)| Verdict::Partial(part)),
                };
                let grandchild = cell.child((c >> 3) as u8).child((c & 7) as u8);
                self.cell(here, there, grandchild, &verdict);
            }
            assert_eq!(parts.next().map(|(index, _)| index), None);
        } else {
            let children = here.split(cell, part).unwrap();
            for (k, child) in (0..).zip(&children) {
                match (self.way, child) {
                    (Way::HandedOver, Verdict::Partial(part)) => {
                        let part = there.hand_over(here, part).unwrap();
                        self.cell(there, here, cell.child(k), &Verdict::Partial(part));
                    }
                    _ => self.cell(here, there, cell.child(k), child),
                }
            }
            if let Way::Again = self.way {
                let again = here.split(cell, part).unwrap();
                let tags = |children: &[Verdict<CsgPart>; 8]| children.each_ref().map(|child| child.tag());
                assert_eq!(tags(&again), tags(&children), "{cell:?}");
            }
        }
        if !matches!(self.way, Way::Kept) {
            here.release(marks[0]);
            there.release(marks[1]);
        }
    }
}

/// Checks random expressions, some with other solids, each on its own frame.
fn expressions(count: u64, depths: [u8; 2], height: u32, mut check: impl FnMut(&Model, &Csg, &Frame)) {
    for seed in 0..count {
        let mut random = Random(seed ^ 0x1A35);
        let depth = depths[0] + random.below((depths[1] - depths[0] + 1) as u64) as u8;
        let frame = frames(depth)[random.below(4) as usize];
        let (aligned, others) = (random.below(2) == 0, random.below(2) == 0);
        let model = Maker { random: &mut random, frame, aligned, others }.expression(height);
        if let Ok(csg) = model.csg(&frame) {
            check(&model, &csg, &frame);
        }
    }
}

fn built(solid: &impl Solid, frame: &Frame, rule: Rule) -> Octree {
    build(solid, frame, rule, &alone()).unwrap()
}

fn all_ways_find_the_same(model: &Model, csg: &Csg, frame: &Frame) {
    let truth = Dense::of(built(csg, frame, Rule::Certified).view());
    for way in [Way::Released, Way::Kept, Way::Twice, Way::HandedOver, Way::Again] {
        let found = Descent::run(csg, frame, way);
        assert!(found == truth, "{way:?}\n{frame:?}\n{model:#?}\n{found:?}\n{truth:?}");
    }
}

#[test]
fn verdicts_do_not_depend_on_the_way() {
    expressions(400, [1, 4], 3, all_ways_find_the_same);
}

/// Words that are written for a child may be taken back when a later operand decides their owner. This must
/// not remove words that others need.
#[test]
fn parts_of_other_solids_live_as_long_as_their_cells() {
    for seed in 0..200 {
        let mut random = Random(seed);
        let frame = lattice_frame(5);
        let mut maker = Maker { random: &mut random, frame, aligned: seed % 2 == 0, others: true };
        let mut planes = [0; 5].map(|_| maker.plane()).to_vec();
        let last = planes.split_off(4);
        planes.insert(3, Model::Other(maker.other()));
        let model = Model::Union([vec![Model::Intersection(planes)], last].concat());
        if let Ok(csg) = model.csg(&frame) {
            all_ways_find_the_same(&model, &csg, &frame);
        }
    }
}

/// Returns the tags of the splits on the way down to a random finest cell.
fn descent(worker: &mut CsgWorker, random: &mut Random) -> Vec<Tag> {
    let mut tags = Vec::new();
    let mut cell = Cell::ROOT;
    let mut verdict = worker.root().unwrap();
    while let (Verdict::Partial(part), true) = (&verdict, cell.level < worker.frame().depth()) {
        let children = worker.split(cell, part).unwrap();
        tags.extend(children.iter().map(|child| child.tag()));
        let first = random.below(8);
        let (k, child) = (0..)
            .zip(children)
            .max_by_key(|(k, child)| (child.tag() == Tag::Partial, *k as u64 ^ first))
            .unwrap();
        (cell, verdict) = (cell.child(k), child);
    }
    tags
}

#[test]
fn a_used_worker_is_as_good_as_a_new_one() {
    expressions(300, [2, 4], 3, |model, csg, frame| {
        let classifier = csg.on(frame, &alone()).unwrap();
        let mut used = classifier.worker().unwrap();
        let mut evaluations = csg.evaluations();
        for seed in 0..4 {
            let mut fresh = classifier.worker().unwrap();
            let tags = [&mut used, &mut fresh].map(|worker| descent(worker, &mut Random(seed)));
            assert_eq!(tags[0], tags[1], "{frame:?}\n{model:#?}");
            if seed % 2 == 0 {
                used.release(0);
            }
            drop(fresh);
            let now = csg.evaluations();
            assert!(now >= evaluations, "the count of evaluations falls\n{model:#?}");
            evaluations = now;
        }
        // The evaluations of the used worker are counted once it is dropped: at least as many as those of the
        // four new ones.
        let before = csg.evaluations();
        drop(used);
        let parts: u64 = csg.evaluations() - before;
        let single = {
            let before = csg.evaluations();
            for seed in 0..4 {
                descent(&mut classifier.worker().unwrap(), &mut Random(seed));
            }
            csg.evaluations() - before
        };
        assert_eq!(parts, single, "{frame:?}\n{model:#?}");
    });
}

#[test]
fn any_number_of_threads_builds_the_same() {
    expressions(40, [7, 7], 3, |model, csg, frame| {
        let alone = built(csg, frame, Rule::Certified);
        for threads in [2, 16] {
            let tree = build(csg, frame, Rule::Certified, &Control::threads(threads)).unwrap();
            assert!(tree == alone, "{threads} threads\n{frame:?}\n{model:#?}");
        }
    });
}

#[test]
fn the_complement_is_the_complement() {
    expressions(150, [1, 5], 3, |model, csg, frame| {
        let tree = built(csg, frame, Rule::Certified);
        let other = built(&csg.complement(), frame, Rule::Certified);
        let dense = [&tree, &other].map(|tree| Dense::of(tree.view()));
        assert!(dense[0].complement() == dense[1], "{frame:?}\n{model:#?}");
        if tree.view().exterior() == other.view().exterior().complement() {
            assert!(complement(tree.view(), &alone()).unwrap() == other, "{frame:?}\n{model:#?}");
        } else {
            panic!("{:?} {:?}\n{frame:?}\n{model:#?}", tree.view().exterior(), other.view().exterior());
        }
    });
}

/// An operation on expressions, and the same on points.
type Operation = (fn(Csg, Csg) -> Csg, fn(bool, bool) -> bool);

#[test]
fn booleans_are_those_of_the_trees() {
    let operations: [Operation; 4] = [
        (|a, b| Csg::union_of([a, b]).unwrap(), |a, b| a | b),
        (|a, b| Csg::intersection_of([a, b]).unwrap(), |a, b| a & b),
        (|a, b| a.difference(&b).unwrap(), |a, b| a & !b),
        (|a, b| Csg::xor_of([a, b]).unwrap(), |a, b| a ^ b),
    ];
    let mut before: Option<(Model, u8)> = None;
    expressions(200, [3, 4], 2, |model, _, frame| {
        let Some((other, depth)) = before.replace((model.clone(), frame.depth())) else { return };
        let frame = &lattice_frame(depth);
        let (Ok(a), Ok(b)) = (model.csg(frame), other.csg(frame)) else { return };
        for (join, op) in operations {
            let both = join(a.clone(), b.clone());
            for rule in [Rule::Certified, Rule::Sampled] {
                let [Ok(a), Ok(b), Ok(both)] = [&a, &b, &both].map(|csg| build(csg, frame, rule, &alone()))
                else {
                    continue;
                };
                let [a, b, both] = [a, b, both].map(|tree| Dense::of(tree.view()));
                let joined = a.combine(&b, op);
                // The expression decides what the trees decide; a rotated one may decide more.
                let agree = joined.tags.iter().zip(&both.tags).all(|(&t, &e)| t == Tag::Partial || t == e);
                assert!(agree, "{rule:?}\n{model:#?}\n{other:#?}");
            }
        }
    });
}

#[test]
fn evaluations_are_counted_where_they_happen() {
    let frame = lattice_frame(5);
    let ball = Csg::ball([16.0; 3], 10.0).unwrap();
    let counted = SplitCounter::new(&ball);
    assert_eq!(ball.evaluations(), 0);
    build(&counted, &frame, Rule::Certified, &alone()).unwrap();
    let once = ball.evaluations();
    assert!(once > counted.splits().iter().sum());
    assert_eq!((counted.frames(), counted.solid().evaluations()), (1, once));
    let mut nested = ball.clone();
    for times in 2..5 {
        // A single expression would be that expression itself.
        nested = Csg::solid(AnySolid::new(SplitCounter::new(nested)));
        let again = SplitCounter::new(&nested);
        build(&again, &frame, Rule::Certified, &alone()).unwrap();
        assert_eq!(again.splits(), counted.splits());
        // Half-spaces behind the common solid interface count there, as often as without it, and do not count
        // for the expression around them.
        assert_eq!((ball.evaluations(), nested.evaluations()), (times * once, 0));
    }
    // With another worker, the count continues.
    let classifier = SplitCounter::new(&nested).on(&frame, &alone()).unwrap();
    let mut last = ball.evaluations();
    let start = last;
    for _ in 0..3 {
        let mut worker = classifier.worker().unwrap();
        let Verdict::Partial(part) = worker.root().unwrap() else { panic!() };
        worker.split(Cell::ROOT, &part).unwrap();
        drop(worker);
        let now = ball.evaluations();
        assert!(now > last && now < start + 1000, "{last}, then {now}");
        last = now;
    }
}
