"""Paths without a signal are told of: of an oblique metal face few rays meet none of its coherent echo."""
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.paths.subset import subset
from echopath.signals.silence import warn_of_silence

TOLD = r"^no signal of [0-9,]+ paths: rays too few for the coherent echo of a surface found none of it: ep.unresolved"


@pytest.fixture(scope="module")
def pyramid():
    corners = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 1.5)]
    scene = ep.Scene()
    scene.add(ep.Mesh(np.array(corners, float), [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 2, 1], [0, 3, 2]]),
              name="pyramid", material="metal", position=(10, 0, 0))
    radar = ep.Radar(ep.ChirpSequence(num_samples=256, num_chirps=8), transmitters=[ep.Antenna()],
                     receivers=[ep.Antenna((0, 0.01, 0))], position=(0, 0, 1))
    return scene, radar


def test_paths_without_power_are_told_of(pyramid):
    paths = ep.trace(*pyramid, num_rays=20_000)
    assert paths.num_paths > 0
    with pytest.warns(RuntimeWarning, match=TOLD) as told:
        assert not ep.synthesize(paths).any()
    assert told[0].filename == __file__
    with pytest.warns(RuntimeWarning, match=TOLD):
        ep.simulate(*pyramid, num_rays=20_000)


def test_silence_of_an_empty_scene_and_a_signal_are_not(pyramid):
    scene, radar = pyramid
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ep.synthesize(ep.trace(scene, radar, num_rays=20_000).select("T 'pyramid' 'pyramid' R"))
        plate = ep.Scene()
        plate.add(ep.actors.plate(0.2, 0.2), name="plate", material="metal", position=(10, 0, 1), yaw=np.pi)
        assert ep.synthesize(ep.trace(plate, radar, num_rays=20_000)).any()


def plates(*places):
    scene = ep.Scene()
    for name, (position, yaw) in zip("abc", places):
        scene.add(ep.actors.plate(0.2, 0.2), name=name, material="metal", position=position, yaw=yaw)
    return scene


BEHIND, FAR = ((-10, 0, 1), 0.0), ((50, 0, 1), np.pi)
NO_GAIN = "where the antennas have no gain: they look elsewhere"
TOO_FAR = r"beyond the last range of the waveform, 38\.37 m"


@pytest.mark.parametrize("places, some, told", [
    ([BEHIND], None, f"[0-9,]+ paths: they lie {NO_GAIN}"),
    ([((-30, 0, 1), 0.0)], None, f"[0-9,]+ paths: they lie {NO_GAIN}"),  # ways of 60 m, which are ranges of 30 m
    ([FAR], None, f"[0-9,]+ paths: they lie {TOO_FAR}"),
    ([FAR], [0], f"1 path: it lies {TOO_FAR}"),
    ([BEHIND, FAR], None, f"[0-9,]+ paths: [0-9,]+ lie {TOO_FAR}; [0-9,]+ lie {NO_GAIN}"),
    ([BEHIND, FAR], [0, -1], f"2 paths: 1 lies {TOO_FAR}; 1 lies {NO_GAIN}"),
])
def test_the_reason_is_that_of_the_paths(pyramid, places, some, told):
    """Antennas of a cosine pattern have no gain behind them. some: indices of paths, None: all"""
    pattern = ep.CosinePower(exponent=4.0)
    blind = pyramid[1].replace(transmitters=[ep.Antenna(pattern=pattern)], receivers=[ep.Antenna((0, 0.01, 0), pattern=pattern)])
    paths = ep.trace(plates(*places), pyramid[1], num_rays=5000)
    if some is not None:
        paths = subset(paths, np.arange(paths.num_paths)[some])
    with pytest.warns(RuntimeWarning, match=f"^no signal of {told}$"):
        assert not ep.synthesize(paths, blind).any()


def test_only_reasons_that_were_not_told_are(pyramid):
    pattern, told = ep.CosinePower(exponent=4.0), set()
    blind = pyramid[1].replace(transmitters=[ep.Antenna(pattern=pattern)], receivers=[ep.Antenna(pattern=pattern)])
    far, behind, both = (ep.trace(plates(*places), pyramid[1], num_rays=5000) for places in ([FAR], [BEHIND], [BEHIND, FAR]))
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        for paths in (far, far, behind, both):
            warn_of_silence(paths, blind, np.zeros(1), told)
    assert ["beyond the last range" in str(one.message) for one in said] == [True, False]
    assert [NO_GAIN in str(one.message) for one in said] == [False, True]
