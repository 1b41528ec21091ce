"""What a caller reads who gave a wrong argument: the name of the parameter, and what it must be."""

import numpy as np
import pytest

import leafless as lf

NAN, INF = float("nan"), float("inf")
ORIGIN, UNIT = [0, 0, 0], [[0, 0, 0], [1, 1, 1]]
BALL = lf.Csg.ball(ORIGIN, 1)
OCTREE = lf.build(BALL, depth=4)
MODEL = lf.dexelize(BALL, depth=3, directions="z")
MESH = lf.surface(BALL, tolerance=0.2)
VOLUME = lf.Volume(np.zeros((2, 2, 2), np.uint8), 1)
CHANNEL = lf.Channel.fill(1.0, OCTREE)
RECORDS = OCTREE.voxels()
ARRAYS = (RECORDS.frame, RECORDS.codes, RECORDS.levels, RECORDS.kinds)
DEVIATION = lf.deviation(BALL, BALL, tolerance=1, max_splits=100)


def lazy():
    return lf.LazyOctree(BALL)


#: Functions, arguments, the exception, and words of its message, in this order.
WRONG = [
    # Limits.
    (lf.build, (BALL,), {"max_bytes": -1}, ValueError, "max_bytes: whole number 0 -1"),
    (lf.build, (BALL,), {"max_bytes": 2**70}, ValueError, "max_bytes: whole number 2^64 - 1"),
    (lf.build, (BALL,), {"max_bytes": "much"}, TypeError, "max_bytes: whole number str"),
    (lf.build, (BALL,), {"max_nodes": 1.5}, TypeError, "max_nodes: whole number float"),
    (lf.build, (BALL,), {"threads": -2}, ValueError, "threads: whole number 0 -2"),
    (lf.build, (BALL,), {"threads": [1]}, TypeError, "threads: whole number list"),
    (lf.measure, (BALL,), {"max_splits": NAN}, TypeError, "max_splits: whole number float"),
    (lf.measure, (BALL,), {"progress": 3}, TypeError, "progress: function"),
    (lf.measure, (BALL,), {"splits": 3}, TypeError, "splits"),
    # Depths, levels, frames, bounds.
    (lf.Frame, (ORIGIN, 1, 0), {}, ValueError, "depth: 1 to 20 not 0"),
    (lf.Frame, (ORIGIN, 1, -1), {}, ValueError, "depth: 1 to 20 not -1"),
    (lf.Frame, (ORIGIN, 1, 2**70), {}, ValueError, "depth: 1 to 20"),
    (lf.Frame, (ORIGIN, 1, "deep"), {}, TypeError, "depth: whole number str"),
    (lf.Frame, (ORIGIN, 1, None), {}, TypeError, "depth: whole number NoneType"),
    (lf.Frame, (ORIGIN, NAN, 3), {}, ValueError, "edge: between"),
    (lf.Frame, (ORIGIN, "long", 3), {}, TypeError, "edge: number str"),
    (lf.Frame, ([0, 0], 1, 3), {}, ValueError, "origin: three numbers (2,)"),
    (lf.Frame, (3, 1, 3), {}, ValueError, "origin: three numbers ()"),
    (lf.Frame, ([0, 0, NAN], 1, 3), {}, ValueError, "origin: number"),
    (lf.Frame.around, ([[1, 1, 1], ORIGIN],), {}, ValueError, "bounds:"),
    (lf.Frame.fitted, ([[NAN] * 3, ORIGIN],), {}, ValueError, "bounds:"),
    (lf.Frame.around, (ORIGIN,), {}, ValueError, "bounds: lower upper corner (2, 3) not (3,)"),
    (lf.Frame.with_cells, (UNIT, -1), {}, ValueError, "cell: between"),
    (lf.build, (BALL, 3), {}, TypeError, "frame: a Frame or an Octree, not int"),
    (lf.build, (BALL,), {"depth": 21}, ValueError, "depth: 1 to 20 not 21"),
    (lf.build, ("ball",), {}, TypeError, "solid: solid str"),
    (lf.build, (~BALL,), {}, ValueError, "frame: must be given"),
    (lf.build, (BALL,), {"rule": "guess"}, ValueError, "rule: 'certified' 'guess'"),
    (lf.build, (BALL,), {"rule": 3}, TypeError, "rule: str int"),
    (lf.build, (BALL,), {"surfaces": -1}, ValueError, "surfaces: positive -1"),
    (lf.build, (BALL,), {"surfaces": "all"}, TypeError, "surfaces: True, False or a number, not str"),
    # Maps.
    (lf.Affine, (np.eye(2),), {}, ValueError, "matrix: 3×4 4×4 (2, 2)"),
    (lf.Affine, (np.full((3, 4), NAN),), {}, ValueError, "matrix: entry"),
    (lf.Affine.translation, ([NAN, 0, 0],), {}, ValueError, "offset: entry"),
    (lf.Affine.translation, ("far",), {}, ValueError, "offset: numbers"),
    (lf.Affine.rotation, (ORIGIN, 90), {}, ValueError, "axis: not all zero"),
    (lf.Affine.rotation, ([0, 0, NAN], 90), {}, ValueError, "axis: finite NaN"),
    (lf.Affine.rotation, ([0, 0, 1], NAN), {}, ValueError, "degrees: finite NaN"),
    (lf.Affine.rotation, ([0, 0, 1], INF), {}, ValueError, "degrees: finite inf"),
    (lf.Affine.rotation, ([0, 0, 1], "90"), {}, TypeError, "degrees: number str"),
    (lf.Affine.rotation, ([0, 0, 1], 90), {"about": [NAN, 0, 0]}, ValueError, "about: entry"),
    (lf.Affine.scale, (0,), {}, ValueError, "factor: not be 0"),
    (lf.Affine.scale, ([1, 2],), {}, ValueError, "factor: three numbers (2,)"),
    (lf.Affine.scale, (NAN,), {}, ValueError, "factor: entry"),
    (BALL.placed, (3,), {}, ValueError, "placement: matrix ()"),
    (BALL.placed, (np.full((3, 4), NAN),), {}, ValueError, "placement: entry"),
    (lf.interference, (BALL, BALL, np.full((2, 3, 4), NAN)), {}, ValueError, "placements: entry"),
    # Expressions.
    (lf.Csg.ball, (ORIGIN, -1), {}, ValueError, "radius: between"),
    (lf.Csg.ball, (ORIGIN, "1"), {}, TypeError, "radius: number str"),
    (lf.Csg.ball, (ORIGIN, None), {}, TypeError, "radius: number NoneType"),
    (lf.Csg.half_space, (ORIGIN, 0), {}, ValueError, "normal:"),
    (lf.Csg.quadric, ([1, 2],), {}, ValueError, "coefficients: 10 numbers not 2"),
    (lf.Csg.quadric, (1,), {}, TypeError, "coefficients: 10 numbers int"),
    (lf.Csg.cuboid, ([1, 1, 1], ORIGIN), {}, ValueError, "max: greater min"),
    (lf.Csg.ellipsoid, (ORIGIN, [1, 2, NAN]), {}, ValueError, "radii: between"),
    (lf.Csg.cylinder, (1, NAN, 1), {}, ValueError, "low: number"),
    (lf.Csg.cylinder, (1, 0, NAN), {}, ValueError, "high: number"),
    (lf.Csg.cylinder, (1, 1, 0), {}, ValueError, "high: greater low"),
    (lf.Csg.cylinder_between, ([NAN, 0, 0], [1, 0, 0], 1), {}, ValueError, "start: number"),
    (lf.Csg.cylinder_between, (ORIGIN, [NAN, 0, 0], 1), {}, ValueError, "end: number"),
    (lf.Csg.cylinder_between, (ORIGIN, ORIGIN, 1), {}, ValueError, "end: another point than start"),
    (lf.Csg.cylinder_between, (ORIGIN, [0, 0, 1], 0), {}, ValueError, "radius: between"),
    (lf.Csg.frustum, (-1, 1, 0, 1), {}, ValueError, "bottom: between"),
    (lf.Csg.frustum, (1, NAN, 0, 1), {}, ValueError, "top: between"),
    (lf.Csg.frustum_between, (ORIGIN, [0, 0, 1], [1, -1]), {}, ValueError, "radii: between"),
    (lf.Csg.frustum_between, (ORIGIN, [0, 0, 1], 1), {}, TypeError, "radii: 2 numbers int"),
    (lf.Csg.torus, (1, NAN), {}, ValueError, "minor: between"),
    (lf.Csg.wedge, ([1, 1, 0], 1), {}, ValueError, "size: between"),
    (lf.Csg.prism, ([[0, 0, 0]], 0, 1), {}, ValueError, "polygon: (n, 2) not (1, 3)"),
    (lf.Csg.prism, ([1, 2], 0, 1), {}, ValueError, "polygon: (n, 2) not (2,)"),
    (lf.Csg.prism, ([], 0, 1), {}, ValueError, "polygon: three corners"),
    (lf.Csg.prism, ("round", 0, 1), {}, ValueError, "polygon: numbers"),
    (lf.Csg.convex, ([[1, 0, 0]],), {}, ValueError, "planes: (n, 4) not (1, 3)"),
    (lf.Csg.convex, (1,), {}, ValueError, "planes: (n, 4) not ()"),
    (lf.Csg.convex, ([[NAN, 0, 0, 1]],), {}, ValueError, "planes: number"),
    (lf.Csg.convex, ([],), {}, ValueError, "planes: empty"),
    (lf.Csg.union_of, (BALL, 3), {}, TypeError, "solids: solid int"),
    (lf.Csg.difference_of, (BALL, 3), {}, TypeError, "others: solid int"),
    (lf.Csg.from_scene, ("cube(",), {}, ValueError, "scene: line 1"),
    (lf.Csg.from_scene, (3,), {}, TypeError, "text: str int"),
    (lf.Csg.from_scene, ("cube(1);", 3), {}, TypeError, "folder: path int"),
    # Questions.
    (BALL.contains, ([1, 2],), {}, ValueError, "points: (n, 3) not (2,)"),
    (BALL.contains, ("here",), {}, ValueError, "points: numbers"),
    (BALL.distances, (ORIGIN,), {"to": "moon"}, ValueError, "to: 'boundary' 'moon'"),
    (BALL.distances, (ORIGIN,), {"tolerance": -1}, ValueError, "tolerance:"),
    (BALL.distances, (ORIGIN,), {"tolerance": NAN}, ValueError, "tolerance:"),
    (BALL.rays, ([NAN, 0, 0], [1, 0, 0]), {}, ValueError, "origins: number"),
    (BALL.rays, (ORIGIN, ORIGIN), {}, ValueError, "directions: zero"),
    (BALL.rays, (np.zeros((3, 3)), np.ones((2, 3))), {}, ValueError, "directions: one as many as origins, 3, not 2"),
    (BALL.rays, (ORIGIN, [1, 0, 0]), {"last": NAN}, ValueError, "last: between"),
    (BALL.rays, (ORIGIN, [1, 0, 0]), {"on": "both"}, ValueError, "on: 'outer' 'both'"),
    (lf.measure, (BALL,), {"tolerance": -1}, ValueError, "tolerance:"),
    (lf.measure, (BALL,), {"tolerance": NAN}, ValueError, "tolerance:"),
    (lf.measure, (BALL,), {"absolute": NAN}, ValueError, "absolute:"),
    (lf.surface_area, (BALL,), {"tolerance": NAN}, ValueError, "tolerance:"),
    (lf.bounding_box, (BALL,), {"tolerance": "small"}, TypeError, "tolerance: number str"),
    (lf.interference, (BALL, "ball"), {}, TypeError, "b: solid str"),
    (lf.interference, (BALL, BALL), {"tolerance": NAN}, ValueError, "tolerance:"),
    (lf.interference, (BALL, BALL, 3), {}, ValueError, "placements: matrix ()"),
    (lf.clearance, (BALL, BALL), {"tolerance": -1}, ValueError, "tolerance:"),
    (lf.gap_at_least, (BALL, BALL, -1), {}, ValueError, "least: between"),
    (lf.deviation, (BALL, BALL), {"tolerance": NAN}, ValueError, "tolerance:"),
    (DEVIATION.within, ("near",), {}, TypeError, "distance: number str"),
    (lf.Interval, (1, 0), {}, ValueError, "upper: below lower, 1, not 0"),
    (lf.Interval, (NAN,), {}, ValueError, "lower: NaN"),
    (lf.Interval, ("low",), {}, TypeError, "lower: number str"),
    # Meshes.
    (lf.Mesh, ([[0, 0]], [[0, 1, 2]]), {}, ValueError, "vertices: (n, 3) not (1, 2)"),
    (lf.Mesh, (MESH.vertices, [[0, 1]]), {}, ValueError, "faces: (n, 3) not (1, 2)"),
    (lf.Mesh, (MESH.vertices, [[0, 1, 2.5]]), {}, TypeError, "faces: whole numbers float64"),
    (lf.Mesh, (MESH.vertices, [[0, 1, -1]]), {}, ValueError, "faces: -1"),
    (lf.Mesh, (MESH.vertices, MESH.faces), {"fill": "odd"}, ValueError, "fill: 'nonzero' 'odd'"),
    (lf.Mesh, (MESH.vertices, MESH.faces), {"fill": None}, TypeError, "fill: str NoneType"),
    (lf.Mesh.from_trimesh, (3,), {}, TypeError, "mesh: vertices and faces int"),
    (MESH.attribute, ("colour",), {}, ValueError, "name: 'colour'"),
    (lf.simplify, (BALL, 0.1), {}, TypeError, "mesh: Mesh Csg"),
    (lf.simplify, (MESH, -1), {}, ValueError, "tolerance: between"),
    (lf.surface, (BALL,), {"method": "magic"}, ValueError, "method: 'faces' 'magic'"),
    (lf.surface, (BALL,), {"method": 3}, TypeError, "method: str int"),
    (lf.surface, (OCTREE,), {"resolve": "both"}, ValueError, "resolve: 'outer' 'both'"),
    (lf.surface, (BALL,), {"tolerance": NAN}, ValueError, "tolerance: between"),
    # Octrees.
    (lf.Octree.from_bytes, ("text",), {}, TypeError, "data: bytes str"),
    (lf.Octree.union_of, (OCTREE, BALL), {}, TypeError, "octrees: an Octree, not Csg"),
    (lf.Octree.union_of, (), {}, ValueError, "octrees:"),
    (OCTREE.cells, ("half",), {}, ValueError, "tags: 'empty' 'half'"),
    (OCTREE.cells, (3,), {}, TypeError, "tags: Tag int"),
    (OCTREE.tag_at, ([0, 0],), {}, ValueError, "at: 3 numbers not 2"),
    (OCTREE.tag_at, ([0, 0, -1],), {}, ValueError, "at: whole number -1"),
    (OCTREE.tag_at, ([0, 0, 16],), {}, ValueError, "at: cell"),
    (OCTREE.tag_at, (3,), {}, TypeError, "at: 3 numbers int"),
    (OCTREE.bitmap, (5,), {}, ValueError, "level: depth"),
    (OCTREE.bitmap, (-1,), {}, ValueError, "level: 0 to 20 not -1"),
    (OCTREE.bitmap, (), {"first": [3, 0, 0], "end": [2, 1, 1]}, ValueError, "end: first"),
    (OCTREE.bitmap, (), {"end": [17, 1, 1]}, ValueError, "end: 16 cells"),
    (OCTREE.bitmap, (), {"first": [-1, 0, 0]}, ValueError, "first: whole number -1"),
    (OCTREE.bitmap, (), {"outer": "yes"}, TypeError, "outer: True or False, not str"),
    (OCTREE.classify_box, ([[1, 1, 1], ORIGIN],), {}, ValueError, "bounds:"),
    (OCTREE.classify_box, ([[NAN, 1, 1], [2, 2, 2]],), {}, ValueError, "bounds:"),
    (OCTREE.channel, ("heat",), {}, ValueError, "name: 'heat'"),
    (OCTREE.with_channel, ("heat", 3), {}, TypeError, "channel: a Channel, not int"),
    (OCTREE.with_metadata, ([],), {}, TypeError, "metadata: dict list"),
    (OCTREE.with_metadata, ({"a": 1},), {}, TypeError, "metadata: str int"),
    (OCTREE.voxels, (), {"boundary_depth": 21}, ValueError, "boundary_depth: 1 to 20 not 21"),
    (OCTREE.plain, (0,), {}, ValueError, "depth: 1 to 20 not 0"),
    (lazy().refine, (21,), {}, ValueError, "level: 0 to 20 not 21"),
    (lazy().refine, (3,), {"bounds": [[1, 1, 1], ORIGIN]}, ValueError, "bounds:"),
    (lazy().refine, (3,), {"bounds": [[NAN, 1, 1], [2, 2, 2]]}, ValueError, "bounds:"),
    (lazy().refine, (3,), {"point": [0, 0]}, ValueError, "point: three numbers (2,)"),
    (lazy().refine, (3,), {"ray": 3}, TypeError, "ray: origin direction int"),
    (lazy().refine, (3,), {"ray": (ORIGIN, ORIGIN)}, ValueError, "ray:"),
    (lf.LazyOctree, (BALL,), {"resume": BALL}, TypeError, "resume: an Octree, not Csg"),
    # Volumes and channels.
    (lf.Volume, (np.zeros((2, 2)),), {}, ValueError, "array: three axes 2"),
    (lf.Volume, (np.zeros((2, 2, 2)),), {}, TypeError, "array: float32 float64"),
    (lf.Volume, (VOLUME.array, NAN), {}, ValueError, "threshold: number nan"),
    (lf.Volume, (VOLUME.array, (2, 1)), {}, ValueError, "threshold: least greatest (2, 1)"),
    (lf.Volume, (VOLUME.array, "high"), {}, TypeError, "threshold: number str"),
    (VOLUME.with_threshold, (NAN,), {}, ValueError, "threshold: number nan"),
    (lf.Volume, (VOLUME.array,), {"origin": [NAN, 0, 0]}, ValueError, "origin: number"),
    (lf.Volume, (VOLUME.array,), {"spacing": 0}, ValueError, "spacing: between"),
    (lf.Volume, (VOLUME.array,), {"order": "yxz"}, ValueError, "order: 'xyz' 'yxz'"),
    (lf.Channel.fill, (-1, OCTREE), {"dtype": "uint8"}, ValueError, "values: range"),
    (lf.Channel.fill, ([], OCTREE), {}, ValueError, "values: 1 to 4 (0,)"),
    (lf.Channel.fill, ([[1, 2]], OCTREE), {}, ValueError, "values: 1 to 4 (1, 2)"),
    (lf.Channel.fill, (lambda points: [1, 2], OCTREE), {}, ValueError, "values: shape (1,)"),
    (lf.Channel.fill, (1, BALL), {}, TypeError, "solid: an Octree Csg"),
    (lf.Channel.fill, (1,), {}, ValueError, "frame: must be given"),
    (lf.Channel.fill, (1, OCTREE), {"cell": -1}, ValueError, "cell: positive"),
    (lf.Channel.fill, (1, OCTREE), {"dtype": "float64"}, ValueError, "dtype: 'uint8' 'float64'"),
    (lf.Channel.fill, (VOLUME, OCTREE), {"nearest": 1}, TypeError, "nearest: True or False, not int"),
    (CHANNEL.summary, (BALL,), {}, TypeError, "solid: an Octree, not Csg"),
    (CHANNEL.summary, (), {"bounds": ORIGIN}, ValueError, "bounds: (2, 3) not (3,)"),
    # Voxels and tri-dexel models.
    (lf.VoxelRecords, (3, *ARRAYS[1:]), {}, TypeError, "frame: a Frame, not int"),
    (lf.VoxelRecords, (*ARRAYS[:2], ARRAYS[2][1:], ARRAYS[3]), {}, ValueError, "levels: as many as codes"),
    (lf.VoxelRecords, (ARRAYS[0], [0.5], [1], [1]), {}, TypeError, "codes: whole numbers float64"),
    (lf.VoxelRecords, (ARRAYS[0], [-1], [1], [1]), {}, ValueError, "codes: whole numbers from 0"),
    (lf.VoxelRecords, (ARRAYS[0], [1], [300], [1]), {}, ValueError, "levels: whole numbers 0 to 255"),
    (lf.VoxelRecords, ARRAYS, {"values": [1.0]}, ValueError, "values: as many as codes"),
    (RECORDS.depth_order, ([NAN, 0, 0],), {}, ValueError, "eye: number"),
    (RECORDS.to_octree, ("branch",), {}, ValueError, "boundary: 'partial' 'branch'"),
    (RECORDS.to_octree, (3,), {}, TypeError, "boundary: Tag int"),
    (lf.dexelize, (BALL,), {"directions": "w"}, ValueError, "directions: x, y and z 'w'"),
    (lf.dexelize, (BALL,), {"directions": ""}, ValueError, "directions: x, y and z ''"),
    (lf.dexelize, (BALL,), {"normals": 8}, ValueError, "normals: 16 or 32 8"),
    (lf.dexelize, (BALL,), {"rule": "certified"}, ValueError, "rule: certified"),
    (MODEL.volume, (0,), {}, ValueError, "axis: 0 z"),
    (MODEL.rays, (3,), {}, ValueError, "axis: 3 z"),
    (MODEL.rays, (-1,), {}, ValueError, "axis: whole number -1"),
    (lf.TriDexel.union_of, (MODEL, OCTREE), {}, TypeError, "models: a TriDexel, not Octree"),
    (lf.TriDexel.union_of, (), {}, ValueError, "models:"),
    # Pictures.
    (lf.render, (), {}, ValueError, "solids: one"),
    (lf.render, (3,), {}, TypeError, "solids: solid int"),
    (lf.render, (BALL,), {"size": (0, 10)}, ValueError, "size:"),
    (lf.render, (BALL,), {"size": (10, 0)}, ValueError, "size: pixels"),
    (lf.render, (BALL,), {"size": (10**6, 10)}, ValueError, "size: pixels"),
    (lf.render, (BALL,), {"size": (-1, 10)}, ValueError, "size: whole number -1"),
    (lf.render, (BALL,), {"size": 640}, TypeError, "size: 2 numbers int"),
    (lf.render, (BALL,), {"size": (1, 2, 3)}, ValueError, "size: 2 numbers not 3"),
    (lf.render, (BALL,), {"view": (NAN, 0)}, ValueError, "view: number"),
    (lf.render, (BALL,), {"view": "top"}, TypeError, "view: number str"),
    (lf.render, (BALL,), {"colours": [(1, 2)]}, ValueError, "colours: 0 to 255"),
    (lf.render, (BALL,), {"colours": [(1, 2, 300)]}, ValueError, "colours: 0 to 255"),
    (lf.render, (BALL,), {"colours": 3}, ValueError, "colours: 0 to 255"),
    (lf.render, (BALL, BALL), {"colours": [(1, 2, 3)]}, ValueError, "colours: 2 rows"),
    (lf.render, (BALL,), {"clip": [1, 2]}, ValueError, "clip: (n, 4) not (2,)"),
    (lf.render, (BALL,), {"clip": [[0, 0, 0, 1]]}, ValueError, "clip: normal"),
    (lf.render, (BALL,), {"slice": (0, 0, 0, 1)}, ValueError, "slice: zero"),
    (lf.render, (BALL,), {"slice": (NAN, 0, 0, 1)}, ValueError, "slice:"),
    (lf.render, (BALL,), {"slice": (0, 0, 1)}, ValueError, "slice: 4 numbers not 3"),
    (lf.render, (BALL,), {"background": (0, 0, 0, 256)}, ValueError, "background: 0 to 255 256"),
    (lf.render, (BALL,), {"samples": 5}, ValueError, "samples: 1, 4"),
    (lf.render, (BALL,), {"frame": "cube"}, TypeError, "frame: Frame str"),
    # Files.
    (lf.open, (3,), {}, TypeError, "path: str or a path, not int"),
    (lf.open, ("none.stl",), {}, FileNotFoundError, "none.stl"),
    (lf.open, ("none.stl",), {"fill": "odd"}, ValueError, "fill: 'nonzero' 'odd'"),
    (lf.open, ("none.stl",), {"fill": 3}, TypeError, "fill: str int"),
    (lf.open, ("none.stl",), {"unit": "ell"}, ValueError, "unit: mm"),
    (lf.open, ("none.stl",), {"to_unit": "ell"}, ValueError, "to_unit: mm"),
    (lf.open, ("none.stl",), {"scale": "big"}, TypeError, "scale: number str"),
    (lf.open, ("none.stl",), {"sew": 1}, TypeError, "sew: True or False, not int"),
    (lf.open, ("none.stl",), {"max_bytes": -1}, ValueError, "max_bytes: whole number -1"),
    (lf.open, ("none.stl",), {"colour": 1}, TypeError, "colour"),
    (lf.map, (None,), {}, TypeError, "path: str or a path, not NoneType"),
    (lf.map, ("memory://none.lfl",), {}, ValueError, "path: open"),
    (lf.map, ("none.lfl",), {"verify": 1}, TypeError, "verify: True or False, not int"),
    (lf.save, (3, "a.lfl"), {}, TypeError, "object: int"),
    (lf.save, (BALL, "a.lfl"), {}, TypeError, "object: Csg build"),
    (lf.save, (OCTREE, "a.stl"), {}, ValueError, "path: a.stl .lfl"),
    (lf.save, (OCTREE, 3), {}, TypeError, "path: str or a path, not int"),
]


def told(line):
    function, arguments, named, *_ = line
    return f"{function.__qualname__}{arguments}{named}"[:80]


@pytest.mark.parametrize("function, arguments, named, error, words", WRONG, ids=map(told, WRONG))
def test_messages_name_the_parameter(function, arguments, named, error, words):
    with pytest.raises(error) as raised:
        function(*arguments, **named)
    message = str(raised.value)
    first, *others = words.split()
    # (What Python itself says begins otherwise.)
    assert message.startswith(first) if first.endswith(":") else first in message, message
    for word in others:
        assert word in message, (word, message)


def test_zero_threads_are_all():
    assert lf.build(BALL, depth=4, threads=0) == OCTREE
