"""Paths around sharp edges so many that a signal takes long: said with their number, and what makes them so many."""
import re
import warnings

import numpy as np
import pytest

import echopath as ep
from support.scenes.edge_scenes import FREQUENCY, box

BOXES = 40
ANTENNAS = 12  # of each kind
RAYS = 500


def make_radar(antennas=ANTENNAS):
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, num_samples=64, num_chirps=1)
    places = [ep.Antenna((0, 0.01 * k, 1)) for k in range(antennas)]
    return ep.Radar(waveform, transmitters=places, receivers=places)


def make_scene(mirrors=True):
    """Boxes over a ground and beside a wall."""
    scene = ep.Scene()
    material = ep.Material.metal(mirror=mirrors)
    scene.add(ep.actors.ground((60, 20)), name="ground", material=material)
    scene.add(ep.actors.wall(60, 6), name="below", material=material, position=(0, 8, -20))  # which no path meets
    scene.add(ep.actors.wall(60, 6), name="wall", material=material, position=(0, 8, 0))
    for k in range(BOXES):
        scene.add(box((0.4, 0.5, 0.6)), name=f"box_{k}", material="metal", yaw=0.1 * k,
                  position=(4.0 + 0.8 * k, -3.0 + 6.0 * (0.618 * k % 1.0), 0.8))
    return scene


def said_of(work):
    """What a call warns of edges, and its result."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        result = work()
    return [str(one.message) for one in said if "sharp edges" in str(one.message)], result


@pytest.fixture(scope="module")
def told():
    return said_of(lambda: ep.trace(make_scene(), make_radar(), num_rays=RAYS, edges=True))


def test_it_names_paths_edges_mirrors_and_the_remedy(told):
    (text,), paths = told
    around = [path for path in range(paths.num_paths) if paths.flags[path] & 4]
    hits = [int(paths.offsets[path]) + (int(paths.flags[path]) >> 8 & 63) for path in around]
    edges = {(int(paths.mesh_id[hit]), int(paths.triangle_id[hit])) for hit in hits}
    numbers = [int(number.replace(",", "")) for number in re.findall(r"[\d,]*\d", text)]
    for number, wanted in zip(numbers, (len(around), len(edges), 2, 1e-5 * len(around) * ANTENNAS**2)):
        assert abs(number - wanted) <= 0.5 * 10.0 ** np.floor(np.log10(wanted))  # one digit
    assert "edges=False" in text and "'ground'" in text and "'wall'" in text and "below" not in text


def test_mirrors_are_named_only_where_they_make_the_paths():
    (text,), _ = said_of(lambda: ep.trace(make_scene(mirrors=False), make_radar(40), num_rays=RAYS, edges=True))
    assert "mirror" not in text and "edges=False" in text


@pytest.mark.parametrize("antennas, edges", [(1, True), (ANTENNAS, False)])
def test_few_paths_or_channels_and_no_edges_are_not_worth_a_word(antennas, edges):
    assert said_of(lambda: ep.trace(make_scene(), make_radar(antennas), num_rays=RAYS, edges=edges))[0] == []


def test_a_live_scene_says_it_too():
    live = ep.Live(make_scene(), make_radar(), num_rays=RAYS, edges=True)
    assert len(said_of(live.update)[0]) == 1
