//! Splits a file into header and sections, and assembles it again. This module is written from the
//! specification, deliberately without the library's code.

/// Length of the header.
pub const HEADER: usize = 128;
/// Length of an entry of the section table.
pub const ENTRY: usize = 48;
/// Length of the record of an object.
pub const RECORD: usize = 128;
/// The first eight bytes.
pub const MAGIC: [u8; 8] = *b"\x89LFL\r\n\x1a\n";

/// Kinds of sections.
pub const OBJECTS: u32 = 1;
pub const METADATA: u32 = 2;
pub const LEVELS: u32 = 3;
pub const PLANES: u32 = 4;
pub const REL: u32 = 5;
pub const BASE: u32 = 6;
pub const BRICKS: u32 = 7;
pub const INDICES: u32 = 8;
pub const ENTRIES: u32 = 9;
pub const SEGMENTS: u32 = 10;
pub const CUT_HEADS: u32 = 11;
pub const CUT_IDS: u32 = 12;
pub const CUT_BLOCKS: u32 = 13;
pub const CUT_FIRST: u32 = 14;
pub const SURFACES: u32 = 15;
pub const NUMBERS: u32 = 20;
pub const PLACEMENTS: u32 = 21;
pub const ORIGINS: u32 = 22;
pub const CELL_SLABS: u32 = 23;
pub const GROUPS: u32 = 24;
pub const MOMENTS: u32 = 25;
/// The kinds of cuts.
pub const CUTS: [u32; 11] = [
    CUT_HEADS, CUT_IDS, CUT_BLOCKS, CUT_FIRST, SURFACES, NUMBERS, PLACEMENTS, ORIGINS, CELL_SLABS, GROUPS,
    MOMENTS,
];

/// Fields of the header: offset and length.
pub const HEADER_FIELDS: [(usize, usize); 28] = [
    (0, 8),
    (8, 2),
    (10, 2),
    (12, 4),
    (16, 4),
    (20, 4),
    (24, 8),
    (32, 8),
    (40, 8),
    (48, 8),
    (56, 8),
    (64, 1),
    (65, 1),
    (66, 1),
    (67, 1),
    (68, 1),
    (69, 1),
    (70, 1),
    (71, 1),
    (72, 8),
    (80, 8),
    (88, 8),
    (96, 4),
    (100, 4),
    (104, 8),
    (112, 8),
    (120, 4),
    (124, 4),
];

/// Fields of an entry of the section table.
pub const ENTRY_FIELDS: [(usize, usize); 12] =
    [(0, 4), (4, 4), (8, 1), (9, 1), (10, 1), (11, 1), (12, 4), (16, 8), (24, 8), (32, 8), (40, 4), (44, 4)];

/// Fields of the record of an object.
pub const RECORD_FIELDS: [(usize, usize); 29] = [
    (0, 4),
    (4, 4),
    (8, 4),
    (12, 1),
    (13, 1),
    (14, 1),
    (15, 1),
    (16, 1),
    (17, 1),
    (18, 1),
    (19, 1),
    (20, 1),
    (21, 3),
    (24, 8),
    (32, 8),
    (40, 8),
    (48, 8),
    (56, 8),
    (64, 4),
    (68, 4),
    (72, 4),
    (76, 4),
    (80, 8),
    (88, 8),
    (96, 8),
    (104, 8),
    (112, 8),
    (120, 4),
    (124, 4),
];

/// The header's fields that the solid's record repeats: offset in the header, offset in the record, length.
const MIRRORED: [(usize, usize, usize); 8] = [
    (64, 12, 3),
    (70, 15, 1),
    (67, 16, 3),
    (104, 24, 8),
    (32, 32, 32),
    (72, 80, 8),
    (80, 88, 8),
    (88, 96, 8),
];

/// Returns the number in the `length` bytes from `at` on.
pub fn number(bytes: &[u8], at: usize, length: usize) -> u64 {
    let mut raw = [0; 8];
    raw[..length].copy_from_slice(&bytes[at..at + length]);
    u64::from_le_bytes(raw)
}

/// Writes the number `value` into the `length` bytes from `at` on.
pub fn put(bytes: &mut [u8], at: usize, value: u64, length: usize) {
    bytes[at..at + length].copy_from_slice(&value.to_le_bytes()[..length]);
}

/// A section: its entry in the table, unchanged, and its bytes.
#[derive(Clone)]
pub struct Section {
    pub entry: [u8; ENTRY],
    pub bytes: Vec<u8>,
}

impl Section {
    /// A section of the solid whose entry has no offset yet.
    pub fn new(kind: u32, bytes: Vec<u8>) -> Section {
        let mut entry = [0; ENTRY];
        put(&mut entry, 0, kind.into(), 4);
        put(&mut entry, 8, 0x101, 2);
        put(&mut entry, 12, ((OBJECTS..=SEGMENTS).contains(&kind) && kind != METADATA).into(), 4);
        Section { entry, bytes }
    }

    pub fn kind(&self) -> u32 {
        number(&self.entry, 0, 4) as u32
    }

    pub fn owner(&self) -> u32 {
        number(&self.entry, 4, 4) as u32
    }

    /// True for the solid's section of a kind.
    pub fn is(&self, kind: u32) -> bool {
        self.kind() == kind && self.owner() == 0
    }

    /// Returns the bytes of an element according to the entry; 1 for an unknown type or encoding.
    pub fn size(&self) -> usize {
        let element = [8, 1, 2, 4, 8, 4, 8].get(self.entry[8] as usize).filter(|_| self.entry[10] == 0);
        element.map_or(1, |size| size * self.entry[9] as usize).max(1)
    }

    /// Returns the index of the section with the same bytes.
    pub fn same(&self) -> Option<usize> {
        (number(&self.entry, 44, 4) as usize).checked_sub(1)
    }
}

/// A file in parts.
#[derive(Clone)]
pub struct File {
    pub header: [u8; HEADER],
    pub sections: Vec<Section>,
}

/// The repairs made when a file is assembled.
#[derive(Clone, Copy)]
pub struct Repairs {
    /// The tree itself: as many elements and bricks as the branches require, and the links to them.
    pub links: bool,
    /// The dictionary of bricks.
    pub dictionary: bool,
    /// The level table.
    pub levels: bool,
    /// Cuts: as many as there are PARTIAL cells and splits, the counts before them, and their surfaces.
    pub cuts: bool,
    /// The order of the table, and elements and counts, in the entries and in the header.
    pub counts: bool,
    /// The records of objects.
    pub objects: bool,
    /// Offsets and lengths, including the file's length.
    pub places: bool,
    /// Checksums of sections, of the table and of the header.
    pub checksums: [bool; 3],
}

impl Repairs {
    pub const ALL: Repairs = Repairs {
        links: true,
        dictionary: true,
        levels: true,
        cuts: true,
        counts: true,
        objects: true,
        places: true,
        checksums: [true; 3],
    };
    pub const NONE: Repairs = Repairs {
        links: false,
        dictionary: false,
        levels: false,
        cuts: false,
        counts: false,
        objects: false,
        places: false,
        checksums: [false; 3],
    };
    /// All offsets, counts, records and checksums, but no repairs of the tree.
    pub const FRAME: Repairs =
        Repairs { links: false, dictionary: false, levels: false, cuts: false, ..Repairs::ALL };
}

/// The most sections examined. Files may have more.
const MOST_SECTIONS: usize = 64;
/// The most elements and bricks of a repaired tree.
const MOST_ENTRIES: usize = 600;
/// The most cuts of a repaired tree.
const MOST_CUTS: usize = 2000;

/// Returns the number of bits of an id for this number of surfaces.
fn bits_of_an_id(surfaces: usize) -> usize {
    (1..).find(|&bits| 1 << bits >= surfaces).unwrap_or(1)
}

/// Unpacks the numbers of a stream of bits.
fn unpacked(bytes: &[u8], bits: usize) -> Vec<usize> {
    let bit = |i: usize| usize::from(bytes[i / 8] >> (i % 8) & 1);
    let one = |i: usize| (0..bits).map(|k| bit(i * bits + k) << k).sum();
    (0..8 * bytes.len() / bits).map(one).collect()
}

/// Packs numbers into a stream of bits.
fn packed(numbers: &[usize], bits: usize) -> Vec<u8> {
    let mut bytes = vec![0; (numbers.len() * bits).div_ceil(8)];
    for (i, number) in numbers.iter().enumerate() {
        for k in 0..bits {
            bytes[(i * bits + k) / 8] |= ((number >> k & 1) as u8) << ((i * bits + k) % 8);
        }
    }
    bytes
}

/// Surfaces numbered in the order of their first use.
struct Group {
    start: usize,
    /// The first unused surface.
    next: usize,
    end: usize,
    origin: [u64; 2],
}

/// The surfaces that cuts use: those of records first, then slabs of cells group by group.
struct Kept {
    groups: Vec<Group>,
    slabs: Vec<u8>,
}

impl Kept {
    fn new(records: usize, slabs: &[u8], groups: &[u8]) -> Kept {
        let all = records + slabs.len() / 16;
        let mut kept = Kept { groups: vec![], slabs: slabs.to_vec() };
        let mut add = |end: usize, origin| {
            let start = kept.groups.last().map_or(0, |group: &Group| group.end);
            kept.groups.push(Group { start, next: start, end: end.clamp(start, all), origin });
        };
        add(records, [0; 2]);
        for group in groups.chunks_exact(24) {
            let end = records.saturating_add(number(group, 16, 8) as usize);
            add(end, [number(group, 0, 8), number(group, 8, 8)]);
        }
        add(all, [7; 2]);
        // The other groups begin at existing surfaces, and no two groups have the same origin.
        let mut n = 0;
        kept.groups.retain(|group| {
            n += 1;
            n == 1 || group.start < group.end
        });
        for g in 1..kept.groups.len() {
            while kept.groups[1..g].iter().any(|before| before.origin == kept.groups[g].origin) {
                kept.groups[g].origin[1] = kept.groups[g].origin[1].wrapping_add(1);
            }
        }
        kept
    }

    fn all(&self) -> usize {
        self.groups.last().map_or(0, |group| group.end)
    }

    fn may_be(&self, id: usize) -> bool {
        let g = self.groups.iter().position(|group| id < group.end).expect("a group");
        let begun = g < 2 || self.groups[g - 1].next > self.groups[g - 1].start;
        id < self.groups[g].next || id == self.groups[g].next && begun
    }

    /// Returns an allowed surface that is not among `others`: `drawn` if it is one.
    fn one(&mut self, drawn: usize, others: &[usize]) -> usize {
        let is_good = |id: &usize| self.may_be(*id) && !others.contains(id);
        let all = self.all();
        let id =
            (0..all).map(|i| (drawn % all + all - i) % all).find(is_good).expect("a surface that is left");
        let group = self.groups.iter_mut().find(|group| id < group.end).expect("a group");
        group.next = group.next.max(id + 1);
        id
    }

    /// Returns the surfaces' new numbers without the unused surfaces, the repaired slabs of cells, and their
    /// groups.
    fn finish(&self, depth: usize) -> (Vec<usize>, Vec<u8>, Vec<u8>) {
        let (mut names, mut slabs, mut groups) = (vec![0; self.all()], vec![], vec![]);
        let records = self.groups[0].end;
        let mut next = 0;
        for (g, group) in self.groups.iter().enumerate() {
            for id in group.start..group.next {
                names[id] = next;
                next += 1;
                if g > 0 {
                    let at = 16 * (id - records);
                    slabs.extend(mended_slab(&self.slabs[at..at + 16], depth));
                }
            }
            if g > 0 && group.next > group.start {
                let end = slabs.len() as u64 / 16;
                groups.extend([group.origin[0], group.origin[1], end].map(u64::to_le_bytes).concat());
            }
        }
        (names, slabs, groups)
    }
}

/// Makes a slab of a cell legal.
fn mended_slab(slab: &[u8], depth: usize) -> Vec<u8> {
    let [home, planes] = [number(slab, 0, 8), number(slab, 8, 8)];
    let index = (home >> 61 & 3).min(2);
    let octants = home & ((1 << 61) - 1);
    let is_level = |level: &usize| octants >> (3 * level) == 1;
    // A cell of the first level is valid at any depth.
    let cell = (0..=depth).find(is_level).map_or(8 | octants & 7, |_| octants);
    let part = |shift: u32, bits: u32| planes >> shift & ((1 << bits) - 1);
    let component = |own: u64| if own == 0x8000 { 0 } else { own };
    let (a, b) = (component(part(0, 16)), component(part(16, 16)));
    let rest = part(32, 23) << 32 | part(55, 6).clamp(2, 50) << 55 | part(61, 2).min(2) << 61;
    [cell | index << 61, a | b << 16 | rest | planes & 1 << 63].map(u64::to_le_bytes).concat()
}

impl File {
    /// Returns the parts of `bytes`, if they have a signature and a header. Sections outside the file are
    /// empty.
    pub fn parse(bytes: &[u8]) -> Option<File> {
        let header: [u8; HEADER] = *bytes.first_chunk()?;
        if header[..8] != MAGIC {
            return None;
        }
        let count = number(&header, 96, 4) as usize;
        let table = bytes[HEADER..].chunks_exact(ENTRY).take(count.min(MOST_SECTIONS));
        let sections = table.map(|entry| {
            let (start, length) = (number(entry, 16, 8), number(entry, 24, 8));
            let range = start as usize..start.saturating_add(length) as usize;
            let mut section = Section { entry: [0; ENTRY], bytes: vec![] };
            section.entry.copy_from_slice(entry);
            section.bytes = bytes.get(range).unwrap_or(&[]).to_vec();
            section
        });
        Some(File { header, sections: sections.collect() })
    }

    /// Returns the solid's section of a kind, the first if there are several.
    pub fn section(&mut self, kind: u32) -> Option<&mut Section> {
        self.sections.iter_mut().find(|section| section.is(kind))
    }

    fn bytes(&self, kind: u32) -> &[u8] {
        self.sections.iter().find(|section| section.is(kind)).map_or(&[], |section| &section.bytes)
    }

    /// Sets the solid's section of a kind to `bytes`; removes it if they are empty.
    fn set(&mut self, kind: u32, bytes: Vec<u8>) {
        if bytes.is_empty() {
            let others = (0..self.sections.len()).filter(|&i| !self.sections[i].is(kind));
            self.rearrange(&others.collect::<Vec<_>>());
        } else if let Some(section) = self.section(kind) {
            section.bytes = bytes;
        } else {
            let at = self.sections.iter().position(|section| (section.owner(), section.kind()) > (0, kind));
            self.insert(at.unwrap_or(self.sections.len()), Section::new(kind, bytes));
        }
    }

    /// Keeps the sections that `order` names, in that order. Sections that shared the bytes of a removed
    /// section get their own copy.
    fn rearrange(&mut self, order: &[usize]) {
        let mut sections: Vec<Section> = order.iter().map(|&i| self.sections[i].clone()).collect();
        for section in &mut sections {
            if let Some(of) = section.same().filter(|&of| of < self.sections.len()) {
                let of = order.iter().position(|&i| i == of);
                put(&mut section.entry, 44, of.map_or(0, |of| of as u64 + 1), 4);
            }
        }
        self.sections = sections;
    }

    /// Inserts a section before the one at `at`.
    pub fn insert(&mut self, at: usize, section: Section) {
        let last = self.sections.len();
        self.sections.push(section);
        self.rearrange(&(0..at).chain([last]).chain(at..last).collect::<Vec<_>>());
    }

    /// Removes the section at `at`.
    pub fn remove(&mut self, at: usize) {
        let others = (0..self.sections.len()).filter(|&i| i != at);
        self.rearrange(&others.collect::<Vec<_>>());
    }

    /// Returns the section whose bytes the section at `at` shares, if that section comes before it and has
    /// its own bytes.
    fn shared(&self, at: usize) -> Option<usize> {
        self.sections[at].same().filter(|&of| of < at && self.sections[of].same().is_none())
    }

    fn words(&self, kind: u32) -> Vec<u64> {
        self.bytes(kind).chunks_exact(8).map(|word| number(word, 0, 8)).collect()
    }

    fn set_words(&mut self, kind: u32, words: &[u64]) {
        self.set(kind, words.iter().flat_map(|word| word.to_le_bytes()).collect());
    }

    /// Returns the bytes of a brick according to the header.
    pub fn brick_size(&self) -> usize {
        if self.header[67] == 2 { 16 } else { 8 }
    }

    /// True if bricks go through a dictionary according to the header.
    pub fn coded(&self) -> bool {
        self.header[68] == 1
    }

    fn depth(&self) -> Option<usize> {
        Some(self.header[64] as usize).filter(|depth| (1..=20).contains(depth))
    }

    /// Returns the bricks, whether or not they go through a dictionary.
    fn decoded(&self) -> Vec<Vec<u8>> {
        let size = self.brick_size();
        if !self.coded() {
            return self.bytes(BRICKS).chunks_exact(size).map(<[u8]>::to_vec).collect();
        }
        let entries: Vec<&[u8]> = self.bytes(ENTRIES).chunks_exact(size).collect();
        let indices = self.bytes(INDICES).chunks_exact(2).map(|index| number(index, 0, 2) as usize);
        indices.filter_map(|index| entries.get(index % entries.len().max(1))).map(|e| e.to_vec()).collect()
    }

    /// Stores bricks, raw or through one dictionary.
    fn encode(&mut self, bricks: &[Vec<u8>], coded: bool) {
        for kind in [BRICKS, INDICES, ENTRIES, SEGMENTS] {
            self.set(kind, vec![]);
        }
        let coded = coded && !bricks.is_empty();
        (self.header[68], self.header[69]) = if coded { (1, 63) } else { (0, 0) };
        put(&mut self.header, 88, 0, 8);
        if !coded {
            return self.set(BRICKS, bricks.concat());
        }
        let value = |brick: &[u8]| -> Vec<u64> { brick.chunks(8).map(|word| number(word, 0, 8)).collect() };
        let mut entries: Vec<(usize, Vec<u64>, &Vec<u8>)> = vec![];
        for brick in bricks {
            match entries.iter_mut().find(|(_, _, entry)| *entry == brick) {
                Some((count, _, _)) => *count += 1,
                None => entries.push((1, value(brick), brick)),
            }
        }
        entries.sort_by(|a, b| b.0.cmp(&a.0).then_with(|| a.1.cmp(&b.1)));
        let index = |brick| entries.iter().position(|(_, _, entry)| *entry == brick).unwrap_or(0) as u16;
        let indices = bricks.iter().flat_map(|brick| index(brick).to_le_bytes()).collect();
        let entries = entries.iter().flat_map(|(_, _, entry)| entry.iter().copied()).collect();
        self.set(INDICES, indices);
        self.set(ENTRIES, entries);
        self.set_words(SEGMENTS, &[0]);
    }

    /// Converts the bricks to `planes` planes.
    pub fn convert_bricks(&mut self, planes: u8) {
        let bricks = self.decoded();
        let converted: Vec<Vec<u8>> = match (self.header[67], planes) {
            (1, 2) => bricks.iter().map(|brick| brick.repeat(2)).collect(),
            (2, 1) => bricks.iter().map(|brick| brick[..8].to_vec()).collect(),
            _ => return,
        };
        self.header[67] = planes;
        self.encode(&converted, self.coded());
    }

    /// Makes the tree connected, starting from its planes: drops and repeats elements and bricks until there
    /// are as many as the branches require, and ranks the children.
    fn repair_links(&mut self) {
        let Some(depth) = self.depth() else { return };
        let levels = depth.div_ceil(2);
        if self.header[65] != 1 {
            for kind in PLANES..=BASE {
                self.set(kind, vec![]);
            }
            return self.encode(&[], false);
        }
        let mut planes: Vec<[u64; 2]> =
            self.words(PLANES).chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        let known = planes.len();
        let mut next = 1;
        let mut end = 0;
        let (mut rel, mut base) = (vec![], vec![]);
        for _ in 1..levels {
            let first = end;
            end = next;
            for n in first..end {
                if n >= planes.len() {
                    planes.push(if known == 0 { [1, 0] } else { planes[n % known] });
                }
                let [lower, upper] = &mut planes[n];
                if n == 0 && depth % 2 == 1 {
                    (*lower, *upper) = (*lower & 0xFF, *upper & 0xFF);
                }
                let branches = (*lower & !*upper).count_ones() as usize;
                if next + branches > MOST_ENTRIES {
                    *upper |= *lower;
                }
                if n % 1024 == 0 {
                    base.push(next as u64);
                }
                rel.extend_from_slice(&((next as u64 - base[n / 1024]) as u16).to_le_bytes());
                next += (*lower & !*upper).count_ones() as usize;
            }
        }
        planes.truncate(end);
        self.set_words(PLANES, &planes.concat());
        self.set(REL, rel);
        self.set_words(BASE, &base);
        let mut bricks = self.decoded();
        if bricks.is_empty() {
            bricks.push([&[0x0Fu8; 8][..], &[0x1Fu8; 8][..]].concat()[..self.brick_size()].to_vec());
        }
        if levels == 1 && depth % 2 == 1 {
            for word in bricks[0].chunks_mut(8) {
                word[1..].fill(0);
            }
        }
        let bricks: Vec<Vec<u8>> = bricks.iter().cycle().take(next - end).cloned().collect();
        self.encode(&bricks, self.coded());
    }

    /// Sorts the dictionary.
    fn repair_dictionary(&mut self) {
        if self.coded() {
            let bricks = self.decoded();
            self.encode(&bricks, true);
        }
    }

    /// Counts the levels, element by element. Where links are wrong, the level table defines the levels'
    /// beginnings and is kept.
    fn repair_levels(&mut self) {
        let Some(depth) = self.depth() else { return };
        let levels = depth.div_ceil(2);
        let mut counts = vec![[0u64; 3]; depth + 1];
        let root = self.header[65];
        if root != 1 {
            counts[0] = [0, (root == 3) as u64, (root == 2) as u64];
            return self.set_words(LEVELS, &counts.concat());
        }
        let planes = self.words(PLANES);
        let bricks = self.decoded();
        let two = self.brick_size() == 16;
        let (mut first, mut end) = (0, 1);
        for e in 0..levels {
            let mut children = 0;
            for n in first..end {
                let [lower, upper] = if e + 1 < levels {
                    let Some(pair) = planes.get(2 * n..2 * n + 2) else { break };
                    [pair[0], pair[1]]
                } else {
                    let Some(brick) = bricks.get(n - first) else { break };
                    [number(brick, 0, 8), number(brick, if two { 8 } else { 0 }, 8)]
                };
                children += (lower & !upper).count_ones() as usize;
                let half = depth % 2 == 1 && e == 0;
                let level = if depth.is_multiple_of(2) { 2 * e } else { (2 * e).max(1) - 1 };
                let cells = if half { level + 1 } else { level + 2 };
                counts[level][0] += 1;
                for octant in 0..if half { 1 } else { 8 } {
                    match ((lower >> (8 * octant)) as u8, (upper >> (8 * octant)) as u8) {
                        (0, 0) if !half => {}
                        (0xFF, 0xFF) if !half => counts[cells - 1][1] += 1,
                        (0, 0xFF) if !half => counts[cells - 1][2] += 1,
                        (lower, upper) => {
                            counts[cells - 1][0] += !half as u64;
                            counts[cells][1] += (lower & upper).count_ones() as u64;
                            counts[cells][2] += (!lower & upper).count_ones() as u64;
                        }
                    }
                }
            }
            (first, end) = (end, end + children);
        }
        self.set_words(LEVELS, &counts.concat());
    }

    /// True if the sections of cuts are valid kinds according to the header, and there are cuts.
    fn has_cuts(&self) -> bool {
        number(&self.header, 10, 2) >= 4 && self.bytes(CUT_HEADS) != [0u8; 0]
    }

    /// Returns the PARTIAL cells' levels in the order of their cuts, and the number of such cells before each
    /// element and brick.
    fn partial_cells(&self, depth: usize) -> (Vec<usize>, Vec<u32>) {
        let (mut cells, mut first) = (vec![], vec![]);
        match self.header[65] {
            1 => {}
            2 => return (vec![0], vec![1]),
            _ => return (cells, vec![0]),
        }
        let bricks = self.decoded();
        let size = self.brick_size();
        let upper = |brick: &[u8]| [number(brick, 0, 8), number(brick, size - 8, 8)];
        let elements = self.words(PLANES);
        let elements = elements.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
        let entries: Vec<[u64; 2]> = elements.chain(bricks.iter().map(|brick| upper(brick))).collect();
        // The ends of the levels, by the branches.
        let (mut e, mut end, mut children) = (0, 1, 0);
        for (n, [lower, upper]) in entries.into_iter().enumerate() {
            if n == end {
                (e, end, children) = (e + 1, end + children, 0);
            }
            children += (lower & !upper).count_ones() as usize;
            first.push(cells.len() as u32);
            let level = (2 * e + 2 - depth % 2).min(depth);
            for octant in 0..8 {
                match (!lower & upper) >> (8 * octant) as u8 & 0xFF {
                    0xFF => cells.push(level - 1),
                    some => cells.extend((0..some.count_ones()).map(|_| level)),
                }
            }
        }
        first.push(cells.len() as u32);
        (cells, first)
    }

    fn repair_cuts(&mut self) {
        let Some(depth) = self.depth().filter(|_| self.has_cuts()) else { return };
        let (mut levels, first) = self.partial_cells(depth);
        if levels.is_empty() || levels.len() > MOST_CUTS {
            return CUTS.into_iter().for_each(|kind| self.set(kind, vec![]));
        }
        let known = levels.len();
        let old_heads = self.bytes(CUT_HEADS).to_vec();
        let mut kept = Kept::new(self.bytes(SURFACES).len() / 16, self.bytes(CELL_SLABS), self.bytes(GROUPS));
        let all = kept.all();
        let old_ids = unpacked(self.bytes(CUT_IDS), bits_of_an_id(all));
        let (mut heads, mut ids) = (vec![], vec![]);
        let mut drawn = old_ids.iter().cycle();
        let mut record = 0;
        while record < levels.len() {
            let mut head = *old_heads.get(record).unwrap_or(&0);
            let is_last_of_group = record >= known && (record - known) % 8 == 7;
            let depends = |i: usize| {
                let mask = [0xAA, 0xCC, 0xF0][i];
                (head & mask) >> (1 << i) != head & !mask
            };
            let count = (0..3).rev().find(|&i| depends(i)).map_or(0, |i| i + 1);
            if (0..count).any(|i| !depends(i)) || count > all {
                head = 0;
            }
            if head == 0xFF && (levels[record] >= depth || levels.len() + 8 > MOST_CUTS) {
                head = 0;
            }
            if head == 0 && is_last_of_group && all > 0 && heads[record - 7..].iter().all(|&head| head == 0) {
                head = 0xAA;
            }
            let count = match head {
                0 | 0xFF => 0,
                0xAA | 0x55 => 1,
                _ => count,
            };
            if head == 0xFF {
                let level = levels[record] + 1;
                levels.extend([level; 8]);
            }
            // Different surfaces, each already used or next in order.
            let mut own: Vec<usize> = vec![];
            while own.len() < count {
                let drawn = drawn.next().map_or(0, |&id| id);
                own.push(kept.one(drawn, &own));
            }
            own.sort_unstable();
            ids.extend(own);
            heads.push(head);
            record += 1;
        }
        // The remaining records, with their doubles.
        let used = kept.groups[0].next;
        let mut records = self.bytes(SURFACES)[..16 * used].to_vec();
        let (old, mut doubles) = (self.bytes(NUMBERS).to_vec(), vec![]);
        for surface in records.chunks_exact_mut(16) {
            let (terms, begin) = (number(surface, 4, 4), number(surface, 8, 4) as usize);
            let length: u64 = (0..10).map(|i| terms >> (3 * i) & 7).sum();
            put(surface, 8, doubles.len() as u64 / 8, 4);
            let range = begin.saturating_mul(8)..begin.saturating_add(length as usize).saturating_mul(8);
            doubles.extend_from_slice(old.get(range).unwrap_or(&[]));
        }
        let (mut blocks, mut counted) = (vec![], [0u32; 2]);
        for (record, head) in heads.iter().enumerate() {
            if record % 32 == 0 {
                blocks.extend(counted.map(u32::to_le_bytes).concat());
            }
            let depends = |i: usize| {
                let mask = [0xAA, 0xCC, 0xF0][i];
                (head & mask) >> (1 << i) != head & !mask
            };
            counted[0] += (0..3u32).rev().find(|&i| depends(i as usize)).map_or(0, |i| i + 1);
            counted[1] += u32::from(*head == 0xFF);
        }
        let (names, slabs, groups) = kept.finish(depth);
        let ids: Vec<usize> = ids.iter().map(|&id| names[id]).collect();
        self.set(CUT_HEADS, heads);
        self.set(CUT_IDS, packed(&ids, bits_of_an_id(used + slabs.len() / 16)));
        self.set(CUT_BLOCKS, blocks);
        self.set(CUT_FIRST, first.iter().flat_map(|n| n.to_le_bytes()).collect());
        self.set(SURFACES, records);
        self.set(NUMBERS, doubles);
        if used == 0 {
            self.set(PLACEMENTS, vec![]);
            self.set(ORIGINS, vec![]);
        }
        self.set(CELL_SLABS, slabs);
        self.set(GROUPS, groups);
        // Moments of a single solid.
        if let Some(moments) = self.section(MOMENTS) {
            moments.bytes.truncate(8 * 23);
        }
    }

    /// Repairs the table's order, the elements of the solid's sections, and the counts.
    fn repair_counts(&mut self) {
        let planes = self.brick_size() as u64 / 8;
        let has_cuts = number(&self.header, 10, 2) >= 4;
        let place = |file: &File, i: usize| (file.sections[i].owner(), file.sections[i].kind());
        let mut order: Vec<usize> = (0..self.sections.len()).collect();
        order.sort_by_key(|&i| place(self, i));
        order.dedup_by_key(|i| place(self, *i));
        for section in &mut self.sections {
            let (kind, components) = match section.kind() {
                _ if section.owner() != 0 => continue,
                OBJECTS => (0, RECORD as u64 / 8),
                METADATA => (1, 1),
                LEVELS => (4, 3),
                PLANES => (4, 2),
                REL | INDICES => (2, 1),
                BASE | SEGMENTS => (4, 1),
                BRICKS | ENTRIES => (4, planes),
                CUT_HEADS | CUT_IDS if has_cuts => (1, 1),
                CUT_BLOCKS if has_cuts => (3, 2),
                CUT_FIRST if has_cuts => (3, 1),
                SURFACES if has_cuts => (3, 4),
                NUMBERS if has_cuts => (6, 1),
                PLACEMENTS if has_cuts => (0, 13),
                ORIGINS | CELL_SLABS if has_cuts => (4, 2),
                GROUPS if has_cuts => (4, 3),
                MOMENTS if has_cuts => (6, 23),
                _ => continue,
            };
            put(&mut section.entry, 8, kind | components << 8, 4);
        }
        for section in &mut self.sections {
            let size = section.size();
            section.bytes.truncate(section.bytes.len() / size * size);
        }
        order.retain(|&i| !self.sections[i].bytes.is_empty());
        self.rearrange(&order);
        let bricks = self.bytes(BRICKS).len() / self.brick_size() + self.bytes(INDICES).len() / 2;
        let counts = [self.bytes(PLANES).len() / 16, bricks, self.bytes(ENTRIES).len() / self.brick_size()];
        for (at, count) in [72, 80, 88].into_iter().zip(counts) {
            put(&mut self.header, at, count as u64, 8);
        }
        put(&mut self.header, 96, self.sections.len() as u64, 4);
    }

    /// Repairs the objects' records: the solid's record repeats the header, the others contain nothing that
    /// readers must understand, and every section belongs to an object.
    fn repair_objects(&mut self) {
        let newer = number(&self.header, 10, 2) > 4;
        let mut records = self.bytes(OBJECTS).to_vec();
        records.resize((records.len() / RECORD * RECORD).max(RECORD), 0);
        for (i, record) in records.chunks_exact_mut(RECORD).enumerate() {
            let (kind, parent, flags) = (number(record, 0, 4), number(record, 4, 4), number(record, 8, 4));
            let flags = if newer { flags } else { 0 };
            if i > 0 {
                put(record, 0, kind.max(1), 4);
                put(record, 4, if parent < i as u64 { parent } else { u32::MAX.into() }, 4);
                put(record, 8, flags & !1, 4);
                continue;
            }
            put(record, 0, 1, 4);
            put(record, 4, u32::MAX.into(), 4);
            put(record, 8, flags | 1, 4);
            for (from, to, length) in MIRRORED {
                record[to..to + length].copy_from_slice(&self.header[from..from + length]);
            }
            // Values, which solids do not have, and reserved bytes.
            for (values, reserved) in [(19..21, 21..24), (64..76, 76..80), (104..112, 112..128)] {
                record[values].fill(0);
                if !newer {
                    record[reserved].fill(0);
                }
            }
        }
        let objects = (records.len() / RECORD) as u32;
        self.set(OBJECTS, records);
        for section in &mut self.sections {
            let owner = section.owner() % objects;
            put(&mut section.entry, 4, owner.into(), 4);
        }
    }

    /// Repairs shared bytes: sections that claim to share the bytes of others, and can, do so.
    fn repair_sharing(&mut self) {
        for i in 0..self.sections.len() {
            let Some(of) = self.shared(i) else {
                put(&mut self.sections[i].entry, 44, 0, 4);
                continue;
            };
            let of = self.sections[of].clone();
            let section = &mut self.sections[i];
            if section.owner() != 0 || section.kind() > SEGMENTS && !CUTS.contains(&section.kind()) {
                section.entry[8..12].copy_from_slice(&of.entry[8..12]);
                section.bytes = of.bytes;
            } else if section.entry[8..12] != of.entry[8..12] || section.bytes != of.bytes {
                put(&mut section.entry, 44, 0, 4);
            }
        }
    }

    /// Returns the file. Unrepaired parts stay as they are.
    pub fn assemble(mut self, repairs: &Repairs) -> Vec<u8> {
        if repairs.links {
            self.repair_links();
        }
        if repairs.dictionary {
            self.repair_dictionary();
        }
        if repairs.levels {
            self.repair_levels();
        }
        if repairs.cuts {
            self.repair_cuts();
        }
        if repairs.objects {
            self.repair_objects();
        }
        if repairs.counts {
            self.repair_counts();
        }
        if repairs.objects && repairs.counts {
            // The solid's record repeats the counts.
            self.repair_objects();
        }
        if repairs.places {
            self.repair_sharing();
        }
        let mut bytes = vec![0; HEADER + ENTRY * self.sections.len()];
        for i in 0..self.sections.len() {
            let shared = self.shared(i).map(|of| self.sections[of].entry);
            if shared.is_none() {
                bytes.resize(bytes.len().next_multiple_of(64), 0);
            }
            let section = &mut self.sections[i];
            let (size, length, raw) = (section.size(), section.bytes.len(), section.entry[10] == 0);
            let entry = &mut section.entry;
            if repairs.places {
                put(entry, 16, shared.map_or(bytes.len() as u64, |of| number(&of, 16, 8)), 8);
                put(entry, 24, length as u64, 8);
                // In an unknown encoding, the entry's number of elements counts.
                let count =
                    if raw && entry[8] < 7 { (length / size) as u64 } else { number(entry, 32, 8).max(1) };
                put(entry, 32, shared.map_or(count, |of| number(&of, 32, 8)), 8);
            }
            if repairs.checksums[0] {
                put(
                    entry,
                    40,
                    shared.map_or(crc32fast::hash(&section.bytes).into(), |of| number(&of, 40, 4)),
                    4,
                );
            }
            bytes[HEADER + ENTRY * i..][..ENTRY].copy_from_slice(entry);
            if shared.is_none() {
                bytes.extend_from_slice(&section.bytes);
            }
        }
        if repairs.places {
            put(&mut self.header, 24, bytes.len() as u64, 8);
        }
        bytes[..HEADER].copy_from_slice(&self.header);
        if repairs.checksums[1] {
            let crc = crc32fast::hash(&bytes[HEADER..HEADER + ENTRY * self.sections.len()]);
            put(&mut bytes, 100, crc.into(), 4);
        }
        if repairs.checksums[2] {
            let crc = crc32fast::hash(&bytes[..124]);
            put(&mut bytes, 124, crc.into(), 4);
        }
        bytes
    }
}
