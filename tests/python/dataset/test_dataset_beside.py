"""What comes in beside the echoes is no echo in the exports and the statistics of datasets."""

import numpy as np
import pytest

import echopath as ep
from echopath import dataset
from echopath.dataset import statistics
from echopath.dataset.exports import cross_sections_dbsm, osi

WAVEFORM = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=512, sampling_rate=20e6, num_chirps=32,
                            chirp_interval=60e-6)


@pytest.fixture(scope="module")
def frame():
    """A ball, and a radar with the same chirps whose tone no ray has made."""
    own, *others = (ep.Antenna((0, 0.0019 * k, 0)) for k in range(3))
    radar = ep.Radar(WAVEFORM, transmitters=[own], receivers=others, transmit_power=1.0)
    other = ep.Radar(WAVEFORM, transmitters=[own], receivers=[own], position=(40, 3, 0))
    scene = ep.Scene(interferers=[ep.Interferer(radar=other, over="direct")])
    scene.add(ep.actors.sphere(0.2), name="ball", material=ep.Material.metal(), smooth=True, position=(8, 3, 0))
    return ep.simulate(scene, radar, num_rays=2000, max_bounces=2, detections=True)


def test_interference_is_clutter_that_does_not_exist_in_osi(frame):
    messages = pytest.importorskip("osi3.osi_sensordata_pb2")
    radar = messages.SensorData().feature_data.radar_sensor.add()
    osi._add_detections(radar, frame.detections, cross_sections_dbsm(frame.detections, frame.radar, 0.0), {"ball": 0})
    told = {(str(part), one.existence_probability, one.classification)
            for part, one in zip(frame.detections.part, radar.detection)}
    assert told == {("interference", 0.0, 3), ("", 1.0, 1)}  # CLASSIFICATION_CLUTTER and CLASSIFICATION_OTHER


@pytest.mark.parametrize("waveform, leakage_db", [(WAVEFORM, -80.0), (ep.ChirpSequence(
    start_frequency=76e9, bandwidth=200e6, num_samples=128, sampling_rate=10e6, num_chirps=32), -110.0)])
def test_what_leaks_from_antenna_to_antenna_has_no_cross_section(frame, waveform, leakage_db):
    """It is within micrometres of 0 m where it is strong, and beside the antennas: it had anything from -130 to 330 dBsm."""
    antennas = [ep.Antenna((0, 0.0019 * k, 0), pattern=ep.CosinePower(2.0)) for k in range(3)]
    for turn, seed in ((0.0, 1), (0.3, 2), (-2.0, 3), (1.3, 4)):
        radar = ep.Radar(waveform, transmitters=antennas[:1], receivers=antennas[1:], yaw=turn, position=(3.0, -7.0, 1.0),
                         receiver=ep.Receiver(leakage_db=[[leakage_db, leakage_db]]))
        found = ep.simulate(ep.Scene(frame.scene), radar, num_rays=100, noise_seed=seed, detections=True).detections
        leaked = found.part == "leakage"
        assert leaked.any() and np.isnan(cross_sections_dbsm(found, radar, 0.0)[leaked]).all()


def test_statistics_count_interference_as_such(frame):
    found = statistics.Statistics()
    statistics._count(dataset.DatasetFrame(0, 0, 0, "train", frame), {"ball": "car"}, found)
    assert found.detections == {"car": 1, "interference": 1}
