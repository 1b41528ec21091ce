"""Shards behind a web server: how many requests and bytes it takes until the first answers.

    python benches/shards_over_http.py MESH DEPTH [LEVEL]

The server is nginx (apt-get install nginx-light), of whose log the requests are counted. Beside it stands what the whole octree takes
as one file.
"""

import os
import re
import subprocess
import sys
import tempfile
import time

import leafless as lf
from leafless import shards

CONFIGURATION = """
worker_processes 1;
daemon off;
error_log {folder}/error.log;
pid {folder}/pid;
events {{ worker_connections 64; }}
http {{
    log_format counted '$request_method $request_uri $status $body_bytes_sent';
    access_log {folder}/access.log counted;
    client_body_temp_path {folder}/t1; proxy_temp_path {folder}/t2; fastcgi_temp_path {folder}/t3;
    uwsgi_temp_path {folder}/t4; scgi_temp_path {folder}/t5;
    server {{ listen 127.0.0.1:{port}; root {folder}/data; }}
}}
"""


def main(path, depth, level=4, port=8713):
    solid = lf.open(path, sew=False)
    frame = lf.Frame.around(solid.bounds, depth)
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)
        data = os.path.join(folder, "data")
        parts = shards.build(solid, os.path.join(data, "shards"), frame, level=level)
        parts.pack(os.path.join(data, "packed"))
        whole = os.path.join(data, "whole.lfl")
        lf.save(parts.join(), whole)
        configuration = os.path.join(folder, "nginx.conf")
        with open(configuration, "w") as file:
            file.write(CONFIGURATION.format(folder=folder, port=port))
        server = subprocess.Popen(["nginx", "-c", configuration])
        try:
            time.sleep(0.5)
            ask(folder, f"http://127.0.0.1:{port}", solid, parts, os.path.getsize(whole))
        finally:
            server.terminate()
            server.wait()


def requests(folder, before):
    time.sleep(0.1)
    with open(os.path.join(folder, "access.log")) as log:
        lines = log.read().splitlines()[before:]
    told = [re.match(r"(\w+) (\S+) (\d+) (\d+)", line).groups() for line in lines]
    assert all(status in ("200", "206") for _, _, status, _ in told), told
    return len(told), sum(int(size) for method, _, _, size in told if method == "GET")


def ask(folder, server, solid, parts, size):
    seen = 0
    centre = solid.bounds.mean(axis=0)
    point = solid.vertices[0] + 1e-2 * (centre - solid.vertices[0])
    high = solid.bounds[1] + 1
    print(f"the whole octree is {size} bytes, {len(parts)} shards are {parts.nbytes}")
    for kind in ("shards", "packed"):
        url = f"{server}/{kind}"
        remote = None

        def opened():
            nonlocal remote
            remote = shards.open(url)
            return len(remote)

        steps = {
            "open: the manifest": opened,
            "volume: the top": lambda: remote.volume,
            "a point next to the surface": lambda: remote.contains(point),
            "the same point again": lambda: remote.contains(point),
            "a ray": lambda: remote.rays([high], [centre - high]).distance[0],
            "all: certified volume": lambda: remote.measure(tolerance=0).volume,
        }
        for name, step in steps.items():
            start = time.perf_counter()
            answer = step()
            seconds = time.perf_counter() - start
            count, size = requests(folder, seen)
            seen += count
            print(f"{kind:8} {name:30} {count:5} requests {size:10} bytes {seconds * 1e3:9.1f} ms   {answer}")


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:]))
