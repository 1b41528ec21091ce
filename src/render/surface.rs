//! Surfaces that lines of sight meet: drawn, with their edges.

use super::cast::Cast;
use super::outline::{Field, Point};
use super::sight::{Finish, Sight};
use super::stage::Stage;
use super::tile::Tile;
use crate::error::Error;
use crate::octree::OctreeRef;
use crate::query::Touch;
use glam::DVec3;

/// What a line of sight meets.
pub struct Seen {
    /// After so many times its direction.
    pub t: f64,
    /// The outward normal there; `None` if the line begins inside.
    pub normal: Option<DVec3>,
    pub finish: Finish,
}

/// Draws what `see` makes of the cells of an octree that lines of sight meet. `blur`: the length over which normals change
/// where the surface has an edge.
pub fn paint(
    tile: &mut Tile<'_>,
    stage: &Stage<'_>,
    tree: &OctreeRef<'_>,
    finish: &Finish,
    blur: f64,
    mut see: impl FnMut(&Sight, Touch) -> Result<Option<Seen>, Error>,
) -> Result<(), Error> {
    let mut cast = Cast::new(tree, *stage);
    let Some(outline) = &finish.edges else {
        while let Some(met) = cast.next(tile)? {
            for (sight, touch) in met {
                if let Some(seen) = see(sight, touch)? {
                    let light = sight.light(&seen.finish, tile.view, seen.normal);
                    tile.put(sight.sample, sight.start + seen.t, light)?;
                }
            }
        }
        return Ok(());
    };
    let mut field = Field::new(tile, outline, blur, tree.frame())?;
    while let Some(met) = cast.next(&field.window)? {
        for (sight, touch) in met {
            let Some(seen) = see(sight, touch)? else { continue };
            let depth = sight.start + seen.t;
            let place = sight.from + sight.along * seen.t;
            let normal = sight.outward(seen.normal).normalize_or_zero();
            field.put(sight.sample, Point { place, normal, depth });
            if let Some(sample) = field.sample_of_tile(sight.sample, tile) {
                tile.put(sample, depth, sight.light(&seen.finish, tile.view, seen.normal))?;
            }
        }
    }
    field.draw(tile, stage.job)
}
