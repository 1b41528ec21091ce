"""The notebooks run from the first cell to the last one, and their assertions hold."""

import os
from pathlib import Path

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")

FOLDER = Path(__file__).parent.parent / "notebooks"
NAMES = ["from_an_stl_to_proven_answers", "labels_for_learning"]


def test_all_notebooks_are_known():
    assert sorted(path.stem for path in FOLDER.glob("*.ipynb")) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_notebook_runs(name, tmp_path):
    if name == "labels_for_learning":
        pytest.importorskip("trimesh")
        pytest.importorskip("rtree")
    notebook = nbformat.read(FOLDER / f"{name}.ipynb", 4)
    before = [kinds(cell) for cell in notebook.cells]
    if os.environ.get("LEAFLESS_THOROUGH") != "1":
        for cell in notebook.cells:
            cell.source = cell.source.replace("500_000", "10_000").replace("spacing = 0.05", "spacing = 0.2")
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    # The kinds of outputs are those in the stored notebook.
    assert [kinds(cell) for cell in notebook.cells] == before and any(before)


def kinds(cell):
    outputs = cell.get("outputs", [])
    return sorted({kind for output in outputs for kind in output.get("data", {"text": ""})})
