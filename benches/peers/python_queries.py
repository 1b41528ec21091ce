"""Points, rays and distances of a mesh in batches from Python, beside trimesh, Open3D and libigl, in one run.

    pip install ./python trimesh embreex rtree scipy open3d libigl
    python benches/peers/python_queries.py MESH

Prints the median time of a call and of a point for batches of 1, 1000 and 1000000, and how often a peer's answer differs from what is proven.
Peers that are not installed are left out. Each takes the arrays that it likes best: Open3D single precision, the others doubles.
"""

import statistics
import sys
import time

import numpy as np

import leafless as lf

SIZES = (1, 1_000, 1_000_000)
#: A call that takes longer is not repeated, and a larger batch that would take longer is left out (seconds).
PATIENCE = 30


def median(call):
    """The median time of a call, and its answer."""
    begin = time.perf_counter()
    answer = call()
    first = time.perf_counter() - begin
    if first > 2:
        return first, answer
    times = []
    while len(times) < 5 or sum(times) < 0.3 and len(times) < 2000:
        begin = time.perf_counter()
        call()
        times.append(time.perf_counter() - begin)
    return statistics.median(times), answer


def questions(mesh):
    """Random points in the box around a mesh, grown by a tenth, and rays from them to points of the box."""
    generator = np.random.default_rng(0)
    low, high = mesh.bounds
    margin = 0.1 * (high - low)
    points = generator.uniform(low - margin, high + margin, (SIZES[-1], 3)).astype(np.float32).astype(np.float64)
    aims = generator.uniform(low, high, points.shape)
    along = aims - points
    along /= np.linalg.norm(along, axis=1)[:, None]
    return points, along.astype(np.float32).astype(np.float64)


class Leafless:
    def __init__(self, mesh):
        self.mesh = mesh

    def contains(self, points):
        return self.mesh.contains(points)

    def rays(self, origins, directions):
        hits = self.mesh.rays(origins, directions)
        return hits.distance.upper

    def distances(self, points):
        return self.mesh.distances(points).distance.middle


class Trimesh:
    def __init__(self, mesh):
        import trimesh

        self.trimesh = trimesh
        self.mesh = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)

    def contains(self, points):
        return self.mesh.contains(points)

    def rays(self, origins, directions):
        found = np.full(len(origins), np.inf)
        places, rays, _ = self.mesh.ray.intersects_location(origins, directions, multiple_hits=False)
        found[rays] = np.linalg.norm(places - origins[rays], axis=1)
        return found

    def distances(self, points):
        return -self.trimesh.proximity.signed_distance(self.mesh, points)


class Open3D:
    def __init__(self, mesh):
        import open3d

        self.tensor = lambda array: open3d.core.Tensor(np.ascontiguousarray(array, np.float32))
        self.scene = open3d.t.geometry.RaycastingScene()
        self.scene.add_triangles(self.tensor(mesh.vertices), open3d.core.Tensor(mesh.faces.astype(np.uint32)))

    def contains(self, points):
        return self.scene.compute_occupancy(self.tensor(points)).numpy() != 0

    def rays(self, origins, directions):
        return self.scene.cast_rays(self.tensor(np.hstack([origins, directions])))["t_hit"].numpy()

    def distances(self, points):
        return self.scene.compute_signed_distance(self.tensor(points)).numpy()


class Libigl:
    def __init__(self, mesh):
        import igl

        self.igl = igl
        self.vertices, self.faces = np.array(mesh.vertices), np.array(mesh.faces, np.int64)

    def contains(self, points):
        return np.abs(self.igl.fast_winding_number(self.vertices, self.faces, points)) >= 0.5

    def rays(self, origins, directions):
        raise NotImplementedError

    def distances(self, points):
        answer = self.igl.signed_distance(
            points, self.vertices, self.faces, sign_type=self.igl.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER
        )
        return answer[0]


def main(path):
    mesh = lf.open(path)
    points, along = questions(mesh)
    scale = float(np.max(mesh.bounds[1] - mesh.bounds[0]))
    print(f"{path}: {len(mesh.faces)} triangles, closed: {mesh.is_closed}")
    programs = {}
    for program in (Leafless, Trimesh, Open3D, Libigl):
        try:
            programs[program.__name__] = program(mesh)
        except ImportError as error:
            print(f"({program.__name__} is left out: {error})")
    membership = mesh.contains(points)
    proven = mesh.distances(points, tolerance=1e-9 * scale).distance
    hits = mesh.rays(points, along)
    # A ray that is proven to begin inside, or near the surface, is no question about the first triangle.
    outside = membership == lf.OUTSIDE
    for question in ("contains", "rays", "distances"):
        print(f"\n{question:<10}" + "".join(f"{size:>24,}" for size in SIZES) + "    differs from the proof")
        for name, program in programs.items():
            line, answer, worst = f"{name:<10}", None, 0.0
            for size in SIZES:
                if worst * size > PATIENCE:
                    line += f"{'-':>24}"
                    answer = None
                    continue
                arguments = (points[:size], along[:size]) if question == "rays" else (points[:size],)
                try:
                    taken, answer = median(lambda: getattr(program, question)(*arguments))
                except NotImplementedError:
                    line += f"{'-':>24}"
                    continue
                worst = taken / size if size > 1 else 0.0
                line += f"{1e6 * taken:>12,.1f} µs {1e9 * taken / size:>8,.0f} ns"
            if answer is not None and name != "Leafless":
                count = len(answer)
                if question == "contains":
                    known = membership[:count] != lf.UNDECIDED
                    wrong = known & (np.asarray(answer, bool) != (membership[:count] == lf.INSIDE))
                    line += f"    {wrong.sum()} of {known.sum():,}"
                elif question == "rays":
                    lower, upper = hits.distance.lower[:count], hits.distance.upper[:count]
                    slack = 1e-4 * scale
                    with np.errstate(invalid="ignore"):
                        wrong = outside[:count] & ((answer < lower - slack) | (answer > upper + slack))
                    line += f"    {wrong.sum()} of {outside[:count].sum():,} by 1e-4 of the size"
                else:
                    slack = 1e-4 * scale
                    lower, upper = proven.lower[:count], proven.upper[:count]
                    wrong = (answer < lower - slack) | (answer > upper + slack)
                    line += f"    {wrong.sum()} of {count:,} by 1e-4 of the size"
            print(line, flush=True)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
