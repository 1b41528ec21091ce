//! What is told of a solid, for programs (JSON) and for people.

use crate::report::channel::ChannelInfo;
use crate::words::{count, ends, measured, number};
use leafless::{
    DefectKind, Error, IntersectingPair, Interval, MeshDefect, MeshReport, Octree, Proof, Statistics,
    StopReason, Tag, TriangleMesh,
};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A certified volume in cubic model units.
#[derive(Serialize)]
pub struct Volume {
    lower: f64,
    upper: f64,
}

impl Volume {
    /// The interval.
    pub fn interval(&self) -> Interval {
        Interval::new(self.lower, self.upper).unwrap_or(Interval::ALL)
    }

    /// How much is undecided.
    pub fn width(&self) -> f64 {
        self.upper - self.lower
    }
}

impl From<Interval> for Volume {
    fn from(interval: Interval) -> Volume {
        Volume { lower: interval.lower, upper: interval.upper }
    }
}

/// Why a search ended, in a word.
pub fn stop_word(reason: StopReason) -> &'static str {
    match reason {
        StopReason::Tolerance => "tolerance",
        StopReason::Budget => "budget",
        StopReason::Exhausted => "exhausted",
    }
}

/// What cells prove of the solid that they were made from.
#[derive(Serialize)]
pub struct Proven {
    full: bool,
    empty: bool,
    displacement: f64,
}

impl From<Proof> for Proven {
    fn from(proof: Proof) -> Proven {
        Proven { full: proof.full, empty: proof.empty, displacement: proof.displacement() }
    }
}

impl Proven {
    /// What is not proven, if that is anything, and what can be done.
    pub fn doubt(&self) -> Option<String> {
        let certified = self.full && self.empty;
        (!certified).then(|| format!("{} (--cells takes the cells for the solid)", self.text()))
    }

    /// The same for people.
    pub fn text(&self) -> String {
        let proven = match (self.full, self.empty) {
            (true, true) => "inside and outside",
            (true, false) => "inside only; what is called outside need not be",
            (false, true) => "outside only; what is called inside need not be",
            (false, false) => "nothing: cells are called inside or outside as they were sampled",
        };
        match self.displacement {
            0.0 => proven.into(),
            moved => format!("{proven}; of surfaces that were moved by {} or less", number(moved)),
        }
    }
}

/// Cells of the canonical octree over all levels; together they are its classical nodes.
#[derive(Serialize)]
struct Cells {
    empty: u64,
    branch: u64,
    partial: u64,
    full: u64,
}

/// What one level holds, and the volume with the tree cut there.
#[derive(Serialize)]
struct Level {
    level: u8,
    nodes: u64,
    /// Cells above the level that were split on the way, where that was counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    splits: Option<u64>,
    lower: f64,
    upper: f64,
}

/// Everything that `info` tells.
#[derive(Serialize)]
pub struct Info {
    depth: u8,
    origin: [f64; 3],
    edge: f64,
    binary: bool,
    clipped: bool,
    proof: Proven,
    pub nodes: u64,
    pub classical_nodes: u64,
    cells: Cells,
    pub volume: Volume,
    pub bytes: u64,
    /// Absent (null) where there is no node.
    pub bytes_per_node: Option<f64>,
    levels: Vec<Level>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    channels: Vec<ChannelInfo>,
    metadata: BTreeMap<String, String>,
}

impl Info {
    /// Of a tree whose file has so many bytes. O(depth) for a tree from a file.
    pub fn new(octree: &Octree, bytes: u64) -> Info {
        let (view, frame, statistics) = (octree.view(), octree.frame(), octree.statistics());
        let nodes = statistics.nodes();
        Info {
            depth: frame.depth(),
            origin: frame.origin(),
            edge: frame.edge(),
            binary: view.is_binary(),
            clipped: view.is_clipped(),
            proof: octree.proof().into(),
            nodes,
            // The level table of a damaged file may hold anything.
            classical_nodes: nodes.saturating_mul(8).saturating_add(1),
            cells: Cells::new(&statistics),
            volume: statistics.volume().into(),
            bytes,
            bytes_per_node: (nodes > 0).then(|| bytes as f64 / nodes as f64),
            levels: (statistics.levels().iter())
                .map(|level| Level {
                    level: level.level,
                    nodes: level.nodes,
                    splits: None,
                    lower: level.volume.lower,
                    upper: level.volume.upper,
                })
                .collect(),
            channels: octree.channels().iter().map(ChannelInfo::new).collect(),
            metadata: octree
                .metadata()
                .iter()
                .map(|(key, value)| (key.to_owned(), value.to_owned()))
                .collect(),
        }
    }

    /// Notes how many cells of each level were split while the tree was built; the canonical tree forgets
    /// those splits whose eight children agree.
    pub fn note_splits(&mut self, splits: &[u64]) {
        for level in &mut self.levels {
            level.splits = Some(splits.iter().take(level.level.into()).sum());
        }
    }

    /// The same for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let mut line = |name: &str, value: String| {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{name:<16}{value}");
        };
        let clipped = if self.clipped { " (the solid may go on outside of it)" } else { "" };
        line("depth", format!("{}, {} cells per axis", self.depth, count(1 << self.depth)));
        line("origin", self.origin.map(number).join(" "));
        line("edge", format!("{}{clipped}", number(self.edge)));
        line(
            "kind",
            (if self.binary { "binary: every cell is decided" } else { "bounds: some cells are undecided" })
                .into(),
        );
        line("proven", self.proof.text());
        line("volume", self.volume_text());
        line("nodes", count(self.nodes));
        line("classical nodes", count(self.classical_nodes));
        let Cells { empty, full, partial, .. } = &self.cells;
        line("cells", format!("{} empty, {} full, {} partial", count(*empty), count(*full), count(*partial)));
        let each = self.bytes_per_node.map_or("-".to_owned(), |bytes| format!("{bytes:.2}"));
        line("bytes", format!("{}, {each} a node", count(self.bytes)));
        for channel in &self.channels {
            line("channel", channel.text());
        }
        for (key, value) in &self.metadata {
            // A file may hold any text; a terminal should not obey it.
            line(&key.escape_debug().to_string(), value.escape_debug().to_string());
        }
        let rows = (self.levels.iter())
            .map(|level| {
                let [from, to] = ends(Interval::new(level.lower, level.upper).unwrap());
                [level.level.to_string(), count(level.nodes), from, to]
            })
            .collect::<Vec<_>>();
        let head = ["level", "nodes", "volume from", "to"].map(str::to_owned);
        text.push('\n');
        text.push_str(&table(&head, &rows));
        text
    }

    /// What the volume is the volume of.
    pub fn volume_note(&self) -> &'static str {
        match (self.proof.full && self.proof.empty, self.clipped) {
            (false, _) => " (of the cells)",
            (true, false) if self.volume.width() == 0.0 => " (exactly)",
            (true, false) => " (the true one lies between)",
            (true, true) => " (that of the part inside of the bounds lies between)",
        }
    }

    /// The volume in words.
    pub fn volume_text(&self) -> String {
        measured(self.volume.interval())
    }
}

impl Cells {
    fn new(statistics: &Statistics) -> Cells {
        Cells {
            empty: statistics.cells(Tag::Empty),
            branch: statistics.cells(Tag::Branch),
            partial: statistics.cells(Tag::Partial),
            full: statistics.cells(Tag::Full),
        }
    }
}

/// What was found while a mesh was taken in.
#[derive(Serialize)]
pub struct Mesh {
    facets_read: u64,
    triangles: u64,
    vertices: u64,
    welded: u64,
    degenerate: u64,
    boundary_edges: u64,
    boundary_loops: u64,
    misoriented_edges: u64,
    non_manifold_edges: u64,
    duplicate: u64,
    opposite: u64,
    flat: u64,
    bodies: u64,
    open_bodies: u64,
    inside_out_bodies: u64,
    sewn: u64,
    displacement: f64,
    overlapping_bodies: u64,
    undecided_bodies: u64,
    polygons: u64,
    bent_polygons: u64,
    polygon_deviation: f64,
    pub defects: Vec<Defect>,
}

/// One of the worst places.
#[derive(Serialize)]
pub struct Defect {
    kind: &'static str,
    count: u64,
    length: f64,
    min: [f64; 3],
    max: [f64; 3],
}

/// Defects that are told of.
const DEFECTS: usize = 10;

impl Mesh {
    pub fn new(mesh: &TriangleMesh) -> Result<Mesh, Error> {
        let report = mesh.report()?;
        let MeshReport { boundary_edges, misoriented_edges, non_manifold_edges, .. } = report;
        let faults = [boundary_edges, misoriented_edges, non_manifold_edges, report.duplicate, report.flat];
        // Looking for them takes time.
        let is_faultless = faults == [0; 5] && report.opposite == 0;
        let defects = if is_faultless { Vec::new() } else { mesh.defects(DEFECTS)? };
        Ok(Mesh {
            facets_read: report.facets_read,
            triangles: report.triangles,
            vertices: report.vertices,
            welded: report.welded,
            degenerate: report.degenerate,
            boundary_edges,
            boundary_loops: report.boundary_loops,
            misoriented_edges,
            non_manifold_edges,
            duplicate: report.duplicate,
            opposite: report.opposite,
            flat: report.flat,
            bodies: report.bodies,
            open_bodies: report.open_bodies,
            inside_out_bodies: report.inside_out_bodies,
            sewn: report.sewn,
            displacement: report.displacement,
            overlapping_bodies: report.overlapping_bodies,
            undecided_bodies: report.undecided_bodies,
            polygons: report.polygons,
            bent_polygons: report.bent_polygons,
            polygon_deviation: report.polygon_deviation,
            defects: defects.iter().map(Defect::new).collect(),
        })
    }
}

impl Defect {
    fn new(defect: &MeshDefect) -> Defect {
        let kind = match defect.kind {
            DefectKind::Hole => "hole",
            DefectKind::Misoriented => "misoriented",
            DefectKind::NonManifold => "non-manifold",
            DefectKind::Duplicate => "duplicate",
            DefectKind::Flat => "flat",
        };
        let (min, max) = defect.bounds;
        Defect { kind, count: defect.count, length: defect.length, min, max }
    }

    /// Two triangles that intersect.
    pub fn intersecting(pair: &IntersectingPair) -> Defect {
        let (min, max) = pair.bounds;
        Defect { kind: "intersecting", count: 2, length: 0.0, min, max }
    }

    /// The same for people, in columns.
    pub fn table(defects: &[Defect]) -> String {
        let rows: Vec<_> = (defects.iter())
            .map(|defect| {
                let [from, to] = [defect.min, defect.max].map(|corner| corner.map(short).join(" "));
                [defect.kind.to_owned(), count(defect.count), short(defect.length), from, to]
            })
            .collect();
        table(&["defect", "count", "length", "from", "to"].map(str::to_owned), &rows)
    }
}

/// A number for a table: six digits tell where to look.
pub fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    number(rounded)
}

/// Lines whose columns are aligned to the right.
fn table<const N: usize>(head: &[String; N], rows: &[[String; N]]) -> String {
    let width =
        |column: usize| (rows.iter().chain([head])).map(|row| row[column].chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for row in [head].into_iter().chain(rows) {
        for (column, cell) in row.iter().enumerate() {
            let gap = if column == 0 { "" } else { "  " };
            let _ = write!(text, "{gap}{cell:>width$}", width = width(column));
        }
        text.push('\n');
    }
    text
}
