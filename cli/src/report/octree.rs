//! Reports of octrees, for programs (JSON) and for people.

use crate::report::bounds::{Proven, Volume};
use crate::report::channel::ChannelInfo;
use crate::report::cuts::Cuts;
use crate::words::{count, number, put_line, table};
use leafless::octree::Statistics;
use leafless::{Interval, Octree, Tag};
use serde::Serialize;
use std::collections::BTreeMap;

/// Cells of the canonical octree over all levels. Together they are its classical nodes.
#[derive(Serialize)]
struct Cells {
    empty: u64,
    branch: u64,
    partial: u64,
    full: u64,
}

/// The contents of one level, and the volume of the tree cut at it.
#[derive(Serialize)]
struct Level {
    level: u8,
    nodes: u64,
    /// Cells above the level that were split while the tree was built, if they were counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    splits: Option<u64>,
    lower: f64,
    upper: f64,
}

/// The complete report of `info`.
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
    /// Bounds of the volume: by the surfaces that cells keep, if they keep any.
    pub volume: Volume,
    /// Bounds of the volume by the cells alone; absent where cells keep no surfaces.
    #[serde(skip_serializing_if = "Option::is_none")]
    volume_of_cells: Option<Volume>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cuts: Option<Cuts>,
    pub bytes: u64,
    /// Null for a tree without nodes.
    pub bytes_per_node: Option<f64>,
    levels: Vec<Level>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    channels: Vec<ChannelInfo>,
    metadata: BTreeMap<String, String>,
}

impl Info {
    /// Describes a tree whose file has `bytes` bytes. O(depth) for a tree from a file. For a tree whose cells
    /// keep surfaces O(n), and the time of its volume.
    pub fn new(octree: &Octree, bytes: u64) -> Info {
        let (view, frame, statistics) = (octree.view(), octree.frame(), octree.statistics());
        let nodes = statistics.nodes();
        let cuts = Cuts::new(octree);
        let of_cells = statistics.volume();
        let sharp = cuts.as_ref().and_then(|_| Cuts::volume(octree));
        Info {
            depth: frame.depth(),
            origin: frame.origin(),
            edge: frame.edge(),
            binary: view.is_binary(),
            clipped: view.is_clipped(),
            proof: octree.proof().into(),
            nodes,
            // The level table of a damaged file may contain anything.
            classical_nodes: nodes.saturating_mul(8).saturating_add(1),
            cells: Cells::new(&statistics),
            volume: sharp.unwrap_or(of_cells).into(),
            volume_of_cells: cuts.is_some().then(|| of_cells.into()),
            cuts,
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

    /// Adds the numbers of cells of each level that were split while the tree was built. The canonical tree
    /// does not contain splits whose eight children agree.
    pub fn note_splits(&mut self, splits: &[u64]) {
        for level in &mut self.levels {
            level.splits = Some(splits.iter().take(level.level.into()).sum());
        }
    }

    /// Returns the report for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let mut line = |name: &str, value: String| put_line(&mut text, name, &value);
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
        if let Some(of_cells) = &self.volume_of_cells {
            line("volume of cells", of_cells.interval().to_string());
        }
        if let Some(cuts) = &self.cuts {
            line("surfaces", cuts.text());
        }
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
            // A file may contain any text; a terminal should not obey it.
            line(&key.escape_debug().to_string(), value.escape_debug().to_string());
        }
        let rows = (self.levels.iter())
            .map(|level| {
                let [from, to] = Interval::new(level.lower, level.upper).unwrap().bounds_text();
                [level.level.to_string(), count(level.nodes), from, to]
            })
            .collect::<Vec<_>>();
        let head = ["level", "nodes", "volume from", "to"].map(str::to_owned);
        text.push('\n');
        text.push_str(&table(&head, &rows));
        text
    }

    /// Returns the report on the surfaces that cells keep, if there are any.
    pub fn cuts_text(&self) -> Option<String> {
        self.cuts.as_ref().map(Cuts::text)
    }

    /// Returns the same report as a line, or nothing.
    pub fn keeps(&self) -> String {
        self.cuts_text().map_or(String::new(), |cuts| format!("keeps   {cuts}\n"))
    }

    /// Returns the same report in a few words.
    pub fn kept_text(&self) -> Option<String> {
        self.cuts.as_ref().map(Cuts::short_text)
    }

    /// Returns a note on which solid the volume belongs to.
    pub fn volume_note(&self) -> &'static str {
        match (self.proof.is_certified(), self.clipped) {
            (false, _) => " (of the cells)",
            (true, false) if self.volume.width() == 0.0 => " (exactly)",
            (true, false) => " (the true one lies between)",
            (true, true) => " (that of the part inside of the bounds lies between)",
        }
    }

    /// Returns the volume in words.
    pub fn volume_text(&self) -> String {
        self.volume.interval().to_string()
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
