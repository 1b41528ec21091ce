//! Proofs that two placed solids are apart, and that a solid lies within the container.

use super::relative::Relative;
use super::wall::{wall, wall_of_box};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::{sqrt, two_diff, two_sum};
use crate::lattice::{Affine, Bounds, Frame, Interval, MAX_DEPTH, axes};
use crate::query::{Asked, GapVerdict, Overlap, Ready, interference};
use crate::solid::{AnySolid, Csg, MeshSolid, Solid};

/// The maximal number of splits for one pair.
pub(super) const PAIR_SPLITS: u64 = 1 << 12;

/// The maximal number of splits for meshes that triangles do not separate: they touch, or nearly so, and
/// cells seldom help.
const TOUCH_SPLITS: u64 = 1 << 9;

/// The range and the resolution of comparisons.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near {
    /// The distance beyond which boxes separate solids (model units).
    pub(super) reach: f64,
    /// The size below which smaller cells give no more information (model units).
    pub(super) finest: f64,
}

impl Near {
    /// Builds the limits. Stored octrees among the solids have no information below the size of their cells.
    pub(super) fn new<'s>(reach: f64, solids: impl Iterator<Item = &'s AnySolid>) -> Near {
        let cells = solids.filter_map(|solid| solid.home()).map(|home| 0.5 * home.cell_size());
        Near { reach, finest: cells.fold(f64::INFINITY, f64::min) }
    }

    fn frame(&self, around: &Bounds) -> Result<Frame, Error> {
        let mut frame = Frame::fitted(around.min, around.max, MAX_DEPTH)?;
        while self.finest < f64::INFINITY && frame.depth() > 1 && 2.0 * frame.cell_size() <= self.finest {
            frame = frame.with_depth(frame.depth() - 1)?;
        }
        Ok(frame)
    }
}

/// A solid prepared for comparisons.
pub(super) struct Piece(Ready);

/// The result of comparing two solids.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known {
    pub(super) verdict: GapVerdict,
    /// The bounds of their distance.
    pub(super) gap: Interval,
    pub(super) splits: u64,
}

impl Piece {
    /// Prepares a solid for comparison with solids within the reach of `near`.
    pub(super) fn new(
        solid: &AnySolid,
        bounds: &Bounds,
        near: &Near,
        control: &Control<'_>,
    ) -> Result<Piece, Error> {
        let frame = near.frame(&bounds.grown(near.reach))?;
        Ok(Piece(Ready::new(solid, bounds, &frame, control)?))
    }

    pub(super) fn solid(&self) -> &AnySolid {
        self.0.solid()
    }

    /// The bounding box.
    pub(super) fn bounds(&self) -> &Bounds {
        self.0.bounds()
    }

    /// Returns whether another solid, in this one's coordinates, is no nearer than `least`; with `least` = 0,
    /// whether the two do not overlap.
    ///
    /// `places` are the placements of both in the model.
    pub(super) fn is_apart(
        &self,
        other: &Piece,
        seen: &Relative,
        places: [&Affine; 2],
        least: f64,
        control: &Control<'_>,
    ) -> Result<Known, Error> {
        let control = &Control { max_splits: control.max_splits.or(Some(PAIR_SPLITS)), ..*control };
        let asked = Asked::AtLeast(seen.needed(least));
        let found = self.0.compared(&other.0, &seen.placement, asked, control)?;
        let gap = seen.distance(found.distance);
        let splits = found.splits.iter().sum();
        // (The needed distance is at least `least`, including all rounding errors.)
        if found.distance.lower >= seen.needed(least) {
            return Ok(Known { verdict: GapVerdict::Yes, gap, splits });
        }
        if least > 0.0 {
            let verdict = if gap.upper < least { GapVerdict::No } else { GapVerdict::Undecided };
            return Ok(Known { verdict, gap, splits });
        }
        // The solids may touch: exact numbers decide, where available.
        let are_meshes = is_mesh(self.solid()) && is_mesh(other.solid());
        let most = control.max_splits.map(|most| if are_meshes { most.min(TOUCH_SPLITS) } else { most });
        let control = &Control { max_splits: most, ..*control };
        let placed = [self.0.solid().placed(places[0])?, other.0.solid().placed(places[1])?];
        let boxes = [self.0.bounds().placed(places[0]), other.0.bounds().placed(places[1])];
        let [Some(own), Some(others)] = boxes else {
            return Ok(Known { verdict: GapVerdict::Undecided, gap, splits });
        };
        let around = own.hull(&others);
        let frame = Frame::fitted(around.min, around.max, MAX_DEPTH)?;
        let found = interference(&placed[0], &placed[1], &frame, f64::INFINITY, control)?;
        let splits = splits + found.splits.iter().sum::<u64>();
        Ok(match found.verdict {
            Overlap::Disjoint => Known { verdict: GapVerdict::Yes, gap, splits },
            Overlap::Overlapping => Known { verdict: GapVerdict::No, gap: Interval::exactly(0.0), splits },
            Overlap::Undecided => Known { verdict: GapVerdict::Undecided, gap, splits },
        })
    }

    /// Returns the distance of another solid, unless it is at least `below`.
    pub(super) fn distance(
        &self,
        other: &Piece,
        seen: &Relative,
        (tolerance, below): (f64, f64),
        control: &Control<'_>,
    ) -> Result<(Interval, u64), Error> {
        let control = &Control { max_splits: control.max_splits.or(Some(PAIR_SPLITS)), ..*control };
        let below = if below < f64::INFINITY { seen.needed(below.max(0.0)) } else { below };
        let asked = Asked::Distance { tolerance, below };
        let found = self.0.compared(&other.0, &seen.placement, asked, control)?;
        Ok((seen.distance(found.distance), found.splits.iter().sum()))
    }
}

fn is_mesh(solid: &AnySolid) -> bool {
    solid.get::<MeshSolid>().is_some()
}

/// The container.
pub(super) struct Container {
    /// The space around the container, as far as any placed copy may reach.
    wall: Piece,
    wall_solid: AnySolid,
    /// The same as a mesh, for comparison with meshes, if the container is proven to be a box and is not a
    /// mesh.
    wall_mesh: Option<Piece>,
    solid: AnySolid,
    bounds: Bounds,
    outer: Bounds,
    /// Whether the container is proven to fill its whole bounding box.
    is_box: bool,
    clearance: f64,
    near: Near,
}

impl Container {
    pub(super) fn new(
        solid: &AnySolid,
        clearance: f64,
        near: &Near,
        control: &Control<'_>,
    ) -> Result<Container, Error> {
        let bounds = super::item::bounds_of(solid, "container")?;
        let outer = bounds.grown(near.reach + clearance);
        let wall_solid = wall(solid, &outer, control)?;
        let wall = Piece::new(&wall_solid, &outer, &Near { reach: 0.0, ..*near }, control)?;
        let mut container = Container {
            wall,
            wall_solid,
            wall_mesh: None,
            solid: solid.clone(),
            bounds,
            outer,
            is_box: false,
            clearance,
            near: *near,
        };
        container.is_box = container.holds(&bounds, control)?;
        if container.is_box && !is_mesh(solid) {
            let wall = wall_of_box(&bounds, &outer)?;
            container.wall_mesh = Some(Piece::new(&wall, &outer, &Near { reach: 0.0, ..*near }, control)?);
        }
        Ok(container)
    }

    pub(super) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    pub(super) fn is_box(&self) -> bool {
        self.is_box
    }

    pub(super) fn clearance(&self) -> f64 {
        self.clearance
    }

    /// Returns whether a box is proven to lie within the container.
    fn holds(&self, block: &Bounds, control: &Control<'_>) -> Result<bool, Error> {
        const SPLITS: u64 = 64;
        let control = Control { max_splits: Some(SPLITS), ..*control };
        let block = Csg::cuboid(block.min, block.max)?;
        let frame = self.near.frame(&self.outer)?;
        let found = interference(&self.wall_solid, &block, &frame, f64::INFINITY, &control)?;
        Ok(found.verdict == Overlap::Disjoint)
    }

    pub(super) fn solid(&self) -> &AnySolid {
        &self.solid
    }

    /// Returns whether a placed copy lies within the container and keeps the distance from the wall; `around`
    /// is the copy's bounding box.
    pub(super) fn takes(
        &self,
        piece: &Piece,
        placement: &Affine,
        around: &Bounds,
        control: &Control<'_>,
    ) -> Result<Known, Error> {
        let block = wider(around, self.clearance);
        let is_inside =
            (0..3).all(|k| self.bounds.min[k] <= block.min[k] && block.max[k] <= self.bounds.max[k]);
        let known = |verdict, gap| Ok(Known { verdict, gap, splits: 0 });
        if is_inside && self.is_box {
            return known(GapVerdict::Yes, Interval::between(self.clearance, f64::INFINITY));
        }
        let is_within =
            (0..3).all(|k| self.outer.min[k] <= around.min[k] && around.max[k] <= self.outer.max[k]);
        if !is_within {
            // The wall does not extend so far from the container. A copy that does not even meet the
            // container's box is outside.
            let away = self.bounds.common(around).is_none();
            return known(
                if away { GapVerdict::No } else { GapVerdict::Undecided },
                Interval::between(0.0, f64::INFINITY),
            );
        }
        let wall = self.wall_mesh.as_ref().filter(|_| is_mesh(piece.solid())).unwrap_or(&self.wall);
        let places = [&Affine::IDENTITY, placement];
        wall.is_apart(piece, &Relative::of(placement), places, self.clearance, control)
    }
}

/// The length of a box's diagonal, rounded up.
pub(super) fn diagonal(bounds: &Bounds) -> f64 {
    let sides: [f64; 3] = axes(|k| bounds.max[k] - bounds.min[k]);
    sqrt(sides.iter().map(|side| side * side).sum::<f64>()) * (1.0 + 1e-12)
}

/// Returns a box that contains all points no further than a margin from a box, along each axis. It is rounded
/// outward, but only where rounding occurs.
pub(super) fn wider(bounds: &Bounds, margin: f64) -> Bounds {
    let rounded = |(sum, rest): (f64, f64), sense: f64| match rest * sense {
        off if off > 0.0 && sense > 0.0 => sum.next_up(),
        off if off > 0.0 => sum.next_down(),
        _ => sum,
    };
    Bounds {
        min: bounds.min.each(|low| rounded(two_diff(low, margin), -1.0)),
        max: bounds.max.each(|high| rounded(two_sum(high, margin), 1.0)),
    }
}

/// Returns a lower bound of the distance of two boxes; a negative number if their interiors meet.
pub(super) fn boxes_apart(a: &Bounds, b: &Bounds) -> f64 {
    let gap = |high: f64, low: f64| {
        let (gap, rest) = two_diff(high, low);
        if rest < 0.0 { gap.next_down() } else { gap }
    };
    let gaps: [f64; 3] = axes(|k| gap(a.min[k], b.max[k]).max(gap(b.min[k], a.max[k])));
    if gaps.iter().all(|&gap| gap < 0.0) {
        return -1.0;
    }
    let parts = gaps.each(|gap| gap.max(0.0));
    let alone = parts.iter().filter(|&&part| part > 0.0).count() <= 1;
    if alone {
        return parts.iter().sum();
    }
    sqrt(parts.iter().map(|part| part * part).sum::<f64>()) * (1.0 - 1e-12)
}
