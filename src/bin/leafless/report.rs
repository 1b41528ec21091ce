//! What is told of a solid, for programs (JSON) and for people.

use crate::output::{count, interval, number};
use leafless::{Interval, MeshReport, Octree, Statistics, Tag};
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
    pub nodes: u64,
    pub classical_nodes: u64,
    cells: Cells,
    pub volume: Volume,
    pub bytes: u64,
    /// Absent (null) where there is no node.
    pub bytes_per_node: Option<f64>,
    levels: Vec<Level>,
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
                    lower: level.volume.lower,
                    upper: level.volume.upper,
                })
                .collect(),
            metadata: octree
                .metadata()
                .iter()
                .map(|(key, value)| (key.to_owned(), value.to_owned()))
                .collect(),
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
        line("volume", self.volume_text());
        line("nodes", count(self.nodes));
        line("classical nodes", count(self.classical_nodes));
        let Cells { empty, full, partial, .. } = &self.cells;
        line("cells", format!("{} empty, {} full, {} partial", count(*empty), count(*full), count(*partial)));
        let each = self.bytes_per_node.map_or("-".to_owned(), |bytes| format!("{bytes:.2}"));
        line("bytes", format!("{}, {each} a node", count(self.bytes)));
        for (key, value) in &self.metadata {
            // A file may hold any text; a terminal should not obey it.
            line(&key.escape_debug().to_string(), value.escape_debug().to_string());
        }
        let rows = (self.levels.iter())
            .map(|level| {
                [level.level.to_string(), count(level.nodes), number(level.lower), number(level.upper)]
            })
            .collect::<Vec<_>>();
        let head = ["level", "nodes", "volume from", "to"].map(str::to_owned);
        text.push('\n');
        text.push_str(&table(&head, &rows));
        text
    }

    /// The volume in words.
    pub fn volume_text(&self) -> String {
        let Volume { lower, upper } = self.volume;
        if lower == upper { number(lower) } else { interval(Interval { lower, upper }) }
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
    misoriented_edges: u64,
    non_manifold_edges: u64,
    bodies: u64,
    sewn: u64,
    displacement: f64,
}

impl From<MeshReport> for Mesh {
    fn from(report: MeshReport) -> Mesh {
        Mesh {
            facets_read: report.facets_read,
            triangles: report.triangles,
            vertices: report.vertices,
            welded: report.welded,
            degenerate: report.degenerate,
            boundary_edges: report.boundary_edges,
            misoriented_edges: report.misoriented_edges,
            non_manifold_edges: report.non_manifold_edges,
            bodies: report.bodies,
            sewn: report.sewn,
            displacement: report.displacement,
        }
    }
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
