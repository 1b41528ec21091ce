//! Unexpected command lines: options of each subcommand in any number and order, with values that fit, nearly
//! fit or do not fit, on good, damaged and missing files. Each run ends by itself with code 0, 1 or 2,
//! reports a problem in one line, and leaves no temporary file.

use crate::place::{Place, Run, block, stl};
use leafless_testkit::Random;
use std::collections::BTreeMap;
use std::io::Write;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Numbers of runs in the default suite, and in the long one.
const FEW: u64 = 400;
const MANY: u64 = 7000;
/// Time after which a hanging command is ended.
const PATIENCE: Duration = Duration::from_secs(100);

/// Returns one of some words.
fn one<'a>(random: &mut Random, of: &[&'a str]) -> &'a str {
    of[random.index(of.len())]
}

/// An option of a subcommand, with the values that its help names.
#[derive(Debug)]
struct Choice {
    name: String,
    takes_value: bool,
    values: Vec<String>,
}

/// Returns all subcommands with their options, as listed by the program's help.
fn subcommands(place: &Place) -> BTreeMap<String, Vec<Choice>> {
    place
        .commands()
        .into_iter()
        .filter(|name| name != "help" && name != "demo")
        .map(|name| (name.clone(), choices(place, &name)))
        .collect()
}

fn choices(place: &Place, name: &str) -> Vec<Choice> {
    let help = place.run(&format!("{name} --help")).good();
    let mut found: Vec<Choice> = vec![];
    let options = help.text().split("Details:").next().unwrap();
    for line in options.lines() {
        // Help texts are indented further than the options.
        let is_option = !line.starts_with("          ");
        let line = line.trim_start();
        if let Some(option) =
            line.split(' ').find(|word| word.starts_with("--")).filter(|_| is_option && line.starts_with('-'))
        {
            let value = line.split_once(option).is_some_and(|(_, rest)| rest.trim_start().starts_with('<'));
            found.push(Choice {
                name: option.trim_end_matches(',').into(),
                takes_value: value,
                values: vec![],
            });
        }
        let Some(last) = found.last_mut() else { continue };
        if let Some((value, _)) = line.strip_prefix("- ").and_then(|rest| rest.split_once(':')) {
            last.values.push(value.into());
        }
        if let Some(list) = line.split_once("[possible values: ").and_then(|(_, rest)| rest.strip_suffix(']'))
        {
            last.values.extend(list.split(", ").map(str::to_owned));
        }
    }
    found.retain(|choice| !["--help", "--version", "--max-memory", "--show"].contains(&&*choice.name));
    found
}

/// Small files of every kind, good and damaged ones.
fn files(place: &Place) -> Vec<String> {
    let mut names: Vec<String> = vec![];
    place.write("cube.stl", stl(&block([1.0; 3], [3.0; 3])));
    place.write("ball.csg", "sphere(1, $fn = 0);");
    place.write("part.csg", "difference() { cube([2, 2, 2]); multmatrix([[1,0,0,1],[0,1,0,1],[0,0,1,0],[0,0,0,1]]) { cylinder(h = 2, r1 = 0.5, r2 = 0.5); } }");
    place.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
    place.write("square.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
    place.write(
        "grid.nrrd",
        b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n\0\xFF\0\xFF\xFF\0\0\xFF",
    );
    place.write("samples.raw", [0u8; 64]);
    for line in [
        "voxelize cube.stl -o cube.lfl --depth 4",
        "csg ball.csg -o ball.lfl --depth 4",
        "csg ball.csg -o sampled.lfl --depth 5 --rule sampled",
        "attribute ball.lfl -o values.lfl --name heat --expr x",
        "dexelize ball.csg -o ball.dex.lfl --resolution 16 --normals 32",
        "mesh ball.lfl -o ball.ply --resolve outer",
        "mesh ball.lfl -o ball.3mf --resolve outer",
        "voxels ball.lfl -o ball.npz",
    ] {
        let run = place.run(line);
        assert_eq!(run.code, Some(0), "{run:?}");
    }
    for name in place.files() {
        let bytes = place.bytes(&name);
        names.push(name.clone());
        // Cut in the middle, and with a byte changed.
        let extension = name.rsplit_once('.').unwrap().1;
        let stem = name.replace('.', "-");
        place.write(&format!("{stem}-cut.{extension}"), &bytes[..bytes.len() / 2]);
        let mut changed = bytes.clone();
        let at = changed.len() / 3;
        changed[at] ^= 0x55;
        place.write(&format!("{stem}-changed.{extension}"), &changed);
        names.extend([format!("{stem}-cut.{extension}"), format!("{stem}-changed.{extension}")]);
    }
    place.write("empty", "");
    names.extend(["empty", "nothing.lfl", ".", "-", "/dev/null"].map(str::to_owned));
    names
}

/// Values for all kinds of options.
const VALUES: [&str; 46] = [
    "0",
    "1",
    "2",
    "3",
    "5",
    "8",
    "20",
    "21",
    "-1",
    "255",
    "4294967296",
    "18446744073709551616",
    "0.5",
    "1e-9",
    "1e300",
    "-0",
    "nan",
    "inf",
    "-inf",
    "",
    " ",
    "x",
    "x+y*z",
    "1/0",
    "sqrt(-x)",
    "0,0,0,1",
    "0,0,0,8",
    "-1,-1,-1,2",
    "0,0,0,0",
    "0,0,0,nan",
    "1e9,0,0,1e-9",
    "0,0,0,1,1,1",
    "1,1,1,0,0,0",
    "1,0,0,0,0,1,0,0,0,0,1,0",
    "0,0,1",
    "0,0,1,0.5",
    "2,2,2",
    "100000,100000,100000",
    "64x64",
    "0x0",
    "1x1",
    "100000x100000",
    "#ff8800",
    "mm",
    "heat",
    "name=left",
];

/// Values that fit certain options.
const FITTING: [(&str, &str); 33] = [
    ("--bounds", "-2,-2,-2,4"),
    ("--threads", "1"),
    ("--threshold", "0.5"),
    ("--unit", "mm"),
    ("--scale", "2"),
    ("--translate", "0.5,0,-1"),
    ("--rotate", "1,1,0,30"),
    ("--place", "0,-1,0,0.5,1,0,0,0,0,0,1,0"),
    ("--tolerance", "0.01"),
    ("--splits", "1000"),
    ("--level", "2"),
    ("--resolution", "16"),
    ("--size", "40x30"),
    ("--boundary-depth", "2"),
    ("--coarse", "0.5"),
    ("--fine", "0.25"),
    ("--channel", "heat"),
    ("--name", "heat"),
    ("--expr", "x + 2*y"),
    ("--ball", "0,0,0,1"),
    ("--box", "0,0,0,1,1,1"),
    ("--axis", "z"),
    ("--samples", "4,4,4"),
    ("--spacing", "0.5"),
    ("--clip", "1,0,0,0.2"),
    ("--place-b", "1,0,0,0.5,0,1,0,0,0,0,1,0"),
    ("--carry", "heat=max"),
    ("--clearance", "0.1"),
    ("--wall-clearance", "0.1"),
    ("--objective", "balance=0,0,0"),
    ("--orientations", "free:3"),
    ("--free-along", "+z"),
    ("--rounds", "1"),
];

/// Options that a subcommand requires.
const NEEDED: [(&str, &str); 6] = [
    ("heights", "--axis z"),
    ("within", "--ball 0.2,0,0,0.9"),
    ("attribute", "--name warm --expr 2*x"),
    ("sample", "--name heat"),
    ("summary", "--name heat"),
    ("dexelize", "--resolution 16"),
];

/// Returns a random command line, without the program's name.
fn line(random: &mut Random, name: &str, choices: &[Choice], files: &[String]) -> Vec<String> {
    let file = |random: &mut Random| files[random.index(files.len())].clone();
    let mut words = vec![name.to_owned()];
    let pairs = ["union", "intersection", "difference", "xor", "interfere", "deviation", "layout"];
    let operands = if pairs.contains(&name) { 2 } else { 1 };
    for _ in 0..operands + random.index(12) / 11 {
        words.push(file(random));
    }
    for (_, needed) in NEEDED.iter().filter(|(of, _)| *of == name && random.index(8) > 0) {
        words.extend(needed.split(' ').map(str::to_owned));
    }
    if choices.iter().any(|choice| choice.name == "--output") && random.index(8) > 0 {
        let extension = match name {
            "render" => "out.png",
            "mesh" => "out.stl",
            "bitmap" => "out.nrrd",
            "voxels" => "out.npz",
            "layout" => "out.json",
            _ => "out.lfl",
        };
        let names = [
            extension,
            extension,
            extension,
            extension,
            extension,
            extension,
            extension,
            extension,
            "out.lfl",
            "out.ply",
            "out.stl",
            "out.obj",
            "out.off",
            "out.3mf",
            "out.png",
            "out.npz",
            "out.csv",
            "out.nrrd",
            "out.raw",
            "out",
            "-",
            "no/folder.lfl",
            "/dev/full",
        ];
        words.extend(["-o".to_owned(), one(random, &names).to_owned()]);
    }
    if choices.iter().any(|choice| choice.name == "--depth") && random.index(3) > 0 {
        words.extend(["--depth".to_owned(), (1 + random.index(5)).to_string()]);
    }
    // Most lines have few options.
    for _ in 0..random.index(4) * random.index(2) {
        let Some(choice) = choices.get(random.index(choices.len().max(1))) else { break };
        if choice.name == "--output" || choice.name == "--depth" {
            continue;
        }
        words.push(choice.name.clone());
        if choice.takes_value && random.index(20) > 0 {
            let fitting = FITTING.iter().find(|(of, _)| *of == choice.name);
            words.push(match (random.index(8), fitting) {
                (0, _) => file(random),
                (1..=6, _) if !choice.values.is_empty() => {
                    choice.values[random.index(choice.values.len())].clone()
                }
                (1..=6, Some((_, value))) => (*value).to_owned(),
                _ => one(random, &VALUES).to_owned(),
            });
        }
    }
    // Sometimes in another order.
    if random.index(16) == 0 && words.len() > 2 {
        let (a, b) = (1 + random.index(words.len() - 1), 1 + random.index(words.len() - 1));
        words.swap(a, b);
    }
    words
}

fn run(place: &Place, words: &[String], input: &str) -> Run {
    let told = words.join(" ");
    let mut command: Command = place.command(words);
    command.args(["--max-memory", "512M"]);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let start = Instant::now();
    let mut child = command.spawn().unwrap();
    let id = child.id();
    // (The program may not read its input.)
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    let (sender, receiver) = std::sync::mpsc::channel();
    let waiting = std::thread::spawn(move || {
        let output = child.wait_with_output();
        let _ = sender.send(());
        output
    });
    if receiver.recv_timeout(PATIENCE).is_err() {
        let _ = Command::new("kill").args(["-9", &id.to_string()]).status();
        panic!("{told}: no end after {:?}", start.elapsed());
    }
    if start.elapsed() > Duration::from_secs(10) {
        eprintln!("SLOW {told}: {:?}", start.elapsed());
    }
    Run::new(&told, waiting.join().unwrap().unwrap())
}

fn attack(seed: u64, runs: u64) {
    let place = Place::new();
    let (subcommands, files) = (subcommands(&place), files(&place));
    assert!(subcommands.len() > 20 && files.len() > 40);
    let names: Vec<&String> = subcommands.keys().collect();
    let mut random = Random(seed);
    let mut codes = [0; 3];
    for _ in 0..runs {
        let name = names[random.index(names.len())];
        let words = line(&mut random, name, &subcommands[name], &files);
        let input = one(
            &mut random,
            &["", "0 0 0\n", "1 2 3 0 0 1\n", "1 0 0 0\n", "nan nan nan\n", "x\n\n0 0 0\n", "0,0,0"],
        );
        let done = run(&place, &words, input);
        let code = done.code.unwrap_or(-1);
        assert!((0..=2).contains(&code), "{done:?}");
        codes[code as usize] += 1;
        let mut lines =
            done.errors.lines().filter(|line| !line.contains(": warning: ") && !line.contains(": note: "));
        assert!(!done.errors.contains("panicked") && !done.errors.contains("os error"), "{done:?}");
        if code != 0 {
            // The last line gives the reason.
            assert!(
                lines.next_back().is_some_and(|line| line.starts_with("leafless: ") && line.len() > 20),
                "{done:?}"
            );
        }
        let left = place.files().into_iter().find(|name| name.starts_with('.') || name.ends_with(".tmp"));
        assert!(left.is_none(), "{left:?} after {done:?}");
    }
    println!("{codes:?} ended with the codes 0, 1 and 2");
    // The lines are moderate enough that some succeed.
    assert!(codes.iter().all(|&count| count > runs / 50), "{codes:?}");
}

#[test]
fn wild_command_lines_end_with_a_sentence() {
    attack(1, FEW);
}

/// Takes minutes: `--test program command_lines:: -- --ignored`. `LEAFLESS_SEED` chooses other lines.
#[test]
#[ignore = "minutes"]
fn thousands_of_command_lines() {
    let seed = std::env::var("LEAFLESS_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(2);
    attack(seed, MANY);
}
