"""Where `echopath scene` puts the radar: it looks at what is there."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath.cli import report
from echopath.scene_file.vantage import vantage


@pytest.mark.parametrize("bodies", [[(12.0, 2.0), (8.0, -2.0)], [(70.0, -15.0)], [(41.0, 19.0)]])
def test_on_an_open_field_it_looks_at_what_stands_there(bodies):
    scene = ep.Scene()
    scene.add(ep.actors.ground((80.0, 40.0)), name="field", material="asphalt", position=(40.0, 0.0, 0.0))
    for number, place in enumerate(bodies):
        scene.add(ep.actors.sphere(1.0), name=f"ball_{number}", material="metal", position=(*place, 1.0))
    found = vantage(scene)
    ways = np.array(bodies) - found.position[:2]
    bearings = np.degrees(np.arctan2(ways[:, 1], ways[:, 0])) - found.yaw
    assert found.is_within and np.abs((bearings + 180.0) % 360.0 - 180.0).min() < 15.0


def test_a_radar_that_looks_away_is_told_that_no_path_has_power():
    pattern = ep.CosinePower(2.0)
    waveform = ep.ChirpSequence(start_frequency=77e9, num_samples=32, num_chirps=4)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0.0, 0.0, 1.0), pattern=pattern)],
                     receivers=[ep.Antenna((0.0, 0.01, 1.0), pattern=pattern)])
    for ahead, told in ((-8.0, "no path has any power: the antennas look away"), (8.0, "resolved to 0.3 dB")):
        scene = ep.Scene()
        scene.add(ep.actors.plate(2.0, 2.0), name="plate", material="concrete", position=(ahead, 0.0, 1.0))
        paths = ep.trace(scene, radar, num_rays=20_000)
        assert report.unresolved(ep.unresolved(paths), paths)[0].startswith(told)
