//! Tests: any signs at the corners of any cells give a manifold.

use super::cells::{Cells, Kind, Slot};
use super::sheets::{Inside, Sheets};
use super::triangles::{Place, Triangles};
use crate::error::Error;
use crate::lattice::Cell;
use leafless_testkit::Random;
use std::collections::HashMap;
use std::vec::Vec;

/// Signs by a hash of the place: `share` of 256 points lie inside.
struct Signs {
    seed: u64,
    share: u64,
}

impl Inside for Signs {
    fn is_inside(&mut self, [x, y, z]: [u32; 3]) -> Result<bool, Error> {
        let key = u64::from(x) | u64::from(y) << 21 | u64::from(z) << 42;
        let mut random = Random(self.seed ^ key.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        Ok(random.below(256) < self.share)
    }
}

/// Checks that each edge has two triangles in opposite directions, and that there is one fan around each
/// vertex. Returns V - E + F.
fn euler(triangles: &[[u32; 3]]) -> i64 {
    let mut next: HashMap<(u32, u32), u32> = HashMap::new();
    let mut fans: HashMap<u32, (u32, u32)> = HashMap::new();
    for &[a, b, c] in triangles {
        for (from, to, third) in [(a, b, c), (b, c, a), (c, a, b)] {
            assert!(from != to && next.insert((from, to), third).is_none(), "{from} {to}");
            let fan = fans.entry(from).or_insert((to, 0));
            fan.1 += 1;
        }
    }
    for &(from, to) in next.keys() {
        assert!(next.contains_key(&(to, from)), "an edge is open: {from} {to}");
    }
    for (&vertex, &(start, count)) in &fans {
        let (mut at, mut met) = (next[&(vertex, start)], 1);
        while at != start {
            (at, met) = (next[&(vertex, at)], met + 1);
        }
        assert_eq!(met, count, "several fans at {vertex}");
    }
    fans.len() as i64 - next.len() as i64 / 2 + triangles.len() as i64
}

fn random_cells(random: &mut Random, depth: u8) -> Cells {
    let mut cells = Cells::new(Kind::Open, depth).unwrap();
    let decided = random.below(4);
    let kind = |random: &mut Random| match random.below(24) {
        0 if decided & 1 != 0 => Kind::Empty,
        1 if decided & 2 != 0 => Kind::Full,
        _ => Kind::Open,
    };
    let splits = 1 + random.below(24);
    for _ in 0..splits {
        let leaf = random.below(cells.leaves.len() as u64) as u32;
        let own = cells.leaves[leaf as usize];
        if own.is_gone || own.cell.level == depth || own.kind != Kind::Open {
            continue;
        }
        let kinds = [0; 8].map(|_: u8| kind(random));
        cells.split(leaf, kinds).unwrap();
    }
    cells
}

fn contour_of(cells: &Cells, signs: &mut Signs, centres: u64) -> Triangles {
    let sheets = Sheets::find(cells, signs).unwrap();
    let place = |cell: Cell| cell.at.map(|c| (f64::from(c) + 0.5) / f64::from(1u32 << cell.level));
    let vertices: Vec<_> =
        sheets.sheets.iter().map(|sheet| place(cells.leaves[sheet.leaf as usize].cell)).collect();
    let scale = f64::from(1u32 << cells.depth);
    let places: Vec<_> = sheets
        .crossings
        .iter()
        .map(|crossing| {
            let mut at = crossing.at.map(|c| f64::from(c) / scale);
            at[usize::from(crossing.axis)] += 0.5 * f64::from(crossing.length) / scale;
            Place { at, normal: [0.0; 3] }
        })
        .collect();
    Triangles::of(&sheets, vertices, &places, |number| centres != 0 && u64::from(number) % centres == 0)
        .unwrap()
}

fn trial(seed: u64) -> usize {
    let mut random = Random(seed);
    let depth = 1 + random.below(4) as u8;
    let cells = if random.below(4) == 0 {
        // All cells of one size: a bitmap.
        let depth = depth.min(3);
        let mut cells = Cells::new(Kind::Open, depth).unwrap();
        let mut leaf = 0;
        while leaf < cells.leaves.len() {
            if cells.leaves[leaf].cell.level < depth {
                cells.split(leaf as u32, [Kind::Open; 8]).unwrap();
            }
            leaf += 1;
        }
        cells
    } else {
        random_cells(&mut random, depth)
    };
    let share = [16, 64, 128, 192, 240][random.below(5) as usize];
    let mut signs = Signs { seed: random.bits(), share };
    let centres = random.below(4);
    let made = contour_of(&cells, &mut signs, centres);
    euler(&made.triangles);
    made.triangles.len()
}

#[test]
fn leaves_are_where_cells_are() {
    let mut random = Random(5);
    for _ in 0..50 {
        let cells = random_cells(&mut random, 4);
        fn check(cells: &Cells, cell: Cell, slot: Slot) -> u64 {
            match slot {
                Slot::Leaf(leaf) => {
                    let leaf = cells.leaves[leaf as usize];
                    assert!(leaf.cell == cell && !leaf.is_gone);
                    1
                }
                Slot::Branch(node) => (0..8u8)
                    .map(|octant| {
                        check(cells, cell.child(octant), cells.nodes[node as usize][usize::from(octant)])
                    })
                    .sum(),
            }
        }
        let count = check(&cells, Cell::ROOT, cells.root);
        assert_eq!(count, cells.leaves.iter().filter(|leaf| !leaf.is_gone).count() as u64);
    }
}

#[test]
fn random_signs_on_random_cells_give_manifolds() {
    let triangles: usize = (0..3000).map(trial).sum();
    assert!(triangles > 100_000, "{triangles}");
}

/// `cargo test --release --lib contour -- --ignored`
#[test]
#[ignore = "takes minutes"]
fn many_random_signs_on_random_cells_give_manifolds() {
    for seed in 0..200_000 {
        trial(1_000_000 + seed);
    }
}
