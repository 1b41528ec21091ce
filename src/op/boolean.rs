//! The set algebra of stored octrees.
//!
//! On one lattice the Booleans are exact: word logic on 64 cells at a time where the operands overlap, runs
//! of whole subtrees copied where only one of them is cut. Everything reduces to the intersection of two
//! trees, each possibly complemented on the fly, and the symmetric difference:
//!
//! ```text
//! A ∪ B = ¬(¬A ∩ ¬B)     A ∖ B = A ∩ ¬B     ¬A = ¬(A ∩ everything)
//! ```
//!
//! PARTIAL cells follow Kleene's logic, so the bounds stay bounds. Operands may be mapped files with
//! dictionaries; they are read where they lie.

use crate::control::{Control, Job, WHOLE};
use crate::error::{Damage, Error};
use crate::octree::view::{OctreeRef, Windows, root_cells};
use crate::octree::writer::Writer;
use crate::octree::{Octree, Planes, Tag};
use core::ops::Range;

/// Every point of `a` and of `b`.
///
/// The operands must lie on the same frame. Time is linear in the cells where both are cut, plus the memory
/// traffic of what is copied from one of them; the result is never larger than both together.
///
/// # Errors
/// [`Error::FrameMismatch`]; [`Error::Damaged`] if an unverified operand turns out damaged; and what
/// `control` asks for.
///
/// ```
/// use leafless::{AxisBox, Control, Frame, Rule, build, difference, union};
/// let (frame, control) = (Frame::new([0.0; 3], 8.0, 3)?, Control::default());
/// let a = build(&AxisBox::new([0.0; 3], [4.0; 3])?, &frame, Rule::Certified, &control)?;
/// let b = build(&AxisBox::new([2.0; 3], [6.0; 3])?, &frame, Rule::Certified, &control)?;
/// let both = union(a.view(), b.view(), &control)?;
/// assert_eq!(both.statistics().volume_cells(), (64 + 64 - 8, 64 + 64 - 8));
/// assert_eq!(difference(both.view(), b.view(), &control)?.statistics().volume_cells().0, 64 - 8);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn union(a: &OctreeRef<'_>, b: &OctreeRef<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    combine(Kernel { a: Operand::not(a), b: Operand::not(b), op: Op::And, flip: true }, control)
}

/// The points that `a` and `b` have in common. Like [`union`] in all else.
///
/// # Errors
/// As [`union`].
pub fn intersection(a: &OctreeRef<'_>, b: &OctreeRef<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    combine(Kernel { a: Operand::of(a), b: Operand::of(b), op: Op::And, flip: false }, control)
}

/// `a` without `b`. Like [`union`] in all else.
///
/// # Errors
/// As [`union`].
pub fn difference(a: &OctreeRef<'_>, b: &OctreeRef<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    combine(Kernel { a: Operand::of(a), b: Operand::not(b), op: Op::And, flip: false }, control)
}

/// The points of just one of `a` and `b`. Like [`union`] in all else.
///
/// # Errors
/// As [`union`].
pub fn xor(a: &OctreeRef<'_>, b: &OctreeRef<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    combine(Kernel { a: Operand::of(a), b: Operand::of(b), op: Op::Xor, flip: false }, control)
}

/// Everything but `a`, inside of its universe and out. One pass over the arrays.
///
/// # Errors
/// As [`union`].
pub fn complement(a: &OctreeRef<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    let all = Octree::uniform(*a.frame(), Tag::Full, Tag::Full)?;
    combine(Kernel { a: Operand::of(a), b: Operand::of(all.view()), op: Op::And, flip: true }, control)
}

/// The union of any number of trees, at least one. Combined two by two, which gives the same result as any
/// other order.
///
/// # Errors
/// [`Error::Argument`] if there is no tree; else as [`union`].
pub fn union_of(trees: &[OctreeRef<'_>], control: &Control<'_>) -> Result<Octree, Error> {
    reduce(trees, union, control)
}

/// The intersection of any number of trees, at least one. Like [`union_of`] in all else.
///
/// # Errors
/// As [`union_of`].
pub fn intersection_of(trees: &[OctreeRef<'_>], control: &Control<'_>) -> Result<Octree, Error> {
    reduce(trees, intersection, control)
}

/// The points that lie in an odd number of the trees, at least one. Like [`union_of`] in all else.
///
/// # Errors
/// As [`union_of`].
pub fn xor_of(trees: &[OctreeRef<'_>], control: &Control<'_>) -> Result<Octree, Error> {
    reduce(trees, xor, control)
}

type Binary = fn(&OctreeRef<'_>, &OctreeRef<'_>, &Control<'_>) -> Result<Octree, Error>;

fn reduce(trees: &[OctreeRef<'_>], op: Binary, control: &Control<'_>) -> Result<Octree, Error> {
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
            let (left, right) = (reduce(left, op, control)?, reduce(right, op, control)?);
            op(left.view(), right.view(), control)
        }
    }
}

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

/// A cell of an operand: described by an element, or all of one tag (as the tree has it, before any flip).
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
                None => return Err(Damage::Dictionary { brick: n as u64 }),
            },
            Source::Uniform(tag) => Planes::uniform(tag),
        };
        Ok(planes.complement_if(self.flip))
    }

    /// The source of cell `c` of level `e`, whose (flipped) tags are `planes` in its parent `source`.
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

    /// The windows of a task that begins at `source` on level `e`.
    #[cfg(feature = "parallel")]
    fn windows(&self, source: Source, e: usize) -> Result<Windows, Damage> {
        match source {
            Source::Element(n) => Windows::below(&self.tree, e, n),
            Source::Uniform(_) => Ok(Windows::new(&self.tree)),
        }
    }
}

/// `a op b`, complemented if `flip`.
struct Kernel<'a> {
    a: Operand<'a>,
    b: Operand<'a>,
    op: Op,
    flip: bool,
}

/// What has to be done below a cell.
#[derive(Clone, Copy)]
enum Step {
    /// Take over `a`'s subtrees in the range, complemented or not.
    CopyA(bool),
    /// Likewise from `b`.
    CopyB(bool),
    /// Combine.
    Visit,
}

/// Entries of both operands from which threads pay: below, a Boolean takes about as long as starting them.
const WORTH_THREADS: u64 = 1 << 19;

fn combine(kernel: Kernel<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    let (a, b) = (&kernel.a.tree, &kernel.b.tree);
    if a.frame() != b.frame() {
        return Err(Error::FrameMismatch);
    }
    let job = Job::new(control);
    job.check()?;
    let entries = |tree: &OctreeRef<'_>| tree.element_count() + tree.brick_count();
    control.run(entries(a) + entries(b) > WORTH_THREADS, |parallel| {
        let binary = a.is_binary() && b.is_binary();
        let mut writer = Writer::new(&job, a.frame().depth(), binary);
        if !parallel {
            // The result is never larger than both operands, so each level is written in one piece.
            for e in 0..a.levels() {
                let most = |tree: &OctreeRef<'_>| tree.starts[e + 1].saturating_sub(tree.starts[e]);
                writer.reserve(e, most(a).saturating_add(most(b)).min(1 << 26))?;
            }
        }
        let mut windows = (Windows::new(a), Windows::new(b));
        let roots = (kernel.a.root(), kernel.b.root());
        for (source, windows) in [(roots.0, &mut windows.0), (roots.1, &mut windows.1)] {
            if let Source::Element(root) = source {
                windows.admit(root, 0, root, root + 1)?;
            }
        }
        let root = kernel.visit(0, roots.0, roots.1, &mut windows, &mut writer, parallel)?;
        let exteriors = (Planes::uniform(a.exterior()), Planes::uniform(b.exterior()));
        let exterior =
            kernel.words(exteriors.0.complement_if(kernel.a.flip), exteriors.1.complement_if(kernel.b.flip));
        writer.finish(*a.frame(), root, exterior.complement_if(kernel.flip).tag(0))
    })?
}

impl Kernel<'_> {
    #[inline(always)]
    fn words(&self, a: Planes, b: Planes) -> Planes {
        match self.op {
            Op::And => a.intersection(b),
            Op::Xor => {
                // PARTIAL xor anything is PARTIAL, also where the words cannot say so.
                let (words, clash) = (a.xor(b), a.clash(b));
                Planes { lower: words.lower & !clash, upper: words.upper | clash }
            }
        }
    }

    /// What to do with a cell that needs a descent, from the operands' (flipped) tags.
    #[inline(always)]
    fn step(&self, a: Tag, b: Tag) -> Step {
        let invert = |other: Tag| self.op == Op::Xor && other == Tag::Full;
        let lone = |other: Tag| other == Tag::Full || (self.op == Op::Xor && other == Tag::Empty);
        if lone(b) {
            Step::CopyA(self.a.flip ^ invert(b) ^ self.flip)
        } else if lone(a) {
            Step::CopyB(self.b.flip ^ invert(a) ^ self.flip)
        } else {
            Step::Visit
        }
    }

    /// Combines two cells that elements of level `e` describe; returns the tag of the result.
    #[allow(clippy::too_many_arguments)]
    fn visit(
        &self,
        e: usize,
        a: Source,
        b: Source,
        windows: &mut (Windows, Windows),
        writer: &mut Writer<'_>,
        parallel: bool,
    ) -> Result<Tag, Error> {
        let (pa, pb) = (self.a.planes(a)?, self.b.planes(b)?);
        let words = self.words(pa, pb);
        let mut result = words.complement_if(self.flip);
        let clash = if self.op == Op::And { pa.clash(pb) } else { 0 };
        let real = if e == 0 { root_cells(self.a.tree.frame().depth()) } else { !0 };
        let mut open = (words.branch() | clash) & real;
        // Progress is counted in the cells below the root.
        let weight = WHOLE / real.count_ones() as usize;
        if e == 0 {
            writer.job().advance(weight * (real & !open).count_ones() as usize);
        }
        if open == 0 {
            return writer.put(e, result);
        }
        writer.job().check()?;
        if e + 1 == self.a.tree.levels() {
            return Err(Damage::BrickBranch { brick: 0 }.into());
        }
        #[cfg(feature = "parallel")]
        if parallel && e == 0 {
            self.visit_parallel(open, (a, pa), (b, pb), windows, writer, &mut result)?;
            return writer.put(e, result);
        }
        let _ = parallel;
        let mut run = Run::default();
        while open != 0 {
            let c = open.trailing_zeros();
            open &= open - 1;
            if e == 0 {
                writer.job().advance(weight);
            }
            match (self.step(pa.tag(c), pb.tag(c)), a, b) {
                (Step::CopyA(flip), Source::Element(n), _) => {
                    let child = self.a.tree.child(n, pa.branch(), c).ok_or(link(n))?;
                    result.set(c, Tag::Branch);
                    run.extend(
                        self,
                        windows,
                        writer,
                        e,
                        Run { of_b: false, flip, parent: n, range: child..child + 1 },
                    )?;
                }
                (Step::CopyB(flip), _, Source::Element(n)) => {
                    let child = self.b.tree.child(n, pb.branch(), c).ok_or(link(n))?;
                    result.set(c, Tag::Branch);
                    run.extend(
                        self,
                        windows,
                        writer,
                        e,
                        Run { of_b: true, flip, parent: n, range: child..child + 1 },
                    )?;
                }
                _ => {
                    run.flush(self, windows, writer, e)?;
                    let a = self.a.child(&mut windows.0, a, pa, c, e + 1)?;
                    let b = self.b.child(&mut windows.1, b, pb, c, e + 1)?;
                    result.set(c, self.visit(e + 1, a, b, windows, writer, false)?);
                }
            }
        }
        run.flush(self, windows, writer, e)?;
        writer.put(e, result)
    }

    /// The descent below the root as independent tasks, their outputs appended in order.
    #[cfg(feature = "parallel")]
    fn visit_parallel(
        &self,
        open: u64,
        (a, pa): (Source, Planes),
        (b, pb): (Source, Planes),
        windows: &mut (Windows, Windows),
        writer: &mut Writer<'_>,
        result: &mut Planes,
    ) -> Result<(), Error> {
        use alloc::vec::Vec;
        use rayon::prelude::*;
        let mut tasks = Vec::new();
        for c in (0..64).filter(|c| open >> c & 1 != 0) {
            let a = self.a.child(&mut windows.0, a, pa, c, 1)?;
            let b = self.b.child(&mut windows.1, b, pb, c, 1)?;
            tasks.push((c, a, b));
        }
        let subtrees = &*writer;
        let done = tasks
            .into_par_iter()
            .map(|(c, a, b)| {
                let mut windows = (self.a.windows(a, 1)?, self.b.windows(b, 1)?);
                let mut subtree = subtrees.sibling();
                let tag = match (self.step(pa.tag(c), pb.tag(c)), a, b) {
                    (Step::CopyA(flip), Source::Element(n), _) => {
                        subtree.copy(&self.a.tree, &mut windows.0, n, 1, n..n + 1, flip)?;
                        Tag::Branch
                    }
                    (Step::CopyB(flip), _, Source::Element(n)) => {
                        subtree.copy(&self.b.tree, &mut windows.1, n, 1, n..n + 1, flip)?;
                        Tag::Branch
                    }
                    // The task's own root was admitted above.
                    _ => self.visit(1, a, b, &mut windows, &mut subtree, false)?,
                };
                subtree.job().advance(WHOLE / root_cells(self.a.tree.frame().depth()).count_ones() as usize);
                Ok((c, tag, subtree))
            })
            .collect::<Result<Vec<_>, Error>>()?;
        for (c, tag, subtree) in done {
            result.set(c, tag);
            writer.append(subtree)?;
        }
        Ok(())
    }
}

/// Neighbouring subtrees of one operand that are copied together.
#[derive(Default)]
struct Run {
    of_b: bool,
    flip: bool,
    parent: usize,
    range: Range<usize>,
}

impl Run {
    /// Joins `next` to the run if it follows on, else writes the run and begins a new one.
    #[inline(always)]
    fn extend(
        &mut self,
        kernel: &Kernel<'_>,
        windows: &mut (Windows, Windows),
        writer: &mut Writer<'_>,
        e: usize,
        next: Run,
    ) -> Result<(), Error> {
        let follows = (self.of_b, self.flip, self.range.end) == (next.of_b, next.flip, next.range.start);
        if follows && !self.range.is_empty() {
            self.range.end = next.range.end;
        } else {
            self.flush(kernel, windows, writer, e)?;
            *self = next;
        }
        Ok(())
    }

    fn flush(
        &mut self,
        kernel: &Kernel<'_>,
        windows: &mut (Windows, Windows),
        writer: &mut Writer<'_>,
        e: usize,
    ) -> Result<(), Error> {
        let range = core::mem::take(&mut self.range);
        if range.is_empty() {
            return Ok(());
        }
        match self.of_b {
            false => writer.copy(&kernel.a.tree, &mut windows.0, self.parent, e + 1, range, self.flip),
            true => writer.copy(&kernel.b.tree, &mut windows.1, self.parent, e + 1, range, self.flip),
        }
    }
}

fn link(n: usize) -> Damage {
    Damage::Link { element: n as u64 }
}
