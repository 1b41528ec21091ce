//! The subcommand `leafless ray`, from outside.

use crate::place::{Place, Run, solids};
use leafless::query::Obstacle;
use leafless::{Ray, exchange, file};
use leafless_testkit::Random;
use serde_json::Value;
use std::io::{Read, Write};
use std::process::Stdio;

/// Returns the numbers on each line; `None` for the line of a miss.
fn hits(run: &Run) -> Vec<Option<Vec<f64>>> {
    let line = |line: &str| (line != "miss").then(|| line.split(' ').map(|x| x.parse().unwrap()).collect());
    run.text().lines().map(line).collect()
}

#[test]
fn line_by_line() {
    let place = solids();
    let rays =
        b"# through, beside, from inside\n0 2 2 1 0 0\n\n0,5,2,1,0,0\r\n2\t2\t2\t0\t0\t-3\n 9 2 , 2  -2 0 0";
    let run = place.run_with("ray cube.lfl", rays).good();
    assert_eq!(run.text(), "1 1 -1 0 0\nmiss\n0 0 0 0 0\n3 3 1 0 0\n");
    assert_eq!(place.run_with("ray cube.lfl --on full", rays).good().text(), run.text());
    assert_eq!(place.run("ray cube.lfl").good().text(), "");
    for (input, number, found) in [
        ("0 2 2 1 0 0\n1 2 3\n0 2 2 1 0 0\n", 2, "expected six numbers, found \"1 2 3\""),
        ("0 2 2 1 0 0\n\n# x\n0 2 2 0 0 0\n", 4, "direction: must not be zero"),
        ("0 2 2 1 0 0\nnan 2 2 1 0 0", 2, "origin: every number"),
        ("0 2 2 1 0 0\n0 2 2 1 inf 0", 2, "direction: every number"),
    ] {
        let run = place.run_with("ray cube.lfl", input.as_bytes());
        assert_eq!((run.code, run.text()), (Some(1), "1 1 -1 0 0\n"), "{run:?}");
        let start = format!("leafless: standard input: line {number}: {found}");
        assert!(run.errors.starts_with(&start) && run.errors.lines().count() == 1, "{run:?}");
    }
}

#[test]
fn json_lines() {
    let place = solids();
    let run = place.run_with("ray cube.lfl --json", b"0 2 2 1 0 0\n0 5 2 1 0 0\n").good();
    let lines: Vec<Value> = run.text().lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 2);
    assert_eq!(lines[1], Value::Null);
    let hit = &lines[0];
    assert_eq!((&hit["t_lower"], &hit["t_upper"]), (&1.0.into(), &1.0.into()));
    assert_eq!(hit["normal"], serde_json::json!([-1.0, 0.0, 0.0]));
    // The cube is 2 of 8 units long, at least a cell on every level from the second on.
    let (level, cell) = (hit["level"].as_u64().unwrap(), hit["cell"][0].as_u64().unwrap());
    assert_eq!(cell << (5 - level), 4, "{hit}");
}

/// A closed mesh answers directly, and reports the triangle. Cells have no triangle.
#[test]
fn triangles_of_meshes() {
    let place = solids();
    let rays = b"0 3.25 1.5 1 0 0\n0 7 1 1 0 0\n3 3 1 1 0 0\n3.25 3.5 9 0 0 -2\n";
    let mesh = exchange::read_stl(&std::fs::read(place.path("slab.stl")).unwrap()).unwrap();
    for on in ["upper", "full"] {
        let run = place.run_with(&format!("ray slab.stl --json --on {on}"), rays).good();
        let lines: Vec<Value> = run.text().lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        assert_eq!(lines.len(), 4);
        for (line, axis, plane, normal) in [(0, 0, 2.0, -1.0), (3, 2, 2.0, 1.0)] {
            let surface = lines[line]["surface"].as_u64().expect("a triangle") as usize;
            let corners = mesh.triangles()[surface].map(|v| mesh.vertices()[v as usize]);
            assert!(corners.iter().all(|corner| corner[axis] == plane), "{}", lines[line]);
            assert_eq!(lines[line]["normal"][axis], normal);
        }
        assert_eq!(lines[1], Value::Null);
        assert_eq!(lines[2]["surface"], Value::Null);
    }
    let run = place.run_with("ray cube.lfl --json", b"0 2.25 1.5 1 0 0\n").good();
    assert_eq!(run.json()["surface"], Value::Null);
}

/// Meshes and scenes are split as deep as needed. A hit that may be a miss has no upper bound.
#[test]
fn meshes_and_scenes() {
    let place = solids();
    place.write("ball.csg", "sphere(r = 2, $fn = 0);");
    for (line, rays, wanted) in [
        ("ray cube.stl", "0 2.1 1.7 1 0 0\n0 3.5 2 1 0 0\n", 1.0),
        ("ray ball.csg", "-5 0.3 0.4 1 0 0\n-5 2.1 0 1 0 0\n", 5.0 - 3.75f64.sqrt()),
        (
            "ray ball.csg --bounds -3,-3,-3,6 --threads 1",
            "-5 0.3 0.4 1 0 0\n-5 2.1 0 1 0 0\n",
            5.0 - 3.75f64.sqrt(),
        ),
        ("ray ball.csg --depth 9 --on full", "-5 0.3 0.4 1 0 0\n-5 2.1 0 1 0 0\n", 5.0 - 3.75f64.sqrt()),
    ] {
        let run = place.run_with(line, rays.as_bytes()).good();
        let found = hits(&run);
        assert_eq!(found.len(), 2, "{run:?}");
        let first = found[0].as_ref().expect(line);
        assert!(first[0] <= wanted && wanted <= first[1] && first[1] - first[0] < 1e-4, "{run:?}");
        assert!(first[2] < -0.9 && found[1].is_none(), "{run:?}");
    }
    // Without a split, nothing about a ball is proven.
    let few = place.run_with("ray ball.csg --splits 0", b"-5 0.3 0.4 1 0 0\n").good();
    assert!(few.text().contains(" inf "), "{few:?}");
    let few = place.run_with("ray ball.csg --splits 0 --json", b"-5 0.3 0.4 1 0 0\n").good();
    assert_eq!(few.json()["t_upper"], Value::Null);
    assert_eq!(
        place.run_with("ray ball.csg --splits 0 --on full", b"-5 0.3 0.4 1 0 0\n").good().text(),
        "miss\n"
    );
}

/// A sampled solid proves nothing. With the option, its cells are the solid.
#[test]
fn cells_that_prove_nothing() {
    let place = solids();
    place.run("voxelize cube.stl -o sampled.lfl --depth 5 --bounds 0,0,0,8 --rule sampled").good();
    let ray = b"0 2 2 1 0 0\n";
    assert_eq!(place.run_with("ray sampled.lfl --on full", ray).good().text(), "miss\n");
    assert!(place.run_with("ray sampled.lfl", ray).good().text().contains(" inf "));
    assert_eq!(place.run_with("ray sampled.lfl --cells", ray).good().text(), "1 1 -1 0 0\n");
}

fn many(place: &Place, count: usize) {
    let slab = file::open(place.path("slab.lfl")).unwrap();
    let mut random = Random(7);
    let rays: Vec<[f64; 6]> = (0..count).map(|_| [0; 6].map(|_| random.between(-4.0, 8.0))).collect();
    let text: String = rays
        .iter()
        .map(|[x, y, z, dx, dy, dz]| format!("{x:?} {y:?} {z:?} {dx:?} {dy:?} {dz:?}\n"))
        .collect();
    let run = place.run_with("ray slab.lfl", text.as_bytes()).good();
    let found = hits(&run);
    assert_eq!(found.len(), rays.len());
    let mut met = 0;
    for ([x, y, z, dx, dy, dz], found) in rays.into_iter().zip(found) {
        let ray = Ray::new([x, y, z], [dx, dy, dz]).unwrap();
        let wanted = slab.cast_ray(&ray, Obstacle::Upper).map(|hit| {
            let [x, y, z] = hit.normal;
            vec![hit.t.lower, hit.t.upper, x, y, z]
        });
        assert_eq!(found, wanted);
        met += wanted.is_some() as usize;
    }
    assert!(met > count / 20, "{met}");
}

#[test]
fn agrees_with_the_library() {
    many(&solids(), 30_000);
}

/// A million rays in bounded memory.
#[test]
#[ignore = "takes ten seconds"]
fn agrees_with_the_library_on_a_million_rays() {
    many(&solids(), 1_000_000);
}

#[test]
fn answers_while_the_asker_waits() {
    let place = solids();
    let mut command = place.command(["ray", "cube.lfl"]);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let (mut stdin, mut stdout) = (child.stdin.take().unwrap(), child.stdout.take().unwrap());
    for _ in 0..3 {
        stdin.write_all(b"0 2 2 1 0 0\n0 5").unwrap();
        let mut answer = [0; 11];
        stdout.read_exact(&mut answer).unwrap();
        assert_eq!(&answer, b"1 1 -1 0 0\n");
        stdin.write_all(b" 2 1 0 0\n").unwrap();
        let mut answer = [0; 5];
        stdout.read_exact(&mut answer).unwrap();
        assert_eq!(&answer, b"miss\n");
    }
    drop(stdin);
    assert!(child.wait().unwrap().success());
}
