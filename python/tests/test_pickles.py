"""What is public can be pickled and copied, or says why not."""

import copy
import pickle

import numpy as np
import pytest

import leafless as lf


def copies(thing):
    """The thing pickled and read again, by each protocol that knows of classes, and a deep copy."""
    return [*(pickle.loads(pickle.dumps(thing, protocol)) for protocol in range(2, 6)), copy.deepcopy(thing)]


BALL = lf.Csg.ball([0, 0, 0], 1)


def test_long_recipes_need_no_recursion():
    part = lf.Csg.cuboid([0, 0, 0], [4, 4, 4])
    for k in range(2500):
        at = np.array([4 * np.sin(k), 2, 2 + k / 2500])
        part = (part | lf.Csg.ball(at, 0.5)) - lf.Csg.ball(-at, 0.5)
    points = np.random.default_rng(0).uniform(-5, 5, (50, 3))
    for again in copies(part):
        assert (again.contains(points) == part.contains(points)).all()


def test_shared_parts_stay_shared():
    part = BALL
    for k in range(40):
        part = part | lf.Affine.translation([2.0**-k, 0, 0]) @ part
    # Written out it would be 2^40 balls.
    for again in copies(part):
        assert len(pickle.dumps(part)) == len(pickle.dumps(again)) < 20_000


class Ball(lf.Shape):
    def distance(self, points):
        return np.linalg.norm(points, axis=1) * (1 - 1e-15) - self.radius


class Plain(Ball):
    def __init__(self, radius):
        self.radius = radius
        self.bounds = [[-radius] * 3, [radius] * 3]


class Slotted(Ball):
    __slots__ = ("radius", "bounds")

    def __init__(self, radius):
        Plain.__init__(self, radius)


class Stated(Ball):
    def __init__(self, radius):
        Plain.__init__(self, radius)
        self.cache = lambda: None

    def __getstate__(self):
        return self.radius

    def __setstate__(self, radius):
        self.__init__(radius)


class Made(Ball):
    def __new__(cls, radius, *, unit):
        self = super().__new__(cls)
        Plain.__init__(self, radius * unit)
        return self

    def __getnewargs_ex__(self):
        return (self.radius,), {"unit": 1}


@pytest.mark.parametrize("shape", [Plain(2), Slotted(2), Stated(2), Made(1, unit=2)], ids=lambda shape: type(shape).__name__)
def test_shapes_are_pickled_as_any_object(shape):
    for again in copies(shape):
        assert type(again) is type(shape) and again.radius == 2 and again.contains([0, 0, 1.9]) == lf.INSIDE
    # One shape at two places stays one.
    for again in copies([shape, {"the same": shape}]):
        assert again[0] is again[1]["the same"]
    for again in copies(shape & lf.Csg.half_space([0, 0, 1], 0)):
        assert again.contains([[0, 0, 1.9], [0, 0, -1.9]]).tolist() == [1, 0]
