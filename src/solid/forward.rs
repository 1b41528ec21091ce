//! Handing on: the methods of the traits, written once for all who pass them to somebody else.
//!
//! `forward_solid!` and `forward_worker!` write methods whose bodies are one call. A method that is missing
//! here is noticed by a test that reads the traits.

/// All methods of [`Solid`](super::Solid).
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
    // Those that say what the shape is, without a frame.
    (@description $self:ident => $to:expr) => {
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

/// The methods of [`Worker`](super::Worker), by groups.
macro_rules! forward_worker {
    // What is remembered.
    (memory $part:ty, $self:ident => $to:expr) => {
        fn frame(&$self) -> &$crate::lattice::Frame {
            $to.frame()
        }

        fn root(&mut $self) -> Result<$crate::solid::Verdict<$part>, $crate::error::Error> {
            $to.root()
        }

        fn mark(&$self) -> usize {
            $to.mark()
        }

        fn scratch_bytes(&$self) -> usize {
            $to.scratch_bytes()
        }

        fn release(&mut $self, mark: usize) {
            $to.release(mark);
        }

        fn recall(&mut $self, cell: $crate::lattice::Cell) -> Option<$part> {
            $to.recall(cell)
        }
    };
    // The faster forms of splitting.
    (splits $part:ty, $self:ident => $to:expr) => {
        fn split(
            &mut $self,
            cell: $crate::lattice::Cell,
            part: &$part,
        ) -> Result<[$crate::solid::Verdict<$part>; 8], $crate::error::Error> {
            $to.split(cell, part)
        }

        fn split64(
            &mut $self,
            cell: $crate::lattice::Cell,
            part: &$part,
            parts: &mut alloc::vec::Vec<(u8, $part)>,
        ) -> Result<$crate::octree::Planes, $crate::error::Error> {
            $to.split64(cell, part, parts)
        }

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

        fn fill(
            &mut $self,
            cell: $crate::lattice::Cell,
            part: &$part,
            block: &mut $crate::octree::Block,
        ) -> Result<bool, $crate::error::Error> {
            $to.fill(cell, part, block)
        }

        fn chords(
            &mut $self,
            cell: $crate::lattice::Cell,
            part: &$part,
            beam: &mut $crate::dexel::Beam,
        ) -> Result<bool, $crate::error::Error> {
            $to.chords(cell, part, beam)
        }

        fn subtree(&$self, part: &$part) -> Option<$crate::solid::Subtree<'_>> {
            $to.subtree(part)
        }
    };
    // Points, and what else is known.
    (answers $part:ty, $self:ident => $to:expr) => {
        fn sample(
            &mut $self,
            cell: $crate::lattice::Cell,
            part: &$part,
        ) -> Result<Option<bool>, $crate::error::Error> {
            $to.sample(cell, part)
        }

        fn sample64(
            &mut $self,
            cell: $crate::lattice::Cell,
            parts: &[(u8, $part)],
        ) -> Result<Option<u64>, $crate::error::Error> {
            $to.sample64(cell, parts)
        }

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

        fn enclosure(
            &mut $self,
            cell: $crate::lattice::Cell,
            part: &$part,
        ) -> Result<Option<$crate::solid::Enclosure>, $crate::error::Error> {
            $to.enclosure(cell, part)
        }

        fn moments(
            &mut $self,
            cell: $crate::lattice::Cell,
            part: &$part,
        ) -> Result<Option<$crate::lattice::CellMoments>, $crate::error::Error> {
            $to.moments(cell, part)
        }

        fn area(
            &mut $self,
            cell: $crate::lattice::Cell,
            part: &$part,
        ) -> Result<Option<$crate::lattice::Interval>, $crate::error::Error> {
            $to.area(cell, part)
        }

        fn crossing(
            &mut $self,
            cell: $crate::lattice::Cell,
            part: &$part,
            segment: &$crate::solid::Segment,
        ) -> Result<Option<$crate::solid::Crossing>, $crate::error::Error> {
            $to.crossing(cell, part, segment)
        }
    };
}

pub(crate) use {forward_solid, forward_worker};

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    /// The names of the functions in a piece of source.
    fn names(source: &str) -> Vec<&str> {
        let lines = source.lines().map(str::trim).filter_map(|line| line.strip_prefix("fn "));
        lines.filter_map(|line| line.split('(').next()).collect()
    }

    #[test]
    fn no_method_is_forgotten() {
        let traits = include_str!("mod.rs");
        let here = include_str!("forward.rs");
        let body = |name: &str| {
            let start = traits.find(name).unwrap();
            let length = traits[start..].find("\n}\n").unwrap();
            &traits[start..start + length]
        };
        let (solid, worker) = here.split_once("macro_rules! forward_worker").unwrap();
        let worker = worker.split("pub(crate) use").next().unwrap();
        // What is moved is another solid, which a reference cannot be.
        let mut expected: Vec<_> =
            names(body("\npub trait Solid")).into_iter().filter(|&name| name != "placed").collect();
        let mut written = names(solid);
        expected.sort_unstable();
        written.sort_unstable();
        assert_eq!(written, expected);
        // To hand over takes two workers, of which each forwarder knows its own.
        let mut expected: Vec<_> =
            names(body("\npub trait Worker")).into_iter().filter(|&name| name != "hand_over").collect();
        let mut written = names(worker);
        expected.sort_unstable();
        written.sort_unstable();
        assert!(expected.len() > 15);
        assert_eq!(written, expected);
    }
}
