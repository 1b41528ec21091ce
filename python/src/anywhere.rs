//! Octrees that can be queried on any frame.

use leafless::solid::{AnyClassifier, Fingerprint, Motion, Transform};
use leafless::{Affine, AnySolid, Bounds, Control, Error, Frame, Solid, TriangleMesh};

/// A solid with a frame of its own that can be queried on any frame. On another universe its cells are looked
/// up. The lookup uses whole cells if that universe is the solid's own one, doubled; otherwise the cells blur
/// by about one cell.
#[derive(Clone)]
pub struct Anywhere(AnySolid);

/// Wraps a solid so that it can be queried on any frame.
pub fn anywhere(solid: &AnySolid) -> AnySolid {
    if solid.home().is_some() { AnySolid::new(Anywhere(solid.clone())) } else { solid.clone() }
}

impl Solid for Anywhere {
    type Classifier = AnyClassifier<'static>;

    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<AnyClassifier<'static>, Error> {
        match self.0.home() {
            Some(own) if !own.same_universe(frame) => {
                AnySolid::new(Transform::new(self.0.clone(), &own, &Affine::IDENTITY)).on(frame, control)
            }
            _ => self.0.on(frame, control),
        }
    }

    fn bounds(&self) -> Option<Bounds> {
        self.0.bounds()
    }

    fn home(&self) -> Option<Frame> {
        self.0.home()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.0.fingerprint()
    }

    fn placed(&self, placement: &Affine) -> Result<Option<Self>, Error> {
        self.0.placed(placement).map(|moved| Some(Anywhere(moved)))
    }

    fn motion(&self) -> Motion {
        self.0.motion()
    }

    fn kept_bytes(&self) -> u64 {
        self.0.kept_bytes()
    }

    fn sole_mesh(&self) -> Option<&TriangleMesh> {
        self.0.sole_mesh()
    }
}
