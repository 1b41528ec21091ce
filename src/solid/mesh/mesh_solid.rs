//! A mesh as a solid: the splits of its cells, and all its answers.

use super::chords::{Chords, Rays};
use super::crossing::Projection;
use super::direct::{self, Tracer};
use super::layers::{Layering, Layers};
use super::local::View;
use super::on_frame::{Branch, MeshOnFrame, MeshPart};
use super::open::Surroundings;
use super::open_rays::OpenRays;
use super::overlap::Overlap;
use super::placed::{Corners, Placed, bounds, ranks};
use super::reach;
use super::rim::Rim;
use super::scan::{Scan, Task};
use super::winding::Caps;
use crate::control::Control;
use crate::dexel::Beam;
use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{Affine, Bounds, Cell, Frame};
use crate::memory;
use crate::mesh::{FacetPlanes, FillRule, Loops, MeshMoments, Pieces, Sides, TriangleMesh};
use crate::octree::{Block, Proof, Tag};
use crate::solid::{
    Batch, BoundaryFacets, BoundaryPieces, Classifier, Crossing, Direct, Enclosure, Fingerprint,
    Fingerprinter, LayersQuestion, Motion, Parts, Question, Segment, Solid, Verdict, WholeQuestion, Worker,
    sample_one_by_one, split_one_by_one,
};
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use once_cell::race::OnceBox;

/// A triangle mesh as a solid. Cheap to clone.
///
/// Any mesh is accepted. For a closed mesh, the inside is exact. For an open mesh, [`FillRule`] is the
/// convention that says which points are inside. A cell is FULL or EMPTY only if this is proven for all of
/// its points. Around holes, cells that no triangle cuts stay PARTIAL; [`TriangleMesh::report`] counts the
/// holes.
///
/// # Single queries
/// Rays ([`cast_rays`](crate::cast_rays), [`ray_spans`](crate::query::ray_spans)), points
/// ([`contains`](crate::contains)), boxes ([`classify_box`](crate::query::classify_box)) and distances
/// ([`distances`](crate::query::distances)) are answered without cells. The first such query builds its data
/// structures. These are: a tree over the triangles, which the mesh keeps for all solids that share it (O(t
/// log t), 0.1 to 0.3 µs a triangle; 36 bytes a triangle); for distances of closed meshes, on which sides of
/// its triangles the solid lies (about twice that time, and a byte a triangle); for open meshes, the rim of
/// their holes (48 bytes an edge). A [placed](Self::placed) copy takes over the order of the tree, and
/// recomputes its boxes. Threads whose first queries coincide may each build the structures once. A solid
/// that is not [`Prepared`](crate::solid::Prepared) is put on its frame for every call, which takes longer
/// than the answer.
///
/// Near a hole, a query of an open mesh looks at all edges of the rim: once as a rule, and some dozen times
/// for a ray through a hole. Where the winding number is one half away from triangles, the ends of spans are
/// as narrow as at triangles, but have no triangle. Some queries still take cells: rays that come very near
/// to the rim; boxes and points next to a hole if the rim's bounds are too wide for them; and all rays, boxes
/// and distances if the rim has more than 16 384 edges.
///
/// ```
/// use leafless::{Control, FillRule, Frame, MeshSolid, Rule, TriangleMesh, build};
/// let vertices = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let mesh = TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
/// let solid = MeshSolid::new(mesh, FillRule::NonZero)?;
/// let tree = build(&solid, &Frame::new([0.0; 3], 1.0, 6)?, Rule::Certified, &Control::default())?;
/// assert!(tree.statistics().volume().contains(1.0 / 6.0));
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Clone)]
pub struct MeshSolid {
    mesh: Arc<TriangleMesh>,
    fill: FillRule,
    boundary: Arc<Boundary>,
}

/// Lazily computed properties of a mesh's boundary, and of the solid that it encloses.
struct Boundary {
    loops: Loops,
    /// The reach of the solid beyond the mesh's bounding box. Computed on first use.
    reach: OnceBox<[[f64; 3]; 2]>,
    /// The moments of the solid. Computed on first use.
    moments: OnceBox<MeshMoments>,
    /// The sides of the triangles on which the solid lies; `None` if triangles lie too close to each other.
    /// Computed on first use.
    sides: OnceBox<Option<Sides>>,
    /// The rim of an open mesh. Computed on first use.
    rim: OnceBox<Rim>,
}

/// A mesh on a frame: a cheap handle.
#[derive(Clone)]
pub struct MeshClassifier {
    mesh: Arc<MeshOnFrame>,
    solid: MeshSolid,
}

/// A worker on a mesh: the lists of triangles of the cells on the way down, and scratch memory.
pub struct MeshWorker {
    mesh: Arc<MeshOnFrame>,
    solid: MeshSolid,
    triangles: Vec<u32>,
    /// Per triangle: bit k is set if the triangle belongs to child k.
    masks: Vec<u8>,
    surroundings: Surroundings,
    scan: Option<Box<Scan>>,
    chords: Chords,
    direct: direct::Direct,
    open_rays: OpenRays,
}

impl MeshSolid {
    /// Makes a solid of the points that a mesh encloses. The mesh is shared (an `Arc`) or taken over. O(1)
    /// for a closed mesh whose edges were analysed before. Otherwise O(t), and O(n log n) in the edges of the
    /// boundary.
    ///
    /// # Errors
    /// [`Error::Mesh`] in three cases: the mesh is empty; an odd number of triangles meet on an edge, for
    /// [`FillRule::EvenOdd`]; the mesh has a [deviation](TriangleMesh::with_deviation) and [is not
    /// closed](TriangleMesh::check_closed) as the rule demands. [`Error::OutOfMemory`].
    pub fn new(mesh: impl Into<Arc<TriangleMesh>>, fill: FillRule) -> Result<MeshSolid, Error> {
        let mesh = mesh.into();
        if mesh.deviation() > 0.0 {
            // (A rim with a deviation may wind around a point in any way.)
            mesh.check_closed(fill)?;
        }
        let loops = match fill {
            FillRule::EvenOdd => {
                mesh.check_closed(fill)?;
                Loops::default()
            }
            FillRule::NonZero | FillRule::Positive if mesh.triangles().is_empty() => {
                return Err(MeshError::Empty.into());
            }
            FillRule::NonZero | FillRule::Positive => mesh.loops()?,
        };
        Ok(MeshSolid {
            mesh,
            fill,
            boundary: Arc::new(Boundary {
                loops,
                reach: OnceBox::new(),
                moments: OnceBox::new(),
                sides: OnceBox::new(),
                rim: OnceBox::new(),
            }),
        })
    }

    /// The mesh that bounds the solid.
    pub fn mesh(&self) -> &Arc<TriangleMesh> {
        &self.mesh
    }

    /// Returns the volume and the moments of the solid, or the reason why they need a split of cells:
    /// [`TriangleMesh::moments`], kept for the solid and its clones.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    pub fn moments(&self, control: &Control<'_>) -> Result<MeshMoments, Error> {
        let find = || self.mesh.moments(self.fill, control).map(Box::new);
        self.boundary.moments.get_or_try_init(find).copied()
    }

    /// Returns the tracer that answers without cells. `None` before the triangles have a tree and, for an
    /// open mesh, before its rim is computed.
    #[inline]
    fn tracer(&self) -> Option<Tracer<'_>> {
        let rim = if self.is_closed() { None } else { Some(self.boundary.rim.get()?) };
        Some(Tracer { tree: self.mesh.known_triangle_tree()?, fill: self.fill, rim })
    }

    /// Returns whether the rim is short enough for rays, boxes and distances to look at all of it.
    fn is_traced(&self) -> bool {
        self.boundary.loops.edges() <= MOST_EDGES
    }

    fn is_closed(&self) -> bool {
        self.boundary.loops.caps() == 0
    }

    /// Returns on which side of each triangle the solid lies, as far as this is known.
    fn sides(&self, control: &Control<'_>) -> Result<Option<&Sides>, Error> {
        let find = || self.mesh.sides(self.fill, control).map(Box::new);
        self.boundary.sides.get_or_try_init(find).map(Option::as_ref)
    }

    /// Returns the solid under an affine map. Its vertices are moved as [`TriangleMesh::placed`] says.
    ///
    /// # Errors
    /// As [`TriangleMesh::placed`].
    pub fn placed(&self, placement: &Affine) -> Result<MeshSolid, Error> {
        if placement.is_identity() {
            return Ok(self.clone());
        }
        MeshSolid::new(self.mesh.placed(placement)?, self.fill)
    }
}

impl MeshOnFrame {
    fn exterior(&self) -> Tag {
        let mesh = &self.placed.mesh;
        let (min, max) = mesh.bounds();
        let within = Bounds::new(min, max)
            .is_some_and(|bounds| bounds.grown(mesh.displacement()).is_within(&self.placed.frame));
        if within && self.is_empty_outside() { Tag::Empty } else { Tag::Partial }
    }

    /// The planes of the mesh. Computed on first use.
    fn layers(&self, control: &Control<'_>) -> Result<&Layers, Error> {
        self.layers.get_or_try_init(|| {
            let Placed { mesh, frame, .. } = &self.placed;
            let displacement = mesh.displacement();
            let planes = FacetPlanes::new(mesh, displacement == 0.0, control)?;
            let ends = frame.origin().into_iter().flat_map(|c| [c, c + frame.edge()]);
            let of_mesh = [mesh.bounds().0, mesh.bounds().1].into_iter().flatten();
            let reach = ends.chain(of_mesh).fold(0.0, |most: f64, c| most.max(c.abs()));
            Ok(Box::new(Layers::new(planes, reach, displacement)))
        })
    }

    /// The verdict of a cell that these triangles cut.
    #[inline]
    fn verdict(
        &self,
        surroundings: &mut Surroundings,
        triangles: &[u32],
        at: [i32; 3],
        size: i32,
        part: MeshPart,
    ) -> Verdict<MeshPart> {
        match part.caps {
            Some(_) => self.open_verdict(surroundings, triangles, at, size, part),
            None => self.closed_verdict(part),
        }
    }
}

/// The most edges of a rim for which every ray, box or distance looks at all edges. With more edges, cells
/// are as fast.
const MOST_EDGES: usize = 1 << 14;

/// The number of triangles that are processed together.
const BATCH: usize = 64;

/// The lowest finest cell of `cell`, and its edge in finest cells.
fn extent(cell: Cell, depth: u8) -> ([i32; 3], i32) {
    (cell.first_at(depth).at.each(|a| a as i32), 1 << (depth - cell.level))
}

/// The triangles of a part: the universe's list is shared, the other lists lie in the scratch memory.
#[inline(always)]
fn list<'t>(roots: &'t [u32], own: &'t [u32], part: &MeshPart) -> &'t [u32] {
    match part.first.checked_sub(roots.len()) {
        None => &roots[part.first..part.first + part.count],
        Some(first) => &own[first..first + part.count],
    }
}

impl Solid for MeshSolid {
    type Classifier = MeshClassifier;

    /// O(v + t); memory beyond the mesh: 37 bytes a vertex, and 4 a triangle. The universe clips a mesh that
    /// reaches beyond it; the exterior reports this.
    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<MeshClassifier, Error> {
        let mut placed = Placed::new(self.mesh.clone(), frame)?;
        let caps = Caps::close(&mut placed, &self.boundary.loops)?;
        let mut roots = Vec::new();
        let count = placed.count();
        roots.try_reserve_exact(count as usize)?;
        let size = frame.cells() as f64;
        let mut winding = 0;
        for triangle in 0..count {
            if triangle % 65536 == 0 && control.is_cancelled() {
                return Err(Error::Cancelled);
            }
            let corners = placed.corners(triangle);
            // The winding number is zero at infinity: follow the lowest centre's line along x from there.
            let spans = |axis: usize| {
                let (first, end) = ranks(&corners, axis);
                first <= 0 && 0 < end
            };
            if spans(1) && spans(2) && ranks(&corners, 0).0 <= 0 {
                let mut seen = Projection::new(&placed, triangle, corners, 0);
                if let Some(span) = seen.span(0).filter(|span| span.first <= 0 && 0 < span.end)
                    && seen.above(0, 0, span.step) <= 0
                {
                    winding += span.step;
                }
            }
            let (min, max) = bounds(&placed, &corners);
            let within = (0..3).all(|axis| min[axis] > 0.0 && max[axis] < size);
            if within || Overlap::new(&placed, &corners, size, frame.depth()).cuts([0.0; 3], size) {
                roots.push(triangle);
            }
        }
        let exterior = OnceBox::new();
        let layers = OnceBox::new();
        let mesh = Arc::new(MeshOnFrame { placed, caps, fill: self.fill, roots, winding, exterior, layers });
        Ok(MeshClassifier { mesh, solid: self.clone() })
    }

    /// The bounding box of a closed mesh. An open mesh may enclose points beyond its own bounding box, and
    /// the box is larger by as much; this takes O(n) in the edges of the boundary, once.
    fn bounds(&self) -> Option<Bounds> {
        let (min, max) = self.mesh.bounds();
        let displacement = self.mesh.displacement();
        let bounds = Bounds::new(min, max)?.grown(displacement);
        let Boundary { loops, reach, .. } = &*self.boundary;
        if loops.caps() == 0 {
            return Some(bounds);
        }
        let find = || reach::reach(&self.mesh, loops, displacement).map(Box::new);
        // (Without the memory to compute the reach, there are no bounds.)
        let [below, above] = reach.get_or_try_init(find).ok()?;
        Bounds::new(
            axes(|axis| {
                if below[axis] == 0.0 {
                    bounds.min[axis]
                } else {
                    (bounds.min[axis] - below[axis]).next_down()
                }
            }),
            axes(|axis| {
                if above[axis] == 0.0 { bounds.max[axis] } else { (bounds.max[axis] + above[axis]).next_up() }
            }),
        )
    }

    fn placed(&self, placement: &Affine) -> Result<Option<MeshSolid>, Error> {
        MeshSolid::placed(self, placement).map(Some)
    }

    fn motion(&self) -> Motion {
        Motion::Vertices
    }

    /// The bytes of the mesh, and of all properties computed so far.
    fn kept_bytes(&self) -> u64 {
        let Boundary { loops, reach, moments, sides, rim } = &*self.boundary;
        let found = reach.get().map_or(0, size_of_val)
            + moments.get().map_or(0, size_of_val)
            + sides.get().map_or(0, |sides| size_of_val(sides) + sides.as_ref().map_or(0, Sides::bytes))
            + rim.get().map_or(0, |rim| size_of_val(rim) + rim.bytes());
        self.mesh.bytes() + (size_of::<Boundary>() + loops.bytes() + found) as u64
    }

    /// The fingerprint of the mesh. O(v + t).
    fn fingerprint(&self) -> Option<Fingerprint> {
        let (vertices, triangles) =
            (self.mesh.vertices().as_flattened(), self.mesh.triangles().as_flattened());
        let all = Fingerprinter::new("mesh")
            .integers(&[self.fill as u64])
            .numbers(&[self.mesh.displacement()])
            .numbers(vertices)
            .words(triangles.len() as u64, triangles.iter().map(|&index| index.into()));
        // (So a deviation of zero does not change the fingerprint.)
        let deviation = self.mesh.deviation();
        Some(if deviation > 0.0 { all.numbers(&[deviation]) } else { all }.finish())
    }
}

impl Classifier for MeshClassifier {
    type Worker = MeshWorker;

    fn frame(&self) -> &Frame {
        &self.mesh.placed.frame
    }

    fn worker(&self) -> Result<MeshWorker, Error> {
        Ok(MeshWorker {
            mesh: self.mesh.clone(),
            solid: self.solid.clone(),
            triangles: Vec::new(),
            masks: Vec::new(),
            surroundings: Surroundings::default(),
            scan: None,
            chords: Chords::default(),
            direct: direct::Direct::default(),
            open_rays: OpenRays::default(),
        })
    }

    fn exterior(&self) -> Tag {
        let mesh = &*self.mesh;
        *mesh.exterior.get_or_init(|| Box::new(mesh.exterior()))
    }

    fn proof(&self) -> Proof {
        Proof::CERTIFIED.moved(self.mesh.placed.mesh.displacement())
    }

    fn kept_bytes(&self) -> u64 {
        let MeshOnFrame { placed, caps, roots, layers, .. } = &*self.mesh;
        let layers = layers.get().map_or(0, Layers::bytes);
        (size_of::<MeshOnFrame>() + placed.bytes() + caps.bytes() + memory::bytes_of(roots) + layers) as u64
    }

    /// Moments and area are available if the mesh is closed and no two triangles intersect. O(t).
    fn answer_whole(&self, question: WholeQuestion<'_>, control: &Control<'_>) -> Result<(), Error> {
        let solid = &self.solid;
        match question {
            WholeQuestion::Moments(known) => match solid.moments(control)? {
                MeshMoments::Known(moments) => *known = Some(moments),
                MeshMoments::Open | MeshMoments::Intersecting(_) | MeshMoments::Undecided => {
                    // A query of moments is usually followed by queries of cells' moments, which need the
                    // sides.
                    solid.sides(control)?;
                }
            },
            WholeQuestion::Area(known) => {
                *known = solid.sides(control)?.and_then(|sides| solid.mesh.boundary_area(sides));
            }
            WholeQuestion::Surfaces(_) => {}
            WholeQuestion::Layers(known) => *known = Some(self.mesh.layers(control)?.list()?),
            WholeQuestion::Direct(kind, is_direct) => {
                let Boundary { loops, rim, .. } = &*solid.boundary;
                if loops.caps() == 0 {
                    solid.mesh.triangle_tree(control)?;
                    *is_direct = kind != Direct::Distances || solid.sides(control)?.is_some();
                } else if kind == Direct::Points || solid.is_traced() {
                    solid.mesh.triangle_tree(control)?;
                    rim.get_or_try_init(|| direct::rim(&solid.mesh, loops).map(Box::new))?;
                    *is_direct = true;
                }
            }
            WholeQuestion::Facets(known) => {
                if solid.is_closed()
                    && self.exterior() == Tag::Empty
                    && let Some(sides) = solid.sides(control)?
                {
                    *known =
                        sides.boundary()?.map(|chosen| BoundaryFacets { mesh: solid.mesh.clone(), chosen });
                }
            }
            WholeQuestion::Pieces(size, known) => {
                if solid.is_closed()
                    && self.exterior() == Tag::Empty
                    && let Some(sides) = solid.sides(control)?
                {
                    let found = solid.mesh.pieces(sides, solid.fill, size, control)?;
                    let facets = BoundaryFacets { mesh: solid.mesh.clone(), chosen: sides.bounding()? };
                    *known = found.map(|Pieces { sure, doubtful, rounding }| BoundaryPieces {
                        facets,
                        sure,
                        doubtful,
                        rounding,
                    });
                }
            }
            WholeQuestion::Walls(known) => {
                if solid.is_closed()
                    && self.exterior() == Tag::Empty
                    && let Some(sides) = solid.sides(control)?
                {
                    let chosen = match sides.boundary()? {
                        None => sides.walls(&solid.mesh, solid.fill, control)?,
                        facets => facets,
                    };
                    *known = chosen.map(|chosen| BoundaryFacets { mesh: solid.mesh.clone(), chosen });
                }
            }
            WholeQuestion::OffLattice(known) => {
                *known = self.mesh.placed.displacement == 0.0
                    && self.mesh.caps.is_empty()
                    && self.mesh.has_no_triangle_in_planes();
            }
        }
        Ok(())
    }
}

/// The view of a cell that the surface cuts, if the surface's winding number in it is an integer or near to
/// one.
fn view<'a>(
    mesh: &'a MeshOnFrame,
    own: &'a [u32],
    surroundings: &mut Surroundings,
    cell: Cell,
    part: &MeshPart,
) -> Option<View<'a>> {
    let placed = &mesh.placed;
    let (at, size) = extent(cell, placed.frame.depth());
    let mut triangles = list(&mesh.roots, own, part);
    let mut winding = part.winding;
    if part.caps.is_some() {
        winding = mesh.nearest_winding(surroundings, triangles, at, size, *part)?;
        triangles = &triangles[..triangles.partition_point(|&triangle| !placed.is_cap(triangle))];
    }
    let is_cut = !triangles.is_empty();
    is_cut.then_some(View { placed, triangles, at, size, winding })
}

impl Parts for MeshWorker {
    type Part = MeshPart;

    fn mark(&self) -> usize {
        self.triangles.len()
    }

    fn scratch_bytes(&self) -> usize {
        size_of_val(&*self.triangles)
    }

    fn release(&mut self, mark: usize) {
        self.triangles.truncate(mark);
    }

    fn hand_over(&mut self, from: &Self, part: &MeshPart) -> Result<MeshPart, Error> {
        let first = self.mesh.roots.len() + self.triangles.len();
        self.triangles.try_reserve(part.count)?;
        self.triangles.extend_from_slice(list(&from.mesh.roots, &from.triangles, part));
        Ok(MeshPart { first, ..*part })
    }
}

impl Worker for MeshWorker {
    fn frame(&self) -> &Frame {
        &self.mesh.placed.frame
    }

    fn root(&mut self) -> Result<Verdict<MeshPart>, Error> {
        let MeshWorker { mesh, surroundings, .. } = self;
        let caps = if mesh.caps.is_empty() { None } else { Some(Branch::UNKNOWN) };
        let part = MeshPart { first: 0, count: mesh.roots.len(), winding: mesh.winding, caps };
        Ok(mesh.verdict(surroundings, &mesh.roots, [0; 3], mesh.placed.frame.cells() as i32, part))
    }

    fn split(&mut self, cell: Cell, part: &MeshPart) -> Result<[Verdict<MeshPart>; 8], Error> {
        let depth = self.mesh.placed.frame.depth();
        debug_assert!(cell.level < depth, "finest cells have no children");
        let (at, size) = extent(cell, depth);
        let half = size / 2;
        let height = depth - cell.level - 1;
        let MeshWorker { mesh, triangles, masks, surroundings, .. } = self;
        let shared = mesh.roots.len();

        masks.clear();
        masks.try_reserve(part.count)?;
        let mut counts = [0; 8];
        let mut steps = [[0; 8]; 2];
        let mut boxes = [[[0; 3]; 2]; BATCH];
        for batch in list(&mesh.roots, triangles, part).chunks(BATCH) {
            // Memory is slow: many loads are started before the first result is used.
            for (ranks, &triangle) in boxes.iter_mut().zip(batch) {
                *ranks = mesh.placed.rank_box(triangle);
            }
            for (&ranks, &triangle) in boxes.iter().zip(batch) {
                mesh.pierce(triangle, ranks, at, half, &mut steps);
                let mask = match only_child(ranks, at, half) {
                    Some(mask) if mesh.placed.ranks_tell() && height > 0 => mask,
                    _ => children_cut(&mesh.placed, &mesh.placed.corners(triangle), at, half, height),
                };
                masks.push(mask);
                counts.iter_mut().enumerate().for_each(|(k, count)| *count += (mask >> k & 1) as usize);
            }
        }
        let top = triangles.len();
        triangles.try_reserve(counts.iter().sum())?;
        let mut firsts = [0; 8];
        for k in 1..8 {
            firsts[k] = firsts[k - 1] + counts[k - 1];
        }
        let mut next = firsts;
        triangles.resize(top + counts.iter().sum::<usize>(), 0);
        let (above, below) = triangles.split_at_mut(top);
        for (&triangle, &mask) in list(&mesh.roots, above, part).iter().zip(masks.iter()) {
            let mut left = mask;
            while left != 0 {
                let k = left.trailing_zeros() as usize;
                left &= left - 1;
                below[next[k]] = triangle;
                next[k] += 1;
            }
        }
        for steps in &mut steps {
            for child in 2..8 {
                // The way to children 2 and 3 begins at 0 and 1, to 4 … 7 at 0 … 3.
                steps[child] += steps[child - if child < 4 { 2 } else { 4 }];
            }
        }
        let [steps, jumps] = steps;
        let mut verdicts = [Verdict::Undecided; 8];
        for (k, verdict) in verdicts.iter_mut().enumerate() {
            let (first, count) = (firsts[k], counts[k]);
            let at = axes(|axis| at[axis] + if k >> axis & 1 != 0 { half } else { 0 });
            let caps = part.caps.map(|branch| branch.plus(jumps[k]));
            let winding = part.winding + steps[k];
            let part = MeshPart { first: shared + top + first, count, winding, caps };
            *verdict = mesh.verdict(surroundings, &below[first..first + count], at, half, part);
        }
        Ok(verdicts)
    }

    fn fill(&mut self, cell: Cell, part: &MeshPart, block: &mut Block) -> Result<bool, Error> {
        let MeshWorker { mesh, triangles, scan, open_rays, .. } = self;
        let (at, _) = extent(cell, mesh.placed.frame.depth());
        let triangles = list(&mesh.roots, triangles, part);
        if part.caps.is_some() {
            // (For an open surface, each cell is queried whether the boundary crosses it.)
            if block.planes_mut().is_some() {
                return Ok(false);
            }
            let Some(centres) = block.centres_mut() else { return Ok(false) };
            mesh.open_centres(open_rays, (triangles, at), *part, centres)?;
            return Ok(true);
        }
        let task = Task { placed: &mesh.placed, at, triangles, winding: part.winding, fill: mesh.fill };
        let scan = match scan {
            Some(scan) => scan,
            none => none.insert(Box::new(Scan::new()?)),
        };
        scan.fill(task, block)?;
        Ok(true)
    }

    #[inline]
    fn answer(&mut self, cell: Cell, part: &MeshPart, question: Question<'_>) -> Result<(), Error> {
        let fill = self.mesh.fill;
        match question {
            Question::Centre(inside) => *inside = Some(self.contains_centre(cell, part)),
            Question::Enclosure(known) => *known = self.slab(cell, part),
            Question::Moments(known) => {
                *known = self.of_sides(cell, part, |view, sides| view.moments(sides, fill))?
            }
            Question::Area(known) => {
                *known = self.of_sides(cell, part, |view, sides| view.area(sides, fill))?
            }
            Question::Crossing(segment, known) => *known = self.first_crossing(cell, part, segment),
            Question::Chords(chords) => *chords.found = self.find_chords(cell, part, chords.beam)?,
            Question::Surfaces(_) => {}
            Question::Layers(question) => self.find_layers(cell, part, question)?,
            Question::Ray(ray) => match self.solid.tracer() {
                Some(tracer @ Tracer { rim: None, .. }) => tracer.trace(&mut self.direct, ray)?,
                Some(tracer @ Tracer { rim: Some(rim), .. }) if self.solid.is_traced() => {
                    tracer.trace_open(&mut self.direct, rim, ray)?;
                }
                _ => {}
            },
            Question::Box(bounds, known) => {
                if let Some(tracer) = self.solid.tracer().filter(|_| self.solid.is_traced()) {
                    *known = tracer.content_of(&mut self.direct, bounds)?;
                }
            }
            Question::Nearest(point, known) => {
                let Some(tracer) = self.solid.tracer().filter(|_| self.solid.is_traced()) else {
                    return Ok(());
                };
                match (tracer.rim, self.solid.boundary.sides.get()) {
                    (Some(rim), _) => *known = tracer.nearest_open(&mut self.direct, rim, &point)?,
                    (None, Some(Some(sides))) => *known = tracer.nearest(&mut self.direct, sides, &point)?,
                    _ => {}
                }
            }
        }
        Ok(())
    }
}

impl Batch for MeshWorker {
    fn likes_many(&self) -> bool {
        false
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, MeshPart)],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<MeshPart>; 8]>,
    ) -> Result<(), Error> {
        split_one_by_one(self, cells, control, verdicts)
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, MeshPart)],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        sample_one_by_one(self, cells, control, inside)
    }

    /// Answers once [`WholeQuestion::Direct`] was asked. A point on the surface gets no answer.
    fn inside(&mut self, points: &[[f64; 3]], answers: &mut [Option<bool>]) -> Result<(), Error> {
        let Some(tracer) = self.solid.tracer() else { return Ok(()) };
        for (point, answer) in points.iter().zip(answers) {
            *answer = tracer.is_inside(&mut self.direct, point)?;
        }
        Ok(())
    }

    fn recall(&mut self, _: Cell) -> Option<MeshPart> {
        None
    }
}

impl MeshWorker {
    /// Evaluates a function of the sides of triangles on which the solid lies, in a cell.
    fn of_sides<T>(
        &mut self,
        cell: Cell,
        part: &MeshPart,
        tell: impl FnOnce(&View<'_>, &Sides) -> Result<Option<T>, Error>,
    ) -> Result<Option<T>, Error> {
        let MeshWorker { mesh, solid, triangles, surroundings, .. } = self;
        match (solid.sides(&Control::threads(1))?, view(mesh, triangles, surroundings, cell, part)) {
            (Some(sides), Some(view)) => tell(&view, sides),
            _ => Ok(None),
        }
    }

    /// Returns whether the centre of a finest cell lies inside: its only centre is its lowest centre.
    fn contains_centre(&mut self, cell: Cell, part: &MeshPart) -> bool {
        match part.caps {
            Some(_) => {
                let (at, _) = extent(cell, self.mesh.placed.frame.depth());
                self.mesh.open_sample(&mut self.surroundings, at, *part)
            }
            None => self.mesh.fill.encloses(part.winding),
        }
    }

    fn slab(&mut self, cell: Cell, part: &MeshPart) -> Option<Enclosure> {
        let MeshWorker { mesh, triangles, surroundings, .. } = self;
        if let Some(view) = view(mesh, triangles, surroundings, cell, part) {
            return view.slab(mesh.fill);
        }
        let (at, size) = extent(cell, mesh.placed.frame.depth());
        mesh.open_slab(surroundings, list(&mesh.roots, triangles, part), at, size, *part)
    }

    fn find_layers(
        &mut self,
        cell: Cell,
        part: &MeshPart,
        question: LayersQuestion<'_>,
    ) -> Result<(), Error> {
        let MeshWorker { mesh, triangles, surroundings, .. } = self;
        let LayersQuestion { tolerance, own, known } = question;
        if let (Some(layers), Some(view)) =
            (mesh.layers.get(), view(mesh, triangles, surroundings, cell, part))
            && let Some(layering) = Layering::new(view, layers, mesh.fill, tolerance)?
        {
            *known = layering.function(own)?;
        }
        Ok(())
    }

    fn first_crossing(&mut self, cell: Cell, part: &MeshPart, segment: &Segment) -> Option<Crossing> {
        let MeshWorker { mesh, triangles, surroundings, .. } = self;
        let view = view(mesh, triangles, surroundings, cell, part);
        view.and_then(|view| view.first_crossing(segment, mesh.fill))
    }

    fn find_chords(&mut self, cell: Cell, part: &MeshPart, beam: &mut Beam) -> Result<bool, Error> {
        if self.mesh.placed.count() > Chords::MOST {
            return Ok(false);
        }
        let MeshWorker { mesh, triangles, open_rays, chords, .. } = self;
        let (at, size) = extent(cell, mesh.placed.frame.depth());
        let triangles = list(&mesh.roots, triangles, part);
        if part.caps.is_some() {
            return mesh.open_chords(open_rays, (triangles, at, size), *part, beam);
        }
        // Caps come last in the list. They are not counted where the surface's own winding number is known.
        let triangles = &triangles[..triangles.partition_point(|&triangle| !mesh.placed.is_cap(triangle))];
        let rays = Rays { placed: &mesh.placed, at, triangles, winding: part.winding, fill: mesh.fill };
        chords.find(rays, beam)?;
        Ok(true)
    }
}

/// Returns the child of edge `half` of the cell at `at` in whose interior a triangle lies, if the triangle's
/// ranks suffice: the result of [`children_cut`], without a look at the corners.
#[inline(always)]
fn only_child([low, high]: [[i32; 3]; 2], at: [i32; 3], half: i32) -> Option<u8> {
    let mut mask = 0xFFu8;
    for (axis, upper) in [0b1010_1010u8, 0b1100_1100, 0b1111_0000].into_iter().enumerate() {
        let (bottom, middle, top) = (at[axis], at[axis] + half, at[axis] + 2 * half);
        if low[axis] > bottom && high[axis] < middle {
            mask &= !upper;
        } else if low[axis] > middle && high[axis] < top {
            mask &= upper;
        } else {
            return None;
        }
    }
    Some(mask)
}

/// Returns which children of edge `half` of the cell at `at` a triangle cuts, as a bit mask.
fn children_cut(placed: &Placed, corners: &Corners, at: [i32; 3], half: i32, height: u8) -> u8 {
    let (min, max) = bounds(placed, corners);
    let mut candidates = 0xFFu8;
    let mut strictly = true;
    for (axis, upper) in [0b1010_1010u8, 0b1100_1100, 0b1111_0000].into_iter().enumerate() {
        let (low, middle, high) = (at[axis] as f64, (at[axis] + half) as f64, (at[axis] + 2 * half) as f64);
        if max[axis] <= middle {
            candidates &= !upper;
            strictly &= min[axis] > low && max[axis] < middle;
        }
        if min[axis] >= middle {
            candidates &= upper;
            strictly &= min[axis] > middle && max[axis] < high;
        }
    }
    // A triangle well inside the only child that its box reaches needs no further test. (A finest cell needs
    // the test all the same: only the test finds that a triangle without area cuts nothing.)
    if candidates.count_ones() == 1 && strictly && height > 0 {
        return candidates;
    }
    let overlap = Overlap::new(placed, corners, half as f64, height);
    let mut cut = 0;
    for k in (0..8).filter(|k| candidates >> k & 1 != 0) {
        let corner = axes(|axis| (at[axis] + if k >> axis & 1 != 0 { half } else { 0 }) as f64);
        cut |= (overlap.cuts(corner, half as f64) as u8) << k;
    }
    cut
}
