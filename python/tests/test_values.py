"""Intervals, frames, placements."""

import copy
import pickle
from fractions import Fraction

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
    # An interval equals no number.
    assert one != 1 and lf.Interval(1) != 1
    assert len({one, lf.Interval(1, 2)}) == 1


def test_formats_are_rounded_outward():
    random = np.random.default_rng(0)
    nearest_is_inside = 0
    for spec in (".0f", ".3f", "+.2f", "12.1f", ",.2f", ".3e", ".4g", ".2", "f", "e", "g", ".1%", "%"):
        number = lambda text: Fraction(text.strip(" +%").replace(",", "")) / (100 if "%" in spec else 1)
        for scale in 10.0 ** np.arange(-8, 9, 2):
            low, high = np.sort(random.normal(0, scale, 2))
            lower, upper = map(number, f"{lf.Interval(low, high):{spec}}".split(" to "))
            assert lower <= Fraction(low) and Fraction(high) <= upper
            nearest_is_inside += number(format(low, spec)) > Fraction(low) or number(format(high, spec)) < Fraction(high)
            if spec == ".3f":
                assert Fraction(low) - lower < Fraction(1, 1000) and upper - Fraction(high) < Fraction(1, 1000)
    # Formats of plain numbers do not round outward.
    assert nearest_is_inside > 20
    assert f"{lf.Interval(0.1):.20f}" == "0.10000000000000000555 to 0.10000000000000000556"
    assert f"{lf.Interval(1e-9, 2e-9):.3f}" == "0.000 to 0.001" and f"{lf.Interval(-1e-9, 1):.0f}" == "-1 to 1"
    assert f"{lf.Interval(0.25, 0.5):.2f}" == "0.25 to 0.50"
    assert f"{lf.Interval(0, np.inf):6.1f}" == "   0.0 to    inf" and f"{lf.Interval(0.1, 2):>5}" == "  0.1 to   2.0"
    for wrong in ("q", ".3d", "..", "s"):
        with pytest.raises(ValueError):
            format(lf.Interval(1, 2), wrong)


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


def test_arrays_of_intervals_compare_as_proofs():
    some = lf.Intervals([1, 2, 3], [2, 2, np.inf])
    assert (some < 2.5).tolist() == [True, True, False] and (some > 2.5).tolist() == [False, False, True]
    assert (some < 2).tolist() == [False] * 3 and (some <= 2).tolist() == [True, True, False]
    assert (some >= [1, 2, 4]).tolist() == [True, True, False] and (some > [1, 2, 4]).tolist() == [False] * 3
    # Comparisons with intervals, in both orders.
    for one in (lf.Interval(2, 3), lf.Interval(1.5), some):
        for two in (lf.Interval(2, 3), lf.Interval(0), some):
            if one is some or two is some:
                pairs = [(one[k] if one is some else one, two[k] if two is some else two) for k in range(3)]
                assert (one < two).tolist() == [a < b for a, b in pairs] == (two > one).tolist()
                assert (one <= two).tolist() == [a <= b for a, b in pairs] == (two >= one).tolist()
    for numbers in (np.array([0, 2, 4]), np.float64(2), 2):
        assert (numbers < some).tolist() == (some > numbers).tolist()
        assert (numbers >= some).tolist() == (some <= numbers).tolist()
    assert not (some < np.nan).any() and not (some >= np.nan).any()
    square = lf.Intervals([[1, 2], [3, 4]], [[1, 2], [3, 4]])
    assert (square < [2, 3]).tolist() == [[True, True], [False, False]]
    with pytest.raises(ValueError):
        some < [1, 2]
    with pytest.raises(TypeError):
        some < "text"


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


def test_maps_are_arrays():
    turn = lf.Affine.rotation([0, 0, 1], 30, about=[1, 2, 3])
    assert (np.asarray(turn) == turn.matrix).all() and np.array(turn, np.float32).dtype == np.float32
    assert lf.Affine(np.asarray(turn)) == turn and np.stack([turn, turn]).shape == (2, 4, 4)
    own = np.asarray(turn)
    own[0, 0] = 7
    assert turn.matrix[0, 0] != 7
    with pytest.raises(ValueError, match="copy"):
        turn.__array__(copy=False)


class Backwards:
    """A class with its own multiplication by a map."""

    def __rmatmul__(self, map):
        return "mine"


def test_products_of_maps_say_what_is_wrong():
    move = lf.Affine.translation([1, 2, 3])
    for wrong in (np.eye(3), np.zeros((4, 4)), np.eye(4)[::-1], [[1, 2], [3]], [move], np.stack([np.eye(4)] * 2)):
        with pytest.raises(lf.ArgumentError):
            move @ wrong
        with pytest.raises(lf.ArgumentError):
            wrong @ move
    with pytest.raises(lf.Error):
        lf.Affine.scale(1e200) @ lf.Affine.scale(1e200)
    assert move @ np.eye(4).tolist() == move == np.eye(3, 4).tolist() @ move
    assert move @ Backwards() == "mine"
    for wrong in (3, "text", None):
        with pytest.raises(TypeError, match="unsupported operand"):
            move @ wrong


def test_lists_of_maps_and_matrices():
    block, pin = lf.Csg.cuboid([0, 0, 0], [2, 2, 2]), lf.Csg.ball([0, 0, 0], 1)
    maps = [lf.Affine.translation([x, 0, 0]) for x in (-2, 0, 4)]
    mixed = [maps[0].matrix, maps[1], maps[2].matrix[:3].tolist()]
    told = ["disjoint", "overlapping", "disjoint"]
    for places in (maps, mixed, mixed[::-1], tuple(mixed), np.stack(maps), [one.matrix for one in maps]):
        found = lf.interference(block, pin, places)
        assert isinstance(found, list) and [one.verdict for one in found] == told
    assert lf.interference(block, pin, [maps[1]])[0].verdict == "overlapping" and lf.interference(block, pin, []) == []
    with pytest.raises(lf.ArgumentError, match="placements"):
        lf.interference(block, pin, [maps[0], np.eye(3)])


@pytest.mark.parametrize(
    "value",
    [lf.Interval(1, 2), lf.Frame([0, 1, 2], 3, 4), lf.Affine.rotation([1, 2, 3], 77), lf.Intervals([1.0], [2.0])],
    ids=repr,
)
def test_values_are_pickled(value):
    assert pickle.loads(pickle.dumps(value)) == value and copy.deepcopy(value) == value
