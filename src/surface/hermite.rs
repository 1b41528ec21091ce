//! Crossings of cut edges with their normals (Hermite data), and crossings from the rays of a tri-dexel
//! model.

use crate::dexel::{OTHERS, Place, RowsRef, Span, TriDexelRef, decoded, with_rows};
use crate::lattice::Each;
use crate::walk::Edge;

/// The crossing of a cut edge between two samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Hermite {
    /// The distance behind the lower sample, as a fraction of the distance between both samples.
    pub t: f64,
    /// The outward unit normal; all zero if it is not known.
    pub normal: [f32; 3],
}

impl Hermite {
    /// The normal, if it is known.
    #[inline(always)]
    pub fn normal(&self) -> Option<[f64; 3]> {
        (self.normal != [0.0; 3]).then(|| self.normal.each(f64::from))
    }
}

/// The result of evaluating the ray along a cut edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Said {
    /// The model has no ray along the edge.
    NoRays,
    /// The ray does not leave the solid on the way from the inside sample to the outside one.
    Nothing,
    /// The ray leaves the solid at this place (in finest cells from the universe's lower face).
    At {
        place: f64,
        normal: Option<[f64; 3]>,
        /// Whether the ray also crosses the surface elsewhere on the edge.
        several: bool,
    },
}

/// Evaluates a model on an edge between two cell centres, one of which lies inside. If the ray leaves the
/// solid at several places, the one nearest to the inside sample is returned.
pub(super) fn said(model: &TriDexelRef<'_>, edge: &Edge) -> Said {
    match &model.rays[edge.axis] {
        None => Said::NoRays,
        Some(rows) => with_rows!(rows, rows => on_ray(rows, edge, model.frame().depth())),
    }
}

fn on_ray<S: Span>(rows: &RowsRef<'_, S>, edge: &Edge, depth: u8) -> Said {
    // (There are no rays before the universe.)
    let ray = OTHERS[edge.axis].each(|axis| edge.lower[axis] as u32);
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
        // Where intervals of two materials touch, there is no surface.
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
