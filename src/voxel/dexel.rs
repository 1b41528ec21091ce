//! The voxels between the rays of a tri-dexel model, merged along y.

use super::record::VoxelKind;
use crate::control::Control;
use crate::dexel::{BLOCK, Occupied, TriDexelRef};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::Frame;
use crate::lattice::axes;
use crate::memory;
use alloc::boxed::Box;
use alloc::vec::Vec;

/// A row of voxels along y that all have the same kind and the same material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LongVoxel {
    /// The first voxel of the row. A voxel (x, y, z) lies between the centres of the cells x − 1 and x, and
    /// likewise on the other axes. So its indices go from 0 to the number of cells of an axis, both included.
    pub first: [u32; 3],
    /// The number of voxels in the row.
    pub length: u32,
    /// [`VoxelKind::Inside`] or [`VoxelKind::Boundary`].
    pub kind: VoxelKind,
    /// The number of the material; 0 if it is unknown.
    pub material: u32,
    /// The material's colour: red, green, blue and opacity, 0 to 255.
    pub colour: [u8; 4],
}

/// The colour of materials without a given colour: an opaque grey.
const GREY: [u8; 4] = [128, 128, 128, 255];

impl LongVoxel {
    /// The lowest and the highest corner in model space.
    pub fn bounds(&self, frame: &Frame) -> ([f64; 3], [f64; 3]) {
        let at = |axis: usize, cells: f64| frame.origin()[axis] + (cells - 0.5) * frame.cell_size();
        let length = [1, self.length, 1];
        (
            axes(|axis| at(axis, f64::from(self.first[axis]))),
            axes(|axis| at(axis, f64::from(self.first[axis]) + f64::from(length[axis]))),
        )
    }
}

/// The voxels of a tri-dexel model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DexelVoxels {
    list: Vec<LongVoxel>,
    counts: [u64; 3],
}

impl DexelVoxels {
    /// The rows of voxels that do not lie outside: by z, then by x, then by y. Neighbouring rows along y
    /// differ in kind or in material.
    pub fn list(&self) -> &[LongVoxel] {
        &self.list
    }

    /// The number of voxels of a kind before merging.
    pub fn count(&self, kind: VoxelKind) -> u64 {
        self.counts.get(kind as usize).copied().unwrap_or(0)
    }
}

/// Computes the voxels of a tri-dexel model by the method of Gao, Zhang and Hou (*DEXEL model of polyhedrons
/// and boolean operations*, 2007). The rays of three directions divide space into voxels whose corners are
/// the centres of cells. A voxel lies inside if all of its eight corners do, outside if none does, and
/// otherwise on the boundary. The boundary voxels are those in which
/// [`marching_cubes_dexels`](crate::surface::marching_cubes_dexels) makes triangles. Centres outside the
/// universe lie outside. Voxels that do not lie outside are merged along y, between four neighbouring rays,
/// as far as their kind and their material are the same.
///
/// The material of a voxel is that of the model at the voxel's first corner that lies inside. Corners are
/// counted with x varying fastest and z slowest. If the model stores no materials, the material is 0. The
/// colour is the element of `colours` at the index of the material's number; materials beyond the list are
/// grey (128, 128, 128, 255).
///
/// [`TriDexelRef::contains_cell`] decides which centres lie inside.
///
/// O(rays of the window + blocks + rows), where the blocks are those of 64³ cells with centres inside. If the
/// model stores materials, O(log) in addition for each voxel that does not lie outside. The work is done by
/// the calling thread.
///
/// # Errors
/// [`Error::OutOfMemory`], [`Error::Cancelled`].
///
/// ```
/// use leafless::{
///     Control, Frame, TriDexel, dexel::{Dexel, DexelEnd, DexelFormat}, voxel::{VoxelKind, dexel_voxels},
/// };
/// let (frame, control) = (Frame::new([0.0; 3], 8.0, 3)?, Control::default());
/// let end = DexelEnd::new;
/// // A cube of four cells to an edge.
/// let cube = |_: usize, ray: [u32; 2], list: &mut Vec<Dexel>| {
///     if ray.iter().all(|i| (2..6).contains(i)) {
///         list.push(Dexel { start: end(2.0), end: end(6.0), material: 0 });
///     }
///     Ok(())
/// };
/// let model = TriDexel::from_rays(&frame, DexelFormat::default(), [true; 3], cube, &control)?;
/// let voxels = dexel_voxels(model.view(), &[[200, 40, 40, 255]], &control)?;
/// assert_eq!(voxels.count(VoxelKind::Inside), 27);
/// assert_eq!(voxels.count(VoxelKind::Boundary), 125 - 27);
/// assert_eq!(voxels.list().iter().filter(|voxel| voxel.kind == VoxelKind::Inside).count(), 9);
/// assert!(voxels.list().iter().all(|voxel| voxel.colour == [200, 40, 40, 255]));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn dexel_voxels(
    model: &TriDexelRef<'_>,
    colours: &[[u8; 4]],
    control: &Control<'_>,
) -> Result<DexelVoxels, Error> {
    model.sound()?;
    let row = |first: [u32; 3], length: u32, kind: VoxelKind, material: u32| {
        let colour = colours.get(material as usize).copied().unwrap_or(GREY);
        LongVoxel { first, length, kind, material, colour }
    };
    let cells = model.frame().cells();
    let mut voxels = DexelVoxels { list: Vec::new(), counts: [0; 3] };
    each_word(model, control, |x, w, z, [any, all]| {
        let mut rest = any;
        while rest != 0 {
            let start = rest.trailing_zeros();
            let inside = all >> start & 1 != 0;
            let same = if inside { all } else { any & !all };
            let length = (!(same >> start)).trailing_zeros();
            rest &= !((!0 >> (64 - length)) << start);
            let kind = if inside { VoxelKind::Inside } else { VoxelKind::Boundary };
            voxels.counts[kind as usize] += u64::from(length);
            let first = [x, 64 * w + start, z];
            if !model.format().materials {
                voxels.append(row(first, length, kind, 0))?;
                continue;
            }
            for y in first[1]..first[1] + length {
                voxels.append(row([x, y, z], 1, kind, material(model, [x, y, z])))?;
            }
        }
        Ok(())
    })?;
    let all = (u64::from(cells) + 1).pow(3);
    voxels.counts[VoxelKind::Outside as usize] = all - voxels.counts.iter().sum::<u64>();
    Ok(voxels)
}

impl DexelVoxels {
    /// Appends a row, or extends the last one.
    #[inline]
    fn append(&mut self, row: LongVoxel) -> Result<(), Error> {
        match self.list.last_mut() {
            Some(last)
                if [last.first[0], last.first[1] + last.length, last.first[2]] == row.first
                    && (last.kind, last.material) == (row.kind, row.material) =>
            {
                last.length += row.length;
                Ok(())
            }
            _ => memory::push(&mut self.list, row),
        }
    }
}

/// The material at the first corner of a voxel that lies inside.
fn material(model: &TriDexelRef<'_>, at: [u32; 3]) -> u32 {
    let corners = (0..8u32).map(|corner| axes(|axis| (at[axis] + (corner >> axis & 1)).wrapping_sub(1)));
    let first = corners.into_iter().find(|&corner| model.contains_cell(corner));
    first.map_or(0, |corner| model.material_of_cell(corner))
}

/// 64³ centres of cells, as columns along y: bit y of word x + 64 z.
struct Columns {
    /// The index of the block along x and along y.
    at: [u32; 2],
    words: Box<[u64; 4096]>,
}

/// 64 layers of centres: the blocks that contain centres inside, by x, then by y.
struct Slab {
    /// The index of the slab along z.
    at: u32,
    blocks: Vec<Columns>,
}

impl Slab {
    /// The blocks at one index along x.
    fn strip(&self, x: u32) -> &[Columns] {
        let first = self.blocks.partition_point(|block| block.at[0] < x);
        let count = self.blocks[first..].partition_point(|block| block.at[0] == x);
        &self.blocks[first..first + count]
    }

    /// The last layer of a slab of `deep` layers.
    fn top(&self, deep: u32) -> Layer<'_> {
        Layer { slab: self, z: deep - 1 }
    }
}

/// A layer of a slab.
#[derive(Clone, Copy)]
struct Layer<'a> {
    slab: &'a Slab,
    z: u32,
}

/// Calls `each`, by z, x and y, for the words that contain voxels with a corner inside. The arguments are the
/// voxels' index along x, the index of the word along y, the index along z, and two sets of bits: the voxels
/// with any corner inside, and the voxels with all corners inside.
fn each_word(
    model: &TriDexelRef<'_>,
    control: &Control<'_>,
    mut each: impl FnMut(u32, u32, u32, [u64; 2]) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut blocks = Occupied::of(model)?.blocks()?;
    blocks.sort_unstable_by_key(|&[x, y, z]| [z, x, y]);
    // The number of layers of a slab.
    let deep = model.frame().cells().min(BLOCK);
    let mut before: Option<Slab> = None;
    for group in blocks.chunk_by(|a, b| a[2] == b[2]) {
        let z = group[0][2];
        if let Some(slab) = before.take_if(|slab| slab.at + 1 != z) {
            layer(deep, slab.at * BLOCK + deep, [Some(slab.top(deep)), None], control, &mut each)?;
        }
        let mut slab = Slab { at: z, blocks: memory::with_capacity(group.len())? };
        for &[x, y, _] in group {
            let mut words = memory::zeros()?;
            model.fill_centres([BLOCK * x, BLOCK * y, BLOCK * z], 1, &mut words);
            slab.blocks.push(Columns { at: [x, y], words });
        }
        let mut below = before.as_ref().map(|slab| slab.top(deep));
        for k in 0..deep {
            let above = Layer { slab: &slab, z: k };
            layer(deep, BLOCK * z + k, [below, Some(above)], control, &mut each)?;
            below = Some(above);
        }
        before = Some(slab);
    }
    match before {
        Some(slab) => layer(deep, slab.at * BLOCK + deep, [Some(slab.top(deep)), None], control, &mut each),
        None => Ok(()),
    }
}

/// The voxels between two layers. `deep` is the number of cells of a block along an axis.
fn layer(
    deep: u32,
    z: u32,
    layers: [Option<Layer<'_>>; 2],
    control: &Control<'_>,
    each: &mut impl FnMut(u32, u32, u32, [u64; 2]) -> Result<(), Error>,
) -> Result<(), Error> {
    control.check()?;
    // Blocks along x, one after the other, in both layers.
    let mut next = Some(0);
    while let Some(from) = next {
        let first = |layer: &Layer<'_>| {
            let blocks = &layer.slab.blocks;
            blocks.get(blocks.partition_point(|block| block.at[0] < from)).map(|block| block.at[0])
        };
        let Some(x) = layers.iter().flatten().filter_map(first).min() else { break };
        let strips = |x: Option<u32>| layers.each(|layer| Some((layer?.slab.strip(x?), layer?.z)));
        let (own, before) = (strips(Some(x)), strips(x.checked_sub(1)));
        for i in 0..deep {
            let lower = if i > 0 { own } else { before };
            column([(lower, (i + BLOCK - 1) % BLOCK), (own, i)], |w, words| {
                each(BLOCK * x + i, w, z, words)
            })?;
        }
        let after = strips(Some(x + 1));
        if after.iter().flatten().all(|(strip, _)| strip.is_empty()) {
            column([(own, deep - 1), (after, 0)], |w, words| each(BLOCK * x + deep, w, z, words))?;
        }
        next = Some(x + 1);
    }
    Ok(())
}

/// The blocks along y of two layers, each with the index of the layer in its slab.
type Strips<'a> = [Option<(&'a [Columns], u32)>; 2];

/// The voxels of a column along y, between columns of centres at two places along x.
fn column(
    sides: [(Strips<'_>, u32); 2],
    mut each: impl FnMut(u32, [u64; 2]) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut sources: [(&[Columns], usize); 4] = [(&[], 0); 4];
    for ((strips, x), pair) in sides.into_iter().zip(sources.chunks_exact_mut(2)) {
        for (strip, source) in strips.into_iter().zip(pair) {
            if let Some((blocks, z)) = strip {
                *source = (blocks, (x + BLOCK * z) as usize);
            }
        }
    }
    // The carry of the previous word: whether any of its last four centres lies inside, and whether all do.
    let (mut at, mut carry) = (0, [0u64; 2]);
    loop {
        let first = sources.iter().filter_map(|(blocks, _)| blocks.first()).map(|block| block.at[1]).min();
        if carry[0] == 0 {
            match first {
                Some(first) => at = first,
                None => return Ok(()),
            }
        }
        let [mut any, mut all] = [0, !0];
        for (blocks, place) in &mut sources {
            let word = match blocks.split_first() {
                Some((block, rest)) if block.at[1] == at => {
                    *blocks = rest;
                    block.words[*place]
                }
                _ => 0,
            };
            (any, all) = (any | word, all & word);
        }
        let words = [any | any << 1 | carry[0], all & (all << 1 | carry[1])];
        if words[0] != 0 {
            each(at, words)?;
        }
        carry = [any >> 63, all >> 63];
        at += 1;
    }
}
