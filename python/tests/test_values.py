"""Intervals, frames, placements."""

import copy
import pickle

import numpy as np
import pytest

import leafless as lf


def test_interval():
    volume = lf.Interval(171000, 172000)
    assert (volume.lower, volume.upper, volume.width, volume.middle) == (171000, 172000, 1000, 171500)
    assert 171000 in volume and 170999 not in volume
    low, high = volume
    assert (low, high) == (171000, 172000)
    assert repr(volume) == "171500 ± 510" and f"{volume:.0f}" == "171000 to 172000"
    assert repr(lf.Interval(2.5)) == "2.5" and lf.Interval(2.5).width == 0
    assert repr(lf.Interval(0, np.inf)) == "at least 0"


def test_intervals_compare_as_proofs():
    one = lf.Interval(1, 2)
    assert one < 3 and one <= 2 and one > 0 and one >= 1
    assert not one < 2 and not one > 1 and not one < 1.5 and not one > 1.5
    assert one < lf.Interval(2.5, 3) and one == lf.Interval(1, 2) and one != lf.Interval(1, 3)
    # An interval is no number.
    assert one != 1 and lf.Interval(1) != 1
    assert len({one, lf.Interval(1, 2)}) == 1


@pytest.mark.parametrize("ends", [(2, 1), (np.nan, 1), (1, np.nan)])
def test_intervals_are_refused(ends):
    with pytest.raises(lf.ArgumentError, match="^(lower|upper): "):
        lf.Interval(*ends)


def test_arrays_of_intervals():
    some = lf.Intervals([[1, 2], [3, 4]], [[1, 3], [5, np.inf]])
    assert some.shape == (2, 2) and some[0, 1] == lf.Interval(2, 3) and some[1].shape == (2,)
    assert some.contain([[1, 4], [4, 1e9]]).tolist() == [[True, False], [True, True]]
    assert repr(some) == "Intervals([[1, 2 to 3], [3 to 5, at least 4]])"
    assert len(list(some)) == 2 and some == lf.Intervals(some.lower, some.upper)
    for wrong in (([1], [1, 2]), ([2], [1]), ([np.nan], [1])):
        with pytest.raises(ValueError):
            lf.Intervals(*wrong)
    with pytest.raises(TypeError, match="contain"):
        2.0 in some


def test_frame():
    frame = lf.Frame((0, 1, 2), 8, depth=5)
    assert (frame.origin, frame.edge, frame.depth, frame.cells, frame.cell_size) == ((0, 1, 2), 8, 5, 32, 0.25)
    assert frame == lf.Frame(np.array([0, 1, 2]), 8, 5) and frame != frame.with_depth(6)
    assert hash(frame) == hash(lf.Frame([-0.0, 1, 2], 8, 5))
    assert eval(repr(frame), {"Frame": lf.Frame}) == frame
    around = lf.Frame.around([[0, 0, 0], [3, 2, 1]], depth=4)
    assert all(around.origin[k] <= 0 and around.origin[k] + around.edge >= (3, 2, 1)[k] for k in range(3))
    assert lf.Frame.with_cells([[0, 0, 0], [3, 2, 1]], 0.01).cell_size == 0.01
    for refused in [([0, 0, 0], -1, 5), ([0, 0, 0], 1, 0), ([0, 0, 0], 1, 21), ([np.nan, 0, 0], 1, 5), ([0, 0], 1, 5)]:
        with pytest.raises(lf.ArgumentError):
            lf.Frame(*refused)
    with pytest.raises(lf.ArgumentError, match="^depth: "):
        lf.Frame([0, 0, 0], 1, -3)


def test_affine():
    move, turn = lf.Affine.translation([1, 2, 3]), lf.Affine.rotation([0, 0, 1], 90)
    assert turn.matrix.tolist() == [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    assert (move @ turn)([1, 0, 0]).tolist() == [1, 3, 3]
    assert (turn @ move)([[0, 0, 0], [1, 0, 0]]).tolist() == [[-2, 1, 3], [-2, 2, 3]]
    assert (np.eye(4) @ move) == move and (move @ np.eye(4)) == move and lf.Affine(move.matrix[:3]) == move
    assert move.inverse() @ move == lf.Affine.identity()
    about = lf.Affine.rotation([0, 0, 2], 30, about=[5, 5, 0])
    assert np.allclose(about([5, 5, 7]), [5, 5, 7])
    rows = np.array([[np.cos(0.3), -np.sin(0.3), 0], [np.sin(0.3), np.cos(0.3), 0], [0, 0, 1]])
    assert np.allclose(lf.Affine.rotation([0, 0, 1], np.degrees(0.3)).matrix[:3, :3], rows)
    assert lf.Affine.scale(2)([1, 1, 1]).tolist() == [2, 2, 2]
    assert lf.Affine.scale([1, 2, 3])([1, 1, 1]).tolist() == [1, 2, 3]
    for wrong in [np.zeros((4, 4)), np.eye(3), np.eye(4)[::-1], "text", np.full((3, 4), np.nan)]:
        with pytest.raises(lf.ArgumentError):
            lf.Affine(wrong)


@pytest.mark.parametrize(
    "value",
    [lf.Interval(1, 2), lf.Frame([0, 1, 2], 3, 4), lf.Affine.rotation([1, 2, 3], 77), lf.Intervals([1.0], [2.0])],
    ids=repr,
)
def test_values_are_pickled(value):
    assert pickle.loads(pickle.dumps(value)) == value and copy.deepcopy(value) == value
