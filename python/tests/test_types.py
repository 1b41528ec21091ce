"""The types of the stub: they match the module, correct programs pass the type checker, and wrong ones fail."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import leafless as lf

pytest.importorskip("mypy")

TESTS = Path(__file__).parent
#: The folder that contains the package, whether it is installed or only on the path.
FOLDER = str(Path(lf.__file__).parent.parent)
PLAIN = ["--config-file=", "--strict", "--no-pretty", "--no-color-output", "--hide-error-context"]


def run(folder, *arguments):
    """Runs a Python module in a folder, and returns its output and its exit code."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("MYPY")}
    paths = [FOLDER, *filter(None, [kept.get("PYTHONPATH")])]
    environment = {**kept, "PYTHONPATH": os.pathsep.join(paths)}
    done = subprocess.run(
        [sys.executable, "-m", *arguments], cwd=folder, env=environment, capture_output=True, text=True
    )
    return done.stdout + done.stderr, done.returncode


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """A cache folder, so that NumPy's types are analysed once for all checks."""
    return tmp_path_factory.mktemp("cache")


def test_the_stub_is_true_of_the_module(tmp_path):
    allowed = TESTS / "stubtest_allowlist.txt"
    told, code = run(tmp_path, "mypy.stubtest", "leafless", "--concise", "--allowlist", str(allowed))
    assert code == 0, told


def test_the_package_passes(tmp_path, cache):
    told, code = run(tmp_path, "mypy", *PLAIN, f"--cache-dir={cache}", "-p", "leafless")
    assert code == 0, told


def test_a_typed_program_passes(tmp_path, cache):
    told, code = run(tmp_path, "mypy", *PLAIN, f"--cache-dir={cache}", str(TESTS / "typed_program.py"))
    assert code == 0, told


def test_the_typed_program_runs(tmp_path):
    from typed_program import main

    main(tmp_path)


#: Wrong lines, and the errors that the checker must report.
WRONG = {
    "lf.build(1)": "arg-type",
    'lf.build(ball, rule="certain")': "arg-type",
    "lf.build(ball, thread=2)": "call-arg",
    'lf.build(ball, threads="all")': "arg-type",
    "lf.build(ball, progress=3)": "arg-type",
    "lf.build(ball).colour": "attr-defined",
    'lf.interference(ball, ball).verdict == "disjont"': "comparison-overlap",
    "lf.interference(ball, ball)[0]": "index",
    "lf.interference(ball, ball, [placement]).verdict": "attr-defined",
    'lf.measure(ball).stop_reason == "finished"': "comparison-overlap",
    "lf.measure(ball).centroid[0]": "index",
    "lf.measure(ball).volume == 3": "comparison-overlap",
    'ball.distances([0, 0, 0], to="moon")': "call-overload",
    "ball.distances([0, 0, 0]).distance.contain([1])": "attr-defined",
    "len(ball.rays([0, 0, 0], [0, 0, 1]))": "arg-type",
    'lf.build(ball).cells("half")': "arg-type",
    "lf.build(ball).cells(lf.INSIDE)": "arg-type",
    "lf.Octree.union_of(ball)": "arg-type",
    'ball.contains([[0, 0, 0]]) + "text"': "operator",
    "ball @ placement": "operator",
    "ball | 1": "operator",
    "lf.dexelize(ball) | ball": "operator",
    'lf.surface(ball, method="magic")': "arg-type",
    'lf.Mesh([[0, 0, 0]], [[0, 0, 0]], fill="odd")': "arg-type",
    "lf.Volume(np.zeros((2, 2, 2)))": "arg-type",
    'lf.render(ball, size="large")': "arg-type",
    'lf.open("ball.lfl", colour="red")': "call-arg",
    'lf.open("ball.lfl").vertices': "union-attr",
    'lf.save(ball, "ball.lfl")': "arg-type",
    "class Own(lf.Csg): ...": "misc",
}


@pytest.fixture(scope="module")
def errors(tmp_path_factory, cache):
    """Checks all wrong lines, and returns the errors by line."""
    folder = tmp_path_factory.mktemp("wrong")
    before = ["import numpy as np", "import leafless as lf"]
    before += ["ball, placement = lf.Csg.ball([0, 0, 0], 1), lf.Affine.identity()"]
    (folder / "wrong.py").write_text("\n".join([*before, *WRONG]) + "\n")
    told, _ = run(folder, "mypy", *PLAIN, f"--cache-dir={cache}", "wrong.py")
    lines = [*before, *WRONG]
    found = re.findall(r"^wrong\.py:(\d+): error: .*\[([a-z-]+)\]$", told, re.MULTILINE)
    assert found, told
    return [(lines[int(number) - 1], code) for number, code in found]


@pytest.mark.parametrize("line", WRONG)
def test_a_wrong_line_is_found(errors, line):
    assert {code for own, code in errors if own == line} == {WRONG[line]}


def test_nothing_else_is_wrong(errors):
    assert {line for line, _ in errors} <= set(WRONG)
