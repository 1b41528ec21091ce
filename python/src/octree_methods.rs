//! The methods of octrees: set operations, lists of cells, channels and files.

use crate::arguments::{Argument, Deep, Depth, Level, named, other_type};
use crate::arrays;
use crate::channel::Channel;
use crate::error::{OrRaise, called, refused};
use crate::frame::{CORNERS, Frame, corners, level_of};
use crate::from_package;
use crate::interval::Interval;
use crate::octree::{DEPTH, Octree, Proof, told};
use crate::shards::Shard;
use crate::voxels::VoxelRecords;
use crate::words;
use crate::work::{Limits, advance, afford};
use leafless::octree::{CellFilter, Statistics};
use leafless::{Control, Error, Metadata, Octree as Inner, OctreeRef, Rule, Tag, complement, op};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};

/// The number of cells that are listed between two checks of signals and limits.
const CHUNK: usize = 1 << 16;

/// The bytes of a cell in the arrays of a list.
const CELL: u64 = 1 + 1 + 3 * 4;

/// The bytes of an open cell: the library's cell and its code.
const OPEN_CELL: u64 = (size_of::<leafless::Cell>() + size_of::<u64>()) as u64;

impl Octree {
    /// Combines any number of octrees.
    fn combined<'py>(
        octrees: &Bound<'py, PyTuple>,
        limits: Option<&Bound<'py, PyDict>>,
        combine: impl FnOnce(&[OctreeRef<'_>], &Control<'_>) -> Result<Inner, Error> + Send,
    ) -> PyResult<Bound<'py, Octree>> {
        let (py, limits) = (octrees.py(), Limits::of(limits)?);
        let all: Vec<Bound<'_, Octree>> =
            octrees.iter().map(|one| Argument::take(&one, "octrees")).collect::<PyResult<_>>()?;
        let views: Vec<_> = all.iter().map(|one| *one.get().octree.view()).collect();
        let found =
            limits.run(py, |control| combine(&views, control).map_err(called([("trees", "octrees")])))?;
        Octree::bound(py, found)
    }

    /// Returns the statistics, which are counted once.
    fn statistics_of_cells(&self, py: Python<'_>) -> Statistics {
        py.detach(|| self.octree.statistics())
    }
}

#[pymethods]
impl Octree {
    /// Reads an octree from the bytes of a file, `data`.
    #[staticmethod]
    fn from_bytes(py: Python<'_>, #[pyo3(from_py_with = named::data)] data: &[u8]) -> PyResult<Py<Octree>> {
        let octree = py.detach(|| leafless::file::from_bytes(data)).or_raise(py)?;
        Ok(Octree::bound(py, octree)?.unbind())
    }

    /// Returns the bytes of the octree's file. They are the same wherever and however it was built.
    pub fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = Limits::default().run_here(py, |_| leafless::file::to_bytes(&self.octree))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Returns the union of any number of `octrees` on one frame, as `|` does for two. If an octree keeps its
    /// surfaces, one walk serves all operands, where repeated `|` needs a walk for each.
    #[staticmethod]
    #[pyo3(signature = (*octrees, **limits))]
    fn union_of<'py>(
        octrees: &Bound<'py, PyTuple>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, Octree>> {
        Octree::combined(octrees, limits, op::union_of)
    }

    /// Returns the intersection of any number of `octrees` on one frame, as `&` does for two.
    #[staticmethod]
    #[pyo3(signature = (*octrees, **limits))]
    fn intersection_of<'py>(
        octrees: &Bound<'py, PyTuple>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, Octree>> {
        Octree::combined(octrees, limits, op::intersection_of)
    }

    /// Returns the first of the `octrees` without the others, as `-` does for two.
    #[staticmethod]
    #[pyo3(signature = (*octrees, **limits))]
    fn difference_of<'py>(
        octrees: &Bound<'py, PyTuple>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, Octree>> {
        Octree::combined(octrees, limits, op::difference_of)
    }

    /// Returns the symmetric difference: the points that lie in an odd number of the `octrees`, as `^` does
    /// for two.
    #[staticmethod]
    #[pyo3(signature = (*octrees, **limits))]
    fn xor_of<'py>(
        octrees: &Bound<'py, PyTuple>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, Octree>> {
        Octree::combined(octrees, limits, op::xor_of)
    }

    /// Returns the complement of an `octree`, as `~octree`.
    #[staticmethod]
    #[pyo3(signature = (octree, **limits))]
    fn complement_of<'py>(
        #[pyo3(from_py_with = named::octree)] octree: Bound<'py, Octree>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, Octree>> {
        let (py, view) = (octree.py(), octree.get().octree.view());
        let found = Limits::of(limits)?.run(py, |control| complement(view, control))?;
        Octree::bound(py, found)
    }

    /// The frame of the octree.
    #[getter]
    fn frame(&self) -> Frame {
        Frame(*self.octree.frame())
    }

    /// The proof that the cells give about the source solid.
    #[getter]
    fn proof(&self) -> Proof {
        self.octree.proof().into()
    }

    /// The interval of the volume of the cells (cubic model units). For an octree that keeps its surfaces,
    /// `measure` returns a narrower interval.
    #[getter]
    fn volume(&self, py: Python<'_>) -> Interval {
        Interval(self.statistics_of_cells(py).volume())
    }

    /// The number of stored nodes.
    #[getter]
    fn node_count(&self, py: Python<'_>) -> u64 {
        self.statistics_of_cells(py).nodes()
    }

    /// The size of the arrays (bytes), in memory or in a mapped file.
    #[getter]
    fn nbytes(&self) -> u64 {
        self.octree.bytes()
    }

    /// True if cells keep the surfaces that cross them.
    #[getter]
    fn keeps_surfaces(&self) -> bool {
        self.octree.view().cuts().is_some()
    }

    /// Returns the same octree with its cells as the truth. A proof is then a proof about the cells. It holds
    /// for the source solid only as far as the cells are right.
    fn as_truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, Octree>> {
        Octree::bound(py, self.octree.with_proof(leafless::Proof::CERTIFIED))
    }

    /// Returns a list of dictionaries, one for each level: `level`, `nodes`, `empty`, `full`, `partial`
    /// (cells that end there), and `volume`, the interval that follows from the cells down to that level.
    fn statistics<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        told(py, &self.statistics_of_cells(py))
    }

    /// Returns the part of the octree with the cells of a `shard` (a `leafless.shards.Shard`). All other
    /// cells are PARTIAL.
    #[pyo3(signature = (shard, **limits))]
    fn shard<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::shard)] shard: Bound<'py, Shard>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, Octree>> {
        let (view, shard) = (self.octree.view(), shard.get().0);
        let found = Limits::of(limits)?.run(py, |control| op::shard(view, shard, control))?;
        Octree::bound(py, found)
    }

    /// Returns the codes (Morton order) of the cells of a `level` that are open: nothing is known of them.
    /// The array has the type uint64. In the top of that level, these are the cells that need a shard.
    /// `max_bytes` limits the array and the memory for making it.
    #[pyo3(signature = (level, **limits))]
    fn open_cells<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::level)] level: Level,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (limits, view) = (Limits::of(limits)?, self.octree.view());
        let level = level_of(py, self.octree.frame(), level)?;
        let codes = limits.run(py, |control| {
            let cells = view.open_cells(level)?;
            afford(control, "the list of open cells", cells.len() as u64 * OPEN_CELL)?;
            let mut codes = Vec::new();
            codes.try_reserve_exact(cells.len()).map_err(|_| Error::OutOfMemory)?;
            codes.extend(cells.iter().map(|cell| cell.morton()));
            Ok(codes)
        })?;
        let count = codes.len();
        Ok(arrays::array(py, codes, &[count])?.into_any())
    }

    /// The metadata of the octree's file, such as `name` and `units`.
    #[getter]
    fn metadata<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let told = PyDict::new(py);
        for (key, value) in self.octree.metadata().iter() {
            told.set_item(key, value)?;
        }
        Ok(told)
    }

    /// Returns the same octree with other `metadata`: a dictionary of texts.
    fn with_metadata<'py>(&self, metadata: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Octree>> {
        let py = metadata.py();
        let facts =
            metadata.cast::<PyDict>().map_err(|_| other_type(metadata, "metadata", "a dict of texts"))?;
        let mut told = Metadata::new();
        for (key, value) in facts.iter() {
            let (key, value) = (<&str>::take(&key, "metadata")?, <&str>::take(&value, "metadata")?);
            told.insert(key.to_owned(), value.to_owned());
        }
        Octree::bound(py, self.octree.with_metadata(told))
    }

    /// Lists cells as arrays: `level` of shape (n,), `at` (indices along x, y and z in cells of that level)
    /// of shape (n, 3), and `tag` (`Tag`) of shape (n,). `tags` selects among "empty", "partial", "full" and
    /// "branch" (split cells), or the constants EMPTY, PARTIAL and FULL. Without `tags`, all cells that are
    /// not split are listed. `max_bytes` limits the arrays.
    ///
    /// >>> cells = build(Csg.cuboid([0, 0, 0], [1, 1, 1]), Frame([0, 0, 0], 2, 1)).cells("full")
    /// >>> cells.level, cells.at
    /// (array([1], dtype=uint8), array([[0, 0, 0]], dtype=uint32))
    #[pyo3(signature = (*tags, **limits))]
    fn cells<'py>(
        &self,
        tags: &Bound<'py, PyTuple>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = tags.py();
        let limits = Limits::of(limits)?;
        let tags = match tags.is_empty() {
            true => vec![Tag::Empty, Tag::Partial, Tag::Full],
            false => tags.iter().map(|tag| words::tag(&tag, "tags")).collect::<PyResult<_>>()?,
        };
        let (level, tag, at) = limits.run(py, |control| {
            let filter = CellFilter::tags(&tags);
            let statistics = self.octree.statistics();
            let chosen = [Tag::Empty, Tag::Branch, Tag::Partial, Tag::Full]
                .into_iter()
                .filter(|tag| tags.contains(tag));
            let count = chosen.fold(0, |sum: u64, tag| sum.saturating_add(statistics.cells(tag)));
            afford(control, "the list of cells", count.saturating_mul(CELL))?;
            let (mut levels, mut tags, mut places) = (Vec::new(), Vec::new(), Vec::new());
            // The arrays of a damaged file may hold more cells than the file states, so the stated number is
            // no bound.
            for (i, found) in self.octree.view().cells(filter).enumerate() {
                if i % CHUNK == 0 {
                    advance(control, i, count as usize)?;
                    levels.try_reserve(CHUNK).map_err(|_| Error::OutOfMemory)?;
                    tags.try_reserve(CHUNK).map_err(|_| Error::OutOfMemory)?;
                    places.try_reserve(CHUNK).map_err(|_| Error::OutOfMemory)?;
                }
                levels.push(found.cell.level);
                tags.push(found.tag as u8);
                places.push(found.cell.at);
            }
            Ok((levels, tags, places))
        })?;
        let count = level.len();
        from_package!(py, "leafless._answers", "Cells")?.call1((
            arrays::array(py, level, &[count])?,
            arrays::array(py, at.into_flattened(), &[count, 3])?,
            arrays::array(py, tag, &[count])?,
        ))
    }

    /// Returns the tag of the finest cell with the indices `at` along x, y and z.
    fn tag_at<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::at)] at: [u32; 3],
    ) -> PyResult<Bound<'py, PyAny>> {
        if at.iter().any(|&index| index >= self.octree.frame().cells()) {
            return Err(refused(py, "at", "must be a cell of the frame"));
        }
        from_package!(py, "leafless._answers", "Tag")?.call1((self.octree.view().tag_at(at) as u8,))
    }

    /// Returns the cells of a `level` as an array of booleans, indexed [x, y, z]: true where cells are FULL,
    /// or with `outer=True` where they are not EMPTY. The default is the finest level. `first` and `end`
    /// select a box: its first cell, and the first cell beyond it, as indices along x, y and z. `max_bytes`
    /// limits the array and the memory for making it.
    #[pyo3(signature = (level=None, *, first=None, end=None, outer=false, **limits))]
    fn bitmap<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::level)] level: Option<Level>,
        #[pyo3(from_py_with = named::first)] first: Option<[u32; 3]>,
        #[pyo3(from_py_with = named::end)] end: Option<[u32; 3]>,
        #[pyo3(from_py_with = named::outer)] outer: bool,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let limits = Limits::of(limits)?;
        let deepest = self.octree.frame().depth();
        let level = level.map_or(deepest, |Deep(level)| level);
        let side = 1 << level;
        let (first, end) = (first.unwrap_or_default(), end.unwrap_or([side; 3]));
        if level <= deepest && (0..3).any(|axis| first[axis] > end[axis] || end[axis] > side) {
            let problem = format!("must not be before first, nor beyond the {side} cells of an axis");
            return Err(refused(py, "end", problem));
        }
        let view = self.octree.view();
        let words = view.bitmap_words(level, first, end).or_raise(py)?;
        let size = [0, 1, 2].map(|axis| (end[axis] - first[axis]) as usize);
        let bits = limits.run(py, |control| {
            let count: usize = size.iter().product();
            let bitmaps = if outer { 2 } else { 1 };
            afford(control, "the bitmap", count as u64 + words * 8 * bitmaps)?;
            let words = words as usize;
            let zeros = || {
                let mut all = Vec::new();
                all.try_reserve_exact(words).map_err(|_| Error::OutOfMemory)?;
                all.resize(words, 0u64);
                Ok::<_, Error>(all)
            };
            let mut inner = zeros()?;
            let mut upper = if outer { Some(zeros()?) } else { None };
            view.bitmap(level, first, end, &mut inner, upper.as_deref_mut(), control)?;
            let words = upper.unwrap_or(inner);
            let mut bits: Vec<bool> = Vec::new();
            bits.try_reserve_exact(count).map_err(|_| Error::OutOfMemory)?;
            let row = size[0].div_ceil(64);
            for row in words.chunks_exact(row.max(1)) {
                bits.extend((0..size[0]).map(|x| row[x / 64] >> (x % 64) & 1 != 0));
            }
            Ok(bits)
        })?;
        let flat = arrays::array(py, bits, &[size.iter().product()])?;
        let order = PyDict::new(py);
        order.set_item("order", "F")?;
        flat.call_method("reshape", (size.to_vec(),), Some(&order))
    }

    /// Classifies a box, whose `bounds` are its lower and its upper corner, as "inside", "outside",
    /// "crossing" or "undecided".
    fn classify_box<'py>(&self, bounds: &Bound<'py, PyAny>) -> PyResult<&'static str> {
        use leafless::query::Region;
        let py = bounds.py();
        let [min, max] = corners(bounds, "bounds")?;
        let found = py.detach(|| self.octree.classify_box(min, max).map_err(called(CORNERS)));
        Ok(match found.or_raise(py)? {
            Region::Outside => "outside",
            Region::Inside => "inside",
            Region::Crossing => "crossing",
            Region::Undecided => "undecided",
        })
    }

    /// The names of the channels.
    #[getter]
    fn channels(&self) -> Vec<String> {
        self.octree.channels().iter().map(|channel| channel.name().to_owned()).collect()
    }

    /// Returns the channel called `name`.
    fn channel(&self, py: Python<'_>, #[pyo3(from_py_with = named::name)] name: &str) -> PyResult<Channel> {
        match self.octree.channel(name) {
            Some(channel) => Ok(Channel(channel.clone())),
            None => Err(refused(py, "name", format!("no channel is called '{name}'"))),
        }
    }

    /// Returns the same octree with a `channel` added, or in place of the channel with that `name`.
    fn with_channel<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::name)] name: &str,
        #[pyo3(from_py_with = named::channel)] channel: Bound<'py, Channel>,
    ) -> PyResult<Bound<'py, Octree>> {
        Octree::bound(py, self.octree.with_channel(channel.get().0.with_name(name)).or_raise(py)?)
    }

    /// Returns an octree without surfaces, to a `depth`. The surfaces of this octree decide its cells. `rule`
    /// decides the cells that are still undecided there, as in `build`.
    #[pyo3(signature = (depth=None, *, rule="certified", **limits))]
    fn plain<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
        #[pyo3(from_py_with = named::rule)] rule: &str,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, Octree>> {
        let rule: Rule = words::value(py, rule)?;
        let own = if self.keeps_surfaces() { DEPTH } else { self.octree.frame().depth() };
        let depth = depth.map_or(own, |Deep(depth)| depth);
        let found = Limits::of(limits)?.run(py, |control| op::plain(&self.octree, depth, rule, control))?;
        Octree::bound(py, found)
    }

    /// Returns the voxels as records, sorted by code, with the values of a `channel` at their centres.
    /// Boundary voxels end at `boundary_depth`, the frame's depth by default. `outside=True` lists the voxels
    /// outside, too.
    #[pyo3(signature = (channel=None, *, boundary_depth=None, outside=false, **limits))]
    fn voxels(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = named::channel)] channel: Option<Bound<'_, Channel>>,
        #[pyo3(from_py_with = named::boundary_depth)] boundary_depth: Option<Depth>,
        #[pyo3(from_py_with = named::outside)] outside: bool,
        limits: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<VoxelRecords> {
        let limits = Limits::of(limits)?;
        let mut options = leafless::voxel::VoxelOptions::new().outside(outside);
        if let Some(Deep(depth)) = boundary_depth {
            options = options.boundary_depth(depth);
        }
        let attribute =
            channel.as_ref().map(|channel| &channel.get().0 as &dyn leafless::attribute::Attribute);
        let view = self.octree.view();
        let records = limits
            .run(py, |control| leafless::voxel::VoxelRecords::of(view, &options, attribute, control))?;
        Ok(VoxelRecords(records))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
        let py = other.py();
        match other.cast::<Octree>() {
            Ok(other) => {
                let other = &other.get().octree;
                py.detach(|| self.octree == *other).into_py_any(py)
            }
            Err(_) => Ok(py.NotImplemented()),
        }
    }

    fn __hash__(&self, py: Python<'_>) -> u64 {
        crate::frame::hash(self.octree.frame()) ^ self.statistics_of_cells(py).nodes()
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let (depth, known) = (self.octree.frame().depth(), self.statistics_of_cells(py));
        format!("<Octree: depth {depth}, {} nodes, volume {}>", known.nodes(), known.volume())
    }

    /// Pickles the bytes of the file; for a mapped octree the path and a checksum, which costs nothing.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let py = slf.py();
        match &slf.get().mapped {
            Some((path, checksum)) => {
                let again = from_package!(py, "leafless._pickle", "mapped")?;
                Ok((again, (path, *checksum).into_bound_py_any(py)?))
            }
            None => {
                let again = from_package!(py, "leafless._pickle", "octree")?;
                Ok((again, (slf.get().to_bytes(py)?,).into_bound_py_any(py)?))
            }
        }
    }
}
