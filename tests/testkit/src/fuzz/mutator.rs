//! Mutations that know the file format. Without them, checksums would stop nearly every input.

use super::layout::{
    BASE, CELL_SLABS, CUT_BLOCKS, CUT_FIRST, CUT_HEADS, CUT_IDS, CUTS, ENTRIES, ENTRY_FIELDS, File, GROUPS,
    HEADER_FIELDS, INDICES, LEVELS, METADATA, MOMENTS, NUMBERS, OBJECTS, ORIGINS, PLACEMENTS, PLANES, RECORD,
    RECORD_FIELDS, REL, Repairs, SEGMENTS, SURFACES, Section, number, put,
};
use super::{halves, joined};
use crate::Random;

/// A blind change of the first `size` bytes of `data` to at most `max` bytes; returns the new size. It is
/// libFuzzer's own mutation, or its substitute in a test.
pub type Blind<'b> = &'b mut dyn FnMut(&mut [u8], usize, usize) -> usize;

/// Changes the file in the first `size` bytes of `data`, to at most `max` bytes.
pub fn mutate_file(data: &mut [u8], size: usize, max: usize, seed: u32, blind: Blind<'_>) -> usize {
    let mut random = Random(seed.into());
    match changed_or_blind(&data[..size], max, &mut random, blind) {
        Some(bytes) => replace(data, &bytes, max).unwrap_or(size),
        None => blind(data, size, max),
    }
}

/// Changes an input of two parts. The first part is a file, the second a file or anything.
pub fn mutate_pair(data: &mut [u8], size: usize, max: usize, seed: u32, blind: Blind<'_>) -> usize {
    let mut random = Random(seed.into());
    let Some((first, second)) = halves(&data[..size]).filter(|_| !random.one_in(32)) else {
        return blind(data, size, max);
    };
    let (mut first, mut second) = (first.to_vec(), second.to_vec());
    let room = max.saturating_sub(4 + first.len().min(second.len()));
    match random.index(8) {
        0 => second = first.clone(),
        1..4 => first = changed_or_blind(&first, room, &mut random, blind).unwrap_or(first),
        _ => {
            second =
                changed_or_blind(&second, room, &mut random, blind).unwrap_or_else(|| grown(second, blind));
        }
    }
    // Trees on different lattices are refused before anything happens.
    if let (Some(a), Some(mut b)) = (File::parse(&first), File::parse(&second))
        && a.header[32..65] != b.header[32..65]
        && !random.one_in(16)
    {
        b.header[32..65].copy_from_slice(&a.header[32..65]);
        second = b.assemble(&repairs(&mut random));
    }
    replace(data, &joined(&first, &second), max).unwrap_or(size)
}

fn replace(data: &mut [u8], bytes: &[u8], max: usize) -> Option<usize> {
    if bytes.is_empty() || bytes.len() > max {
        return None;
    }
    data.get_mut(..bytes.len())?.copy_from_slice(bytes);
    Some(bytes.len())
}

/// Returns `bytes` after a blind change.
fn grown(mut bytes: Vec<u8>, blind: Blind<'_>) -> Vec<u8> {
    let size = bytes.len();
    let most = size + 32;
    bytes.resize(most, 0);
    let size = blind(&mut bytes, size, most);
    bytes.truncate(size.min(most));
    bytes
}

/// Returns random repairs. Each has a high probability; deeper repairs are less frequent, so that damage gets
/// that far.
pub fn repairs(random: &mut Random) -> Repairs {
    let mut often = || !random.one_in(24);
    let mut repairs = Repairs {
        counts: often(),
        objects: often(),
        places: often(),
        checksums: [often(), often(), often()],
        ..Repairs::FRAME
    };
    match random.index(4) {
        0 => {}
        1 => (repairs.levels, repairs.cuts) = (true, true),
        _ => {
            repairs.links = true;
            repairs.dictionary = !random.one_in(8);
            repairs.levels = !random.one_in(8);
            repairs.cuts = !random.one_in(8);
        }
    }
    repairs
}

/// Returns the file in `bytes` after a few changes and the given repairs; `None` if `bytes` are no file.
pub fn changed(bytes: &[u8], random: &mut Random, blind: Blind<'_>, repairs: &Repairs) -> Option<Vec<u8>> {
    let mut file = File::parse(bytes)?;
    for _ in 0..1 + random.index(3) {
        change(&mut file, random, blind);
    }
    Some(file.assemble(repairs))
}

/// Returns the file in `bytes` after a few changes; `None` if `bytes` are no file, if the result is too long,
/// or if a blind change is due.
fn changed_or_blind(bytes: &[u8], max: usize, random: &mut Random, blind: Blind<'_>) -> Option<Vec<u8>> {
    if random.one_in(12) {
        return None;
    }
    let repairs = repairs(random);
    let mut bytes = changed(bytes, random, blind, &repairs)?;
    if random.one_in(64) {
        // Between sections, or behind the last one.
        match random.index(3) {
            0 => bytes.push(0),
            1 => drop(bytes.pop()),
            _ => {
                let at = random.index(bytes.len());
                bytes[at] ^= 1 << random.index(8);
            }
        }
    }
    (bytes.len() <= max).then_some(bytes)
}

/// Returns a number near some likely limit.
fn number_near(old: u64, random: &mut Random) -> u64 {
    match random.index(12) {
        0 => 0,
        1 => 1,
        2 => old.wrapping_add(1),
        3 => old.wrapping_sub(1),
        4 => u64::MAX,
        5 => 1 << random.index(64),
        6 => (1u64 << random.index(64)).wrapping_sub(1),
        7 => old ^ 1 << random.index(64),
        8 => old.wrapping_add(64),
        9 => random.index(32) as u64,
        10 => random.bits(),
        _ => random.index(1 << 12) as u64,
    }
}

fn change_field(bytes: &mut [u8], fields: &[(usize, usize)], random: &mut Random) {
    let (at, length) = fields[random.index(fields.len())];
    let old = number(bytes, at, length);
    put(bytes, at, number_near(old, random), length);
}

/// Changes one of the numbers of `length` bytes in a section.
fn change_number(file: &mut File, kind: u32, length: usize, random: &mut Random) {
    if let Some(section) = file.section(kind)
        && section.bytes.len() >= length
    {
        let at = length * random.index(section.bytes.len() / length);
        let others = section.bytes.len() / length;
        let other = number(&section.bytes, length * random.index(others), length);
        let old = number(&section.bytes, at, length);
        let new = if random.one_in(3) { other } else { number_near(old, random) };
        put(&mut section.bytes, at, new, length);
    }
}

/// Gives one cell of the planes or bricks another tag.
fn change_tag(file: &mut File, random: &mut Random) {
    let kind = if random.one_in(2) {
        PLANES
    } else if file.coded() {
        ENTRIES
    } else {
        super::layout::BRICKS
    };
    let planes = if kind == PLANES { 2 } else { file.brick_size() / 8 };
    let Some(section) = file.section(kind).filter(|section| section.bytes.len() >= 8 * planes) else {
        return;
    };
    let at = 8 * planes * random.index(section.bytes.len() / (8 * planes));
    // Near the first cells more often: the root of an odd depth has eight.
    let cell = if random.one_in(2) { random.index(8) } else { random.index(64) };
    for plane in 0..planes {
        if random.one_in(2) {
            section.bytes[at + 8 * plane + cell / 8] ^= 1 << (cell % 8);
        }
    }
}

/// Grows, shrinks, doubles, moves or removes a section.
fn change_extent(file: &mut File, random: &mut Random) {
    if file.sections.is_empty() {
        return;
    }
    let i = random.index(file.sections.len());
    let section = &mut file.sections[i];
    match random.index(7) {
        0 => {
            let length = random.index(section.bytes.len() + 1);
            section.bytes.truncate(length);
        }
        1 => {
            let length = section.bytes.len().saturating_sub(section.size());
            section.bytes.truncate(length);
        }
        2 => {
            let size = section.size().min(section.bytes.len());
            section.bytes.extend_from_within(..size);
        }
        3 => {
            let again = section.bytes.len().min(512);
            section.bytes.extend_from_within(..again);
        }
        4 => {
            let copy = section.clone();
            file.insert(i, copy);
        }
        5 => file.remove(i),
        _ => {
            let kind = random.index(48) as u32 | (random.index(2) as u32) << 31;
            let mut section = Section::new(kind, vec![7; 8 * (1 + random.index(5))]);
            put(&mut section.entry, 12, random.index(3) as u64 / 2, 4);
            let at = random.index(file.sections.len() + 1);
            file.insert(at, section);
        }
    }
}

/// Adds an object, adds a section to an object, makes sections share bytes, or changes a record.
fn change_objects(file: &mut File, random: &mut Random) {
    let Some(objects) = file.section(OBJECTS) else { return };
    let count = objects.bytes.len() / RECORD;
    match random.index(4) {
        0 if count < 8 => {
            let at = objects.bytes.len();
            objects.bytes.resize(at + RECORD, 0);
            let record = &mut objects.bytes[at..];
            put(record, 0, 2 + random.index(6) as u64, 4);
            put(
                record,
                4,
                if random.one_in(2) { u32::MAX.into() } else { random.index(count + 1) as u64 },
                4,
            );
            put(record, 8, random.index(4) as u64 / 3, 4);
        }
        1 => {
            let mut section = Section::new(random.index(24) as u32, vec![3; 8 * (1 + random.index(5))]);
            put(&mut section.entry, 4, random.index(count + 1) as u64, 4);
            put(&mut section.entry, 8, random.index(7) as u64 | 0x100, 2);
            file.sections.push(section);
        }
        2 => {
            // In most cases, the bytes of an earlier section.
            let at = random.index(file.sections.len());
            let of =
                if random.one_in(4) { random.index(file.sections.len() + 2) } else { random.index(at + 1) };
            put(&mut file.sections[at].entry, 44, of as u64, 4);
        }
        _ => {
            let at = RECORD * random.index(count);
            if let Some(record) = objects.bytes.get_mut(at..at + RECORD) {
                change_field(record, &RECORD_FIELDS, random);
            }
        }
    }
}

/// Adds metadata entries, or changes the length of one.
fn change_metadata(file: &mut File, random: &mut Random) {
    match file.section(METADATA) {
        Some(section) if random.one_in(2) => {
            let at = 4 * random.index(section.bytes.len() / 4);
            if section.bytes.len() >= at + 4 {
                let old = number(&section.bytes, at, 4);
                put(&mut section.bytes, at, number_near(old, random), 4);
            }
        }
        Some(section) => section.bytes.extend_from_slice(b"\x02\0\0\0\x01\0\0\0zzv"),
        None => {
            let facts = b"\x01\0\0\0\x02\0\0\0k\xC3\x98\x02\0\0\0\0\0\0\0kk".to_vec();
            file.insert(file.sections.len().min(1), Section::new(METADATA, facts));
        }
    }
}

/// Returns a double near some likely limit.
fn double_near(old: u64, random: &mut Random) -> u64 {
    let value = f64::from_bits(old);
    let new = match random.index(12) {
        0 => f64::NAN,
        1 => f64::INFINITY,
        2 => 0.0,
        3 => -value,
        4 => value.next_up(),
        5 => value * 2f64.powi(random.index(600) as i32 - 300),
        6 => random.index(70) as f64,
        7 => f64::MAX,
        8 => f64::from_bits(1),
        9 => 2f64.powi(random.index(140) as i32 - 70),
        10 => value * (random.index(9) as f64 - 4.0) / 3.0,
        _ => return number_near(old, random),
    };
    new.to_bits()
}

fn change_double(file: &mut File, kind: u32, random: &mut Random) {
    if let Some(section) = file.section(kind).filter(|section| section.bytes.len() >= 8) {
        let at = 8 * random.index(section.bytes.len() / 8);
        let new = double_near(number(&section.bytes, at, 8), random);
        put(&mut section.bytes, at, new, 8);
    }
}

/// Changes cuts; adds cuts if there are none, or removes them.
fn change_cuts(file: &mut File, random: &mut Random) {
    if file.section(CUT_HEADS).is_none() {
        // A plane, a quadric and a slab, and slabs of cells of two origins. The number of cuts is repaired
        // later.
        put(&mut file.header, 10, 4, 2);
        file.header[67] = if random.one_in(8) { file.header[67] } else { 2 };
        let surfaces = [[0, 0o1111, 0, 0], [1, 0o1_001_000_111, 4, 0], [4, 0o11111, 9, 0]];
        let doubles = [1.0, -2.0, 0.5, 7.0, -1.0, -1.0, -1.0, 20.0, 100.0, 1.0, 1.0, -1.0, 3.0, 9.0];
        // Slabs of octants of the universe: about through the middle, an eighth of the cell thick.
        let planes = |bits: u64| bits & 3 << 61 | bits & 1 << 63 | 7 << 55 | 8 << 51 | bits & 0x3FFF_3FFF;
        let slabs: Vec<u64> = (0..3).flat_map(|k| [(8 + k) | k << 61, planes(random.bits())]).collect();
        let heads = (0..40 + random.index(40)).map(|_| match random.index(4) {
            0 => [0, 0xFF, 0xAA, 0x55][random.index(4)],
            _ => random.bits() as u8,
        });
        let parts = [
            (CUT_HEADS, heads.collect(), 0x101),
            (CUT_IDS, (0..60).map(|_| random.bits() as u8).collect(), 0x101),
            (CUT_BLOCKS, vec![0; 24], 0x203),
            (CUT_FIRST, vec![0; 8], 0x103),
            (SURFACES, surfaces.as_flattened().iter().flat_map(|n: &u32| n.to_le_bytes()).collect(), 0x403),
            (NUMBERS, doubles.iter().flat_map(|c: &f64| c.to_le_bytes()).collect(), 0x106),
            (CELL_SLABS, slabs.into_iter().flat_map(u64::to_le_bytes).collect(), 0x204),
            (GROUPS, [5, 6, 2, 0, 0, 3u64].into_iter().flat_map(u64::to_le_bytes).collect(), 0x304),
        ];
        let count = if random.one_in(3) { 6 } else { 8 };
        // A point, and wide bounds of all moments about it.
        let wide: Vec<f64> = (0..20).map(|i| [-1e6, 1e6][i % 2]).collect();
        let moments = [&[0.5, 0.0, -2.0, 0.0][..], &wide[1..]].concat();
        let moments = moments.iter().flat_map(|c: &f64| c.to_le_bytes()).collect();
        let moments = random.one_in(2).then_some((MOMENTS, moments, 0x1706));
        for (kind, bytes, element) in parts.into_iter().take(count).chain(moments) {
            let mut section = Section::new(kind, bytes);
            put(&mut section.entry, 8, element, 2);
            file.sections.push(section);
        }
        return file
            .sections
            .sort_by_key(|section| (number(&section.entry, 4, 4), number(&section.entry, 0, 4)));
    }
    match random.index(17) {
        0..3 => change_number(file, CUT_HEADS, 1, random),
        3 => change_number(file, CUT_IDS, 1, random),
        4 => change_number(file, if random.one_in(3) { GROUPS } else { CELL_SLABS }, 8, random),
        5 => change_number(file, CUT_BLOCKS, 4, random),
        6 => change_number(file, CUT_FIRST, 4, random),
        7 | 8 => change_number(file, SURFACES, 4, random),
        9..12 => change_double(file, NUMBERS, random),
        12 | 13 => change_double(file, PLACEMENTS, random),
        14 => change_number(file, if random.one_in(2) { ORIGINS } else { PLACEMENTS }, 8, random),
        15 => change_double(file, MOMENTS, random),
        _ => {
            let gone = CUTS[random.index(CUTS.len())];
            if let Some(i) = file.sections.iter().position(|section| section.is(gone)) {
                file.remove(i);
            }
        }
    }
}

/// Makes one change.
fn change(file: &mut File, random: &mut Random, blind: Blind<'_>) {
    match random.index(32) {
        0 => change_field(&mut file.header, &HEADER_FIELDS, random),
        // Depth, tags, bricks and counts, on which the rest depends.
        1 => change_field(&mut file.header, &HEADER_FIELDS[11..22], random),
        2 => file.header[64] = 1 + random.index(20) as u8,
        3 => {
            let depth = file.header[64];
            file.header[64] =
                if random.one_in(2) { depth.saturating_add(2) } else { depth.saturating_sub(2) };
        }
        4 => file.header[65 + random.index(2)] = random.index(4) as u8,
        5 => file.convert_bricks(3 - file.header[67].clamp(1, 2)),
        6 => {
            if !file.sections.is_empty() {
                let i = random.index(file.sections.len());
                change_field(&mut file.sections[i].entry, &ENTRY_FIELDS, random);
            }
        }
        7 | 8 => {
            if !file.sections.is_empty() {
                let i = random.index(file.sections.len());
                let bytes = std::mem::take(&mut file.sections[i].bytes);
                file.sections[i].bytes = grown(bytes, blind);
            }
        }
        9 | 10 => change_extent(file, random),
        11 | 12 => change_number(file, REL, 2, random),
        13 => change_number(file, BASE, 8, random),
        14 | 15 => change_number(file, LEVELS, 8, random),
        16 => change_number(file, INDICES, 2, random),
        17 => change_number(file, SEGMENTS, 8, random),
        18 => change_number(file, ENTRIES, 8, random),
        19 => change_metadata(file, random),
        20 | 21 => change_objects(file, random),
        26..32 => change_cuts(file, random),
        _ => change_tag(file, random),
    }
}
