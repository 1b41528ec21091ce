//! A solid that keeps its classifier.

use super::forward::forward_solid;
use super::{AnyClassifier, AnySolid, Classifier, Solid};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Affine, Frame};
use crate::lock::Lock;
use alloc::sync::Arc;

/// A solid that keeps its classifier for the last frame that it was put on. A second query on that frame
/// starts at once. Clones share the kept classifier.
///
/// Threads may put the solid on frames at the same time. No thread waits for another: two threads that come
/// first with the same frame both prepare it.
#[derive(Clone)]
pub struct Prepared {
    solid: AnySolid,
    last: Arc<Lock<Option<(Frame, AnyClassifier<'static>)>>>,
}

impl Prepared {
    /// Wraps a solid. Nothing is prepared yet.
    pub fn new(solid: AnySolid) -> Prepared {
        Prepared { solid, last: Arc::default() }
    }

    /// The wrapped solid.
    pub fn solid(&self) -> &AnySolid {
        &self.solid
    }

    /// The kept classifier, if it is for this frame.
    fn kept(&self, frame: &Frame) -> Option<AnyClassifier<'static>> {
        self.last.with(|last| {
            last.as_ref().filter(|(kept, _)| kept == frame).map(|(_, classifier)| classifier.clone())
        })
    }
}

impl Solid for Prepared {
    type Classifier = AnyClassifier<'static>;

    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<AnyClassifier<'static>, Error> {
        if let Some(classifier) = self.kept(frame) {
            return Ok(classifier);
        }
        // The host's functions may be called here, and may query this very solid, so that no lock may be
        // held.
        let classifier = self.solid.on(frame, control)?;
        let before = self.last.with(|last| last.replace((*frame, classifier.clone())));
        drop(before);
        Ok(classifier)
    }

    fn placed(&self, placement: &Affine) -> Result<Option<Prepared>, Error> {
        Ok(Some(Prepared::new(AnySolid::placed(&self.solid, placement)?)))
    }

    /// Counts the solid, and the classifier that is kept for the last frame.
    fn kept_bytes(&self) -> u64 {
        let last = self.last.with(|last| last.as_ref().map(|(_, classifier)| classifier.clone()));
        self.solid.kept_bytes() + last.map_or(0, |classifier| classifier.kept_bytes())
    }

    forward_solid!(@shape self => self.solid);
}
