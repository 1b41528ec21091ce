//! A surface as triangles, with a bound of their distance from the boundary of a solid.

use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, Frame};
use crate::memory;
use crate::mesh::{TriangleMesh, TriangleTree};
use crate::solid::{BoundaryFacets, BoundaryPieces};
use alloc::sync::Arc;
use alloc::vec::Vec;

/// The maximal distance by rounding between a surface's pieces and the surface, as a part of the largest
/// coordinate.
pub(super) const ROUNDING: f64 = 1.0 / (1u64 << 41) as f64;

/// Triangles, and a radius within which they locate the boundary.
pub(super) struct Layer {
    pub(super) mesh: Arc<TriangleMesh>,
    /// The triangles that count; all if this is empty.
    pub(super) chosen: Vec<bool>,
    pub(super) radius: f64,
}

/// The known boundary of a solid in the universe.
pub(super) struct Surface {
    /// Each point of the boundary is within a layer's radius of one of the layer's triangles.
    pub(super) covers: Vec<Layer>,
    /// Each point of these triangles is within the layer's radius of a point of the boundary. `None`: this
    /// holds for the covers, too.
    pub(super) cores: Option<Vec<Layer>>,
    /// The universe, if the boundary may continue outside of it.
    pub(super) clipped: Option<Frame>,
    /// Number of cell splits.
    pub(super) splits: u64,
    /// Whether more splits would have improved the result.
    pub(super) is_cut_short: bool,
}

impl Surface {
    /// Builds an exactly known surface.
    pub(super) fn of_facets(facets: BoundaryFacets) -> Result<Surface, Error> {
        let BoundaryFacets { mesh, chosen } = facets;
        let radius = mesh.radius();
        let mut covers = memory::with_capacity(1)?;
        let is_any = if chosen.is_empty() { !mesh.triangles().is_empty() } else { chosen.contains(&true) };
        if is_any {
            covers.push(Layer { mesh, chosen, radius });
        }
        Ok(Surface { covers, cores: None, clipped: None, splits: 0, is_cut_short: false })
    }

    /// True if the boundary may exist but nothing of its position is known.
    #[cfg(feature = "std")]
    pub(super) fn is_unknown(&self) -> bool {
        !self.covers.is_empty() && self.cores.as_ref().is_some_and(Vec::is_empty)
    }

    /// Builds a surface that is known exactly except where triangles intersect.
    pub(super) fn of_pieces(pieces: BoundaryPieces) -> Result<Surface, Error> {
        let BoundaryPieces { facets, sure, doubtful, rounding } = pieces;
        let radius = facets.mesh.radius() + 2.0 * rounding;
        let layer = |triangles: [&[[[f64; 3]; 3]]; 2]| {
            let count = triangles.iter().map(|list| list.len()).sum::<usize>();
            let mut vertices = memory::with_capacity(3 * count)?;
            vertices.extend(triangles.into_iter().flatten().flatten());
            let corners = (0..count as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
            let mesh = TriangleMesh::new(vertices, memory::collected(corners)?)?;
            Ok::<_, Error>((!mesh.triangles().is_empty()).then(|| Layer {
                mesh: Arc::new(mesh),
                chosen: Vec::new(),
                radius,
            }))
        };
        let mut surface = Surface::of_facets(facets)?;
        let mut cores = memory::with_capacity(2)?;
        surface.covers.try_reserve(1)?;
        for Layer { mesh, chosen, radius } in &surface.covers {
            cores.push(Layer { mesh: mesh.clone(), chosen: memory::copied(chosen)?, radius: *radius });
        }
        cores.extend(layer([&sure, &[]])?);
        surface.covers.extend(layer([&sure, &doubtful])?);
        Ok(Surface { cores: Some(cores), ..surface })
    }

    /// Builds a surface from the triangles of a mesh, wherever the boundary that they represent may lie.
    #[cfg(feature = "std")]
    pub(super) fn of_triangles(mesh: &TriangleMesh) -> Result<Surface, Error> {
        let mut covers = memory::with_capacity(1)?;
        if !mesh.triangles().is_empty() {
            covers.push(Layer { mesh: Arc::new(mesh.try_clone()?), chosen: Vec::new(), radius: 0.0 });
        }
        Ok(Surface { covers, cores: None, clipped: None, splits: 0, is_cut_short: false })
    }

    /// Builds a surface from all triangles of a mesh, whatever they bound.
    #[cfg(feature = "std")]
    pub(super) fn of_mesh(mesh: &Arc<TriangleMesh>) -> Result<Surface, Error> {
        Surface::of_facets(BoundaryFacets { mesh: mesh.clone(), chosen: Vec::new() })
    }

    /// Builds the same surface with the trees of the triangles.
    pub(super) fn seen<'s>(&'s self, control: &Control<'_>) -> Result<Seen<'s>, Error> {
        let trees = |layers: &'s [Layer]| {
            let mut trees = memory::with_capacity(layers.len())?;
            for Layer { mesh, chosen, radius } in layers {
                trees.push(SeenLayer { tree: mesh.triangle_tree(control)?, mesh, chosen, radius: *radius });
            }
            Ok::<_, Error>(trees)
        };
        let cores = self.cores.as_deref().map(trees).transpose()?;
        let covers = trees(&self.covers)?;
        let coordinates = || {
            covers.iter().flat_map(|layer| layer.mesh.vertices()).flatten().map(|coordinate| coordinate.abs())
        };
        let rounding = ROUNDING * coordinates().fold(0.0, f64::max);
        let universe = self.clipped.as_ref().map(Bounds::of);
        Ok(Seen { covers, cores, rounding, universe })
    }
}

/// A triangle of a layer, within whose radius the boundary lies.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Facet {
    layer: u32,
    triangle: u32,
}

impl Facet {
    pub(super) const NONE: Facet = Facet { layer: u32::MAX, triangle: u32::MAX };

    /// The index in its layer; `None` for `Facet::NONE`.
    #[cfg(feature = "std")]
    pub(super) fn triangle(self) -> Option<u32> {
        (self != Facet::NONE).then_some(self.triangle)
    }

    fn of_layer(self, layer: u32) -> Option<u32> {
        (self.layer == layer).then_some(self.triangle)
    }
}

/// The bounds of the distance of a point from the boundary.
#[derive(Clone, Copy)]
pub(super) struct Near {
    pub(super) lower: f64,
    pub(super) upper: f64,
    /// The triangle that determines `upper`.
    pub(super) facet: Facet,
}

impl Near {
    /// Not computed yet.
    pub(super) const OPEN: Near = Near { lower: 0.0, upper: f64::INFINITY, facet: Facet::NONE };
    /// There is no boundary.
    const NOTHING: Near = Near { lower: f64::INFINITY, upper: f64::INFINITY, facet: Facet::NONE };
}

pub(super) struct SeenLayer<'s> {
    pub(super) tree: TriangleTree<'s>,
    pub(super) mesh: &'s TriangleMesh,
    chosen: &'s [bool],
    pub(super) radius: f64,
}

impl SeenLayer<'_> {
    pub(super) fn is_chosen(&self, triangle: u32) -> bool {
        self.chosen.is_empty() || self.chosen[triangle as usize]
    }

    pub(super) fn corners(&self, triangle: u32) -> [[f64; 3]; 3] {
        self.mesh.triangles()[triangle as usize].each(|vertex| self.mesh.vertices()[vertex as usize])
    }
}

/// A surface with the trees of its triangles.
pub(super) struct Seen<'s> {
    pub(super) covers: Vec<SeenLayer<'s>>,
    cores: Option<Vec<SeenLayer<'s>>>,
    /// The maximal distance by rounding between the surface's pieces and the surface.
    pub(super) rounding: f64,
    universe: Option<Bounds>,
}

impl<'s> Seen<'s> {
    fn cores(&self) -> &[SeenLayer<'s>] {
        self.cores.as_deref().unwrap_or(&self.covers)
    }

    /// True if the triangles are the boundary itself.
    pub(super) fn is_exact(&self) -> bool {
        self.cores.is_none()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.covers.is_empty()
    }

    /// True if nothing of the boundary's position is known.
    #[cfg(feature = "std")]
    pub(super) fn is_unknown(&self) -> bool {
        self.cores().is_empty()
    }

    /// The number of triangles.
    pub(super) fn count(&self) -> usize {
        self.covers.iter().map(|layer| layer.mesh.triangles().len()).sum()
    }

    /// True if there are enough triangles to justify threads.
    pub(super) fn is_large(&self) -> bool {
        const MANY: usize = 1 << 12;
        self.count() > MANY
    }

    /// Returns the distance of a point from the boundary. A hint that is a near facet saves time.
    pub(super) fn near(&self, point: [f64; 3], hint: Facet) -> Near {
        let mut near = match &self.cores {
            None => Near::NOTHING,
            Some(_) => self.near_core(point, hint),
        };
        for (number, layer) in (0..).zip(&self.covers) {
            // (Layers of both lists are often about the same.)
            let hint = hint.of_layer(number);
            let found = layer.tree.nearest_beside(&point, hint, |triangle| layer.is_chosen(triangle));
            let Some((found, distance)) = found else {
                // Every layer has triangles, so the point is too far away.
                near.lower = 0.0;
                continue;
            };
            near.lower = near.lower.min(distance.lower - layer.radius);
            let upper = distance.upper + layer.radius;
            if self.is_exact() && upper < near.upper {
                near = Near { upper, facet: Facet { layer: number, triangle: found.triangle }, ..near };
            }
        }
        if let Some(Bounds { min, max }) = &self.universe {
            // The boundary may begin directly outside.
            let inside = (0..3).map(|axis| (point[axis] - min[axis]).min(max[axis] - point[axis]));
            near.lower = near.lower.min(inside.fold(f64::INFINITY, f64::min));
        }
        near.lower = near.lower.max(0.0).min(near.upper);
        near
    }

    /// Returns an upper bound of a point's distance from the boundary.
    pub(super) fn near_core(&self, point: [f64; 3], hint: Facet) -> Near {
        let mut near = Near::NOTHING;
        for (number, layer) in (0..).zip(self.cores()) {
            let is_chosen = |triangle| layer.is_chosen(triangle);
            if let Some((found, distance)) =
                layer.tree.nearest_beside(&point, hint.of_layer(number), is_chosen)
            {
                let upper = distance.upper + layer.radius;
                if upper < near.upper {
                    near = Near { upper, facet: Facet { layer: number, triangle: found.triangle }, ..near };
                }
            }
        }
        near
    }

    /// Returns an upper bound of a point's distance from the boundary next to a facet.
    pub(super) fn most_from(&self, facet: Facet, point: [f64; 3]) -> f64 {
        let Some(layer) = self.cores().get(facet.layer as usize) else { return f64::INFINITY };
        layer.tree.most_from(facet.triangle, &point) + layer.radius
    }

    /// The corners of a facet.
    pub(super) fn corners(&self, facet: Facet) -> Option<[[f64; 3]; 3]> {
        Some(self.cores().get(facet.layer as usize)?.corners(facet.triangle))
    }

    /// The point of a facet that is nearest to another point.
    pub(super) fn nearest_on(&self, facet: Facet, point: [f64; 3]) -> Option<[f64; 3]> {
        Some(self.cores().get(facet.layer as usize)?.tree.nearest_to(facet.triangle, &point))
    }
}
