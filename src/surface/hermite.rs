//! Where cut edges are crossed, and the normals there (Hermite data), and how rays of a tri-dexel model tell.

use crate::dexel::{OTHERS, Place, RowsRef, Span, TriDexelRef, decoded, with_rows};
use crate::walk::Edge;

/// Where a cut edge between two samples is crossed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Hermite {
    /// How far behind the lower sample, of the distance between both.
    pub t: f64,
    /// The outward unit normal; all zero if it is not known.
    pub normal: [f32; 3],
}

impl Hermite {
    /// The normal, if it is known.
    #[inline(always)]
    pub fn normal(&self) -> Option<[f64; 3]> {
        (self.normal != [0.0; 3]).then(|| self.normal.map(f64::from))
    }
}

/// What a ray says of a cut edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Said {
    /// There is no ray along it.
    NoRays,
    /// The ray does not leave the solid on the way from the inside sample to the outside one.
    Nothing,
    /// It does at this place (finest cells from the universe's lower face).
    At {
        place: f64,
        normal: Option<[f64; 3]>,
        /// Whether it crosses the surface elsewhere on the edge, too.
        several: bool,
    },
}

/// What a model says of an edge between two centres of cells, one of which lies inside. Of the places where
/// the ray leaves the solid it is the nearest to the inside sample.
pub(super) fn said(model: &TriDexelRef<'_>, edge: &Edge) -> Said {
    match &model.rays[edge.axis] {
        None => Said::NoRays,
        Some(rows) => with_rows!(rows, rows => on_ray(rows, edge, model.frame().depth())),
    }
}

fn on_ray<S: Span>(rows: &RowsRef<'_, S>, edge: &Edge, depth: u8) -> Said {
    // (What lies before the universe is no ray.)
    let ray = OTHERS[edge.axis].map(|axis| edge.lower[axis] as u32);
    let gap = (edge.lower[edge.axis] + 1) as u32;
    let range = rows.ray(ray);
    let spans = &rows.columns.spans[range.clone()];
    let from = spans.partition_point(|span| span.ends()[1].gap(depth) < gap);
    let (mut found, mut count) = (None, 0);
    for (i, span) in spans.iter().enumerate().skip(from) {
        let [start, end] = span.ends();
        if start.gap(depth) > gap {
            break;
        }
        // Where intervals of two materials touch there is no surface.
        if start.gap(depth) == gap && !(i > 0 && spans[i - 1].ends()[1] >= start) {
            count += 1;
            if !edge.starts_inside {
                found = Some((i, 0));
            }
        }
        if end.gap(depth) == gap && !spans.get(i + 1).is_some_and(|next| next.ends()[0] <= end) {
            count += 1;
            if edge.starts_inside && found.is_none() {
                found = Some((i, 1));
            }
        }
    }
    let Some((i, side)) = found else { return Said::Nothing };
    let item = rows.columns.item(range.start + i);
    Said::At {
        place: item.ends[side].cells(depth),
        normal: decoded(item.marks[side].normal),
        several: count > 1,
    }
}
