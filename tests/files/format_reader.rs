//! The C reader, written from the specification alone (`format_spec/reader.c`), and the library agree on
//! every file: on the test vectors, on files that the library writes, and on damaged files.
//!
//! Needs a C compiler: `cc`, or the compiler that the environment variable `CC` names.

#![cfg(all(unix, feature = "std"))]

// Its `main` is the program that writes the vectors.
use crate::make_vectors;
use leafless::{Control, Membership, Octree, Proof, Tag, contains, file, file::dexels};
use leafless_testkit::{Random, fuzz};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("format_spec")
}

/// Compiles the reader and returns its command.
fn reader() -> Command {
    static READER: OnceLock<PathBuf> = OnceLock::new();
    let path = READER.get_or_init(|| {
        let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join("reader");
        // (Another test program may be running it.)
        let made = program.with_extension(std::process::id().to_string());
        let compiler = std::env::var_os("CC").unwrap_or("cc".into());
        let compiled = Command::new(compiler)
            .args([
                "-std=c99",
                "-O2",
                "-Wall",
                "-Wextra",
                "-pedantic",
                "-Wstrict-prototypes",
                "-Werror",
                "-o",
            ])
            .arg(&made)
            .arg(folder().join("reader.c"))
            .status()
            .expect("a C compiler is needed: install one, or name it in CC");
        assert!(compiled.success(), "reader.c does not compile");
        std::fs::rename(made, &program).unwrap();
        program
    });
    Command::new(path)
}

/// Runs the reader; returns its output and exit code.
fn run(arguments: &[&str], file: &Path, input: &str) -> (i32, String) {
    let mut child = reader()
        .args(arguments)
        .arg(file)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.stderr.is_empty(), "{}: {}", file.display(), String::from_utf8_lossy(&output.stderr));
    (output.status.code().expect("the reader ends by itself"), String::from_utf8(output.stdout).unwrap())
}

/// The levels of checking, from the weakest to the strictest: the names in the vectors' texts, and the
/// reader's options.
const LEVELS: [(&str, &[&str]); 4] = [
    ("probing", &["--probe"]),
    ("plain", &["--plain"]),
    ("metadata", &["--metadata"]),
    ("verification", &[]),
];

/// Returns the texts beside a folder's vectors, with the vectors' paths.
fn vectors(kind: &str) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder().join("vectors").join(kind)).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "lfl") {
            let text = std::fs::read_to_string(path.with_extension("txt")).unwrap();
            found.push((path, text));
        }
    }
    assert!(found.len() > 20);
    found
}

#[test]
fn it_gives_the_facts_of_every_valid_vector() {
    for (path, text) in vectors("valid") {
        // Facts that a reader cannot know, or need not print.
        let apart =
            ["about", "canonical", "origin-decimal", "edge-decimal", "point", "cut-point", "value", "cell"];
        let facts = text.lines().filter(|line| !apart.contains(&line.split(':').next().unwrap()));
        let (code, printed) = run(&[], &path, "");
        assert_eq!(code, 0, "{}", path.display());
        assert_eq!(printed.lines().collect::<Vec<_>>(), facts.collect::<Vec<_>>(), "{}", path.display());
        for (_, options) in LEVELS {
            assert_eq!(run(options, &path, "").0, 0, "{}", path.display());
        }
        let cells: Vec<Vec<&str>> = text
            .lines()
            .filter_map(|line| Some(line.strip_prefix("cell: ")?.splitn(4, ' ').collect()))
            .collect();
        if !cells.is_empty() {
            let questions: String = cells.iter().map(|words| words[..3].join(" ") + "\n").collect();
            let (code, answers) = run(&["--cells"], &path, &questions);
            let expected: Vec<&str> = cells.iter().map(|words| words[3]).collect();
            assert_eq!((code, answers.lines().collect()), (0, expected), "{}", path.display());
            continue;
        }
        for (key, option) in [("point: ", "--points"), ("cut-point: ", "--cut-points")] {
            let points: Vec<(&str, &str)> =
                text.lines().filter_map(|line| line.strip_prefix(key)?.rsplit_once(' ')).collect();
            let questions: String = points.iter().map(|(point, _)| format!("{point}\n")).collect();
            let (_, answers) = run(&[option], &path, &questions);
            let expected: Vec<&str> = points.iter().map(|(_, answer)| *answer).collect();
            assert_eq!(answers.split_whitespace().collect::<Vec<_>>(), expected, "{}", path.display());
        }
        // Every point of a channel is queried in all channels.
        let channels = text.lines().filter(|line| line.starts_with("channel: ")).count();
        let values: Vec<Vec<&str>> = text
            .lines()
            .filter_map(|line| Some(line.strip_prefix("value: ")?.splitn(4, ' ').collect()))
            .collect();
        let questions: String = values.iter().map(|words| words[..3].join(" ") + "\n").collect();
        let (code, answers) = run(&["--values"], &path, &questions);
        let answers: Vec<&str> = answers.lines().collect();
        assert_eq!((code, answers.len()), (0, values.len() * channels));
        for (words, answers) in values.iter().zip(answers.chunks(channels.max(1))) {
            assert!(answers.contains(&words[3]), "{}: {words:?}, {answers:?}", path.display());
        }
    }
}

#[test]
fn it_refuses_every_invalid_vector_for_the_stated_reason() {
    for (path, text) in vectors("invalid") {
        let fact = |key: &str| text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(": "));
        let weakest = LEVELS.iter().position(|(name, _)| fact("refused-by") == Some(name)).unwrap();
        for (level, (_, options)) in LEVELS.iter().enumerate() {
            let (code, printed) = run(options, &path, "");
            // From the second level on, the length of the file is checked first.
            let rule = match fact("error-of-length") {
                Some(_) if level > 0 => "file-length",
                _ => fact("rule").unwrap(),
            };
            let expected = if level < weakest { (0, None) } else { (1, Some(format!("refused: {rule}\n"))) };
            assert_eq!(code, expected.0, "{} {options:?}: {printed}", path.display());
            if let Some(refusal) = expected.1 {
                assert_eq!(printed, refusal, "{} {options:?}", path.display());
            }
        }
    }
}

/// Coordinates on and beside lattice planes, inside and outside of the universe.
fn points(tree: &Octree, random: &mut Random) -> Vec<[f64; 3]> {
    let frame = tree.frame();
    let mut coordinate = |axis: usize| {
        let cells = frame.cells() as u64 + 2;
        let plane = frame.origin()[axis] + (random.bits() % cells) as f64 * frame.cell_size();
        match random.index(5) {
            0 => plane,
            1 => plane.next_up(),
            2 => plane.next_down(),
            3 => plane + frame.cell_size() / 3.0,
            _ => frame.origin()[axis] + frame.edge() * (random.index(1000) as f64 / 990.0 - 0.005),
        }
    };
    (0..500).map(|_| [0, 1, 2].map(&mut coordinate)).collect()
}

fn tag_name(tag: Tag) -> &'static str {
    match tag {
        Tag::Empty => "EMPTY",
        Tag::Branch => "BRANCH",
        Tag::Partial => "PARTIAL",
        Tag::Full => "FULL",
    }
}

#[test]
fn it_agrees_with_the_library_on_what_the_library_writes() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("tree.lfl");
    let mut random = Random(1);
    for tree in fuzz::seeds::trees() {
        file::save(&tree, &path).unwrap();
        let (code, printed) = run(&[], &path, "");
        assert_eq!(code, 0, "{printed}");
        let all = |key: &str| -> Vec<String> {
            let values = printed.lines().filter_map(|line| line.strip_prefix(key)?.strip_prefix(": "));
            values.map(str::to_string).collect()
        };
        let statistics = tree.statistics();
        let (lower, upper) = statistics.volume_cells();
        assert_eq!(all("cells"), [format!("{lower} {upper}")]);
        assert_eq!(all("depth"), [tree.frame().depth().to_string()]);
        assert_eq!(all("root"), [tag_name(tree.view().root_tag())]);
        assert_eq!(all("exterior"), [tag_name(tree.view().exterior())]);
        assert_eq!(all("elements"), [tree.view().element_count().to_string()]);
        assert_eq!(all("bricks"), [tree.view().brick_count().to_string()]);
        let levels = statistics.levels().iter();
        let levels = levels.map(|l| format!("{} {} {} {}", l.level, l.nodes, l.full, l.partial));
        assert_eq!(all("level"), levels.collect::<Vec<_>>());
        let metadata = tree.metadata().iter().map(|(key, value)| format!("{key}\t{value}"));
        assert_eq!(all("metadata"), metadata.collect::<Vec<_>>());

        let points = points(&tree, &mut random);
        let questions: String = points.iter().map(|[x, y, z]| format!("{x:e} {y:e} {z:e}\n")).collect();
        let (_, answers) = run(&["--points"], &path, &questions);
        let word = |answer: Membership| match answer {
            Membership::Outside => "outside",
            Membership::Inside => "inside",
            Membership::Undecided => "undecided",
        };
        let tags = tree.view().without_cuts();
        let expected = points.iter().map(|&point| word(tags.contains(point)));
        assert_eq!(answers.split_whitespace().collect::<Vec<_>>(), expected.collect::<Vec<_>>());

        // With cuts, intervals leave points undecided that exact signs decide, and only those.
        let (_, answers) = run(&["--cut-points"], &path, &questions);
        let mut expected = vec![Membership::Undecided; points.len()];
        let certified = tree.view().with_proof(Proof::CERTIFIED);
        contains(&certified, tree.frame(), &points, &mut expected, &Control::threads(1)).unwrap();
        let (mut decided, mut open) = (0, 0);
        for ((found, expected), point) in answers.split_whitespace().zip(expected).zip(&points) {
            assert!(found == "undecided" || found == word(expected), "{point:?}: {found}, {expected:?}");
            decided += u32::from(expected != Membership::Undecided);
            open += u32::from(expected != Membership::Undecided && found == "undecided");
        }
        assert!(10 * open <= decided, "{open} of {decided}");
        if let Some(cuts) = tree.view().cuts() {
            let words = all("cuts");
            let numbers: Vec<u64> = words[0].split(' ').map(|word| word.parse().unwrap()).collect();
            assert_eq!(numbers[..4], [cuts.cells, cuts.given_up, cuts.splits, cuts.surfaces]);
        }

        let channels: Vec<_> = (1..).zip(tree.channels()).collect();
        assert_eq!(all("channel").len(), channels.len());
        let (_, answers) = run(&["--values"], &path, &questions);
        let mut answers = answers.lines();
        for &point in points.iter().filter(|_| !channels.is_empty()) {
            for (owner, channel) in &channels {
                let view = channel.view().unwrap();
                let words: Vec<&str> = answers.next().unwrap().split(' ').collect();
                assert_eq!(words[0], owner.to_string());
                let value =
                    view.value_at(point).map(|value| value[..view.value_type().components()].to_vec());
                let found =
                    (words[1] != "none").then(|| words[1..].iter().map(|word| double(word)).collect());
                assert_eq!(found, value, "{point:?}");
            }
        }
        assert_eq!(answers.next(), None);
    }
}

/// A normal number as C prints it with `%a`.
fn double(text: &str) -> f64 {
    let (sign, text) = text.strip_prefix('-').map_or((1.0, text), |text| (-1.0, text));
    let (digits, exponent) = text.strip_prefix("0x").unwrap().split_once('p').unwrap();
    let (lead, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let all = u64::from_str_radix(&format!("{lead}{fraction}"), 16).unwrap() as f64;
    sign * all * 2f64.powi(exponent.parse::<i32>().unwrap() - 4 * fraction.len() as i32)
}

#[test]
fn it_agrees_with_the_library_on_tri_dexel_models() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("model.lfl");
    let mut random = Random(3);
    for seed in 0..60 {
        let form = (0x20..=0xFFu8).filter(|form| form & 6 != 6).nth(random.index(168)).unwrap();
        let mut bytes = make_vectors::dexel_vectors::Dexels::random(seed, 1 + seed as u8 % 4, form).bytes();
        if seed % 2 == 1 {
            // Anywhere but in the header, with right checksums.
            let at = 128 + random.index(bytes.len() - 128);
            bytes[at] = random.bits() as u8;
            make_vectors::seal(&mut bytes);
        }
        std::fs::write(&path, &bytes).unwrap();
        let leaked = Box::leak(Box::new(leafless_testkit::Aligned::new(&bytes))).bytes();
        let expected = [
            file::probe_bytes(leaked).is_ok(),
            dexels::view(leaked).is_ok(),
            dexels::from_static(leaked).is_ok(),
            file::verify(leaked).is_ok(),
        ];
        for ((name, options), expected) in LEVELS.iter().zip(expected) {
            let (code, printed) = run(options, &path, "");
            assert_eq!(code == 0, expected, "seed {seed}, {name}: {printed}");
        }
        let Ok(model) = dexels::from_bytes(&bytes) else { continue };
        let (_, printed) = run(&[], &path, "");
        let mut lines = printed.lines().filter_map(|line| line.strip_prefix("interval: "));
        let (origin, size) = (model.frame().origin(), model.frame().cell_size());
        for rays in (0..3).filter_map(|axis| model.view().rays(axis)) {
            let [us, vs] = rays.window();
            for (v, u) in vs.flat_map(|v| us.clone().map(move |u| (v, u))) {
                for dexel in rays.dexels([u, v]) {
                    let words: Vec<&str> = lines.next().unwrap().split(' ').collect();
                    assert_eq!(
                        [words[0], words[1], words[2]],
                        [rays.axis() as u32, u, v].map(|n| n.to_string())
                    );
                    for (word, end) in words[3..].iter().zip([dexel.start, dexel.end]) {
                        assert_eq!(Some(double(word)), end.cells);
                        let along = double(word) * size;
                        let off = (origin[rays.axis()] + along - end.at).abs();
                        assert!(off <= 2.0 * f64::EPSILON * (end.at.abs() + along));
                    }
                    let material = words[5..].last().filter(|_| model.view().format().materials);
                    assert_eq!(material.map_or(0, |word| word.parse().unwrap()), dexel.material);
                }
            }
        }
        assert_eq!(lines.next(), None);
    }
}

/// Returns whether the library accepts a file at each of the four levels. The bytes stay alive until the test
/// ends.
fn accepted(bytes: &[u8]) -> [bool; 4] {
    let bytes = Box::leak(Box::new(leafless_testkit::Aligned::new(bytes))).bytes();
    [
        file::probe_bytes(bytes).is_ok(),
        file::view(bytes).is_ok(),
        file::from_static(bytes).is_ok(),
        file::verify(bytes).is_ok(),
    ]
}

#[test]
fn it_accepts_and_refuses_damaged_files_as_the_library_does() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("tree.lfl");
    let seeds = fuzz::seeds::files();
    let mut refused = [0; 4];
    for round in 0..400u32 {
        let mut bytes = seeds[round as usize % seeds.len()].clone();
        let length = bytes.len();
        let most = length + 512;
        bytes.resize(most, 0);
        let length = fuzz::mutate_file(&mut bytes, length, most, round, &mut |bytes, size, _| {
            bytes[round as usize % size] ^= 1 << (round % 8);
            size
        });
        bytes.truncate(length);
        std::fs::write(&path, &bytes).unwrap();
        let expected = accepted(&bytes);
        for (level, (name, options)) in LEVELS.iter().enumerate() {
            let (code, printed) = run(options, &path, "");
            assert_eq!(code == 0, expected[level], "seed {round}, {name}: {printed}");
            refused[level] += (code != 0) as u32;
        }
    }
    // The damage reaches every level.
    assert!(
        refused[0] > 0 && refused[0] < refused[1] && refused[1] < refused[3] && refused[3] < 400,
        "{refused:?}"
    );
}
