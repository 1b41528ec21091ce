//! The voxels between the rays of a tri-dexel model, merged along y.

use super::record::VoxelKind;
use crate::control::Control;
use crate::dexel::TriDexelRef;
use crate::error::Error;
use crate::lattice::Frame;
use crate::memory;
use alloc::boxed::Box;
use alloc::vec::Vec;

/// A row of voxels along y that are all of one kind and of one material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LongVoxel {
    /// Its first voxel. A voxel (x, y, z) lies between the centres of the cells x − 1 and x, and likewise on the other
    /// axes; so its indices go from 0 to the cells of an axis, that number included.
    pub first: [u32; 3],
    /// How many voxels it consists of.
    pub length: u32,
    /// [`VoxelKind::Inside`] or [`VoxelKind::Boundary`].
    pub kind: VoxelKind,
    /// What it is made of; 0 where nothing was said.
    pub material: u32,
    /// The material's colour: red, green, blue and opacity, 0 to 255.
    pub colour: [u8; 4],
}

/// The colour of materials of which none is given: an opaque grey.
const GREY: [u8; 4] = [128, 128, 128, 255];

impl LongVoxel {
    /// Its lowest and highest corner in model space.
    pub fn bounds(&self, frame: &Frame) -> ([f64; 3], [f64; 3]) {
        let at = |axis: usize, cells: f64| frame.origin()[axis] + (cells - 0.5) * frame.cell_size();
        let length = [1, self.length, 1];
        (
            [0, 1, 2].map(|axis| at(axis, f64::from(self.first[axis]))),
            [0, 1, 2].map(|axis| at(axis, f64::from(self.first[axis]) + f64::from(length[axis]))),
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
    /// The rows of voxels that do not lie outside: by z, then by x, then by y. Two that follow each other along y differ
    /// in kind or in material.
    pub fn list(&self) -> &[LongVoxel] {
        &self.list
    }

    /// How many voxels are of a kind, before they were merged.
    pub fn count(&self, kind: VoxelKind) -> u64 {
        self.counts.get(kind as usize).copied().unwrap_or(0)
    }
}

/// The voxels of a tri-dexel model, as Gao, Zhang and Hou have them (*DEXEL model of polyhedrons and boolean operations*,
/// 2007): the rays of three directions cut space into voxels whose corners are the centres of cells. A voxel lies inside
/// if all of its eight corners do, outside if none does, and else on the boundary: those are the voxels in which
/// [`marching_cubes_of_dexels`](crate::marching_cubes_of_dexels) makes triangles. Centres outside of the universe lie
/// outside. Voxels that do not lie outside are merged along y, between four neighbouring rays, as far as their kind and
/// their material are the same.
///
/// The material of a voxel is that of the model at the voxel's first corner that lies inside. Corners are counted with x
/// running fastest and z slowest. If the model stores no materials it is 0. Its colour is the one that `colours` has for the
/// material, at the place of the material's number; materials beyond are grey (128, 128, 128, 255).
///
/// Which centres lie inside is what [`TriDexelRef::contains_cell`] says.
///
/// O(8^depth / 64 + rows), and O(log) for each voxel that does not lie outside if the model stores materials; by the
/// calling thread.
///
/// # Errors
/// [`Error::OutOfMemory`], [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Dexel, DexelEnd, DexelFormat, Frame, TriDexel, VoxelKind, dexel_voxels};
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
    let mut layers = Layers::new(cells)?;
    let mut voxels = DexelVoxels { list: Vec::new(), counts: [0; 3] };
    for z in 0..=cells {
        control.check()?;
        layers.advance(model, z)?;
        for x in 0..=cells {
            for w in 0..=layers.words {
                let [any, all] = layers.corners(x, w);
                let mut rest = any;
                while rest != 0 {
                    let start = rest.trailing_zeros();
                    let inside = all >> start & 1 != 0;
                    let same = if inside { all } else { any & !all };
                    let length = (!(same >> start)).trailing_zeros();
                    rest &= !((!0 >> (64 - length)) << start);
                    let kind = if inside { VoxelKind::Inside } else { VoxelKind::Boundary };
                    voxels.counts[kind as usize] += u64::from(length);
                    let first = [x, 64 * w as u32 + start, z];
                    if !model.format().materials {
                        voxels.append(row(first, length, kind, 0))?;
                        continue;
                    }
                    for y in first[1]..first[1] + length {
                        let material = layers.material(model, [x, y, z]);
                        voxels.append(row([x, y, z], 1, kind, material))?;
                    }
                }
            }
        }
    }
    let all = (u64::from(cells) + 1).pow(3);
    voxels.counts[VoxelKind::Outside as usize] = all - voxels.counts.iter().sum::<u64>();
    Ok(voxels)
}

impl DexelVoxels {
    /// Appends a row, or makes the last one longer.
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

/// The centres of cells as columns along y: 64 layers at a time, and the one before.
struct Layers {
    cells: u32,
    /// Words to a column.
    words: usize,
    /// Word w of the column at x in layer z is number (z · cells + x) · words + w.
    slab: Vec<u64>,
    /// The layers below and above the present voxels, if they are in the universe.
    below: Option<Vec<u64>>,
    above: Option<usize>,
    block: Box<[u64; 4096]>,
}

impl Layers {
    fn new(cells: u32) -> Result<Layers, Error> {
        let words = cells.div_ceil(64) as usize;
        let layer = cells as usize * words;
        let slab = memory::filled(layer * cells.min(64) as usize, 0)?;
        Ok(Layers { cells, words, slab, below: None, above: None, block: memory::zeros()? })
    }

    fn layer(&self) -> usize {
        self.cells as usize * self.words
    }

    /// Goes on to the voxels between layers z − 1 and z.
    fn advance(&mut self, model: &TriDexelRef<'_>, z: u32) -> Result<(), Error> {
        let size = self.layer();
        if let Some(above) = self.above.take() {
            let mut below = match self.below.take() {
                Some(list) => list,
                None => memory::filled(size, 0)?,
            };
            below.copy_from_slice(&self.slab[above * size..(above + 1) * size]);
            self.below = Some(below);
        }
        if z == self.cells {
            return Ok(());
        }
        if z.is_multiple_of(64) {
            self.load(model, z);
        }
        self.above = Some((z % 64) as usize);
        Ok(())
    }

    /// Takes in 64 layers.
    fn load(&mut self, model: &TriDexelRef<'_>, z: u32) {
        let (size, deep) = (self.layer(), self.cells.min(64) as usize);
        self.slab.fill(0);
        for x in (0..self.cells).step_by(64) {
            for w in 0..self.words {
                if !model.fill_centres([x, 64 * w as u32, z], 1, &mut self.block) {
                    continue;
                }
                for k in 0..deep {
                    for i in 0..deep {
                        self.slab[k * size + (x as usize + i) * self.words + w] = self.block[64 * k + i];
                    }
                }
            }
        }
    }

    /// The layers at the voxels' lower and upper faces.
    fn both(&self) -> [Option<&[u64]>; 2] {
        let size = self.layer();
        [self.below.as_deref(), self.above.map(|above| &self.slab[above * size..(above + 1) * size])]
    }

    /// A word of a column. Outside of the universe it is empty.
    #[inline(always)]
    fn word(&self, layer: Option<&[u64]>, x: u32, w: usize) -> u64 {
        match layer {
            Some(layer) if x < self.cells && w < self.words => layer[x as usize * self.words + w],
            _ => 0,
        }
    }

    /// Which voxels of word `w` of a column have any corner inside, and which all.
    #[inline(always)]
    fn corners(&self, x: u32, w: usize) -> [u64; 2] {
        let layers = self.both();
        let four = |w: usize| {
            let (mut any, mut all) = (0, !0);
            for layer in layers {
                for x in [x.wrapping_sub(1), x] {
                    let word = self.word(layer, x, w);
                    (any, all) = (any | word, all & word);
                }
            }
            [any, all]
        };
        let [any, all] = four(w);
        let [any_before, all_before] = if w == 0 { [0; 2] } else { four(w - 1) };
        [any | any << 1 | any_before >> 63, all & (all << 1 | all_before >> 63)]
    }

    /// The material at the first corner of a voxel that lies inside.
    fn material(&self, model: &TriDexelRef<'_>, at: [u32; 3]) -> u32 {
        let layers = self.both();
        for corner in 0..8u32 {
            let [x, y, z] = [0, 1, 2].map(|axis| (at[axis] + (corner >> axis & 1)).wrapping_sub(1));
            let word = self.word(layers[(corner >> 2) as usize], x, (y / 64) as usize);
            if word >> (y % 64) & 1 != 0 {
                return model.material_of_cell([x, y, z]);
            }
        }
        0
    }
}
