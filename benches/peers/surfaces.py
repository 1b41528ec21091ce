"""Surfaces beside those of OpenSCAD, Manifold, fidget and OpenVDB, in one run; see benches/README.md.

    pip install manifold3d
    python benches/peers/surfaces.py LEAFLESS PLATE VOLUME_TO_MESH MODEL...

LEAFLESS is the program, PLATE that of benches/peers/src/bin/plate.rs, VOLUME_TO_MESH that of volume_to_mesh.cpp. Round faces of OpenSCAD
and Manifold have as many sides as the deviation asks for. How far a mesh is from the solid, `leafless deviation` says of all of them.
"""

import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from manifold3d import Manifold

PLATE = "difference() { cube([80, 60, 10]); translate([40, 30, -1]) cylinder(r = 5, h = 12, $fn = %d); }"
RUNS = 5

program, plate, volume_to_mesh, *models = [str(pathlib.Path(path).resolve()) for path in sys.argv[1:]]


def said(*command):
    """What a program says on standard output, and the seconds it takes."""
    start = time.perf_counter()
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if not done.stdout.strip() and done.returncode != 0:
        raise SystemExit(done.stderr)
    return done.stdout, time.perf_counter() - start


def leafless(*arguments):
    return json.loads(said(program, *arguments, "--json")[0])


def apart(solid, mesh, tolerance):
    """The interval of the distance between the boundary of a solid and a mesh."""
    found = leafless("deviation", solid, mesh, "--tolerance", str(tolerance))
    return found["lower"], found["upper"]


def median(run):
    """The median of the seconds that `run` returns first, and the rest of the last time."""
    found = [run() for _ in range(RUNS)]
    return statistics.median(one[0] for one in found), *found[-1][1:]


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


def milliseconds(seconds):
    return f"{1e3 * seconds:.3g}"


def by_leafless(*arguments):
    start = time.perf_counter()
    told = leafless("mesh", *arguments)
    return time.perf_counter() - start, told["triangles"], told.get("deviation")


def by_manifold(sides):
    start = time.perf_counter()
    cutter = Manifold.cylinder(12, 5, circular_segments=sides).translate([40, 30, -1])
    made = Manifold.cube([80, 60, 10]) - cutter
    return made.num_tri(), time.perf_counter() - start


def of_plate(folder):
    row("plate", "triangles", "ms", "deviation, of 80")
    row("---", "---:", "---:", "---:")
    exact = folder / "exact.csg"
    exact.write_text(PLATE % 0)
    for part in [1e-3, 1e-4, 1e-5]:
        most = 80 * part
        sides = math.ceil(math.pi / math.acos(1 - most / 5))
        out = str(folder / "plate.ply")
        seconds, triangles, proven = median(lambda: by_leafless(str(exact), "-o", out, "--tolerance", str(most)))
        row(f"Leafless, {part:.0e}", triangles, milliseconds(seconds), f"≤ {proven / 80:.1e}, proven")
        triangles, seconds = by_manifold(sides)
        seconds = statistics.median(by_manifold(sides)[1] for _ in range(RUNS))
        chord = 5 * (1 - math.cos(math.pi / sides)) / 80
        row(f"Manifold, {sides} sides", triangles, milliseconds(seconds), f"{chord:.1e} by its sides")
        scad, off = folder / "sides.scad", folder / "sides.off"
        scad.write_text(PLATE % sides)
        seconds = statistics.median(said("openscad", str(scad), "-o", str(off))[1] for _ in range(3))
        triangles = leafless("info", str(off))["mesh"]["triangles"]
        row(f"OpenSCAD, {sides} sides", triangles, milliseconds(seconds), f"{chord:.1e} by its sides")
    for depth in [5, 6, 7, 8]:
        stl = str(folder / "fidget.stl")
        told = [said(plate, str(depth), stl)[0].split() for _ in range(RUNS)]
        seconds = statistics.median(float(one[0]) for one in told)
        low, high = apart(str(exact), stl, 0.05)
        row(f"fidget, depth {depth}", told[0][1], milliseconds(seconds), f"{low / 80:.1e} to {high / 80:.1e}")


def of_model(folder, model):
    info = leafless("info", model)
    size = max(high - low for low, high in zip(info["min"], info["max"]))
    off, out = str(folder / "model.off"), str(folder / "out.off")
    leafless("convert", model, "-o", off)
    row(pathlib.Path(model).name, "triangles", "s", "deviation, of its length")
    row("---", "---:", "---:", "---:")
    row("itself", info["mesh"]["triangles"], "", "")

    def tell(name, triangles, seconds):
        low, high = apart(off, out, 1e-5 * size)
        row(name, triangles, f"{seconds:.3g}", f"{low / size:.2e} to {high / size:.2e}")

    for method in [[], ["--method", "adaptive"]]:
        seconds, triangles, _ = by_leafless(off, "-o", out, *method)
        tell("Leafless" + "".join(f" {word}" for word in method), triangles, seconds)
    for depth in [7, 8]:
        seconds, triangles, _ = by_leafless(off, "-o", out, "--method", "mc", "--depth", str(depth))
        tell(f"Leafless --method mc --depth {depth}", triangles, seconds)
    for cells in [128, 256, 512]:
        for adaptivity in [0, 0.25, 1]:
            told, _ = said(volume_to_mesh, off, out, str(size / cells), str(adaptivity))
            first, second, triangles = told.split()
            tell(f"OpenVDB, {cells} voxels, adaptivity {adaptivity}", triangles, float(first) + float(second))


with tempfile.TemporaryDirectory() as name:
    of_plate(pathlib.Path(name))
    for one in models:
        print()
        of_model(pathlib.Path(name), one)
