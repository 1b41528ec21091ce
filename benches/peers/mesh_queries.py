"""The points of `mesh_queries.cpp`, asked of libigl in batches; see benches/README.md.

    pip install libigl numpy
    IGL_NUM_THREADS=1 taskset -c 1 python benches/peers/mesh_queries.py MESH.stl [QUESTIONS]

A call from Python would cost more than many an answer, so each call asks about all points. Processor time, medians of five.
"""

import statistics
import sys
import time

import igl
import numpy as np

ROUNDS = 5


def read(path):
    """Corners and triangles of a binary STL; equal corners are one."""
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    with open(path, "rb") as file:
        soup = np.frombuffer(file.read()[84:], facet)["corners"].reshape(-1, 3)
    corners, places = np.unique(soup, axis=0, return_inverse=True)
    return corners.astype(np.float64), places.reshape(-1, 3).astype(np.int64)


def points_within(low, high, count):
    """splitmix64, as in `mesh_queries.h`."""
    with np.errstate(over="ignore"):
        z = np.uint64(3) + np.arange(1, 3 * count + 1, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)
        z = (z ^ z >> np.uint64(30)) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ z >> np.uint64(27)) * np.uint64(0x94D049BB133111EB)
        z ^= z >> np.uint64(31)
    shares = (z >> np.uint64(11)).astype(np.float64) / 9007199254740992.0
    return (low + shares.reshape(-1, 3) * (high - low)).astype(np.float32)


def asked(name, count, ask, what):
    """Prints the median time of a question, and what the answers come to."""
    times = []
    for _ in range(ROUNDS):
        start = time.process_time_ns()
        answers = ask()
        times.append(time.process_time_ns() - start)
    print(f"{name:38} {statistics.median(times) / count:10.1f} ns  {what(answers)}", flush=True)


def main():
    corners, triangles = read(sys.argv[1])
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 1_000_000
    points = points_within(corners.min(axis=0), corners.max(axis=0), count)
    print(f"{count} points: {points.view(np.uint32).sum(dtype=np.uint64)}")
    points = points.astype(np.float64)

    start = time.process_time_ns()
    tree = igl.AABB()
    tree.init(corners, triangles)
    print(f"{'libigl, tree for distances':38} {(time.process_time_ns() - start) / 1e6:10.2f} ms")
    total = lambda found: f"{np.sqrt(found[0]).sum():.9f}"
    asked("libigl, distances", count, lambda: tree.squared_distance(corners, triangles, points), total)

    # Makes its tree anew: a call about one point tells how long that takes.
    of_one = lambda: igl.fast_winding_number(corners, triangles, points[:1])
    asked("libigl, a winding number and its tree", 1, of_one, lambda _: "")
    inside = lambda numbers: f"{(numbers > 0.5).sum()} inside, {(np.abs(numbers - 0.5) < 0.4).sum()} between 0.1 and 0.9"
    asked("libigl, fast winding numbers", count, lambda: igl.fast_winding_number(corners, triangles, points), inside)


main()
