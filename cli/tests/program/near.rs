//! The subcommands `leafless distance` and `leafless neighbours`, from outside.

use crate::place::{Place, Run, solids};
use leafless::octree::{Cursor, Direction};
use leafless::query::DistanceTo;
use leafless::{Tag, file};
use leafless_testkit::Random;
use serde_json::{Value, json};

/// Returns the numbers on each line.
fn intervals(run: &Run) -> Vec<[f64; 2]> {
    let line = |line: &str| {
        let numbers: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
        [numbers[0], numbers[1]]
    };
    run.text().lines().map(line).collect()
}

fn random(count: usize) -> Vec<[f64; 3]> {
    let mut random = Random(7);
    (0..count).map(|_| [0; 3].map(|_| random.between(-4.0, 8.0))).collect()
}

fn lines(points: &[[f64; 3]]) -> String {
    points.iter().map(|[x, y, z]| format!("{x:?} {y:?} {z:?}\n")).collect()
}

#[test]
fn distances_line_by_line() {
    // The cube [1, 3]³.
    let place = solids();
    let points = b"# outside, inside, at a corner\n0 2 2\n\n2,2,1.75\r\n4\t5\t3\n-1 2 , 2";
    let wanted = |options: &str, wanted: [f64; 4]| {
        let run = place.run_with(&format!("distance cube.lfl {options}"), points).good();
        let found = intervals(&run);
        assert_eq!(found.len(), 4);
        for ([lower, upper], wanted) in found.into_iter().zip(wanted) {
            assert!(lower <= wanted && wanted <= upper && upper - lower < 1e-12, "{options}: {run:?}");
        }
    };
    wanted("", [1.0, 0.0, 5f64.sqrt(), 2.0]);
    wanted("--target complement", [0.0, 0.75, 0.0, 0.0]);
    wanted("--signed", [1.0, -0.75, 5f64.sqrt(), 2.0]);
    wanted("--target boundary --depth 5", [1.0, -0.75, 5f64.sqrt(), 2.0]);
    assert_eq!(place.run("distance cube.lfl").good().text(), "");
    let run = place.run_with("distance cube.lfl", b"1 1 1\n1 2\n");
    assert_eq!((run.code, run.text().lines().count()), (Some(1), 1), "{run:?}");
    assert!(run.errors.contains("line 2: expected three numbers, found \"1 2\""), "{run:?}");
    let json = place.run_with("distance cube.lfl --json", b"2 2 2\nnan 0 0\n").good();
    let lines: Vec<Value> = json.text().lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines, [json!({"lower": 0.0, "upper": 0.0}), json!({"lower": 0.0, "upper": null})]);
    place.run("distance - --signed").bad(2, &["standard input carries the points"]);
    place.run("distance cube.lfl --signed --target solid").bad(2, &["--signed", "--target"]);
    place.run("distance cube.lfl --tolerance -1").bad(2, &["not below 0"]);
}

#[test]
fn distances_agree_with_the_library() {
    let place = solids();
    let slab = file::open(place.path("slab.lfl")).unwrap();
    let points = random(20_000);
    let run = place.run_with("distance slab.lfl --signed", lines(&points).as_bytes()).good();
    let found = intervals(&run);
    assert_eq!(found.len(), points.len());
    for (point, [lower, upper]) in points.into_iter().zip(found) {
        let wanted = slab.distance(point, DistanceTo::Boundary).unwrap();
        assert_eq!([lower, upper], [wanted.lower, wanted.upper]);
    }
}

/// For meshes and scenes, cells are split until the distance is known to the tolerance.
#[test]
fn distances_from_meshes_and_scenes() {
    let place = solids();
    place.write("ball.csg", "sphere(r = 2, $fn = 0);");
    let points = lines(&[[3.0, 0.0, 4.0], [0.5, 0.2, 0.1]]);
    for (options, width) in [("", 1e-5), ("--tolerance 1e-9", 1e-9), ("--tolerance 0.1 --depth 9", 0.1)] {
        let run = place.run_with(&format!("distance ball.csg --signed {options}"), points.as_bytes()).good();
        for ([lower, upper], wanted) in intervals(&run).into_iter().zip([3.0, 0.3f64.sqrt() - 2.0]) {
            assert!(lower <= wanted && wanted <= upper && upper - lower <= width, "{options}: {run:?}");
        }
    }
    let run = place.run_with("distance cube.stl", b"0 2 2\n").good();
    let [lower, upper] = intervals(&run)[0];
    assert!(lower <= 1.0 && 1.0 <= upper && upper - lower < 1e-4, "{run:?}");
    // Without a split, nothing about a ball is proven.
    let run = place.run_with("distance ball.csg --splits 0", points.as_bytes()).good();
    assert!(run.text().lines().all(|line| line.ends_with(" inf")), "{run:?}");
}

#[test]
fn neighbours_line_by_line() {
    let place: Place = solids();
    let octree = file::open(place.path("cube.lfl")).unwrap();
    // A cell of each tag, by the library.
    let cells: Vec<_> =
        octree.view().cells(leafless::octree::CellFilter::tags(&[Tag::Full, Tag::Branch])).collect();
    let input: String = (cells.iter().map(|found| (found.cell.level, found.cell.at)))
        .map(|(level, [x, y, z])| format!("{level} {x} {y} {z}\n"))
        .collect();
    for (through, count) in [("faces", 6), ("edges", 18), ("vertices", 26)] {
        for smaller in [false, true] {
            let options = format!("--through {through} {}", if smaller { "--smaller" } else { "" });
            let run = place.run_with(&format!("neighbours cube.lfl {options}"), input.as_bytes()).good();
            let json =
                place.run_with(&format!("neighbours cube.lfl --json {options}"), input.as_bytes()).good();
            let mut cursor = Cursor::new(octree.view());
            let mut told = run.text().lines();
            for (found, line) in cells.iter().zip(json.text().lines()) {
                cursor.seek(found.cell).unwrap();
                let mut wanted = Vec::new();
                for &direction in &Direction::ALL[..count] {
                    let mut tell = |found: leafless::octree::TaggedCell| {
                        let [dx, dy, dz] = direction.steps();
                        let ([x, y, z], level) = (found.cell.at, found.cell.level);
                        let tag = format!("{:?}", found.tag).to_lowercase();
                        wanted.push(format!("{dx} {dy} {dz} {tag} {level} {x} {y} {z}"));
                    };
                    if smaller {
                        cursor.neighbours(direction).for_each(&mut tell);
                    } else {
                        cursor.neighbour(direction).into_iter().for_each(&mut tell);
                    }
                }
                // An empty line ends an answer. The universe's answer is empty.
                let answer: Vec<&str> = told.by_ref().take_while(|line| !line.is_empty()).collect();
                assert_eq!(answer, wanted);
                let line: Vec<Value> = serde_json::from_str(line).unwrap();
                assert_eq!(line.len(), wanted.len());
            }
        }
    }
    let one = place.run_with("neighbours cube.lfl --json", b"1 0 0 0\n").good();
    assert_eq!(one.json()[0]["level"], 1);
    for (input, problem) in [
        ("1 0 0\n", "expected four numbers"),
        ("1 0 0 0.5\n", "whole numbers"),
        ("-1 0 0 0\n", "whole numbers"),
        ("nan 0 0 0\n", "whole numbers"),
        ("1 2 0 0\n", "lies outside of the universe"),
        ("300 0 0 0\n", "finer than the finest cells"),
        ("5 0 0 0\n", "there is no such cell"),
    ] {
        let run = place.run_with("neighbours cube.lfl", input.as_bytes());
        assert!(run.code == Some(1) && run.text().is_empty(), "{run:?}");
        assert!(run.errors.contains("line 1: ") && run.errors.contains(problem), "{run:?}");
    }
    place.run("neighbours -").bad(2, &["standard input carries the cells"]);
    place.run_with("neighbours slab.stl", b"0 0 0 0\n").bad(1, &["slab.stl"]);
}
