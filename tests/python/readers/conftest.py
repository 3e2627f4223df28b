"""What tests of files share."""
from __future__ import annotations

import pytest

import echopath as ep
from support.scenes.saved_frame import PARTS, make_radar, make_scene
from support.scenes.sensor_text import CONFIGURATION


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


@pytest.fixture
def written(tmp_path):
    """write(text) -> path of a configuration; write(old=new) replaces in CONFIGURATION."""
    def write(text=None, **lines):
        text = CONFIGURATION if text is None else text
        for command, line in lines.items():
            text = "\n".join(line if one.split()[:1] == [command] else one for one in text.splitlines()) + "\n"
        path = tmp_path / "sensor.cfg"
        path.write_text(text)
        return path
    return write
