"""The clearance of two meshes in many poses by the program, the C library and Python: processor seconds of each, in turn.

    cargo build --release && pip install ./python
    python benches/same_speed.py target/release/leafless target/release/libleafless.so A.stl B.stl [POSES]

All three are made of one kernel. The program tells the verdict of each pose, too, and prints it; Python makes an object
for each pose.
"""

import ctypes
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from ctypes import POINTER, byref, c_bool, c_char_p, c_double, c_int, c_size_t, c_uint32, c_uint64, c_void_p

import numpy as np

import leafless as lf


class Source(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("access", c_int),
        ("path", c_char_p),
        ("path_length", c_size_t),
        ("bytes", c_void_p),
        ("length", c_uint64),
    ]


class Frame(ctypes.Structure):
    _fields_ = [("origin", c_double * 3), ("edge", c_double), ("depth", c_uint32)]


class Placed(ctypes.Structure):
    _fields_ = [
        ("distance", c_double * 2),
        ("points", c_double * 6),
        ("depth", c_double),
        ("splits", c_uint64 * 2),
        ("measured", c_int),
        ("has_points", c_bool),
        ("is_clipped", c_bool),
    ]


def by_program(program, paths, matrices):
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as poses:
        poses.writelines(" ".join(map(repr, map(float, matrix.ravel()))) + "\n" for matrix in matrices)
        poses.flush()
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        command = [program, "interfere", *paths, "--poses", poses.name, "--clearance"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def by_c(library, paths, matrices, frame):
    def call(name, *arguments):
        status = getattr(library, name)(*arguments)
        assert status == 0, (name, status)

    solids = []
    start = time.process_time()
    for path in paths:
        mesh, solid, name = c_void_p(), c_void_p(), path.encode()
        source = Source(ctypes.sizeof(Source), 0, name, len(name), None, 0)
        call("leafless_mesh_read", byref(source), None, None, byref(mesh))
        call("leafless_solid_from_mesh", mesh, 0, byref(solid))
        solids.append(solid)
    cube = Frame((c_double * 3)(*frame.origin), frame.edge, frame.depth)
    flat = np.ascontiguousarray(matrices, dtype=float)
    found = (Placed * len(matrices))()
    pointer = flat.ctypes.data_as(POINTER(c_double))
    count, tolerance = c_uint64(len(matrices)), c_double(1e-9 * frame.edge)
    call("leafless_solid_clearance_many", *solids, byref(cube), pointer, count, byref(cube), tolerance, None, found)
    return time.process_time() - start


def by_python(paths, matrices, frame):
    start = time.process_time()
    a, b = map(lf.open, paths)
    lf.clearance(a, b, matrices, tolerance=1e-9 * frame.edge, frame=frame)
    return time.process_time() - start


def main(program, library, first, second, count=1000):
    library, paths = ctypes.CDLL(library), [first, second]
    low, high = lf.open(first).bounds
    random = np.random.default_rng(5)
    matrices = np.tile(np.eye(3, 4), (int(count), 1, 1))
    matrices[:, :, 3] = random.uniform(-2, 2, (int(count), 3)) * (high - low)
    frame = lf.Frame(low - 4 * np.max(high - low), 9 * float(np.max(high - low)), 10)
    rows = []
    for _ in range(6):
        rows.append([by_program(program, paths, matrices), by_c(library, paths, matrices, frame)])
        rows[-1].append(by_python(paths, matrices, frame))
    for name, column in zip(("program", "C", "Python"), zip(*rows[1:])):
        ratios = [mine / row[0] for mine, row in zip(column, rows[1:])]
        print(f"{name:8} {statistics.median(column):.3f} s, {statistics.median(ratios):.3f} of the program")


if __name__ == "__main__":
    main(*sys.argv[1:])
