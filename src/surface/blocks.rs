//! The blocks of samples that a surface crosses.
//!
//! One walk through the tree visits every cell together with its seven neighbours towards +x, +y and +z, and
//! skips the cells where all eight are inside, or all outside. (Ju et al. 2002 walk in this way in dual
//! contouring.) Only cells at the surface remain, so the cost of the walk is linear in their number.

use super::key::Key;
use super::masks::{CORNER_AT, all, any, bits, configuration, corners};
use super::samples::{Node, Samples};
use super::size::{self, Least};
use super::table::MARCHING_CUBES;
use crate::control::{Job, WHOLE};
use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use crate::parallel::each;
use alloc::vec::Vec;

/// A block of 4³ samples that contains the lowest sample of a dual cell which the surface crosses.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    pub key: Key,
    /// The samples that lie inside, as bits.
    pub inside: u64,
    /// For each axis, the samples that differ from the next sample along it: the edges that the surface
    /// crosses.
    pub cut: [u64; 3],
    /// The dual cells whose samples differ, by their lowest samples.
    pub mixed: u64,
    /// The numbers of vertices and triangles before those of this block.
    pub vertex: u32,
    pub triangle: u32,
}

/// The blocks of a surface in Morton order, with the counts of marching cubes.
pub(super) struct Blocks {
    pub list: Vec<Block>,
    pub vertices: usize,
    pub triangles: usize,
    /// Blocks per axis; the positions of keys are biased by this number.
    pub bias: i32,
}

/// A node with its neighbours.
struct Task {
    e: usize,
    key: Key,
    at: [i32; 3],
    nodes: [Node; 8],
}

/// The part of the whole work that finding the blocks takes.
pub(super) const FINDING: usize = WHOLE / 4;

impl Blocks {
    /// Finds the blocks of a surface whose least size is `least`. O(blocks), plus the cost of
    /// [`Samples::new`].
    ///
    /// # Errors
    /// [`Error::TooLarge`] and [`Error::Limit`] by the limits of the job's control, [`MeshError::TooMany`]
    /// for more vertices or triangles than 32 bits can number, [`Error::Damaged`], [`Error::OutOfMemory`],
    /// and [`Error::Cancelled`].
    pub fn find(
        samples: &Samples<'_>,
        least: &Least,
        job: &Job<'_>,
        parallel: bool,
    ) -> Result<Blocks, Error> {
        size::afford(samples, least, size_of::<Block>() as u64, job.control())?;
        let tasks = tasks(samples)?;
        let list = run(samples, &tasks, job, parallel)?;
        let mut blocks = Blocks { list, vertices: 0, triangles: 0, bias: samples.blocks() };
        let (mut vertices, mut triangles) = (0u64, 0u64);
        for block in &mut blocks.list {
            // The walk has stored the counts of each block here.
            let counts = (u64::from(block.vertex), u64::from(block.triangle));
            (block.vertex, block.triangle) = (vertices as u32, triangles as u32);
            (vertices, triangles) = (vertices + counts.0, triangles + counts.1);
            if vertices.max(triangles) > u64::from(u32::MAX) {
                return Err(MeshError::TooMany.into());
            }
        }
        (blocks.vertices, blocks.triangles) = (vertices as usize, triangles as usize);
        Ok(blocks)
    }
}

/// Cuts the lattice, and the border before it, into tasks for threads.
fn tasks(samples: &Samples<'_>) -> Result<Vec<Task>, Error> {
    let mut tasks = memory::with_capacity(8)?;
    for place in 0..8usize {
        // The first seven nodes lie outside, and the universe is their neighbour.
        let at = axes(|axis| (place >> axis & 1) as i32 - 1);
        let nodes = [0, 1, 2, 3, 4, 5, 6, 7]
            .each(|j| if place | j == 7 && place & j == 0 { samples.root() } else { Node::Void });
        tasks.push(Task { e: 0, key: place as Key, at, nodes });
    }
    // Two levels down there are enough tasks.
    for e in 0..samples.levels().saturating_sub(1).min(2) {
        let mut finer = Vec::new();
        for task in &tasks {
            debug_assert_eq!(task.e, e);
            split(samples, task, &mut |task| memory::push(&mut finer, task))?;
        }
        tasks = finer;
    }
    Ok(tasks)
}

fn run(samples: &Samples<'_>, tasks: &[Task], job: &Job<'_>, parallel: bool) -> Result<Vec<Block>, Error> {
    let share = if parallel { tasks.len().div_ceil(512).max(1) } else { tasks.len().max(1) };
    let each_task = FINDING.checked_div(tasks.len()).unwrap_or(0);
    job.advance(FINDING - each_task * tasks.len());
    let mut found = each(parallel, tasks.chunks(share), |tasks| {
        let mut list = Vec::new();
        for task in tasks {
            job.check()?;
            visit(samples, task, job, &mut list)?;
            job.advance(each_task);
        }
        Ok(list)
    })?;
    if found.len() == 1 {
        return Ok(found.remove(0));
    }
    let mut list = memory::with_capacity(found.iter().map(Vec::len).sum())?;
    found.iter().for_each(|part| list.extend_from_slice(part));
    Ok(list)
}

/// Appends the blocks in a node. The recursion is at most ten levels deep.
fn visit(samples: &Samples<'_>, task: &Task, job: &Job<'_>, list: &mut Vec<Block>) -> Result<(), Error> {
    if task.e + 1 == samples.levels() {
        return leaf(samples, task, list);
    }
    let before = list.len();
    split(samples, task, &mut |task| visit(samples, &task, job, list))?;
    if task.e + 2 == samples.levels() {
        job.spend(0, (list.len() - before) * size_of::<Block>())?;
    }
    Ok(())
}

/// Passes on the cells of a node that the surface may cross, with their neighbours.
#[inline(always)]
fn split(
    samples: &Samples<'_>,
    task: &Task,
    put: &mut impl FnMut(Task) -> Result<(), Error>,
) -> Result<(), Error> {
    let sets = sets(samples, task)?;
    let [solid, void] = [corners(sets.each(|sets| sets.solid)), corners(sets.each(|sets| sets.void))];
    for c in bits(!(all(&solid) | all(&void))) {
        let mut nodes = [Node::Void; 8];
        for (node, (of, inner)) in nodes.iter_mut().zip(CORNER_AT[c as usize]) {
            *node = samples.child(&sets[of as usize], inner.into())?;
        }
        let place = crate::lattice::morton::position(c);
        let at = axes(|axis| 4 * task.at[axis] + place[axis] as i32);
        put(Task { e: task.e + 1, key: task.key << 6 | Key::from(c), at, nodes })?;
    }
    Ok(())
}

/// The sets of a node and of its neighbours.
#[inline(always)]
fn sets(samples: &Samples<'_>, task: &Task) -> Result<[super::samples::Sets; 8], Error> {
    let mut sets = [super::samples::Sets::VOID; 8];
    for (j, (sets, &node)) in sets.iter_mut().zip(&task.nodes).enumerate() {
        *sets = samples.sets(task.e, node, axes(|axis| task.at[axis] + (j >> axis & 1) as i32))?;
    }
    Ok(sets)
}

/// Appends a block of the finest level, if the surface crosses it.
#[inline(always)]
fn leaf(samples: &Samples<'_>, task: &Task, list: &mut Vec<Block>) -> Result<(), Error> {
    let words = corners(sets(samples, task)?.each(|sets| sets.solid));
    let mixed = any(&words) & !all(&words);
    if mixed == 0 {
        return Ok(());
    }
    let cut = [words[0] ^ words[1], words[0] ^ words[2], words[0] ^ words[4]];
    let vertex = cut.iter().map(|cut| cut.count_ones()).sum();
    let triangle = bits(mixed).map(|c| u32::from(MARCHING_CUBES[configuration(&words, c)].count)).sum();
    memory::push(list, Block { key: task.key, inside: words[0], cut, mixed, vertex, triangle })
}
