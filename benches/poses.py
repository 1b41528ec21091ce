"""Ten thousand poses of an interference on two worker processes of Dask, beside one process.

python benches/poses.py MESH [POSES]
"""

import sys
import time

import numpy as np


def main(path, count=10_000):
    from distributed import Client, LocalCluster

    import leafless as lf
    from leafless import distributed

    part = lf.open(path)
    size = part.bounds[1] - part.bounds[0]
    random = np.random.default_rng(5)
    turns = random.normal(size=(count, 3))
    places = [
        lf.Affine.translation(random.uniform(-1.1, 1.1, 3) * size)
        @ lf.Affine.rotation(turns[i], random.uniform(0, 360), part.bounds.mean(axis=0))
        for i in range(count)
    ]
    start = time.perf_counter()
    expected = lf.interference(part, part, places)
    print(f"one process, all processors: {time.perf_counter() - start:.2f} s")
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, memory_limit=0) as cluster,
        Client(cluster),
    ):
        distributed.sweep(abs, [1, 2])
        for batch in (64, 256, 1024):
            start = time.perf_counter()
            found = distributed.interference(part, part, places, batch=batch)
            seconds = time.perf_counter() - start
            verdicts = [one.verdict for one in found]
            same = verdicts == [one.verdict for one in expected]
            counts = {word: verdicts.count(word) for word in sorted(set(verdicts))}
            print(f"two workers, {batch} poses a task: {seconds:.2f} s, same verdicts: {same}, {counts}")


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:]))
