"""Examples in docstrings run, and everything public has a docstring."""

import dataclasses
import doctest
import enum
import importlib
import inspect
import re
from pathlib import Path

import pytest

import leafless


#: The public names, and the names of the extension module for octrees in shards and for pairs in batches.
PUBLIC = {name: getattr(leafless, name) for name in [*leafless.__all__, "map", "open"]}
INNER = ["MassSum", "Shard", "ShardedSolid", "frame_of", "frame_of_pair", "join", "joined_statistics", "measure_cell", "surface_in"]
ALL = PUBLIC | {name: getattr(leafless._leafless, name) for name in INNER}


def documented():
    yield "leafless", leafless
    for name, thing in ALL.items():
        yield name, thing
        if inspect.isclass(thing):
            for inner, member in vars(thing).items():
                if not inner.startswith("_"):
                    yield f"{name}.{inner}", member


def is_constant(thing):
    return thing is None or isinstance(thing, (leafless.Membership, leafless.Tag, leafless.VoxelKind))


THINGS = [(name, thing) for name, thing in documented() if not is_constant(thing)]
EXAMPLES = [(name, thing) for name, thing in THINGS if isinstance(thing.__doc__, str) and ">>>" in thing.__doc__]


@pytest.mark.parametrize("name, thing", EXAMPLES, ids=[name for name, _ in EXAMPLES])
def test_examples_run(name, thing):
    test = doctest.DocTestParser().get_doctest(thing.__doc__, dict(vars(leafless)), name, None, 0)
    report = []
    results = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(test, out=report.append)
    assert results.attempted > 0 and results.failed == 0, "".join(report)


@pytest.mark.parametrize("name, thing", THINGS, ids=[name for name, _ in THINGS])
def test_everything_is_documented(name, thing):
    # Fields of answers have comments in the source.
    if type(thing).__name__ in ("member_descriptor", "property") and name.split(".")[0] in ("Intervals",):
        return
    assert thing.__doc__ and thing.__doc__.strip(), name


def callables():
    for name, thing in ALL.items():
        if not inspect.isclass(thing):
            if callable(thing):
                yield name, thing, thing.__doc__
            continue
        # Callers do not construct answers.
        if not dataclasses.is_dataclass(thing) and not issubclass(thing, (enum.Enum, Exception)):
            yield name, thing, thing.__doc__
            for inner in vars(thing):
                member = getattr(thing, inner)
                if not inner.startswith("_") and callable(member):
                    yield f"{name}.{inner}", member, f"{member.__doc__} {thing.__doc__}"


def parameters(thing):
    """The parameters of a function. The page and the package's docstring explain those of limits."""
    try:
        all = inspect.signature(thing).parameters
    except ValueError:
        return []
    return [name for name in all if name not in ("self", "cls", "limits", "taking") and not name.startswith("_")]


CALLABLES = list(callables())


@pytest.mark.parametrize("name, thing, told", CALLABLES, ids=[name for name, *_ in CALLABLES])
def test_parameters_are_explained(name, thing, told):
    quoted = " ".join(re.findall(r"`([^`]*)`", told))
    assert [parameter for parameter in parameters(thing) if not re.search(rf"\b{parameter}\b", quoted)] == []


def test_parameters_are_found():
    assert parameters(leafless.build)[:3] == ["solid", "frame", "depth"] and "depth" in parameters(leafless.Frame)
    assert sum(len(parameters(thing)) for _, thing, _ in CALLABLES) > 150


def test_examples_are_many():
    assert len(EXAMPLES) >= 25


@pytest.mark.parametrize("name", ["shards", "distributed"])
def test_modules_are_documented_and_run(name):
    if name == "distributed":
        pytest.importorskip("dask")
    module = importlib.import_module(f"leafless.{name}")
    for public in module.__all__:
        thing = getattr(module, public)
        assert thing.__doc__ and thing.__doc__.strip(), public
        for inner, member in vars(thing).items() if inspect.isclass(thing) else ():
            assert inner.startswith("_") or member.__doc__, f"{public}.{inner}"
    report = []
    test = doctest.DocTestParser().get_doctest(module.__doc__, {}, name, None, 0)
    results = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(test, out=report.append)
    assert results.attempted > 3 and results.failed == 0, "".join(report)


DOCS = Path(__file__).parent.parent.parent / "docs"
PROJECT = DOCS.parent
ALL_PAGES = [*sorted(DOCS.rglob("*.md")), PROJECT / "README.md", PROJECT / "python" / "README.md"]
PAGES = [page for page in ALL_PAGES if "\n```python\n" in page.read_text(encoding="utf-8")]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(PROJECT)))
def test_pages_run(page):
    if page.name == "scale.md":
        pytest.importorskip("distributed")
    blocks = re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    report = []
    test = doctest.DocTestParser().get_doctest("".join(blocks), {}, page.name, str(page), 0)
    options = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
    results = doctest.DocTestRunner(optionflags=options).run(test, out=report.append)
    assert results.attempted >= 2 and results.failed == 0, "".join(report)
