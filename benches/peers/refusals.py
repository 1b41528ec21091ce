"""What kernels do with meshes as they are found: a cube with a defect, less another cube, of known volume.

    pip install manifold3d meshlib numpy
    cargo build --release && python benches/peers/refusals.py target/release/leafless

For each defect and kernel, the program prints the volume of the result, or how the kernel refuses. "wrong" is a volume
that is off by more than a thousandth and that comes without an error.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import manifold3d
import numpy as np
from meshlib import mrmeshnumpy, mrmeshpy

CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
SIDES = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
FACES = np.array([face for a, b, c, d in SIDES for face in ([a, b, c], [a, c, d])])


def box(low, high):
    low, high = np.array(low, dtype=float), np.array(high, dtype=float)
    return low + CORNERS * (high - low), FACES.copy()


def joined(a, b):
    return np.concatenate([a[0], b[0]]), np.concatenate([a[1], b[1] + len(a[0])])


CUBE = box([0, 0, 0], [2, 2, 2])
TOOL = box([1, 1, 1], [3, 3, 3])
INVERTED = CUBE[1].copy()
INVERTED[3] = INVERTED[3][::-1]
CRACKED = np.concatenate([CUBE[0], CUBE[0][[0]] + 1e-8]), CUBE[1].copy()
CRACKED[1][4][CRACKED[1][4] == 0] = 8

# Name, mesh, volume of the mesh less the tool.
CASES = [
    ("no defect", CUBE, 7.0),
    ("a hair crack of 1e-8", CRACKED, 7.0),
    ("two bodies that overlap", joined(CUBE, box([0.5, 0.5, 1], [1.5, 1.5, 3])), 7.75),
    ("a facet twice", (CUBE[0], np.concatenate([CUBE[1], CUBE[1][[2]]])), 7.0),
    ("a facet inverted", (CUBE[0], INVERTED), 7.0),
    ("a facet missing", (CUBE[0], CUBE[1][1:]), 7.0),
]


def manifold(a, b):
    def made(mesh):
        return manifold3d.Manifold(manifold3d.Mesh64(vert_properties=mesh[0], tri_verts=mesh[1].astype(np.uint64)))

    a, b = made(a), made(b)
    for status in (a.status(), b.status()):
        if status != manifold3d.Error.NoError:
            return f"refused: {status.name}"
    return (a - b).volume()


def meshlib(a, b):
    a, b = (mrmeshnumpy.meshFromFacesVerts(mesh[1].astype(np.int32), mesh[0]) for mesh in (a, b))
    found = mrmeshpy.boolean(a, b, mrmeshpy.BooleanOperation.DifferenceAB)
    if not found.valid():
        return f"refused: {found.errorString}"
    return found.mesh.volume()


def leafless(a, b):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name, (vertices, faces) in (("a", a), ("b", b)):
            lines = ["OFF", f"{len(vertices)} {len(faces)} 0"]
            lines += [" ".join(repr(float(c)) for c in vertex) for vertex in vertices]
            lines += ["3 " + " ".join(str(v) for v in face) for face in faces]
            (folder / f"{name}.off").write_text("\n".join(lines) + "\n")
        (folder / "cut.csg").write_text('difference() { import("a.off"); import("b.off"); }')
        command = [PROGRAM, "measure", "cut.csg", "--tolerance", "1e-3", "--seconds", "20", "--json"]
        ran = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        if ran.returncode != 0:
            return f"refused: {ran.stderr.strip()}"
        volume = json.loads(ran.stdout)["volume"]
        return volume["lower"], volume["upper"]


def told(answer, truth):
    if isinstance(answer, str):
        return answer
    if isinstance(answer, tuple):
        verdict = "contains the truth" if answer[0] - 1e-6 <= truth <= answer[1] + 1e-6 else "wrong"
        return f"{answer[0]:.5f} to {answer[1]:.5f}: {verdict}"
    return f"{answer:.5f}" if abs(answer - truth) < 1e-3 * truth else f"{answer:.5f}: wrong"


if __name__ == "__main__":
    PROGRAM = pathlib.Path(sys.argv[1]).resolve()
    for name, mesh, truth in CASES:
        print(f"{name}: {truth}")
        for kernel in (leafless, manifold, meshlib):
            try:
                answer = kernel(mesh, TOOL)
            except Exception as error:
                answer = f"refused: {type(error).__name__}: {error}"
            print(f"    {kernel.__name__:9} {told(answer, truth)}")
