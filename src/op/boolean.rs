//! The set algebra of stored octrees.
//!
//! On one lattice the Booleans are exact. Where the operands overlap, they are combined by word logic on 64
//! cells at a time. Where only one of them is cut, whole subtrees are copied as runs. Everything reduces to
//! the symmetric difference and to the intersection of two trees, each possibly complemented on the fly:
//!
//! ```text
//! A ∪ B = ¬(¬A ∩ ¬B)     A ∖ B = A ∩ ¬B     ¬A = ¬(A ∩ everything)
//! ```
//!
//! PARTIAL cells follow Kleene's logic, so the bounds stay bounds. Operands may be mapped files with
//! dictionaries; they are read where they lie.
//!
//! If one of the trees keeps surfaces, `extended` combines them, and the result keeps surfaces.

use super::extended::{self, Combination};
use crate::control::{Control, Job, WHOLE};
use crate::dispatch::{Hot, with_popcount};
use crate::error::{Damage, Error};
use crate::lattice::Each;
use crate::memory;
use crate::octree::links::Windows;
use crate::octree::view::OctreeRef;
use crate::octree::writer::Writer;
use crate::octree::{Octree, Planes, Proof, Tag};
use crate::parallel::each;
use core::ops::Range;

/// The points that lie in `a`, in `b`, or in both.
///
/// The operands must lie on the same frame. Time is linear in the cells where both operands are cut, plus the
/// memory traffic of the subtrees that are copied from one of them. If neither tree has cuts, the result is
/// never larger than both together. The result has no metadata; [`Metadata::common`](crate::Metadata::common)
/// returns the metadata of the operands that also holds for the result.
///
/// If an operand keeps surfaces, the result keeps surfaces: see [*Set operations*](Octree#set-operations),
/// which also says why `max_bytes` should be set. More than two operands are combined fastest by
/// [`union_of`].
///
/// # Errors
/// [`Error::FrameMismatch`]; [`Error::Damaged`] if an unverified operand turns out to be damaged;
/// [`Error::Limit`] if the exact map of a surface's placements is too long; and cancellation or an exceeded
/// limit of `control`.
///
/// ```
/// use leafless::{Control, Csg, Frame, Rule, build, difference, union};
/// let (frame, control) = (Frame::new([0.0; 3], 8.0, 3)?, Control::default());
/// let a = build(&Csg::cuboid([0.0; 3], [4.0; 3])?, &frame, Rule::Certified, &control)?;
/// let b = build(&Csg::cuboid([2.0; 3], [6.0; 3])?, &frame, Rule::Certified, &control)?;
/// let both = union(a.view(), b.view(), &control)?;
/// assert_eq!(both.statistics().volume_cells(), (64 + 64 - 8, 64 + 64 - 8));
/// assert_eq!(difference(both.view(), b.view(), &control)?.statistics().volume_cells().0, 64 - 8);
/// # Ok::<(), leafless::Error>(())
/// ```
///
/// Two balls that keep their surfaces:
///
/// ```
/// use leafless::{Control, Csg, Frame, Membership, SurfaceOptions, Tag, build_extended, difference, union};
/// let (frame, control) = (Frame::new([-2.0; 3], 4.0, 20)?, Control::default());
/// let ball = |x| build_extended(&Csg::ball([x, 0.0, 0.0], 1.0)?, &frame, &SurfaceOptions::default(), &control);
/// let (a, b) = (ball(-0.5)?, ball(0.5)?);
/// let both = union(a.view(), b.view(), &control)?;
/// // Next to the circle in which the balls meet.
/// assert_eq!(both.view().contains([0.0, 0.866025, 0.0]), Membership::Inside);
/// assert_eq!(both.view().contains([0.0, 0.866026, 0.0]), Membership::Outside);
/// assert_eq!(difference(a.view(), both.view(), &control)?.view().root_tag(), Tag::Empty);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn union(a: &OctreeRef<'_>, b: &OctreeRef<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    combine(Kernel { operands: [Operand::not(a), Operand::not(b)], op: Op::And, flip: true }, control)
}

/// The points that lie in both `a` and `b`. Frames, cost and surfaces as for [`union`].
///
/// # Errors
/// As [`union`].
pub fn intersection(a: &OctreeRef<'_>, b: &OctreeRef<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    combine(Kernel { operands: [Operand::of(a), Operand::of(b)], op: Op::And, flip: false }, control)
}

/// The points of `a` that do not lie in `b`. Frames, cost and surfaces as for [`union`].
///
/// # Errors
/// As [`union`].
pub fn difference(a: &OctreeRef<'_>, b: &OctreeRef<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    combine(Kernel { operands: [Operand::of(a), Operand::not(b)], op: Op::And, flip: false }, control)
}

/// The points that lie in exactly one of `a` and `b`. Frames, cost and surfaces as for [`union`].
///
/// # Errors
/// As [`union`].
pub fn xor(a: &OctreeRef<'_>, b: &OctreeRef<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    combine(Kernel { operands: [Operand::of(a), Operand::of(b)], op: Op::Xor, flip: false }, control)
}

/// The points that do not lie in `a`, inside and outside of its universe. One pass over the arrays. If `a`
/// keeps surfaces, the result keeps all of them. The complement of the complement is the tree, byte for byte.
///
/// # Errors
/// As [`union`].
pub fn complement(a: &OctreeRef<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    if a.cuts.is_some() {
        return extended::combine(&[(*a, true)], Combination::All { flip: false }, control);
    }
    let all = Octree::uniform(*a.frame(), Tag::Full, Tag::Full)?;
    combine(Kernel { operands: [Operand::of(a), Operand::of(all.view())], op: Op::And, flip: true }, control)
}

/// The union of one or more trees. The result does not depend on the order of the trees.
///
/// Trees without cuts are combined in pairs; the limits of `control` apply to each of these steps. If a tree
/// keeps surfaces, all trees are walked at once: a cell that another tree changes is not copied, and no
/// intermediate result exists. So a batch of tools costs only the tools, whereas one operation per tool would
/// copy the part once per tool. A batch may split a cell more often than single operations do, or less often,
/// so the results agree as sets, but not always byte for byte.
///
/// # Errors
/// [`Error::Argument`] if there is no tree; otherwise as [`union`].
pub fn union_of(trees: &[OctreeRef<'_>], control: &Control<'_>) -> Result<Octree, Error> {
    if keep_surfaces(trees) {
        return with_surfaces(trees, |_| true, Combination::All { flip: true }, control);
    }
    reduce(trees, union, control)
}

/// The intersection of one or more trees. Order, cost and surfaces as for [`union_of`].
///
/// # Errors
/// [`Error::Argument`] if there is no tree; otherwise as [`union`].
pub fn intersection_of(trees: &[OctreeRef<'_>], control: &Control<'_>) -> Result<Octree, Error> {
    if keep_surfaces(trees) {
        return with_surfaces(trees, |_| false, Combination::All { flip: false }, control);
    }
    reduce(trees, intersection, control)
}

/// The points of the first tree that lie in none of the others. There must be at least one tree. Cost and
/// surfaces as for [`union_of`].
///
/// This is the way to cut a part by many tools.
///
/// # Errors
/// [`Error::Argument`] if there is no tree; otherwise as [`union`].
///
/// ```
/// use leafless::op::difference_of;
/// use leafless::{Affine, Control, Csg, Frame, SurfaceOptions, build_extended, measure};
/// let (low, high, control) = ([0.0; 3], [80.0, 60.0, 10.0], Control::default());
/// let frame = Frame::around(low, high, 20)?;
/// let extended = |csg: &Csg| build_extended(csg, &frame, &SurfaceOptions::default(), &control);
/// let mut trees = vec![extended(&Csg::cuboid(low, high)?)?];
/// for k in 0..20u8 {
///     let to = [8.0 + 16.0 * f64::from(k % 5), 7.5 + 15.0 * f64::from(k / 5), 0.0];
///     trees.push(extended(&Csg::cylinder(2.5, -1.0, 11.0)?.placed(&Affine::translation(to)?)?)?);
/// }
/// let views: Vec<_> = trees.iter().map(|tree| *tree.view()).collect();
/// let part = difference_of(&views, &control)?;
/// let volume = measure(&part, &frame, 1e-4, &control)?.volume;
/// assert!(volume.contains(48_000.0 - 20.0 * std::f64::consts::PI * 2.5 * 2.5 * 10.0));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn difference_of(trees: &[OctreeRef<'_>], control: &Control<'_>) -> Result<Octree, Error> {
    if keep_surfaces(trees) {
        return with_surfaces(trees, |i| i > 0, Combination::All { flip: false }, control);
    }
    match trees {
        [first, others @ ..] if others.len() > 1 => {
            check_all(trees)?;
            let share = LAST * others.len() as f64 / trees.len() as f64;
            let away = control.share([0.0, share], |control| union_of(others, control))?;
            control.share([share, 1.0], |control| difference(first, away.view(), control))
        }
        _ => reduce(trees, difference, control),
    }
}

/// The points that lie in an odd number of the trees. There must be at least one tree. Order, cost and
/// surfaces as for [`union_of`].
///
/// # Errors
/// [`Error::Argument`] if there is no tree; otherwise as [`union`].
pub fn xor_of(trees: &[OctreeRef<'_>], control: &Control<'_>) -> Result<Octree, Error> {
    if keep_surfaces(trees) {
        return with_surfaces(trees, |_| false, Combination::Odd, control);
    }
    reduce(trees, xor, control)
}

/// Returns whether a tree keeps surfaces.
fn keep_surfaces(trees: &[OctreeRef<'_>]) -> bool {
    trees.iter().any(|tree| tree.cuts.is_some())
}

/// Combines all trees at once. For the places where `complement` says so, the complement of the tree is used.
fn with_surfaces(
    trees: &[OctreeRef<'_>],
    not: impl Fn(usize) -> bool,
    combination: Combination,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    let operands = memory::collected(trees.iter().enumerate().map(|(i, tree)| (*tree, not(i))))?;
    extended::combine(&operands, combination, control)
}

type Binary = fn(&OctreeRef<'_>, &OctreeRef<'_>, &Control<'_>) -> Result<Octree, Error>;

/// Refuses trees on different frames, before any work is done.
fn check_all(trees: &[OctreeRef<'_>]) -> Result<(), Error> {
    match trees.iter().find(|tree| tree.frame() != trees[0].frame()) {
        Some(other) => Err(trees[0].frame().mismatch(other.frame())),
        None => Ok(()),
    }
}

fn reduce(trees: &[OctreeRef<'_>], op: Binary, control: &Control<'_>) -> Result<Octree, Error> {
    check_all(trees)?;
    match trees {
        [] => Err(Error::Argument { name: "trees", problem: "at least one is needed" }),
        [one] => {
            let all = Octree::uniform(*one.frame(), Tag::Full, Tag::Full)?;
            intersection(one, all.view(), control)
        }
        [a, b] => op(a, b, control),
        many => {
            // Neighbours first, so that the intermediate trees stay small; the recursion is log₂ n deep.
            let (left, right) = many.split_at(many.len().div_ceil(2));
            // Each half has its share of the operands. (A single tree needs no work.)
            let share = LAST * left.len() as f64 / many.len() as f64;
            let left = control.share([0.0, share], |control| reduce(left, op, control))?;
            let right = control.share([share, LAST], |control| reduce(right, op, control))?;
            control.share([LAST, 1.0], |control| op(left.view(), right.view(), control))
        }
    }
}

/// The progress fraction at which the last step of a combination of many trees begins.
const LAST: f64 = 0.8;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Op {
    And,
    Xor,
}

/// A tree, or its complement.
struct Operand<'a> {
    tree: OctreeRef<'a>,
    flip: bool,
}

/// A cell of an operand: an element, or a cell of one tag (as stored in the tree, before any flip).
#[derive(Clone, Copy)]
enum Source {
    Element(usize),
    Uniform(Tag),
}

impl<'a> Operand<'a> {
    fn of(tree: &OctreeRef<'a>) -> Operand<'a> {
        Operand { tree: *tree, flip: false }
    }

    fn not(tree: &OctreeRef<'a>) -> Operand<'a> {
        Operand { tree: *tree, flip: true }
    }

    fn root(&self) -> Source {
        match self.tree.root_tag() {
            Tag::Branch => Source::Element(0),
            tag => Source::Uniform(tag),
        }
    }

    #[inline(always)]
    fn planes(&self, source: Source) -> Result<Planes, Damage> {
        let planes = match source {
            Source::Element(n) => match self.tree.entry(n) {
                Some(planes) => planes,
                None => {
                    return Err(Damage::Dictionary {
                        brick: n.saturating_sub(self.tree.planes.len()) as u64,
                    });
                }
            },
            Source::Uniform(tag) => Planes::uniform(tag),
        };
        Ok(planes.complement_if(self.flip))
    }

    /// Returns the source of cell `c` of level `e`, whose (flipped) tags are `planes` in its parent `source`.
    #[inline(always)]
    fn child(
        &self,
        windows: &mut Windows,
        source: Source,
        planes: Planes,
        c: u32,
        e: usize,
    ) -> Result<Source, Damage> {
        match (source, planes.tag(c)) {
            (Source::Element(n), Tag::Branch) => {
                Ok(Source::Element(windows.child(&self.tree, n, planes.branch(), c, e)?))
            }
            (_, tag) => Ok(Source::Uniform(if self.flip { tag.complement() } else { tag })),
        }
    }
}

/// `a op b`, complemented if `flip`.
struct Kernel<'a> {
    operands: [Operand<'a>; 2],
    op: Op,
    flip: bool,
}

/// The state of a traversal: the passed part of each operand, and the writer of the results.
struct Walk<'w, 'j> {
    windows: [Windows; 2],
    writer: &'w mut Writer<'j>,
}

/// The next step below an element.
enum Step {
    /// Copies neighbouring subtrees of operand `of`, complemented if `flip`.
    Copy { of: usize, flip: bool, parent: usize, range: Range<usize> },
    /// Combines both operands in this cell.
    Visit(u32, [Source; 2]),
}

/// A visit written as a loop that ranks children.
struct Visit<'v, 'a, 'w, 'j> {
    kernel: &'v Kernel<'a>,
    e: usize,
    sources: [Source; 2],
    walk: &'v mut Walk<'w, 'j>,
    parallel: bool,
}

/// Entries of both operands from which threads pay. With fewer entries, joining the threads' outputs takes
/// longer than the threads save. (Measured on a solid and the same solid turned by 0.002: 1.8 million entries
/// lose a third, 7 million gain 1.4 times.)
const WORTH_THREADS: u64 = 1 << 21;

fn combine(kernel: Kernel<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    let operands = kernel.operands.each_ref().each(|operand| (operand.tree, operand.flip));
    if operands.iter().any(|(tree, _)| tree.cuts.is_some()) {
        let combination = match kernel.op {
            Op::And => Combination::All { flip: kernel.flip },
            Op::Xor => Combination::Odd,
        };
        return extended::combine(&operands, combination, control);
    }
    combine_above(WORTH_THREADS, kernel, control)
}

fn combine_above(entries: u64, kernel: Kernel<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    let [a, b] = [&kernel.operands[0].tree, &kernel.operands[1].tree];
    if a.frame() != b.frame() {
        return Err(a.frame().mismatch(b.frame()));
    }
    let job = Job::new(control);
    job.check()?;
    let count = |tree: &OctreeRef<'_>| tree.element_count() + tree.brick_count();
    control.run(count(a) + count(b) > entries, |parallel| {
        let binary = a.is_binary() && b.is_binary();
        let mut writer = Writer::new(&job, a.frame().depth(), binary);
        let most = (count(a) + count(b)).saturating_mul(size_of::<Planes>() as u64);
        if control.max_bytes.is_none_or(|limit| most <= limit) {
            // The result is never larger than both operands together, so one thread can write each level in
            // one piece. If that much memory cannot be reserved, the level is written in several pieces.
            for e in 0..a.levels() {
                let most = |tree: &OctreeRef<'_>| tree.starts[e + 1].saturating_sub(tree.starts[e]);
                let _ = writer.reserve(e, most(a).saturating_add(most(b)).min(1 << 26), !parallel);
            }
        }
        let mut walk = Walk { windows: [Windows::new(a), Windows::new(b)], writer: &mut writer };
        let roots = [kernel.operands[0].root(), kernel.operands[1].root()];
        for (source, windows) in roots.iter().zip(&mut walk.windows) {
            if let Source::Element(root) = *source {
                windows.admit(root, 0, root, root + 1)?;
            }
        }
        let root = kernel.visit(0, roots, &mut walk, parallel)?;
        let exterior = [0, 1].each(|k| {
            let operand = &kernel.operands[k];
            Planes::uniform(operand.tree.exterior()).complement_if(operand.flip)
        });
        let exterior = kernel.words(exterior).complement_if(kernel.flip).tag(0);
        let proofs = kernel.operands.each_ref().each(|operand| {
            let proof = operand.tree.proof();
            if operand.flip { proof.complement() } else { proof }
        });
        let proof = kernel.proof(proofs);
        Ok(writer.finish(*a.frame(), root, exterior)?.with_proof(proof))
    })
}

impl Kernel<'_> {
    #[inline(always)]
    fn words(&self, [a, b]: [Planes; 2]) -> Planes {
        match self.op {
            Op::And => a.intersection(b),
            Op::Xor => {
                // PARTIAL xor anything is PARTIAL, also where the word operation cannot express it.
                let (words, clash) = (a.xor(b), a.clash(b));
                Planes { lower: words.lower & !clash, upper: words.upper | clash }
            }
        }
    }

    /// The proof of the result's cells, from the proofs of the (flipped) operands' cells.
    fn proof(&self, [a, b]: [Proof; 2]) -> Proof {
        let proof = match self.op {
            Op::And => a.and(b),
            Op::Xor => a.xor(b),
        };
        if self.flip { proof.complement() } else { proof }
    }

    /// Returns the operands' (flipped) tags in the cells of two sources, the result's tags, and the cells
    /// whose result has to be computed below.
    #[inline(always)]
    fn meet(&self, sources: [Source; 2]) -> Result<([Planes; 2], Planes, u64), Damage> {
        let planes = [self.operands[0].planes(sources[0])?, self.operands[1].planes(sources[1])?];
        let words = self.words(planes);
        let clash = if self.op == Op::And { planes[0].clash(planes[1]) } else { 0 };
        Ok((planes, words.complement_if(self.flip), words.branch() | clash))
    }

    /// Takes the first of the `open` cells, which lie on level `e`, and the following cells that are copied
    /// with it.
    #[inline(always)]
    fn step(
        &self,
        open: &mut u64,
        sources: [Source; 2],
        planes: [Planes; 2],
        windows: &mut [Windows; 2],
        e: usize,
    ) -> Result<Step, Damage> {
        let (c, rest) = (open.trailing_zeros(), *open);
        for of in [0, 1] {
            let (other, branch) = (planes[1 - of], planes[of].branch());
            let full = other.full() >> c & 1 != 0;
            // Where the other operand is decided, this operand's subtree is the result.
            let decided = if full || self.op == Op::And { other.full() } else { other.empty() };
            let lone = rest & branch & decided;
            if lone >> c & 1 != 0
                && let Source::Element(parent) = sources[of]
            {
                let stop = (rest | branch) & !lone & !0 << c;
                let run = lone & (stop & stop.wrapping_neg()).wrapping_sub(1);
                *open &= !run;
                let bad = Damage::Link { element: parent as u64 };
                let child = self.operands[of].tree.child(parent, branch, c).ok_or(bad)?;
                let end = child.checked_add(run.count_ones() as usize).ok_or(bad)?;
                let flip = self.operands[of].flip ^ self.flip ^ (self.op == Op::Xor && full);
                return Ok(Step::Copy { of, flip, parent, range: child..end });
            }
        }
        *open &= rest - 1;
        let [wa, wb] = windows;
        let a = self.operands[0].child(wa, sources[0], planes[0], c, e)?;
        Ok(Step::Visit(c, [a, self.operands[1].child(wb, sources[1], planes[1], c, e)?]))
    }

    /// Does the next step on level `e`; returns the tag of a visited cell.
    #[inline(always)]
    fn go(
        &self,
        e: usize,
        step: Step,
        walk: &mut Walk<'_, '_>,
        parallel: bool,
    ) -> Result<Option<(u32, Tag)>, Error> {
        match step {
            Step::Copy { of, flip, parent, range } => {
                let windows = &mut walk.windows[of];
                walk.writer.copy(&self.operands[of].tree, windows, parent, e, range, flip)?;
                Ok(None)
            }
            Step::Visit(c, sources) if e + 1 == self.operands[0].tree.levels() => {
                let (_, result, open) = self.meet(sources)?;
                if open != 0 {
                    return Err(self.branching_brick(sources).into());
                }
                Ok(Some((c, walk.writer.put(e, result)?)))
            }
            Step::Visit(c, sources) => Ok(Some((c, self.visit(e, sources, walk, parallel)?))),
        }
    }

    /// Combines two cells that elements of level `e` describe; returns the tag of the result.
    fn visit(
        &self,
        e: usize,
        sources: [Source; 2],
        walk: &mut Walk<'_, '_>,
        parallel: bool,
    ) -> Result<Tag, Error> {
        with_popcount(Visit { kernel: self, e, sources, walk, parallel })
    }

    /// The damage when cells of the deepest level claim to have children.
    #[cold]
    fn branching_brick(&self, sources: [Source; 2]) -> Damage {
        let brick = [0, 1].into_iter().find_map(|k| match sources[k] {
            Source::Element(n) => Some(n - self.operands[k].tree.planes.len()),
            Source::Uniform(_) => None,
        });
        Damage::BrickBranch { brick: brick.unwrap_or(0) as u64 }
    }

    /// Runs the steps below an element of the first two levels as independent tasks, and appends their
    /// outputs in order.
    fn visit_parallel(
        &self,
        e: usize,
        mut open: u64,
        sources: [Source; 2],
        planes: [Planes; 2],
        walk: &mut Walk<'_, '_>,
        result: &mut Planes,
    ) -> Result<(), Error> {
        let mut tasks = memory::with_capacity(open.count_ones() as usize)?;
        while open != 0 {
            let before = open.count_ones();
            let step = self.step(&mut open, sources, planes, &mut walk.windows, e)?;
            let below = match &step {
                Step::Copy { of, parent, range, .. } => {
                    walk.windows[*of].admit(*parent, e, range.start, range.end)?;
                    [0, 1].each(|k| (k == *of).then(|| range.clone()))
                }
                Step::Visit(_, children) => children.each(|child| match child {
                    Source::Element(n) => Some(n..n + 1),
                    Source::Uniform(_) => None,
                }),
            };
            let mut windows = walk.windows.clone();
            for (k, range) in below.into_iter().enumerate() {
                if let Some(range) = range {
                    windows[k] = walk.windows[k].below(&self.operands[k].tree, e, range)?;
                }
            }
            tasks.push((step, windows, before - open.count_ones()));
        }
        let subtrees = &*walk.writer;
        let done = each(true, tasks.into_iter(), |(step, windows, cells)| {
            let mut subtree = subtrees.sibling();
            let found = self.go(e, step, &mut Walk { windows, writer: &mut subtree }, true)?;
            self.advance(e, cells, &subtree);
            Ok((found, subtree))
        })?;
        for (found, subtree) in done {
            if let Some((c, tag)) = found {
                result.set(c, tag);
            }
            walk.writer.append(subtree)?;
        }
        Ok(())
    }

    /// Reports cells on level `e` as done. Progress is counted in the cells below the root.
    #[inline(always)]
    fn advance(&self, e: usize, cells: u32, writer: &Writer<'_>) {
        if e == 1 {
            let all = self.operands[0].tree.root_cells().count_ones() as usize;
            writer.job().advance(WHOLE / all * cells as usize);
        }
    }
}

impl Hot for Visit<'_, '_, '_, '_> {
    type Output = Result<Tag, Error>;

    #[inline(always)]
    fn run(self) -> Result<Tag, Error> {
        let Visit { kernel, e, sources, walk, parallel } = self;
        let (planes, mut result, open) = kernel.meet(sources)?;
        let real = if e == 0 { kernel.operands[0].tree.root_cells() } else { !0 };
        let mut open = open & real;
        kernel.advance(e + 1, (real & !open).count_ones(), walk.writer);
        if open == 0 {
            return walk.writer.put(e, result);
        }
        walk.writer.job().check()?;
        let levels = kernel.operands[0].tree.levels();
        if e + 1 == levels {
            return Err(kernel.branching_brick(sources).into());
        }
        if parallel && (e == 0 || e == 1 && e + 3 < levels) {
            kernel.visit_parallel(e + 1, open, sources, planes, walk, &mut result)?;
            return walk.writer.put(e, result);
        }
        while open != 0 {
            let before = open.count_ones();
            let step = kernel.step(&mut open, sources, planes, &mut walk.windows, e + 1)?;
            if let Some((c, tag)) = kernel.go(e + 1, step, walk, parallel)? {
                result.set(c, tag);
            }
            kernel.advance(e + 1, before - open.count_ones(), walk.writer);
        }
        walk.writer.put(e, result)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Frame;
    use crate::octree::brick::{BrickArray, Bricks};
    use alloc::vec;
    use alloc::vec::Vec;

    /// A tree of depth 6 whose root is cut in all 64 cells, each cut in its first cell; `link` gives the
    /// brick link of a cell's element.
    fn with_tree<R>(base: u64, link: impl Fn(u16) -> u16, ask: impl FnOnce(&OctreeRef<'_>) -> R) -> R {
        let mut planes = vec![Planes { lower: 1, upper: 0 }; 65];
        planes[0] = Planes::uniform(Tag::Branch);
        let rel: Vec<u16> = core::iter::once(0).chain((0..64).map(link)).collect();
        let bricks: Vec<u64> = (1..=64).collect();
        let mut starts = [0, 1, 65, 129, 129, 129, 129, 129, 129, 129, 129];
        starts[4..].fill(129);
        ask(&OctreeRef {
            frame: Frame::new([0.0; 3], 1.0, 6).unwrap(),
            root: Tag::Branch,
            exterior: Tag::Empty,
            proof: Proof::CERTIFIED,
            planes: &planes,
            rel: &rel,
            base: &[base],
            bricks: Bricks::One(BrickArray::Raw(&bricks)),
            starts,
            table: None,
            is_linked: false,
            cuts: None,
        })
    }

    /// The results of every operation with an operand that leaves each cell of the root alone, with one
    /// thread and with several.
    fn results(tree: &OctreeRef<'_>) -> Vec<Result<Octree, Error>> {
        let whole = |tag| Octree::uniform(*tree.frame(), tag, tag).unwrap();
        let mut results = Vec::new();
        for other in [whole(Tag::Empty), whole(Tag::Full)] {
            for (op, flip) in [(Op::And, false), (Op::And, true), (Op::Xor, false)] {
                for (entries, threads) in [(u64::MAX, 1), (0, 2)] {
                    let operands = [Operand { tree: *tree, flip }, Operand { tree: *other.view(), flip }];
                    let kernel = Kernel { operands, op, flip };
                    results.push(combine_above(entries, kernel, &Control::threads(threads)));
                }
            }
        }
        results
    }

    #[test]
    fn a_sound_tree_is_combined_the_same_by_any_number_of_threads() {
        with_tree(
            1,
            |cell| 64 + cell,
            |tree| {
                tree.check().unwrap();
                for pair in results(tree).chunks_exact(2) {
                    assert_eq!(pair[0].as_ref().unwrap(), pair[1].as_ref().unwrap());
                }
            },
        );
    }

    /// The number of bricks of the result; none if the damage was found. (For a run that is copied whole only
    /// the ends are checked, so not all damage is found.)
    fn copied(result: &Result<Octree, Error>) -> u64 {
        match result {
            Ok(tree) => tree.view().brick_count(),
            Err(Error::Damaged(_)) => 0,
            Err(other) => panic!("{other}"),
        }
    }

    #[test]
    fn shared_or_absent_children_never_multiply() {
        type Link = fn(u16) -> u16;
        let links: [(u64, Link); 5] = [
            (1, |cell| 64 + cell % 2 * 32),
            (1, |cell| 64 + cell / 2),
            (1, |_| 64),
            (u64::MAX, |_| 0),
            (u64::MAX - 64, |cell| 64 + cell),
        ];
        for (base, link) in links {
            with_tree(base, link, |tree| {
                assert!(tree.check().is_err());
                assert!(results(tree).iter().all(|result| copied(result) <= 64));
            });
        }
    }
}
