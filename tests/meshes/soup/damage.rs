//! Damage to meshes, the same in every run.

use crate::shapes::*;
use leafless_testkit::Random;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Damage {
    Intact,
    RemoveOne,
    RemoveFew,
    RemoveFifth,
    /// Removes all facets around a place.
    RemovePatch,
    RemoveHalf,
    FlipOne,
    FlipTenth,
    FlipHalf,
    DuplicateOne,
    DuplicateFifth,
    /// Doubles every facet, and hence all winding numbers.
    DuplicateAll,
    /// Adds some facets with reversed orientation, which cancel them.
    Cancel,
    /// Repeats a facet many times.
    Stack,
    /// Opens hair cracks.
    JitterSlightly,
    /// Opens gaps as wide as cells.
    JitterWidely,
    /// Inserts vertices slightly beside the middle of edges, in one facet only.
    TJunctions,
    /// Adds facets without area.
    Degenerate,
    /// Adds a moved, overlapping copy of the body.
    Overlap,
    /// Adds a smaller, inside-out copy with a hole inside.
    Nest,
    InsideOut,
    /// Scatters facets around.
    Debris,
    Everything,
}

use Damage::*;

pub const ALL: [Damage; 23] = [
    Intact,
    RemoveOne,
    RemoveFew,
    RemoveFifth,
    RemovePatch,
    RemoveHalf,
    FlipOne,
    FlipTenth,
    FlipHalf,
    DuplicateOne,
    DuplicateFifth,
    DuplicateAll,
    Cancel,
    Stack,
    JitterSlightly,
    JitterWidely,
    TJunctions,
    Degenerate,
    Overlap,
    Nest,
    InsideOut,
    Debris,
    Everything,
];

fn bounds(soup: &Soup) -> ([f64; 3], [f64; 3]) {
    let fold = |f: fn(f64, f64) -> f64, start: f64| {
        [0, 1, 2].map(|axis| soup.iter().flatten().map(|p| p[axis]).fold(start, f))
    };
    (fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY))
}

/// Returns the longest extent.
pub fn extent(soup: &Soup) -> f64 {
    let (low, high) = bounds(soup);
    (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max)
}

fn middle(facet: &[[f64; 3]; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| (facet[0][axis] + facet[1][axis] + facet[2][axis]) / 3.0)
}

fn any<'s>(soup: &'s Soup, random: &mut Random) -> &'s [[f64; 3]; 3] {
    &soup[random.below(soup.len() as u64) as usize]
}

/// Removes `count` facets, but not the last one.
pub fn remove(soup: &mut Soup, random: &mut Random, count: usize) {
    for _ in 0..count.min(soup.len() - 1) {
        soup.swap_remove(random.below(soup.len() as u64) as usize);
    }
}

/// Keeps the facets that `keep` selects, but at least one facet.
fn keep(soup: &mut Soup, keep: impl FnMut(&[[f64; 3]; 3]) -> bool) {
    let last = *soup.last().unwrap();
    soup.retain(keep);
    if soup.is_empty() {
        soup.push(last);
    }
}

/// Returns the damaged soup. `grain` is the edge of a cell and scales all displacements. If `aligned`,
/// corners on planes and centres of the lattice stay on them.
pub fn damaged(soup: &Soup, damage: Damage, random: &mut Random, grain: f64, aligned: bool) -> Soup {
    let mut soup = soup.clone();
    let size = extent(&soup);
    let some = soup.len().div_ceil(5);
    let place = middle(any(&soup, random));
    let near = |facet: &[[f64; 3]; 3], radius: f64| {
        let at = middle(facet);
        (0..3).map(|axis| (at[axis] - place[axis]).powi(2)).sum::<f64>() < radius * radius
    };
    let whole = |x: f64| if aligned { (x / grain * 2.0).round() * grain / 2.0 } else { x };
    match damage {
        Intact => {}
        RemoveOne => remove(&mut soup, random, 1),
        RemoveFew => remove(&mut soup, random, 5),
        RemoveFifth => remove(&mut soup, random, some),
        RemovePatch => keep(&mut soup, |facet| !near(facet, 0.3 * size)),
        RemoveHalf => {
            let axis = random.below(3) as usize;
            keep(&mut soup, |facet| middle(facet)[axis] > place[axis])
        }
        FlipOne | FlipTenth => {
            let count = if damage == FlipOne { 1 } else { some.div_ceil(2) };
            for _ in 0..count {
                let i = random.below(soup.len() as u64) as usize;
                soup[i].swap(0, 1);
            }
        }
        FlipHalf => {
            soup.iter_mut().filter(|facet| middle(facet)[0] > place[0]).for_each(|facet| facet.swap(0, 1))
        }
        DuplicateOne | DuplicateFifth | Cancel => {
            for _ in 0..if damage == DuplicateOne { 1 } else { some } {
                // Start triangles at other corners, as exporters do.
                let [a, b, c] = *any(&soup, random);
                soup.push(if damage == Cancel { [b, a, c] } else { [b, c, a] });
            }
        }
        DuplicateAll => soup.extend_from_within(..),
        Stack => {
            let facet = *any(&soup, random);
            soup.extend([facet; 6]);
        }
        JitterSlightly | JitterWidely => {
            let far = grain * if damage == JitterSlightly { 1e-7 } else { 0.7 };
            for x in soup.as_flattened_mut().as_flattened_mut() {
                let moved = *x + random.between(-far, far);
                *x = if damage == JitterWidely { whole(moved) } else { moved };
            }
        }
        TJunctions => {
            for _ in 0..some {
                let i = random.below(soup.len() as u64) as usize;
                let [a, b, c] = soup.swap_remove(i);
                let beside = if aligned { 0.0 } else { grain * random.between(-0.2, 0.2) };
                let between = [0, 1, 2].map(|axis| whole((a[axis] + b[axis]) / 2.0) + beside);
                soup.extend([[a, between, c], [between, b, c]]);
            }
        }
        Degenerate => {
            for _ in 0..some {
                let [a, b, _] = *any(&soup, random);
                let between = [0, 1, 2].map(|axis| (a[axis] + b[axis]) / 2.0);
                let beyond = [0, 1, 2].map(|axis| 2.0 * b[axis] - a[axis]);
                soup.push(match random.below(4) {
                    0 => [a, a, b],
                    1 => [a, a, a],
                    2 => [a, between, b],
                    _ => [a, b, beyond],
                });
            }
        }
        Overlap => {
            let by = [0; 3].map(|_: i32| whole(size * random.between(0.1, 0.35)));
            soup.extend(moved(&soup, |p| [0, 1, 2].map(|axis| p[axis] + by[axis])));
        }
        Nest => {
            let (low, high) = bounds(&soup);
            let mut inner =
                moved(&soup, |p| [0, 1, 2].map(|axis| whole((low[axis] + high[axis]) / 4.0 + p[axis] / 2.0)));
            remove(&mut inner, random, 2);
            soup.extend(inside_out(inner));
        }
        InsideOut => soup = inside_out(soup),
        Debris => {
            let (low, high) = bounds(&soup);
            for _ in 0..some.min(20) {
                soup.push(
                    [0; 3].map(|_: i32| [0, 1, 2].map(|axis| whole(random.between(low[axis], high[axis])))),
                );
            }
        }
        Everything => {
            for step in
                [RemoveFew, FlipOne, DuplicateFifth, TJunctions, Degenerate, JitterSlightly, Overlap, Debris]
            {
                // An aligned soup stays aligned, except for the one step that breaks it.
                if !(aligned && step == JitterSlightly) {
                    soup = damaged(&soup, step, random, grain, aligned);
                }
            }
        }
    }
    soup
}
