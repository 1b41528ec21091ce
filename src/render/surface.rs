//! Surfaces that lines of sight meet, drawn with their edges.

use super::cast::Cast;
use super::light::Light;
use super::outline::{Field, Point};
use super::sight::{Finish, SightLine};
use super::stage::{Colouring, Stage};
use super::tile::Tile;
use crate::attribute::Attribute;
use crate::error::Error;
use crate::octree::OctreeRef;
use crate::query::TouchedCell;
use glam::DVec3;

/// The appearance of a surface.
#[derive(Clone, Copy)]
pub struct Skin<'a> {
    pub finish: Finish,
    /// The attribute whose values are shown, and the colours of the values.
    pub values: Option<(&'a dyn Attribute, Colouring<'a>)>,
}

impl Skin<'_> {
    /// Refuses invalid edges.
    pub fn check(&self) -> Result<(), Error> {
        self.finish.edges.map_or(Ok(()), |outline| outline.check())
    }

    /// The appearance at a point, given the outward normal, or the direction to the viewer. Values are taken
    /// `below` under the surface.
    fn finish(&self, place: DVec3, outward: DVec3, below: f64) -> Result<Finish, Error> {
        let Some((attribute, colour)) = self.values else { return Ok(self.finish) };
        let shown = colour(attribute.value((place - below * outward.normalize_or_zero()).to_array())?);
        Ok(Finish { colour: shown, cut: shown, ..self.finish })
    }
}

/// The point where a line of sight meets a surface.
pub struct Seen {
    /// The distance in units of the line's direction.
    pub t: f64,
    /// The outward normal there; `None` if the line begins inside.
    pub normal: Option<DVec3>,
}

/// Draws the surface that `see` finds in the cells of an octree that lines of sight meet. `blur`: the length
/// over which normals change where the surface has an edge.
pub fn paint(
    tile: &mut Tile<'_>,
    stage: &Stage<'_>,
    tree: &OctreeRef<'_>,
    skin: &Skin<'_>,
    blur: f64,
    mut see: impl FnMut(&SightLine, TouchedCell) -> Result<Option<Seen>, Error>,
) -> Result<(), Error> {
    let half = 0.5 * tree.frame().cell_size();
    let light = |sight: &SightLine, Seen { t, normal }: Seen| -> Result<Light, Error> {
        let place = sight.from + sight.along * t;
        let finish = skin.finish(place, normal.unwrap_or(-sight.along), half)?;
        Ok(sight.light(&finish, stage.view, normal))
    };
    let mut cast = Cast::new(tree, *stage);
    let Some(outline) = &skin.finish.edges else {
        while let Some(met) = cast.next(tile)? {
            for (sight, touch) in met {
                if let Some(seen) = see(sight, touch)? {
                    tile.put(sight.sample, sight.start + seen.t, light(sight, seen)?)?;
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
                tile.put(sample, depth, light(sight, seen)?)?;
            }
        }
    }
    field.draw(tile, stage.job)
}
