#!/usr/bin/env python3
"""What MeshLib's 3D nesting and `leafless layout` do with a box of mixed CAD parts.

    pip install meshlib numpy            # needed
    pip install trimesh python-fcl       # only for --fcl, the second check
    cargo build --release -p leafless-cli
    python nesting.py MODELS --stage leafless sequential --leafless ../../target/release/leafless ...

The stage `random` asks `leafless layout` for a thousand layouts by chance, and MeshLib for the exact distance of every
pair of parts that are near in them.

MODELS is a folder with featuretype.STL, angle_block.STL and plate_holes.STL. Every part is scaled
uniformly so that the longest side of its axis-aligned bounding box is 1 and moved to the origin.
The container is a cube of edge E.

Columns of the tables
  placed   parts with NestingResult.nested set
  wall/cpu seconds of the call alone (wall clock / processor time of all threads); of leafless those of the whole process,
           which reads the files, proves the layout, measures it and writes it
  d_cube   sum of true volumes of placed parts / E^3
  d_base   sum of true volumes of placed parts / (E * E * height reached)
  d_tight  sum of true volumes of placed parts / volume of the tight box of all placed parts
  min gap  smallest distance between two placed parts (exact mesh-mesh distance)
  <c       number of pairs nearer than the clearance asked for; coll: pairs that intersect
  out      by how much the worst part sticks out of the container
"""
import argparse, itertools, json, os, random, resource, subprocess, sys, tempfile, threading, time

ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
ap.add_argument("models", help="folder with the three STL files")
ap.add_argument("--counts", type=int, nargs=3, default=[30, 20, 10], metavar="N",
                help="number of featuretype, angle_block, plate_holes")
ap.add_argument("--clearance", type=float, default=0.02)
ap.add_argument("--stage", nargs="+", default=["series", "min", "densify", "sequential"],
                choices=["series", "min", "densify", "loose", "sequential", "limit", "drop", "leafless", "random"])
ap.add_argument("--leafless", default="leafless", help="the program")
ap.add_argument("--leafless-edges", type=float, nargs="*", default=None, help="E of stage leafless (default: --edge)")
ap.add_argument("--leafless-options", action="append", default=None,
                help="options of stage leafless, one string for each run (may be given several times)")
ap.add_argument("--layouts", type=int, default=1000, help="layouts of stage random")
ap.add_argument("--edges", type=float, nargs=3, default=[2.0, 4.5, 0.1], metavar=("FROM", "TO", "STEP"))
ap.add_argument("--min-step", type=float, default=0.01, help="step of E in stage min")
ap.add_argument("--min-range", type=float, nargs=2, default=None)
ap.add_argument("--edge", type=float, default=None, help="E of stage densify/sequential (default: found by stage min)")
ap.add_argument("--voxel", type=float, default=0.02, help="voxel size of the series")
ap.add_argument("--voxels", type=float, nargs="*", default=[0.08, 0.04, 0.02, 0.01])
ap.add_argument("--rounds", type=int, nargs="*", default=[1, 3, 10], help="repetitions of -Z -Y -X in stage densify")
ap.add_argument("--config", default="fixed/position", help="box configuration of stage densify: fixed|rot / position|density")
ap.add_argument("--iteration-limit", type=int, default=10_000_000)
ap.add_argument("--cores", type=int, default=1, help="pin the process to that many cores")
ap.add_argument("--seq-voxels", type=float, nargs="*", default=[0, 0.04, 0.02])
ap.add_argument("--seq-edges", type=float, nargs="*", default=None)
ap.add_argument("--loose-gap", type=float, default=0.1, help="gap of the box nesting that stage loose then densifies")
ap.add_argument("--no-check", action="store_true", help="skip collision and clearance check")
ap.add_argument("--fcl", action="store_true", help="repeat the check with trimesh + python-fcl")
ap.add_argument("--parts-out", default=None, help="write the scaled parts there (default: temporary folder)")
A = ap.parse_args()

# the thread pool of MeshLib (TBB) looks at the affinity mask when it starts
try:
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:A.cores])
except AttributeError:
    pass

import numpy as np
import meshlib
import meshlib.mrmeshpy as mm
from importlib.metadata import version

N = mm.Nesting
NAMES = ["featuretype", "angle_block", "plate_holes"]


# ---------------------------------------------------------------- parts
def read_stl(path):
    raw = open(path, "rb").read()
    n = int.from_bytes(raw[80:84], "little")
    if len(raw) != 84 + 50 * n:
        sys.exit(f"{os.path.basename(path)}: not a binary STL")
    d = np.frombuffer(raw, np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]), n, 84)
    return d["v"].astype(float)


def write_stl(path, t):
    d = np.zeros(len(t), np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]))
    d["v"] = t
    with open(path, "wb") as f:
        f.write(b"\0" * 80 + len(t).to_bytes(4, "little") + d.tobytes())


class Part:
    def __init__(self, name, out):
        t = read_stl(os.path.join(A.models, name + ".STL"))
        t -= t.reshape(-1, 3).min(0)
        t /= t.reshape(-1, 3).max()
        path = os.path.join(out, name + ".stl")
        write_stl(path, t)
        self.name, self.tri = name, read_stl(path)
        self.volume = float(np.einsum("ij,ij->i", self.tri[:, 0], np.cross(self.tri[:, 1], self.tri[:, 2])).sum() / 6)
        self.size = np.ptp(self.tri.reshape(-1, 3), axis=0)
        self.verts = np.unique(self.tri.reshape(-1, 3), axis=0)
        self.mesh = mm.loadMesh(path)
        mm.MeshBuilder.uniteCloseVertices(self.mesh, 1e-6)  # loadMesh leaves some seams of an STL open
        self.closed = self.mesh.topology.isClosed()


def xf_np(xf):
    m = np.eye(4)
    for i, r in enumerate("xyz"):
        row = getattr(xf.A, r)
        m[i, :3] = [row.x, row.y, row.z]
        m[i, 3] = getattr(xf.b, r)
    return m


# ---------------------------------------------------------------- nesting
def cube(E):
    return mm.Box3f(mm.Vector3f(0, 0, 0), mm.Vector3f(E, E, E))


def base(E):
    b = N.NestingBaseParams()
    b.nest, b.minInterval = cube(E), A.clearance
    return b


def box_options(E, config):
    o = N.BoxNestingOptions()
    rot, metric = config.split("/")
    o.allowRotation = rot == "rot"
    o.iterationLimit = A.iteration_limit
    if metric == "density":
        o.priorityMetric = N.getNeighborigDensityPriorityMetric(cube(E), 2 * A.clearance)
    return o


def meshxfs(items):
    """items: list of (part, xf)"""
    v = mm.Vector_Nesting_MeshXf_ObjId()
    for p, xf in items:
        x = N.MeshXf()
        x.mesh, x.xf = p.mesh, xf
        v.push_back(x)
    return v


class Clock:
    def __enter__(self):
        self.w, self.c = time.perf_counter(), time.process_time()
        return self

    def __exit__(self, *a):
        self.w, self.c = time.perf_counter() - self.w, time.process_time() - self.c


def box_nest(parts, E, config):
    p = N.BoxNestingParams()
    p.baseParams, p.options = base(E), box_options(E, config)
    v = meshxfs([(q, mm.AffineXf3f()) for q in parts])
    with Clock() as c:
        r = N.boxNesting(v, p)
    out = [(parts[i], mm.AffineXf3f(r[mm.ObjId(i)].xf)) for i in range(len(parts)) if r[mm.ObjId(i)].nested]
    return out, c


def sequence(rounds):
    s = mm.std_vector_OutEdge()
    for _ in range(rounds):
        for d in (mm.OutEdge.MinusZ, mm.OutEdge.MinusY, mm.OutEdge.MinusX):
            s.append(d)
    return s


def densify(placed, E, voxel, rounds):
    p = N.TetrisDensifyParams()
    p.baseParams = base(E)
    p.options.voxelSize = voxel
    p.options.densificationSequence = sequence(rounds)
    v = meshxfs(placed)
    with Clock() as c:
        r = N.tetrisNestingDensify(v, p)
    return [(q, r[mm.ObjId(i)] * xf) for i, (q, xf) in enumerate(placed)], c


def sequential(parts, E, config, voxel):
    """One part at a time, biggest bounding box first: a part that does not fit is skipped."""
    parts = sorted(parts, key=lambda q: -float(np.prod(q.size)))
    s = N.SequentialNester(base(E), voxel)
    o = box_options(E, config)
    out = []
    with Clock() as c:
        for q in parts:
            x = N.MeshXf()
            x.mesh, x.xf = q.mesh, mm.AffineXf3f()
            r = s.nestMesh(x, o)
            if r.nested:
                out.append((q, mm.AffineXf3f(r.xf)))
    return out, c


def leafless(kinds, counts, E, options, out):
    """Runs the program; returns its layout, the clock, and its report."""
    target = os.path.join(out, "layout.json")
    command = [A.leafless, "layout", f"box:{E},{E},{E}",
               *(os.path.join(out, q.name + ".stl") + f"*{n}" for q, n in zip(kinds, counts) if n > 0),
               "--clearance", str(A.clearance), "-o", target, "--json", *options]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with Clock() as c:
        done = subprocess.run(command, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    c.c = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    if done.returncode not in (0, 1) or not done.stdout:
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    kinds = [q for q, n in zip(kinds, counts) if n > 0]
    placed = []
    for copy in json.load(open(target))["placed"]:
        m = copy["matrix"]
        a = mm.Matrix3f(*(mm.Vector3f(*row[:3]) for row in m))
        placed.append((kinds[copy["item"]], mm.AffineXf3f(a, mm.Vector3f(*(row[3] for row in m)))))
    return placed, c, json.loads(done.stdout)


# ---------------------------------------------------------------- figures
def boxes(placed):
    b = []
    for q, xf in placed:
        m = xf_np(xf)
        v = q.verts @ m[:3, :3].T + m[:3, 3]
        b.append((v.min(0), v.max(0)))
    return b


def density(placed, E):
    if not placed:
        return dict(n=0, base=0, cube=0, tight=0, h=0, out=0, dims=(0, 0, 0), wall=0)
    b = boxes(placed)
    lo, hi = np.min([x[0] for x in b], 0), np.max([x[1] for x in b], 0)
    V = sum(q.volume for q, _ in placed)
    return dict(n=len(placed), base=V / (E * E * hi[2]), cube=V / E ** 3, tight=V / np.prod(hi - lo), h=hi[2],
                out=max(0, -lo.min(), (hi - E).max()), dims=hi - lo, wall=min(lo.min(), (E - hi).min()))


def check(placed, E, tol=1e-5):
    """exact mesh-mesh distances of all pairs whose boxes are nearer than the clearance"""
    c = A.clearance
    b = boxes(placed)
    baked = {}

    def bake(i):
        if i not in baked:
            m = mm.Mesh(placed[i][0].mesh)
            m.transform(placed[i][1])
            baked[i] = m
        return baked[i]

    near = [(i, j) for i, j in itertools.combinations(range(len(placed)), 2)
            if np.linalg.norm(np.maximum(0, np.maximum(b[i][0] - b[j][1], b[j][0] - b[i][1]))) < c]
    gap, viol, coll, below = np.inf, 0, 0, []
    for i, j in near:
        r = mm.findDistance(mm.MeshPart(bake(i)), mm.MeshPart(bake(j)))
        d = r.distSq ** 0.5
        hit = len(mm.findCollidingTriangles(mm.MeshPart(bake(i)), mm.MeshPart(bake(j)), None, True)) > 0 \
            or mm.isInside(mm.MeshPart(bake(i)), mm.MeshPart(bake(j))) or mm.isInside(mm.MeshPart(bake(j)), mm.MeshPart(bake(i)))
        d = 0.0 if hit else d
        gap = min(gap, d)
        if d < c - tol:
            viol += 1
            below.append(d)
        coll += hit
    res = dict(pairs=len(near), gap=gap, viol=viol, coll=coll)
    if A.fcl:
        res["fcl"] = check_fcl(placed, near, tol)
    return res


def check_fcl(placed, near, tol):
    import fcl
    geo, gap, viol, coll = {}, np.inf, 0, 0
    for q in {id(q): q for q, _ in placed}.values():
        m = fcl.BVHModel()
        m.beginModel(len(q.tri) * 3, len(q.tri))
        m.addSubModel(q.tri.reshape(-1, 3), np.arange(len(q.tri) * 3).reshape(-1, 3))
        m.endModel()
        geo[id(q)] = m
    ob = []
    for q, xf in placed:
        m = xf_np(xf)
        ob.append(fcl.CollisionObject(geo[id(q)], fcl.Transform(m[:3, :3], m[:3, 3])))
    for i, j in near:
        hit = fcl.collide(ob[i], ob[j], fcl.CollisionRequest(), fcl.CollisionResult()) > 0
        d = 0.0 if hit else fcl.distance(ob[i], ob[j], fcl.DistanceRequest(), fcl.DistanceResult())
        gap, viol, coll = min(gap, d), viol + (d < A.clearance - tol), coll + hit
    return dict(gap=gap, viol=viol, coll=coll)


def by_kind(placed):
    return "/".join(str(sum(q.name == n for q, _ in placed)) for n in NAMES)


HEAD = f"{'E':>5} {'step':28} {'placed':>6} {'kinds':>11} {'wall':>7} {'cpu':>7} {'height':>6} {'d_cube':>7} {'d_base':>7} {'d_tight':>7} {'out':>7} {'pairs':>5} {'min gap':>8} {'<c':>4} {'coll':>4}"


def row(E, step, placed, c):
    d = density(placed, E)
    s = f"{E:5.2f} {step:28} {d['n']:6} {by_kind(placed):>11} {c.w:7.2f} {c.c:7.2f} {d['h']:6.3f} {d['cube']:7.4f} {d['base']:7.4f} {d['tight']:7.4f} {d['out']:7.4f}"
    if not A.no_check and placed:
        k = check(placed, E)
        s += f" {k['pairs']:5} {k['gap']:8.5f} {k['viol']:4} {k['coll']:4}"
        if "fcl" in k:
            f = k["fcl"]
            s += f"   fcl: gap {f['gap']:.5f}, <c {f['viol']}, coll {f['coll']}"
    print(s, flush=True)


def cpu_model():
    try:
        return next(l.split(":", 1)[1].strip() for l in open("/proc/cpuinfo") if l.startswith("model name"))
    except (OSError, StopIteration):
        return "unknown"


def threads():
    """processor seconds of every thread of this process"""
    out = []
    try:
        for t in os.listdir("/proc/self/task"):
            f = open(f"/proc/self/task/{t}/stat").read().rsplit(")", 1)[1].split()
            out.append((int(f[11]) + int(f[12])) / os.sysconf("SC_CLK_TCK"))
    except OSError:
        pass
    return sorted(out, reverse=True)


def frange(a, b, s):
    return [round(a + i * s, 6) for i in range(int(round((b - a) / s)) + 1)]


CONFIGS = ["fixed/position", "rot/position", "fixed/density", "rot/density"]


def main():
    out = A.parts_out or tempfile.mkdtemp()
    os.makedirs(out, exist_ok=True)
    kinds = [Part(n, out) for n in NAMES]
    parts = [q for q, n in zip(kinds, A.counts) for _ in range(n)]
    V = sum(q.volume for q in parts)
    print(f"meshlib {version('meshlib')}, numpy {np.__version__}, python {sys.version.split()[0]}, CPU {cpu_model()}, "
          f"process pinned to {A.cores} of {os.cpu_count()} cores")
    for q, n in zip(kinds, A.counts):
        print(f"  {n} x {q.name}: size {np.round(q.size, 4)}, volume {q.volume:.6f}, "
              f"fills {q.volume / np.prod(q.size):.3f} of its box, {len(q.tri)} triangles, {'closed' if q.closed else 'NOT closed'}")
    print(f"  {len(parts)} parts, volume {V:.4f}, volume of their boxes {sum(np.prod(q.size) for q in parts):.4f}, clearance {A.clearance}")
    print("  configuration: fixed = allowRotation off, rot = on; position / density = priority metric\n")

    if "series" in A.stage:
        print("# series: boxNesting in four configurations, then tetrisNestingDensify (defaults: -Z -Y -X, voxel", A.voxel, ")")
        print(HEAD)
        for E in frange(*A.edges):
            for k in CONFIGS:
                placed, c = box_nest(parts, E, k)
                row(E, "box " + k, placed, c)
                if k == "fixed/position":
                    placed, c = densify(placed, E, A.voxel, 1)
                    row(E, "  densified", placed, c)
        print()

    best = {}
    if "min" in A.stage:
        print("# smallest E at which boxNesting places every part (scan, step", A.min_step, ")")
        lo, hi = A.min_range or A.edges[:2]
        for k in CONFIGS:
            ok, bad = [], []
            for E in reversed(frange(lo, hi, A.min_step)):
                if sum(q.volume for q in parts) > E ** 3:
                    break
                (ok if len(box_nest(parts, E, k)[0]) == len(parts) else bad).append(E)
                if len(bad) > 40 and ok and bad[-1] < min(ok) - 0.3:
                    break
            if ok:
                best[k] = min(ok)
                above = [e for e in bad if e > min(ok)]
                print(f"  {k:16} {min(ok):.2f}   V/E^3 = {V / min(ok) ** 3:.4f}" +
                      (f"   but fails again at {min(above):.2f}..{max(above):.2f} ({len(above)} values)" if above else ""), flush=True)
            else:
                print(f"  {k:16} none up to {hi}", flush=True)
        print()

    E0 = A.edge or (best.get(A.config)) or A.edges[1]
    if "densify" in A.stage:
        print("# densification of one box nesting, config", A.config)
        print(HEAD)
        placed0, c = box_nest(parts, E0, A.config)
        row(E0, "box " + A.config, placed0, c)
        for v in A.voxels:
            for r in A.rounds:
                placed, c = densify(placed0, E0, v, r)
                row(E0, f"voxel {v:g}, {r} x (-Z-Y-X)", placed, c)
        print()

    if "loose" in A.stage:
        print(f"# boxNesting with gap {A.loose_gap:g}, config {A.config}, then densified with gap {A.clearance:g}")
        print(HEAD)
        asked = A.clearance
        A.clearance = A.loose_gap
        placed0, c = box_nest(parts, E0, A.config)
        A.clearance = asked
        row(E0, f"box, gap {A.loose_gap:g}", placed0, c)
        for v in A.voxels:
            for r in A.rounds:
                placed, c = densify(placed0, E0, v, r)
                row(E0, f"voxel {v:g}, {r} x (-Z-Y-X)", placed, c)
        print()

    if "sequential" in A.stage:
        print("# SequentialNester, one part at a time, biggest box first (voxel 0: boxes only)")
        print(HEAD)
        for E in A.seq_edges or [E0]:
            for v in A.seq_voxels:
                placed, c = sequential(parts, E, A.config, v)
                row(E, f"sequential, voxel {v:g}", placed, c)
        print()

    if "leafless" in A.stage:
        print("# leafless layout")
        print(HEAD)
        for E in A.leafless_edges or [E0]:
            for options in A.leafless_options or [""]:
                placed, c, told = leafless(kinds, A.counts, E, options.split(), out)
                row(E, f"{options or 'as it is'}", placed, c)
                lower, upper = (told["filled_part"][end] for end in ("lower", "upper"))
                true = density(placed, E)["cube"]
                if not lower - 1e-6 <= true <= upper + 1e-6:
                    sys.exit(f"it tells that {lower} to {upper} are filled, which is {true}")
        print()

    if "random" in A.stage:
        chance, clock, pairs, copies, nearest = random.Random(40), time.perf_counter(), 0, 0, 9.0
        for number in range(A.layouts):
            E, A.clearance = chance.uniform(1.3, 2.2), chance.choice([0.001, 0.005, 0.02, 0.1])
            counts = [chance.randrange(5) for _ in kinds]
            counts[chance.randrange(3)] += 1
            options = ["--rounds", "1", "--cells", str(chance.choice([16, 24, 40])), "--seed", str(number),
                       "--orientations", chance.choice(["24", "free:6", "as-given"]),
                       "--objective", chance.choice(["count", "height", "density", f"balance={E / 2},{E / 2},{E / 2}"])]
            options += chance.choice([[], [], ["--free-along", "+z"]])
            placed, _, told = leafless(kinds, counts, E, options, out)
            # (MeshLib computes with single precision.)
            found, around = check(placed, E, 2e-6), density(placed, E)
            copies, pairs = copies + len(placed), pairs + found["pairs"]
            nearest = min(nearest, found["gap"] / A.clearance)
            if found["viol"] > 0 or found["coll"] > 0 or around["out"] > 1e-6:
                sys.exit(f"layout {number}: {found}, {around['out']} out of the box: {told}")
        print(f"# {A.layouts} layouts by chance: {copies} parts, {pairs} pairs nearer than the clearance by their boxes; the "
              f"nearest has {nearest:.5f} of the clearance; {time.perf_counter() - clock:.0f} s\n")

    if "limit" in A.stage:
        print("# iterationLimit: N equal plates in a cube that holds many more")
        plate = kinds[2]
        for n in (100, 200, 300, 400, 500, 600, 800):
            for k in ("fixed/position", "rot/position"):
                placed, c = box_nest([plate] * n, 12.0, k)
                print(f"  {k:16} N {n:4}: placed {len(placed):4}, wall {c.w:.2f} s", flush=True)
        print()

    if "drop" in A.stage:
        print("# ten featuretype and one angle_block ten times too large, in a cube of edge 4")
        p = N.BoxNestingParams()
        p.baseParams = base(4.0)
        v = meshxfs([(kinds[0], mm.AffineXf3f.translation(mm.Vector3f(7, 7, 7)))] * 10 +
                    [(kinds[1], mm.AffineXf3f.linear(mm.Matrix3f.scale(10.0)))])
        r = N.boxNesting(v, p)
        print(f"  placed {sum(r[mm.ObjId(i)].nested for i in range(11))} of 11; transform of an unplaced part: "
              f"given (7, 7, 7), returned {tuple(float(x) for x in np.round(xf_np(r[mm.ObjId(0)].xf)[:3, 3], 6))}")
        print()

    print(f"threads with processor time: {[round(t, 2) for t in threads() if t > 0.05]}, "
          f"peak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")


if __name__ == "__main__":
    main()
