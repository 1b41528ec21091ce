//! Checks that a solid represents a soup, against the soup's winding numbers.

use super::winding::{Boundary, Soupy, Winding};
use crate::shapes::Soup;
use leafless::{FillRule, Frame, Octree, Rule, Solid, Tag, build};
use leafless_testkit::{Random, alone};

/// Returns the winding number's distance beyond the threshold: 0 or more is inside the solid.
pub fn margin(fill: FillRule, winding: f64) -> f64 {
    match fill {
        FillRule::NonZero => winding.abs() - 0.5,
        FillRule::Positive => winding - 0.5,
        _ => panic!("{fill:?} is no matter of winding numbers of open soups"),
    }
}

/// True if the solid contains a point; `None` if the point is too near the boundary to decide.
pub fn is_inside(fill: FillRule, at: Winding, least: f64) -> Option<bool> {
    let margin = margin(fill, at.value);
    (margin.abs() > at.error.max(least)).then_some(margin > 0.0)
}

/// A soup on a frame.
pub struct Case<'a> {
    pub name: String,
    pub soup: &'a Soup,
    pub frame: Frame,
    pub fill: FillRule,
    /// True if cell centres are doubles, and likewise corners that are meant to lie on planes or centres.
    pub aligned: bool,
}

/// Numbers of examined points, by kind.
#[derive(Clone, Copy)]
pub struct Effort {
    pub points: usize,
    pub centres: usize,
    pub corners: usize,
    pub shares: usize,
}

/// The results of the checks.
#[derive(Default, Debug)]
pub struct Findings {
    pub faults: Vec<String>,
    /// Numbers of answers compared with the oracle, and of answers that the oracle could not decide.
    pub asked: usize,
    pub skipped: usize,
    /// Number of cells that a plain bound of the gradient decides, and number of these that the solid left
    /// open.
    pub decidable: usize,
    pub left_open: usize,
    /// Number of cells that no triangle meets, and number of these that are open.
    pub clear: usize,
    pub clear_open: usize,
}

impl Findings {
    pub fn add(&mut self, other: Findings) {
        self.faults.extend(other.faults);
        self.asked += other.asked;
        self.skipped += other.skipped;
        self.decidable += other.decidable;
        self.left_open += other.left_open;
        self.clear += other.clear;
        self.clear_open += other.clear_open;
    }

    /// Panics with the first faults, if there are any.
    pub fn judge(&self) {
        let first = &self.faults[..self.faults.len().min(10)];
        assert!(first.is_empty(), "{} faults, such as\n{}", self.faults.len(), first.join("\n"));
        // An oracle that decides too little proves nothing.
        assert!(self.skipped * 50 <= self.asked, "{} of {} skipped", self.skipped, self.asked);
        // The plain bound is taken with a margin of SLACK, so a solid that uses the same law decides all of
        // them.
        assert!(
            self.left_open * 100 <= self.decidable,
            "{} of {} cells left open",
            self.left_open,
            self.decidable
        );
    }
}

/// The factor by which a solid's bound of the gradient may exceed the oracle's.
const SLACK: f64 = 2.0;

pub fn centre(frame: &Frame, at: [u32; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| frame.origin()[axis] + (at[axis] as f64 + 0.5) * frame.cell_size())
}

/// Returns the winding number that decides a sampled cell. If lattice and soup are `aligned`, centres may lie
/// on the soup.
pub fn around_centre(truth: &mut Soupy, frame: &Frame, at: [u32; 3], aligned: bool) -> Winding {
    let p = centre(frame, at);
    let mut winding = truth.at(p);
    if winding.error > 1e-3 && aligned {
        // On an edge or a vertex of the soup, take the winding number a small step along (ε, ε², ε³), to
        // first order.
        let shift = [2f64.powi(-12), 2f64.powi(-24), 2f64.powi(-36)];
        winding = truth.at([0, 1, 2].map(|axis| p[axis] + frame.cell_size() * shift[axis]));
        winding.error = winding.error.max(0.02);
    } else if winding.on_surface && !aligned {
        winding.error = f64::INFINITY;
    }
    winding
}

/// Returns a random item of a list.
fn pick<T: Copy>(random: &mut Random, list: &[T]) -> Option<T> {
    (!list.is_empty()).then(|| list[random.below(list.len() as u64) as usize])
}

/// Builds the four trees of a solid with one thread.
pub fn trees<S: Solid>(solid: &S, frame: &Frame) -> [Octree; 4] {
    [Rule::Certified, Rule::Sampled, Rule::Inner, Rule::Outer].map(|rule| {
        let tree = build(solid, frame, rule, &alone()).unwrap();
        tree.view().check().unwrap();
        tree
    })
}

/// Checks all claims of `trees` about `case`.
pub fn examine(case: &Case<'_>, trees: &[Octree; 4], effort: Effort, seed: u64) -> Findings {
    let mut examiner = Examiner {
        case,
        trees,
        truth: Soupy::new(case.soup),
        random: Random(seed),
        findings: Findings::default(),
    };
    let cells = examiner.cells();
    examiner.points(effort.points);
    examiner.centres(&cells, effort.centres);
    examiner.corners(&cells, effort.corners);
    examiner.shares(&cells, effort.shares);
    examiner.outside(effort.points / 8);
    examiner.findings
}

/// Finest cells, grouped by use.
struct Cells {
    open: Vec<[u32; 3]>,
    /// Decided cells with an undecided neighbour.
    margin: Vec<[u32; 3]>,
}

struct Examiner<'a> {
    case: &'a Case<'a>,
    trees: &'a [Octree; 4],
    truth: Soupy,
    random: Random,
    findings: Findings,
}

impl Examiner<'_> {
    fn fault(&mut self, what: String) {
        let Case { name, frame, fill, .. } = self.case;
        self.findings.faults.push(format!("{name}, depth {}, {fill:?}: {what}", frame.depth()));
    }

    fn certified(&self, at: [u32; 3]) -> Tag {
        self.trees[0].view().tag_at(at)
    }

    fn any_cell(&mut self) -> [u32; 3] {
        [0; 3].map(|_: i32| self.random.below(self.case.frame.cells() as u64) as u32)
    }

    /// Checks inner ⊆ sampled ⊆ outer, cell by cell. Returns the interesting cells.
    fn cells(&mut self) -> Cells {
        let n = self.case.frame.cells();
        let mut cells = Cells { open: Vec::new(), margin: Vec::new() };
        let tags: Vec<Tag> = (0..n)
            .flat_map(|z| (0..n).flat_map(move |y| (0..n).map(move |x| [x, y, z])))
            .map(|at| self.certified(at))
            .collect();
        let tag = |[x, y, z]: [u32; 3]| tags[((z * n + y) * n + x) as usize];
        for z in 0..n {
            for y in 0..n {
                for x in 0..n {
                    let at = [x, y, z];
                    let here = tag(at);
                    let [sampled, inner, outer] = [1, 2, 3].map(|i: usize| self.trees[i].view().tag_at(at));
                    let consistent = match here {
                        Tag::Full => sampled == Tag::Full && inner == Tag::Full && outer == Tag::Full,
                        Tag::Empty => sampled == Tag::Empty && inner == Tag::Empty && outer == Tag::Empty,
                        _ => sampled != Tag::Partial && inner == Tag::Empty && outer == Tag::Full,
                    };
                    if !consistent {
                        self.fault(format!(
                            "{at:?} is {here:?}, sampled {sampled:?}, inner {inner:?}, outer {outer:?}"
                        ));
                    }
                    if here == Tag::Partial {
                        cells.open.push(at);
                    } else if (0..6).any(|side| {
                        let mut other = at;
                        other[side / 2] = match side % 2 {
                            0 => at[side / 2].saturating_sub(1),
                            _ => (at[side / 2] + 1).min(n - 1),
                        };
                        tag(other) == Tag::Partial
                    }) {
                        cells.margin.push(at);
                    }
                }
            }
        }
        cells
    }

    /// Checks that points anywhere, near the surface and near its boundary never contradict a verdict, and
    /// that the volume's interval contains the estimate from the points anywhere.
    fn points(&mut self, count: usize) {
        let frame = self.case.frame;
        let boundary = Boundary::of(self.case.soup);
        let (mut inside, mut outside, mut either) = (0, 0, 0);
        for i in 0..count {
            let far = 2.0 * frame.cell_size();
            let near = match i % 4 {
                1 => Some(self.point_of_surface()),
                3 if !boundary.0.is_empty() => {
                    let (a, b) = boundary.0[self.random.below(boundary.0.len() as u64) as usize].0;
                    let t = self.random.unit();
                    Some([0, 1, 2].map(|axis| a[axis] + t * (b[axis] - a[axis])))
                }
                _ => None,
            };
            let p = match near {
                Some(on) => on.map(|x| x + self.random.between(-far, far)),
                None => frame.origin().map(|low| low + self.random.unit() * frame.edge()),
            };
            let truth = self.probe(p, 1e-9);
            if near.is_none() {
                match truth {
                    Some(true) => inside += 1,
                    Some(false) => outside += 1,
                    None => either += 1,
                }
            }
        }
        let all = (inside + outside + either).max(1) as f64;
        let share = inside as f64 / all;
        let deviation = ((share * (1.0 - share)).max(10.0 / all) / all).sqrt();
        let (low, high) = (share - 5.0 * deviation, (inside + either) as f64 / all + 5.0 * deviation);
        let universe = frame.edge().powi(3);
        let volume = self.trees[0].statistics().volume();
        if volume.lower > high * universe || volume.upper < low * universe {
            let (low, high) = (low * universe, high * universe);
            self.fault(format!("volume {volume:?}, by random points {low} to {high}"));
        }
    }

    fn point_of_surface(&mut self) -> [f64; 3] {
        let [a, b, c] = self.truth.corners(self.random.below(self.truth.len() as u64) as usize);
        let (u, v) = (self.random.unit(), self.random.unit());
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        [0, 1, 2].map(|axis| a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]))
    }

    /// Checks the verdict of the cell around `p` against the truth. Returns the truth if it is certain.
    fn probe(&mut self, p: [f64; 3], least: f64) -> Option<bool> {
        let at = self.case.frame.cell_of(p);
        let tag = at.map(|at| self.certified(at));
        let winding = self.truth.at(p);
        let truth = is_inside(self.case.fill, winding, least);
        self.findings.asked += 1;
        self.findings.skipped += truth.is_none() as usize;
        let claimed = match tag {
            Some(Tag::Full) => Some(true),
            Some(Tag::Empty) => Some(false),
            _ => None,
        };
        if let (Some(truth), Some(claimed)) = (truth, claimed)
            && truth != claimed
        {
            self.fault(format!("{at:?} is {tag:?}, but at {p:?} the winding number is {}", winding.value));
        }
        truth
    }

    /// Checks that the winding number of their centre decides sampled cells.
    fn centres(&mut self, cells: &Cells, count: usize) {
        let Case { frame, fill, aligned, .. } = *self.case;
        for i in 0..count {
            let at = match i % 2 {
                0 => self.any_cell(),
                _ => match pick(&mut self.random, &cells.open) {
                    Some(at) => at,
                    None => continue,
                },
            };
            let winding = around_centre(&mut self.truth, &frame, at, aligned);
            let truth = is_inside(fill, winding, 1e-9);
            self.findings.asked += 1;
            self.findings.skipped += truth.is_none() as usize;
            let found = self.trees[1].view().tag_at(at) == Tag::Full;
            if truth.is_some_and(|truth| truth != found) {
                self.fault(format!("{at:?} sampled {found}, but the winding number is {winding:?}"));
            }
        }
    }

    /// Checks that a decided cell is right up to its corners. The winding number is harmonic, so its extremes
    /// are on the cell's boundary. The cells with centres nearest to the threshold are examined.
    fn corners(&mut self, cells: &Cells, count: usize) {
        let Case { frame, fill, .. } = *self.case;
        let mut ranked: Vec<(f64, [u32; 3])> = Vec::new();
        for _ in 0..count {
            let Some(at) = pick(&mut self.random, &cells.margin) else { return };
            let winding = self.truth.at(centre(&frame, at));
            ranked.push((margin(fill, winding.value).abs(), at));
        }
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        for &(_, at) in ranked.iter().take(count.div_ceil(4)) {
            let p = centre(&frame, at);
            for corner in 0..8 {
                // Slightly inside: contact with the surface is no overlap.
                let half = 0.499_999 * frame.cell_size();
                let p = [0, 1, 2].map(|axis| p[axis] + if corner >> axis & 1 != 0 { half } else { -half });
                self.probe(p, 1e-8);
            }
        }
    }

    /// Counts the cells that the solid leaves open without need.
    fn shares(&mut self, cells: &Cells, count: usize) {
        let Case { frame, fill, .. } = *self.case;
        let boundary = Boundary::of(self.case.soup);
        // Slightly more than the half diagonal.
        let radius = 0.866_026 * frame.cell_size();
        for i in 0..count {
            let at = match i % 2 {
                0 => self.any_cell(),
                _ => match pick(&mut self.random, &cells.open) {
                    Some(at) => at,
                    None => continue,
                },
            };
            let p = centre(&frame, at);
            if self.truth.is_near(p, radius) {
                continue;
            }
            let is_open = self.certified(at) == Tag::Partial;
            // Shares are of random cells; open cells are looked at one by one.
            if i % 2 == 0 {
                self.findings.clear += 1;
                self.findings.clear_open += is_open as usize;
            }
            let change = radius * boundary.gradient(p, radius);
            let winding = self.truth.at(p);
            if margin(fill, winding.value).abs() > SLACK * change + 1e-6 + winding.error {
                self.findings.decidable += 1;
                self.findings.left_open += is_open as usize;
            }
        }
    }

    /// Checks that a solid reported to end within the universe does so.
    fn outside(&mut self, count: usize) {
        let frame = self.case.frame;
        let exterior = self.trees[0].view().exterior();
        if exterior == Tag::Partial {
            return;
        }
        for i in 0..count {
            // Just outside of a face, or anywhere around.
            let mut p = frame.origin().map(|low| low + self.random.between(-1.0, 2.0) * frame.edge());
            if i % 2 == 0 {
                p = frame.origin().map(|low| low + self.random.unit() * frame.edge());
                let axis = self.random.below(3) as usize;
                let beyond = self.random.unit() * frame.cell_size();
                p[axis] = match self.random.below(2) {
                    0 => frame.origin()[axis] - beyond,
                    _ => frame.origin()[axis] + frame.edge() + beyond,
                };
            }
            if frame.cell_of(p).is_some() {
                continue;
            }
            let winding = self.truth.at(p);
            let truth = is_inside(self.case.fill, winding, 1e-9);
            if truth.is_some_and(|truth| truth != (exterior == Tag::Full)) {
                self.fault(format!(
                    "exterior {exterior:?}, but at {p:?} the winding number is {}",
                    winding.value
                ));
            }
        }
    }
}
