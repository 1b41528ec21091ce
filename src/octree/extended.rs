//! Octrees whose PARTIAL cells keep surfaces: what is counted, and what they promise.

use super::cuts::{BLOCK, Block, CutCounts, Head, records};
use super::tag::Tag;
use super::view::OctreeRef;
use crate::error::Damage;

impl OctreeRef<'_> {
    /// What the PARTIAL cells keep of the surfaces that cross them; `None` if they keep nothing. O(records).
    pub fn cuts(&self) -> Option<CutCounts> {
        let cuts = self.cuts.as_ref()?;
        let count = |head: Head| cuts.heads.iter().filter(|&&own| own == head.0).count() as u64;
        let (given_up, splits) = (count(Head::NONE), count(Head::SPLIT));
        let surfaces = &cuts.surfaces;
        let bytes = size_of_val(cuts.heads)
            + size_of_val(cuts.ids)
            + size_of_val(cuts.blocks)
            + size_of_val(cuts.first)
            + size_of_val(surfaces.records)
            + size_of_val(surfaces.doubles)
            + size_of_val(surfaces.placements);
        Some(CutCounts {
            cells: cuts.heads.len() as u64 - given_up - splits,
            given_up,
            splits,
            surfaces: surfaces.len() as u64,
            bytes: bytes as u64,
        })
    }

    /// The same tree without cuts: what its planes say.
    #[must_use]
    pub fn without_cuts(&self) -> Self {
        OctreeRef { cuts: None, ..*self }
    }

    /// Checks everything that cuts promise: a record for each PARTIAL cell, groups for splits, prefix counts, tables whose
    /// surfaces are there and count, surfaces of which none is unused. O(n).
    pub(crate) fn check_cuts(&self) -> Result<(), Damage> {
        let Some(cuts) = &self.cuts else { return Ok(()) };
        let wrong = |what: bool| if what { Err(Damage::Cuts) } else { Ok(()) };
        // The planes' cells.
        let elements = self.planes.len() + self.bricks.len();
        wrong(cuts.first.len() != elements + 1)?;
        let mut next = (self.root == Tag::Partial) as u32;
        for (index, &first) in cuts.first.iter().enumerate() {
            wrong(first != next)?;
            if index < elements {
                next += self.entry(index).map_or(0, records);
            }
        }
        // Records, and what is counted before them.
        let (mut ids, mut splits) = (0usize, 0usize);
        for (record, &head) in cuts.heads.iter().enumerate() {
            if record % BLOCK == 0 {
                let block = Block { ids: ids as u32, splits: splits as u32 };
                wrong(cuts.blocks.get(record / BLOCK) != Some(&block))?;
            }
            let head = Head(head);
            wrong(!head.is_valid())?;
            if head.is_split() {
                // A group comes after its split, whose level has cells below it.
                wrong(next as usize + 8 * splits <= record)?;
                splits += 1;
            }
            let own = cuts.ids.get(ids..ids + head.surfaces()).ok_or(Damage::Cuts)?;
            wrong(own.windows(2).any(|pair| pair[0] >= pair[1]))?;
            ids += head.surfaces();
        }
        wrong(cuts.heads.len() != next as usize + 8 * splits)?;
        wrong(cuts.ids.len() != ids || cuts.blocks.len() != cuts.heads.len().div_ceil(BLOCK))?;
        // Surfaces in the order of their first use.
        let mut known = 0;
        for &id in cuts.ids {
            wrong(id > known)?;
            known = known.max(id + 1);
        }
        wrong(known as usize != cuts.surfaces.len())?;
        cuts.surfaces.check()
    }
}
