"""What tests of files share."""
from __future__ import annotations

import pytest

import echopath as ep
from support.scenes.saved_frame import PARTS, make_radar, make_scene


@pytest.fixture(scope="module")
def frame():
    """A frame with two partitions, noise and a map of azimuth, of a scene with all kinds of motion."""
    return ep.simulate(make_scene(), make_radar(), num_rays=4000, seed=7, parts=PARTS, noise_seed=3,
                       window=("chebyshev", 60), angles={"window": ("chebyshev", 30), "azimuth": [-0.1, 0.0, 0.15]})


@pytest.fixture
def saved(frame, tmp_path):
    """The path of its file."""
    path = tmp_path / "frame.h5"
    frame.save(path)
    return path
