"""A mesh certified in shards by two worker processes of Dask, beside a single build: bytes, memory and time.

    python benches/sharded.py MESH DEPTH [LEVEL]

Memory is the peak of resident memory of a process, less what it takes before the first task.
"""

import hashlib
import json
import os
import resource
import subprocess
import sys
import tempfile
import time


def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024


def mesh(path):
    import leafless as lf

    return lf.open(path, sew=False)


def single(path, depth):
    import leafless as lf

    solid, before = mesh(path), peak()
    frame = lf.Frame.around(solid.bounds, depth)
    start = time.perf_counter()
    octree = lf.build(solid, frame)
    seconds = time.perf_counter() - start
    built = peak()
    print(json.dumps({"s": seconds, "MB": built - before, "sha256": hashlib.sha256(octree.to_bytes()).hexdigest()}))


def sharded(path, depth, level):
    from distributed import Client, LocalCluster

    import leafless as lf
    from leafless import distributed

    solid = mesh(path)
    frame = lf.Frame.around(solid.bounds, depth)
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "memory_limit": 0}
    with tempfile.TemporaryDirectory() as folder, LocalCluster(**options) as cluster, Client(cluster) as client:
        # (The library is loaded before.)
        distributed.build(lf.Csg.ball([0, 0, 0], 1), os.path.join(folder, "ball"), depth=5, level=1)
        before = client.run(peak)
        start = time.perf_counter()
        parts = distributed.build(solid, os.path.join(folder, "mesh"), frame, level=level)
        seconds = time.perf_counter() - start
        after = client.run(peak)
        memory = [after[worker] - before[worker] for worker in after]
        start = time.perf_counter()
        volume = distributed.measure(parts, tolerance=0).volume
        measured = time.perf_counter() - start
        told = {
            "s": seconds,
            "MB": memory,
            "shards": len(parts),
            "bytes": parts.nbytes,
            "volume": str(volume),
            "measure s": measured,
        }
        if depth <= 12:
            told["sha256"] = hashlib.sha256(parts.join().to_bytes()).hexdigest()
        print(json.dumps(told))


if __name__ == "__main__":
    if sys.argv[1] in ("single", "sharded"):
        arguments = [sys.argv[2], *map(int, sys.argv[3:])]
        single(*arguments) if sys.argv[1] == "single" else sharded(*arguments)
    else:
        path, depth, level = sys.argv[1], sys.argv[2], (sys.argv[3:] or ["4"])[0]
        for arguments in (["single", path, depth], ["sharded", path, depth, level]):
            print(
                arguments[0],
                subprocess.run(
                    [sys.executable, __file__, *arguments], check=True, stdout=subprocess.PIPE, text=True
                ).stdout.strip(),
            )
