"""Long work: Ctrl-C, progress, limits, the interpreter's lock; shapes whose methods raise."""

import gc
import os
import signal
import threading
import time
import weakref

import numpy as np
import pytest

import leafless as lf

#: So many splits that nobody waits for them.
ENDLESS = {"tolerance": 0.0, "max_splits": 1 << 40}


def hard():
    """A solid that takes for ever to measure."""
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


def test_other_threads_go_on():
    counted = [0]
    done = threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    lf.measure(hard(), frame=FRAME, tolerance=0.0, max_splits=300_000)
    done.set()
    thread.join()
    assert counted[0] > 3


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
    for wrong in (-1, "many", 1.5):
        with pytest.raises((TypeError, OverflowError)):
            lf.build(ball, max_nodes=wrong)


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
    """With the gradient of |p|² − r²."""

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
