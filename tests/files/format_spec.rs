//! The specification of the file format, its vectors and the library agree.

#![cfg(feature = "std")]

// Its `main` is the program that writes the vectors.
use crate::make_vectors;
use crate::make_vectors::{Way, hex, name, number};
use leafless::error::FormatError;
use leafless::octree::SurfaceKind;
use leafless::query::{PointCursor, PointTable};
use leafless::{
    Control, Error, Frame, Membership, Octree, OctreeRef, Proof, compact, contains, file, measure,
};
use leafless_testkit::Aligned;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("format_spec")
}

fn specification() -> String {
    fs::read_to_string(folder().join("specification.md")).unwrap()
}

// ---- the folder -----------------------------------------------------------------------------------------

#[test]
fn the_vectors_are_what_the_program_makes() {
    let mut expected = BTreeSet::new();
    let hint = "run `cargo run --release --example make_vectors -- format_spec/vectors`";
    let mut total = 0;
    for (path, bytes) in make_vectors::files() {
        let on_disk = fs::read(folder().join("vectors").join(&path)).unwrap_or_default();
        assert!(on_disk == bytes, "{} is out of date: {hint}", path.display());
        assert!(bytes.len() <= 100_000, "{}", path.display());
        total += bytes.len();
        assert!(expected.insert(path.clone()), "{} stands twice", path.display());
    }
    assert!(total < 2_050_000, "{total} bytes");
    for part in ["valid", "invalid"] {
        for file in fs::read_dir(folder().join("vectors").join(part)).unwrap() {
            let path = Path::new(part).join(file.unwrap().file_name());
            assert!(expected.contains(&path), "{} is not made by the program", path.display());
        }
    }
}

// ---- valid files ----------------------------------------------------------------------------------------

/// The lines of a vector's text, as pairs of key and value.
struct Facts<'t>(Vec<(&'t str, &'t str)>);

impl<'t> Facts<'t> {
    fn new(text: &'t str) -> Facts<'t> {
        Facts(text.lines().map(|line| line.split_once(": ").expect("a key and a value")).collect())
    }

    fn all<'f>(&'f self, key: &'f str) -> impl Iterator<Item = &'t str> + 'f {
        self.0.iter().filter(move |(found, _)| *found == key).map(|&(_, value)| value)
    }

    fn one(&self, key: &str) -> &'t str {
        let mut all = self.all(key);
        let value = all.next().unwrap_or_else(|| panic!("{key} is missing"));
        assert!(all.next().is_none(), "{key} stands twice");
        value
    }

    fn number(&self, key: &str) -> u64 {
        self.one(key).parse().unwrap()
    }
}

fn numbers(line: &str) -> Vec<u64> {
    line.split(' ').map(|number| number.parse().unwrap()).collect()
}

/// Parses a double as `hex` formats it.
fn double(text: &str) -> f64 {
    if !text.contains("0x") {
        return text.parse().unwrap();
    }
    let (sign, text) = text.strip_prefix('-').map_or((0, text), |text| (1 << 63, text));
    let (digits, exponent) = text.strip_prefix("0x").unwrap().split_once('p').unwrap();
    let (lead, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let fraction = u64::from_str_radix(&format!("{fraction:0<13}"), 16).unwrap();
    let exponent = exponent.parse::<i64>().unwrap() + 1023;
    f64::from_bits(sign | if lead == "0" { fraction } else { (exponent as u64) << 52 | fraction })
}

#[test]
fn doubles_are_written_without_loss() {
    for value in [0.0, -0.0, 1.0, -0.1, 1e300, f64::MAX, f64::MIN_POSITIVE, 5e-324, f64::INFINITY, -1.0 / 3.0]
    {
        assert_eq!(double(&hex(value)).to_bits(), value.to_bits(), "{value:e} as {}", hex(value));
    }
    assert!(double(&hex(f64::NAN)).is_nan());
    assert_eq!((hex(-4.0), hex(0.1)), ("-0x1p+2".into(), "0x1.999999999999ap-4".into()));
}

fn vector(of: &str, name: &str, ending: &str) -> PathBuf {
    folder().join("vectors").join(of).join(format!("{name}.{ending}"))
}

#[test]
fn valid_vectors_are_read_by_every_way_in() {
    let vectors = make_vectors::valid();
    assert!(vectors.len() > 30);
    for made in vectors {
        let path = vector("valid", made.name, "lfl");
        println!("{}", path.display());
        let bytes = fs::read(&path).unwrap();
        let text = fs::read_to_string(vector("valid", made.name, "txt")).unwrap();
        let facts = Facts::new(&text);

        let probe = file::probe(&path).unwrap();
        assert_eq!(probe, file::probe_bytes(&bytes).unwrap());
        probed(&probe, &facts, &bytes);
        let aligned = Aligned::new(&bytes);
        file::verify(aligned.bytes()).unwrap();
        viewed(&file::view(aligned.bytes()).unwrap(), &facts);
        owned(&file::from_bytes(&bytes).unwrap(), &facts, &bytes);
        owned(&file::open(&path).unwrap(), &facts, &bytes);
        #[cfg(feature = "mmap")]
        {
            // SAFETY: nobody changes the vectors while tests run.
            owned(&unsafe { file::map(&path) }.unwrap(), &facts, &bytes);
            // SAFETY: as above.
            owned(&unsafe { file::map_verified(&path) }.unwrap(), &facts, &bytes);
        }
    }
}

/// A reader of an older version ignores the sections of cuts as unknown ones, and reads the same tree.
#[test]
fn without_its_sections_of_cuts_a_file_is_that_of_the_tree() {
    let mut count = 0;
    for made in make_vectors::valid() {
        let tree = file::from_bytes(&made.bytes).unwrap();
        if tree.view().cuts().is_none() {
            continue;
        }
        let mut older = made.bytes.clone();
        make_vectors::put(&mut older, 10, 3, 2);
        // (Only newer versions may use these flags and reserved bytes of sections.)
        let sections = number(&older, 96, 4) as usize;
        for at in (0..sections).map(|i| 128 + make_vectors::ENTRY * i) {
            older[at + 11] = 0;
            older[at + 12] &= 1;
        }
        make_vectors::seal(&mut older);
        let plain = file::from_bytes(&older).unwrap();
        assert!(plain.view().cuts().is_none());
        let tags = compact(&tree.view().without_cuts()).unwrap();
        assert!(plain == tags && plain != tree && plain.proof() == tree.proof(), "{}", made.name);
        assert!(plain.metadata() == tree.metadata() && plain.channels() == tree.channels());
        assert_eq!(plain.statistics().levels(), tree.statistics().levels());
        count += 1;
    }
    assert!(count > 15, "{count}");
}

fn frame(facts: &Facts<'_>) -> Frame {
    let origin: Vec<f64> = facts.one("origin").split(' ').map(double).collect();
    let decimals: Vec<f64> =
        facts.one("origin-decimal").split(' ').map(|text| text.parse().unwrap()).collect();
    let edge = double(facts.one("edge"));
    assert_eq!((&decimals, facts.one("edge-decimal").parse::<f64>().unwrap()), (&origin, edge));
    Frame::new([origin[0], origin[1], origin[2]], edge, facts.number("depth") as u8).unwrap()
}

fn probed(probe: &file::Probe, facts: &Facts<'_>, bytes: &[u8]) {
    assert_eq!((probe.file_len, bytes.len() as u64), (facts.number("length"), facts.number("length")));
    assert_eq!(format!("{}.{}", probe.version.0, probe.version.1), facts.one("version"));
    assert_eq!(probe.frame, frame(facts));
    assert_eq!((name(probe.root), name(probe.exterior)), (facts.one("root"), facts.one("exterior")));
    assert_eq!(probe.proof, proof(facts));
    assert_eq!((probe.elements, probe.bricks), (facts.number("elements"), facts.number("bricks")));
    assert_eq!((probe.binary, number(bytes, 67, 1)), (facts.one("planes") == "1", facts.number("planes")));
    let kinds: Vec<u64> = probe.sections.iter().map(|section| section.kind.into()).collect();
    assert_eq!(kinds, numbers(facts.one("sections")));
    let owners: Vec<u64> = probe.sections.iter().map(|section| section.owner.into()).collect();
    assert_eq!(owners, numbers(facts.one("owners")));
    assert_eq!((probe.sections[0].name, probe.sections[0].count), (Some("objects"), facts.number("objects")));
    assert!(probe.sections.iter().all(|section| section.owner == 0 || section.name.is_none()));
    let coded = probe.sections.iter().find(|section| section.name == Some("dictionary entries"));
    assert_eq!(coded.is_some(), facts.one("encoding") == "dictionary");
    assert_eq!(coded.map_or(0, |section| section.count), facts.number("entries"));
    assert_eq!(number(bytes, 69, 1), facts.number("shift"));
}

fn proof(facts: &Facts<'_>) -> Proof {
    let bits = facts.number("proof");
    let proof = Proof::new(bits & 1 != 0, bits & 2 != 0);
    assert!(bits < 4);
    proof.with_displacement(double(facts.one("displacement"))).unwrap()
}

fn viewed(tree: &OctreeRef<'_>, facts: &Facts<'_>) {
    assert_eq!(tree.proof(), proof(facts));
    assert_eq!(tree.frame(), &frame(facts));
    assert_eq!((name(tree.root_tag()), name(tree.exterior())), (facts.one("root"), facts.one("exterior")));
    assert_eq!(
        (tree.element_count(), tree.brick_count()),
        (facts.number("elements"), facts.number("bricks"))
    );
    assert_eq!(tree.is_binary(), facts.one("planes") == "1");
    // The cuts answer in place. These points keep a distance from all surfaces.
    answered(tree, facts.all("cut-point").map(answer).collect());
    // The other points are answered without the cuts.
    let points: Vec<_> = facts.all("point").map(answer).collect();
    assert!(points.len() >= 30);
    answered(&tree.without_cuts(), points);
}

/// Checks that every way to query a tree gives these answers.
fn answered(tree: &OctreeRef<'_>, expected: Vec<([f64; 3], Membership)>) {
    let mut cursor = PointCursor::new(tree);
    let table = PointTable::new(tree, 4).unwrap();
    for &(point, answer) in &expected {
        let found = [tree.contains(point), cursor.contains(point), table.contains(point)];
        assert_eq!(found, [answer; 3], "{point:?}");
    }
    let (points, expected): (Vec<_>, Vec<_>) = expected.into_iter().unzip();
    let mut answers = vec![Membership::Undecided; points.len()];
    tree.contains_many(&points, &mut answers).unwrap();
    assert_eq!(answers, expected);
}

/// Parses a point and the answer for it.
fn answer(line: &str) -> ([f64; 3], Membership) {
    let words: Vec<&str> = line.split(' ').collect();
    let answer = match words[3] {
        "inside" => Membership::Inside,
        "outside" => Membership::Outside,
        "undecided" => Membership::Undecided,
        other => panic!("{other}"),
    };
    ([words[0], words[1], words[2]].map(double), answer)
}

/// Checks a tree's surfaces against the text's lines about surfaces.
fn surfaces(tree: &Octree, facts: &Facts<'_>, count: u64) {
    let (records, slabs) = (facts.all("surface").count() as u64, facts.all("cell-slab").count() as u64);
    assert_eq!(records + slabs, count);
    let half = |digits: &str| u64::from_str_radix(digits, 16).unwrap();
    let origin = |words: &[&str]| [half(words[1]), half(words[2])];
    let words = |line: &'_ str| line.split(' ').map(str::to_owned).collect::<Vec<_>>();
    let origins: Vec<_> =
        facts.all("slab-origin").map(|line| origin(&line.split(' ').collect::<Vec<_>>())).collect();
    for (id, line) in (0..).zip(facts.all("surface")) {
        let (words, found) = (words(line), tree.view().surface(id).unwrap());
        let numbers = if words[1] == "slab" { &words[3..words.len() - 2] } else { &words[3..] };
        assert_eq!(numbers.len(), found.numbers());
        for (i, number) in numbers.iter().enumerate() {
            let expected: Vec<_> = number.split(',').filter(|number| *number != "0").map(double).collect();
            assert_eq!(found.number(i), expected, "{line}");
        }
        let identity = (words[1] == "slab").then(|| [words.len() - 2, words.len() - 1].map(|i| &words[i]));
        let identity = identity.map(|own| own.map(|number| number.parse::<u64>().unwrap()));
        let expected = identity.filter(|own| own[0] != 0).map(|own| (origins[own[0] as usize - 1], own[1]));
        assert_eq!(found.origin(), expected, "{line}");
    }
    let groups: Vec<_> =
        facts.all("cell-slab-group").map(|line| line.split(' ').collect::<Vec<_>>()).collect();
    let ([x, y, z], edge) = (tree.frame().origin(), tree.frame().edge());
    let universe = [[edge, 0.0, 0.0, x], [0.0, edge, 0.0, y], [0.0, 0.0, edge, z]];
    for (place, line) in (0..).zip(facts.all("cell-slab")) {
        let words = words(line);
        let id = words[0].parse::<u32>().unwrap();
        let found = tree.view().surface(id).unwrap();
        assert_eq!((u64::from(id), found.kind()), (records + place, SurfaceKind::Slab));
        for (i, number) in words[6..].iter().enumerate() {
            let expected = Some(double(number)).filter(|number| *number != 0.0);
            assert_eq!(found.number(i), Vec::from_iter(expected), "{line}");
        }
        assert!(found.placements().eq([universe]), "{line}");
        let group = groups.iter().find(|group| place < group[3].parse().unwrap()).unwrap();
        let whole = |i: usize| words[i].parse::<u64>().unwrap();
        let octant = |l: u64| whole(2) >> l & 1 | (whole(3) >> l & 1) << 1 | (whole(4) >> l & 1) << 2;
        let home = (0..whole(1)).rev().fold(1, |home, l| home << 3 | octant(l)) | whole(5) << 61;
        let expected = Some((origin(group), 1 << 63 | home)).filter(|(origin, _)| *origin != [0; 2]);
        assert_eq!(found.origin(), expected, "{line}");
    }
}

/// Checks a tree's moments, and the measures of the solid, against the text's line about moments.
fn moments(tree: &Octree, facts: &Facts<'_>) {
    let Some(line) = facts.all("moments").next() else { return assert_eq!(tree.view().moments(), None) };
    let expected: Vec<f64> = line.split(' ').map(double).collect();
    let found = tree.view().moments().unwrap();
    let intervals = [found.volume].into_iter().chain(found.first).chain(found.second);
    let ends = intervals.flat_map(|interval| [interval.lower, interval.upper]);
    assert_eq!(found.point.into_iter().chain(ends).collect::<Vec<_>>(), expected);
    let plain = tree.without_moments();
    assert!(plain.view().moments().is_none() && plain == *tree);
    // The cells do not contradict them.
    let measured = |tree: &Octree| {
        let control = Control { max_splits: Some(2000), ..Control::threads(1) };
        measure(tree, tree.frame(), 0.0, &control).unwrap()
    };
    let (own, by_cells) = (measured(tree), measured(&plain));
    assert!(own.exact && own.volume == found.volume && !by_cells.exact);
    assert!(own.volume.lower <= by_cells.volume.upper && by_cells.volume.lower <= own.volume.upper);
    if let (Some(own), Some(by_cells)) = (own.centroid, by_cells.centroid) {
        for (own, by_cells) in own.iter().zip(by_cells) {
            assert!(own.lower <= by_cells.upper && by_cells.lower <= own.upper);
        }
    }
    for (own, by_cells) in own.inertia_about_origin.iter().zip(by_cells.inertia_about_origin) {
        for (own, by_cells) in own.iter().zip(by_cells) {
            assert!(own.lower <= by_cells.upper && by_cells.lower <= own.upper, "{own:?}, {by_cells:?}");
        }
    }
}

/// Checks a tree's cuts, and the point answers of a solid with cuts, against the text's lines about cuts.
fn cuts(tree: &Octree, facts: &Facts<'_>) {
    let Some(counts) = tree.view().cuts() else {
        assert_eq!(facts.all("cuts").count() + facts.all("cut-point").count(), 0);
        return;
    };
    let found = [counts.cells, counts.given_up, counts.splits, counts.surfaces];
    assert_eq!(found, numbers(facts.one("cuts"))[..4]);
    surfaces(tree, facts, counts.surfaces);
    moments(tree, facts);
    let (points, expected): (Vec<_>, Vec<_>) = facts.all("cut-point").map(answer).unzip();
    assert!(points.len() >= 15);
    let mut answers = vec![Membership::Undecided; points.len()];
    contains(tree, tree.frame(), &points, &mut answers, &Control::threads(1)).unwrap();
    for ((point, expected), found) in points.iter().zip(expected).zip(answers) {
        assert_eq!(found, expected, "{point:?}");
    }
}

fn owned(tree: &Octree, facts: &Facts<'_>, bytes: &[u8]) {
    viewed(tree.view(), facts);
    tree.view().check().unwrap();
    let statistics = tree.statistics();
    let levels: Vec<_> = facts.all("level").map(numbers).collect();
    let found = statistics.levels().iter().map(|l| vec![l.level as u64, l.nodes, l.full, l.partial]);
    assert_eq!(found.collect::<Vec<_>>(), levels);
    let (lower, upper) = statistics.volume_cells();
    assert_eq!(vec![lower, upper], numbers(facts.one("cells")));
    let metadata: Vec<_> = facts.all("metadata").map(|line| line.split_once('\t').unwrap()).collect();
    assert_eq!(tree.metadata().iter().collect::<Vec<_>>(), metadata);
    channels(tree, facts);
    cuts(tree, facts);
    // The writer makes this file of the tree, unless the file is not canonical.
    assert_eq!(file::to_bytes(tree).unwrap() == bytes, facts.one("canonical") == "yes");
}

/// Checks a tree's channels against the text's lines about channels. The first word of each line is the
/// number of the channel's object.
fn channels(tree: &Octree, facts: &Facts<'_>) {
    let heads: Vec<Vec<&str>> = facts.all("channel").map(|line| line.split(' ').collect()).collect();
    assert_eq!(tree.channels().len(), heads.len());
    for (channel, head) in tree.channels().iter().zip(&heads) {
        let of = |key| facts.all(key).filter_map(|line| line.strip_prefix(head[0])?.strip_prefix(' '));
        let view = channel.view().unwrap();
        view.check().unwrap();
        let kind = view.value_type();
        let (depth, values) = (view.frame().depth().to_string(), view.value_count().to_string());
        let components = kind.components().to_string();
        assert_eq!(
            [depth.as_str(), kind.scalar().name(), &components, &values],
            [head[1], head[3], head[4], head[5]]
        );
        let elements: Vec<u64> = head[8..10].iter().map(|number| number.parse().unwrap()).collect();
        assert_eq!(view.element_count(), elements.iter().sum::<u64>());
        let metadata: Vec<_> = of("channel-metadata").map(|line| line.split_once('\t').unwrap()).collect();
        assert_eq!(channel.metadata().iter().collect::<Vec<_>>(), metadata);
        assert_eq!(of("channel-level").count(), view.frame().depth() as usize + 1);
        let mut count = 0;
        for line in facts.all("value") {
            let words: Vec<&str> = line.split(' ').collect();
            if words[3] != head[0] {
                continue;
            }
            let mut expected = [0.0; 4];
            for (number, word) in expected.iter_mut().zip(&words[4..]).filter(|(_, word)| **word != "none") {
                *number = double(word);
            }
            let expected = (words[4] != "none").then_some(expected);
            assert_eq!(view.value_at([words[0], words[1], words[2]].map(double)), expected, "{line}");
            count += 1;
        }
        assert!(count >= 30);
    }
}

// ---- invalid files --------------------------------------------------------------------------------------

#[track_caller]
fn refused<T>(result: Result<T, Error>) -> String {
    match result {
        Ok(_) => panic!("it was let in"),
        Err(error) => format!("{:?}", error.cause()),
    }
}

#[test]
fn each_invalid_vector_is_refused_where_it_says_and_for_the_reason_it_says() {
    for made in make_vectors::invalid() {
        let path = vector("invalid", &made.name, "lfl");
        println!("{}", path.display());
        let bytes = fs::read(&path).unwrap();
        let text = fs::read_to_string(vector("invalid", &made.name, "txt")).unwrap();
        let facts = Facts::new(&text);
        assert!(made.name.starts_with(facts.one("rule")));
        let way = [Way::Probing, Way::Plain, Way::Metadata, Way::Verification];
        let way = way.into_iter().find(|way| way.name() == facts.one("refused-by")).unwrap();
        let error = facts.one("error");
        let of_length = facts.all("error-of-length").next().unwrap_or(error);

        // Bytes may be the beginning of a longer file; files have a length.
        match way {
            Way::Probing => {
                assert_eq!(refused(file::probe_bytes(&bytes)), error);
                assert_eq!(refused(file::probe_from(&bytes[..])), error);
                assert_eq!(refused(file::probe(&path)), error);
            }
            _ => {
                file::probe_bytes(&bytes).unwrap();
                file::probe_from(&bytes[..]).unwrap();
                match facts.one("rule") == "file-length" {
                    true => assert_eq!(refused(file::probe(&path)), error),
                    false => drop(file::probe(&path).unwrap()),
                }
            }
        }
        let aligned = Aligned::new(&bytes);
        match way {
            Way::Probing | Way::Plain => assert_eq!(refused(file::view(aligned.bytes())), of_length),
            _ => drop(file::view(aligned.bytes()).unwrap()),
        }
        #[cfg(feature = "mmap")]
        {
            // SAFETY: nobody changes the vectors while tests run.
            match (way, unsafe { file::map(&path) }) {
                (Way::Verification, mapped) => drop(mapped.unwrap()),
                (_, mapped) => assert_eq!(refused(mapped), of_length),
            }
            // SAFETY: as above.
            assert_eq!(refused(unsafe { file::map_verified(&path) }), of_length);
        }
        assert_eq!(refused(file::verify(aligned.bytes())), of_length);
        assert_eq!(refused(file::from_bytes(&bytes)), of_length);
        assert_eq!(refused(file::open(&path)), of_length);
    }
}

/// The names in the first column of the tables of §10.
fn rules() -> Vec<String> {
    let specification = specification();
    let (_, rules) = specification.split_once("\n## 10. ").unwrap();
    let (rules, _) = rules.split_once("\n## 11. ").unwrap();
    let rows = rules.lines().filter_map(|line| line.strip_prefix("| `")?.split_once("` |"));
    rows.map(|(name, _)| name.to_owned()).collect()
}

/// All invalid vectors, including those of tri-dexel models.
fn all_invalid() -> Vec<make_vectors::Invalid> {
    let mut vectors = make_vectors::invalid();
    vectors.extend(make_vectors::dexel_vectors::invalid());
    vectors
}

#[test]
fn each_rule_for_readers_has_a_vector() {
    let rules = rules();
    let named: BTreeSet<&str> = rules.iter().map(String::as_str).collect();
    assert_eq!(named.len(), rules.len(), "a rule stands twice");
    assert!(rules.len() > 50, "{rules:?}");
    let vectors = all_invalid();
    let used: BTreeSet<&str> = vectors.iter().map(|vector| vector.rule).collect();
    assert_eq!(used, named);
}

/// The library's sources that define the format.
const SOURCES: [&str; 10] = [
    include_str!("../../src/file/header.rs"),
    include_str!("../../src/file/counts.rs"),
    include_str!("../../src/file/section.rs"),
    include_str!("../../src/file/kind.rs"),
    include_str!("../../src/file/object.rs"),
    include_str!("../../src/file/layout.rs"),
    include_str!("../../src/file/tree.rs"),
    include_str!("../../src/file/channel.rs"),
    include_str!("../../src/file/tridexel.rs"),
    include_str!("../../src/file/cuts.rs"),
];

/// Every name that the reader's source can put into an error occurs in the error of some vector. So does
/// every variant that bytes can cause.
#[test]
fn each_reason_of_the_library_has_a_vector() {
    let vectors = all_invalid();
    let seen = |what: &str| {
        assert!(vectors.iter().any(|vector| vector.error.contains(what)), "no vector is refused with {what}");
    };
    let source = SOURCES.concat();
    let mut fields = BTreeSet::new();
    for call in ["illegal(\"", "demand(\""] {
        fields.extend(source.split(call).skip(1).map(|rest| rest.split_once('"').unwrap().0));
    }
    assert!(fields.len() >= 31, "{fields:?}");
    fields.insert("padding");
    fields.iter().for_each(|field| seen(&format!("Field {{ name: {field:?}")));
    let (_, names) = source.split_once("fn name(self) -> &'static str {").unwrap();
    let names: Vec<_> =
        names.split("=> \"").skip(1).take(24).map(|rest| rest.split_once('"').unwrap().0).collect();
    for name in names.iter().chain(&["windows", "starts along x", "spans along y", "starts along z"]) {
        seen(&format!("Section {{ name: {name:?}"));
    }
    assert_eq!((names[0], names[9], names[12]), ("objects", "dictionary segments", "value base"));
    assert_eq!((names[13], names[23]), ("cut heads", "moments"));
    // (The sections of channels belong to other objects.)
    let of_solid = names.iter().take(10).chain(&names[13..]);
    of_solid.for_each(|name| seen(&format!("Checksum {{ name: {name:?}")));
    for name in ["the header", "the section table", "an unknown section", "a section of another object"] {
        seen(&format!("Checksum {{ name: {name:?}"));
    }
    for name in ["flags", "section", "section encoding", "object"] {
        seen(&format!("Required {{ name: {name:?}"));
    }

    // All variants, from the source of the enums.
    let errors = include_str!("../../src/error.rs");
    let mut count = 0;
    for of in ["FormatError", "Damage"] {
        let (_, body) = errors.split_once(&format!("pub enum {of} {{")).unwrap();
        let (body, _) = body.split_once("\n}").unwrap();
        for line in body.lines().filter_map(|line| line.strip_prefix("    ")) {
            let variant: String = line.chars().take_while(|c| c.is_alphanumeric()).collect();
            // The memory's alignment, the machine's byte order and the kind of a file are not errors of the
            // bytes. Neither is the kind of file that the caller expects.
            let elsewhere = ["", "Alignment", "Endianness", "NotRegular", "OtherModel"];
            if !elsewhere.contains(&&*variant) {
                let kind = if of == "Damage" { "Damaged" } else { "Format" };
                seen(&format!("{kind}({variant}"));
                count += 1;
            }
        }
    }
    assert_eq!(count, 10 + 18);
}

// ---- accepted files -------------------------------------------------------------------------------------

/// Sets each single byte of small files to every eighth value, with right checksums, once with a solid's
/// record that repeats the header and once with the old record. A file that is then verified must be
/// canonical (the bytes that the writer would write) or be listed in `permissive.md`.
#[test]
fn what_is_accepted_is_canonical_or_listed() {
    let accepted = accept(8);
    assert!(accepted > 1_000, "{accepted}");
}

/// The same for all values. Takes minutes: `--test files format_spec -- --ignored`.
#[test]
#[ignore = "minutes"]
fn whatever_is_accepted_is_canonical_or_listed() {
    let accepted = accept(1);
    assert!(accepted > 10_000, "{accepted}");
}

/// Sets each byte of each vector to one value in `every`; returns the number of accepted files.
fn accept(every: usize) -> usize {
    let mut accepted = 0;
    for (place, vector) in make_vectors::valid().into_iter().enumerate() {
        let most = match vector.name {
            name if name.starts_with("channel") => 1800,
            "cut-placed" => 1900,
            name if name.starts_with("cut-moments") => 1600,
            name if name.starts_with("cut-") => 1500,
            _ => 1200,
        };
        if vector.bytes.len() > most || !vector.canonical {
            continue;
        }
        let name = vector.name;
        // (A different part of the values for each byte.)
        let values = |at: usize| (0..=255u8).skip((at + place) % every).step_by(every);
        let changes = (0..vector.bytes.len()).flat_map(|at| values(at).map(move |value| (at, value)));
        for ((at, value), mirrored) in changes.flat_map(|change| [(change, false), (change, true)]) {
            let mut bytes = vector.bytes.clone();
            // The solid's record repeats only header fields.
            if bytes[at] == value || mirrored && at >= 128 {
                continue;
            }
            bytes[at] = value;
            if mirrored {
                make_vectors::mirror(&mut bytes);
            }
            make_vectors::seal(&mut bytes);
            let Ok(tree) = file::from_bytes(&bytes) else { continue };
            accepted += 1;
            if tree.view().cuts().is_some() {
                // A verified tree is a solid.
                let frame = tree.frame();
                let points = [0.3, 0.6].map(|t| frame.origin().map(|c| c + t * frame.edge()));
                let mut answers = [Membership::Undecided; 2];
                contains(&tree, frame, &points, &mut answers, &Control::threads(1)).unwrap();
            }
            let written = file::to_bytes(&tree).unwrap();
            // The writer states the oldest version that supports the objects.
            let other = number(&bytes, 10, 2) != number(&written, 10, 2);
            let unknown = make_vectors::has_unknown_parts(&bytes);
            assert!(
                (written == bytes) != (other || unknown),
                "{name}: byte {at} = {value:#x} is accepted, and written otherwise"
            );
        }
    }
    accepted
}

// ---- the specification ----------------------------------------------------------------------------------

/// Returns the rows of the table that follows `title`, as trimmed cells.
fn table(text: &str, title: &str) -> Vec<Vec<String>> {
    let (_, text) = text.split_once(title).unwrap_or_else(|| panic!("{title}"));
    let rows = text.lines().skip_while(|line| !line.starts_with("|---")).skip(1);
    let cells = |line: &str| line.trim_matches('|').split(" | ").map(|cell| cell.trim().to_owned()).collect();
    rows.take_while(|line| line.starts_with('|')).map(|line| cells(&line.replace("| |", "|  |"))).collect()
}

fn size(kind: &str) -> usize {
    match kind {
        "u8" => 1,
        "u16" => 2,
        "u32" => 4,
        "u64" | "f64" => 8,
        bytes => bytes.strip_suffix(" bytes").unwrap().parse().unwrap(),
    }
}

#[test]
fn the_tables_fit_the_constants() {
    let text = specification();
    let source = SOURCES.concat();
    // Offsets that the source declares of its structures.
    let offsets = |of: &str| -> BTreeSet<usize> {
        let (_, declared) = source.split_once(&format!("    struct {of}: ")).unwrap();
        let (fields, _) = declared.split_once("    }\n}").unwrap();
        let fields = fields.lines().skip(1).map(str::trim).filter(|line| !line.starts_with("///"));
        fields.filter_map(|line| line.split(' ').next()?.parse().ok()).collect()
    };
    let tables = [
        ("\n## 3. Header", "Header", 128),
        ("\n## 4. Section table", "Entry", 48),
        ("\n### 5.1 Objects", "Object", 128),
    ];
    for (title, of, length) in tables {
        let mut end = 0;
        let mut found = BTreeSet::new();
        for row in table(&text, title) {
            assert_eq!(row[0].parse::<usize>().unwrap(), end, "{row:?}");
            found.insert(end);
            end += size(&row[1]);
        }
        assert_eq!(end, length);
        // Some lines of the tables are one field of the structure (the origin, the extents). Other lines have
        // no field of their name.
        let offsets = offsets(of);
        assert!(offsets.is_subset(&found), "{offsets:?}, {found:?}");
        let apart: Vec<_> = found.difference(&offsets).copied().collect();
        match of {
            "Header" => assert_eq!(apart, [40, 48]),
            "Entry" => assert!(apart.is_empty()),
            _ => assert!(apart.iter().all(|at| [40, 48, 68, 72].contains(at)), "{apart:?}"),
        }
    }

    let constant = |name: &str| -> u64 {
        let (_, value) = source.split_once(&format!("const {name}: ")).unwrap();
        let (value, _) = value.split_once(" = ").unwrap().1.split_once(';').unwrap();
        match value.split_once(" << ") {
            Some((one, shift)) => one.parse::<u64>().unwrap() << shift.parse::<u32>().unwrap(),
            None => value.parse().unwrap(),
        }
    };
    let limits = table(&text, "\n## 12. Limits");
    let limit = |name: &str| &limits.iter().find(|row| row[0] == name).unwrap()[1];
    assert_eq!(limit("sections"), &constant("MAX_SECTIONS").to_string());
    assert_eq!(limit("objects"), &constant("MAX_OBJECTS").to_string());
    assert_eq!((limit("metadata"), constant("MAX_METADATA")), (&"2^20 bytes".to_owned(), 1 << 20));
    assert!(limit("depth").starts_with(&leafless::lattice::MAX_DEPTH.to_string()));
    assert!(text.contains(&format!("a multiple of {}", constant("SECTION_ALIGNMENT"))));
    assert!(text.contains(&format!("{} to 62 for segments", constant("LEAST_SEGMENT_SHIFT"))));
    let magic = file::MAGIC.map(|byte| format!("{byte:02X}")).join(" ");
    assert!(text.contains(&format!("| magic | `{magic}` |")));
    assert!(text.contains(&format!("# The Leafless file format, version {}.{}\n", file::MAJOR, file::MINOR)));

    assert_eq!((limit("channels"), constant("MOST_CHANNELS")), (&"256".to_owned(), 256));
    let channel = include_str!("../../src/file/channel.rs");
    assert!(
        limit("metadata of a channel") == "2^16 bytes" && channel.contains("MAX_METADATA: u64 = 1 << 16;")
    );

    // Kinds and their names.
    let mut rows = table(&text, "\n## 5. Sections");
    rows.extend(
        table(&text, "\n### 5.6 Channels")
            .into_iter()
            .filter(|row| row[0].parse::<u8>().is_ok_and(|kind| kind > 10)),
    );
    rows.extend(table(&text, "\n### 5.7 Tri-dexel models").into_iter().skip(2));
    rows.extend(table(&text, "\n### 5.8 Cuts"));
    rows.sort_by_key(|row| row[0].parse::<u8>().unwrap());
    let (_, kinds) = source.split_once("enum Kind {").unwrap();
    let (kinds, _) = kinds.split_once("\n}").unwrap();
    let numbers: Vec<_> = kinds.lines().filter_map(|line| line.split_once(" = ")).collect();
    let (_, names) = source.split_once("fn name(self) -> &'static str {").unwrap();
    for (row, (kind, number)) in rows.iter().zip(&numbers) {
        let (_, name) = names.split_once(&format!("Kind::{} => \"", kind.trim())).unwrap();
        let name = name.split_once('"').unwrap().0;
        assert_eq!((row[0].as_str(), row[1].as_str()), (number.trim_end_matches(','), name));
    }
    assert_eq!((rows.len(), numbers.len()), (40, 40));
}

#[test]
fn the_checksum_is_the_specified_one() {
    assert!(specification().contains(&format!("`123456789` it is 0x{:08X}", crc32fast::hash(b"123456789"))));
}

#[test]
fn the_example_is_the_vector() {
    let text = specification();
    let (_, dump) = text.split_once("```hex\n").unwrap();
    let (dump, _) = dump.split_once("```").unwrap();
    let bytes = fs::read(vector("valid", "example", "lfl")).unwrap();
    let mut shown = vec![0; bytes.len()];
    let mut end = 0;
    for line in dump.lines().filter(|line| !line.is_empty()) {
        let (line, _) = line.split_once('|').unwrap();
        let (at, digits) = line.split_once(' ').unwrap();
        let at = usize::from_str_radix(at, 16).unwrap();
        assert!(at >= end, "{line}");
        end = at;
        for byte in digits.split_whitespace() {
            shown[end] = u8::from_str_radix(byte, 16).unwrap();
            end += 1;
        }
    }
    assert_eq!(end, bytes.len());
    assert!(text.contains(&format!("The {} bytes of", bytes.len())));
    assert!(shown == bytes);
    let tree = file::from_bytes(&bytes).unwrap();
    assert_eq!(tree.statistics().volume_cells(), (97, 177));
    let volume = tree.statistics().volume();
    assert_eq!((volume.lower, volume.upper), (12.125, 22.125));
    for (point, answer) in [
        ([2.5, 2.5, 3.5], Membership::Inside),
        ([2.0, 1.0, 1.0], Membership::Undecided),
        ([3.0, 4.0, 4.5], Membership::Outside),
        ([3.1, 2.0, 3.5], Membership::Undecided),
    ] {
        assert_eq!(tree.contains(point), answer);
    }
}

/// Links between the pages lead to existing files.
#[test]
fn links_lead_to_files() {
    let mut count = 0;
    for page in ["README.md", "specification.md", "rationale.md", "CHANGES.md", "errata.md", "permissive.md"]
    {
        let text = fs::read_to_string(folder().join(page)).unwrap();
        for link in text.split("](").skip(1).map(|rest| rest.split_once(')').unwrap().0) {
            let local = link.split('#').next().unwrap();
            assert!(link.contains("://") || folder().join(local).exists(), "{page}: {link}");
            count += 1;
        }
    }
    assert!(count > 10);
}

/// Several dictionary segments need too many bricks for a vector in a file.
#[test]
fn dictionaries_of_several_segments() {
    // 64³ bricks of 25 000 kinds in every block of 2^16: too many for one dictionary, few enough for several.
    let bytes = make_vectors::many_bricks();
    let sections = file::probe_bytes(&bytes).unwrap().sections;
    let at = |name| sections.iter().position(|section| section.name == Some(name)).unwrap();
    let (indices, entries, segments) =
        (at("brick indices"), at("dictionary entries"), at("dictionary segments"));
    assert_eq!((number(&bytes, 69, 1), sections[segments].count), (17, 2));
    let tree = file::from_bytes(&bytes).unwrap();
    assert!(file::to_bytes(&tree).unwrap() == bytes);

    let verdict = |at: usize, value: u64, length: usize| {
        let mut bytes = bytes.clone();
        make_vectors::put(&mut bytes, at, value, length);
        make_vectors::seal(&mut bytes);
        let aligned = Aligned::new(&bytes);
        // Reading in place may begin, whatever the dictionary contains.
        if let Ok(view) = file::view(aligned.bytes()) {
            assert!(view.check().is_err());
            view.contains([0.0; 3]);
        }
        refused(file::from_bytes(&bytes))
    };
    let start = sections[segments].offset as usize;
    let second = number(&bytes, start + 8, 8);
    let all = sections[entries].count;
    assert!(second <= 65_536 && all > 65_537);
    let brick = |brick: u64| format!("Damaged(Dictionary {{ brick: {brick} }})");
    assert_eq!(verdict(start, 1, 8), brick(0));
    assert_eq!(verdict(start + 8, u64::MAX, 8), brick(0));
    assert_eq!(verdict(start + 8, all + 1, 8), brick(0));
    // A segment with too many entries, with one that it does not use, and with one too few.
    assert_eq!(verdict(start + 8, 65_537, 8), brick(0));
    let unused = verdict(start + 8, second + 1, 8);
    assert_eq!(unused, format!("Damaged(DictionaryOrder {{ entry: {second} }})"));
    assert!(verdict(start + 8, second - 1, 8).starts_with("Damaged(Dictionary { brick: "));
    assert_eq!(verdict(start + 8, 0, 8), brick(0));
    // An index leads to an entry of the next segment. This entry exists, but it is not the brick's.
    assert!(second < 65_536);
    assert_eq!(verdict(sections[indices].offset as usize, second, 2), brick(0));
    // Other segment shifts need another number of segments.
    assert_eq!(verdict(69, 16, 1), "Format(Section { name: \"dictionary segments\" })");
    assert_eq!(verdict(69, 63, 1), "Format(Section { name: \"dictionary segments\" })");
    assert_eq!(verdict(69, 18, 1), "Format(Field { name: \"segment shift\", value: 18 })");

    // Smaller segments than the writer's are accepted.
    let smaller = make_vectors::many_bricks_in_small_segments();
    assert_eq!(number(&smaller, 69, 1), 16);
    let back = file::from_bytes(&smaller).unwrap();
    assert!(back == tree && file::to_bytes(&back).unwrap() == bytes);
}

/// A reader may refuse misaligned memory. This refusal says nothing about the bytes.
#[test]
fn alignment_is_no_matter_of_the_file() {
    let bytes = fs::read(vector("valid", "example", "lfl")).unwrap();
    let shifted = Aligned::new(&[&[0; 4][..], &bytes].concat());
    let error = file::view(&shifted.bytes()[4..]).map(|_| ());
    assert!(matches!(error, Err(Error::Format(FormatError::Alignment))));
    file::from_bytes(&shifted.bytes()[4..]).unwrap();
}
