import os
from pathlib import Path

import numpy as np
import pytest

import leafless as lf


@pytest.fixture
def plate():
    """A plate with a bore. Its volume is known."""
    return lf.Csg.cuboid([0, 0, 0], [8, 6, 1]) - lf.Csg.cylinder_between([4, 3, -1], [4, 3, 2], 1)


PLATE_VOLUME = 48 - np.pi


@pytest.fixture
def tetrahedron():
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    return lf.Mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


@pytest.fixture
def models():
    """The folder of real meshes, if it exists."""
    folder = os.environ.get("LEAFLESS_MODELS")
    if not folder:
        pytest.skip("SKIPPED python: no models (LEAFLESS_MODELS)")
    return Path(folder)
