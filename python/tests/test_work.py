"""Long operations: Ctrl-C, progress, limits, the interpreter's lock; shapes whose methods raise."""

import gc
import os
import signal
import sys
import threading
import time
import weakref

import numpy as np
import pytest

import leafless as lf

#: More splits than any test waits for.
ENDLESS = {"tolerance": 0.0, "max_splits": 1 << 40}


def hard():
    """A solid whose measurement takes for ever."""
    return lf.Csg.union_of(*(lf.Csg.torus(2 + 0.01 * k, 0.5) for k in range(4))) & lf.Csg.half_space([1, 2, 3], 0.1)


FRAME = lf.Frame([-4, -4, -4], 8, 20)


def test_ctrl_c_interrupts():
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        lf.measure(hard(), frame=FRAME, **ENDLESS)
    assert time.monotonic() - begin < 20


def test_signal_handlers_run_and_their_exceptions_come_out():
    class Alarm(Exception):
        pass

    def ring(*_):
        raise Alarm

    before = signal.signal(signal.SIGALRM, ring)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(Alarm):
            lf.measure(hard(), frame=FRAME, **ENDLESS)
    finally:
        signal.signal(signal.SIGALRM, before)


def questions():
    """Queries that take some time, and whose arrays NumPy need not convert."""
    ball, turned = lf.Csg.ball([0, 0, 0], 1), lf.Affine.rotation([1, 2, 3], 40)
    octree, model, mesh = lf.build(ball, depth=7), lf.dexelize(ball, depth=7), lf.surface(ball, tolerance=3e-4)
    data, model_data = octree.to_bytes(), model.to_bytes()
    twin, model_twin = lf.Octree.from_bytes(data), lf.TriDexel.from_bytes(model_data)
    points = np.random.default_rng(0).uniform(-1, 1, (30_000, 3))
    channel = lf.Channel.fill(lambda points: points[:, 0], octree, depth=5)
    volume, records = lf.Volume(octree.bitmap(), spacing=0.01), octree.voxels()
    lazy = lf.LazyOctree(ball)
    lazy.refine(6)
    # A mesh caches its report, so each call needs a fresh mesh.
    fresh = [mesh.placed(turned) for _ in range(30)]
    return {
        "Affine.__call__": lambda: turned(points),
        "Channel.values_at": lambda: channel.values_at(points),
        "Frame.codes": lambda: octree.frame.codes(points, 5),
        "LazyOctree.contains": lambda: lazy.contains(points),
        "Mesh.placed": lambda: mesh.placed(turned),
        "Mesh.report": lambda: fresh.pop().report(),
        "Octree.__eq__": lambda: octree == twin,
        "Octree.open_cells": lambda: octree.open_cells(6),
        "Octree.contains": lambda: octree.contains(points[:4000]),
        "Octree.from_bytes": lambda: lf.Octree.from_bytes(data),
        "Octree.to_bytes": octree.to_bytes,
        "Solid.contains": lambda: ball.contains(points[:4000]),
        "Solid.distances": lambda: ball.distances(points[:10]),
        "TriDexel.__eq__": lambda: model == model_twin,
        "TriDexel.from_bytes": lambda: lf.TriDexel.from_bytes(model_data),
        "TriDexel.rays": lambda: model.rays(1),
        "TriDexel.to_bytes": model.to_bytes,
        "TriDexel.volume": lambda: model.volume(1),
        "Volume.values_at": lambda: volume.values_at(points),
        "VoxelRecords.corners": records.corners,
        "measure": lambda: lf.measure(hard(), frame=FRAME, tolerance=0.0, max_splits=1000),
    }


def lets_others_run(ask, patience=10.0):
    """Returns whether another thread runs during a query."""
    ran, gate = [], threading.Lock()
    ask()
    gate.acquire()

    def wait():
        with gate:
            ran.append(1)

    other = threading.Thread(target=wait)
    other.start()
    before = sys.getswitchinterval()
    # From here on a thread keeps the interpreter until it releases it. Only the query may do so.
    sys.setswitchinterval(1000)
    try:
        gate.release()
        end = time.monotonic() + patience
        while not ran and time.monotonic() < end:
            ask()
        return bool(ran)
    finally:
        sys.setswitchinterval(before)
        other.join()


def test_other_threads_go_on():
    assert [name for name, ask in questions().items() if not lets_others_run(ask)] == []


def test_what_keeps_the_interpreter_is_found():
    assert not lets_others_run(lambda: sum(range(1000)), patience=0.2)


def test_progress_is_reported():
    heard = []
    lf.build(lf.Csg.ball([0, 0, 0], 1), depth=10, progress=heard.append)
    assert heard and heard[-1] == 1 and heard == sorted(heard) and min(heard) >= 0


def test_progress_of_tqdm():
    tqdm = pytest.importorskip("tqdm").tqdm
    with tqdm(total=50, file=open(os.devnull, "w")) as bar:
        lf.build(lf.Csg.ball([0, 0, 0], 1), depth=8, progress=bar)
        assert bar.n == 50


def test_progress_that_raises_ends_the_work():
    def stop(part):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        lf.measure(hard(), frame=FRAME, progress=stop, **ENDLESS)
    with pytest.raises(TypeError, match="progress"):
        lf.build(lf.Csg.ball([0, 0, 0], 1), progress=3)


def test_limits():
    ball = lf.Csg.ball([0, 0, 0], 1)
    with pytest.raises(lf.LimitError, match="nodes"):
        lf.build(ball, depth=9, max_nodes=100)
    with pytest.raises(lf.LimitError, match="bytes"):
        lf.build(ball, depth=9, max_bytes=1000)
    assert lf.measure(ball, max_splits=10, tolerance=0).stop_reason == "budget"
    for wrong, error in ((-1, lf.ArgumentError), ("many", TypeError), (1.5, TypeError)):
        with pytest.raises(error, match="^max_nodes: "):
            lf.build(ball, max_nodes=wrong)


def test_limits_of_arrays_and_files(tmp_path):
    octree = lf.build(lf.Csg.ball([0, 0, 0], 1), depth=6)
    count = len(octree.cells())
    assert len(octree.cells(max_bytes=14 * count)) == count
    with pytest.raises(lf.LimitError, match="cells"):
        octree.cells(max_bytes=14 * count - 1)
    # The limit covers the library's list, and a code for each cell.
    codes = octree.open_cells(6)
    assert (octree.open_cells(6, max_bytes=24 * len(codes)) == codes).all()
    with pytest.raises(lf.LimitError, match="open cells"):
        octree.open_cells(6, max_bytes=24 * len(codes) - 1)
    # The limit covers a word for each row, and a byte for each cell.
    needed = 64 * 64 * 8 + 64**3
    assert octree.bitmap(max_bytes=needed).shape == (64, 64, 64)
    with pytest.raises(lf.LimitError, match="bitmap"):
        octree.bitmap(max_bytes=needed - 1)
    with pytest.raises(lf.LimitError):
        octree.bitmap(outer=True, max_bytes=needed)
    for object, name in ((octree, "ball.lfl"), (lf.surface(octree), "ball.stl")):
        path = tmp_path / name
        lf.save(object, path)
        size = path.stat().st_size
        lf.open(path, max_bytes=size)
        with pytest.raises(lf.LimitError, match="file"):
            lf.open(path, max_bytes=size - 1)
        with pytest.raises(lf.LimitError, match="file"):
            lf.open(f"file://{path}", max_bytes=size - 1)
        heard = []
        lf.open(path, progress=heard.append)
        assert heard[-1] == 1
    (tmp_path / "part.csg").write_text('import("ball.stl");')
    assert lf.open(tmp_path / "part.csg", max_bytes=size).bounds is not None
    with pytest.raises(lf.Error):
        lf.open(tmp_path / "part.csg", max_bytes=size - 1)


def test_limits_of_set_operations():
    frame = lf.Frame([-2, -2, -2], 4, 6)
    balls = [lf.Csg.ball([x, 0, 0], 1) for x in (-0.5, 0, 0.5)]
    a, b, c = (lf.build(ball, frame) for ball in balls)
    several = [
        (lf.Octree.union_of, a | b | c),
        (lf.Octree.intersection_of, a & b & c),
        (lf.Octree.difference_of, a - b - c),
        (lf.Octree.xor_of, a ^ b ^ c),
    ]
    for combined, expected in several:
        assert combined(a, b, c) == expected and combined(a, b, c, threads=1) == expected
        with pytest.raises(lf.LimitError):
            combined(a, b, c, max_nodes=3)
    assert lf.Octree.complement_of(a) == ~a and lf.Octree.union_of(a) == a
    kept = lf.Octree.union_of(*(lf.build(ball, frame, surfaces=True) for ball in balls))
    assert kept.keeps_surfaces and lf.measure(kept).volume.middle == pytest.approx((a | b | c).volume.middle, rel=0.02)
    one, other = (lf.dexelize(lf.Csg.ball([x, 0, 0], 1), frame) for x in (0, 0.5))
    assert lf.TriDexel.union_of(one, other) == one | other and lf.TriDexel.difference_of(one, other) == one - other
    assert lf.TriDexel.intersection_of(one, other) == one & other and lf.TriDexel.xor_of(one, other) == one ^ other
    assert lf.TriDexel.complement_of(one) == ~one
    with pytest.raises(lf.LimitError):
        lf.TriDexel.union_of(one, other, max_bytes=100)


def test_octrees_heed_those_who_stop_them():
    octree = lf.build(lf.Csg.ball([0, 0, 0], 1), depth=8)
    points = np.tile(np.random.default_rng(0).uniform(-1.5, 1.5, (1 << 20, 3)), (8, 1))

    def stop(part):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        octree.contains(points, progress=stop)
    # The answers do not depend on the number of points in one call.
    many, beyond = octree.contains(points[: 3 << 16]), points[1 << 16 :][:1000]
    assert (many[1 << 16 :][:1000] == octree.contains(beyond)).all() and set(many) == {0, 1, 2}


def test_threads_at_once():
    ball = lf.Csg.ball([0, 0, 0], 1)
    points = np.random.default_rng(0).uniform(-1.5, 1.5, (20_000, 3))
    expected = ball.contains(points)
    wrong = []

    def ask():
        for _ in range(3):
            if (ball.contains(points) != expected).any():
                wrong.append(1)

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


class Sphere(lf.Shape):
    def __init__(self, radius):
        self.radius = radius

    @property
    def bounds(self):
        return [[-self.radius] * 3, [self.radius] * 3]

    def classify(self, boxes):
        low, high = boxes[:, 0], boxes[:, 1]
        near = np.clip(0, low, high)
        far = np.maximum(abs(low), abs(high))
        nearest, farthest = np.linalg.norm(near, axis=1), np.linalg.norm(far, axis=1)
        tags = np.full(len(boxes), lf.PARTIAL)
        tags[nearest * (1 - 1e-12) > self.radius] = lf.EMPTY
        tags[farthest * (1 + 1e-12) < self.radius] = lf.FULL
        return tags

    def inside(self, points):
        return np.linalg.norm(points, axis=1) < self.radius


class Sloped(Sphere):
    """A ball with the gradient of |p|² − r²."""

    def gradient(self, boxes):
        low, high = boxes[:, 0], boxes[:, 1]
        middle = 0.5 * (low + high)
        value = (middle**2).sum(axis=1) - self.radius**2
        return np.stack([value - 1e-12, value + 1e-12], axis=1), np.stack([2 * low, 2 * high], axis=2)


class Distant(lf.Shape):
    bounds = [[-1, -1, -1], [1, 1, 1]]

    def distance(self, points):
        return np.linalg.norm(points, axis=1) * (1 - 1e-15) - 1


def test_shapes():
    truth = 4 / 3 * np.pi
    for shape in (Sphere(1), Distant(), Sloped(1)):
        octree = lf.build(shape, depth=5)
        assert truth in octree.volume and octree.volume.width < 2
        assert shape.contains([0, 0, 0]) == lf.INSIDE and shape.contains([0, 0, 1.1]) == lf.OUTSIDE
        assert truth in lf.measure(shape, max_splits=2000).volume
    assert lf.build(Sphere(1), depth=6, rule="sampled").volume.width == 0
    exact = lf.build(lf.Csg.ball([0, 0, 0], 1), lf.build(Sphere(1), depth=6), rule="sampled")
    assert lf.build(Sphere(1), exact, rule="sampled") == exact
    plain, sloped = (lf.measure(shape, max_splits=3000, tolerance=0).volume.width for shape in (Sphere(1), Sloped(1)))
    assert sloped < plain / 4
    both = Sphere(1) - lf.Csg.half_space([0, 0, 1], 0)
    assert truth / 2 in lf.measure(both, max_splits=2000).volume
    assert lf.interference(Sphere(1), lf.Csg.ball([2.5, 0, 0], 1), max_splits=4000).verdict == "disjoint"


@pytest.mark.parametrize(
    "answer, error",
    [
        (lambda boxes: 1 / 0, ZeroDivisionError),
        (lambda boxes: np.zeros(len(boxes) + 1), ValueError),
        (lambda boxes: np.full(len(boxes), 7), ValueError),
        (lambda boxes: np.full(len(boxes), lf.Tag.BRANCH), ValueError),
        (lambda boxes: None, ValueError),
        (lambda boxes: ["full"] * len(boxes), ValueError),
    ],
)
@pytest.mark.parametrize("threads", [1, 2])
def test_exceptions_come_out(answer, error, threads):
    class Wrong(lf.Shape):
        bounds = [[0, 0, 0], [1, 1, 1]]

        def classify(self, boxes):
            return answer(boxes)

    for _ in range(3):
        with pytest.raises(error):
            lf.build(Wrong(), depth=3, threads=threads)
    with pytest.raises(error):
        lf.measure(lf.Csg.cuboid([0, 0, 0], [2, 2, 2]) - Wrong(), threads=threads)


def test_shapes_must_have_a_method():
    class Nothing(lf.Shape):
        pass

    with pytest.raises(TypeError, match="classify"):
        lf.build(Nothing(), lf.Frame([0, 0, 0], 1, 3))


def test_shapes_are_freed():
    shape = Sphere(1)
    gone = weakref.ref(shape)
    octree = lf.build(shape, depth=3)
    expression = shape | lf.Csg.ball([0, 0, 0], 0.5)
    assert expression.contains([0, 0, 0])
    del shape
    gc.collect()
    assert gone() is not None
    del expression
    gc.collect()
    assert gone() is None and octree.node_count > 0


def test_shapes_that_hold_what_is_made_of_them_are_freed():
    shape = Sphere(1)
    shape.half = shape & lf.Csg.half_space([0, 0, 1], 0)
    shape.moved = lf.Affine.translation([1, 0, 0]) @ (shape.half - ~shape)
    shape.lazy = lf.LazyOctree(shape.moved)
    gone = [weakref.ref(thing) for thing in (shape, shape.half, shape.moved, shape.lazy)]
    gc.collect()
    assert shape.half.contains([0, 0, 0.5]) == lf.INSIDE and all(thing() is not None for thing in gone)
    del shape
    gc.collect()
    assert [thing() for thing in gone] == [None] * 4


def test_what_is_made_of_a_shape_keeps_it():
    lazy = lf.LazyOctree(Sphere(1) | Sphere(0.5))
    expression = lf.Csg.union_of(Sphere(1), lf.Csg.of(Sphere(0.5)))
    gc.collect()
    assert lazy.refine(3) and expression.contains([0, 0, 0.9]) == lf.INSIDE


class Attributes(Distant):
    def __init__(self, edge):
        self.bounds = [[-edge] * 3, [edge] * 3]


def test_bounds_are_told_by_a_class_an_object_or_a_property():
    assert Distant().bounds == [[-1] * 3, [1] * 3] and Sphere(2).bounds == [[-2] * 3, [2] * 3]
    one, other = Attributes(1), Attributes(3)
    assert lf.Csg.of(one).bounds.tolist() == one.bounds and lf.Csg.of(other).bounds.tolist() == other.bounds
    other.bounds = None
    assert lf.Csg.of(other).bounds is None and lf.Shape.bounds is None


class NewTakes(Distant):
    def __new__(cls, size):
        return super().__new__(cls)


def test_arguments_that_nobody_takes_are_refused():
    for wrong in (lambda: Distant(1), lambda: Distant(size=1), lambda: lf.Shape(1), lambda: lf.Shape.__new__(NewTakes, 1)):
        with pytest.raises(TypeError, match="takes"):
            wrong()
    assert NewTakes(1).distance(np.zeros((1, 3))) == -1


def test_a_shape_may_ask_the_library():
    inner = lf.Csg.ball([0, 0, 0], 1)

    class Asking(lf.Shape):
        bounds = [[-1, -1, -1], [1, 1, 1]]

        def distance(self, points):
            found = inner.distances(points, tolerance=1e-3).distance
            return np.where(found.lower > 0, found.lower, np.where(found.upper < 0, found.upper, 0))

    assert 4 / 3 * np.pi in lf.build(Asking(), depth=3).volume


def test_a_shape_must_not_wait_for_its_own_octree():
    asked = []

    class Curious(Distant):
        def distance(self, points):
            for octree in asked:
                octree.volume
            return super().distance(points)

    lazy = lf.LazyOctree(Curious())
    asked.append(lazy)
    with pytest.raises(RuntimeError, match="at work"):
        lazy.refine(3)
    assert "LazyOctree" in repr(lazy)


def test_interrupts_come_through():
    class Interrupted(lf.Shape):
        bounds = [[0, 0, 0], [1, 1, 1]]

        def classify(self, boxes):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        Interrupted()._repr_png_()
