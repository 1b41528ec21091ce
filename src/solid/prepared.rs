//! A solid that keeps what it is on a frame.

use super::forward::forward_solid;
use super::{AnyClassifier, AnySolid, Classifier, Solid};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Affine, Frame};
use crate::lock::Lock;
use alloc::sync::Arc;

/// A solid that keeps one frame prepared, the last that it was put on: asked on it again, it is there at
/// once. A clone shares what is kept.
///
/// Threads may put it on frames at the same time. None waits for another: two that come first with the same
/// frame both prepare it.
#[derive(Clone)]
pub struct Prepared {
    solid: AnySolid,
    last: Arc<Lock<Option<(Frame, AnyClassifier)>>>,
}

impl Prepared {
    /// A solid that nobody has put on a frame yet.
    pub fn new(solid: AnySolid) -> Prepared {
        Prepared { solid, last: Arc::default() }
    }

    /// The solid.
    pub fn solid(&self) -> &AnySolid {
        &self.solid
    }

    /// What is kept, if it is for this frame.
    fn kept(&self, frame: &Frame) -> Option<AnyClassifier> {
        self.last.with(|last| {
            last.as_ref().filter(|(kept, _)| kept == frame).map(|(_, classifier)| classifier.clone())
        })
    }
}

impl Solid for Prepared {
    type Classifier = AnyClassifier;

    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<AnyClassifier, Error> {
        if let Some(classifier) = self.kept(frame) {
            return Ok(classifier);
        }
        // The host's functions may be called here, and may ask this very solid: no lock is held.
        let classifier = self.solid.on(frame, control)?;
        let before = self.last.with(|last| last.replace((*frame, classifier.clone())));
        drop(before);
        Ok(classifier)
    }

    fn placed(&self, placement: &Affine) -> Result<Option<Prepared>, Error> {
        Ok(Some(Prepared::new(AnySolid::placed(&self.solid, placement)?)))
    }

    /// The solid's, and what is kept for the last frame.
    fn kept_bytes(&self) -> u64 {
        let last = self.last.with(|last| last.as_ref().map(|(_, classifier)| classifier.clone()));
        self.solid.kept_bytes() + last.map_or(0, |classifier| classifier.kept_bytes())
    }

    forward_solid!(@shape self => self.solid);
}
