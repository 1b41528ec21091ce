"""The cuts of `cargo bench --bench extended_booleans` by Manifold and trueform, which combine triangle meshes; see benches/README.md.

    pip install manifold3d trueform numpy
    taskset -c 0 python benches/peers/manifold.py

Round faces are polygons of 128 sides. Each time is the median of the wall clock, tools are made beforehand.
"""

import math
import statistics
import time

import numpy as np
from manifold3d import Manifold, OpType

try:
    import trueform
except ImportError:
    trueform = None

SIDES = 128

# What is left of the block: proven to lie between 0.920295718 and 0.920295771.
BLOCK = 0.920295744


def timed(runs, run):
    """The median of the times, and what the last run made. Manifold works when it is asked for a result."""
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        made = run()
        count = made.num_tri() if isinstance(made, Manifold) else len(made.faces)
        times.append(time.perf_counter() - start)
    return statistics.median(times), made, count


def one_by_one(stock, tools, less):
    for tool in tools:
        stock = less(stock, tool)
        if isinstance(stock, Manifold):
            stock.num_tri()  # As whoever looks at the part after each cut.
    return stock


def told(name, found, volume, truth):
    seconds, made, triangles = found
    error = volume(made) / truth - 1
    print(f"{name}: {1e3 * seconds:.2f} ms, {triangles} triangles, volume {error:+.1e}", flush=True)


def compare(name, stock, tools, truth, runs, others=False):
    own = lambda a, b: a - b
    volume = lambda solid: solid.volume()
    if len(tools) <= 100:
        told(f"{name}, manifold, one by one", timed(runs, lambda: one_by_one(stock, tools, own)), volume, truth)
    batch = lambda: Manifold.batch_boolean([stock, *tools], OpType.Subtract)
    told(f"{name}, manifold, at once", timed(runs, batch), volume, truth)
    if trueform is None or not others:
        return

    def mesh(solid):
        arrays = solid.to_mesh64()
        points = np.asarray(arrays.vert_properties, dtype=np.float64)[:, :3].copy()
        made = trueform.Mesh(np.asarray(arrays.tri_verts, dtype=np.int32).copy(), points)
        made.build_tree()
        return made

    def less(a, b):
        (faces, points), *_ = trueform.boolean_difference(a, b)
        return trueform.Mesh(faces, points)

    stock, tools = mesh(stock), [mesh(tool) for tool in tools]
    volume = lambda solid: abs(trueform.signed_volume(solid))
    told(f"{name}, trueform, one by one", timed(runs, lambda: one_by_one(stock, tools, less)), volume, truth)


def plate(count, edge, runs):
    """A plate of thickness 10, and bores of radius 2.5."""
    width, height = edge
    bore = Manifold.cylinder(12.0, 2.5, 2.5, SIDES).translate((0.0, 0.0, -1.0))
    if count == 20:
        places = [(8.0 + 16.0 * (k % 5), 7.5 + 15.0 * (k // 5)) for k in range(count)]
    else:
        places = [(16.0 + 31.0 * (k % 32), 16.0 + 31.0 * (k // 32)) for k in range(count)]
    tools = [bore.translate((x, y, 0.0)) for x, y in places]
    for tool in tools:
        tool.num_tri()
    truth = 10.0 * width * height - count * 10.0 * math.pi * 2.5**2
    compare(f"plate, {count} bores", Manifold.cube((width, height, 10.0)), tools, truth, runs, others=count == 20)


def balls(runs):
    """A block of edge 1, and 100 balls of radius 0.06."""
    state = 1

    def unit():
        nonlocal state
        state = (state * 6364136223846793005 + 1442695040888963407) % 2**64
        return (state >> 11) / 2.0**53

    ball = Manifold.sphere(0.06, SIDES)
    tools = [ball.translate((unit(), unit(), unit())) for _ in range(100)]
    for tool in tools:
        tool.num_tri()
    print(f"a ball has {ball.num_tri()} triangles, its volume is {ball.volume() / (4 / 3 * math.pi * 0.06**3) - 1:+.1e} off")
    compare("block, 100 balls", Manifold.cube((1.0, 1.0, 1.0)), tools, BLOCK, runs)


if __name__ == "__main__":
    plate(20, (80.0, 60.0), 21)
    balls(3)
    plate(1000, (1000.0, 1000.0), 1)
