//! Macros that forward the methods of the traits to another value.
//!
//! `forward_solid!`, `forward_classifier!`, `forward_parts!`, `forward_batch!` and `forward_answers!` write
//! methods whose bodies are one call. If a macro lacks a method that has no default, the code that uses the
//! macro does not compile.

/// Forwards all methods of [`Solid`](super::Solid) but `placed`: a moved solid is a new value, which a
/// reference cannot be.
macro_rules! forward_solid {
    ($classifier:ty, $self:ident => $to:expr) => {
        type Classifier = $classifier;

        fn on(
            &$self,
            frame: &$crate::lattice::Frame,
            control: &$crate::control::Control<'_>,
        ) -> Result<$classifier, $crate::error::Error> {
            $to.on(frame, control)
        }

        $crate::solid::forward::forward_solid!(@description $self => $to);
    };
    // The methods that describe the shape without a frame, and its memory.
    (@description $self:ident => $to:expr) => {
        fn kept_bytes(&$self) -> u64 {
            $to.kept_bytes()
        }

        fn sole_mesh(&$self) -> Option<&$crate::mesh::TriangleMesh> {
            $to.sole_mesh()
        }

        $crate::solid::forward::forward_solid!(@shape $self => $to);
    };
    (@shape $self:ident => $to:expr) => {
        fn bounds(&$self) -> Option<$crate::lattice::Bounds> {
            $to.bounds()
        }

        fn home(&$self) -> Option<$crate::lattice::Frame> {
            $to.home()
        }

        fn fingerprint(&$self) -> Option<$crate::solid::Fingerprint> {
            $to.fingerprint()
        }

        fn motion(&$self) -> $crate::solid::Motion {
            $to.motion()
        }
    };
}

/// Forwards the methods of [`Classifier`](super::Classifier) but `worker`.
macro_rules! forward_classifier {
    ($self:ident => $to:expr) => {
        fn frame(&$self) -> &$crate::lattice::Frame {
            $to.frame()
        }

        fn exterior(&$self) -> $crate::octree::Tag {
            $to.exterior()
        }

        fn proof(&$self) -> $crate::octree::Proof {
            $to.proof()
        }

        fn answer_whole(
            &$self,
            question: $crate::solid::WholeQuestion<'_>,
            control: &$crate::control::Control<'_>,
        ) -> Result<(), $crate::error::Error> {
            $to.answer_whole(question, control)
        }

        fn kept_bytes(&$self) -> u64 {
            $to.kept_bytes()
        }
    };
}

/// Forwards the methods of [`Parts`](super::Parts) but `hand_over`, which takes two workers.
macro_rules! forward_parts {
    ($part:ty, $self:ident => $to:expr) => {
        type Part = $part;

        fn mark(&$self) -> usize {
            $to.mark()
        }

        fn release(&mut $self, mark: usize) {
            $to.release(mark);
        }

        fn scratch_bytes(&$self) -> usize {
            $to.scratch_bytes()
        }
    };
}

/// Forwards the methods of [`Batch`](super::Batch): all of them, or (`answers`) all but the methods that
/// split.
macro_rules! forward_batch {
    ($part:ty, $self:ident => $to:expr) => {
        fn likes_many(&$self) -> bool {
            $to.likes_many()
        }

        fn split_many(
            &mut $self,
            cells: &[($crate::lattice::Cell, $part)],
            control: &$crate::control::Control<'_>,
            verdicts: &mut alloc::vec::Vec<[$crate::solid::Verdict<$part>; 8]>,
        ) -> Result<(), $crate::error::Error> {
            $to.split_many(cells, control, verdicts)
        }

        $crate::solid::forward::forward_batch!(answers $part, $self => $to);
    };
    (answers $part:ty, $self:ident => $to:expr) => {
        fn sample_many(
            &mut $self,
            cells: &[($crate::lattice::Cell, $part)],
            control: &$crate::control::Control<'_>,
            inside: &mut alloc::vec::Vec<Option<bool>>,
        ) -> Result<(), $crate::error::Error> {
            $to.sample_many(cells, control, inside)
        }

        fn inside(
            &mut $self,
            points: &[[f64; 3]],
            answers: &mut [Option<bool>],
        ) -> Result<(), $crate::error::Error> {
            $to.inside(points, answers)
        }

        fn recall(&mut $self, cell: $crate::lattice::Cell) -> Option<$part> {
            $to.recall(cell)
        }
    };
}

/// Forwards the methods of [`Worker`](super::Worker) that do not split.
macro_rules! forward_answers {
    ($part:ty, $self:ident => $to:expr) => {
        fn frame(&$self) -> &$crate::lattice::Frame {
            $to.frame()
        }

        fn root(&mut $self) -> Result<$crate::solid::Verdict<$part>, $crate::error::Error> {
            $to.root()
        }

        fn answer(
            &mut $self,
            cell: $crate::lattice::Cell,
            part: &$part,
            question: $crate::solid::Question<'_>,
        ) -> Result<(), $crate::error::Error> {
            $to.answer(cell, part, question)
        }

        fn sample64(
            &mut $self,
            cell: $crate::lattice::Cell,
            parts: &[(u8, $part)],
        ) -> Result<Option<u64>, $crate::error::Error> {
            $to.sample64(cell, parts)
        }
    };
}

pub(crate) use {forward_answers, forward_batch, forward_classifier, forward_parts, forward_solid};
